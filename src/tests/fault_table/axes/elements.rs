//! Elements of a frame of matrices on two axes of an emulated rig: a pier at a scale and a bearing between two degrees of freedom. The run
//! equals that on a virtual rig, and the pre-test check measures each element alone.

use super::held;
use super::two_axes::{checked, ideal, results, same};
use crate::tests::fault_table::stage::run;

const PLAN: &str = r#"
specimen bridge {
  mass_matrix      = "mass.csv"
  stiffness_matrix = "stiffness.csv"
  elements = [
    element(from: 0, to: 2, stiffness: 300 kN/m, part: tested(scale: 1 / 2, represents: 2)),
    element(from: 0, to: 3, part: computed, behaviour: bilinear(stiffness: 250 kN/m, yield_force: 1 kN, post_yield_ratio: 10 %)),
    element(from: 3, to: 1, stiffness: 200 kN/m),
  ]
}

ground motion { file = "ground.csv" }

limits {
  displacement = -60 mm .. 60 mm
  force        = -20 kN .. 20 kN
  speed        = 500 mm/s
}

rig frame_rig {
  link        = serial(port: "/dev/ttyUSB0", dialect: native, reply_timeout: 0.1 s)
  settle      = within(0.005 mm, 5 kN/s, for: 0.05 s, timeout: 0.5 s)
  safe_state  = hold
  speed       = 100 mm/s
  rate        = 50 Hz
  resolution  = 1 nm
  force_range = 25 kN
  axes        = [
    axis(element: 1, pretest_check: probe(0.05 mm, stiffness: 70 kN/m .. 80 kN/m, zero: 5 N)),
    axis(element: 3, polarity: negative, pretest_check: probe(0.05 mm, stiffness: 190 kN/m .. 210 kN/m, zero: 5 N)),
  ]
}

shake quake {
  ground        = motion
  damping_ratio = 2 %
  integrator    = alpha_os(alpha: -0.05)
  time_step     = 10 ms
  duration      = 0.5 s
}

require "deck" max(quake.max_displacement) < 60 mm
"#;

#[test]
fn on_two_axes_elements_move_as_on_a_virtual_rig() {
    let ended = run(&checked(PLAN, "frame_rig"), "");
    assert!(ended.completed(), "{}\n{}", ended.reason(), ended.tail());
    let found = results(&ended.record);
    // The line resolves 1 nm and 1 mN of the rig.
    same(&found, &ideal(PLAN), |name, size| {
        if name.contains("energy_error") || name.contains("nrms_error") {
            1e-5
        } else {
            1e-6 + 1e-5 * size
        }
    });
    let moved = found.iter().filter(|(name, _)| *name == "max_displacement");
    let moved: Vec<f64> = moved.map(|(_, moved)| *moved).collect();
    assert!(moved.len() == 3 && moved[1] > 0.005, "{moved:?}");
}

/// Each element has its own stiffness at its axis, so that an exchange of the two is found before the test.
#[test]
fn two_elements_that_are_exchanged_are_found_by_the_pretest_check() {
    let (pier, bearing) = ("70 kN/m .. 80 kN/m", "190 kN/m .. 210 kN/m");
    let exchanged = PLAN
        .replace(pier, "PIER")
        .replace(bearing, pier)
        .replace("PIER", bearing);
    let ended = run(&checked(&exchanged, "frame_rig"), "");
    held(
        &ended,
        "the stiffness of axis 1 in a move of 50 µm is 75.00 kN/m",
    );
}
