//! Effect of an actuator that misses its target on a run, through the solver: the amplitudes of the physics reference (section 11), the
//! I-modification, and the energy that the monitor sees.

use psd_physics::impact::{ImpactInput, ImpactSolver};
use psd_physics::tracking::monitor::{Monitor, TrackedStep, Tracking};
use psd_plan::Integrator;

use super::methods::vibration;

const PERIOD: f64 = 0.5;
const TIME_STEP: f64 = 0.01;
const CYCLES: u32 = 10;
const STEPS_A_CYCLE: u32 = 50;

/// Position of an actuator after the command `target`, from the last target and position \[m\].
type Actuator = fn(target: f64, last_target: f64, last_position: f64) -> f64;

/// Ten per cent short of its increment, measured from the last target.
const SHORT: Actuator = |target, last, _| last + 0.9 * (target - last);
const BEYOND: Actuator = |target, last, _| last + 1.1 * (target - last);
/// Short by 2 % of the first amplitude, against the motion.
const BEHIND: Actuator = |target, last, _| target - 0.02 * (target - last).signum();
/// An actuator that starts from its present position.
const SHORT_OF_THE_MOVE: Actuator = |target, _, position| position + 0.9 * (target - position);
const BEYOND_THE_MOVE: Actuator = |target, _, position| position + 1.1 * (target - position);

/// Largest |d| over the last of ten cycles, including its start, from 1 m at rest; and the final values of the monitor.
fn amplitude(integrator: Integrator, i_modification: bool, actuator: Actuator) -> (f64, Tracking) {
    let stiffness = (2.0 * std::f64::consts::PI / PERIOD).powi(2);
    let input = ImpactInput {
        i_modification,
        ..vibration(integrator, 1.0, 0.0, stiffness, TIME_STEP)
    };
    let mut solver = ImpactSolver::new(&input, 1.0, stiffness).expect("an impact");
    let reached = |commanded: f64, measured: f64| TrackedStep {
        commanded,
        measured,
        force: stiffness * measured,
        effective_force: stiffness * measured,
    };
    let mut monitor = Monitor::new(&reached(1.0, 1.0));
    let (mut last_target, mut position, mut largest) = (1.0, 1.0, 0.0_f64);
    for step in 1..=CYCLES * STEPS_A_CYCLE {
        let target = solver.predict();
        position = actuator(target, last_target, position);
        last_target = target;
        let displacement = solver.complete(position, stiffness * position).displacement;
        monitor.take(&reached(target, position));
        if step >= (CYCLES - 1) * STEPS_A_CYCLE {
            largest = largest.max(displacement.abs());
        }
    }
    (largest, monitor.tracking())
}

const SPLITTING: Integrator = Integrator::AlphaOs { alpha: 0.0 };

/// The factors of the reference: to half a unit of the last digit printed there, explicit Newmark to one.
#[test]
fn ten_cycles_of_tracking_error_grow_or_shrink_as_printed() {
    let cases = [
        (SPLITTING, false, SHORT, 1.4736, 5e-5),
        (SPLITTING, false, BEYOND, 0.7005, 5e-5),
        (SPLITTING, false, BEHIND, 1.7856, 5e-5),
        (SPLITTING, true, BEHIND, 0.9989, 5e-5),
        (Integrator::Explicit, false, SHORT_OF_THE_MOVE, 1.549, 1e-3),
        (Integrator::Explicit, false, BEYOND_THE_MOVE, 0.723, 1e-3),
    ];
    for (integrator, corrected, actuator, printed, digits) in cases {
        let (found, _) = amplitude(integrator, corrected, actuator);
        assert!(
            (found - printed).abs() <= digits,
            "{integrator:?}, corrected {corrected}: {found}, printed {printed}"
        );
    }
}

/// The tracking-error energy of the monitor equals the gain of the amplitude: ½K(A² − 1) to the order of the error squared.
#[test]
fn the_monitor_sees_the_energy_that_tracking_puts_in() {
    let stiffness = (2.0 * std::f64::consts::PI / PERIOD).powi(2);
    for actuator in [SHORT, BEYOND, BEHIND] {
        let (grown, tracking) = amplitude(SPLITTING, false, actuator);
        let gained = 0.5 * stiffness * (grown * grown - 1.0);
        assert!(
            (tracking.energy_error + gained).abs() < 0.15 * gained.abs(),
            "{tracking:?}, gained {gained} J"
        );
        assert_eq!(
            tracking.indicator < 0.0,
            gained > 0.0,
            "a lag encloses its area the other way round"
        );
    }
    let (kept, corrected) = amplitude(SPLITTING, true, BEHIND);
    assert!(
        (kept - 1.0).abs() < 2e-3 && corrected.indicator < 0.0,
        "corrected, not followed better"
    );
}
