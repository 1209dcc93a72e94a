//! Checks of expressions and field values. In: the syntax tree. Out: numbers in SI, formulas,
//! chosen variants. They know no block.

pub mod calendar;
pub mod call;
pub mod choice;
pub mod data;
pub mod data_file;
pub mod expression;
pub mod fields;
pub mod literal;
pub mod names;
pub mod overrides;
pub mod parameters;
pub mod section;
