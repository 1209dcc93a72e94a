//! The program tested by itself: cases whose answers were derived without it, reckoned by the very code of a run. In:
//! nothing. Out: what came out beside what must. A report prints it, so that whoever reads the numbers sees that the
//! program that made them still reckons right.
//!
//! The answers: Melo et al. 2006, examples 1 and 2 and Fig. 11, to the digits of an event-driven solution and of the scheme
//! itself at the printed step; the critical time step is its eq. (7).

use super::contact::ContactLaw;
use super::critical_time_step;
use super::impact::{ImpactInput, ImpactSolver};
use super::specimen::{Elastic, RestoringForce};
use super::summary::{ImpactSummary, SummaryBuilder};
use crate::plan::Integrator;
use crate::quantity::Dimension;

/// One number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfTest {
    pub case: &'static str,
    pub result: &'static str,
    pub dimension: Dimension,
    /// SI.
    pub computed: f64,
    /// SI.
    pub expected: f64,
    /// Half a unit of the last digit that was derived, SI.
    pub tolerance: f64,
}

impl SelfTest {
    /// Whether the program gives what was derived.
    #[must_use]
    pub fn passed(&self) -> bool {
        (self.computed - self.expected).abs() <= self.tolerance
    }
}

/// Every case. It takes a thousand steps, less than a millisecond.
#[must_use]
pub fn all() -> Vec<SelfTest> {
    let case = |case, result, dimension, computed, expected, tolerance| SelfTest {
        case,
        result,
        dimension,
        computed,
        expected,
        tolerance,
    };
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let (one, two) = (impact(1.0, 327.65, ContactLaw::Rigid, 0.01), impact(0.25, 327.65, ContactLaw::Rigid, 0.01));
    let limited = impact(1.0, 300.0, ContactLaw::Limit { force: 1500.0 }, 0.001);
    vec![
        case("example 1, rigid", "largest displacement", Dimension::LENGTH, one.max_displacement, 0.157_864, 5e-7),
        case("example 1, rigid", "the striker stops at", Dimension::TIME, number(one.stop_time), 0.29, 1e-9),
        case("example 1", "critical time step", Dimension::TIME, critical_time_step(1.0, 327.65), 0.0347, 5e-5),
        case("example 2, rigid", "largest displacement", Dimension::LENGTH, two.max_displacement, 0.168_965, 5e-7),
        case("figure 11, limit 1500 N", "largest displacement", Dimension::LENGTH, limited.max_displacement, 0.165_524, 5e-7),
        case("figure 11, limit 1500 N", "the striker stops at", Dimension::TIME, number(limited.stop_time), 0.3, 1e-9),
    ]
}

/// Whether every case gives what was derived.
#[must_use]
pub fn passed() -> bool {
    all().iter().all(SelfTest::passed)
}

/// A striker of 10 kg at 1 m/s that touches an undamped, linear structure at t = 0, to its end.
fn impact(mass: f64, stiffness: f64, law: ContactLaw, time_step: f64) -> ImpactSummary {
    /// Ten times as many as the longest case takes.
    const STEPS: u32 = 4000;
    let input = ImpactInput {
        mass,
        damping: 0.0,
        stiffness,
        striker_mass: 10.0,
        striker_velocity: 1.0,
        gap: 0.0,
        gravity: 0.0,
        time_step,
        max_tangent_ratio: 2.0,
        law,
        integrator: Integrator::Tangent,
        operator_stiffness: stiffness,
        i_modification: false,
        force_noise: 0.0,
        resolution: 0.0,
    };
    let mut specimen = Elastic { stiffness };
    let mut solver = ImpactSolver::new(&input, 0.0, specimen.move_to(0.0));
    let mut summary = SummaryBuilder::new(&input);
    summary.push(solver.state());
    for _ in 0..STEPS {
        if solver.finished() {
            break;
        }
        let displacement = solver.predict();
        summary.push(solver.complete(displacement, specimen.move_to(displacement)));
    }
    summary.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_passes_and_a_wrong_number_does_not() {
        let all = all();
        assert!(all.len() >= 6 && passed(), "{all:?}");
        for case in all {
            let beyond = SelfTest { computed: case.expected + 1.01 * case.tolerance, ..case };
            let nothing = SelfTest { computed: f64::NAN, ..case };
            assert!(!beyond.passed() && !nothing.passed());
        }
    }
}
