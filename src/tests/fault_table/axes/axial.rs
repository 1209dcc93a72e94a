//! Constant axial load on a rig over a line: the controller holds the force. A run equals that on a virtual rig. Whatever is lost, the
//! controller keeps the load, or holds the displacement, and psd stops. A run killed at any write resumes under its load.

use super::two_axes::{checked, messages, results, same};
use super::{killed, logged_run};
use crate::run::replay;
use crate::run::replay::{Bands, RigBody};
use crate::run::{Inspection, Motion, Observer, StepReport, Unwatched};
use crate::tests::fault_table::interrupted::cut_off::cut_off_anywhere;
use crate::tests::fault_table::stage::{Ended, emulator, link, open, run, run_watched};
use crate::tests::testing::run_unwatched;
use psd_plan::Plan;
use psd_plan::record::{EventKind, Record, UNLOADING};
use psd_rig::emulator::Log;
use psd_rig::emulator::firmware::sealed;
use psd_rig::transport::{Clock as _, Port as _};
use psd_rig::{LineStatistics, Rig as _};
use psd_testing::emulator::InProcess;
use psd_testing::journal::PowerLoss;
use std::time::Duration;

/// One column that is loaded with 262.5 kN. The axial axis has the other polarity.
const PLAN: &str = r#"
param load = 262.5 kN

specimen column {
  storeys = [
    storey(
      mass: 26.76 t,
      height: 3 m,
      gravity: load,
      behaviour: bilinear(stiffness: 4 MN/m, yield_force: 40 kN, post_yield_ratio: 8 %),
    ),
  ]
}

ground motion { file = "ground/three_sines.csv" }

limits {
  displacement = -60 mm .. 60 mm
  force        = -300 kN .. 300 kN
  speed        = 500 mm/s
}

rig frame_rig {
  link        = serial(port: "/dev/ttyUSB0", dialect: native, reply_timeout: 0.1 s)
  settle      = within(0.005 mm, 50 kN/s, for: 0.05 s, timeout: 0.5 s)
  safe_state  = hold
  speed       = 100 mm/s
  rate        = 50 Hz
  resolution  = 1 nm
  force_range = 310 kN
  axes        = [
    axis(storey: 1, force: 80 kN, pretest_check: probe(0.05 mm, stiffness: 3 MN/m .. 5 MN/m, zero: 5 N)),
    axis(
      axial: 1,
      control: force(rate: 50 kN/s, tolerance: 0.5 kN),
      p_delta: 100 %,
      displacement: -4 mm .. 4 mm,
      polarity: negative,
    ),
  ]
}

preload vertical {
  storey = 1
  force  = load
}

move out { to = 8 mm }

shake quake {
  ground        = motion
  scale         = 0.5
  duration      = 0.3 s
  damping_ratio = 2 %
  integrator    = alpha_os(alpha: -0.05)
  time_step     = 10 ms
}

unload rest { }

require "load" abs(vertical.axial_force - load) < 0.5 kN
"#;

const LOAD: f64 = 262_500.0;

/// All numbers of a record.
fn numbers(record: &Record) -> Vec<(&'static str, f64)> {
    let procedures = record.procedures.iter();
    let alone = procedures.map(|procedure| Record {
        procedures: vec![procedure.clone()],
        ..record.clone()
    });
    alone.flat_map(|record| results(&record)).collect()
}

/// The line resolves 1 nm and 1 mN.
fn far(name: &str, size: f64) -> f64 {
    match name {
        "tracking_energy_error" | "nrms_error" => 1e-5,
        "residual_force" | "residual_shear" => 1.0,
        "axial_force" | "axial_displacement" => 1e-9 + 1e-12 * size,
        _ => 2e-6 + 1e-5 * size,
    }
}

fn plan() -> Plan {
    checked(PLAN, "frame_rig")
}

/// The force of the axial actuator, in compression \[N\].
fn load_of(emulator: &InProcess) -> f64 {
    -emulator.lock().rig().axial_force(1).unwrap()
}

fn is_in_force_control(emulator: &InProcess) -> bool {
    emulator.lock().rig().force_control(1).is_some()
}

#[test]
fn a_run_under_load_is_that_on_a_virtual_rig() {
    let ended = run(&plan(), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    assert_eq!(ended.line_statistics, LineStatistics::default());
    let ideal = run_unwatched(&plan().on_an_ideal_rig());
    // The line resolves 1 nm and 1 mN.
    same(
        &numbers(&ended.record),
        &numbers(&ideal),
        |name, size| match name {
            "tracking_energy_error" | "nrms_error" => 1e-5,
            "residual_force" | "residual_shear" => 1.0,
            "axial_force" | "axial_displacement" => 1e-9 + 1e-12 * size,
            _ => 2e-6 + 1e-5 * size,
        },
    );
    let notes = ended.events(EventKind::Note);
    let under_load = notes
        .iter()
        .find(|note| note.starts_with("under the axial load"));
    // φ N/h = 87.5 kN/m.
    assert_eq!(
        *under_load.unwrap(),
        "under the axial load the stiffness of axis 1 is 3.913 MN/m, lower by 87.50 kN/m (87.50 kN/m expected)"
    );
    assert_eq!(load_of(&ended.emulator), 0.0, "`unload` takes it off");
    for procedure in &ended.record.procedures {
        let readings = procedure.axial.iter();
        let off = readings.filter(|reading| (reading.force - reading.target).abs() > 1.0);
        assert_eq!(off.count(), 0, "{}", procedure.name);
    }
}

/// The column is loaded, moved and unloaded.
fn short() -> Plan {
    let (first, rest) = PLAN.split_once("shake quake {").unwrap();
    let (_, rest) = rest.split_once("unload rest").unwrap();
    checked(&format!("{first}unload rest{rest}"), "frame_rig")
}

/// psd stopped for `why`; the axial actuator kept the load, or a part of it while the load was growing.
fn kept(plan: &Plan, script: &str, why: &str) -> Ended {
    let ended = run(plan, script);
    assert!(ended.reason().contains(why), "{script}: {}", ended.reason());
    if let Some(held) = ended.log.find("actuator > !") {
        assert!(!ended.log[held..].contains(" bench move "), "{script}");
    }
    // Over a lost line the watchdog holds.
    ended.emulator.clock().sleep(10.0);
    assert!(!ended.emulator.lock().rig().moving(), "{script}");
    assert!(
        load_of(&ended.emulator) > 1e4,
        "{script}: {} N",
        load_of(&ended.emulator)
    );
    let notes = ended.events(EventKind::Note);
    assert!(
        notes
            .iter()
            .any(|note| note.starts_with("the axial load of storey 1 was not taken off")),
        "{notes:?}"
    );
    ended
}

#[test]
fn a_load_that_its_cell_or_its_band_loses_is_held_by_displacement() {
    for (script, why, load) in [
        (
            "after 31 moves: axis 2 scale force by 0",
            "axis 2: it left force control because its force did not follow",
            LOAD,
        ),
        (
            "after 31 moves: axis 2 drift displacement -5 mm/s",
            "axis 2: it left force control because its displacement left its band",
            LOAD,
        ),
        // While the load grows.
        (
            "after 5 moves: axis 2 clip force at 100000 N",
            "axis 2: it left force control because its force did not follow",
            100.5e3,
        ),
    ] {
        let ended = kept(&plan(), script, why);
        assert!(!is_in_force_control(&ended.emulator), "{script}");
        let found = load_of(&ended.emulator);
        assert!(
            (found - load).abs() < 200.0,
            "{script}: {found}, not {load}"
        );
        // Before a person has taken the load off, psd does not open the rig again.
        let refused = open(&plan(), &ended.emulator).err().unwrap().to_string();
        assert!(
            refused.contains("left force control") && refused.contains("--let-go"),
            "{refused}"
        );
    }
}

/// The table of the manual: what stops the run, and whether the controller still holds the force.
#[test]
fn every_row_of_the_manual_stops_the_run_and_keeps_the_load() {
    let manual = include_str!("../../../../docs/reference/emulator-faults.md");
    let (_, section) = manual
        .split_once("## Faults beside an axis in force control")
        .unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    let rows = section.lines().filter_map(|line| {
        let mut cells = line.strip_prefix("| `")?.strip_suffix(" |")?.split(" | ");
        let script = cells.next()?.trim_end_matches('`');
        let message = cells.next()?.trim_matches('`');
        Some((script, message, cells.next()?))
    });
    let rows: Vec<(&str, &str, &str)> = rows.collect();
    assert!(rows.len() >= 8, "{rows:?}");
    let mut noisy = plan();
    link(&mut noisy).axes[1].noise = Some(5.0);
    for (script, message, after) in rows {
        let plan = if script.contains("freeze force") {
            noisy.clone()
        } else {
            plan()
        };
        let ended = kept(&plan, script, message);
        assert_eq!(
            is_in_force_control(&ended.emulator),
            after == "the force",
            "{script}"
        );
    }
}

#[test]
fn the_load_is_held_while_the_host_is_away_and_when_it_comes_again() {
    let plan = plan();
    let ended = run(&plan, "after 31 moves: axis 1 stick");
    let emulator = ended.emulator;
    emulator.clock().sleep(60.0);
    let held = |emulator: &InProcess| {
        let rig = emulator.lock();
        (
            rig.rig().axial_force(1),
            rig.rig().force_control(1).is_some(),
            rig.rig().moving(),
        )
    };
    assert_eq!(held(&emulator), (Some(-LOAD), true, false), "the watchdog");
    let mut rig = open(&plan, &emulator).unwrap();
    assert_eq!(
        held(&emulator),
        (Some(-LOAD), true, false),
        "HELLO, CLR, LIM, FORCE"
    );
    assert_eq!(rig.read().unwrap().force[1], LOAD);
    // A run that begins again has no load yet: it does not begin.
    let again = crate::run::run(&plan, &mut rig, &mut Unwatched).outcome;
    assert!(
        format!("{again:?}").contains("force error of axis 2"),
        "{again:?}"
    );
    assert_eq!(held(&emulator), (Some(-LOAD), true, false));
}

/// A plan that moves the second axis by its displacement does not begin while its controller holds a force.
#[test]
fn a_force_that_the_plan_does_not_know_is_a_fault() {
    let ended = run(&plan(), "after 31 moves: axis 1 stick");
    let mut other = plan();
    link(&mut other).axes[1].axial = None;
    let refused = open(&other, &ended.emulator).err().unwrap().to_string();
    assert!(
        refused.contains("axis 2: its controller holds a force"),
        "{refused}"
    );
    assert_eq!(load_of(&ended.emulator), LOAD);
}

/// Killed at any write, and after three times the watchdog of 3 s without a host: the load is held, no motion is repeated, and the run ends
/// as the whole one.
#[test]
fn killed_anywhere_it_goes_on_under_its_load() {
    let plan = short();
    let whole = run(&plan, "");
    assert!(whole.completed(), "{}", whole.reason());
    let wanted = numbers(&whole.record);
    let away = |emulator: &InProcess| {
        let before = emulator.lock().rig().axial_force(1);
        let is_loaded = is_in_force_control(emulator);
        emulator.clock().sleep(9.0);
        let rig = emulator.lock();
        assert_eq!(rig.rig().force_control(1).is_some(), is_loaded);
        let found = rig.rig().axial_force(1).unwrap();
        // A force that was on its way goes on until the watchdog.
        assert!((found - before.unwrap()).abs() <= 3.1 * 50e3);
    };
    cut_off_anywhere(&plan, 12, away, |record, _| {
        for ((name, found), (_, wanted)) in numbers(record).into_iter().zip(&wanted) {
            assert!(
                (found - wanted).abs() <= far(name, wanted.abs()),
                "{name}: {found}, not {wanted}"
            );
        }
    });
}

#[test]
fn a_load_that_was_taken_off_meanwhile_is_not_applied_again() {
    let plan = short();
    let (emulator, disk) = (emulator(&plan, "", Log::none(), 1), PowerLoss::new());
    assert!(killed(&plan, &emulator, &disk, (90, false)));
    assert_eq!(load_of(&emulator), LOAD);
    let mut port = emulator.port(0);
    let requests = [
        "HELLO 1",
        "CLR 2",
        "LIM 3 -60 60 -80000 80000 -4 4 -300000 300000 500",
        "FORCE 4 0 0 500000 500",
        "MOVE 5 1000 8 0 10",
    ];
    for request in requests {
        port.write(&sealed(request), Duration::from_secs(1))
            .unwrap();
        emulator.clock().sleep(0.01);
    }
    emulator.clock().sleep(10.0);
    assert_eq!(load_of(&emulator), 0.0);
    let (_, logged) = logged_run(&disk);
    let mut rig = open(&plan, &emulator).unwrap();
    let (found, about) = (rig.read().unwrap(), RigBody::of(&rig));
    let bands = Bands::of(&plan.rig, plan.rig.link.as_real().unwrap());
    let refused = replay::decide(&logged, &about, &found, &bands, false).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "axis 2 holds 0 kN, but the run log allows 0.262 MN .. 0.263 MN: the axial load of the run is not on the specimen any more"
    );
}

/// Stops after a number of steps, and answers whether the rig may be unloaded.
struct StopsAndUnloads {
    steps: usize,
    questions: Vec<String>,
}

impl Observer for StopsAndUnloads {
    fn release(&mut self, note: &str, motion: &Motion) -> Inspection {
        Unwatched.release(note, motion)
    }

    fn step_done(&mut self, _: &StepReport) {
        self.steps = self.steps.saturating_sub(1);
    }

    fn stop_requested(&self) -> bool {
        self.steps == 0
    }

    fn may_unload(&mut self, question: &str, _: &Motion) -> Option<Inspection> {
        self.questions.push(question.to_owned());
        Some(Inspection::GoOn {
            note: None,
            by: None,
        })
    }
}

/// After a stop a load is taken off if the operator wants it, and never without a question.
#[test]
fn a_stopped_specimen_is_unloaded_for_the_operator_alone() {
    let plan = checked(
        &PLAN.replace("safe_state  = hold", "safe_state  = unload"),
        "frame_rig",
    );
    let ended = kept(
        &plan,
        "after 31 moves: axis 1 drift force 1000000 N/s",
        "force",
    );
    let holds = ended.events(EventKind::Hold);
    assert!(!holds.contains(&UNLOADING), "{holds:?}");
    let mut operator = StopsAndUnloads {
        steps: 20,
        questions: Vec::new(),
    };
    let ended = run_watched(&plan, "", &mut operator).unwrap();
    assert_eq!(operator.questions.len(), 1, "{}", ended.reason());
    let asked = "its start position; there AXIAL of storey 1 takes off its 262.5 kN";
    assert!(
        operator.questions[0].ends_with(asked),
        "{:?}",
        operator.questions
    );
    assert!(load_of(&ended.emulator).abs() < 1e-6);
    assert!(ended.emulator.lock().rig().commanded_of(0).abs() < 1e-9);
    let notes = ended.events(EventKind::Note);
    assert!(
        !notes.iter().any(|note| note.contains("was not taken off")),
        "{notes:?}"
    );
}

#[test]
fn beside_an_axial_axis_no_motion_is_read_on_its_way() {
    for continuous in [
        PLAN.replace(
            "alpha: -0.05)",
            "alpha: -0.05)\n  mode = continuous(time_scale: 100)",
        ),
        PLAN.replace(
            "move out { to = 8 mm }",
            "cycle out {\n  amplitudes = [5, 8] mm\n  speed = 1 mm/s\n  rate = 20 Hz\n}",
        ),
    ] {
        assert_ne!(continuous, PLAN);
        assert_eq!(
            messages(&continuous, "frame_rig", "E644"),
            ["the real rig has an axial axis: beside it the controller moves to targets only"]
        );
    }
}

#[test]
fn the_release_states_the_load_its_rate_and_what_holds_it() {
    let ended = run(&short(), "");
    assert_eq!(
        ended.events(EventKind::Inspection)[0],
        "release rig frame_rig: it MOVES by 50 µm and back (pre-test check), then MOVES as the plan specifies; AXIAL of storey 1 LOADS it to \
         262.5 kN at 50000 N/s and holds this in FORCE CONTROL until `unload`, also if psd ends"
    );
}

/// The apparatus has another share of the P-Δ than the plan states.
#[test]
fn a_wrong_share_of_the_p_delta_is_seen_before_the_test() {
    let plan = short();
    let mut apparatus = plan.clone();
    if let Some(axial) = &mut link(&mut apparatus).axes[1].axial {
        axial.p_delta = 0.0;
    }
    let emulator = emulator(&apparatus, "", Log::none(), 1);
    let mut rig = open(&plan, &emulator).unwrap();
    let record = crate::run::run(&plan, &mut rig, &mut Unwatched);
    let remarks = record.events.iter();
    let mut remarks = remarks.filter(|event| event.kind == EventKind::Remark);
    let seen = remarks.any(|event| {
        event.text
            == "under the axial load the stiffness of axis 1 is 4.000 MN/m, lower by 0 kN/m (87.50 kN/m expected)"
    });
    assert!(seen, "{:?}", record.events);
}
