//! A rig that moves a real specimen: its devices fit together, and every entry that the safety of the specimen needs is there. In: the
//! block of a rig, the limits of the run. Out: a [`RealLink`]. It opens no port.

use crate::check::checker::Checker;
use crate::check::declarations::limits::CheckedLimits;
use crate::check::expressions::fields::whole as whole_number;
use crate::check::violations::{
    BeyondLimits, DeviceCannotMeasureForce, DeviceCannotMove, ZeroFactor,
};
use crate::check::wording::shown;
use crate::codes::{E401, E606, E607, E609, E613, E614, E619};
use crate::syntax::ast::{Argument, Expr, ExprKind, Ident};
use psd_plan::schema::{
    Field, Kind, Presence, RigKind, limits, limits as limits_block, plan_block, rig as schema,
};
use psd_plan::{Datum, Dialect, Interval, Link, PretestCheck, ReadingRules, RealLink, SafeState};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::axes::{self, CheckedAxis};
use super::axial;
use super::device::{Device, device};
use super::probe::probe;
use super::{CheckedRig, axis_devices, context_of, kind};

/// A request is sent after 0, T and 3T, and abandoned after 7T.
const PATIENCE: f64 = 7.0;

#[derive(Violation)]
#[violation(E619, "no operator is named: a real rig requires one")]
#[help("add `--operator \"A. Tester\"`, or `operator` in the `plan` block")]
struct NoOperatorNamed {
    #[label("moves a real specimen")]
    rig: Span,
}

/// A run on a real rig must name its operator, who is responsible for every move.
pub fn check_operator(checker: &mut Checker, particulars: &[(&'static str, String)]) {
    let named = particulars
        .iter()
        .any(|(field, name)| *field == plan_block::OPERATOR.name && !name.trim().is_empty());
    if let Some(block) = checker.real_rig.filter(|_| !named) {
        let declared = &checker.scope.blocks[block];
        let at = declared.name.map_or(declared.block.head, |name| name.span);
        checker.report(NoOperatorNamed { rig: at });
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
    let axial = axes.iter().filter(|axis| axis.plan.axial.is_some());
    let controllers = axial.map(|axis| axis.actuator.as_ref().unwrap_or(&actuator));
    axial::check_controllers(checker, controllers)?;
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

struct LinkAndDevice<'a> {
    link: Span,
    field: &'a str,
    other: Span,
}

impl Violation for LinkAndDevice<'_> {
    const CODE: Code = E607;

    fn diagnostic(self) -> Diagnostic {
        let Self { link, field, other } = self;
        let help = if field == schema::LOAD_CELL.name {
            "write `actuator` instead of `link` for the device that moves"
        } else {
            "write `link` for one device that moves and measures force; write `actuator` and `load_cell` for two"
        };
        Diagnostic::new(
        Self::CODE,
        format!(
            "a rig has a `link`, or an `actuator` and a `load_cell`, but not `link` and `{field}`"
        ),
    )
    .at(other, "conflicts with `link`")
    .at(link, "this")
    .help(help)
    }
}

#[derive(Violation)]
#[violation(E607, "`load_cell` requires an `actuator`")]
#[help("add a line such as\nactuator = serial(port: \"/dev/ttyUSB0\", dialect: grbl)")]
struct LoadCellAlone {
    #[label("no actuator")]
    at: Span,
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
        return checker.fail(LinkAndDevice { link, field, other });
    }
    if let (None, Some(at)) = (actuator, load_cell)
        && !checker.misspelt(block, &[schema::ACTUATOR.name])
    {
        return checker.fail(LoadCellAlone { at });
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
        return checker.fail(DeviceCannotMove {
            field,
            dialect: &moving.link.dialect,
            at: moving.dialect_at,
        });
    }
    let cell = load_cell_device.unwrap_or(moving);
    let all_apart = !axes.is_empty() && axes.iter().all(|axis| axis.load_cell.is_some());
    if !cell.link.dialect.abilities().measures_force && !all_apart {
        let own = load_cell_device.is_some();
        return checker.fail(DeviceCannotMeasureForce {
            own,
            field,
            dialect: &cell.link.dialect,
            at: cell.dialect_at,
        });
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

struct NothingCounts<'a> {
    key: &'a Ident,
    dialect: &'a Dialect,
}

impl Violation for NothingCounts<'_> {
    const CODE: Code = E614;

    fn diagnostic(self) -> Diagnostic {
        let Self { key, dialect } = self;
        let (field, name) = (&key.node, dialect.name());
        Diagnostic::new(
            Self::CODE,
            format!("`{field}` has no effect: `{name}` gives the force in newtons"),
        )
        .at(key.span, "not used")
        .help(format!("remove `{field}`"))
    }
}

#[derive(Violation)]
#[violation(
    E609,
    "`{}` gives raw counts, but the rig has no scale factor for them",
    dialect.name()
)]
#[help("add to the rig, from its calibration,\nforce_per_count = 0.0123 N\nzero_offset = 8123")]
struct CountsWithoutForce<'a> {
    dialect: &'a Dialect,
    #[label("counts, not newtons")]
    at: Span,
}

/// Raw counts need a scale factor; a force in newtons must have none.
fn counts(checker: &mut Checker, block: usize, dialect: &Dialect, cell: &Device) -> Option<()> {
    if !dialect.abilities().counts {
        let given = [schema::FORCE_PER_COUNT.name, schema::ZERO_OFFSET.name]
            .into_iter()
            .find_map(|field| checker.field(block, field));
        return match given {
            Some((_, entry)) => checker.fail(NothingCounts {
                key: &entry.key,
                dialect,
            }),
            None => Some(()),
        };
    }
    match checker.field(block, schema::FORCE_PER_COUNT.name) {
        None if checker.misspelt(block, &[schema::FORCE_PER_COUNT.name]) => None,
        None => checker.fail(CountsWithoutForce {
            dialect,
            at: cell.dialect_at,
        }),
        Some((_, entry)) => match checker.constant(block, schema::FORCE_PER_COUNT.name)? {
            0.0 => checker.fail(ZeroFactor {
                field: schema::FORCE_PER_COUNT.name,
                span: entry.value.span,
            }),
            _ => Some(()),
        },
    }
}

/// `given`: the watchdog is specified at `at`; otherwise the device with the longest request is.
struct WatchdogTooShort {
    watchdog: f64,
    silence: f64,
    given: bool,
    at: Span,
}

impl Violation for WatchdogTooShort {
    const CODE: Code = E613;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            watchdog,
            silence,
            given,
            at,
        } = self;
        let time = |value: f64| shown(value, Dimension::TIME);
        // Rounded down to a whole millisecond, so that seven of it are inside the watchdog time.
        let shorter = (watchdog / 7.0 * 1e3).floor() / 1e3;
        let (watchdog, silence) = (time(watchdog), time(silence));
        let label = if given {
            format!("{watchdog}, one request takes up to {silence}")
        } else {
            format!("a request takes up to {silence}")
        };
        let other = if shorter > 0.0 {
            format!(", or a `reply_timeout` of at most {}", time(shorter))
        } else {
            String::new()
        };
        Diagnostic::new(
        Self::CODE,
        format!("the watchdog of {watchdog} is shorter than one request: {silence} (7 × `reply_timeout`)"),
    )
    .at(at, label)
    .help(format!("write `watchdog = {silence}` or more{other}"))
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
    checker.fail(WatchdogTooShort {
        watchdog,
        silence,
        given: given.is_some(),
        at: given.unwrap_or(slowest.at),
    })
}

/// The pre-test check of the rig; not needed if each axis has a separate one.
fn pretest_check(
    checker: &mut Checker,
    block: usize,
    axes: &[CheckedAxis],
) -> Option<PretestCheck> {
    let mut lateral = axes.iter().filter(|axis| axis.plan.axial.is_none());
    if checker.field(block, schema::PRETEST_CHECK.name).is_none()
        && lateral.all(|axis| axis.plan.pretest_check.is_some())
    {
        return axes.first()?.plan.pretest_check;
    }
    let context = context_of(checker, block, schema::PRETEST_CHECK.name)?;
    let chosen = checker.choice(block, schema::PRETEST_CHECK.name)?;
    probe(checker, &chosen, context)
}

#[derive(Violation)]
#[violation(E401, "`{field}` must be odd, so that one reading is the median")]
#[help("write {} or {}", value.saturating_sub(1), value + 1)]
struct EvenCount<'a> {
    field: &'a str,
    #[label("even")]
    span: Span,
    value: u32,
}

fn readings(checker: &mut Checker, block: usize) -> Option<ReadingRules> {
    let samples = checker.count(block, schema::SAMPLES.name);
    if let (Some(samples), Some((_, entry))) = (samples, checker.field(block, schema::SAMPLES.name))
        && samples.is_multiple_of(2)
    {
        return checker.fail(EvenCount {
            field: schema::SAMPLES.name,
            span: entry.value.span,
            value: samples,
        });
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

/// `a`, `b` and `c`
fn all_of(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [most @ .., last] if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        other => other.concat(),
    }
}

fn example_of_limit(field: &str) -> &'static str {
    match field {
        _ if field == limits::DISPLACEMENT.name => "displacement = -2 mm .. 25 mm",
        _ if field == limits::FORCE.name => "force = -2 kN .. 12 kN",
        _ => "speed = 10 mm/s",
    }
}

struct RealRigIncomplete<'a> {
    name: Option<&'a Ident>,
    head: Span,
    missing: &'a [&'a Field],
    unbounded: &'a [&'a str],
}

impl Violation for RealRigIncomplete<'_> {
    const CODE: Code = E606;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            head,
            missing,
            unbounded,
        } = self;
        let name = name.map_or("", |name| name.node.as_str());
        let fields: Vec<&str> = missing.iter().map(|field| field.name).collect();
        let mut lacks = Vec::new();
        let mut help = Vec::new();
        if !fields.is_empty() {
            lacks.push(all_of(&fields));
            help.push("add to the rig".to_owned());
            help.extend(missing.iter().map(|field| field.example.to_owned()));
        }
        if !unbounded.is_empty() {
            lacks.push(format!("limits on {}", all_of(unbounded)));
            help.push(
                if unbounded.len() > 1 {
                    "write them in `limits`, as in"
                } else {
                    "write it in `limits`, as in"
                }
                .to_owned(),
            );
            help.extend(
                unbounded
                    .iter()
                    .map(|field| example_of_limit(field).to_owned()),
            );
        }
        Diagnostic::new(
            Self::CODE,
            format!(
                "real rig `{name}` is incomplete: it lacks {}",
                lacks.join(", and ")
            ),
        )
        .at(head, "real rig")
        .help(help.join("\n"))
    }
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
            checker.report(RealRigIncomplete {
                name: declared.name,
                head: declared.block.head,
                missing: &missing,
                unbounded: &unbounded,
            });
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
    // By its name, or as the second limits block without a name. An axial axis has no check.
    let is_check = |(index, argument): (usize, &Argument)| match &argument.name {
        Some(name) => [schema::PRETEST_CHECK.name, schema::AXIAL].contains(&name.node.as_str()),
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
        (limits_block::DISPLACEMENT.name, limits.limits.displacement),
        (limits_block::FORCE.name, limits.limits.force),
        (limits_block::SPEED.name, limits.limits.speed),
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
        checker.report(BeyondLimits {
            field: schema::PRETEST_CHECK.name,
            value: probe,
            dimension: Dimension::LENGTH,
            span: pretest_check.value.span,
            limit: interval,
            limit_at: at,
        });
    }
    let interval = limits.limits.speed;
    match (checker.field(block, schema::SPEED.name), limits.speed_at) {
        (Some((_, speed)), Some(at)) if !interval.contains(link.own_speed) => {
            let diagnostic = BeyondLimits {
                field: schema::SPEED.name,
                value: link.own_speed,
                dimension: Dimension::VELOCITY,
                span: speed.value.span,
                limit: interval,
                limit_at: at,
            }
            .diagnostic();
            checker.diagnostics.push(diagnostic);
        }
        // The default does not exceed the limit.
        (None, _) => link.own_speed = link.own_speed.min(interval.high),
        _ => {}
    }
}
