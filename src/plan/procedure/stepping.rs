//! How a procedure that integrates takes its steps, whatever it steps: an impact, an impact on a storey, a shake. In: what
//! the fields of its block say, SI. It knows neither what is struck nor what shakes.

use crate::plan::formula::Formula;
use crate::plan::{InspectTrigger, Integrator, Mode};

/// Steps of one procedure, of a frame times its storeys, at most. `check` counts them where it can, `run` where it must.
pub const MOST_STEPS: f64 = 1e7;

/// Steps of all procedures of one run, at most. A step takes 0.5 kB to 2 kB of the run log, and no run log of more than 4 GiB
/// is read back.
pub const MOST_RECORDED_STEPS: u64 = 2_000_000;

/// What every procedure that integrates says of its steps.
#[derive(Clone, Debug)]
pub struct Stepping {
    pub integrator: Integrator,
    /// Whether it runs beyond the stability limit of its integrator.
    pub allow_unstable: bool,
    /// Whether the recursion takes the force where the specimen was to be, r* = `r_m` − `K_I`(`d_m` − d̃).
    pub i_modification: bool,
    pub mode: Mode,
    /// s; may read `critical`.
    pub time_step: Formula,
    /// s, at every step.
    pub pause: Formula,
    /// c of "`K_t` is clamped to [0, c·K0]".
    pub max_tangent_ratio: Formula,
    pub inspect: Vec<InspectTrigger>,
}

/// Steps of `time_step` in `duration` (s): 0.5 s of 0.01 s are 50, whatever rounding says of the ratio.
#[must_use]
pub fn steps_in(duration: f64, time_step: f64) -> f64 {
    (duration / time_step * (1.0 - 1e-12)).ceil()
}

/// The same as a count, saturating: for bounds, and once it is known to be at most [`MOST_STEPS`].
#[must_use]
pub fn step_count(duration: f64, time_step: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturating, and no duration is below 0"
    )]
    let steps = steps_in(duration, time_step) as u64;
    steps
}

#[cfg(test)]
mod tests {
    use super::{step_count, steps_in};

    #[test]
    fn a_ratio_that_rounding_lifts_above_a_whole_number_counts_no_step_more() {
        // 0.3 / 0.1 is 2.9999999999999996, 0.7 / 0.1 is 6.999999999999999, 1.1 / 0.1 is 11.000000000000002.
        for (duration, steps) in [(0.3, 3), (0.7, 7), (1.1, 11), (0.5, 5)] {
            assert_eq!(step_count(duration, 0.1), steps);
        }
        assert!((steps_in(0.51, 0.1) - 6.0).abs() < f64::EPSILON);
        assert_eq!(step_count(f64::INFINITY, 0.1), u64::MAX);
    }
}
