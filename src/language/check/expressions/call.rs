//! Functions: `abs(x)`, `max(a, b)`, `sqrt(area)`.

use crate::check::checker::{Checker, Context, Shape, Typed};
use crate::check::expressions::section;
use crate::check::violations::{AbsoluteTemperature, ExponentTooLarge, ListForNumber, Mismatched};
use crate::check::wording::suggestion;
use crate::codes::{E207, E213};
use crate::syntax::ast::{Argument, Ident};
use crate::syntax::foreign;
use psd_plan::formula::{Formula, Function};
use psd_plan::schema::sections::SECTIONS;
use psd_plan::schema::{FUNCTIONS, FunctionKind, Kind, Takes};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::{Dimension, Exponent};

#[derive(Violation)]
#[violation(E207, "unknown function `{name}`")]
#[help("{}", suggestion(
            name,
            FUNCTIONS.iter().map(|function| function.name).chain(SECTIONS.iter().map(|shape| shape.name)),
        ))]
struct UnknownFunction<'a> {
    name: &'a str,
    #[label("unknown function")]
    span: Span,
}

/// A function of other languages, with its form in this one.
#[derive(Violation)]
#[violation(E207, "unknown function `{name}`")]
#[help("{help}")]
struct ForeignFunction<'a> {
    name: &'a str,
    #[label("unknown function")]
    span: Span,
    help: String,
}

struct FunctionArgumentWithName<'a> {
    function: &'a str,
    name: &'a Ident,
}

impl Violation for FunctionArgumentWithName<'_> {
    const CODE: Code = E213;

    fn diagnostic(self) -> Diagnostic {
        let Self { function, name } = self;
        Diagnostic::new(
            Self::CODE,
            format!("the arguments of `{function}` have no names"),
        )
        .at(name.span, "named argument")
        .help(format!("remove `{}:`", name.node))
    }
}

#[derive(Violation)]
#[violation(
    E213,
    "`{}` requires {wanted}, found {found}",
    kind.name,
    wanted = match kind.takes {
        Takes::One => "one value",
        Takes::Two => "two values",
        Takes::Many => "at least one value",
    }
)]
#[help("write it as in `{}({})`", kind.name, if kind.takes == Takes::Two { "x, y" } else { "x" })]
struct FunctionArguments<'a> {
    kind: &'a FunctionKind,
    found: usize,
    #[label("{found} values")]
    span: Span,
}

/// A function that gives no temperature for absolute temperatures.
fn keeps_temperatures(function: Function) -> bool {
    matches!(function, Function::Min | Function::Max | Function::Mean)
}

impl<'a> Checker<'a> {
    pub fn call(
        &mut self,
        name: &Ident,
        arguments: &'a [Argument],
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        if section::shape(&name.node).is_some() {
            return self.section_for_number(span);
        }
        let Some(kind) = FUNCTIONS.iter().find(|function| function.name == name.node) else {
            return match self.form_of_foreign_function(&name.node, arguments) {
                Some(help) => self.fail(ForeignFunction {
                    name: &name.node,
                    span,
                    help,
                }),
                None => self.fail(UnknownFunction {
                    name: &name.node,
                    span: name.span,
                }),
            };
        };
        if let Some(named) = arguments.iter().find_map(|argument| argument.name.as_ref()) {
            return self.fail(FunctionArgumentWithName {
                function: kind.name,
                name: named,
            });
        }
        let checked: Vec<Option<Typed>> = arguments
            .iter()
            .map(|argument| self.value(&argument.value, context))
            .collect();
        let checked: Vec<Typed> = checked.into_iter().collect::<Option<_>>()?;
        let wrong_count = match kind.takes {
            Takes::One => checked.len() != 1,
            Takes::Two => checked.len() != 2,
            Takes::Many => checked.is_empty(),
        };
        let Some(first) = checked.first().filter(|_| !wrong_count) else {
            return self.fail(FunctionArguments {
                kind,
                found: checked.len(),
                span,
            });
        };
        let list = checked.iter().find(|it| it.shape == Shape::List);
        if let Some(list) = list.filter(|_| kind.takes != Takes::Many) {
            return self.fail(ListForNumber { span: list.span });
        }
        if let Some(other) = checked
            .iter()
            .find(|other| other.dimension != first.dimension)
        {
            return self.fail(Mismatched {
                operator: kind.name,
                left: first,
                right: other,
            });
        }
        let absolute = checked.iter().any(|argument| argument.absolute);
        if absolute && !keeps_temperatures(kind.function) {
            return self.fail(AbsoluteTemperature::of_function(kind.name, span));
        }
        let dimension = match kind.function {
            Function::Sin | Function::Cos | Function::Tan => {
                let (angle, written) = (first.clone(), &arguments.first()?.value);
                self.expect(angle, Dimension::ANGLE, kind.name, written)?;
                Dimension::NUMBER
            }
            Function::Exp | Function::Log => {
                let (number, written) = (first.clone(), &arguments.first()?.value);
                self.expect(number, Dimension::NUMBER, kind.name, written)?;
                Dimension::NUMBER
            }
            Function::Sqrt => {
                let half = Exponent::ratio(1, 2);
                let Some(root) = half.and_then(|half| first.dimension.to_power(half)) else {
                    return self.fail(ExponentTooLarge { span });
                };
                root
            }
            _ => first.dimension,
        };
        let bare = checked.iter().all(|argument| argument.bare);
        let parts = checked
            .into_iter()
            .map(|argument| argument.formula)
            .collect();
        Some(Typed {
            bare,
            absolute,
            ..Typed::number(Formula::Call(kind.function, parts), dimension, span)
        })
    }

    /// What to write instead of a function of other languages.
    fn form_of_foreign_function(&self, name: &str, arguments: &'a [Argument]) -> Option<String> {
        let texts: Vec<&str> = arguments
            .iter()
            .map(|argument| self.text(argument.value.span))
            .collect();
        if let Some(range) = foreign::range_of_call(name, &texts, "") {
            return Some(format!("write `{range}`: both ends are part of a range"));
        }
        match (name, texts.as_slice()) {
            ("pow" | "power", [base, exponent]) => {
                let simple =
                    |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
                let bracketed = |text: &str| {
                    if simple(text) {
                        text.to_owned()
                    } else {
                        format!("({text})")
                    }
                };
                Some(format!(
                    "write `{}^{}`",
                    bracketed(base),
                    bracketed(exponent)
                ))
            }
            ("P" | "Pr" | "prob" | "probability", _) => {
                let studies = self.scope.of_kind(Kind::Study);
                let study = studies.into_iter().find_map(|(_, block)| block.name);
                let study = study.map_or("scatter", |name| name.node.as_str());
                Some(format!(
                    "name the event by a requirement; a study has its probability: `{study}.probability(fails: \"…\")`"
                ))
            }
            ("log10", [number]) => Some(format!("write `log({number}) / log(10)`")),
            _ if foreign::is_range(name) => {
                Some("write a range, as in `1 mm .. 10 mm step …`".to_owned())
            }
            _ => None,
        }
    }
}
