//! Warnings of a real rig whose results would not be reliable: calibrations, resolution, the probe, devices without a serial number. In: the
//! checked rig of a run. Out: warnings. It opens no port.

use super::CheckedRig;
use crate::check::checker::Checker;
use crate::check::messages::rigs as message;
use crate::syntax::ast::{Expr, ExprKind};
use psd_plan::schema::rig as schema;
use psd_plan::{Calibration, DeviceLink, Dialect, PretestCheck, Specimen};
use psd_text::source::Span;

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
        checker
            .diagnostics
            .push(message::not_issuable(&rig.plan.name, head, reference, due));
    }
    let dues = calibrations
        .iter()
        .flat_map(|calibration| [calibration.due.as_ref(), displacement_due(calibration)]);
    let due = dues.flatten().min();
    if let Some((due, today)) = due.zip(today).filter(|(due, today)| due.as_str() < *today) {
        let at = checker.value_or_head(block, schema::CALIBRATION_DUE.name);
        checker
            .diagnostics
            .push(message::calibration_overdue(&rig.plan.name, due, today, at));
    }
    let no_day = |calibration: &Calibration| matches!(calibration.displacement, Some((_, None)));
    let of_rig = checker
        .field(block, schema::DISPLACEMENT_CALIBRATION.name)
        .or_else(|| checker.field(block, schema::AXES.name));
    if let (true, Some((_, entry))) = (calibrations.iter().any(no_day), of_rig) {
        checker.diagnostics.push(message::displacement_without_day(
            &rig.plan.name,
            entry.value.span,
        ));
    }
    if axes
        .clone()
        .any(|axis| link.readings_of(axis).resolution == 0.0)
    {
        let at = checker.value_or_head(block, schema::RESOLUTION.name);
        checker
            .diagnostics
            .push(message::resolution_unknown(&rig.plan.name, at));
    }
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
        checker
            .diagnostics
            .push(message::band_within_resolution(band, coarsest, at));
    }
    let excluded = excluded(specimens, &link.pretest_check_of(0));
    let drowned = axes
        .clone()
        .filter(|_| excluded.is_none())
        .map(|axis| (link.pretest_check_of(axis), link.readings_of(axis).noise))
        .find(|(pretest_check, noise)| {
            // A value that is ten times as large in the plan must be ten times as large here.
            pretest_check.probe.abs() * pretest_check.stiffness.low
                < message::CHECK_OVER_NOISE * noise * (1.0 - 1e-9)
        });
    let given = checker
        .field(block, schema::PRETEST_CHECK.name)
        .or_else(|| checker.field(block, schema::AXES.name));
    if let (Some(stiffness), Some((_, entry))) = (excluded, given) {
        let window = link.pretest_check_of(0).stiffness;
        checker.diagnostics.push(message::window_excludes(
            window,
            stiffness,
            entry.value.span,
        ));
    }
    if let (Some((pretest_check, noise)), Some((_, entry))) = (drowned, given) {
        checker.diagnostics.push(message::check_within_noise(
            &pretest_check,
            noise,
            entry.value.span,
        ));
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
            checker.diagnostics.push(message::device_not_pinned(
                field,
                "",
                &device.port,
                entry.value.span,
            ));
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
                checker.diagnostics.push(message::device_not_pinned(
                    field,
                    &format!(" of axis {}", axis + 1),
                    &device.port,
                    at,
                ));
            }
        }
    }
}

/// The stated stiffness \[N/m\] of the one specimen of the plan, of one degree of freedom, if the window of the pre-test check excludes it.
fn excluded(specimens: &[Option<Specimen>], check: &PretestCheck) -> Option<f64> {
    let [Some(specimen)] = specimens else {
        return None;
    };
    let behaviour = specimen
        .behaviour
        .as_ref()
        .filter(|_| specimen.frame.is_none())?;
    let stiffness = behaviour.initial_stiffness();
    (stiffness.is_finite() && !check.stiffness.contains(stiffness)).then_some(stiffness)
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
