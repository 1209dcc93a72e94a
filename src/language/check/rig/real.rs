//! A rig that moves a real specimen: its devices fit together, and every entry that the safety of the specimen needs is there. In: the
//! block of a rig, the limits of the run. Out: a [`RealLink`]. It opens no port.

use super::axes::{self, CheckedAxis};
use super::axis_devices;
use super::device::{Device, device};
use super::probe::probe;
use super::{CheckedRig, context_of, kind};
use crate::check::checker::Checker;
use crate::check::declarations::limits::CheckedLimits;
use crate::check::expressions::fields::whole as whole_number;
use crate::check::messages::rigs as message;
use crate::check::messages::{values, whole};
use crate::syntax::ast::{Argument, Expr, ExprKind};
use psd_plan::schema::rig as schema;
use psd_plan::schema::{Field, Kind, Presence, RigKind};
use psd_plan::schema::{limits as limits_block, plan_block};
use psd_plan::{Datum, Dialect, Interval, Link, PretestCheck, ReadingRules, RealLink, SafeState};
use psd_text::units::Dimension;

/// A request is sent after 0, T and 3T, and abandoned after 7T.
const PATIENCE: f64 = 7.0;

/// A run on a real rig must name its operator, who is responsible for every move.
pub fn check_operator(checker: &mut Checker, particulars: &[(&'static str, String)]) {
    let named = particulars
        .iter()
        .any(|(field, name)| *field == plan_block::OPERATOR.name && !name.trim().is_empty());
    if let Some(block) = checker.real_rig.filter(|_| !named) {
        let declared = &checker.scope.blocks[block];
        let at = declared.name.map_or(declared.block.head, |name| name.span);
        checker.diagnostics.push(message::no_operator_named(at));
    }
}

/// The link of a real rig; None if it has an error or is incomplete, which [`complete`] reports.
pub fn real_link(checker: &mut Checker, block: usize) -> Option<RealLink> {
    let safe_state = checker
        .choice(block, schema::SAFE_STATE.name)
        .map(|chosen| chosen.variant.name);
    let datum = checker.word(block, schema::DATUM.name, "machine");
    let axes = axes::axes(checker, block);
    let devices = devices(checker, block, axes.as_deref().unwrap_or_default());
    let pretest_check = pretest_check(checker, block, axes.as_deref().unwrap_or_default());
    let readings = readings(checker, block);
    let watchdog = checker.constant(block, schema::WATCHDOG.name);
    let own_speed = checker.constant(block, schema::SPEED.name);
    let (actuator, load_cell) = devices?;
    if let Some(watchdog) = watchdog {
        let own = axes
            .iter()
            .flatten()
            .flat_map(|axis| [axis.actuator.as_ref(), axis.load_cell.as_ref()]);
        check_watchdog(
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
    axis_devices::check(checker, block, &actuator, load_cell.as_ref(), &axes)?;
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
        pretest_check: pretest_check?,
        readings: readings?,
        watchdog: watchdog?,
        own_speed: own_speed?,
        axes: axes.into_iter().map(|axis| axis.plan).collect(),
    })
}

/// The device that moves, and the device that measures the force if it is a separate one.
fn devices(
    checker: &mut Checker,
    block: usize,
    axes: &[CheckedAxis],
) -> Option<(Device, Option<Device>)> {
    let key = |checker: &Checker, field: &str| {
        checker.field(block, field).map(|(_, entry)| entry.key.span)
    };
    let (link, actuator, load_cell) = (
        key(checker, schema::LINK.name),
        key(checker, schema::ACTUATOR.name),
        key(checker, schema::LOAD_CELL.name),
    );
    if let (Some(link), Some((field, other))) = (
        link,
        actuator
            .map(|at| (schema::ACTUATOR.name, at))
            .or(load_cell.map(|at| (schema::LOAD_CELL.name, at))),
    ) {
        return checker.fail(message::link_and_device(link, field, other));
    }
    if let (None, Some(at)) = (actuator, load_cell)
        && !checker.misspelt(block, &[schema::ACTUATOR.name])
    {
        return checker.fail(message::load_cell_alone(at));
    }
    let field = if link.is_some() {
        schema::LINK.name
    } else {
        schema::ACTUATOR.name
    };
    let moving = device_of(checker, block, field);
    let load_cell_device = match load_cell {
        Some(_) => device_of(checker, block, schema::LOAD_CELL.name).map(Some),
        None => Some(None),
    };
    let (moving, load_cell_device) = (moving?, load_cell_device?);
    fit(
        checker,
        block,
        field,
        &moving,
        load_cell_device.as_ref(),
        axes,
    )?;
    Some((moving, load_cell_device))
}

fn device_of(checker: &mut Checker, block: usize, field: &str) -> Option<Device> {
    let (_, entry) = checker.field(block, field)?;
    let (at, context) = (entry.value.span, context_of(checker, block, field)?);
    let chosen = checker.choice(block, field)?;
    device(checker, &chosen, at, context)
}

/// One device moves, one measures the force, and raw counts have a scale factor.
fn fit(
    checker: &mut Checker,
    block: usize,
    field: &str,
    moving: &Device,
    load_cell_device: Option<&Device>,
    axes: &[CheckedAxis],
) -> Option<()> {
    if !moving.link.dialect.abilities().moves {
        return checker.fail(message::cannot_move(
            field,
            &moving.link.dialect,
            moving.dialect_at,
        ));
    }
    let cell = load_cell_device.unwrap_or(moving);
    let all_apart = !axes.is_empty() && axes.iter().all(|axis| axis.load_cell.is_some());
    if !cell.link.dialect.abilities().measures_force && !all_apart {
        let own = load_cell_device.is_some();
        return checker.fail(message::cannot_measure_force(
            own,
            field,
            &cell.link.dialect,
            cell.dialect_at,
        ));
    }
    let unstated = axes.iter().find(|axis| {
        let cell = axis.load_cell.as_ref().unwrap_or(cell);
        cell.link.dialect.abilities().counts && axis.plan.calibration.newtons_per_count.is_none()
    });
    match axes
        .iter()
        .filter_map(|axis| axis.load_cell.as_ref())
        .find(|own| own.link.dialect.abilities().counts)
    {
        // If each axis states its scale factor, the rig need not.
        Some(_) if unstated.is_none() => Some(()),
        Some(own) => {
            let own = unstated
                .and_then(|axis| axis.load_cell.as_ref())
                .unwrap_or(own);
            counts(checker, block, &own.link.dialect, own)
        }
        None if unstated.is_none() && !axes.is_empty() && cell.link.dialect.abilities().counts => {
            Some(())
        }
        None => counts(checker, block, &cell.link.dialect, cell),
    }
}

/// Raw counts need a scale factor; a force in newtons must have none.
fn counts(checker: &mut Checker, block: usize, dialect: &Dialect, cell: &Device) -> Option<()> {
    if !dialect.abilities().counts {
        let given = [schema::FORCE_PER_COUNT.name, schema::ZERO_OFFSET.name]
            .into_iter()
            .find_map(|field| checker.field(block, field));
        return match given {
            Some((_, entry)) => checker.fail(message::nothing_counts(&entry.key, dialect)),
            None => Some(()),
        };
    }
    match checker.field(block, schema::FORCE_PER_COUNT.name) {
        None if checker.misspelt(block, &[schema::FORCE_PER_COUNT.name]) => None,
        None => checker.fail(message::counts_without_force(dialect, cell.dialect_at)),
        Some((_, entry)) => match checker.constant(block, schema::FORCE_PER_COUNT.name)? {
            0.0 => checker.fail(values::zero(schema::FORCE_PER_COUNT.name, entry.value.span)),
            _ => Some(()),
        },
    }
}

/// A request may remain unanswered for 7T before the program abandons it; the watchdog of the rig must not act earlier.
fn check_watchdog<'d>(
    checker: &mut Checker,
    block: usize,
    watchdog: f64,
    devices: impl Iterator<Item = &'d Device>,
) -> Option<()> {
    let slowest =
        devices.max_by(|one, other| one.link.reply_timeout.total_cmp(&other.link.reply_timeout))?;
    let silence = PATIENCE * slowest.link.reply_timeout;
    // 7 · 0.4 s is 2.8 s, despite rounding in the last bit of the product.
    if watchdog >= silence * (1.0 - 4.0 * f64::EPSILON) {
        return Some(());
    }
    let given = checker
        .field(block, schema::WATCHDOG.name)
        .map(|(_, entry)| entry.value.span);
    checker.fail(message::watchdog_too_short(
        watchdog,
        silence,
        given.is_some(),
        given.unwrap_or(slowest.at),
    ))
}

/// The pre-test check of the rig; not needed if each axis has a separate one.
fn pretest_check(
    checker: &mut Checker,
    block: usize,
    axes: &[CheckedAxis],
) -> Option<PretestCheck> {
    if checker.field(block, schema::PRETEST_CHECK.name).is_none()
        && axes.iter().all(|axis| axis.plan.pretest_check.is_some())
    {
        return axes.first()?.plan.pretest_check;
    }
    let context = context_of(checker, block, schema::PRETEST_CHECK.name)?;
    let chosen = checker.choice(block, schema::PRETEST_CHECK.name)?;
    probe(checker, &chosen, context)
}

fn readings(checker: &mut Checker, block: usize) -> Option<ReadingRules> {
    let samples = checker.count(block, schema::SAMPLES.name);
    if let (Some(samples), Some((_, entry))) = (samples, checker.field(block, schema::SAMPLES.name))
        && samples.is_multiple_of(2)
    {
        return checker.fail(values::even(
            schema::SAMPLES.name,
            entry.value.span,
            samples,
        ));
    }
    let (rate, resolution, noise) = (
        checker.constant(block, schema::RATE.name),
        checker.constant(block, schema::RESOLUTION.name),
        checker.constant(block, schema::NOISE.name),
    );
    let force_range = checker.bounds(block, schema::FORCE_RANGE.name);
    let frozen_after = checker
        .constant(block, schema::FROZEN_AFTER.name)
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

/// Reports the missing entries of each real rig; for the rig of the run also whether it is limited, and allows its own moves.
pub fn complete(
    checker: &mut Checker,
    rig: Option<&mut CheckedRig>,
    limits: Option<&CheckedLimits>,
) {
    // The limits that the rig names are unknown if the rig has an error itself.
    let knows_limits =
        |block: usize| rig.is_some() || checker.field(block, schema::LIMITS.name).is_none();
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
            .filter(|field| matches!(field.presence, Presence::RequiredOn(RigKind::Real, _)));
        let absent = |field: &&Field| {
            let elsewhere =
                field.name == schema::PRETEST_CHECK.name && every_axis_has_a_check(checker, block);
            checker.field(block, field.name).is_none()
                && !elsewhere
                && !checker.misspelt(block, &[field.name])
        };
        let missing: Vec<&Field> = required.filter(absent).collect();
        let unbounded = limits
            .filter(|_| of_run == Some(block))
            .map_or_else(Vec::new, |limits| unbounded(checker, limits));
        if !missing.is_empty() || !unbounded.is_empty() {
            checker.diagnostics.push(message::incomplete(
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
        check_own_moves(checker, *block, link, limits);
    }
}

fn every_axis_has_a_check(checker: &Checker, block: usize) -> bool {
    let Some((_, written)) = checker.field(block, schema::AXES.name) else {
        return false;
    };
    // By its name, or as the second limits block without a name.
    let is_check = |(index, argument): (usize, &Argument)| match &argument.name {
        Some(name) => name.node == schema::PRETEST_CHECK.name,
        None => index == 1,
    };
    let has = |axis: &Expr| match &axis.kind {
        ExprKind::Call { arguments, .. } => arguments.iter().enumerate().any(is_check),
        _ => false,
    };
    match &written.value.kind {
        ExprKind::List { items, .. } => !items.is_empty() && items.iter().all(has),
        _ => has(&written.value),
    }
}

/// The limits that a real rig must have and that are missing.
fn unbounded(checker: &Checker, limits: &CheckedLimits) -> Vec<&'static str> {
    let has_error = |field: &str| {
        let mut blocks = checker.scope.of_kind(Kind::Limits);
        checker.names_lost || blocks.any(|(block, _)| checker.misspelt(block, &[field]))
    };
    let finite = |interval: Interval| interval.low.is_finite() && interval.high.is_finite();
    let all = [
        (limits_block::NAMES.displacement, limits.limits.displacement),
        (limits_block::NAMES.force, limits.limits.force),
        (limits_block::NAMES.speed, limits.limits.speed),
    ];
    all.into_iter()
        .filter(|(field, interval)| !finite(*interval) && !has_error(field))
        .map(|(field, _)| field)
        .collect()
}

/// The moves of the rig itself: the probe, and moves without a specified speed.
fn check_own_moves(
    checker: &mut Checker,
    block: usize,
    link: &mut RealLink,
    limits: &CheckedLimits,
) {
    let axes = link.axes.len().max(1);
    let beyond = (0..axes)
        .map(|axis| link.pretest_check_of(axis).probe)
        .find(|probe| !limits.limits.displacement.contains(*probe));
    let given = checker
        .field(block, schema::PRETEST_CHECK.name)
        .or_else(|| checker.field(block, schema::AXES.name));
    if let (Some((_, pretest_check)), Some(at), Some(probe)) =
        (given, limits.displacement_at, beyond)
    {
        let interval = limits.limits.displacement;
        checker.diagnostics.push(whole::beyond_limits(
            schema::PRETEST_CHECK.name,
            probe,
            Dimension::LENGTH,
            pretest_check.value.span,
            interval,
            at,
        ));
    }
    let interval = limits.limits.speed;
    match (checker.field(block, schema::SPEED.name), limits.speed_at) {
        (Some((_, speed)), Some(at)) if !interval.contains(link.own_speed) => {
            let diagnostic = whole::beyond_limits(
                schema::SPEED.name,
                link.own_speed,
                Dimension::VELOCITY,
                speed.value.span,
                interval,
                at,
            );
            checker.diagnostics.push(diagnostic);
        }
        // The default does not exceed the limit.
        (None, _) => link.own_speed = link.own_speed.min(interval.high),
        _ => {}
    }
}
