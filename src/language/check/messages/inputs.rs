//! Errors of names of inputs, in `--set` and in studies.

use super::suggestion;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

/// Why a name is not an input of the plan.
pub enum NoInput {
    Unknown(UnknownName),
    /// The name of a `let`.
    Let(String),
    /// A block without a field.
    Block {
        name: String,
        inputs: Vec<String>,
    },
    /// A name behind a number.
    InsideANumber(String),
    /// A field of a block that gives no number. `inputs`: the numbers that the block writes.
    NoField {
        path: String,
        inputs: Vec<String>,
        reason: NoField,
    },
    /// Its declaration has an error, which is reported.
    Reported,
}

/// An unknown first word.
pub struct UnknownName {
    pub name: String,
    pub known: Vec<String>,
}

/// Why a field gives no number.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum NoField {
    Unknown,
    /// A known field that the plan does not write.
    NotWritten,
    /// Calculated from other fields.
    Derived,
    /// The result of a procedure.
    Result,
    List,
    NotANumber,
}

impl NoInput {
    fn code(&self) -> Code {
        match self {
            Self::Unknown(_) => Code::UnknownName,
            Self::NoField {
                reason: NoField::Unknown,
                ..
            } => Code::UnknownResult,
            _ => Code::NotAnInput,
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Unknown(unknown) => format!("unknown name `{}`", unknown.name),
            Self::Let(name) => format!("`{name}` is a `let`, which is calculated"),
            Self::Block { name, .. } => format!("`{name}` is a block, not a number"),
            Self::InsideANumber(name) => format!("`{name}` is one number"),
            Self::Reported => String::new(),
            Self::NoField { path, reason, .. } => match reason {
                NoField::Unknown => format!("the plan writes no `{path}`"),
                NoField::NotWritten => format!("the plan does not write `{path}`"),
                NoField::Derived => format!("`{path}` is calculated from other fields"),
                NoField::Result => format!("`{path}` is a result, not an input"),
                NoField::List => format!("`{path}` is a list, not one number"),
                NoField::NotANumber => format!("`{path}` is not a number"),
            },
        }
    }

    fn label(&self) -> &'static str {
        match self {
            Self::Unknown(_) => "unknown name",
            Self::Let(_) => "a `let`",
            Self::Block { .. } => "a block",
            Self::InsideANumber(_) | Self::Reported => "one number",
            Self::NoField { reason, .. } => match reason {
                NoField::Unknown => "unknown field",
                NoField::NotWritten => "not written in the block",
                NoField::Derived => "calculated",
                NoField::Result => "a result",
                NoField::List => "a list",
                NoField::NotANumber => "not a number",
            },
        }
    }

    fn help(&self) -> String {
        match self {
            Self::Unknown(unknown) => {
                suggestion(&unknown.name, unknown.known.iter().map(String::as_str))
            }
            Self::Let(name) => format!("write `param {name} = …` in the plan"),
            Self::Block { inputs, .. } => one_of_inputs(inputs),
            Self::InsideANumber(name) => format!("write `{name}` alone"),
            Self::Reported => String::new(),
            Self::NoField {
                path,
                inputs,
                reason,
            } => match reason {
                NoField::Unknown | NoField::Derived if !inputs.is_empty() => {
                    let last = path.rsplit('.').next().unwrap_or_default();
                    match inputs.as_slice() {
                        [only] if only.ends_with(&format!(".{last}")) => {
                            format!("write `{only}`")
                        }
                        _ => suggestion(path, inputs.iter().map(String::as_str)),
                    }
                }
                NoField::NotWritten => {
                    let field = path.rsplit('.').next().unwrap_or_default();
                    format!("write `{field} = …` in the block")
                }
                NoField::Result => {
                    let name = path.replace('.', "_");
                    format!(
                        "write `param {name} = …`, use it in the plan instead, and name `{name}` here"
                    )
                }
                _ => "write a `param`, use it in the field, and name it here".to_owned(),
            },
        }
    }
}

fn one_of_inputs(inputs: &[String]) -> String {
    match inputs {
        [] => "write a `param`, use it in the block, and name it here".to_owned(),
        _ => format!(
            "write a field, {}",
            super::one_of(inputs.iter().map(String::as_str))
        ),
    }
}

/// `--set beam.mas=2kg`
pub fn setting_without_input(name: &str, reason: &NoInput) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownParameter,
        format!("`--set {name}`: {}", reason.message()),
    )
    .help(reason.help())
}

/// `--set bench.force_per_count=1N`
pub fn setting_of_a_real_rig(name: &str) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownParameter,
        format!("`--set {name}`: a number of a real rig is in the plan only"),
    )
    .help("change it in the rig's block")
}

/// An entry of `vary`, or an intensity. None if it is reported elsewhere.
pub fn no_input(reason: &NoInput, span: Span) -> Option<Diagnostic> {
    if matches!(reason, NoInput::Reported) {
        return None;
    }
    Some(
        Diagnostic::new(reason.code(), reason.message())
            .at(span, reason.label())
            .help(reason.help()),
    )
}

pub fn input_wanted(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{text}` is not the name of an input"),
    )
    .at(span, "not a name")
    .help("write a `param` or a field, with its distribution: `beam.mass ~ normal(cv: 2 %)`")
}

/// A number that a study cannot vary, for another reason than its name.
pub fn cannot_vary(name: &str, why: &str, span: Span, help: &str) -> Diagnostic {
    Diagnostic::new(Code::NotAnInput, format!("`{name}` {why}"))
        .at(span, "cannot be varied")
        .help(help)
}

pub fn varied_twice(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::new(Code::Duplicate, format!("`{name}` is varied twice"))
        .at(span, "varied again")
        .at(first, "first varied here")
        .help("remove one of them")
}

pub fn not_a_record(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NotAnInput,
        format!("`{name}` is not the number of a ground-motion record"),
    )
    .at(span, "draws one of several records")
    .help("write `motion.record_number ~ any` for a `ground motion` with `record_number = 1`, or a distribution such as `normal(cv: 2 %)`")
}

pub fn record_drawn(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NotAnInput,
        format!("`{name}` is the number of a record, not a measured value"),
    )
    .at(span, "gives numbers between records")
    .help(format!(
        "write `{name} ~ any`: each record has the same probability"
    ))
}

pub fn mean_of_a_result(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadDistribution,
        format!("`{name}` is a result: the plan does not state its mean"),
    )
    .at(span, "around which value?")
    .help(format!(
        "write `{name} ~ measured`, or add `mean:` to the distribution"
    ))
}
