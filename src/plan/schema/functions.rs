//! The functions and constants of expressions.

use crate::formula::Function;

/// A function, and its arguments.
#[derive(Debug)]
pub struct FunctionKind {
    pub name: &'static str,
    pub function: Function,
    pub takes: Takes,
    pub doc: &'static str,
}

/// What a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    One,
    Two,
    /// Any number of values and lists.
    Many,
}

impl Takes {
    /// The arguments as a reader writes them.
    #[must_use]
    pub const fn arguments(self) -> &'static str {
        match self {
            Self::One => "x",
            Self::Two => "x, y",
            Self::Many => "values, …",
        }
    }
}

/// The constants: name, value, description.
pub const CONSTANTS: &[(&str, f64, &str)] = &[(
    "pi",
    std::f64::consts::PI,
    "ratio of circumference to diameter, a number",
)];

/// The value of a constant.
#[must_use]
pub fn constant(name: &str) -> Option<f64> {
    let found = CONSTANTS.iter().find(|(constant, ..)| *constant == name);
    found.map(|(_, value, _)| *value)
}

const fn function(
    name: &'static str,
    function: Function,
    takes: Takes,
    doc: &'static str,
) -> FunctionKind {
    FunctionKind {
        name,
        function,
        takes,
        doc,
    }
}

pub const FUNCTIONS: &[FunctionKind] = &[
    function("abs", Function::Abs, Takes::One, "absolute value"),
    function(
        "min",
        Function::Min,
        Takes::Many,
        "smallest of several values or of a list",
    ),
    function(
        "max",
        Function::Max,
        Takes::Many,
        "largest of several values or of a list",
    ),
    function(
        "sum",
        Function::Sum,
        Takes::Many,
        "sum of several values or of a list",
    ),
    function(
        "mean",
        Function::Mean,
        Takes::Many,
        "mean of several values or of a list",
    ),
    function(
        "sqrt",
        Function::Sqrt,
        Takes::One,
        "square root; the unit is the root of the unit",
    ),
    function("sin", Function::Sin, Takes::One, "sine of an angle"),
    function("cos", Function::Cos, Takes::One, "cosine of an angle"),
    function("tan", Function::Tan, Takes::One, "tangent of an angle"),
    function(
        "exp",
        Function::Exp,
        Takes::One,
        "e to the power of a number",
    ),
    function(
        "log",
        Function::Log,
        Takes::One,
        "natural logarithm of a number",
    ),
    function(
        "hypot",
        Function::Hypot,
        Takes::Two,
        "sqrt(x^2 + y^2) of two values of one dimension",
    ),
];
