//! Smooth hysteresis after Bouc and Wen, independent of rate. In: a displacement. Out: the force there, integrated over the
//! displacement to a stated error, for a move of any length.

use super::{BilinearCurve, RestoringForce};

/// R = α K X + (1 − α) F_y z, dz/dX = (K/F_y) [1 − |z|ⁿ (γ + β sign(z dX))], known as the Bouc–Wen model, normalised to γ = 1 − β, so
/// that z tends to ±1. Its dissipation beyond the elastic energy ½z² F_y/K is z dX − (F_y/K) z dz = |z|ⁿ⁺¹ |dX| (β + γ sign(z dX)). This
/// is not negative on any path if β ≥ |γ|, that is β ≥ ½.
///
/// With y = |ΔX| K/F_y and u = z counted along the move, du/dy = 1 − uⁿ loading (u ≥ 0) and 1 + (2β − 1)|u|ⁿ unloading (u < 0).
/// Unloading ends at u = 0, where the right-hand side loses derivatives: the part up to it is integrated first, so that no step
/// crosses it, and steps near it are as short as |u|/4. Steps of fourth order of at most 1/(32 n) of y: |Δz| < 1e-7 against the
/// exact solution for n up to 20, and as much between one move and many (the tests measure both).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoucWen {
    curve: BilinearCurve,
    sharpness: f64,
    beta: f64,
    displacement: f64,
    /// z
    plastic: f64,
}

/// Steps of a yield displacement for n = 1.
const STEPS: f64 = 32.0;
/// Shortest step near u = 0: the error of such a step by |u|ⁿ with n ≥ 1 is its square, at most.
const SHORTEST: f64 = 1e-4;

impl BoucWen {
    /// A spring at zero displacement that rounds the knee of `curve`, with `sharpness` n ≥ 1 and `beta` β, ½ to 1.
    #[must_use]
    pub const fn new(curve: BilinearCurve, sharpness: f64, beta: f64) -> Self {
        Self {
            curve,
            sharpness,
            beta,
            displacement: 0.0,
            plastic: 0.0,
        }
    }

    /// du/dy
    fn rate(&self, along: f64) -> f64 {
        let power = along.abs().powf(self.sharpness);
        if along < 0.0 {
            1.0 + (2.0 * self.beta - 1.0) * power
        } else {
            1.0 - power
        }
    }

    /// y from `along` < 0 to 0: ∫ du/(1 + (2β − 1)|u|ⁿ) by Simpson's rule over t, |u| = `size` t³, which smooths the end.
    fn travel_to_zero(&self, along: f64) -> f64 {
        let size = -along;
        let intervals = 2.0 * (STEPS * self.sharpness).ceil();
        let value = |interval: f64| {
            let t = interval / intervals;
            3.0 * size * t * t / self.rate(-size * t * t * t)
        };
        let mut sum = value(intervals);
        let mut interval = 1.0;
        while interval < intervals {
            sum += if interval % 2.0 == 1.0 { 4.0 } else { 2.0 } * value(interval);
            interval += 1.0;
        }
        sum / (3.0 * intervals)
    }

    /// u after `length` of y on one side of 0, by the classical Runge–Kutta method.
    fn integrate(&self, mut along: f64, mut length: f64) -> f64 {
        while length > 0.0 && self.rate(along) > f64::EPSILON {
            let longest = (0.25 * along.abs())
                .max(SHORTEST)
                .min(1.0 / (STEPS * self.sharpness));
            // An equal part of the rest, so that the last step is not very short.
            let step = if length <= longest {
                length
            } else {
                length / (length / longest).ceil()
            };
            along = self.runge_kutta(along, step);
            length = if step == length { 0.0 } else { length - step };
        }
        along
    }

    fn runge_kutta(&self, along: f64, step: f64) -> f64 {
        // Trial values stay on the side of the start.
        let side = |u: f64| {
            if along < 0.0 {
                u.min(-f64::MIN_POSITIVE)
            } else {
                u.min(1.0)
            }
        };
        let first = self.rate(along);
        let second = self.rate(side(along + 0.5 * step * first));
        let third = self.rate(side(along + 0.5 * step * second));
        let fourth = self.rate(side(along + step * third));
        side(along + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth))
    }
}

impl RestoringForce for BoucWen {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let moved = displacement - self.displacement;
        if moved != 0.0 {
            let mut length = moved.abs() * self.curve.stiffness / self.curve.yield_force;
            let mut along = self.plastic * moved.signum();
            if along < 0.0 {
                // du/dy is largest here, so that no shorter distance leads to 0.
                let to_zero = if length * self.rate(along) < -along {
                    f64::INFINITY
                } else {
                    self.travel_to_zero(along)
                };
                if length < to_zero {
                    along = self.integrate(along, length);
                    length = 0.0;
                } else {
                    along = 0.0;
                    length -= to_zero;
                }
            }
            if length > 0.0 {
                along = self.integrate(along, length);
            }
            self.plastic = along * moved.signum();
            self.displacement = displacement;
        }
        self.curve.post_yield_ratio * self.curve.stiffness * displacement
            + (1.0 - self.curve.post_yield_ratio) * self.curve.yield_force * self.plastic
    }

    fn initial_stiffness(&self) -> f64 {
        self.curve.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// z of a specimen whose y is X itself: K = F_y = 1, no hardening.
    fn bare(sharpness: f64, beta: f64) -> BoucWen {
        BoucWen::new(
            BilinearCurve {
                stiffness: 1.0,
                yield_force: 1.0,
                post_yield_ratio: 0.0,
            },
            sharpness,
            beta,
        )
    }

    /// n = 1: z = 1 − e^(−y). n = 2: z = tanh y. Unloading with β = ½ is straight: slope 1.
    #[test]
    fn first_loading_and_unloading_in_closed_form() {
        for position in [0.1_f64, 0.5, 1.0, 2.0, 5.0] {
            assert!((bare(1.0, 0.7).move_to(position) - (1.0 - (-position).exp())).abs() < 1e-8);
            assert!(
                (bare(2.0, 0.7).move_to(position) - position.tanh()).abs() < 1e-8,
                "{position}"
            );
        }
        let mut model = bare(1.0, 0.5);
        let top = model.move_to(1.5);
        assert!((model.move_to(1.5 - 0.4) - (top - 0.4)).abs() < 1e-12);
        // n = 1, β = 1: du/dy = 1 + |u| unloading, so w = −u falls as (1 + w₀) e^(−y) − 1.
        let mut model = bare(1.0, 1.0);
        let top = model.move_to(1.5);
        let back = 0.3_f64;
        assert!((model.move_to(1.5 - back) - ((1.0 + top) * (-back).exp() - 1.0)).abs() < 1e-8);
        // n = 2, β = 1: w = tan(atan w₀ − y).
        let mut model = bare(2.0, 1.0);
        let top = model.move_to(1.5);
        assert!((model.move_to(1.5 - back) - (top.atan() - back).tan()).abs() < 1e-8);
        assert!(
            (BoucWen::new(
                BilinearCurve {
                    stiffness: 2e6,
                    yield_force: 1e3,
                    post_yield_ratio: 0.1
                },
                1.0,
                0.5
            )
            .move_to(1e-9)
                - 2e-3)
                .abs()
                < 1e-8,
            "K at first"
        );
    }

    /// The right-hand side as printed in the papers, with extrapolated midpoint steps (Gragg–Bulirsch–Stoer) that share no code with the
    /// model.
    fn independent(sharpness: f64, beta: f64, path: &[f64]) -> f64 {
        let (mut position, mut z) = (0.0_f64, 0.0_f64);
        let rate = |z: f64, length: f64| {
            let sign = if z * length > 0.0 {
                1.0
            } else if z * length < 0.0 {
                -1.0
            } else {
                0.0
            };
            length * (1.0 - z.abs().powf(sharpness) * (1.0 - beta + beta * sign))
        };
        for to in path {
            let pieces = 4000;
            let h = (to - position).abs() / f64::from(pieces);
            let length = (to - position).signum();
            for _ in 0..pieces {
                let midpoint = |n: i32| {
                    let step = h / f64::from(n);
                    let (mut before, mut now) = (z, z + step * rate(z, length));
                    for _ in 1..n {
                        (before, now) = (now, before + 2.0 * step * rate(now, length));
                    }
                    0.5 * (now + before + step * rate(now, length))
                };
                let (two, four) = (midpoint(2), midpoint(4));
                z = four + (four - two) / 3.0;
            }
            position = *to;
        }
        z
    }

    #[test]
    fn an_independent_integration_finds_the_same() {
        let path = [1.7, -0.6, 0.4, -2.5, 3.0, 2.2];
        for (sharpness, beta) in [
            (1.0, 0.5),
            (1.0, 0.9),
            (1.5, 0.6),
            (2.0, 0.5),
            (3.3, 1.0),
            (8.0, 0.7),
            (20.0, 0.5),
        ] {
            let mut model = bare(sharpness, beta);
            for to in path {
                model.move_to(to);
            }
            let by_other_means = independent(sharpness, beta, &path);
            assert!(
                (model.plastic - by_other_means).abs() < 1e-7,
                "n {sharpness}, β {beta}: {}",
                model.plastic - by_other_means
            );
        }
    }

    #[test]
    fn it_hardly_depends_on_the_size_of_its_moves() {
        for (sharpness, beta) in [
            (1.0, 1.0),
            (1.0, 0.66),
            (1.3, 0.6),
            (2.0, 0.9),
            (5.0, 0.6),
            (20.0, 0.6),
        ] {
            let (mut once, mut often) = (bare(sharpness, beta), bare(sharpness, beta));
            let mut from = 0.0;
            for to in [2.0, -1.5, -0.58, 0.3, 1.1, -3.0] {
                for i in 1..=997 {
                    often.move_to(from + (to - from) * f64::from(i) / 997.0);
                }
                let apart = once.move_to(to) - often.move_to(to);
                assert!(apart.abs() < 1e-7, "n {sharpness}: {apart}");
                from = to;
            }
        }
    }

    /// The bound of the step depends on the order of the method: half the step, a sixteenth of the error.
    #[test]
    fn the_error_falls_with_the_fourth_power_of_the_step() {
        let error = |count: u32| {
            let model = bare(2.0, 0.5);
            let mut along = 0.0;
            for _ in 0..count {
                along = model.runge_kutta(along, 1.0 / f64::from(count));
            }
            (along - 1.0_f64.tanh()).abs()
        };
        let ratio = error(16) / error(32);
        assert!((ratio - 16.0).abs() < 2.0, "{ratio}");
    }

    /// n → ∞ is the elastic–plastic specimen.
    #[test]
    fn a_sharp_knee_is_perfectly_plastic() {
        let (mut sharp, mut plastic) = (
            bare(400.0, 0.5),
            super::super::Bilinear::new(BilinearCurve {
                stiffness: 1.0,
                yield_force: 1.0,
                post_yield_ratio: 0.0,
            }),
        );
        for to in [0.5, 2.0, 1.2, -3.0, -2.5, 1.0] {
            assert!((sharp.move_to(to) - plastic.move_to(to)).abs() < 0.01);
        }
    }
}
