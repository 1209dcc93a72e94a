//! A relaxing specimen with a real rig's driver: native protocol, the simulated rig of the plan, simulated time. The rig waits half a
//! second in its band after every move; the positions polled during the move show when it moved.

use super::{over_a_line, uncertain};
use psd_plan::record::{History, Outcome};

const PLAN: &str = r#"
specimen joint {
  mass      = 4 kg
  behaviour = maxwell(of: elastic(stiffness: 300 kN/m), stiffness: 120 kN/m, time_constant: 1.7 s)
}

limits bench_limits {
  displacement = -5 mm .. 30 mm
  force        = -15 kN .. 15 kN
  speed        = 150 mm/s
}

rig bench {
  link        = serial(port: "/dev/none", dialect: native)
  settle      = within(0.005 mm, 500 N/s, for: 0.5 s, timeout: 20 s)
  safe_state  = hold
  pretest_check        = probe(0.2 mm, stiffness: 250 kN/m .. 450 kN/m, zero: 20 N)
  limits      = bench_limits
  resolution  = 1 um
  noise       = 2 N
  force_range = 15 kN
}

stiffness ramp k {
  displacements = 1 mm .. 6 mm step 1 mm
  pause         = 4 s
  speed         = 5 mm/s
  relaxation    = standard_linear_solid(readings: 20, accuracy: 5 N)
}
"#;

/// 0.2 s of move, 0.5 s of dwell: treated as one uniform move they gave 103 of 120 kN/m.
#[test]
fn a_real_rig_reports_when_it_moved() {
    let record = over_a_line(PLAN, 115_200.0, 1);
    assert_eq!(record.outcome, Outcome::Completed);
    let ramp = &record.procedures[0];
    let (branch, _) = uncertain(ramp, "branch_stiffness");
    assert!((branch / 120e3 - 1.0).abs() < 0.02, "{branch} N/m");
    let History::StiffnessRamp(history) = &ramp.history else {
        panic!("no ramp")
    };
    for hold in &history.holds {
        assert!(
            (hold.moved_for - 0.2).abs() < 0.1 && hold.settled_for > 0.4,
            "{} s, {} s",
            hold.moved_for,
            hold.settled_for
        );
    }
}
