//! The functions of expressions.

use crate::formula::Function;

/// A function, and its arguments.
#[derive(Debug)]
pub struct FunctionKind {
    pub name: &'static str,
    pub function: Function,
    /// Takes any number of values and lists; else exactly one number.
    pub many: bool,
    pub doc: &'static str,
}

const fn function(
    name: &'static str,
    function: Function,
    many: bool,
    doc: &'static str,
) -> FunctionKind {
    FunctionKind {
        name,
        function,
        many,
        doc,
    }
}

pub const FUNCTIONS: &[FunctionKind] = &[
    function("abs", Function::Abs, false, "absolute value"),
    function(
        "min",
        Function::Min,
        true,
        "smallest of several values or of a list",
    ),
    function(
        "max",
        Function::Max,
        true,
        "largest of several values or of a list",
    ),
    function(
        "sum",
        Function::Sum,
        true,
        "sum of several values or of a list",
    ),
    function(
        "mean",
        Function::Mean,
        true,
        "mean of several values or of a list",
    ),
    function(
        "sqrt",
        Function::Sqrt,
        false,
        "square root; the unit is the root of the unit",
    ),
    function("sin", Function::Sin, false, "sine of an angle in radians"),
    function("cos", Function::Cos, false, "cosine of an angle in radians"),
];
