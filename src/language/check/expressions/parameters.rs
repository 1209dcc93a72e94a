//! `let` and `param`: their values. A value given from outside the plan, by `--set` or by binding, replaces the one of a
//! parameter. In: the syntax tree and the values from outside. Out: constants with their dimensions.

use std::collections::BTreeMap;

use crate::check::checker::{Checker, Context, OwnValue, Reads, Shape, Typed};
use crate::check::scope::{DeclaredValue, Setting};
use crate::check::violations::{Mismatched, NotFinite, UnknownParameter, WrongDimensionOfQuantity};
use crate::check::wording::shown;
use crate::codes::{E101, E401, E406};
use crate::syntax;
use crate::syntax::ast::{Ast, Expr, ItemKind};
use psd_plan::formula::Formula;
use psd_plan::{Interval, Parameter};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{FileId, Sources, Span};
use psd_text::units::Dimension;

struct SettingIsNoValue<'a> {
    name: &'a str,
    file: FileId,
    length: usize,
}

impl Violation for SettingIsNoValue<'_> {
    const CODE: Code = E101;

    fn diagnostic(self) -> Diagnostic {
        let Self { name, file, length } = self;
        Diagnostic::new(Self::CODE, format!("`--set {name}` requires one value"))
            .at(Span::new(file, 0, length), "more than a value")
            .help(format!("write it as in `--set {name}=\"1.5 m/s\"`"))
    }
}

/// Parses the values of `--set`, each as a source file of its own, so that an error in it can be shown. Later ones win.
pub fn read_settings(
    sources: &mut Sources,
    trees: &[Ast],
    settings: &[(String, String)],
    errors: &mut Vec<Diagnostic>,
) -> BTreeMap<String, Setting> {
    let known = names_of_parameters(trees);
    let last: BTreeMap<&str, &str> = settings
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_str()))
        .collect();
    let mut read = BTreeMap::new();
    for (name, value) in last {
        // `beam.mass`: the declarations decide whether there is such a field.
        if !known.contains(&name) && !name.contains('.') {
            errors.push(
                UnknownParameter {
                    name,
                    known: &known,
                    calculated: has_let(trees, name),
                }
                .diagnostic(),
            );
            continue;
        }
        let word = name.replace('.', "_");
        let file = sources.add(format!("--set {name}"), format!("param {word} = {value}"));
        let (tree, found) = syntax::parse(sources, file);
        let broken = !found.is_empty();
        errors.extend(found);
        match tree.items.into_iter().next().map(|item| item.kind) {
            Some(ItemKind::Param {
                value,
                bounds: None,
                ..
            }) if is_one_line(&sources.file(file).text) => {
                read.insert(name.to_owned(), Setting::Written(value));
            }
            _ if broken => {}
            _ => errors.push(
                SettingIsNoValue {
                    name,
                    file,
                    length: sources.file(file).text.len(),
                }
                .diagnostic(),
            ),
        }
    }
    read
}

/// The names of every `param`, in the order of the files.
pub fn names_of_parameters(trees: &[Ast]) -> Vec<&str> {
    let items = trees.iter().flat_map(|tree| &tree.items);
    items
        .filter_map(|item| match &item.kind {
            ItemKind::Param { name, .. } => Some(name.node.as_str()),
            _ => None,
        })
        .collect()
}

/// Whether a `let` has this name.
pub fn has_let(trees: &[Ast], wanted: &str) -> bool {
    let mut items = trees.iter().flat_map(|tree| &tree.items);
    items.any(|item| matches!(&item.kind, ItemKind::Let { name, .. } if name.node == wanted))
}

/// A value must be on one line.
fn is_one_line(text: &str) -> bool {
    !text.contains(['\n', '\r'])
}

#[derive(Violation)]
#[violation(
    E401,
    "`{name}` is outside its range {low} .. {high}",
    low = shown(bounds.low, dimension),
    high = shown(bounds.high, dimension)
)]
#[help("widen the range or change the value")]
struct ParameterOutOfBounds<'a> {
    name: &'a str,
    text: &'a str,
    #[label("`{text}` is outside")]
    span: Span,
    bounds: Interval,
    dimension: Dimension,
}

/// `name`: as in `--set speed`, or the parameter alone where no text gives the value.
#[derive(Violation)]
#[violation(
    E406,
    "`{name}` is outside {low} .. {high}",
    low = shown(bounds.low, dimension),
    high = shown(bounds.high, dimension)
)]
#[help(
    "write a value between {low} and {high}",
    low = shown(bounds.low, dimension),
    high = shown(bounds.high, dimension)
)]
struct SettingOutOfRange<'a> {
    name: &'a str,
    text: &'a str,
    #[label("`{text}` is outside")]
    span: Span,
    bounds: Interval,
    dimension: Dimension,
    #[label("allowed range")]
    bounds_at: Span,
}

/// Where the value of a parameter is.
const OF_PARAMETER: Context = Context {
    entry: None,
    reads: Reads::Nothing("a parameter"),
    critical: false,
};

impl<'a> Checker<'a> {
    /// The value of a declaration; for a parameter that is set, the value given.
    pub fn value_of_declaration(&mut self, index: usize) -> Option<Typed> {
        let declared = &self.scope.values[index];
        if declared.keyword == "let" {
            let context = Context {
                entry: None,
                reads: Reads::All,
                critical: false,
            };
            if self.section_of(declared.value).is_some() {
                // It has values and is none.
                self.section(declared.value, context);
                return None;
            }
            return self.value(declared.value, context);
        }
        let work = |checker: &mut Checker<'a>| checker.own_value(declared);
        let OwnValue { typed: own, bounds } =
            self.once_in(|checker| &mut checker.own_values, index, work)?;
        match declared.setting {
            None => Some(own),
            Some(setting) => self.value_of_setting(declared, setting, &own, bounds),
        }
    }

    /// The value that the plan itself gives a parameter, and its bounds. They read nothing else of the plan.
    fn own_value(&mut self, declared: &DeclaredValue<'a>) -> Option<OwnValue> {
        let own = self.single(declared.value, OF_PARAMETER);
        let bounds = declared
            .bounds
            .map(|bounds| self.bounds_of_parameter(bounds, OF_PARAMETER, own.as_ref()));
        let typed = own?;
        let bounds = match bounds {
            Some(bounds) => bounds?,
            None => Interval::ALL,
        };
        let value = typed.constant()?;
        if !bounds.contains(value) {
            let span = declared.value.span;
            return self.fail(ParameterOutOfBounds {
                name: &declared.name.node,
                text: self.text(span),
                span,
                bounds,
                dimension: typed.dimension,
            });
        }
        Some(OwnValue { typed, bounds })
    }

    /// The value given from outside the plan, if it has the dimension of the parameter's own and is within its bounds.
    fn value_of_setting(
        &mut self,
        declared: &'a DeclaredValue<'a>,
        setting: &'a Setting,
        own: &Typed,
        bounds: Interval,
    ) -> Option<Typed> {
        let name = &declared.name.node;
        let set = match setting {
            Setting::Written(written) => {
                let set = self.single(written, OF_PARAMETER)?;
                self.expect(set, own.dimension, name, written)?
            }
            Setting::Bound(input) => {
                let quantity = self.bound_value(*input);
                let span = declared.value.span;
                if quantity.dimension != own.dimension {
                    return self.fail(WrongDimensionOfQuantity {
                        bound: quantity,
                        wanted: own.dimension,
                        parameter: name,
                        declared_at: span,
                    });
                }
                if !quantity.value.is_finite() {
                    return self.fail(NotFinite { span });
                }
                let formula = Formula::Constant(quantity.value);
                Typed::number(formula, quantity.dimension, span)
            }
        };
        let value = set.constant()?;
        if !bounds.contains(value) {
            let (name, text) = match setting {
                Setting::Written(_) => (format!("--set {name}"), self.text(set.span).to_owned()),
                Setting::Bound(input) => (name.clone(), self.bound_value(*input).in_plan_syntax()),
            };
            let at = declared
                .bounds
                .map_or(declared.value.span, |bounds| bounds.span);
            return self.fail(SettingOutOfRange {
                name: &name,
                text: &text,
                span: set.span,
                bounds,
                dimension: own.dimension,
                bounds_at: at,
            });
        }
        Some(set)
    }

    fn bounds_of_parameter(
        &mut self,
        written: &'a Expr,
        context: Context,
        own: Option<&Typed>,
    ) -> Option<Interval> {
        let (interval, dimension) = self.interval(written, context)?;
        if let Some(own) = own
            && own.dimension != dimension
        {
            return self.fail(Mismatched {
                operator: "between",
                left: own,
                right: &Typed::number(own.formula.clone(), dimension, written.span),
            });
        }
        Some(interval)
    }

    /// The parameter of the run that is declared here; None for a `let`.
    pub fn parameter(&mut self, index: usize) -> Option<Parameter> {
        let declared = &self.scope.values[index];
        let was_used = self.used.contains(&index);
        let typed = self.declared_value(index, declared.name.span);
        if !was_used {
            self.used.remove(&index);
        }
        let typed =
            typed.filter(|typed| declared.keyword == "param" && typed.shape == Shape::Number)?;
        Some(Parameter {
            name: declared.name.node.clone(),
            value: typed.constant()?,
            dimension: typed.dimension,
            set: declared.setting.is_some(),
        })
    }
}
