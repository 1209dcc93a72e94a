//! `axis(axial: 1, …)`: an axis that loads a storey along its height, in force control. In: its arguments, and the frame on the rig. Out: an
//! [`AxialAxis`], or what is wrong. `axes` reads the list.

use super::device::Device;
use super::{CheckedRig, item_of};
use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::codes::{E614, E675, E676, E677};
use psd_plan::schema::{limits, rig as schema};
use psd_plan::{AxialAxis, Dialect, Interval, Part, Specimen, Storey};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

#[derive(Violation)]
#[violation(E675, "an axial axis requires `{argument}`")]
#[help("{}", help)]
struct AxialArgumentMissing {
    argument: &'static str,
    #[label("`{argument}` is missing")]
    axial: Span,
    help: &'static str,
}

#[derive(Violation)]
#[violation(E675, "`{argument}` has no effect on an axial axis")]
#[help("remove it")]
struct NotOfAnAxialAxis {
    argument: &'static str,
    #[label("not used")]
    at: Span,
    #[label("axial axis")]
    axial: Span,
}

#[derive(Violation)]
#[violation(E675, "`{argument}` applies to axial axes only")]
#[help("add `axial: 1` for the storey that the axis loads, or remove `{argument}`")]
struct OfAxialAxesOnly {
    argument: &'static str,
    #[label("not used")]
    at: Span,
}

#[derive(Violation)]
#[violation(
    E675,
    "an axial axis is listed before an axis that moves a storey sideways"
)]
#[help("list the axial axes last")]
struct AxialAxisFirst {
    #[label("axial axis")]
    at: Span,
}

#[derive(Violation)]
#[violation(
    E614,
    "`{argument}` of an axis applies to real rigs only, but this rig is virtual"
)]
#[help("remove it")]
struct ArgumentOfRealRigs {
    argument: &'static str,
    #[label("not used")]
    at: Span,
}

/// The arguments of an axis that a virtual rig reads.
const SIMULATED: [&str; 6] = [
    schema::AXIS_STOREY,
    schema::AXIAL,
    schema::CONTROL.name,
    schema::P_DELTA.name,
    limits::DISPLACEMENT.name,
    limits::FORCE.name,
];

/// The arguments that an axial axis does not have.
const NOT_AXIAL: [&str; 2] = [schema::AXIS_STOREY, schema::PRETEST_CHECK.name];

/// The axial part of an axis with these limits of its displacement \[m\]: `Some(None)` if it is none.
pub fn axial<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    band: Option<Interval>,
    context: Context,
) -> Option<Option<AxialAxis>> {
    let Some(axial) = chosen.span(schema::AXIAL) else {
        for argument in [schema::CONTROL.name, schema::P_DELTA.name] {
            if let Some(at) = chosen.span(argument) {
                return checker.fail(OfAxialAxesOnly { argument, at });
            }
        }
        return Some(None);
    };
    let storey = checker.constant_argument(chosen, schema::AXIAL, context);
    for argument in NOT_AXIAL {
        if let Some(at) = chosen.span(argument) {
            return checker.fail(NotOfAnAxialAxis {
                argument,
                at,
                axial,
            });
        }
    }
    let is_band = |band: Interval| band.low.is_finite() && band.high.is_finite();
    let required = [
        (
            chosen.span(schema::CONTROL.name).is_some(),
            schema::CONTROL.name,
            "add `control: force(rate: 5 kN/s, tolerance: 0.5 kN)`",
        ),
        (
            chosen.span(schema::P_DELTA.name).is_some(),
            schema::P_DELTA.name,
            "add `p_delta: 100 %` if the load stays vertical, or `p_delta: 0 %` if it points at the base of the column",
        ),
        (
            band.is_some_and(is_band),
            limits::DISPLACEMENT.name,
            "add the band that the axis must not leave, such as `displacement: -4 mm .. 4 mm`",
        ),
    ];
    for (is_given, argument, help) in required {
        if !is_given {
            return checker.fail(AxialArgumentMissing {
                argument,
                axial,
                help,
            });
        }
    }
    let p_delta = checker.constant_argument(chosen, schema::P_DELTA.name, context);
    let control = checker.chosen_argument(chosen, schema::CONTROL.name)?;
    let mut number = |name: &str| checker.constant_argument(&control, name, context);
    let (rate, tolerance) = (
        number(schema::CONTROL_RATE.name),
        number(schema::CONTROL_TOLERANCE.name),
    );
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count from 1 to 64"
    )]
    let storey = storey? as usize - 1;
    Some(Some(AxialAxis {
        storey,
        rate: rate?,
        tolerance: tolerance?,
        p_delta: p_delta?,
    }))
}

/// Refuses arguments that a virtual rig does not read.
pub fn simulated(checker: &mut Checker, chosen: &Chosen<'_>) {
    let is_axial = chosen.span(schema::AXIAL).is_some();
    for argument in chosen.variant.arguments {
        let is_refused = is_axial && NOT_AXIAL.contains(&argument.name);
        if let Some(at) = chosen.span(argument.name)
            && !SIMULATED.contains(&argument.name)
            && !is_refused
        {
            let argument = argument.name;
            checker.report(ArgumentOfRealRigs { argument, at });
        }
    }
}

/// The axial axes are behind all others, as guard and run log have them.
pub fn check_order(checker: &mut Checker, block: usize, is_axial: &[bool]) -> Option<()> {
    let first = is_axial.iter().position(|is_axial| *is_axial);
    let Some(first) = first else { return Some(()) };
    if is_axial[first..].iter().all(|is_axial| *is_axial) {
        return Some(());
    }
    let at = item_of(checker, block, first)?;
    checker.fail(AxialAxisFirst { at })
}

#[derive(Violation)]
#[violation(E677, "`{}` cannot hold an axial force: {reason}", dialect.name())]
#[help("use a `native` controller with `FORCE`, or a virtual rig")]
struct NoForceControl<'a> {
    dialect: &'a Dialect,
    reason: &'static str,
    #[label("moves the axial axis")]
    at: Span,
}

/// The controllers of axial axes must hold the displacement themselves when they leave force control.
pub fn check_controllers<'a>(
    checker: &mut Checker,
    controllers: impl Iterator<Item = &'a Device>,
) -> Option<()> {
    for device in controllers {
        if let Some(reason) = device.link.dialect.no_force_control() {
            return checker.fail(NoForceControl {
                dialect: &device.link.dialect,
                reason,
                at: device.dialect_at,
            });
        }
    }
    Some(())
}

#[derive(Violation)]
#[violation(E676, "no axial load on storey {storey}: {problem}")]
#[help("{}", help)]
struct UnfitStorey {
    storey: usize,
    problem: String,
    #[label("loads storey {storey}")]
    at: Span,
    help: &'static str,
}

/// Whether the storeys of the axial axes can have an axial load. In: the frame on the rig.
pub fn check_storeys(checker: &mut Checker, rig: &CheckedRig, specimen: &Specimen) {
    let Some(block) = rig.block else { return };
    let axes = rig.plan.listed_axes();
    let mut seen = Vec::new();
    for (index, axis) in axes.iter().enumerate() {
        let Some(axial) = axis.axial else { continue };
        let storeys = specimen
            .frame
            .as_ref()
            .map_or(&[][..], |frame| &frame.storeys);
        let found = if seen.contains(&axial.storey) {
            Some((
                "two axes load it".to_owned(),
                "remove one of the axial axes",
            ))
        } else {
            unfit(storeys, axial.storey, &specimen.name)
        };
        seen.push(axial.storey);
        if let (Some((problem, help)), Some(at)) = (found, item_of(checker, block, index)) {
            checker.report(UnfitStorey {
                storey: axial.storey + 1,
                problem,
                at,
                help,
            });
            return;
        }
    }
}

/// Why a storey has no axial load on the rig, with the help.
fn unfit(storeys: &[Storey], storey: usize, specimen: &str) -> Option<(String, &'static str)> {
    if storeys.is_empty() {
        let problem = format!("specimen `{specimen}` has no storeys");
        return Some((
            problem,
            "write the specimen with `storeys = [storey(…)]`, also a single column",
        ));
    }
    let Some(storey) = storeys.get(storey) else {
        let problem = format!("frame `{specimen}` has no such storey");
        return Some((problem, "name a tested storey"));
    };
    let scale = match storey.part {
        Part::Tested { scale, .. } => scale,
        Part::Computed => {
            return Some((
                "it is computed".to_owned(),
                "name a tested storey, or write `part: tested` in this one",
            ));
        }
    };
    if storey.height.is_none() {
        return Some((
            "it has no `height`".to_owned(),
            "add `height: 3 m` to the storey: the P-Δ is N u over the height",
        ));
    }
    // Stresses are preserved: forces have the square of the scale of lengths.
    let of_lengths = scale.displacement * scale.displacement;
    ((scale.force - of_lengths).abs() > 1e-9 * of_lengths).then(|| {
        (
            "its scale has two numbers, which leave the height on the rig open".to_owned(),
            "write the scale as one number, as in `scale: 1 / 2`",
        )
    })
}
