//! Force that relaxes with the logarithm of time. In: the instantaneous force of a specimen in time. Out: the part of it that is lost, in
//! closed form, so that neither the length of a dwell nor the number of evaluations matters. It knows no specimen.
//!
//! An instantaneous force R̂ loses R̂·a ln(1 + t/t₀) ([`super::law`]). By Frullani's integral ln(1 + t/t₀) = ∫₀^∞ (1 −
//! e^(−t/τ)) e^(−t₀/τ) dτ/τ: the law is a spectrum of Maxwell branches, positive everywhere (Gonzáles-Santander & Mainardi, *A comparative
//! view of Becker, Lomnitz, and Lambert linear viscoelastic models*, Mathematics 12 (2024) 3426, arXiv:2411.17025). Here it ends at τ = T,
//! the `longest`: up to some thousandth of T the difference is negligible, and after long a·E₁(t₀/T) ≈ a·(ln(T/t₀) − 0.5772) is lost. In
//! steps of ln τ the integral is a sum of branches, and the sum of an analytic function converges faster than any power of the step: with
//! a step of ½ the error is 10⁻⁸ of the law (tested).

use super::maxwell::{MaxwellBranch, Motion};

/// Steps of ln τ, at most.
const STEP: f64 = 0.5;
/// Branches below t₀ times this are negligible: e^(−e^3.7) is 10⁻¹⁸.
const FASTEST: f64 = 0.024_7;

/// A move of a specimen, and the instantaneous force at its end.
#[derive(Clone, Copy, Debug)]
pub struct Increment {
    /// \[m\]
    pub moved: f64,
    /// \[N\]
    pub force: f64,
}

/// The lost part Σ gᵢ·(R − qᵢ) of an instantaneous force R, with qᵢ' = R' − qᵢ/τᵢ.
#[derive(Clone, Debug)]
pub struct LogarithmicLoss {
    /// Each with gᵢ for its stiffness and R for its displacement: its force is gᵢ·qᵢ.
    branches: Vec<MaxwellBranch>,
    /// Σ gᵢ: the fraction that is lost after long.
    all: f64,
    /// R \[N\]
    reached: f64,
    /// Bound of the slope dR/dX \[N/m\]: a steeper one is a move there and back.
    steepest: f64,
}

/// The law a ln(1 + t/t₀) of a specimen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogarithmicRelaxation {
    /// a
    pub share: f64,
    /// t₀ \[s\]
    pub reference_time: f64,
    /// T \[s\]
    pub longest: f64,
}

impl LogarithmicRelaxation {
    /// The fraction of an instantaneous force that is lost after long.
    #[must_use]
    pub fn lost_after_long(&self) -> f64 {
        spectrum(self).map(|(part, _)| part).sum()
    }
}

/// gᵢ and τᵢ \[s\], from the slowest.
fn spectrum(law: &LogarithmicRelaxation) -> impl Iterator<Item = (f64, f64)> {
    let LogarithmicRelaxation {
        share,
        reference_time,
        longest,
    } = *law;
    let range = (longest / (FASTEST * reference_time)).ln().max(STEP);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some hundreds: a plan's times are finite"
    )]
    let count = (range / STEP).ceil() as u32;
    let step = range / f64::from(count);
    (0..count).map(move |index| {
        let time = longest * (-step * (f64::from(index) + 0.5)).exp();
        (share * step * (-reference_time / time).exp(), time)
    })
}

impl LogarithmicLoss {
    /// `steepest`: the largest slope of the specimen \[N/m\].
    #[must_use]
    pub fn new(law: &LogarithmicRelaxation, steepest: f64) -> Self {
        let parts: Vec<(f64, f64)> = spectrum(law).collect();
        let all = parts.iter().map(|(part, _)| part).sum();
        let branches = parts
            .iter()
            .map(|(part, time)| MaxwellBranch::new(*part, *time))
            .collect();
        Self {
            branches,
            all,
            reached: 0.0,
            steepest,
        }
    }

    /// Force beside the instantaneous one \[N\], of the opposite direction.
    #[must_use]
    pub fn force(&self) -> f64 {
        self.branches.iter().map(MaxwellBranch::force).sum::<f64>() - self.all * self.reached
    }

    /// The branches whose force decays at rest.
    #[must_use]
    pub fn branches(&self) -> &[MaxwellBranch] {
        &self.branches
    }

    /// The force changes in proportion to the displacement where the slope between the two ends is possible, else at a constant rate.
    pub fn follow(&mut self, motion: &Motion, increment: Increment) {
        let gained = increment.force - self.reached;
        self.reached = increment.force;
        let slope = gained / increment.moved;
        let changed = if gained == 0.0 {
            Motion::rest(motion.seconds)
        } else if motion.seconds <= 0.0 {
            for branch in &mut self.branches {
                branch.jump(gained);
            }
            return;
        } else if slope.abs() <= self.steepest * (1.0 + 1e-9) {
            motion.times(slope)
        } else {
            Motion::even(gained / motion.seconds, motion.seconds)
        };
        for branch in &mut self.branches {
            branch.follow(&changed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relaxation::law::RelaxationLaw;

    const SHARE: f64 = 0.01;
    const TIME: f64 = 2.0;
    const LONGEST: f64 = 2e12;

    const LAW: LogarithmicRelaxation = LogarithmicRelaxation {
        share: SHARE,
        reference_time: TIME,
        longest: LONGEST,
    };

    fn loss() -> LogarithmicLoss {
        LogarithmicLoss::new(&LAW, 1e6)
    }

    /// A step of 1 kN: 10 N ln(1 + t/2 s) are lost, from a millisecond to a month, with any number of evaluations.
    #[test]
    fn a_step_loses_the_logarithm_of_time() {
        let (mut once, mut often) = (loss(), loss());
        for loss in [&mut once, &mut often] {
            loss.follow(
                &Motion::even(1e6, 1e-9),
                Increment {
                    moved: 1e-3,
                    force: 1000.0,
                },
            );
        }
        let mut held = 0.0;
        for decade in -3..=6 {
            let until = 2.592 * 10_f64.powi(decade);
            once.follow(
                &Motion::rest(until - held),
                Increment {
                    moved: 0.0,
                    force: 1000.0,
                },
            );
            for _ in 0..10 {
                often.follow(
                    &Motion::rest(0.1 * (until - held)),
                    Increment {
                        moved: 0.0,
                        force: 1000.0,
                    },
                );
            }
            held = until;
            let by_hand = -1000.0 * SHARE * f64::ln_1p(until / TIME);
            // The finite spectrum lacks t/T of a.
            assert!(
                (once.force() - by_hand).abs()
                    < 1e-6 * SHARE * 1000.0 + 1000.0 * SHARE * until / LONGEST,
                "{} N at {until} s",
                once.force()
            );
            assert!((once.force() - often.force()).abs() < 1e-9);
            let rate: f64 = once
                .branches()
                .iter()
                .map(|branch| branch.rate_after(0.0))
                .sum();
            assert!(
                (rate / (1000.0 * SHARE / (TIME + until)) - 1.0).abs() < 2e-5,
                "{rate} N/s"
            );
        }
        once.follow(
            &Motion::rest(1e20),
            Increment {
                moved: 0.0,
                force: 1000.0,
            },
        );
        let after_long = SHARE * ((LONGEST / TIME).ln() - 0.577_215_664_9);
        assert!(
            (once.force() / (-1000.0 * after_long) - 1.0).abs() < 1e-6,
            "{} N after long",
            once.force()
        );
        assert!((LAW.lost_after_long() / after_long - 1.0).abs() < 1e-6);
    }

    /// Ramps with holds between: each increment relaxes from its own instants on, by the mean of the law over the move.
    #[test]
    fn steps_are_superposed() {
        let mut loss = loss();
        let (moved_for, pause) = (0.5, 3.0);
        for step in 1..=4 {
            let force = 250.0 * f64::from(step);
            loss.follow(
                &Motion::even(1e-3 / moved_for, moved_for),
                Increment { moved: 1e-3, force },
            );
            loss.follow(&Motion::rest(pause), Increment { moved: 0.0, force });
            let lost = |earlier: i32| {
                RelaxationLaw::Logarithmic.timed(TIME).lost(
                    pause + f64::from(step - earlier) * (pause + moved_for),
                    moved_for,
                )
            };
            let by_hand: f64 = (1..=step)
                .map(|earlier| -250.0 * SHARE * lost(earlier))
                .sum();
            assert!(
                (loss.force() - by_hand).abs() < 1e-6,
                "{} N is not {by_hand} N",
                loss.force()
            );
        }
    }

    /// A jump in no time; and a move there and back within one evaluation, over which the force changes and the displacement does not.
    #[test]
    fn no_slope_is_steeper_than_that_of_the_specimen() {
        let mut loss = loss();
        loss.follow(
            &Motion::rest(0.0),
            Increment {
                moved: 1e-3,
                force: 1000.0,
            },
        );
        assert!(loss.force().abs() < 1e-9, "no loss in no time");
        loss.follow(
            &Motion::even(0.0, 1.0),
            Increment {
                moved: 0.0,
                force: 400.0,
            },
        );
        let mut even = self::tests::loss();
        even.follow(
            &Motion::rest(0.0),
            Increment {
                moved: 1e-3,
                force: 1000.0,
            },
        );
        even.follow(
            &Motion::even(-6e-4, 1.0),
            Increment {
                moved: -6e-4,
                force: 400.0,
            },
        );
        assert!(
            (loss.force() - even.force()).abs() < 1e-9,
            "at a constant rate"
        );
    }
}
