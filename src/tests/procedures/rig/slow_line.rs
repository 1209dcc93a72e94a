//! A damping sweep with a real rig's driver, over a slow line: native protocol, the simulated rig of the plan, simulated time. c is
//! within its uncertainty although far fewer readings arrive than requested.

use super::{over_a_line, uncertain};
use psd_plan::record::{EventKind, History, Outcome, Record};

/// c and the Coulomb force of the simulated rig \[N·s/m\] and \[N\].
const DAMPING: f64 = 600.0;
const COULOMB: f64 = 12.0;

const PLAN: &str = r#"
specimen beam {
  mass      = 5 kg
  behaviour = elastic(stiffness: 300 kN/m)
  damping   = 600 N*s/m
  coulomb   = 12 N
}

limits bench_limits {
  displacement = -5 mm .. 30 mm
  force        = -15 kN .. 15 kN
  speed        = 150 mm/s
}

rig bench {
  link        = serial(port: "/dev/none", dialect: native)
  settle      = within(0.005 mm, 50 N/s, for: 0.05 s, timeout: 10 s)
  safe_state  = hold
  pretest_check        = probe(0.5 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)
  limits      = bench_limits
  resolution  = 1 um
  noise       = 2 N
  force_range = 15 kN
}

stiffness ramp k0 {
  displacements = 0.1 mm .. 1 mm step 0.1 mm
}

damping sweep c {
  velocities = [5, 10, 20, 50, 100] mm/s
  stroke     = 5 mm
  stiffness  = k0.stiffness
}
"#;

/// Readings of each pass of the sweep, and the least time between two of them \[s\].
fn readings(record: &Record) -> (Vec<usize>, f64) {
    let History::DampingSweep(sweep) = &record.procedures[1].history else {
        panic!("a sweep")
    };
    let strokes = sweep
        .steps
        .chunk_by(|one, other| one.velocity == other.velocity);
    let times = sweep
        .steps
        .windows(2)
        .map(|pair| pair[1].wall_time - pair[0].wall_time);
    (
        strokes.map(<[_]>::len).collect(),
        times.fold(f64::INFINITY, f64::min),
    )
}

#[test]
fn damping_is_recovered_at_one_to_seven_milliseconds_a_reading() {
    for (baud, seed) in [
        (230_400.0, 1),
        (230_400.0, 2),
        (160_000.0, 3),
        (115_200.0, 4),
    ] {
        let record = over_a_line(PLAN, baud, seed);
        assert_eq!(record.outcome, Outcome::Completed, "{:?}", record.events);
        let (strokes, least) = readings(&record);
        assert!(least > 0.0005 && least < 0.008, "{least} s a reading");
        assert!(
            strokes.len() == 10 && strokes.iter().all(|count| *count <= 64),
            "{strokes:?}"
        );
        assert!(
            strokes[9] < 50,
            "50 ms hold fewer readings than were asked for: {strokes:?}"
        );
        for (name, truth) in [("damping", DAMPING), ("coulomb_force", COULOMB)] {
            let (found, error) = uncertain(&record.procedures[1], name);
            assert!(
                (found - truth).abs() <= 3.0 * error,
                "{name}: {found} ± {error}, {truth} at {baud} baud"
            );
            assert!(error < 0.05 * truth.max(40.0), "{name}: ± {error}");
        }
        assert!(
            record
                .events
                .iter()
                .all(|event| event.kind != EventKind::Remark),
            "{:?}",
            record.events
        );
    }
}

#[test]
fn a_line_too_slow_for_the_fast_strokes_is_reported() {
    // At 38400 baud a reading takes some 20 ms: the pass of 50 ms has one or two on its steady part.
    let record = over_a_line(PLAN, 38_400.0, 1);
    assert_eq!(record.outcome, Outcome::Completed, "{:?}", record.events);
    let is_remarked = record.events.iter().any(|event| {
        event.kind == EventKind::Remark && event.text.contains("communication too slow")
    });
    assert!(is_remarked, "{:?}", record.events);
    let (found, error) = uncertain(&record.procedures[1], "damping");
    assert!((found - DAMPING).abs() <= 3.0 * error, "{found} ± {error}");
}
