//! Force that relaxes with the logarithm of time: what a specimen loses of the force it has reached. In: how the force changed, in
//! time. Out: what is lost, in closed form, so that a pause of months costs as much as none and the number of looks changes nothing.
//!
//! Of a force reached at once, `a`·ln(1 + t/t₀) is lost ([`super::law`]). By Frullani's integral ln(1 + t/t₀) = ∫₀^∞ (1 −
//! e^(−t/τ)) e^(−t₀/τ) dτ/τ: the law is a spectrum of Maxwell branches, positive everywhere (Gonzáles-Santander & Mainardi, *A comparative
//! view of Becker, Lomnitz, and Lambert linear viscoelastic models*, Mathematics 12 (2024) 3426, arXiv:2411.17025). Here it ends at τ = T,
//! the `longest`: up to some thousandth of T nobody sees it, and after long `a`·E₁(t₀/T) ≈ `a`·(ln(T/t₀) − 0.5772) is gone. In steps of ln
//! τ the integral is a sum of branches, and the sum of an analytic function converges faster than any power of the step: at half, 10⁻⁸ of
//! the law is left (tested).

use super::maxwell::{MaxwellBranch, Travel};

/// Steps of ln τ, at most.
const STEP: f64 = 0.5;
/// Branches below t₀ times this have no part: e^(−e^3.7) is 10⁻¹⁸.
const FASTEST: f64 = 0.024_7;

/// How a specimen went from one force to another.
#[derive(Clone, Copy, Debug)]
pub struct Went {
    /// m
    pub moved: f64,
    /// The force then, N.
    pub force: f64,
}

/// y = Σ gᵢ·(R − qᵢ), qᵢ' = R' − qᵢ/τᵢ: what is lost of R.
#[derive(Clone, Debug)]
pub struct LossOfReached {
    /// Each with gᵢ for its stiffness: driven by a force, its force is gᵢ·qᵢ.
    branches: Vec<MaxwellBranch>,
    /// Σ gᵢ: the share that is lost after long.
    all: f64,
    /// R, N
    reached: f64,
    /// No slope dR/dX is steeper, N/m: what seems to be is a way there and back.
    steepest: f64,
}

/// The share of a reached force that is lost after long.
#[must_use]
pub fn lost_after_long(share: f64, reference_time: f64, longest: f64) -> f64 {
    spectrum(share, reference_time, longest)
        .map(|(part, _)| part)
        .sum()
}

/// gᵢ and τᵢ (s), from the slowest.
fn spectrum(share: f64, reference_time: f64, longest: f64) -> impl Iterator<Item = (f64, f64)> {
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

impl LossOfReached {
    /// `steepest`: the largest slope of the specimen, N/m.
    #[must_use]
    pub fn new(share: f64, reference_time: f64, longest: f64, steepest: f64) -> Self {
        let parts: Vec<(f64, f64)> = spectrum(share, reference_time, longest).collect();
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

    /// What the cell feels of it beside the reached force, N: against it.
    #[must_use]
    pub fn force(&self) -> f64 {
        self.branches.iter().map(MaxwellBranch::force).sum::<f64>() - self.all * self.reached
    }

    /// What dies away at rest.
    #[must_use]
    pub fn branches(&self) -> &[MaxwellBranch] {
        &self.branches
    }

    /// The force changed with the way, as far as the slope between the two ends can be one; else evenly in time.
    pub fn follow(&mut self, travel: &Travel, went: Went) {
        let gained = went.force - self.reached;
        self.reached = went.force;
        let slope = gained / went.moved;
        let changed = if gained == 0.0 {
            Travel::rest(travel.seconds)
        } else if travel.seconds <= 0.0 {
            for branch in &mut self.branches {
                branch.jump(gained);
            }
            return;
        } else if slope.abs() <= self.steepest * (1.0 + 1e-9) {
            travel.times(slope)
        } else {
            Travel::even(gained / travel.seconds, travel.seconds)
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

    fn loss() -> LossOfReached {
        LossOfReached::new(SHARE, TIME, LONGEST, 1e6)
    }

    /// 1 kN at once: 10 N ln(1 + t/2 s) are lost, from a millisecond to a month, however often one looks.
    #[test]
    fn a_step_loses_the_logarithm_of_time() {
        let (mut once, mut often) = (loss(), loss());
        for loss in [&mut once, &mut often] {
            loss.follow(
                &Travel::even(1e6, 1e-9),
                Went {
                    moved: 1e-3,
                    force: 1000.0,
                },
            );
        }
        let mut held = 0.0;
        for decade in -3..=6 {
            let until = 2.592 * 10_f64.powi(decade);
            once.follow(
                &Travel::rest(until - held),
                Went {
                    moved: 0.0,
                    force: 1000.0,
                },
            );
            for _ in 0..10 {
                often.follow(
                    &Travel::rest(0.1 * (until - held)),
                    Went {
                        moved: 0.0,
                        force: 1000.0,
                    },
                );
            }
            held = until;
            let by_hand = -1000.0 * SHARE * f64::ln_1p(until / TIME);
            // A thousand million times shorter than the longest: t/T of `a` is missing besides.
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
            &Travel::rest(1e20),
            Went {
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
        assert!((lost_after_long(SHARE, TIME, LONGEST) / after_long - 1.0).abs() < 1e-6);
    }

    /// Ramps with holds between: each force is forgotten from its own instants on, as the law says of a move that takes its time.
    #[test]
    fn steps_are_superposed() {
        let mut loss = loss();
        let (moved_for, pause) = (0.5, 3.0);
        for step in 1..=4 {
            let force = 250.0 * f64::from(step);
            loss.follow(
                &Travel::even(1e-3 / moved_for, moved_for),
                Went { moved: 1e-3, force },
            );
            loss.follow(&Travel::rest(pause), Went { moved: 0.0, force });
            let lost = |earlier: i32| {
                RelaxationLaw::Logarithmic.lost(
                    pause + f64::from(step - earlier) * (pause + moved_for),
                    moved_for,
                    TIME,
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

    /// A jump in no time, and a way there and back within one look, in which the force changes though nothing moved.
    #[test]
    fn no_slope_is_steeper_than_the_specimen() {
        let mut loss = loss();
        loss.follow(
            &Travel::rest(0.0),
            Went {
                moved: 1e-3,
                force: 1000.0,
            },
        );
        assert!(loss.force().abs() < 1e-9, "nothing is lost in no time");
        loss.follow(
            &Travel::even(0.0, 1.0),
            Went {
                moved: 0.0,
                force: 400.0,
            },
        );
        let mut even = self::tests::loss();
        even.follow(
            &Travel::rest(0.0),
            Went {
                moved: 1e-3,
                force: 1000.0,
            },
        );
        even.follow(
            &Travel::even(-6e-4, 1.0),
            Went {
                moved: -6e-4,
                force: 400.0,
            },
        );
        assert!((loss.force() - even.force()).abs() < 1e-9, "evenly in time");
    }
}
