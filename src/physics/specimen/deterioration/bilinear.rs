//! A bilinear spring with cyclic deterioration. In: a displacement. Out: the force there, exact for a move of any length; without
//! deterioration bit-identical to the bilinear spring.

use super::{Degradation, Deterioration};
use crate::specimen::{BilinearCurve, RestoringForce};

/// The bilinear spring (`Bilinear`: K between two lines of slope k, R = kX ± Y, Y = (1 − h)F_y, k = hK) with two of the modes of
/// deterioration of Ibarra, Medina & Krawinkler (Earthquake Engng Struct. Dyn. 34 (2005) 1489–1511), in the order of `IMKBilin` of
/// OpenSees:
/// - at zero force, where the next excursion begins, Y of that side and k lose the fraction of `Degradation`. The slope is one for both
///   sides: two lines of different slopes would cross, and a spring between them would release energy that it never absorbed;
/// - at the reversal of a loaded excursion, the stiffness between the lines. The energy stored between them, ½(R − kX)²/(K − k), grows
///   with that, never by more than the plastic work since the last time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeterioratingBilinear {
    /// The initial K \[N/m\].
    stiffness: f64,
    /// The initial Y \[N\].
    half_band: f64,
    /// k \[N/m\]
    post_yield: f64,
    displacement: f64,
    force: f64,
    pub(super) degradation: Degradation,
    /// Direction of the present excursion, from zero force to zero force; 0 before the first.
    excursion: f64,
    /// Whether it has reversed and not yielded since.
    turned: bool,
    /// Plastic work since the stiffness was last reduced \[J\].
    plastic_work: f64,
}

impl DeterioratingBilinear {
    /// A spring at zero displacement that has not deteriorated.
    #[must_use]
    pub fn new(curve: BilinearCurve, rule: Deterioration) -> Self {
        let BilinearCurve {
            stiffness,
            yield_force,
            post_yield_ratio,
        } = curve;
        Self {
            stiffness,
            half_band: (1.0 - post_yield_ratio) * yield_force,
            post_yield: post_yield_ratio * stiffness,
            displacement: 0.0,
            force: 0.0,
            degradation: Degradation::new(Some(rule), yield_force, stiffness),
            excursion: 0.0,
            turned: false,
            plastic_work: 0.0,
        }
    }

    /// Stiffness between the lines \[N/m\].
    fn elastic(&self) -> f64 {
        self.degradation.unloading * self.stiffness
    }

    /// Y of the side in this direction \[N\].
    fn band(&self, direction: f64) -> f64 {
        self.degradation.strength[usize::from(direction < 0.0)] * self.half_band
    }

    /// Displacement at which the elastic line from `from` (displacement and force, along `direction`) meets the yield line \[m\].
    fn meets(&self, direction: f64, [displacement, force]: [f64; 2]) -> f64 {
        let steeper = self.elastic() - self.post_yield;
        if steeper <= 0.0 {
            return f64::INFINITY;
        }
        ((self.band(direction) - force + self.elastic() * displacement) / steeper).max(displacement)
    }

    /// Displacement at which a force against the direction is zero: between the lines, or beyond, where the spring already yields \[m\].
    fn unloaded(&self, direction: f64, from: [f64; 2]) -> f64 {
        let [displacement, force] = from;
        let elastic = displacement - force / self.elastic();
        if elastic <= self.meets(direction, from) {
            elastic
        } else {
            -self.band(direction) / self.post_yield
        }
    }

    /// Adds the work of the move to `to`, and its plastic part.
    fn count(&mut self, direction: f64, from: [f64; 2], to: f64) {
        let [displacement, force] = from;
        let yields = self.meets(direction, from).min(to);
        let there = force + self.elastic() * (yields - displacement);
        self.degradation
            .work(0.5 * (force + there) * (yields - displacement));
        if yields < to {
            let end = there + self.post_yield * (to - yields);
            self.degradation.work(0.5 * (there + end) * (to - yields));
            self.plastic_work += self.band(direction) * (to - yields);
            self.turned &= end <= 0.0;
        }
    }

    /// The reversal of a loaded excursion.
    fn reverse_loading(&mut self) {
        self.turned = true;
        let (before, within) = (
            self.degradation.unloading,
            self.force - self.post_yield * self.displacement,
        );
        self.degradation
            .turned(0.5 * self.force * self.force / self.elastic());
        if self.degradation.unloading < before && within != 0.0 {
            let store = 0.5 * within * within;
            let least = self.post_yield
                + store / (store / (before * self.stiffness - self.post_yield) + self.plastic_work);
            self.degradation.unloading = self
                .degradation
                .unloading
                .max(least / self.stiffness)
                .min(before);
            self.plastic_work = 0.0;
        } else {
            self.degradation.unloading = before;
        }
    }

    /// Zero force, and the move continues. Returns whether strength was lost.
    fn ended(&mut self, direction: f64) -> bool {
        let side = usize::from(direction < 0.0);
        let before = self.degradation.strength[side];
        self.degradation.ended(side);
        self.post_yield *= self.degradation.strength[side] / before;
        (self.excursion, self.turned) = (direction, false);
        self.degradation.strength[side] < before
    }

    fn go(&mut self, direction: f64, to: f64) {
        if self.force * direction < 0.0 && !self.turned {
            self.reverse_loading();
        }
        let mut from = [self.displacement * direction, self.force * direction];
        let mut origin = from;
        if self.excursion * direction < 0.0 {
            let unloaded_at = if from[1] < 0.0 {
                self.unloaded(direction, from)
            } else {
                from[0]
            };
            if to >= unloaded_at {
                self.count(direction, from, unloaded_at);
                from = [unloaded_at, 0.0];
                if self.ended(direction) {
                    origin = from;
                }
            }
        } else {
            self.excursion = direction;
        }
        self.count(direction, from, to);
        let (middle, trial) = (
            self.post_yield * to,
            origin[1] + self.elastic() * (to - origin[0]),
        );
        self.displacement = direction * to;
        // Positive zero where it is zero.
        self.force = direction
            * trial
                .max(middle - self.band(-direction))
                .min(middle + self.band(direction))
            + 0.0;
    }
}

impl RestoringForce for DeterioratingBilinear {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let moved = displacement - self.displacement;
        if moved != 0.0 {
            self.go(moved.signum(), displacement * moved.signum());
        }
        self.force
    }

    fn initial_stiffness(&self) -> f64 {
        self.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::specimen::Bilinear;
    use crate::specimen::tests::energy_along;

    /// Infinite capacities.
    const NO_WEAR: Deterioration = Deterioration {
        strength: f64::INFINITY,
        capping: f64::INFINITY,
        unloading: f64::INFINITY,
        reloading: f64::INFINITY,
        exponent: 1.0,
        residual: 0.1,
    };

    /// 1000 N/mm to 1 kN; γ `F_y` `x_y` = 40 J of a γ of 40.
    fn spring(post_yield_ratio: f64, rule: Deterioration) -> DeterioratingBilinear {
        DeterioratingBilinear::new(
            BilinearCurve {
                stiffness: 1e6,
                yield_force: 1000.0,
                post_yield_ratio,
            },
            rule,
        )
    }

    /// Reversals of all kinds: elastic, yielding, before zero force, on either side, tiny.
    fn reversals() -> impl Iterator<Item = f64> {
        let positions = [
            0.003, -0.002, 0.006, 0.001, 0.0055, -0.007, -0.004, -0.0065, 0.009, -0.012, 0.02,
            0.0201, 0.0, 1e-9,
        ];
        (0..200_u32).map(move |index| {
            positions[index as usize % positions.len()] * (1.0 + 0.37 * f64::from(index % 11))
        })
    }

    /// Infinite capacities: bit-identical to the bilinear spring, also if its hardening is so large that it yields before zero force.
    #[test]
    fn without_wear_it_is_the_bilinear_spring() {
        for post_yield_ratio in [0.0, 0.03, 0.1, 0.6, 1.0] {
            let (mut plain, mut degraded) = (
                Bilinear::new(BilinearCurve {
                    stiffness: 1e6,
                    yield_force: 1000.0,
                    post_yield_ratio,
                }),
                spring(post_yield_ratio, NO_WEAR),
            );
            for direction in reversals() {
                assert_eq!(
                    plain.move_to(direction).to_bits(),
                    degraded.move_to(direction).to_bits(),
                    "hardening {post_yield_ratio}, {direction} m"
                );
            }
        }
    }

    /// To 5 mm and back to zero force it absorbs 4 J of 40 J: β = 4/36, and in the opposite direction it yields at 8/9 of 1 kN. From 4 mm
    /// there to −3 mm it absorbs F·(4 + 3) mm − F²/K, by which the forward strength is reduced.
    #[test]
    fn strength_is_lost_by_the_energy_of_each_excursion() {
        let rule = Deterioration {
            strength: 40.0,
            ..NO_WEAR
        };
        let mut model = spring(0.0, rule);
        assert!((model.move_to(0.005) - 1000.0).abs() < 1e-9);
        assert!(
            (model.move_to(0.0045) - 500.0).abs() < 1e-9,
            "it unloads with K"
        );
        assert!((model.move_to(0.005) - 1000.0).abs() < 1e-9 && model.move_to(0.004).abs() < 1e-9);
        let weaker = 1000.0 * (1.0 - 4.0 / 36.0);
        assert!(
            (model.move_to(0.0035) + 500.0).abs() < 1e-9,
            "it reloads with K"
        );
        assert!((model.move_to(-0.003) + weaker).abs() < 1e-9);
        let absorbed = weaker * 0.007 - weaker * weaker / 1e6;
        let forwards = 1000.0 * (1.0 - absorbed / (40.0 - 4.0 - absorbed));
        assert!((model.move_to(0.003) - forwards).abs() < 1e-9);
    }

    /// With hardening, the slope falls with the strength: on the opposite yield line R = −sY + skX, with s = 1 − β of the energy of the
    /// first excursion. It is 1 kN at 1 mm and 1.4 kN at 5 mm, and unloads to 3.6 mm.
    #[test]
    fn hardening_wears_with_the_strength() {
        let mut model = spring(
            0.1,
            Deterioration {
                strength: 40.0,
                ..NO_WEAR
            },
        );
        assert!((model.move_to(0.005) - 1400.0).abs() < 1e-9);
        let absorbed = 0.5 * 1.0 + 0.5 * (1.0 + 1.4) * 4.0 - 0.5 * 1.4 * 1.4;
        let left = 1.0 - absorbed / (40.0 - absorbed);
        for displacement in [-0.004, -0.009] {
            let found = model.move_to(displacement);
            assert!(
                (found - left * (-900.0 + 1e5 * displacement)).abs() < 1e-9,
                "{displacement} m: {found} N"
            );
        }
    }

    /// To 5 mm it has absorbed 4.5 J, of which 0.5 J are released: β = 4/36. It unloads with 8/9 of K, and reloads along the same line.
    #[test]
    fn the_unloading_stiffness_falls_by_what_it_took() {
        let mut model = spring(
            0.0,
            Deterioration {
                unloading: 40.0,
                ..NO_WEAR
            },
        );
        model.move_to(0.005);
        let soft = 1e6 * (1.0 - 4.0 / 36.0);
        assert!((model.move_to(0.0045) - (1000.0 - 5e-4 * soft)).abs() < 1e-9);
        assert!((model.move_to(0.0048) - (1000.0 - 2e-4 * soft)).abs() < 1e-9);
        assert!(
            (model.move_to(0.0045) - (1000.0 - 5e-4 * soft)).abs() < 1e-9,
            "another reversal there costs nothing"
        );
        assert!(
            (model.move_to(0.007) - 1000.0).abs() < 1e-9,
            "its strength is whole"
        );
        assert!((model.move_to(-0.004) + 1000.0).abs() < 1e-9);
    }

    /// Elastic cycles lose nothing. Plastic cycles use up its capacity, unless it softens so much that they are elastic. It never
    /// releases more energy than it absorbed, and the counted energy is the work done.
    #[test]
    fn it_wears_out_and_gives_back_no_more_than_it_took() {
        for (post_yield_ratio, unloading) in
            [(0.0, f64::INFINITY), (0.0, 30.0), (0.05, 60.0), (0.4, 60.0)]
        {
            let mut model = spring(
                post_yield_ratio,
                Deterioration {
                    strength: 60.0,
                    unloading,
                    ..NO_WEAR
                },
            );
            for displacement in [0.0009, -0.0009, 0.0009, -0.0009, 0.0] {
                model.move_to(displacement);
            }
            assert_eq!(
                (model.degradation.strength, model.degradation.unloading),
                ([1.0; 2], 1.0)
            );
            let (mut work, mut least): (f64, f64) = (0.0, 0.0);
            for cycle in 1..=40 {
                let amplitude = 1e-3 * (1.5 + 0.2 * f64::from(cycle));
                for reversal in [
                    amplitude,
                    -0.3 * amplitude,
                    0.6 * amplitude,
                    -amplitude,
                    0.0,
                ] {
                    let from = model.displacement;
                    work += energy_along(&mut model, from, &[reversal], 1e-5);
                    least = least.min(work);
                }
            }
            assert!(least >= -1e-9, "{post_yield_ratio}: {least} J");
            let exhausted = model.degradation.strength == [0.1; 2];
            assert!(
                exhausted || (unloading.is_finite() && model.degradation.energy[0] < 60.0),
                "{post_yield_ratio}: {:?}",
                model.degradation
            );
            assert!(
                unloading.is_infinite() || model.degradation.unloading < 0.3,
                "{post_yield_ratio}: {:?}",
                model.degradation
            );
            let counted = model.degradation.energy[0] + model.degradation.energy[1];
            assert!(
                (counted / work - 1.0).abs() < 2e-3,
                "{post_yield_ratio}: {counted} J are counted, {work} J were done"
            );
        }
    }
}
