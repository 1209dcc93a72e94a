//! The paper's beam, `plans/beam.psd`, on a rig emulator of every protocol driver. The test runs in one process and in simulated time,
//! because on a line it would take minutes. In: the plan and its libraries, with other rig devices, resolutions and noise. Out: the
//! results of the ideal virtual run, within the resolution of the rig. The unchanged plan runs on the one driver that reads displacement
//! and force at one instant. For every other driver the sweep is refused, and its result is supplied instead.

use crate::check::{Checked, LoadError, Options, check};
use crate::codes::E654;
use crate::run::{Unwatched, replay, run};
use psd_plan::Plan;
use psd_plan::formula::ResultValue;
use psd_plan::record::{Outcome, Record};
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, Journal};
use psd_rig::virtual_rig;
use psd_testing::journal::PowerLoss;
use psd_text::diagnostic::Code;

use super::stage::{emulator, header, open};

/// Stiffness of the beam \[N/m\].
const STIFFNESS: f64 = 3e5;

/// A rig and its resolution.
struct Case {
    devices: &'static str,
    /// \[m\]
    resolution: f64,
    /// Half the resolution of its force readings \[N\].
    force_error: f64,
    /// Whether it reads displacement and force at one instant.
    sweeps: bool,
}

const fn case(devices: &'static str, force_error: f64) -> Case {
    Case {
        devices,
        resolution: 1e-6,
        force_error,
        sweeps: false,
    }
}

const CASES: &[Case] = &[
    // Six decimals of a millimetre, three of a newton.
    Case {
        resolution: 1e-9,
        sweeps: true,
        ..case("link = serial(port: \"/a\", dialect: native)", 5e-4)
    },
    case(
        "link = tcp(address: \"rig:1\", dialect: nees(\"MDL-00-01\"))",
        1e-3,
    ),
    case("link = serial(port: \"/a\", dialect: instron)", 1e-4),
    Case {
        resolution: 1e-5,
        ..case("link = serial(port: \"/a\", dialect: mark10)", 0.05)
    },
    case(
        "link = serial(port: \"/a\", dialect: modbus(unit: 1, number: float32(high_word_first), target: 100, position: 102, \
         length_unit: 1 mm, force: 104, force_unit: 1 kN, speed: 106, speed_unit: 1 mm/s, status: 108, moving_mask: 1, \
         command: 109, start_word: 1, stop_word: 2))",
        1e-3,
    ),
    case(
        "actuator = serial(port: \"/a\", dialect: grbl)\n  load_cell = serial(port: \"/b\", dialect: hx711)\n  \
         force_per_count = 0.01 N\n  zero_offset = 8123\n  polarity = negative\n  datum = here",
        5e-3,
    ),
    case(
        "actuator = serial(port: \"/a\", dialect: grbl)\n  load_cell = serial(port: \"/b\", dialect: indicator)\n  polarity = negative\n  datum = here",
        0.05,
    ),
    case(
        "actuator = serial(port: \"/a\", dialect: grbl)\n  load_cell = serial(port: \"/b\", dialect: scpi(1 N))\n  polarity = negative\n  datum = here",
        0.05,
    ),
    case(
        "actuator = serial(port: \"/a\", dialect: grbl)\n  load_cell = serial(port: \"/b\", dialect: mark10_gauge)\n  polarity = negative\n  datum = here",
        0.05,
    ),
];

impl Case {
    /// The libraries of the plan, with the devices of the case.
    fn library(&self, path: &str) -> Result<String, LoadError> {
        match path {
            "lib/instron_frame.psd" => {
                Ok(include_str!("../../../plans/lib/instron_frame.psd").to_owned())
            }
            "lib/gfrp_beam.psd" => Ok(include_str!("../../../plans/lib/gfrp_beam.psd").to_owned()),
            "lib/real_frame.psd" => Ok(self.frame()),
            _ => Err(LoadError::NotFound),
        }
    }

    /// `lib/real_frame.psd`, noiseless.
    fn frame(&self) -> String {
        let frame = include_str!("../../../plans/lib/real_frame.psd");
        let link = frame
            .lines()
            .find(|line| line.starts_with("  link "))
            .unwrap();
        let micrometres = self.resolution / 1e-6;
        let others = [
            (link, format!("  {}", self.devices)),
            (
                "resolution      = 1 um",
                format!("resolution = {micrometres} um"),
            ),
            (
                "within(0.005 mm",
                format!("within({} um", (1.5 * micrometres).max(5.0)),
            ),
            ("noise           = 2 N", "noise = 0 N".to_owned()),
        ];
        others.iter().fold(frame.to_owned(), |text, (was, is)| {
            assert!(text.contains(was), "{was}");
            text.replace(was, is)
        })
    }

    /// Results of the plan, complete or without its sweep.
    fn checked(&self, rig: &str, sweep: bool) -> Checked {
        let text = include_str!("../../../plans/beam.psd");
        let begins = text.find("damping sweep c {").unwrap();
        let ends = begins + text[begins..].find("\n}\n").unwrap() + 3;
        let without = format!("{}{}", &text[..begins], &text[ends..])
            .replace("c.damping", "6 N*s/m")
            .replace("    damping_fit(c),\n", "");
        let options = Options {
            rig: Some(rig.to_owned()),
            ..Options::default()
        };
        check(
            "beam.psd",
            if sweep { text } else { &without },
            &|path: &str| self.library(path),
            &options,
        )
    }

    fn plan(&self, rig: &str) -> Plan {
        let checked = self.checked(rig, self.sweeps);
        checked
            .plan
            .unwrap_or_else(|| panic!("{}: {:?}", self.devices, checked.diagnostics))
    }

    fn run(&self) -> Record {
        let plan = self.plan("bench");
        let emulator = emulator(&plan, "", Log::none(), 1);
        let mut rig =
            open(&plan, &emulator).unwrap_or_else(|fault| panic!("{}: {fault}", self.devices));
        let mut journal = Journal::create(Box::new(PowerLoss::new()), Durability::EverySyncPoint);
        replay::begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
        let record =
            replay::record(&plan, &mut rig, &mut Unwatched, journal, Box::new(|| None)).record;
        assert!(
            emulator.lock().rig().violations().is_empty(),
            "{}",
            self.devices
        );
        assert_eq!(record.outcome, Outcome::Completed, "{}", self.devices);
        record
    }
}

fn number(record: &Record, procedure: &str, name: &str) -> f64 {
    let procedure = record
        .procedures
        .iter()
        .find(|other| other.name == procedure)
        .unwrap();
    match procedure.result(name).map(|result| &result.value) {
        Some(ResultValue::Number {
            value: Some(value), ..
        }) => *value,
        other => panic!("{name}: {other:?}"),
    }
}

/// Difference of a result between the two runs, which must be at most `allowed`.
fn near(
    case: &Case,
    (ideal, real): (&Record, &Record),
    (procedure, name): (&str, &str),
    allowed: f64,
) -> f64 {
    let (expected, found) = (
        number(ideal, procedure, name),
        number(real, procedure, name),
    );
    let off = (found - expected).abs();
    assert!(
        off <= allowed,
        "{}: {procedure}.{name} {found} is not within {allowed} of {expected}",
        case.devices
    );
    off
}

/// Compares the results of a rig with those of the ideal rig.
///
/// A target is rounded by at most half the resolution r. The reading of the end position has the same error. The force read thus differs
/// from that of the ideal rig by at most e = K·r/2 + q, where q is half the force resolution.
/// - K of the ramp's line: Σ|x − m|/Σ(x − m)² of 0.1 to 1 mm by 0.1 mm is 3031/m, and the displacements err by r/2 too.
/// - c of five velocities: each mean errs by at most e; Σ|v − m|/Σ(v − m)² of 5 to 100 mm/s is 24.6 s/m.
/// - The impact: K predicts one increment of at most 1.1 mm, and c adds c·v. A beam that vibrates freely, at ω = 641/s, answers a force
///   error with at most (2/π)·ωt·e/K until the striker stops, t = 13.5 ms. The work of e is done along the path, which is at most v·t.
///   The work of the spring is K·X times the error of X. The striker stops one step of 0.5 ms earlier or later.
fn compare(case: &Case, runs: (&Record, &Record)) {
    const STOP: f64 = 0.0135;
    const VELOCITY: f64 = 2.2;
    const LARGEST: f64 = 7.74e-3;
    let rounded = STIFFNESS * case.resolution / 2.0;
    let mut error = rounded + case.force_error;
    error += near(case, runs, ("k0", "stiffness"), (error + rounded) * 3031.0) * 1.1e-3;
    if case.sweeps {
        error += near(case, runs, ("c", "damping"), error * 24.6) * VELOCITY;
    }
    let displacement =
        std::f64::consts::FRAC_2_PI * 641.0 * STOP * error / STIFFNESS + case.resolution;
    near(case, runs, ("hit", "max_displacement"), displacement);
    near(
        case,
        runs,
        ("hit", "absorbed_energy"),
        error * VELOCITY * STOP + STIFFNESS * LARGEST * displacement,
    );
    near(case, runs, ("hit", "stop_time"), 0.5e-3 * 1.001);
    let found = number(runs.1, "hit", "max_displacement");
    assert!(
        (found - LARGEST).abs() < 0.1e-3,
        "{}: {found} m is not the converged 7.74 mm",
        case.devices
    );
}

#[test]
fn the_papers_beam_itself_gives_the_ideal_runs_results_in_every_dialect() {
    for case in CASES {
        let refused: Vec<Code> = case
            .checked("bench", true)
            .diagnostics
            .iter()
            .filter(|it| it.is_error())
            .map(|it| it.code)
            .collect();
        assert_eq!(
            refused,
            if case.sweeps { vec![] } else { vec![E654] },
            "{}",
            case.devices
        );
        let plan = case.plan("ideal");
        let ideal = run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched);
        compare(case, (&ideal, &case.run()));
    }
}

/// Reason for refusing the sweep. Without the guard of the check, the move between two readings acts as a damper. This damper is many
/// times larger than that of the beam.
#[test]
fn a_sweep_with_readings_at_different_times_would_count_the_travel_between_them_as_damping() {
    let case = Case {
        sweeps: true,
        ..case("link = serial(port: \"/a\", dialect: native)", 5e-4)
    };
    let apart = &CASES[4];
    let mut plan = case.plan("bench");
    super::stage::link(&mut plan).actuator = apart
        .plan("bench")
        .rig
        .link
        .as_real()
        .unwrap()
        .actuator
        .clone();
    let emulator = emulator(&plan, "", Log::none(), 1);
    let mut rig = open(&plan, &emulator).unwrap();
    let record = run(&plan, &mut rig, &mut Unwatched);
    assert!(
        number(&record, "c", "damping") > 100.0 * 6.0,
        "{}",
        number(&record, "c", "damping")
    );
}
