//! Checks of expressions and field values. In: the syntax tree. Out: numbers in SI, formulas,
//! chosen variants. They know no block.

pub(crate) mod calendar;
pub(crate) mod call;
pub(crate) mod choice;
pub(crate) mod data;
pub(crate) mod data_file;
pub(crate) mod expression;
pub(crate) mod fields;
pub(crate) mod literal;
pub(crate) mod names;
pub(crate) mod overrides;
pub(crate) mod parameters;
pub(crate) mod read_field;
