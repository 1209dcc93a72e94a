//! Two slopes that wear. In: a displacement. Out: the force there, exact however large the move; without wear, bit for bit that of the
//! bilinear spring.

use super::RestoringForce;
use super::deterioration::Wear;
use crate::specimen::Deterioration;

/// The bilinear spring (`Bilinear`: K between two lines of slope k, R = kX ± Y, Y = (1 − h)F_y, k = hK) with two of the modes of deterioration of
/// Ibarra, Medina & Krawinkler (Earthquake Engng Struct. Dyn. 34 (2005) 1489–1511), in the order of `IMKBilin` of OpenSees:
/// - where the force is gone and the way goes on to a side, Y of that side, and k with it, by the share that is lost (`Wear`). The slope is one for both
///   sides: two lines of different slopes would cross, and a spring that is held between them would give back what it never took;
/// - where a loaded excursion turns, the stiffness between the lines. The store of what is between them, ½(R − kX)²/(K − k), grows with
///   that; never by more than has been lost to flow since the last time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearingBilinear {
    /// The first K, N/m.
    stiffness: f64,
    /// The first Y, N.
    half_band: f64,
    /// k, N/m
    hardened: f64,
    displacement: f64,
    force: f64,
    pub(super) wear: Wear,
    /// The way of the present excursion, from no force to none; 0 before the first.
    excursion: f64,
    /// Whether it has turned and not flowed since.
    turned: bool,
    /// Lost to flow since the stiffness last fell, J.
    flowed: f64,
}

impl WearingBilinear {
    /// `stiffness` K (N/m), `yield_force` (N), `hardening` h, 0 to 1.
    #[must_use]
    pub fn new(stiffness: f64, yield_force: f64, hardening: f64, rule: Deterioration) -> Self {
        Self {
            stiffness,
            half_band: (1.0 - hardening) * yield_force,
            hardened: hardening * stiffness,
            displacement: 0.0,
            force: 0.0,
            wear: Wear::new(Some(rule), yield_force, stiffness),
            excursion: 0.0,
            turned: false,
            flowed: 0.0,
        }
    }

    /// Between the lines, N/m.
    fn elastic(&self) -> f64 {
        self.wear.unloading * self.stiffness
    }

    /// Y of the side that lies this way, N.
    fn band(&self, way: f64) -> f64 {
        self.wear.strength[usize::from(way < 0.0)] * self.half_band
    }

    /// Where the way from `from` (displacement and force, both counted along it) meets the line ahead, m.
    fn meets(&self, way: f64, [place, force]: [f64; 2]) -> f64 {
        let steeper = self.elastic() - self.hardened;
        if steeper <= 0.0 {
            return f64::INFINITY;
        }
        ((self.band(way) - force + self.elastic() * place) / steeper).max(place)
    }

    /// Where a force against the way is gone: between the lines, or beyond, where the spring yields under it already.
    fn no_force(&self, way: f64, from: [f64; 2]) -> f64 {
        let [place, force] = from;
        let elastic = place - force / self.elastic();
        if elastic <= self.meets(way, from) {
            elastic
        } else {
            -self.band(way) / self.hardened
        }
    }

    /// Counts the work of going on to `to`, and what of it is lost to flow.
    fn count(&mut self, way: f64, from: [f64; 2], to: f64) {
        let [place, force] = from;
        let yields = self.meets(way, from).min(to);
        let there = force + self.elastic() * (yields - place);
        self.wear.work(0.5 * (force + there) * (yields - place));
        if yields < to {
            let end = there + self.hardened * (to - yields);
            self.wear.work(0.5 * (there + end) * (to - yields));
            self.flowed += self.band(way) * (to - yields);
            self.turned &= end <= 0.0;
        }
    }

    /// A loaded excursion turns.
    fn turn(&mut self) {
        self.turned = true;
        let (before, within) = (
            self.wear.unloading,
            self.force - self.hardened * self.displacement,
        );
        self.wear
            .turned(0.5 * self.force * self.force / self.elastic());
        if self.wear.unloading < before && within != 0.0 {
            let store = 0.5 * within * within;
            let least = self.hardened
                + store / (store / (before * self.stiffness - self.hardened) + self.flowed);
            self.wear.unloading = self.wear.unloading.max(least / self.stiffness).min(before);
            self.flowed = 0.0;
        } else {
            self.wear.unloading = before;
        }
    }

    /// The force is gone, and the way goes on. Out: whether anything was lost.
    fn ended(&mut self, way: f64) -> bool {
        let side = usize::from(way < 0.0);
        let before = self.wear.strength[side];
        self.wear.ended(side);
        self.hardened *= self.wear.strength[side] / before;
        (self.excursion, self.turned) = (way, false);
        self.wear.strength[side] < before
    }

    fn go(&mut self, way: f64, to: f64) {
        if self.force * way < 0.0 && !self.turned {
            self.turn();
        }
        let mut from = [self.displacement * way, self.force * way];
        let mut origin = from;
        if self.excursion * way < 0.0 {
            let gone = if from[1] < 0.0 {
                self.no_force(way, from)
            } else {
                from[0]
            };
            if to >= gone {
                self.count(way, from, gone);
                from = [gone, 0.0];
                if self.ended(way) {
                    origin = from;
                }
            }
        } else {
            self.excursion = way;
        }
        self.count(way, from, to);
        let (middle, trial) = (
            self.hardened * to,
            origin[1] + self.elastic() * (to - origin[0]),
        );
        self.displacement = way * to;
        // Without a sign where it is gone.
        self.force = way
            * trial
                .max(middle - self.band(-way))
                .min(middle + self.band(way))
            + 0.0;
    }
}

impl RestoringForce for WearingBilinear {
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
    use super::super::Bilinear;
    use super::super::tests::energy_along;
    use super::*;

    /// Capacities without end.
    const NO_WEAR: Deterioration = Deterioration {
        strength: f64::INFINITY,
        capping: f64::INFINITY,
        unloading: f64::INFINITY,
        reloading: f64::INFINITY,
        exponent: 1.0,
        residual: 0.1,
    };

    /// 1000 N/mm to 1 kN; γ `F_y` `x_y` = 40 J of a γ of 40.
    fn spring(hardening: f64, rule: Deterioration) -> WearingBilinear {
        WearingBilinear::new(1e6, 1000.0, hardening, rule)
    }

    /// Turns of all kinds: elastic, yielding, under a force that is not gone, on either side, tiny.
    fn ways() -> impl Iterator<Item = f64> {
        let places = [
            0.003, -0.002, 0.006, 0.001, 0.0055, -0.007, -0.004, -0.0065, 0.009, -0.012, 0.02,
            0.0201, 0.0, 1e-9,
        ];
        (0..200_u32).map(move |index| {
            places[index as usize % places.len()] * (1.0 + 0.37 * f64::from(index % 11))
        })
    }

    /// Capacities without end: the bilinear spring, bit for bit, also where it hardens so much that it yields before its force is gone.
    #[test]
    fn without_wear_it_is_the_bilinear_spring() {
        for hardening in [0.0, 0.03, 0.1, 0.6, 1.0] {
            let (mut plain, mut worn) = (
                Bilinear::new(1e6, 1000.0, hardening),
                spring(hardening, NO_WEAR),
            );
            for way in ways() {
                assert_eq!(
                    plain.move_to(way).to_bits(),
                    worn.move_to(way).to_bits(),
                    "hardening {hardening}, {way} m"
                );
            }
        }
    }

    /// To 5 mm and back to no force it takes 4 J of 40 J: β = 4/36, and backwards it yields at 8/9 of 1 kN. From 4 mm there to −3 mm it takes
    /// F·(4 + 3) mm − F²/K, of which the forward strength is lost.
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
        let taken = weaker * 0.007 - weaker * weaker / 1e6;
        let forwards = 1000.0 * (1.0 - taken / (40.0 - 4.0 - taken));
        assert!((model.move_to(0.003) - forwards).abs() < 1e-9);
    }

    /// With hardening, the slope goes with the strength: on the line backwards R = −sY + skX, s = 1 − β of what the first excursion took. It is
    /// 1 kN at 1 mm and 1.4 kN at 5 mm, and unloads to 3.6 mm.
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
        let taken = 0.5 * 1.0 + 0.5 * (1.0 + 1.4) * 4.0 - 0.5 * 1.4 * 1.4;
        let left = 1.0 - taken / (40.0 - taken);
        for place in [-0.004, -0.009] {
            let found = model.move_to(place);
            assert!(
                (found - left * (-900.0 + 1e5 * place)).abs() < 1e-9,
                "{place} m: {found} N"
            );
        }
    }

    /// To 5 mm it has taken 4.5 J, of which 0.5 J come back: β = 4/36, and it unloads with 8/9 of K; back up the same line.
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
            "another turn there costs nothing"
        );
        assert!(
            (model.move_to(0.007) - 1000.0).abs() < 1e-9,
            "its strength is whole"
        );
        assert!((model.move_to(-0.004) + 1000.0).abs() < 1e-9);
    }

    /// Elastic cycles lose nothing; plastic ones wear it out within its capacity, unless it softens so much that they are elastic; it never gives back
    /// more than it took, and what it counts is the work done.
    #[test]
    fn it_wears_out_and_gives_back_no_more_than_it_took() {
        for (hardening, unloading) in [(0.0, f64::INFINITY), (0.0, 30.0), (0.05, 60.0), (0.4, 60.0)]
        {
            let mut model = spring(
                hardening,
                Deterioration {
                    strength: 60.0,
                    unloading,
                    ..NO_WEAR
                },
            );
            for place in [0.0009, -0.0009, 0.0009, -0.0009, 0.0] {
                model.move_to(place);
            }
            assert_eq!((model.wear.strength, model.wear.unloading), ([1.0; 2], 1.0));
            let (mut work, mut least): (f64, f64) = (0.0, 0.0);
            for cycle in 1..=40 {
                let amplitude = 1e-3 * (1.5 + 0.2 * f64::from(cycle));
                for turn in [
                    amplitude,
                    -0.3 * amplitude,
                    0.6 * amplitude,
                    -amplitude,
                    0.0,
                ] {
                    let from = model.displacement;
                    work += energy_along(&mut model, from, &[turn], 1e-5);
                    least = least.min(work);
                }
            }
            assert!(least >= -1e-9, "{hardening}: {least} J");
            let worn_out = model.wear.strength == [0.1; 2];
            assert!(
                worn_out || (unloading.is_finite() && model.wear.energy[0] < 60.0),
                "{hardening}: {:?}",
                model.wear
            );
            assert!(
                unloading.is_infinite() || model.wear.unloading < 0.3,
                "{hardening}: {:?}",
                model.wear
            );
            let counted = model.wear.energy[0] + model.wear.energy[1];
            assert!(
                (counted / work - 1.0).abs() < 2e-3,
                "{hardening}: {counted} J are counted, {work} J were done"
            );
        }
    }
}
