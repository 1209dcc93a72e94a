//! `limits`: ranges and bounds, the intersection of the plan's and the rig's limits, and targets that are known before the run.

use crate::check::checker::{Checker, Context, Typed};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{BeyondLimits, NeedsTheRun};
use crate::check::wording::shown;
use crate::codes::{E304, E401, E402, E602, E604};
use crate::syntax::ast::{Expr, ExprKind};
use psd_plan::formula::Formula;
use psd_plan::procedures::damping_sweep::block as damping_sweep;
use psd_plan::procedures::move_to::block as move_to;
use psd_plan::procedures::stiffness_ramp::block as stiffness_ramp;
use psd_plan::schema::limits;
use psd_plan::schema::procedures::SPEED;
use psd_plan::schema::{Field, FieldType, Kind};
use psd_plan::{Interval, Limits, Specimen};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// The limits of a run, with the span of the bound on each quantity.
pub struct CheckedLimits {
    pub limits: Limits,
    pub displacement_at: Option<Span>,
    pub force_at: Option<Span>,
    pub speed_at: Option<Span>,
}

#[derive(Violation)]
#[violation(E304, "expected a range, found one value")]
#[help("write both ends, as in `0 .. {text}`")]
struct RangeWanted<'a> {
    #[label("not a range")]
    span: Span,
    text: &'a str,
}

#[derive(Violation)]
#[violation(E402, "a range of allowed values has no step")]
#[help("remove `step`")]
struct StepInBounds {
    #[label("not allowed here")]
    span: Span,
}

#[derive(Violation)]
#[violation(E401, "range in reverse order: `{low}` is more than `{high}`")]
#[help("write `{high} .. {low}`")]
struct BoundsReversed<'a> {
    #[label("lower end must be first")]
    span: Span,
    low: &'a str,
    high: &'a str,
}

struct NegativeBound<'a> {
    field: &'a str,
    span: Span,
    text: &'a str,
    symmetric: bool,
}

impl Violation for NegativeBound<'_> {
    const CODE: Code = E401;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            field,
            span,
            text,
            symmetric,
        } = self;
        let help = if symmetric {
            "write both ends, as in `-2 mm .. 25 mm`, or one positive bound"
        } else {
            "write the absolute value"
        };
        Diagnostic::new(
            Self::CODE,
            format!("the bound on `{field}` must be at least 0"),
        )
        .at(span, format!("`{text}` is negative"))
        .help(help)
    }
}

/// A limit on the speed that allows none.
#[derive(Violation)]
#[violation(E401, "the bound on `{field}` must be greater than 0")]
#[help("{}", help)]
struct NoMotionAllowed<'a> {
    field: &'a str,
    help: &'a str,
    #[label("no motion possible")]
    span: Span,
}

#[derive(Violation)]
#[violation(E604, "the plan's limit on `{field}` exceeds the limit of the rig")]
#[help("write the limit of the rig, or remove it")]
struct LimitsWider<'a> {
    field: &'a str,
    #[label("plan: `{plan_text}`")]
    plan: Span,
    plan_text: &'a str,
    #[label("rig: `{rig_text}`")]
    rig: Span,
    rig_text: &'a str,
}

impl<'a> Checker<'a> {
    /// `a .. b`, known before the run, with its dimension.
    pub fn interval(
        &mut self,
        written: &'a Expr,
        context: Context,
    ) -> Option<(Interval, Dimension)> {
        if !matches!(written.kind, ExprKind::Range { .. }) {
            return match written.kind {
                ExprKind::Faulty => None,
                _ => self.fail(RangeWanted {
                    span: written.span,
                    text: self.text(written.span),
                }),
            };
        }
        let parts = self.range_parts(written, None, context)?;
        if let Some(step) = &parts.step {
            return self.fail(StepInBounds { span: step.span });
        }
        let (Some(low), Some(high)) = (parts.start.constant(), parts.end.constant()) else {
            return self.fail(NeedsTheRun {
                span: written.span,
                text: self.text(written.span),
            });
        };
        if low > high {
            return self.fail(BoundsReversed {
                span: written.span,
                low: self.text(parts.start.span),
                high: self.text(parts.end.span),
            });
        }
        // A range with no unit at either end is the one whose unit may have been forgotten.
        if parts.start.bare && parts.end.bare {
            return Some((Interval { low, high }, Dimension::NUMBER));
        }
        Some((Interval { low, high }, parts.start.dimension))
    }

    /// A range, or a bound `b`: −b .. b where both signs are meaningful, else 0 .. b.
    pub fn bounds(&mut self, block: usize, field: &'static str) -> Option<Interval> {
        let Some((entry, written)) = self.field(block, field) else {
            return Some(Interval::ALL);
        };
        let field = self.scope.blocks[block].kind.field(field)?;
        let context = self.context_of(block, entry);
        self.bounds_of(field, &written.value, context)
    }

    /// The same for an argument; `Some(None)` if it is omitted, None if it has an error.
    pub fn bounds_argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
        context: Context,
    ) -> Option<Option<Interval>> {
        match chosen.find(name)? {
            (field, Some(written)) => self.bounds_of(field, written, context).map(Some),
            (_, None) => Some(None),
        }
    }

    fn bounds_of(
        &mut self,
        field: &'static Field,
        written: &'a Expr,
        context: Context,
    ) -> Option<Interval> {
        let FieldType::Bounds {
            dimension,
            symmetric,
        } = field.ty
        else {
            return None;
        };
        if let ExprKind::Range { .. } = written.kind {
            let (interval, found) = self.interval(written, context)?;
            let bare = found == Dimension::NUMBER && dimension != Dimension::NUMBER;
            let typed = Typed {
                bare,
                ..Typed::number(Formula::Constant(interval.high), found, written.span)
            };
            self.expect(typed, dimension, field.name, written)?;
            return self.moves_at_all(field.name, interval, written.span);
        }
        let typed = self.single(written, context)?;
        let typed = self.expect(typed, dimension, field.name, written)?;
        let bound = typed.constant()?;
        if bound < 0.0 {
            return self.fail(NegativeBound {
                field: field.name,
                span: written.span,
                text: self.text(written.span),
                symmetric,
            });
        }
        let interval = Interval {
            low: if symmetric { -bound } else { 0.0 },
            high: bound,
        };
        self.moves_at_all(field.name, interval, written.span)
    }

    /// An actuator with a speed limit of zero never arrives; a displacement or force limit of zero stops a run at its first reading.
    fn moves_at_all(&mut self, field: &str, interval: Interval, span: Span) -> Option<Interval> {
        let nothing = interval.low >= 0.0 && interval.high <= 0.0;
        let help = match field {
            _ if !nothing => return Some(interval),
            _ if field == limits::SPEED.name => {
                "write the largest speed of the actuator, as in `10 mm/s`"
            }
            _ if field == limits::DISPLACEMENT.name => "write the travel, as in `-5 mm .. 60 mm`",
            _ if field == limits::FORCE.name => "write the largest force, as in `12 kN`",
            _ => return Some(interval),
        };
        self.fail(NoMotionAllowed { field, help, span })
    }

    /// Every `limits` block; the intersection of those without a name and the one that the rig names. A plan that asks for
    /// more than its rig allows is an error.
    pub fn limits(&mut self, rig_limits: Option<usize>) -> Option<CheckedLimits> {
        let blocks: Vec<usize> = self
            .scope
            .of_kind(Kind::Limits)
            .map(|(index, _)| index)
            .collect();
        let checked: Vec<Option<(usize, Limits)>> = blocks
            .into_iter()
            .map(|index| read(self, index).map(|limits| (index, limits)))
            .collect();
        let checked: Vec<(usize, Limits)> = checked.into_iter().collect::<Option<_>>()?;
        let rig = rig_limits
            .and_then(|rig| checked.iter().find(|(index, _)| *index == rig))
            .copied();
        let plan: Vec<(usize, Limits)> = checked
            .into_iter()
            .filter(|(index, _)| self.scope.blocks[*index].name.is_none())
            .collect();
        let mut all = Limits::NONE;
        let (mut displacement_at, mut force_at, mut speed_at) = (None, None, None);
        for (index, limits) in plan.iter().chain(&rig) {
            if let (Some((rig, allowed)), true) = (&rig, Some(*index) != rig_limits) {
                self.compare_limits(*index, limits, *rig, allowed);
            }
            all = intersection(&all, limits);
            displacement_at = self
                .field(*index, limits::DISPLACEMENT.name)
                .map(|(_, entry)| entry.span)
                .or(displacement_at);
            force_at = self
                .field(*index, limits::FORCE.name)
                .map(|(_, entry)| entry.span)
                .or(force_at);
            speed_at = self
                .field(*index, limits::SPEED.name)
                .map(|(_, entry)| entry.span)
                .or(speed_at);
        }
        Some(CheckedLimits {
            limits: all,
            displacement_at,
            force_at,
            speed_at,
        })
    }

    fn compare_limits(&mut self, plan: usize, wanted: &Limits, rig: usize, allowed: &Limits) {
        for ((field, wanted, _), (_, allowed, _)) in wanted.named().into_iter().zip(allowed.named())
        {
            let wider = wanted.is_bounded()
                && allowed.is_bounded()
                && (wanted.low < allowed.low || wanted.high > allowed.high);
            if let (true, Some((_, plan)), Some((_, rig))) =
                (wider, self.field(plan, field), self.field(rig, field))
            {
                let (plan_text, rig_text) = (self.text(plan.value.span), self.text(rig.value.span));
                self.report(LimitsWider {
                    field,
                    plan: plan.value.span,
                    plan_text,
                    rig: rig.value.span,
                    rig_text,
                });
            }
        }
    }
}

/// The limits of one block. All are read before one fails, so that all errors are reported at once.
fn read(checker: &mut Checker<'_>, block: usize) -> Option<Limits> {
    let mut bounds = |field: Field| checker.bounds(block, field.name);
    let displacement = bounds(limits::DISPLACEMENT);
    let force = bounds(limits::FORCE);
    let speed = bounds(limits::SPEED);
    let increment = bounds(limits::INCREMENT);
    let tracking_error = bounds(limits::TRACKING_ERROR);
    let energy_error = bounds(limits::ENERGY_ERROR);
    let tracking_energy_error = bounds(limits::TRACKING_ENERGY_ERROR);
    let nrms_error = bounds(limits::NRMS_ERROR);
    Some(Limits {
        displacement: displacement?,
        force: force?,
        speed: speed?,
        increment: increment?,
        tracking_error: tracking_error?,
        energy_error: energy_error?,
        tracking_energy_error: tracking_energy_error?,
        nrms_error: nrms_error?,
    })
}

fn intersection(one: &Limits, other: &Limits) -> Limits {
    Limits {
        displacement: one.displacement.intersection(other.displacement),
        force: one.force.intersection(other.force),
        speed: one.speed.intersection(other.speed),
        increment: one.increment.intersection(other.increment),
        tracking_error: one.tracking_error.intersection(other.tracking_error),
        energy_error: one.energy_error.intersection(other.energy_error),
        tracking_energy_error: one
            .tracking_energy_error
            .intersection(other.tracking_energy_error),
        nrms_error: one.nrms_error.intersection(other.nrms_error),
    }
}

/// Limits that stop a run before it begins.
struct StartBeyondLimits<'a> {
    name: &'a str,
    limit: Interval,
    dimension: Dimension,
    at: Span,
}

impl Violation for StartBeyondLimits<'_> {
    const CODE: Code = E602;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            limit,
            dimension,
            at,
        } = self;
        let (low, high) = (shown(limit.low, dimension), shown(limit.high, dimension));
        let (zero, wider) = if limit.low > 0.0 {
            ("0", format!("0 .. {high}"))
        } else {
            ("0", format!("{low} .. 0"))
        };
        Diagnostic::new(
            Self::CODE,
            format!("the start is outside the limits: {name} {zero}, limits {low} .. {high}"),
        )
        .at(at, "excludes the start")
        .help(format!("include the start: write `{name} = {wider}`"))
    }
}

/// A virtual rig begins at rest, with displacement and force 0: limits that exclude them stop it before it moves. The initial
/// position of a real rig is unknown here.
pub fn check_start(checker: &mut Checker, limits: &CheckedLimits) {
    if checker.real_rig.is_some() {
        return;
    }
    for (name, interval, dimension, at) in [
        (
            limits::DISPLACEMENT.name,
            limits.limits.displacement,
            Dimension::LENGTH,
            limits.displacement_at,
        ),
        (
            limits::FORCE.name,
            limits.limits.force,
            Dimension::FORCE,
            limits.force_at,
        ),
    ] {
        if let (Some(at), false) = (at, interval.contains(0.0)) {
            checker.report(StartBeyondLimits {
                name,
                limit: interval,
                dimension,
                at,
            });
        }
    }
}

/// Targets \[m\] at which a specimen with a constant stiffness has a force beyond the limits.
struct ForceBeyondLimits<'a> {
    field: &'a str,
    target: f64,
    force: f64,
    span: Span,
    limit: Interval,
    limit_at: Span,
}

impl Violation for ForceBeyondLimits<'_> {
    const CODE: Code = E602;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            field,
            target,
            force,
            span,
            limit,
            limit_at,
        } = self;
        let newtons = |value| shown(value, Dimension::FORCE);
        let (low, high) = (newtons(limit.low), newtons(limit.high));
        let target = shown(target, Dimension::LENGTH);
        Diagnostic::new(
            Self::CODE,
            format!(
                "`{field}` leads to {} at {target}, outside the limits {low} .. {high}",
                newtons(force)
            ),
        )
        .at(
            span,
            format!("{} by the specimen's stiffness", newtons(force)),
        )
        .at(limit_at, "limit")
        .help("stay within the limits, or widen them if the rig and the specimen allow it")
    }
}

/// Compares the forces of an elastic specimen on a virtual rig at the targets that are known before the run with the limits: they follow
/// from its stiffness. A real specimen has the force that it has.
pub fn check_forces(checker: &mut Checker, limits: &CheckedLimits, specimens: &[Option<Specimen>]) {
    let (Some(at), None) = (limits.force_at, checker.real_rig) else {
        return;
    };
    let interval = limits.limits.force;
    let procedures: Vec<usize> = checker.scope.procedures().map(|(index, _)| index).collect();
    for block in procedures {
        for field in [stiffness_ramp::DISPLACEMENTS.name, move_to::TO.name] {
            let Some((entry, written)) = checker.field(block, field) else {
                continue;
            };
            let span = written.value.span;
            let tested = checker.specimen_block(block);
            let specimen = tested.map(|tested| checker.scope.index_in_kind(tested));
            let specimen = specimen.and_then(|index| specimens.get(index)?.as_ref());
            let behaviour = specimen.and_then(|specimen| specimen.behaviour.as_ref());
            let Some(behaviour) = behaviour.filter(|behaviour| behaviour.is_elastic()) else {
                continue;
            };
            let stiffness = behaviour.initial_stiffness();
            let typed = checker.entry(block, entry, span);
            let targets = typed.map(|typed| typed.parts()).unwrap_or_default();
            let beyond = targets.iter().filter_map(Formula::constant);
            let beyond = beyond
                .into_iter()
                .find(|target| !interval.contains(stiffness * target));
            if let Some(target) = beyond {
                let force = stiffness * target;
                checker.report(ForceBeyondLimits {
                    field,
                    target,
                    force,
                    span,
                    limit: interval,
                    limit_at: at,
                });
            }
        }
    }
}

/// Relative error of the targets of a range.
const ROUNDING: f64 = 1e-9;

/// Compares targets \[m\] and speeds \[m/s\] of the procedures that are known before the run with the limits.
pub fn check_targets(checker: &mut Checker, limits: &CheckedLimits) {
    let procedures: Vec<usize> = checker.scope.procedures().map(|(index, _)| index).collect();
    for block in procedures {
        for (field, interval, at) in [
            (
                stiffness_ramp::DISPLACEMENTS.name,
                limits.limits.displacement,
                limits.displacement_at,
            ),
            (
                move_to::TO.name,
                limits.limits.displacement,
                limits.displacement_at,
            ),
            (
                damping_sweep::STROKE.name,
                limits.limits.displacement,
                limits.displacement_at,
            ),
            (SPEED.name, limits.limits.speed, limits.speed_at),
            (
                damping_sweep::VELOCITIES.name,
                limits.limits.speed,
                limits.speed_at,
            ),
        ] {
            let Some((entry, written)) = checker.field(block, field) else {
                continue;
            };
            let (Some(field), Some(at)) = (checker.scope.blocks[block].kind.field(field), at)
            else {
                continue;
            };
            // Limits that exclude the start are reported.
            let of_displacement = field.dimension() == Some(Dimension::LENGTH);
            if of_displacement && checker.real_rig.is_none() && !interval.contains(0.0) {
                continue;
            }
            let Some(typed) = checker.entry(block, entry, written.value.span) else {
                continue;
            };
            let values: Vec<f64> = typed.parts().iter().filter_map(Formula::constant).collect();
            // A target that is at the limit but for rounding is not the one to show.
            let slack = ROUNDING * interval.low.abs().max(interval.high.abs());
            let visibly =
                |value: &&f64| **value < interval.low - slack || **value > interval.high + slack;
            let beyond = values.iter().find(|value| !interval.contains(**value));
            let beyond = values.iter().find(visibly).or(beyond);
            if let Some(&value) = beyond {
                let diagnostic = BeyondLimits {
                    field: field.name,
                    value,
                    dimension: typed.dimension,
                    span: written.value.span,
                    limit: interval,
                    limit_at: at,
                }
                .diagnostic();
                checker.diagnostics.push(diagnostic);
            }
        }
    }
}
