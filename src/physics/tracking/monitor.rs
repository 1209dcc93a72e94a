//! Tracking monitors of a hybrid test, one for each degree of freedom. In: commanded displacement, measured displacement and force of
//! every step. Out: sums so far. It knows no rig: the caller compares the sums with the limits.
//!
//! With d_c commanded, d_m measured and r_m the force read, by the trapezoidal rule over the steps:
//!
//! ```text
//! energy error        E_err = ∫ r_m dd_c − ∫ r_m dd_m          J
//! tracking indicator  TI = ½(∫ d_m dd_c − ∫ d_c dd_m)          m²
//! NRMS error          √(Σ(d_m − d_c)² / Σ d_c²)                1
//! peak error          max |d_m − d_c|                          m
//! ```
//!
//! If the recursion uses an effective force r* in place of the reading, as under the I-modification, r* = r_m − K_I(d_m − d_c). It then
//! assumes that the specimen moves from d_m to d_c along K_I. The monitors make the same assumption:
//!
//! ```text
//! E_err = ∫ r* dd_c − (∫ r_m dd_m + ∫_{d_m}^{d_c} r dx),    ∫_{d_m}^{d_c} r dx = ½(r_m + r*)(d_c − d_m)
//! ```
//!
//! The energy that the specimen would store between d_m and d_c is released when the actuator arrives there, and is not an error. On a
//! spring K = K_I the error is zero at every step, however large the lag. Without the last term it would oscillate by sin φ of ½KA² twice
//! per cycle of A sin ωt and end as it began. Only the difference between the specimen and K_I remains.
//!
//! **Energy error**: the recursion assumes that the specimen absorbs ∫ r_m dd_c, but it absorbs ∫ r_m dd_m. Negative: the tracking adds
//! energy to the test, and its amplitudes grow. Positive: it removes energy, as damping does. As a fraction of the input energy, it is
//! the one number by which a test is stopped.
//! **Tracking indicator**: the area that the curve of command against measurement encloses. It falls as long as the actuator lags and
//! rises while it leads. A proportional error does not change it.
//! **NRMS and peak error** give the size, not the direction.

use serde::{Deserialize, Serialize};

/// Fraction of the input energy at which the report makes an observation. Half a per cent of damping ratio over a dozen cycles has this
/// size: a larger error is visible in the results.
pub const WARN: f64 = 0.02;
/// Default fraction of the input energy at which the rig is held.
pub const HOLD: f64 = 0.05;

/// The tracking errors after a step.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Tracking {
    /// E_err \[J\]; negative: tracking adds energy.
    pub energy_error: f64,
    /// TI \[m²\]; falling: the actuator lags.
    pub indicator: f64,
    /// Root mean square of the error over that of the command; 0 as long as nothing was commanded.
    pub nrms_error: f64,
    /// Largest |measured − commanded| so far \[m\].
    pub peak_error: f64,
}

impl Tracking {
    /// All axes of a specimen together: energies and areas add; for the others the largest counts.
    #[must_use]
    pub fn together(axes: &[Self]) -> Self {
        axes.iter().fold(Self::default(), |all, axis| Self {
            energy_error: all.energy_error + axis.energy_error,
            indicator: all.indicator + axis.indicator,
            nrms_error: all.nrms_error.max(axis.nrms_error),
            peak_error: all.peak_error.max(axis.peak_error),
        })
    }

    /// E_err as a fraction of the input energy \[J\], with its sign; None if the input is zero.
    #[must_use]
    pub fn share_of(&self, input_energy: f64) -> Option<f64> {
        (input_energy > 0.0).then(|| self.energy_error / input_energy)
    }
}

/// One axis at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct TrackedStep {
    /// d_c \[m\]
    pub commanded: f64,
    /// d_m \[m\]
    pub measured: f64,
    /// r_m \[N\]
    pub force: f64,
    /// r*, with which the recursion continues at the command \[N\]: r_m if nothing corrects it.
    pub effective_force: f64,
}

impl TrackedStep {
    /// r* − r_m \[N\]
    fn corrected(&self) -> f64 {
        self.effective_force - self.force
    }

    /// ½(r_m + r*)(d_c − d_m) \[J\]; zero without a force correction, because then nothing is assumed between the two displacements.
    fn work_behind(&self) -> f64 {
        let corrected = self.corrected();
        if corrected == 0.0 {
            0.0
        } else {
            (self.force + 0.5 * corrected) * (self.commanded - self.measured)
        }
    }
}

/// Sums up the steps of one degree of freedom.
#[derive(Clone, Copy, Debug)]
pub struct Monitor {
    last: TrackedStep,
    /// ∫ r* dd_c − ∫ r_m dd_m \[J\].
    integrated: f64,
    /// Work between the measured and the commanded displacement before the first step \[J\].
    behind_at_start: f64,
    errors: f64,
    commands: f64,
    tracking: Tracking,
}

impl Monitor {
    /// From the command and the reading before the first step. The recursion begins with the measured force.
    #[must_use]
    pub fn new(start: &TrackedStep) -> Self {
        let mut monitor = Self {
            last: TrackedStep {
                effective_force: start.force,
                ..*start
            },
            integrated: 0.0,
            behind_at_start: start.work_behind(),
            errors: 0.0,
            commands: 0.0,
            tracking: Tracking::default(),
        };
        monitor.size(start);
        monitor
    }

    /// Adds a step.
    pub fn take(&mut self, step: &TrackedStep) -> Tracking {
        let last = self.last;
        let (asked, went) = (
            step.commanded - last.commanded,
            step.measured - last.measured,
        );
        let tracking = &mut self.tracking;
        self.integrated += 0.5 * (last.force + step.force) * (asked - went)
            + 0.5 * (last.corrected() + step.corrected()) * asked;
        tracking.energy_error = self.integrated - (step.work_behind() - self.behind_at_start);
        tracking.indicator += 0.25
            * ((last.measured + step.measured) * asked - (last.commanded + step.commanded) * went);
        self.last = *step;
        self.size(step);
        self.tracking
    }

    /// The tracking error so far.
    #[must_use]
    pub const fn tracking(&self) -> Tracking {
        self.tracking
    }

    fn size(&mut self, step: &TrackedStep) {
        let error = step.measured - step.commanded;
        self.errors += error * error;
        self.commands += step.commanded * step.commanded;
        self.tracking.peak_error = self.tracking.peak_error.max(error.abs());
        self.tracking.nrms_error = if self.commands > 0.0 {
            (self.errors / self.commands).sqrt()
        } else {
            0.0
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STIFFNESS: f64 = 1000.0;
    const STEPS: u32 = 4000;

    /// A step whose force is not corrected.
    fn uncorrected(commanded: f64, measured: f64, force: f64) -> TrackedStep {
        TrackedStep {
            commanded,
            measured,
            force,
            effective_force: force,
        }
    }

    /// One cycle of A sin ωt; the actuator moves to `position`.
    fn cycle(amplitude: f64, position: impl Fn(f64) -> f64) -> Tracking {
        let at = |step: u32| std::f64::consts::TAU * f64::from(step) / f64::from(STEPS);
        let mut monitor = Monitor::new(&uncorrected(0.0, position(0.0), STIFFNESS * position(0.0)));
        for step in 1..=STEPS {
            let angle = at(step);
            let measured = position(angle);
            monitor.take(&uncorrected(
                amplitude * angle.sin(),
                measured,
                STIFFNESS * measured,
            ));
        }
        monitor.tracking()
    }

    /// A lag of φ on a spring: E_err = −πKA² sin φ and TI = −πA² sin φ per cycle; a lead gives the opposite sign.
    #[test]
    fn a_lag_puts_energy_in_and_a_lead_takes_it_out() {
        let (amplitude, phase): (f64, f64) = (0.01, 0.1);
        for sign in [-1.0, 1.0] {
            let found = cycle(amplitude, |angle| amplitude * (angle + sign * phase).sin());
            let area = std::f64::consts::PI * amplitude * amplitude * phase.sin();
            assert!(
                (found.energy_error - sign * STIFFNESS * area).abs() < 1e-5 * STIFFNESS * area,
                "{found:?}"
            );
            assert!(
                (found.indicator - sign * area).abs() < 1e-5 * area,
                "{found:?}"
            );
            // |sin(a + φ) − sin a| is at most 2 sin(φ/2). This is also its ratio of root mean squares.
            assert!((found.peak_error - 2.0 * amplitude * (0.5 * phase).sin()).abs() < 1e-8);
            assert!(
                (found.nrms_error - 2.0 * (0.5 * phase).sin()).abs() < 1e-4,
                "{found:?}"
            );
        }
    }

    /// A proportional error stores energy and releases it: nothing remains after a cycle, and no area is enclosed.
    #[test]
    fn an_error_of_gain_shows_in_its_size_only() {
        let found = cycle(0.01, |angle| 0.009 * angle.sin());
        assert!(found.energy_error.abs() < 1e-12 && found.indicator.abs() < 1e-15);
        assert!((found.nrms_error - 0.1).abs() < 1e-12 && (found.peak_error - 0.001).abs() < 1e-12);
    }

    /// A cycle of A sin ωt with a lag of φ on a spring K, corrected along `operator`: the error at every step.
    fn corrected(
        amplitude: f64,
        phase: f64,
        operator: f64,
        force: impl Fn(f64) -> f64,
    ) -> Vec<f64> {
        let angle = |step: u32| std::f64::consts::TAU * f64::from(step) / f64::from(STEPS);
        let position = |angle: f64| amplitude * (angle - phase).sin();
        let effective_force =
            |commanded: f64, measured: f64| force(measured) - operator * (measured - commanded);
        let first = position(0.0);
        let step = |commanded: f64, measured: f64| TrackedStep {
            commanded,
            measured,
            force: force(measured),
            effective_force: effective_force(commanded, measured),
        };
        let mut monitor = Monitor::new(&step(0.0, first));
        let steps = (1..=2 * STEPS).map(|index| {
            let (commanded, measured) = (amplitude * angle(index).sin(), position(angle(index)));
            monitor.take(&step(commanded, measured)).energy_error
        });
        steps.collect()
    }

    /// Corrected with the spring's own K, the error is zero at every step. Without the correction a cycle adds πKA² sin φ. The recursion
    /// begins with an uncorrected force: half of that over the first step.
    #[test]
    fn what_a_spring_gives_back_is_no_error() {
        for (amplitude, phase) in [(0.01_f64, 0.1_f64), (0.01, 1.2), (0.03, -0.5)] {
            let increment = amplitude * (std::f64::consts::TAU / f64::from(STEPS)).sin();
            let first = -0.5 * STIFFNESS * amplitude * phase.sin() * increment;
            for error in corrected(amplitude, phase, STIFFNESS, |position| STIFFNESS * position) {
                assert!(
                    (error - first).abs() < 1e-12 * STIFFNESS,
                    "{phase}: {error} J, {first} J"
                );
            }
        }
    }

    /// A `K_I` that differs from the spring corrects only in part: r* = K d_m − K_I(d_m − d_c), and π(K − K_I)A² sin φ remains per cycle.
    #[test]
    fn what_a_correction_leaves_counts() {
        let (amplitude, phase): (f64, f64) = (0.01, 0.2);
        for share in [0.5, 0.9, 1.3] {
            let steps = corrected(amplitude, phase, share * STIFFNESS, |position| {
                STIFFNESS * position
            });
            let (one, two) = (steps[STEPS as usize - 1], steps[2 * STEPS as usize - 1]);
            let exact = -std::f64::consts::PI
                * (1.0 - share)
                * STIFFNESS
                * amplitude
                * amplitude
                * phase.sin();
            assert!(
                ((two - one) / exact - 1.0).abs() < 1e-5,
                "K_I = {share} K: {} J a cycle, {exact} J",
                two - one
            );
        }
    }

    /// A specimen that yields at ±F while the recursion assumes that it is still elastic. Over a path w the error is K_I·e·w, with e the
    /// lag of the actuator.
    #[test]
    fn a_correction_of_what_flows_is_an_error() {
        let (flow, behind, operator, step) = (5.0, 1e-3, STIFFNESS, 1e-4);
        let at = |commanded: f64| TrackedStep {
            commanded,
            measured: commanded - behind,
            force: flow,
            effective_force: flow + operator * behind,
        };
        let mut monitor = Monitor::new(&at(0.1));
        let mut last = Tracking::default();
        for index in 1..=100 {
            last = monitor.take(&at(0.1 + step * f64::from(index)));
        }
        // Minus half of the first step, which begins with the measured force.
        let exact = operator * behind * step * 99.5;
        assert!(
            (last.energy_error - exact).abs() < 1e-12,
            "{last:?}, {exact} J"
        );
    }

    /// By hand: from rest to a command of 2 mm, 1 mm reached, 10 N read: ½·10 N·1 mm. ¼(1·2 − 2·1) mm² is zero on the first step.
    #[test]
    fn one_step_by_hand() {
        let mut monitor = Monitor::new(&uncorrected(0.0, 0.0, 0.0));
        let first = monitor.take(&uncorrected(0.002, 0.001, 10.0));
        assert!((first.energy_error - 0.005).abs() < 1e-15 && first.indicator.abs() < 1e-18);
        // Command 0, 1.5 mm reached: ½(10+15)(−2 − 0.5) mm, ¼((1+1.5)(−2) − 2·0.5) mm².
        let second = monitor.take(&uncorrected(0.0, 0.0015, 15.0));
        assert!(
            (second.energy_error - (0.005 - 0.03125)).abs() < 1e-15,
            "{second:?}"
        );
        assert!((second.indicator + 1.5e-6).abs() < 1e-18, "{second:?}");
        assert_eq!(second.share_of(0.0), None);
        assert!((second.share_of(0.5).unwrap() + 0.0525).abs() < 1e-12);
    }
}
