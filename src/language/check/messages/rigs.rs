//! Errors and warnings of real rigs: E606 to E614, E619, W707, W708, W711, W727. In: names, numbers and spans. Out: diagnostics.

use super::shown;
use crate::syntax::ast::Ident;
use psd_plan::schema::Field;
use psd_plan::schema::{limits, rig as schema};
use psd_plan::{Dialect, Interval, PortPlan, PretestCheck};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// Least ratio of the force of a probe to the noise of a reading.
pub const CHECK_OVER_NOISE: f64 = 10.0;

/// `a`, `b` and `c`
fn all_of(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [most @ .., last] if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        other => other.concat(),
    }
}

pub fn incomplete(
    name: Option<&Ident>,
    head: Span,
    missing: &[&Field],
    unbounded: &[&str],
) -> Diagnostic {
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
        Code::RealRigIncomplete,
        format!(
            "real rig `{name}` is incomplete: it lacks {}",
            lacks.join(", and ")
        ),
    )
    .at(head, "real rig")
    .help(help.join("\n"))
}

pub fn no_operator_named(rig: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NobodyNamed,
        "no operator is named: a real rig requires one",
    )
    .at(rig, "moves a real specimen")
    .help("add `--operator \"A. Tester\"`, or `operator` in the `plan` block")
}

fn example_of_limit(field: &str) -> &'static str {
    match field {
        _ if field == limits::NAMES.displacement => "displacement = -2 mm .. 25 mm",
        _ if field == limits::NAMES.force => "force = -2 kN .. 12 kN",
        _ => "speed = 10 mm/s",
    }
}

pub fn link_and_device(link: Span, field: &str, other: Span) -> Diagnostic {
    let help = if field == schema::LOAD_CELL.name {
        "write `actuator` instead of `link` for the device that moves"
    } else {
        "write `link` for one device that moves and measures force; write `actuator` and `load_cell` for two"
    };
    Diagnostic::new(
        Code::RigLinks,
        format!(
            "a rig has a `link`, or an `actuator` and a `load_cell`, but not `link` and `{field}`"
        ),
    )
    .at(other, "conflicts with `link`")
    .at(link, "this")
    .help(help)
}

pub fn load_cell_alone(at: Span) -> Diagnostic {
    Diagnostic::new(Code::RigLinks, "`load_cell` requires an `actuator`")
        .at(at, "no actuator")
        .help("add a line such as\nactuator = serial(port: \"/dev/ttyUSB0\", dialect: grbl)")
}

pub fn cannot_move(field: &str, dialect: &Dialect, at: Span) -> Diagnostic {
    let name = dialect.name();
    let help = match dialect {
        Dialect::Modbus(_) => "add the `target` register, and `position` with its `length_unit`",
        _ if field == schema::LINK.name => {
            "make this the `load_cell`, and name an `actuator` that moves"
        }
        _ => "name a device that moves: `native`, `grbl`, `instron`, `mark10`, `modbus` or `nees`",
    };
    Diagnostic::new(
        Code::WrongDevice,
        format!("`{field}` must move the specimen, but a `{name}` device cannot"),
    )
    .at(at, "cannot move")
    .help(help)
}

/// `own`: a load cell was named; otherwise the moving device was to measure the force too.
pub fn cannot_measure_force(own: bool, field: &str, dialect: &Dialect, at: Span) -> Diagnostic {
    let name = dialect.name();
    let help = match dialect {
        Dialect::Modbus(_) => {
            "add the `force` register with its `force_unit`, or another device that reads the force"
        }
        _ if own => {
            "name a device that reads the force, as in\nload_cell = serial(port: \"/dev/ttyUSB1\", dialect: indicator)"
        }
        _ if field == schema::LINK.name => {
            "make this the `actuator`, and add\nload_cell = serial(port: \"/dev/ttyUSB1\", dialect: indicator)"
        }
        _ => "add a line such as\nload_cell = serial(port: \"/dev/ttyUSB1\", dialect: indicator)",
    };
    let message = if own {
        format!("`load_cell` must read the force, but a `{name}` device cannot")
    } else {
        format!("no device reads the force: a `{name}` device only moves")
    };
    Diagnostic::new(Code::WrongDevice, message)
        .at(at, "reads no force")
        .help(help)
}

pub fn counts_without_force(dialect: &Dialect, at: Span) -> Diagnostic {
    Diagnostic::new(
        Code::CountsWithoutForce,
        format!(
            "`{}` gives raw counts, but the rig has no scale factor for them",
            dialect.name()
        ),
    )
    .at(at, "counts, not newtons")
    .help("add to the rig, from its calibration,\nforce_per_count = 0.0123 N\nzero_offset = 8123")
}

pub fn nothing_counts(key: &Ident, dialect: &Dialect) -> Diagnostic {
    let (field, name) = (&key.node, dialect.name());
    Diagnostic::new(
        Code::FieldWithoutUse,
        format!("`{field}` has no effect: `{name}` gives the force in newtons"),
    )
    .at(key.span, "not used")
    .help(format!("remove `{field}`"))
}

pub fn day_of_no_calibration(field: &str, at: Span) -> Diagnostic {
    Diagnostic::new(Code::FieldWithoutUse, format!("`{field}` requires `displacement_calibration`"))
        .at(at, "no displacement calibration")
        .help("add `displacement_calibration = \"UKAS 4712\"`, or remove the date: `calibration_due` applies to both")
}

pub fn displacement_without_day(rig: &str, at: Span) -> Diagnostic {
    Diagnostic::new(
        Code::CalibrationWithoutDay,
        format!("test reports of rig `{rig}` cannot be issued: `displacement_calibration_due` is missing"),
    )
    .at(at, "due date missing")
    .help("add to the rig\ndisplacement_calibration_due = \"2027-03-01\"")
}

pub fn field_of_real_rigs(key: &Ident) -> Diagnostic {
    let field = &key.node;
    let help = match field.as_str() {
        name if [schema::NOISE.name, schema::RESOLUTION.name].contains(&name) => {
            format!("write it inside the link, as in `link = virtual({field}: …)`, or remove it")
        }
        _ => format!("remove `{field}`"),
    };
    Diagnostic::new(
        Code::FieldWithoutUse,
        format!("`{field}` applies to real rigs only, but this rig is virtual"),
    )
    .at(key.span, "not used")
    .help(help)
}

pub fn bad_port(span: Span, why: &str) -> Diagnostic {
    Diagnostic::new(Code::BadPort, format!("invalid port name: {why}"))
        .at(span, "invalid port name")
        .help("write the name that the system uses, such as `\"/dev/ttyUSB0\"`")
}

pub fn bad_address(address: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadPort,
        format!(
            "invalid address `{}`: a host, a colon and a port from 1 to 65535 are required",
            address.escape_debug()
        ),
    )
    .at(span, "not `host:port`")
    .help("write it as in `\"127.0.0.1:44000\"`")
}

pub fn bad_line_text(field: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadPort,
        format!("invalid `{field}`: the protocol requires a nonempty line of plain text"),
    )
    .at(span, "empty, or invalid characters")
    .help("write the letters and digits that the device uses")
}

pub fn port_twice(port: &PortPlan, second: Span, first: Span) -> Diagnostic {
    Diagnostic::new(
        Code::PortTwice,
        format!(
            "two devices on one port, `{}`",
            port.to_string().escape_debug()
        ),
    )
    .at(second, "named again")
    .at(first, "first named here")
    .help(
        "write a port for each device, or use `link` for one device that moves and measures force",
    )
}

pub fn not_a_day(day: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NotADay,
        format!("`{}` is not a calendar date", day.escape_debug()),
    )
    .at(span, "invalid date")
    .help("write year, month and day, as in `\"2027-03-01\"`")
}

/// `given`: the watchdog is specified at `at`; otherwise the device with the longest request is.
pub fn watchdog_too_short(watchdog: f64, silence: f64, given: bool, at: Span) -> Diagnostic {
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
        Code::WatchdogTooShort,
        format!("the watchdog of {watchdog} is shorter than one request: {silence} (7 × `reply_timeout`)"),
    )
    .at(at, label)
    .help(format!("write `watchdog = {silence}` or more{other}"))
}

pub fn never_settles(field: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("`{field}` of a real rig must be greater than 0: readings always vary"),
    )
    .at(span, "too small")
    .help("write a tolerance of a few times the noise of the rig")
}

pub fn not_issuable(rig: &str, head: Span, reference: bool, due: bool) -> Diagnostic {
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
        Code::CalibrationWithoutDay,
        format!("test reports of rig `{rig}` cannot be issued: {lacks} missing"),
    )
    .at(head, "calibration data missing")
    .help(format!("add to the rig\n{lines}"))
}

pub fn calibration_overdue(rig: &str, due: &str, today: &str, at: Span) -> Diagnostic {
    Diagnostic::new(
        Code::CalibrationWithoutDay,
        format!("test reports of rig `{rig}` cannot be issued: its calibration was due on {due} (today: {today})"),
    )
    .at(at, "overdue")
    .help("calibrate the rig before the test, then write the new due date")
}

/// `of`: ` of axis 2`, if it belongs to one axis.
pub fn device_not_pinned(field: &str, of: &str, port: &PortPlan, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::DeviceNotPinned,
        format!(
            "`{field}`{of} accepts any device on `{}`",
            port.to_string().escape_debug()
        ),
    )
    .at(span, "no `serial_number`")
    .help("write the serial number of the device, as in\nserial_number: \"PSD-0001\"")
}

pub fn no_operator_to_free_it(at: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NobodyToFreeIt,
        "the specimen of a virtual rig cannot be taken off its load cell".to_owned(),
    )
    .at(at, "requires an operator")
    .help("write `after: start`: the rig returns to its start position and reads the zero there")
}

/// A source of random changes of a reading.
#[derive(Clone, Copy)]
pub struct ReadingScatter {
    pub name: &'static str,
    /// In SI units.
    pub size: f64,
    /// The largest change that it may cause, in SI units.
    pub reach: f64,
}

pub fn drift_within_noise(
    what: &str,
    allowed: f64,
    scatter: ReadingScatter,
    dimension: Dimension,
    at: Span,
) -> Diagnostic {
    let name = scatter.name;
    let (allowed, size, reach) = (
        shown(allowed, dimension),
        shown(scatter.size, dimension),
        shown(scatter.reach, dimension),
    );
    Diagnostic::new(
        Code::DriftWithinNoise,
        format!("{what} drift tolerance {allowed} is within the scatter of the readings"),
    )
    .at(at, format!("{name} of one reading: {size}"))
    .help(format!("write at least {reach}, or reduce the {name}"))
}

/// A probe whose force on the softest acceptable specimen is too small compared with the noise of a reading \[N\].
pub fn check_within_noise(pretest_check: &PretestCheck, noise: f64, at: Span) -> Diagnostic {
    let (probe, softest) = (pretest_check.probe.abs(), pretest_check.stiffness.low);
    // Two digits, rounded up.
    let least = CHECK_OVER_NOISE * noise / softest;
    let digit = 10f64.powf(least.log10().floor() - 1.0);
    let least = (least / digit * (1.0 - 1e-9)).ceil() * digit;
    Diagnostic::new(
        Code::CheckWithinNoise,
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

/// A pre-test check that refuses the stiffness \[N/m\] that the plan states.
pub fn window_excludes(window: Interval, stiffness: f64, at: Span) -> Diagnostic {
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
        Code::WindowExcludesStiffness,
        format!(
            "pre-test check will refuse the specimen: its stiffness {} is outside {low} .. {high}",
            show(stiffness)
        ),
    )
    .at(at, "excludes the stated stiffness")
    .help(help)
}

/// A settling band \[m\] that readings of this resolution \[m\] may never show.
pub fn band_within_resolution(band: f64, resolution: f64, at: Span) -> Diagnostic {
    let show = |value| shown(value, Dimension::LENGTH);
    Diagnostic::new(
        Code::BandWithinResolution,
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

pub fn resolution_unknown(rig: &str, at: Span) -> Diagnostic {
    Diagnostic::new(
        Code::ResolutionUnknown,
        format!(
            "a quiet load cell may be reported as frozen: rig `{rig}` has no displacement resolution"
        ),
    )
    .at(at, "0 mm by default")
    .help("add to the rig, from the transducer's data sheet\nresolution = 1 um")
}
