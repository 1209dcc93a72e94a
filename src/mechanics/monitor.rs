//! How well an actuator follows, and what that does to the run: the field's monitors of a hybrid test, one degree of
//! freedom each. In: at every step the place that was asked for, the place that was measured, the force. Out: sums so far.
//! It holds no rig: whoever does compares them with the limits.
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
//! Where the recursion takes another force r* than the one read, as under the I-modification, E_err = ∫ r* dd_c − ∫ r_m dd_m: what
//! a correction has taken back is no error.
//!
//! **Energy error** (Thewalt and Roman 1994; Mosqueda, Stojadinović and Mahin 2007): the recursion believes that the
//! specimen took ∫ r_m dd_c, it took ∫ r_m dd_m. Negative: tracking puts energy into the test, and its amplitudes grow;
//! positive: it takes energy out, as damping would. A share of the input, it is the one number to stop a test by.
//! **Tracking indicator** (Mercan and Ricles 2007): the area that command against measurement encloses. It falls as long as
//! the actuator lags, and rises while it leads; an error in proportion leaves it where it is.
//! **NRMS and peak error** (as in the benchmark of Silva et al. 2020) tell of the size, and of no direction.

use serde::{Deserialize, Serialize};

/// Share of the input energy at which a run is remarked on. Half a damping ratio of a per cent over a dozen cycles is of
/// this size: more of it shows in the results.
pub const WARN: f64 = 0.02;
/// Share of the input energy at which the rig is held, where the plan says nothing else.
pub const HOLD: f64 = 0.05;

/// What the monitors show after a step.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Tracking {
    /// E_err, J; negative: tracking puts energy in.
    pub energy_error: f64,
    /// TI, m²; falling: the actuator lags.
    pub indicator: f64,
    /// Root mean square of the error over that of the command; 0 as long as nothing was commanded.
    pub nrms_error: f64,
    /// Largest |measured − commanded| so far, m.
    pub peak_error: f64,
}

impl Tracking {
    /// All axes of a specimen told as one: energies and areas add, of the others the largest counts.
    #[must_use]
    pub fn together(axes: &[Self]) -> Self {
        axes.iter().fold(Self::default(), |all, axis| Self {
            energy_error: all.energy_error + axis.energy_error,
            indicator: all.indicator + axis.indicator,
            nrms_error: all.nrms_error.max(axis.nrms_error),
            peak_error: all.peak_error.max(axis.peak_error),
        })
    }

    /// E_err as a share of the energy put into the test (J), signed; none while nothing was.
    #[must_use]
    pub fn share_of(&self, input_energy: f64) -> Option<f64> {
        (input_energy > 0.0).then(|| self.energy_error / input_energy)
    }
}

/// Sums up the steps of one degree of freedom.
#[derive(Clone, Copy, Debug)]
pub struct Monitor {
    commanded: f64,
    measured: f64,
    force: f64,
    /// r* − r_m at the last step, N.
    corrected: f64,
    errors: f64,
    commands: f64,
    tracking: Tracking,
}

impl Monitor {
    /// From what was asked for (m), measured (m) and read (N) before the first step.
    #[must_use]
    pub fn new(commanded: f64, measured: f64, force: f64) -> Self {
        let mut monitor =
            Self { commanded, measured, force, corrected: 0.0, errors: 0.0, commands: 0.0, tracking: Tracking::default() };
        monitor.size(commanded, measured);
        monitor
    }

    /// Takes the end of a step.
    pub fn take(&mut self, commanded: f64, measured: f64, force: f64) -> Tracking {
        self.take_as(commanded, measured, force, force)
    }

    /// The same, where the recursion takes `taken` (N) for the force at the command.
    pub fn take_as(&mut self, commanded: f64, measured: f64, force: f64, taken: f64) -> Tracking {
        let corrected = taken - force;
        let (asked, went) = (commanded - self.commanded, measured - self.measured);
        let tracking = &mut self.tracking;
        tracking.energy_error += 0.5 * (self.force + force) * (asked - went) + 0.5 * (self.corrected + corrected) * asked;
        tracking.indicator += 0.25 * ((self.measured + measured) * asked - (self.commanded + commanded) * went);
        (self.commanded, self.measured, self.force, self.corrected) = (commanded, measured, force, corrected);
        self.size(commanded, measured);
        self.tracking
    }

    #[must_use]
    pub const fn tracking(&self) -> Tracking {
        self.tracking
    }

    fn size(&mut self, commanded: f64, measured: f64) {
        let error = measured - commanded;
        self.errors += error * error;
        self.commands += commanded * commanded;
        self.tracking.peak_error = self.tracking.peak_error.max(error.abs());
        self.tracking.nrms_error = if self.commands > 0.0 { (self.errors / self.commands).sqrt() } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STIFFNESS: f64 = 1000.0;
    const STEPS: u32 = 4000;

    /// One cycle of A sin ωt; the actuator goes where `place` says.
    fn cycle(amplitude: f64, place: impl Fn(f64) -> f64) -> Tracking {
        let at = |step: u32| std::f64::consts::TAU * f64::from(step) / f64::from(STEPS);
        let mut monitor = Monitor::new(0.0, place(0.0), STIFFNESS * place(0.0));
        for step in 1..=STEPS {
            let angle = at(step);
            let measured = place(angle);
            monitor.take(amplitude * angle.sin(), measured, STIFFNESS * measured);
        }
        monitor.tracking()
    }

    /// Behind by φ on a spring: E_err = −πKA² sin φ and TI = −πA² sin φ a cycle; ahead, the same with the other sign.
    #[test]
    fn a_lag_puts_energy_in_and_a_lead_takes_it_out() {
        let (amplitude, phase): (f64, f64) = (0.01, 0.1);
        for sign in [-1.0, 1.0] {
            let found = cycle(amplitude, |angle| amplitude * (angle + sign * phase).sin());
            let area = std::f64::consts::PI * amplitude * amplitude * phase.sin();
            assert!((found.energy_error - sign * STIFFNESS * area).abs() < 1e-5 * STIFFNESS * area, "{found:?}");
            assert!((found.indicator - sign * area).abs() < 1e-5 * area, "{found:?}");
            // |sin(a + φ) − sin a| is at most 2 sin(φ/2), and that is its ratio of root mean squares too.
            assert!((found.peak_error - 2.0 * amplitude * (0.5 * phase).sin()).abs() < 1e-8);
            assert!((found.nrms_error - 2.0 * (0.5 * phase).sin()).abs() < 1e-4, "{found:?}");
        }
    }

    /// An error in proportion stores energy and gives it back: nothing is left after a cycle, and no area is enclosed.
    #[test]
    fn an_error_of_gain_shows_in_its_size_only() {
        let found = cycle(0.01, |angle| 0.009 * angle.sin());
        assert!(found.energy_error.abs() < 1e-12 && found.indicator.abs() < 1e-15);
        assert!((found.nrms_error - 0.1).abs() < 1e-12 && (found.peak_error - 0.001).abs() < 1e-12);
    }

    /// A lag whose force is corrected to the command by the spring's own K: ½K(d_c² − d_m²) is all that is left, and over a
    /// cycle nothing.
    #[test]
    fn what_a_correction_takes_back_is_no_error() {
        let (amplitude, phase) = (0.01, 0.1);
        let at = |step: u32| std::f64::consts::TAU * f64::from(step) / f64::from(STEPS);
        let place = |angle: f64| amplitude * (angle - phase).sin();
        let mut monitor = Monitor::new(0.0, place(0.0), STIFFNESS * place(0.0));
        for step in 1..=STEPS {
            let (commanded, measured) = (amplitude * at(step).sin(), place(at(step)));
            let found = monitor.take_as(commanded, measured, STIFFNESS * measured, STIFFNESS * commanded);
            let stored = |from: f64, to: f64| 0.5 * STIFFNESS * (to * to - from * from);
            let left = stored(0.0, commanded) - stored(place(0.0), measured);
            // The first step begins with a force that nothing has corrected yet.
            let first = 0.5 * STIFFNESS * place(0.0) * amplitude * at(1).sin();
            assert!((found.energy_error - left - first).abs() < 1e-12, "step {step}: {found:?}, {left} J");
        }
    }

    /// By hand: from rest to 2 mm asked, 1 mm gone, 10 N read: ½·10 N·1 mm; ¼(1·2 − 2·1) mm² is nothing on the first step.
    #[test]
    fn one_step_by_hand() {
        let mut monitor = Monitor::new(0.0, 0.0, 0.0);
        let first = monitor.take(0.002, 0.001, 10.0);
        assert!((first.energy_error - 0.005).abs() < 1e-15 && first.indicator.abs() < 1e-18);
        // Back to 0 asked, 1.5 mm gone: ½(10+15)(−2 − 0.5) mm, ¼((1+1.5)(−2) − 2·0.5) mm².
        let second = monitor.take(0.0, 0.0015, 15.0);
        assert!((second.energy_error - (0.005 - 0.03125)).abs() < 1e-15, "{second:?}");
        assert!((second.indicator + 1.5e-6).abs() < 1e-18, "{second:?}");
        assert_eq!(second.share_of(0.0), None);
        assert!((second.share_of(0.5).unwrap() + 0.0525).abs() < 1e-12);
    }
}
