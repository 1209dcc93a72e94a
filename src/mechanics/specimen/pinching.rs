//! Pinched hysteresis, peak-oriented. In: a displacement. Out: the force there, exact however large the move: every branch is
//! straight, and a move is cut at their ends.

use super::RestoringForce;
use crate::plan::{Deterioration, Pinching};

/// After Ibarra, Medina & Krawinkler, *Hysteretic models that incorporate strength and stiffness deterioration*, Earthquake
/// Engng Struct. Dyn. 34 (2005) 1489–1511, of its modes of deterioration that of the basic strength; the break point and the order of
/// the deterioration as `IMKPinching` of OpenSees has them:
/// - the backbone is bilinear: K to F_y, then hardening;
/// - unloading has the stiffness K (x_y/x_p)^a, x_p the peak displacement that way (Takeda, Sozen & Nielsen 1970), but at
///   least that of the peak's chord, F_p/x_p; a return before the force is gone goes back up the same line;
/// - from no force at u₀, reloading runs to the break point U = (1 − κ_D)·U_p, F = κ_F·F_p (U − u₀)/(x_p − u₀), with U_p the
///   permanent displacement of the peak that way, and on to the peak; where u₀ is past the break point, straight to the peak;
/// - from the peak on it is the backbone;
/// - each time the force is gone, an excursion has taken `E_i` (it stores nothing then). The strength of the way it goes on is
///   multiplied by 1 − β, β = (`E_i`/(γ F_y x_y − ΣE_j))^c with all excursions so far in the sum, yield force and hardening alike, down
///   to the residual. Nothing is lost while it is elastic, for then `E_i` is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinchedHysteresis {
    plan: Pinching,
    /// Farthest displacements on the backbone, forwards and backwards, m, both counted positive.
    peaks: [f64; 2],
    displacement: f64,
    force: f64,
    /// Where the force was last 0, m.
    zero: f64,
    /// Strength over the first one, forwards and backwards.
    strength: [f64; 2],
    /// Taken in all excursions that ended, and in the one that has not, J.
    energy: [f64; 2],
    /// Where an unloading began that has not come to no force yet: displacement (m), force (N).
    turn: Option<[f64; 2]>,
}

impl PinchedHysteresis {
    #[must_use]
    pub fn new(plan: Pinching) -> Self {
        let yielded = plan.yield_force / plan.stiffness;
        Self {
            plan,
            peaks: [yielded; 2],
            displacement: 0.0,
            force: 0.0,
            zero: 0.0,
            strength: [1.0; 2],
            energy: [0.0; 2],
            turn: None,
        }
    }

    /// Force of the backbone that way at `displacement` past yield, N.
    fn backbone(&self, way: f64, displacement: f64) -> f64 {
        let strength = self.strength[usize::from(way < 0.0)];
        let yield_force = strength * self.plan.yield_force;
        let past = displacement - yield_force / self.plan.stiffness;
        yield_force + strength * self.plan.hardening * self.plan.stiffness * past
    }

    /// An excursion has ended, and the next one goes this way: its strength falls.
    fn deteriorate(&mut self, way: f64) {
        let Some(Deterioration { capacity, exponent, residual }) = self.plan.deterioration else { return };
        let taken = self.energy[1].max(0.0);
        self.energy = [self.energy[0] + taken, 0.0];
        let left = capacity * self.plan.yield_force * self.plan.yield_force / self.plan.stiffness - self.energy[0];
        let share = if left > taken { (taken / left).powf(exponent) } else { 1.0 };
        let strength = &mut self.strength[usize::from(way < 0.0)];
        *strength = (*strength * (1.0 - share)).max(residual);
    }

    /// Stiffness at which a force that way unloads, N/m.
    fn unloading(&self, way: f64) -> f64 {
        let peak = self.peak(way);
        let ductility = peak * self.plan.stiffness / self.plan.yield_force;
        // Never softer than the way there, from where the force was gone: what was taken is not given back twice.
        let from = if self.plan.deterioration.is_some() { (self.zero * way).clamp(0.0, 0.999 * peak) } else { 0.0 };
        (self.plan.stiffness * ductility.powf(-self.plan.unloading_exponent)).max(self.backbone(way, peak) / (peak - from))
    }

    const fn peak(&self, way: f64) -> f64 {
        if way > 0.0 { self.peaks[0] } else { self.peaks[1] }
    }

    /// Ends of the straight branches of a reloading from no force at `zero` to the peak, all counted along the way.
    fn branches(&self, way: f64, zero: f64) -> [[f64; 2]; 2] {
        let peak = self.peak(way);
        let top = self.backbone(way, peak);
        let permanent = peak - top / self.unloading(way);
        let at = (1.0 - self.plan.displacement_factor) * permanent;
        if at <= zero {
            return [[peak, top]; 2];
        }
        [[at, self.plan.force_factor * top * (at - zero) / (peak - zero)], [peak, top]]
    }

    /// Goes along a straight branch to `end` or as far as `to`; true where `to` was reached. All counted along the way.
    fn along(&mut self, way: f64, end: [f64; 2], to: f64) -> bool {
        let (from, force) = (self.displacement * way, self.force * way);
        let [end_at, end_force] = end;
        let reached = to < end_at;
        let force = if reached { force + (end_force - force) * ((to - from) / (end_at - from)) } else { end_force };
        self.pass(way * if reached { to } else { end_at }, way * force);
        reached
    }

    /// Goes straight to a place (m) and the force there (N).
    fn pass(&mut self, displacement: f64, force: f64) {
        self.energy[1] += 0.5 * (self.force + force) * (displacement - self.displacement);
        (self.displacement, self.force) = (displacement, force);
    }

    /// Unloads a force against the way, or comes back up to where an unloading began; true where `to` was reached.
    fn elastic(&mut self, way: f64, to: f64) -> bool {
        if self.force * way < 0.0 {
            if self.turn.is_none() {
                self.turn = Some([self.displacement, self.force]);
            }
            let end = self.displacement * way - self.force * way / self.unloading(-way);
            if self.along(way, [end, 0.0], to) {
                return true;
            }
            self.zero = self.displacement;
            self.turn = None;
            self.deteriorate(way);
        }
        if let Some([at, force]) = self.turn {
            if self.along(way, [at * way, force * way], to) {
                return true;
            }
            self.turn = None;
        }
        false
    }

    fn go(&mut self, way: f64, to: f64) {
        if self.elastic(way, to) {
            return;
        }
        for end in self.branches(way, self.zero * way) {
            if self.displacement * way < end[0] && self.along(way, end, to) {
                return;
            }
        }
        if to > self.peak(way) {
            self.peaks[usize::from(way < 0.0)] = to;
            self.pass(way * to, way * self.backbone(way, to));
        }
        self.displacement = way * to;
    }
}

impl RestoringForce for PinchedHysteresis {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let moved = displacement - self.displacement;
        if moved != 0.0 {
            self.go(moved.signum(), displacement * moved.signum());
            self.displacement = displacement;
        }
        self.force
    }

    fn initial_stiffness(&self) -> f64 {
        self.plan.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::energy_along;
    use super::*;

    /// 1000 N/mm to 1 kN, perfectly plastic; κ_F = 0.4, κ_D = 0.5.
    const PLAN: Pinching = Pinching {
        stiffness: 1e6,
        yield_force: 1000.0,
        hardening: 0.0,
        force_factor: 0.4,
        displacement_factor: 0.5,
        unloading_exponent: 0.0,
        deterioration: None,
    };

    #[test]
    fn the_points_of_the_rule_by_hand() {
        let mut model = PinchedHysteresis::new(PLAN);
        let path = [
            (0.0005, 500.0),
            (0.0050, 1000.0),
            // Unloads with K; back up before the force is gone; no force at 4 mm.
            (0.0045, 500.0),
            (0.0048, 800.0),
            (0.0045, 500.0),
            (0.0040, 0.0),
            // Backwards to the peak at −1 mm: its permanent displacement is 0, so is the break point's; −400·4/5 = −320 N there.
            (0.0020, -160.0),
            (0.0000, -320.0),
            (-0.0010, -1000.0),
            (-0.0030, -1000.0),
            (-0.0020, 0.0),
            // Forwards: break point at half of 4 mm, 400·(2 + 2)/(5 + 2) N.
            (0.0020, 1600.0 / 7.0),
            (0.0050, 1000.0),
            (0.0060, 1000.0),
        ];
        for (displacement, force) in path {
            let found = model.move_to(displacement);
            assert!((found - force).abs() < 1e-9, "{displacement} m: {found} N is not {force} N");
        }
    }

    #[test]
    fn unloading_softens_with_the_peak_and_never_below_its_chord() {
        let soft = Pinching { unloading_exponent: 0.5, ..PLAN };
        let mut model = PinchedHysteresis::new(soft);
        model.move_to(0.004);
        // K/√4 = 500 N/mm.
        assert!((model.move_to(0.003) - 500.0).abs() < 1e-9);
        let mut hard = PinchedHysteresis::new(Pinching { unloading_exponent: 1.0, hardening: 0.5, ..PLAN });
        let top = hard.move_to(0.004);
        assert!((top - 2500.0).abs() < 1e-9);
        assert!((hard.move_to(0.002) - 1250.0).abs() < 1e-9, "to the origin, not past it");
    }

    /// A settled cycle ±A of the perfectly plastic one with κ_D = 1 (break points at no displacement): by hand, with A = 5 x_y,
    /// the reloading polygon (−4, 0), (0, 400·4/9), (5, 1000), unloading to (4, 0), and the same mirrored: areas in N·mm.
    #[test]
    fn energy_of_a_settled_cycle() {
        let mut model = PinchedHysteresis::new(Pinching { displacement_factor: 1.0, ..PLAN });
        let (amplitude, middle) = (0.005, 1600.0 / 9.0);
        model.move_to(amplitude);
        model.move_to(-amplitude);
        let energy = energy_along(&mut model, -amplitude, &[amplitude, -amplitude], 1e-6);
        let half = 0.5 * 4.0 * middle + 0.5 * 5.0 * (middle + 1000.0) - 0.5 * 1000.0;
        assert!((energy / (2e-3 * half) - 1.0).abs() < 1e-6, "{energy} J is not {} J", 2e-3 * half);
    }

    const TIRES: Pinching = Pinching {
        displacement_factor: 1.0,
        deterioration: Some(Deterioration { capacity: 40.0, exponent: 1.0, residual: 0.1 }),
        ..PLAN
    };

    /// Perfectly plastic to 5 mm and back to no force: 1000·(5 − 1) mN·m = 4 J of γ F_y x_y = 40 J. β = 4/(40 − 4): backwards it
    /// yields at 8/9 of 1 kN. There to −3 mm from −1 mm, and so on.
    #[test]
    fn strength_is_lost_by_the_energy_of_each_excursion() {
        let mut model = PinchedHysteresis::new(TIRES);
        model.move_to(0.005);
        assert!((model.move_to(0.004)).abs() < 1e-9);
        let weaker = 1000.0 * (1.0 - 4.0 / 36.0);
        // Break point at no displacement: 0.4 of it times 4/5 of the way.
        assert!((model.move_to(0.0) + 0.4 * weaker * 4.0 / 5.0).abs() < 1e-9);
        assert!((model.move_to(-0.001) + weaker).abs() < 1e-9 && (model.move_to(-0.003) + weaker).abs() < 1e-9);
        let at_break = 0.32 * weaker;
        let taken = 1e-3 * (0.5 * 4.0 * at_break + 0.5 * (at_break + weaker) + 2.0 * weaker) - 0.5 * weaker * weaker / 1e6;
        model.move_to(-0.003 + weaker / 1e6);
        model.move_to(0.005);
        let forwards = 1000.0 * (1.0 - taken / (40.0 - 4.0 - taken));
        assert!((model.move_to(0.006) - forwards).abs() < 1e-9, "{} N is not {forwards} N", model.force);
    }

    /// Elastic cycles take nothing and lose nothing; plastic ones lose strength at every reversal, never gain it, never below the
    /// residual; and what it took is what ∫R dX says, by trapezia so fine that nothing is left of their error.
    #[test]
    fn deterioration_is_monotone_and_its_energy_is_the_work_done() {
        let mut model = PinchedHysteresis::new(TIRES);
        for _ in 0..5 {
            model.move_to(0.0009);
            model.move_to(-0.0009);
        }
        assert_eq!(model.strength, [1.0; 2]);
        model.move_to(0.0);
        let (mut work, mut strength) = (0.0, model.strength);
        for cycle in 1..=30 {
            let amplitude = 1e-3 * (2.0 + 0.1 * f64::from(cycle));
            work += energy_along(&mut model, 0.0, &[amplitude, -amplitude, 0.0], 1e-5);
            assert!(
                model.strength.iter().zip(strength).all(|(now, before)| *now <= before && *now >= 0.1),
                "{:?}",
                model.strength
            );
            strength = model.strength;
        }
        assert_eq!(strength, [0.1; 2], "worn out");
        let counted = model.energy[0] + model.energy[1];
        assert!((counted / work - 1.0).abs() < 1e-4, "{counted} J are counted, {work} J were done");
    }
}
