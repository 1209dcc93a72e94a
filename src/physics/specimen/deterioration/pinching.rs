//! Peak-oriented pinched hysteresis. In: a displacement. Out: the force there, exact for a move of any length: every branch is straight,
//! and a move is divided at their ends.

use super::{Degradation, Deterioration};
use crate::specimen::RestoringForce;

/// Parameters of a pinched hysteresis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinching {
    /// K \[N/m\]
    pub stiffness: f64,
    /// F_y \[N\]
    pub yield_force: f64,
    /// Post-yield stiffness ratio of the backbone.
    pub post_yield_ratio: f64,
    /// κ_F: force of the break point over that of the straight line to the peak.
    pub force_factor: f64,
    /// κ_D: 1 − displacement of the break point over the largest residual displacement.
    pub displacement_factor: f64,
    /// a of the unloading stiffness K (x_y/x_max)^a.
    pub unloading_exponent: f64,
    /// Post-capping branch; None without one.
    pub capping: Option<Capping>,
    /// Cyclic deterioration by absorbed energy; None without it.
    pub deterioration: Option<Deterioration>,
}

/// Post-capping branch of a backbone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capping {
    /// Its begin \[m\].
    pub displacement: f64,
    /// Its negative slope over the initial stiffness.
    pub slope: f64,
    /// Strength that is never lost, over the first one.
    pub residual: f64,
}

/// After Ibarra, Medina & Krawinkler, *Hysteretic models that incorporate strength and stiffness deterioration*, Earthquake
/// Engng Struct. Dyn. 34 (2005) 1489–1511; the break point and the order of the deterioration as `IMKPinching` of OpenSees has them:
/// - the backbone has the slope K to F_y, then the post-yield slope, and, where it is capped, from `x_c` a falling line to the residual
///   strength;
/// - unloading has the stiffness K (x_y/x_p)^a, with the peak displacement x_p of that direction (as in Takeda's model), but at least
///   that of the peak's chord, F_p/x_p; a reversal before zero force reloads along the same line;
/// - from zero force at u₀, reloading runs to the break point U = (1 − κ_D)·U_p, F = κ_F·F_p (U − u₀)/(x_p − u₀), with the residual
///   displacement U_p of the peak of that direction, and on to the peak; if u₀ is past the break point, straight to the peak;
/// - beyond the peak it is the backbone;
/// - basic strength, post-capping strength, unloading stiffness and the target of reloading deteriorate by the energy of its excursions
///   (`Degradation`); not while it is elastic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinchedHysteresis {
    plan: Pinching,
    /// Peak displacements on the backbone, forwards and backwards, both positive \[m\].
    peaks: [f64; 2],
    displacement: f64,
    force: f64,
    /// Last displacement of zero force \[m\].
    zero: f64,
    pub(super) degradation: Degradation,
    /// Begin of an unloading that has not reached zero force: displacement \[m\], force \[N\].
    reversal: Option<[f64; 2]>,
}

impl PinchedHysteresis {
    /// Undamaged, without load.
    #[must_use]
    pub fn new(plan: Pinching) -> Self {
        let yielded = plan.yield_force / plan.stiffness;
        Self {
            plan,
            peaks: [yielded; 2],
            displacement: 0.0,
            force: 0.0,
            zero: 0.0,
            degradation: Degradation::new(plan.deterioration, plan.yield_force, plan.stiffness),
            reversal: None,
        }
    }

    /// Force of the backbone of a direction at `displacement` past yield \[N\].
    fn backbone(&self, direction: f64, displacement: f64) -> f64 {
        let strength = self.degradation.strength[usize::from(direction < 0.0)];
        let yield_force = strength * self.plan.yield_force;
        let past = displacement - yield_force / self.plan.stiffness;
        let post_yield =
            yield_force + strength * self.plan.post_yield_ratio * self.plan.stiffness * past;
        match self.plan.capping {
            None => post_yield,
            Some(capping) => {
                let capped = self.cap(direction, capping)
                    - capping.slope * self.plan.stiffness * displacement;
                post_yield
                    .min(capped)
                    .max(capping.residual * self.plan.yield_force)
            }
        }
    }

    /// Force of the post-capping line at zero displacement \[N\].
    fn cap(&self, direction: f64, capping: Capping) -> f64 {
        let Capping {
            displacement,
            slope,
            ..
        } = capping;
        let Pinching {
            stiffness,
            yield_force,
            post_yield_ratio,
            ..
        } = self.plan;
        let top =
            yield_force + post_yield_ratio * stiffness * (displacement - yield_force / stiffness);
        self.degradation.capping[usize::from(direction < 0.0)]
            * (top + slope * stiffness * displacement)
    }

    /// Begin and end of the post-capping branch of a direction \[m\].
    fn cap_limits(&self, direction: f64) -> [f64; 2] {
        let Some(capping) = self.plan.capping else {
            return [f64::INFINITY; 2];
        };
        let Pinching {
            stiffness,
            yield_force,
            post_yield_ratio,
            ..
        } = self.plan;
        let strength = self.degradation.strength[usize::from(direction < 0.0)];
        let (cap, falls) = (self.cap(direction, capping), capping.slope * stiffness);
        let hardens = strength * post_yield_ratio * stiffness;
        let at_none = strength * yield_force * (1.0 - strength * post_yield_ratio);
        let begins = (cap - at_none) / (hardens + falls);
        [begins, (cap - capping.residual * yield_force) / falls]
    }

    /// Unloading stiffness from a force of a direction \[N/m\].
    fn unloading(&self, direction: f64) -> f64 {
        let peak = self.peak(direction);
        let ductility = peak * self.plan.stiffness / self.plan.yield_force;
        // Never softer than the chord from the last zero force, so that no energy is released twice.
        let falls = self.degradation.degrades() || self.plan.capping.is_some();
        let from = if falls {
            (self.zero * direction).clamp(0.0, 0.999 * peak)
        } else {
            0.0
        };
        let degraded = self.degradation.unloading
            * self.plan.stiffness
            * ductility.powf(-self.plan.unloading_exponent);
        degraded.max(self.backbone(direction, peak) / (peak - from))
    }

    const fn peak(&self, direction: f64) -> f64 {
        if direction > 0.0 {
            self.peaks[0]
        } else {
            self.peaks[1]
        }
    }

    /// Ends of the straight branches of reloading from zero force at `zero` to the peak, all along the direction.
    fn branches(&self, direction: f64, zero: f64) -> [[f64; 2]; 2] {
        let peak = self.peak(direction);
        let top = self.backbone(direction, peak);
        let permanent = peak - top / self.unloading(direction);
        let at = (1.0 - self.plan.displacement_factor) * permanent;
        if at <= zero {
            return [[peak, top]; 2];
        }
        [
            [
                at,
                self.plan.force_factor * top * (at - zero) / (peak - zero),
            ],
            [peak, top],
        ]
    }

    /// Moves along a straight branch to `end`, or to `to` before it; true where `to` was reached. All along the direction.
    fn along(&mut self, direction: f64, end: [f64; 2], to: f64) -> bool {
        let (from, force) = (self.displacement * direction, self.force * direction);
        let [end_at, end_force] = end;
        let reached = to < end_at;
        let force = if reached {
            force + (end_force - force) * ((to - from) / (end_at - from))
        } else {
            end_force
        };
        self.pass(
            direction * if reached { to } else { end_at },
            direction * force,
        );
        reached
    }

    /// Moves to a displacement \[m\] and the force there \[N\], with the work of a straight line.
    fn pass(&mut self, displacement: f64, force: f64) {
        self.degradation
            .work(0.5 * (self.force + force) * (displacement - self.displacement));
        (self.displacement, self.force) = (displacement, force);
    }

    /// Unloads a force against the direction, or reloads to the begin of an unloading; true where `to` was reached. A force that has
    /// unloaded to exactly zero still ends its excursion when the motion continues.
    fn elastic(&mut self, direction: f64, to: f64) -> bool {
        let unloads = self
            .reversal
            .is_some_and(|[_, force]| force * direction < 0.0);
        if self.force * direction < 0.0 || unloads {
            if self.reversal.is_none() {
                self.reversal = Some([self.displacement, self.force]);
                self.degradation
                    .turned(0.5 * self.force * self.force / self.unloading(-direction));
            }
            let end =
                self.displacement * direction - self.force * direction / self.unloading(-direction);
            if self.along(direction, [end, 0.0], to) {
                return true;
            }
            self.zero = self.displacement;
            self.reversal = None;
            let side = usize::from(direction < 0.0);
            self.peaks[side] *= self.degradation.ended(side);
        }
        if let Some([at, force]) = self.reversal {
            if self.along(direction, [at * direction, force * direction], to) {
                return true;
            }
            self.reversal = None;
        }
        false
    }

    fn go(&mut self, direction: f64, to: f64) {
        if self.elastic(direction, to) {
            return;
        }
        for end in self.branches(direction, self.zero * direction) {
            if self.displacement * direction < end[0] && self.along(direction, end, to) {
                return;
            }
        }
        for limit in self.cap_limits(direction) {
            if self.peak(direction) < limit && limit < to {
                self.beyond(direction, limit);
            }
        }
        if to > self.peak(direction) {
            self.beyond(direction, to);
        }
        self.displacement = direction * to;
    }

    /// Moves along the backbone, which is straight up to `to` (along the direction) \[m\].
    fn beyond(&mut self, direction: f64, to: f64) {
        self.peaks[usize::from(direction < 0.0)] = to;
        self.pass(direction * to, direction * self.backbone(direction, to));
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
pub(super) mod tests {
    use super::*;
    use crate::specimen::tests::energy_along;

    /// 1000 N/mm to 1 kN, perfectly plastic; κ_F = 0.4, κ_D = 0.5.
    pub(crate) const PLAN: Pinching = Pinching {
        stiffness: 1e6,
        yield_force: 1000.0,
        post_yield_ratio: 0.0,
        force_factor: 0.4,
        displacement_factor: 0.5,
        unloading_exponent: 0.0,
        capping: None,
        deterioration: None,
    };

    #[test]
    fn the_points_of_the_rule_by_hand() {
        let mut model = PinchedHysteresis::new(PLAN);
        let path = [
            (0.0005, 500.0),
            (0.0050, 1000.0),
            // Unloads with K; reloads before zero force; zero force at 4 mm.
            (0.0045, 500.0),
            (0.0048, 800.0),
            (0.0045, 500.0),
            (0.0040, 0.0),
            // In the opposite direction to the peak at −1 mm: its permanent displacement is 0, and so is the break point's; −400·4/5 =
            // −320 N there.
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
            assert!(
                (found - force).abs() < 1e-9,
                "{displacement} m: {found} N is not {force} N"
            );
        }
    }

    #[test]
    fn unloading_softens_with_the_peak_and_never_below_its_chord() {
        let soft = Pinching {
            unloading_exponent: 0.5,
            ..PLAN
        };
        let mut model = PinchedHysteresis::new(soft);
        model.move_to(0.004);
        // K/√4 = 500 N/mm.
        assert!((model.move_to(0.003) - 500.0).abs() < 1e-9);
        let mut hard = PinchedHysteresis::new(Pinching {
            unloading_exponent: 1.0,
            post_yield_ratio: 0.5,
            ..PLAN
        });
        let top = hard.move_to(0.004);
        assert!((top - 2500.0).abs() < 1e-9);
        assert!(
            (hard.move_to(0.002) - 1250.0).abs() < 1e-9,
            "to the origin, not past it"
        );
    }

    /// Just before the displacement of zero force the force rounds to zero. Loading in the opposite direction begins there, not at the
    /// reversal point.
    #[test]
    fn an_unloading_that_rounds_to_zero_force_has_ended() {
        let mut model = PinchedHysteresis::new(Pinching {
            unloading_exponent: 1.0,
            ..PLAN
        });
        model.move_to(-0.002);
        assert_eq!(model.move_to(-1e-30), 0.0);
        let next = model.move_to(0.0005);
        assert!((next - 500.0).abs() < 1e-9, "{next} N");
    }

    /// A settled cycle ±A of the perfectly plastic one with κ_D = 1 (break points at zero displacement): by hand, with A = 5 x_y, the
    /// reloading polygon (−4, 0), (0, 400·4/9), (5, 1000), unloading to (4, 0), and the same mirrored: areas in N·mm.
    #[test]
    fn energy_of_a_settled_cycle() {
        let mut model = PinchedHysteresis::new(Pinching {
            displacement_factor: 1.0,
            ..PLAN
        });
        let (amplitude, middle) = (0.005, 1600.0 / 9.0);
        model.move_to(amplitude);
        model.move_to(-amplitude);
        let energy = energy_along(&mut model, -amplitude, &[amplitude, -amplitude], 1e-6);
        let half = 0.5 * 4.0 * middle + 0.5 * 5.0 * (middle + 1000.0) - 0.5 * 1000.0;
        assert!(
            (energy / (2e-3 * half) - 1.0).abs() < 1e-6,
            "{energy} J is not {} J",
            2e-3 * half
        );
    }
}
