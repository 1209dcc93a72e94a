//! The effect of the time step on results: a systematic effect of known sign, which is bounded and not corrected (JCGM 100:2008, 3.2.4
//! and 6.3.1). In: the differences of results in finer steps, as contributions. Out: the interval in which a result lies in any finer steps,
//! and results as they would be there.

use super::contribution::Contribution;
use super::results::{Moved, Results};
use super::source::{Refinement, Source};

/// Results in finer steps, as weights of the differences in own, half and quarter steps: those in half and in quarter steps, and two bounds
/// of those in still finer ones. A method of first order has left after the second halving as much as this halving changed, and half as
/// much as the first one changed. Each bound is three times that, the factor of safety of two grids (Roache, *Annu. Rev. Fluid Mech.* 29
/// (1997) 123–160).
pub const FINER: [[f64; 3]; 4] = [
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, -3.0, 4.0],
    [-1.5, 1.5, 1.0],
];

/// Calls with the results in finer steps, one of [`FINER`].
pub fn in_finer_steps<T>(
    results: &dyn Results,
    weights: [f64; 3],
    then: &mut dyn FnMut(&dyn Results) -> T,
) -> T {
    let shifts: Vec<(Source, f64)> = Refinement::ALL
        .map(Source::TimeStep)
        .into_iter()
        .zip(weights)
        .collect();
    let shifts = &shifts;
    then(&Moved { results, shifts })
}

/// The effect of the time step on one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInterval {
    /// Difference in half of the steps.
    pub half: f64,
    /// Difference in a quarter of the steps.
    pub quarter: f64,
    /// The smallest and the largest difference in any finer steps; one of them is 0 if the steps converge from one side.
    pub ends: [f64; 2],
    /// Whether the steps converge and the record determines the number in finer ones. Otherwise the interval is an estimate.
    pub smooth: bool,
}

impl StepInterval {
    /// From the contributions to one number; None if the time step has no effect on it.
    #[must_use]
    pub fn of(parts: &[Contribution]) -> Option<Self> {
        let of_step = |steps| {
            parts
                .iter()
                .find(move |part| part.source == Source::TimeStep(steps))
        };
        let differences =
            Refinement::ALL.map(|steps| of_step(steps).map_or(0.0, |part| part.amount));
        if differences == [0.0; 3] {
            return None;
        }
        let finer = FINER.map(|weights| {
            weights
                .iter()
                .zip(differences)
                .map(|(weight, difference)| weight * difference)
                .sum::<f64>()
        });
        Some(Self {
            half: differences[1],
            quarter: differences[2],
            ends: [
                finer.into_iter().fold(0.0, f64::min),
                finer.into_iter().fold(0.0, f64::max),
            ],
            smooth: Refinement::ALL
                .into_iter()
                .filter_map(of_step)
                .all(|part| part.smooth),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences of a number whose error is e(Δt) from its value in own steps, reported `late` too large.
    fn interval(late: f64, error: [f64; 3]) -> StepInterval {
        let part = |(steps, error): (Refinement, f64)| {
            Contribution::new(Source::TimeStep(steps), error - late)
        };
        let parts: Vec<Contribution> = Refinement::ALL.into_iter().zip(error).map(part).collect();
        StepInterval::of(&parts).unwrap()
    }

    /// Errors that fall with a power p of the step: the interval has one side, and the exact value, −1 from that of the run, is in it.
    #[test]
    fn the_interval_holds_what_the_steps_converge_to() {
        for order in [0.6, 1.0, 2.0, 4.0] {
            let left = |finer: f64| finer.powf(-order) - 1.0;
            let StepInterval {
                ends: [low, high], ..
            } = interval(0.0, [1.0, 2.0, 4.0].map(left));
            assert!(high == 0.0 && low <= -1.0, "order {order}: {low}, {high}");
            assert!(low > -2.5, "order {order}: {low}");
        }
    }

    /// By hand: half −0.5, quarter −0.75; −0.75 − 3·0.25, −0.75 − 1.5·0.5 are both −1.5. Reported at the end of a step, 0.2 late, the
    /// interval begins there.
    #[test]
    fn the_ends_are_three_times_what_is_left() {
        let found = interval(0.0, [0.0, -0.5, -0.75]);
        assert_eq!(
            (found.half, found.quarter, found.ends),
            (-0.5, -0.75, [-1.5, 0.0])
        );
        let late = interval(0.2, [0.0, -0.5, -0.75]);
        assert!(
            (late.ends[0] + 1.7).abs() < 1e-12 && late.ends[1] == 0.0,
            "{late:?}"
        );
        // Refinement that turn: the interval has both sides.
        let turns = interval(0.0, [0.0, -0.5, -0.25]);
        assert_eq!(turns.ends, [-1.0, 0.5]);
        assert_eq!(StepInterval::of(&[]), None);
    }
}
