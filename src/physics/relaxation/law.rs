//! Laws of relaxation of an instantaneous force. In: the time since a move ended, its duration, the time of the law. Out: the lost
//! fraction of the increment of force, for a share of 1, and its rate. It knows no specimen and no fit.
//!
//! A force that is applied instantly and held loses, per newton, `share` times
//! - 1 − e^(−t/τ): exponential, as a Maxwell branch;
//! - ln(1 + t/t₀): with the logarithm of time, as creep by Lomnitz's law (Garra, Mainardi & Spada, *A generalization of the
//!   Lomnitz logarithmic creep law via Hadamard fractional calculus*, 2017, arXiv:1701.03068). Every decade of time takes the same
//!   part, without end: the result is therefore the rate of relaxation, not the remaining force.
//!
//! The relaxations of all increments of force are superposed, each from its own instant on (Boltzmann's superposition; Fung's
//! quasi-linear viscoelasticity).

/// The loss of a force a time t \[s\] after it was applied, over its share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxationLaw {
    /// 1 − e^(−t/τ)
    Exponential,
    /// ln(1 + t/t₀)
    Logarithmic,
}

impl RelaxationLaw {
    pub const BOTH: [Self; 2] = [Self::Exponential, Self::Logarithmic];

    /// The law with τ or t₀ \[s\].
    #[must_use]
    pub const fn timed(self, time: f64) -> TimedLaw {
        TimedLaw { law: self, time }
    }

    /// Symbol of its time.
    #[must_use]
    pub const fn time_name(self) -> &'static str {
        match self {
            Self::Exponential => "τ",
            Self::Logarithmic => "t₀",
        }
    }
}

/// A law with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedLaw {
    law: RelaxationLaw,
    /// τ or t₀ \[s\].
    time: f64,
}

impl TimedLaw {
    /// Loss of 1 N with a share of 1, `since` \[s\] the end of a move that brought it at a constant rate in `moved_for` \[s\]: the mean of
    /// the law over the instants of the move.
    ///
    /// Exponential: 1 − e^(−u/τ)·(1 − e^(−m/τ))·τ/m. Logarithmic, with A = 1 + u/t₀ and r = m/(t₀A):
    /// ln A + (1 + r) ln(1 + r)/r − 1.
    #[must_use]
    pub fn lost(self, since: f64, moved_for: f64) -> f64 {
        let time = self.time;
        match self.law {
            RelaxationLaw::Exponential => 1.0 - (-since / time).exp() * mean_fall(moved_for / time),
            RelaxationLaw::Logarithmic => {
                (since / time).ln_1p() + mean_rise(moved_for / (time + since))
            }
        }
    }

    /// Rate of that loss \[1/s\].
    #[must_use]
    pub fn rate(self, since: f64, moved_for: f64) -> f64 {
        let time = self.time;
        match self.law {
            RelaxationLaw::Exponential => {
                (-since / time).exp() * mean_fall(moved_for / time) / time
            }
            RelaxationLaw::Logarithmic => {
                let (from, ratio) = (time + since, moved_for / (time + since));
                if ratio < 1e-8 {
                    (1.0 - 0.5 * ratio) / from
                } else {
                    ratio.ln_1p() / moved_for
                }
            }
        }
    }
}

/// (1 − e^(−x))/x
fn mean_fall(x: f64) -> f64 {
    if x < 1e-8 {
        1.0 - 0.5 * x
    } else {
        -(-x).exp_m1() / x
    }
}

/// (1 + r) ln(1 + r)/r − 1, below 1/100 by its series Σ (−1)^(k+1) rᵏ/(k(k + 1)) because the parts nearly cancel.
fn mean_rise(r: f64) -> f64 {
    if r < 0.01 {
        return (1..=8_i32)
            .rev()
            .fold(0.0, |sum, k| r * (1.0 / f64::from(k * (k + 1)) - sum));
    }
    (1.0 + r) * r.ln_1p() / r - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean over a move is that of many instants, at any length of it, and its rate the slope.
    #[test]
    fn the_mean_over_a_move_is_the_mean_of_its_instants() {
        for law in RelaxationLaw::BOTH {
            for (since, moved_for, time) in [
                (0.0, 0.5, 0.02),
                (3.0, 0.5, 1.5),
                (0.2, 40.0, 7.0),
                (5.0, 0.06, 1.0),
                (5.0, 1e-3, 1.0),
            ] {
                let parts = 40_000;
                let at = |part: u32| since + moved_for * (f64::from(part) + 0.5) / f64::from(parts);
                let instant = |t: f64| match law {
                    RelaxationLaw::Exponential => 1.0 - f64::exp(-t / time),
                    RelaxationLaw::Logarithmic => f64::ln(1.0 + t / time),
                };
                let mean = (0..parts).map(|part| instant(at(part))).sum::<f64>() / f64::from(parts);
                let lost = law.timed(time).lost(since, moved_for);
                assert!((lost - mean).abs() < 1e-7, "{law:?}: {lost} is not {mean}");
                let slope = (law.timed(time).lost(since + 1e-5, moved_for) - lost) / 1e-5;
                let rate = law.timed(time).rate(since + 5e-6, moved_for);
                assert!(
                    (rate / slope - 1.0).abs() < 1e-5,
                    "{law:?}: {rate} is not {slope}"
                );
            }
            assert!(
                law.timed(1.0).lost(0.0, 0.0).abs() < 1e-15,
                "no loss in no time"
            );
        }
        let below_and_above = [0.009_999_999, 0.010_000_001].map(mean_rise);
        assert!(
            (below_and_above[1] - below_and_above[0] - 1e-9).abs() < 1e-11,
            "the series continues the closed form"
        );
    }
}
