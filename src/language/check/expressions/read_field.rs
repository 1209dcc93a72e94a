//! Reading a field of a declared block by the type of its parameter. In: a block and the name of a field. Out: the parameter, or an error.

use crate::check::checker::Checker;
use psd_plan::formula::Formula;

/// A parameter that a field of a block gives; None after an error.
pub trait ReadField: Sized {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self>;
}

/// One number, or the default of the field.
impl ReadField for Formula {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        checker.quantity(block, field)
    }
}

/// One number, if the field is given.
impl ReadField for Option<Formula> {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        checker.optional(block, field)
    }
}

/// The numbers of a list.
impl ReadField for Vec<Formula> {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        checker.quantities(block, field)
    }
}

/// The tested specimen, as an index into `Plan::specimens`; no other field is an index.
impl ReadField for usize {
    fn read(checker: &mut Checker<'_>, block: usize, _field: &'static str) -> Option<Self> {
        checker.specimen_of(block)
    }
}

/// A whole number.
impl ReadField for u32 {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        checker.count(block, field)
    }
}

/// `true` or `false`; false if it is not given.
impl ReadField for bool {
    fn read(checker: &mut Checker<'_>, block: usize, field: &'static str) -> Option<Self> {
        checker
            .word(block, field, "false")
            .map(|word| word == "true")
    }
}
