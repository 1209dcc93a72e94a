//! A bolted joint: clamped faces that slip, then the bolt bears on the edge of its hole, which grows when it yields. In: a displacement.
//! Out: the force there, by exact return maps.

use super::{Bilinear, BilinearCurve, RestoringForce};

/// Parameters of a bolted joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bolted {
    /// In bearing, and of the friction before slip \[N/m\].
    pub stiffness: f64,
    /// Force at which a hole yields and grows \[N\].
    pub bearing_force: f64,
    /// Clearance from the middle to bearing \[m\].
    pub clearance: f64,
    /// Friction of the clamped faces \[N\].
    pub slip_force: f64,
}

/// Friction and two edges in parallel. Friction: stiffness K up to the slip force, perfectly plastic beyond. Each edge:
/// zero force before its gap g is closed, then K (x − g), at most the bearing force: there the hole grows permanently, g ← x − F_b/K
/// (the elastic–plastic gap with damage of OpenSees, `ElasticPPGap`). After some cycles the joint is loose: the force is small around
/// the middle, which is the pinched loop of bolted supports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoltedJoint {
    stiffness: f64,
    bearing_force: f64,
    /// Clearance to bearing forwards and backwards, both positive \[m\].
    gaps: [f64; 2],
    friction: Option<Bilinear>,
}

impl BoltedJoint {
    /// A joint in the middle of its clearance, without load.
    #[must_use]
    pub fn new(joint: Bolted) -> Self {
        let friction = (joint.slip_force > 0.0).then(|| {
            Bilinear::new(BilinearCurve {
                stiffness: joint.stiffness,
                yield_force: joint.slip_force,
                post_yield_ratio: 0.0,
            })
        });
        let gaps = [joint.clearance; 2];
        Self {
            stiffness: joint.stiffness,
            bearing_force: joint.bearing_force,
            gaps,
            friction,
        }
    }

    /// Force of the edge on `side` (0 forwards, 1 backwards) at a displacement towards it; its gap grows where the hole yields.
    fn bearing(&mut self, side: usize, displacement: f64) -> f64 {
        let gap = &mut self.gaps[side];
        let force = self.stiffness * (displacement - *gap);
        if force <= 0.0 {
            0.0
        } else if force < self.bearing_force {
            force
        } else {
            *gap = displacement - self.bearing_force / self.stiffness;
            self.bearing_force
        }
    }
}

impl RestoringForce for BoltedJoint {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let ahead = self.bearing(0, displacement);
        let behind = self.bearing(1, -displacement);
        ahead - behind
            + self
                .friction
                .as_mut()
                .map_or(0.0, |friction| friction.move_to(displacement))
    }

    /// In bearing, for a joint without friction.
    fn initial_stiffness(&self) -> f64 {
        if self.gaps == [0.0; 2] && self.friction.is_some() {
            2.0 * self.stiffness
        } else {
            self.stiffness
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::energy_along;
    use super::*;

    fn joint(clearance: f64, slip_force: f64) -> BoltedJoint {
        BoltedJoint::new(Bolted {
            stiffness: 1e6,
            bearing_force: 2000.0,
            clearance,
            slip_force,
        })
    }

    /// 1000 N/mm, bearing at 2 kN, 0.5 mm of clearance.
    #[test]
    fn corners_by_hand() {
        let mut joint = joint(0.0005, 0.0);
        let corners = [
            (0.0004, 0.0),
            (0.0015, 1000.0),
            (0.0025, 2000.0),
            (0.0040, 2000.0),
            // The hole grew by 1.5 mm on this side alone.
            (0.0030, 1000.0),
            (0.0020, 0.0),
            (-0.0005, 0.0),
            (-0.0015, -1000.0),
            (0.0019, 0.0),
            (0.0025, 500.0),
        ];
        for (displacement, force) in corners {
            let found = joint.move_to(displacement);
            assert!(
                (found - force).abs() < 1e-9,
                "{displacement} m: {found} N is not {force} N"
            );
        }
        assert!((joint.gaps[0] + joint.gaps[1] - 0.0025).abs() < 1e-15);
    }

    /// Slip dissipates 4 F_s (A − x_s) per cycle, x_s = F_s/K; the first cycle dissipates besides F_b times the growth of the holes.
    #[test]
    fn energy_of_friction_and_of_growing_holes() {
        let (clearance, slip, amplitude) = (0.0005, 300.0, 0.004);
        let mut joint = joint(clearance, slip);
        joint.move_to(amplitude);
        joint.move_to(-amplitude);
        let settled = energy_along(&mut joint, -amplitude, &[amplitude, -amplitude], 1e-6);
        let friction = 4.0 * slip * (amplitude - slip / 1e6);
        assert!(
            (settled / friction - 1.0).abs() < 1e-6,
            "{settled} J is not {friction} J"
        );
        let mut new = BoltedJoint::new(Bolted {
            stiffness: 1e6,
            bearing_force: 2000.0,
            clearance,
            slip_force: 0.0,
        });
        let first = energy_along(&mut new, 0.0, &[amplitude, -amplitude, 0.0], 1e-6);
        let holes = 2.0 * 2000.0 * (amplitude - clearance - 0.002);
        assert!(
            (first / holes - 1.0).abs() < 1e-6,
            "{first} J is not {holes} J"
        );
        assert!(energy_along(&mut new, 0.0, &[amplitude, -amplitude, 0.0], 1e-6).abs() < 1e-9);
    }

    #[test]
    fn what_holds_at_first_is_the_friction() {
        assert_eq!(joint(0.0, 100.0).initial_stiffness(), 2e6);
        assert_eq!(joint(0.001, 100.0).initial_stiffness(), 1e6);
        assert_eq!(joint(0.0, 100.0).move_to(1e-5), 20.0);
        assert_eq!(joint(0.001, 100.0).move_to(1e-5), 10.0);
    }
}
