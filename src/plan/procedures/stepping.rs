//! The steps of a procedure that integrates: an impact, an impact on a storey, or a ground motion. In: the SI values of the fields of its
//! block. It knows neither the structure nor the excitation.

use crate::formula::Formula;
use crate::{InspectTrigger, Integrator, Mode};

/// Largest number of steps of one procedure, for a frame multiplied by its storeys. `check` counts them if it can; otherwise `run` does.
pub const MOST_STEPS: f64 = 1e7;

/// Largest number of steps of all procedures of one run. A step occupies 0.5 kB to 2 kB of the run log, and a run log of more than 4 GiB
/// is not read back.
pub const MOST_RECORDED_STEPS: u64 = 2_000_000;

/// The step parameters of every procedure that integrates.
#[derive(Clone, Debug)]
pub struct Stepping {
    pub integrator: Integrator,
    /// Whether it may run beyond the stability limit of its integrator.
    pub allow_unstable: bool,
    /// Whether the recursion uses the force at the commanded position, r* = `r_m` − `K_I`(`d_m` − d̃).
    pub i_modification: bool,
    pub mode: Mode,
    /// \[s\]; may read `critical`.
    pub time_step: Formula,
    /// \[s\], at every step.
    pub pause: Formula,
    /// c of "`K_t` is clamped to [0, c·K0]".
    pub max_tangent_ratio: Formula,
    pub inspect: Vec<InspectTrigger>,
}

/// Number of steps of `time_step` in `duration` \[s\]: 0.5 s contains 50 steps of 0.01 s, despite rounding of the ratio.
#[must_use]
pub fn steps_in(duration: f64, time_step: f64) -> f64 {
    (duration / time_step * (1.0 - 1e-12)).ceil()
}

/// The same as an integer, saturating: for bounds, and after it is known to be at most [`MOST_STEPS`].
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
