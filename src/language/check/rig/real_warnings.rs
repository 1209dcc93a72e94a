//! Warnings of a real rig whose results would not be reliable: calibrations, resolution, the probe, devices without a serial number. In: the
//! checked rig of a run. Out: warnings. It opens no port.

use std::ops::Range;

use crate::check::checker::Checker;
use crate::check::wording::shown;
use crate::codes::{W707, W708, W711, W727, W734, W735};
use crate::syntax::ast::{Expr, ExprKind};
use psd_physics::structure::assemblies::stiffness_on_the_rig;
use psd_plan::schema::rig as schema;
use psd_plan::{Calibration, DeviceLink, Dialect, Interval, PortPlan, PretestCheck, Specimen};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::CheckedRig;

struct NotIssuable<'a> {
    rig: &'a str,
    head: Span,
    reference: bool,
    due: bool,
}

impl Violation for NotIssuable<'_> {
    const CODE: Code = W707;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            rig,
            head,
            reference,
            due,
        } = self;
        let (field, line) = if reference {
            (schema::CALIBRATION.name, "calibration = \"UKAS 4711\"")
        } else {
            (
                schema::CALIBRATION_DUE.name,
                "calibration_due = \"2027-03-01\"",
            )
        };
        let lacks = if reference && due {
            "`calibration` or `calibration_due`".to_owned()
        } else {
            format!("`{field}`")
        };
        let lines = if reference && due {
            format!("{line}\ncalibration_due = \"2027-03-01\"")
        } else {
            line.to_owned()
        };
        Diagnostic::new(
            Self::CODE,
            format!("test reports of rig `{rig}` cannot be issued: {lacks} missing"),
        )
        .at(head, "calibration data missing")
        .help(format!("add to the rig\n{lines}"))
    }
}

#[derive(Violation)]
#[violation(
    W707,
    "test reports of rig `{rig}` cannot be issued: its calibration was due on {due} (today: {today})"
)]
#[help("calibrate the rig before the test, then write the new due date")]
struct CalibrationOverdue<'a> {
    rig: &'a str,
    due: &'a str,
    today: &'a str,
    #[label("overdue")]
    at: Span,
}

#[derive(Violation)]
#[violation(
    W707,
    "test reports of rig `{rig}` cannot be issued: `displacement_calibration_due` is missing"
)]
#[help("add to the rig\ndisplacement_calibration_due = \"2027-03-01\"")]
struct DisplacementWithoutDay<'a> {
    rig: &'a str,
    #[label("due date missing")]
    at: Span,
}

#[derive(Violation)]
#[violation(
    W711,
    "a quiet load cell may be reported as frozen: rig `{rig}` has no displacement resolution"
)]
#[help("add to the rig, from the transducer's data sheet\nresolution = 1 um")]
struct ResolutionUnknown<'a> {
    rig: &'a str,
    #[label("0 mm by default")]
    at: Span,
}

/// A settling band \[m\] that readings of this resolution \[m\] may never show.
struct BandWithinResolution {
    band: f64,
    resolution: f64,
    at: Span,
}

impl Violation for BandWithinResolution {
    const CODE: Code = W734;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            band,
            resolution,
            at,
        } = self;
        let show = |value| shown(value, Dimension::LENGTH);
        Diagnostic::new(
            Self::CODE,
            format!(
                "a move may never settle: band {} is below the resolution of {}",
                show(band),
                show(resolution)
            ),
        )
        .at(at, "band within the resolution")
        .help(format!(
            "write a band of at least {}",
            show(2.0 * resolution)
        ))
    }
}

/// Least ratio of the force of a probe to the noise of a reading.
const CHECK_OVER_NOISE: f64 = 10.0;

/// A pre-test check that refuses the stiffness \[N/m\] that the plan states.
struct WindowExcludes {
    /// ` of axis 2`, if the rig has several.
    of: String,
    window: Interval,
    stiffness: f64,
    at: Span,
}

impl Violation for WindowExcludes {
    const CODE: Code = W735;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            of,
            window,
            stiffness,
            at,
        } = self;
        let show = |value| shown(value, Dimension::STIFFNESS);
        let (low, high) = (show(window.low), show(window.high));
        // A unit that is a thousand times too small or too large.
        let meant = [1e3, 1e-3].into_iter().find(|factor| {
            let window = Interval {
                low: window.low * factor,
                high: window.high * factor,
            };
            window.contains(stiffness)
        });
        let help = match meant {
            Some(factor) => format!(
                "write `{} .. {}`: the unit of the window is not that of the specimen",
                show(window.low * factor),
                show(window.high * factor)
            ),
            None => format!(
                "write a window around {}, or correct the `behaviour`",
                show(stiffness)
            ),
        };
        Diagnostic::new(
        Self::CODE,
        format!(
            "pre-test check{of} will refuse the specimen: its stiffness {} is outside {low} .. {high}",
            show(stiffness)
        ),
    )
    .at(at, "excludes the stated stiffness")
    .help(help)
    }
}

/// A probe whose force on the softest acceptable specimen is too small compared with the noise of a reading \[N\].
struct CheckWithinNoise<'a> {
    pretest_check: &'a PretestCheck,
    noise: f64,
    at: Span,
}

impl Violation for CheckWithinNoise<'_> {
    const CODE: Code = W727;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            pretest_check,
            noise,
            at,
        } = self;
        let (probe, softest) = (pretest_check.probe.abs(), pretest_check.stiffness.low);
        // Two digits, rounded up.
        let least = CHECK_OVER_NOISE * noise / softest;
        let digit = 10f64.powf(least.log10().floor() - 1.0);
        let least = (least / digit * (1.0 - 1e-9)).ceil() * digit;
        Diagnostic::new(
            Self::CODE,
            format!(
                "pre-test check may fail by chance: a probe of {} is too small for the noise",
                shown(probe, Dimension::LENGTH)
            ),
        )
        .at(
            at,
            format!(
                "{} at {}, noise of one reading is {}",
                shown(probe * softest, Dimension::FORCE),
                shown(softest, Dimension::STIFFNESS),
                shown(noise, Dimension::FORCE)
            ),
        )
        .help(format!(
            "write at least {}: ten times the noise",
            shown(least, Dimension::LENGTH)
        ))
    }
}

/// `of`: ` of axis 2`, if it belongs to one axis.
#[derive(Violation)]
#[violation(W708, "`{field}`{of} accepts any device on `{}`", port.to_string().escape_debug())]
#[help("write the serial number of the device, as in\nserial_number: \"PSD-0001\"")]
struct DeviceNotPinned<'a> {
    field: &'a str,
    of: &'a str,
    port: &'a PortPlan,
    #[label("no `serial_number`")]
    span: Span,
}

/// Warnings for the real rig of a run whose results would not be reliable. Due dates are compared with `today`, if it is known.
pub fn warn(
    checker: &mut Checker,
    rig: &CheckedRig,
    specimens: &[Option<Specimen>],
    today: Option<&str>,
) {
    let (Some(block), Some(link)) = (rig.block, rig.plan.link.as_real()) else {
        return;
    };
    let head = checker.scope.blocks[block].block.head;
    let axes = 0..rig.plan.axes().unwrap_or(1);
    let calibrations: Vec<Calibration> = axes
        .clone()
        .map(|axis| rig.plan.calibration_of(axis))
        .collect();
    let lacks = |of: fn(&Calibration) -> &Option<String>| {
        calibrations
            .iter()
            .any(|calibration| of(calibration).is_none())
    };
    let (reference, due) = (
        lacks(|calibration| &calibration.reference),
        lacks(|calibration| &calibration.due),
    );
    if reference || due {
        checker.report(NotIssuable {
            rig: &rig.plan.name,
            head,
            reference,
            due,
        });
    }
    let dues = calibrations
        .iter()
        .flat_map(|calibration| [calibration.due.as_ref(), displacement_due(calibration)]);
    let due = dues.flatten().min();
    if let Some((due, today)) = due.zip(today).filter(|(due, today)| due.as_str() < *today) {
        let at = checker.value_or_head(block, schema::CALIBRATION_DUE.name);
        checker.report(CalibrationOverdue {
            rig: &rig.plan.name,
            due,
            today,
            at,
        });
    }
    let no_day = |calibration: &Calibration| matches!(calibration.displacement, Some((_, None)));
    let of_rig = checker
        .field(block, schema::DISPLACEMENT_CALIBRATION.name)
        .or_else(|| checker.field(block, schema::AXES.name));
    if let (true, Some((_, entry))) = (calibrations.iter().any(no_day), of_rig) {
        checker.report(DisplacementWithoutDay {
            rig: &rig.plan.name,
            at: entry.value.span,
        });
    }
    if axes
        .clone()
        .any(|axis| link.readings_of(axis).resolution == 0.0)
    {
        let at = checker.value_or_head(block, schema::RESOLUTION.name);
        checker.report(ResolutionUnknown {
            rig: &rig.plan.name,
            at,
        });
    }
    // Neither band nor pre-test check are those of an axial axis.
    let axes = 0..link.lateral_axes();
    let coarsest = axes
        .clone()
        .map(|axis| link.readings_of(axis).resolution)
        .fold(0.0, f64::max);
    let band = rig.plan.settle.band;
    if let (true, Some((_, entry))) = (
        band < coarsest * (1.0 - 1e-9),
        checker.field(block, schema::SETTLE.name),
    ) {
        let at = entry.value.span;
        checker.report(BandWithinResolution {
            band,
            resolution: coarsest,
            at,
        });
    }
    let window = |axis: usize| link.pretest_check_of(axis).stiffness;
    let excluded = excluded(specimens, axes.clone(), &window);
    let drowned = axes
        .clone()
        .filter(|_| excluded.is_none())
        .map(|axis| (link.pretest_check_of(axis), link.readings_of(axis).noise))
        .find(|(pretest_check, noise)| {
            // A value that is ten times as large in the plan must be ten times as large here.
            pretest_check.probe.abs() * pretest_check.stiffness.low
                < CHECK_OVER_NOISE * noise * (1.0 - 1e-9)
        });
    let given = checker
        .field(block, schema::PRETEST_CHECK.name)
        .or_else(|| checker.field(block, schema::AXES.name));
    if let (Some((axis, stiffness)), Some((_, entry))) = (excluded, given) {
        let of = match axes.len() {
            1 => String::new(),
            _ => format!(" of axis {}", axis + 1),
        };
        checker.report(WindowExcludes {
            of,
            window: window(axis),
            stiffness,
            at: entry.value.span,
        });
    }
    if let (Some((pretest_check, noise)), Some((_, entry))) = (drowned, given) {
        checker.report(CheckWithinNoise {
            pretest_check: &pretest_check,
            noise,
            at: entry.value.span,
        });
    }
    let unpinned =
        |device: &DeviceLink| device.dialect == Dialect::Native && device.serial_number.is_none();
    let fields = if checker.field(block, schema::LINK.name).is_some() {
        [schema::LINK.name, schema::LOAD_CELL.name]
    } else {
        [schema::ACTUATOR.name, schema::LOAD_CELL.name]
    };
    for (field, device) in fields
        .into_iter()
        .zip([Some(&link.actuator), link.load_cell.as_ref()])
    {
        if let (Some(device), Some((_, entry))) = (device, checker.field(block, field))
            && unpinned(device)
        {
            checker.report(DeviceNotPinned {
                field,
                of: "",
                port: &device.port,
                span: entry.value.span,
            });
        }
    }
    let Some((_, written)) = checker.field(block, schema::AXES.name) else {
        return;
    };
    for (axis, own) in link.axes.iter().enumerate() {
        for (field, device) in [
            (schema::ACTUATOR.name, &own.actuator),
            (schema::LOAD_CELL.name, &own.load_cell),
        ] {
            if let Some(device) = device.as_ref().filter(|device| unpinned(device)) {
                let at = own_device_at(&written.value, axis, field);
                checker.report(DeviceNotPinned {
                    field,
                    of: &format!(" of axis {}", axis + 1),
                    port: &device.port,
                    span: at,
                });
            }
        }
    }
}

/// The axis of which the window of the pre-test check excludes the stated stiffness of the one specimen of the plan, with that stiffness
/// in numbers of the rig \[N/m\]. Each axis is moved alone, so that the stiffness is one of the diagonal.
fn excluded(
    specimens: &[Option<Specimen>],
    mut axes: Range<usize>,
    window: &dyn Fn(usize) -> Interval,
) -> Option<(usize, f64)> {
    let [Some(specimen)] = specimens else {
        return None;
    };
    let stiffness = match (&specimen.frame, &specimen.behaviour) {
        (Some(frame), _) => stiffness_on_the_rig(frame),
        (None, Some(behaviour)) => vec![vec![behaviour.initial_stiffness()]],
        (None, None) => return None,
    };
    axes.find_map(|axis| {
        let stiffness = *stiffness.get(axis)?.get(axis)?;
        let is_excluded = stiffness.is_finite() && !window(axis).contains(stiffness);
        is_excluded.then_some((axis, stiffness))
    })
}

fn displacement_due(calibration: &Calibration) -> Option<&String> {
    calibration.displacement.as_ref()?.1.as_ref()
}

/// The span of a separate device of an axis; the span of the list of axes, if that is unclear.
fn own_device_at(axes: &Expr, axis: usize, field: &str) -> Span {
    let written = match &axes.kind {
        ExprKind::List { items, .. } => items.get(axis),
        _ => Some(axes),
    };
    let named = written.and_then(|written| match &written.kind {
        ExprKind::Call { arguments, .. } => arguments.iter().find(|argument| {
            argument
                .name
                .as_ref()
                .is_some_and(|name| name.node == field)
        }),
        _ => None,
    });
    named.map_or(axes.span, |argument| argument.value.span)
}
