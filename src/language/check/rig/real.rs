//! A rig that moves a real specimen: its devices fit together, and nothing is missing that keeps a specimen safe. In: the
//! block of a rig, the limits of the run. Out: a [`RealLink`]. It opens no port.

use super::axes::{self, CheckedAxis};
use super::axis_devices;
use super::device::{Device, device};
use super::{CheckedRig, kind, place_of};
use crate::language::check::checker::{Checker, Place};
use crate::language::check::declarations::limits::CheckedLimits;
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::expressions::fields::whole as whole_number;
use crate::language::check::messages::rigs as fault;
use crate::language::check::messages::{values, whole};
use crate::language::syntax::ast::{Argument, Expr, ExprKind};
use crate::plan::{
    Calibration, Datum, DeviceLink, Dialect, Gate, Interval, Link, ReadingRules, RealLink,
    SafeState,
};
use crate::schema::{Field, Kind, Need, RigKind};
use crate::text::source::Span;
use crate::units::Dimension;

/// A request is sent after 0, T, 3T and given up after 7T.
const PATIENCE: f64 = 7.0;

/// Who runs the test on a real rig has a name: what moves the specimen is somebody's act.
pub fn attended(checker: &mut Checker, particulars: &[(&'static str, String)]) {
    let named = particulars
        .iter()
        .any(|(field, name)| *field == "operator" && !name.trim().is_empty());
    if let Some(block) = checker.real_rig.filter(|_| !named) {
        let declared = &checker.scope.blocks[block];
        let at = declared.name.map_or(declared.block.head, |name| name.span);
        checker.faults.push(fault::nobody_named(at));
    }
}

/// What a real rig says; None where something of it is faulty or missing, which [`complete`] says.
pub fn real_link(checker: &mut Checker, block: usize) -> Option<RealLink> {
    let safe_state = checker
        .choice(block, "safe_state")
        .map(|chosen| chosen.variant.name);
    let datum = checker.word(block, "datum", "machine");
    let axes = axes::axes(checker, block);
    let devices = devices(checker, block, axes.as_deref().unwrap_or_default());
    let gate = gate(checker, block, axes.as_deref().unwrap_or_default());
    let readings = readings(checker, block);
    let watchdog = checker.constant(block, "watchdog");
    let own_speed = checker.constant(block, "speed");
    let (actuator, load_cell) = devices?;
    if let Some(watchdog) = watchdog {
        let own = axes
            .iter()
            .flatten()
            .flat_map(|axis| [axis.actuator.as_ref(), axis.load_cell.as_ref()]);
        hold_watchdog(
            checker,
            block,
            watchdog,
            [Some(&actuator), load_cell.as_ref()]
                .into_iter()
                .chain(own)
                .flatten(),
        )?;
    }
    let axes = axes?;
    axis_devices::hold(checker, block, &actuator, load_cell.as_ref(), &axes)?;
    Some(RealLink {
        actuator: actuator.link,
        load_cell: load_cell.map(|device| device.link),
        safe_state: if safe_state? == "unload" {
            SafeState::Unload
        } else {
            SafeState::Hold
        },
        datum: if datum? == "here" {
            Datum::Here
        } else {
            Datum::Machine
        },
        gate: gate?,
        readings: readings?,
        watchdog: watchdog?,
        own_speed: own_speed?,
        axes: axes.into_iter().map(|axis| axis.plan).collect(),
    })
}

/// The device that moves, and the one that weighs where it is another.
fn devices(
    checker: &mut Checker,
    block: usize,
    axes: &[CheckedAxis],
) -> Option<(Device, Option<Device>)> {
    let key = |checker: &Checker, field: &str| {
        checker.given(block, field).map(|(_, entry)| entry.key.span)
    };
    let (link, actuator, load_cell) = (
        key(checker, "link"),
        key(checker, "actuator"),
        key(checker, "load_cell"),
    );
    if let (Some(link), Some((field, other))) = (
        link,
        actuator
            .map(|at| ("actuator", at))
            .or(load_cell.map(|at| ("load_cell", at))),
    ) {
        return checker.fail(fault::link_and_device(link, field, other));
    }
    if let (None, Some(at)) = (actuator, load_cell)
        && !checker.misspelt(block, &["actuator"])
    {
        return checker.fail(fault::load_cell_alone(at));
    }
    let field = if link.is_some() { "link" } else { "actuator" };
    let moving = device_of(checker, block, field);
    let weighing = match load_cell {
        Some(_) => device_of(checker, block, "load_cell").map(Some),
        None => Some(None),
    };
    let (moving, weighing) = (moving?, weighing?);
    fit(checker, block, field, &moving, weighing.as_ref(), axes)?;
    Some((moving, weighing))
}

fn device_of(checker: &mut Checker, block: usize, field: &str) -> Option<Device> {
    let (_, entry) = checker.given(block, field)?;
    let (at, place) = (entry.value.span, place_of(checker, block, field)?);
    let chosen = checker.choice(block, field)?;
    device(checker, &chosen, at, place)
}

/// One moves, one weighs, and counts have a worth.
fn fit(
    checker: &mut Checker,
    block: usize,
    field: &str,
    moving: &Device,
    weighing: Option<&Device>,
    axes: &[CheckedAxis],
) -> Option<()> {
    if !moving.link.dialect.moves() {
        return checker.fail(fault::cannot_move(
            field,
            &moving.link.dialect,
            moving.dialect_at,
        ));
    }
    let cell = weighing.unwrap_or(moving);
    let all_apart = !axes.is_empty() && axes.iter().all(|axis| axis.load_cell.is_some());
    if !cell.link.dialect.weighs() && !all_apart {
        let own = weighing.is_some();
        return checker.fail(fault::cannot_weigh(
            own,
            field,
            &cell.link.dialect,
            cell.dialect_at,
        ));
    }
    let unsaid = axes.iter().find(|axis| {
        let counts = axis
            .load_cell
            .as_ref()
            .unwrap_or(cell)
            .link
            .dialect
            .counts();
        counts && axis.plan.calibration.newtons_per_count.is_none()
    });
    match axes
        .iter()
        .filter_map(|axis| axis.load_cell.as_ref())
        .find(|own| own.link.dialect.counts())
    {
        // What each axis says of its counts the rig need not say.
        Some(_) if unsaid.is_none() => Some(()),
        Some(own) => {
            let own = unsaid
                .and_then(|axis| axis.load_cell.as_ref())
                .unwrap_or(own);
            counts(checker, block, &own.link.dialect, own)
        }
        None if unsaid.is_none() && !axes.is_empty() && cell.link.dialect.counts() => Some(()),
        None => counts(checker, block, &cell.link.dialect, cell),
    }
}

/// Raw counts need to be told in newtons; a force in newtons is not told twice.
fn counts(checker: &mut Checker, block: usize, dialect: &Dialect, cell: &Device) -> Option<()> {
    if !dialect.counts() {
        let given = ["force_per_count", "zero_count"]
            .into_iter()
            .find_map(|field| checker.given(block, field));
        return match given {
            Some((_, entry)) => checker.fail(fault::nothing_counts(&entry.key, dialect)),
            None => Some(()),
        };
    }
    match checker.given(block, "force_per_count") {
        None if checker.misspelt(block, &["force_per_count"]) => None,
        None => checker.fail(fault::counts_without_force(dialect, cell.dialect_at)),
        Some((_, entry)) => match checker.constant(block, "force_per_count")? {
            0.0 => checker.fail(values::zero("force_per_count", entry.value.span)),
            _ => Some(()),
        },
    }
}

/// A request may go unanswered for 7T before the program gives it up; a rig that lets go before that is of no use.
fn hold_watchdog<'d>(
    checker: &mut Checker,
    block: usize,
    watchdog: f64,
    devices: impl Iterator<Item = &'d Device>,
) -> Option<()> {
    let slowest =
        devices.max_by(|one, other| one.link.reply_timeout.total_cmp(&other.link.reply_timeout))?;
    let silence = PATIENCE * slowest.link.reply_timeout;
    // 7 · 0.4 s is 2.8 s also where the last bit of the product says more.
    if watchdog >= silence * (1.0 - 4.0 * f64::EPSILON) {
        return Some(());
    }
    let given = checker
        .given(block, "watchdog")
        .map(|(_, entry)| entry.value.span);
    checker.fail(fault::watchdog_too_short(
        watchdog,
        silence,
        given.is_some(),
        given.unwrap_or(slowest.at),
    ))
}

/// The rig's gate; where each axis has its own, the rig needs none.
fn gate(checker: &mut Checker, block: usize, axes: &[CheckedAxis]) -> Option<Gate> {
    if checker.given(block, "gate").is_none() && axes.iter().all(|axis| axis.plan.gate.is_some()) {
        return axes.first()?.plan.gate;
    }
    let place = place_of(checker, block, "gate")?;
    let chosen = checker.choice(block, "gate")?;
    probe(checker, &chosen, place)
}

/// `probe(…)`, of a rig or of one of its axes.
pub fn probe<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, place: Place) -> Option<Gate> {
    let probe = checker.constant_argument(chosen, "displacement", place);
    let stiffness = checker.interval_argument(chosen, "stiffness", place);
    let zero = checker.constant_argument(chosen, "zero", place);
    Some(Gate {
        zero: zero?,
        probe: probe?,
        stiffness: stiffness?,
    })
}

fn readings(checker: &mut Checker, block: usize) -> Option<ReadingRules> {
    let samples = checker.count(block, "samples");
    if let (Some(samples), Some((_, entry))) = (samples, checker.given(block, "samples"))
        && samples.is_multiple_of(2)
    {
        return checker.fail(values::even("samples", entry.value.span, samples));
    }
    let (rate, resolution, noise) = (
        checker.constant(block, "rate"),
        checker.constant(block, "resolution"),
        checker.constant(block, "noise"),
    );
    let force_range = checker.bounds(block, "force_range");
    let frozen_after = checker
        .constant(block, "frozen_after")
        .and_then(whole_number);
    Some(ReadingRules {
        samples: samples?,
        rate: rate?,
        resolution: resolution?,
        noise: noise?,
        force_range: force_range?,
        frozen_after: frozen_after?,
    })
}

/// Says what each real rig lacks; for the rig of the run also whether its limits bound it, and hold its own moves.
pub fn complete(
    checker: &mut Checker,
    rig: Option<&mut CheckedRig>,
    limits: Option<&CheckedLimits>,
) {
    // Limits that the rig names are not known where it is faulty itself.
    let knows_limits = |block: usize| rig.is_some() || checker.given(block, "limits").is_none();
    let of_run = checker.real_rig.filter(|block| knows_limits(*block));
    let rigs = checker.scope.of_kind(Kind::Rig).map(|(index, _)| index);
    let real: Vec<usize> = rigs
        .filter(|block| kind(checker, *block) == Some(RigKind::Real))
        .collect();
    for block in real {
        let declared = &checker.scope.blocks[block];
        let required = declared
            .kind
            .fields
            .iter()
            .filter(|field| matches!(field.need, Need::RequiredOn(RigKind::Real, _)));
        let absent = |field: &&Field| {
            let elsewhere = field.name == "gate" && every_axis_has_a_gate(checker, block);
            checker.given(block, field.name).is_none()
                && !elsewhere
                && !checker.misspelt(block, &[field.name])
        };
        let missing: Vec<&Field> = required.filter(absent).collect();
        let unbounded = limits
            .filter(|_| of_run == Some(block))
            .map_or_else(Vec::new, |limits| unbounded(checker, limits));
        if !missing.is_empty() || !unbounded.is_empty() {
            checker.faults.push(fault::incomplete(
                declared.name,
                declared.block.head,
                &missing,
                &unbounded,
            ));
        }
    }
    if let (
        Some(CheckedRig {
            plan,
            block: Some(block),
            ..
        }),
        Some(limits),
    ) = (rig, limits)
        && let Link::Real(link) = &mut plan.link
    {
        hold_own_moves(checker, *block, link, limits);
    }
}

fn every_axis_has_a_gate(checker: &Checker, block: usize) -> bool {
    let Some((_, written)) = checker.given(block, "axes") else {
        return false;
    };
    // By its name, or as the second of those without one.
    let is_gate = |(place, argument): (usize, &Argument)| match &argument.name {
        Some(name) => name.node == "gate",
        None => place == 1,
    };
    let has = |axis: &Expr| match &axis.kind {
        ExprKind::Call { arguments, .. } => arguments.iter().enumerate().any(is_gate),
        _ => false,
    };
    match &written.value.kind {
        ExprKind::List { items, .. } => !items.is_empty() && items.iter().all(has),
        _ => has(&written.value),
    }
}

/// The limits that a real rig must have and that nothing bounds.
fn unbounded(checker: &Checker, limits: &CheckedLimits) -> Vec<&'static str> {
    let said = |field: &str| {
        let mut blocks = checker.scope.of_kind(Kind::Limits);
        checker.names_lost || blocks.any(|(block, _)| checker.misspelt(block, &[field]))
    };
    let finite = |interval: Interval| interval.low.is_finite() && interval.high.is_finite();
    let all = [
        ("displacement", limits.limits.displacement),
        ("force", limits.limits.force),
        ("speed", limits.limits.speed),
    ];
    all.into_iter()
        .filter(|(field, interval)| !finite(*interval) && !said(field))
        .map(|(field, _)| field)
        .collect()
}

/// The moves that the rig makes of itself: the probe, and a move for which no speed is said.
fn hold_own_moves(
    checker: &mut Checker,
    block: usize,
    link: &mut RealLink,
    limits: &CheckedLimits,
) {
    let axes = link.axes.len().max(1);
    let beyond = (0..axes)
        .map(|axis| link.gate_of(axis).probe)
        .find(|probe| !limits.limits.displacement.contains(*probe));
    let given = checker
        .given(block, "gate")
        .or_else(|| checker.given(block, "axes"));
    if let (Some((_, gate)), Some(at), Some(probe)) = (given, limits.displacement_at, beyond) {
        let interval = limits.limits.displacement;
        checker.faults.push(whole::beyond_limits(
            "gate",
            probe,
            Dimension::LENGTH,
            gate.value.span,
            interval,
            at,
        ));
    }
    let interval = limits.limits.speed;
    match (checker.given(block, "speed"), limits.speed_at) {
        (Some((_, speed)), Some(at)) if !interval.contains(link.own_speed) => {
            let fault = whole::beyond_limits(
                "speed",
                link.own_speed,
                Dimension::VELOCITY,
                speed.value.span,
                interval,
                at,
            );
            checker.faults.push(fault);
        }
        // The default is no faster than what is allowed.
        (None, _) => link.own_speed = link.own_speed.min(interval.high),
        _ => {}
    }
}

/// What runs on the real rig of the run but cannot be vouched for.
pub fn warn(checker: &mut Checker, rig: &CheckedRig) {
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
            .faults
            .push(fault::not_certifiable(&rig.plan.name, head, reference, due));
    }
    let no_day = |calibration: &Calibration| matches!(calibration.displacement, Some((_, None)));
    let of_rig = checker
        .given(block, "displacement_calibration")
        .or_else(|| checker.given(block, "axes"));
    if let (true, Some((_, entry))) = (calibrations.iter().any(no_day), of_rig) {
        checker.faults.push(fault::displacement_without_day(
            &rig.plan.name,
            entry.value.span,
        ));
    }
    if axes
        .clone()
        .any(|axis| link.readings_of(axis).resolution == 0.0)
    {
        let at = checker
            .given(block, "resolution")
            .map_or(head, |(_, entry)| entry.value.span);
        checker
            .faults
            .push(fault::resolution_unknown(&rig.plan.name, at));
    }
    let drowned = axes
        .clone()
        .map(|axis| (link.gate_of(axis), link.readings_of(axis).noise))
        .find(|(gate, noise)| {
            // What is written as ten times must be ten times.
            gate.probe.abs() * gate.stiffness.low < fault::GATE_OVER_NOISE * noise * (1.0 - 1e-9)
        });
    let given = checker
        .given(block, "gate")
        .or_else(|| checker.given(block, "axes"));
    if let (Some((gate, noise)), Some((_, entry))) = (drowned, given) {
        checker.faults.push(fault::gate_within_noise(
            gate.probe.abs(),
            gate.stiffness.low,
            noise,
            entry.value.span,
        ));
    }
    let unpinned =
        |device: &DeviceLink| device.dialect == Dialect::Native && device.serial_number.is_none();
    let fields = if checker.given(block, "link").is_some() {
        ["link", "load_cell"]
    } else {
        ["actuator", "load_cell"]
    };
    for (field, device) in fields
        .into_iter()
        .zip([Some(&link.actuator), link.load_cell.as_ref()])
    {
        if let (Some(device), Some((_, entry))) = (device, checker.given(block, field))
            && unpinned(device)
        {
            checker.faults.push(fault::device_not_pinned(
                field,
                "",
                &device.port,
                entry.value.span,
            ));
        }
    }
    let Some((_, written)) = checker.given(block, "axes") else {
        return;
    };
    for (axis, own) in link.axes.iter().enumerate() {
        for (field, device) in [("actuator", &own.actuator), ("load_cell", &own.load_cell)] {
            if let Some(device) = device.as_ref().filter(|device| unpinned(device)) {
                let at = own_device_at(&written.value, axis, field);
                checker.faults.push(fault::device_not_pinned(
                    field,
                    &format!(" of axis {}", axis + 1),
                    &device.port,
                    at,
                ));
            }
        }
    }
}

/// Where an axis names a device of its own; the list of axes, where that cannot be told.
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
