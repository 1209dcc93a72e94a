//! An input as a study names it: `impact_speed`, `beam.mass`. In: the expression. Out: its position, dimension and value in the plan.

use crate::check::checker::{Checker, Shape};
use crate::check::expressions::overrides::{self, InputLocation, no_input};
use crate::check::rig;
use crate::check::violations::InputWanted;
use crate::codes::{E656, E665};
use crate::syntax::ast::{Expr, ExprKind};
use psd_plan::formula::ResultReference;
use psd_plan::schema::ground::RECORD_NUMBER;
use psd_plan::schema::{Field, FieldType, Kind, RigKind};
use psd_plan::study::Input;
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

/// An input as a study names it.
pub(super) struct Target<'a> {
    pub name: String,
    /// The name.
    pub span: Span,
    pub location: InputLocation<'a>,
    pub dimension: Dimension,
    /// The value of the plan without the study, SI; NaN for a result, which has it in a run.
    pub nominal: f64,
}

impl Target<'_> {
    /// The input with its distribution as text.
    pub(super) fn input(&self, text: String) -> Input {
        Input {
            name: self.name.clone(),
            dimension: self.dimension,
            text,
            nominal: self.nominal,
            is_record: self.is_record(),
        }
    }

    /// Whether it is the number of a ground-motion record.
    pub(super) fn is_record(&self) -> bool {
        matches!(self.location, InputLocation::Field { field, .. } if field.name == RECORD_NUMBER.name)
    }

    /// The result that it is, of a procedure.
    pub(super) fn result(&self) -> Option<ResultReference> {
        match self.location {
            InputLocation::Result { reference, .. } => Some(reference),
            InputLocation::Parameter(_) | InputLocation::Field { .. } => None,
        }
    }
}

/// The words of `beam.behaviour.stiffness`; None for anything else.
pub(super) fn path_of(written: &Expr) -> Option<Vec<&str>> {
    match &written.kind {
        ExprKind::Name(name) => Some(vec![name]),
        ExprKind::Field { base, name } => {
            let mut path = path_of(base)?;
            path.push(&name.node);
            Some(path)
        }
        _ => None,
    }
}

/// A number that a study cannot vary, for another reason than its name.
#[derive(Violation)]
#[violation(E656, "`{name}` {why}")]
#[help("{}", help)]
struct CannotVary<'a> {
    name: &'a str,
    why: &'a str,
    #[label("cannot be varied")]
    span: Span,
    help: &'a str,
}

/// The input that an expression names.
pub(super) fn target<'a>(checker: &mut Checker<'a>, written: &'a Expr) -> Option<Target<'a>> {
    let span = written.span;
    let Some(path) = path_of(written) else {
        return match written.kind {
            ExprKind::Faulty => None,
            _ => checker.fail(InputWanted {
                text: checker.text(span),
                span,
            }),
        };
    };
    let name = path.join(".");
    let location = match overrides::find_input(checker.scope, &path) {
        Ok(location) => location,
        Err(_) if checker.may_be_lost(path[0]) => return None,
        Err(reason) => {
            checker.diagnostics.extend(no_input(&reason, span));
            return None;
        }
    };
    let (dimension, nominal) = match location {
        InputLocation::Parameter(index) => of_parameter(checker, index)?,
        InputLocation::Result { dimension, .. } => (dimension, f64::NAN),
        InputLocation::Field {
            block,
            entry,
            field,
            written,
        } => {
            refuse(checker, &name, block, field, span)?;
            let context = checker.context_of(block, entry);
            // An error of the value is reported where the block is read.
            let before = checker.diagnostics.len();
            let typed = checker.typed_field(field, written, context);
            checker.diagnostics.truncate(before);
            let typed = typed?;
            if typed.shape == Shape::List {
                let help = "write a `param`, use it in the list, and name it here";
                return checker.fail(CannotVary {
                    name: &name,
                    why: "is a list",
                    span,
                    help,
                });
            }
            let Some(nominal) = typed.constant() else {
                return checker.fail(CannotVary {
                    name: &name,
                    why: "is known only in the run",
                    span,
                    help: "vary the inputs from which it is calculated",
                });
            };
            (typed.dimension, nominal)
        }
    };
    Some(Target {
        name,
        span,
        location,
        dimension,
        nominal,
    })
}

fn of_parameter(checker: &mut Checker, index: usize) -> Option<(Dimension, f64)> {
    let declared = &checker.scope.values[index];
    // A parameter that only a study names has no effect on a run.
    let was_used = checker.used.contains(&index);
    let typed = checker.declared_value(index, declared.name.span);
    if !was_used {
        checker.used.remove(&index);
    }
    let typed = typed.filter(|typed| typed.shape == Shape::Number)?;
    Some((typed.dimension, typed.constant()?))
}

/// A value of a rig that moves a specimen.
#[derive(Violation)]
#[violation(E665, "`{name}` belongs to a real rig, and a study is simulated")]
#[help("remove it, or vary a field of a virtual rig")]
struct InputOfARealRig<'a> {
    name: &'a str,
    #[label("no effect in a study")]
    span: Span,
}

/// Fields that a simulated run does not scatter.
fn refuse(
    checker: &mut Checker,
    name: &str,
    block: usize,
    field: &'static Field,
    span: Span,
) -> Option<()> {
    if matches!(field.ty, FieldType::Count) && field.name != RECORD_NUMBER.name {
        let help = "vary a number that is not a count";
        return checker.fail(CannotVary {
            name,
            why: "is a whole number",
            span,
            help,
        });
    }
    match checker.scope.blocks[block].kind.kind {
        Kind::Study | Kind::Fragility => checker.fail(CannotVary {
            name,
            why: "describes a study, not a run",
            span,
            help: "vary a field of a specimen, a striker, a ground motion or a procedure",
        }),
        Kind::Rig if rig::kind(checker, block) == Some(RigKind::Real) => {
            checker.fail(InputOfARealRig { name, span })
        }
        _ => Some(()),
    }
}
