//! The virtual actuator. In: reference motion, rig time \[s\]. Out: position and velocity of the piston. In closed form, so that a long
//! settling time costs no more than a short one. It knows no specimen and no load cell.

use psd_physics::relaxation::maxwell::Motion;
use psd_physics::tracking::trajectory::Rate;

/// A servo whose piston follows its reference with a first-order lag: ẋ = (reference − x) / lag.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// Time constant \[s\]; 0: the piston is at the reference.
    lag: f64,
    /// Fraction of each increment not reached.
    tracking: f64,
    /// \[m\]
    reference: f64,
    /// reference − position \[m\].
    lagging: f64,
    /// Velocity of the reference \[m/s\]; 0 at rest.
    reference_velocity: f64,
}

impl Actuator {
    pub const fn new(lag: f64, tracking: f64) -> Self {
        Self {
            lag,
            tracking,
            reference: 0.0,
            lagging: 0.0,
            reference_velocity: 0.0,
        }
    }

    /// Position of the piston \[m\].
    pub fn position(&self) -> f64 {
        self.reference - self.lagging
    }

    /// Velocity of the piston \[m/s\].
    pub fn velocity(&self) -> f64 {
        if self.lag > 0.0 {
            self.lagging / self.lag
        } else {
            self.reference_velocity
        }
    }

    /// End of the reference for a `target`: short by the tracking fraction of the increment. An actuator takes the
    /// increment from its present position, so the error does not add up over steps in one direction.
    pub fn aim(&self, target: f64) -> f64 {
        target - self.tracking * (target - self.position())
    }

    /// Present position of the reference \[m\].
    pub const fn reference(&self) -> f64 {
        self.reference
    }

    /// Distance of the piston behind its reference \[m\], absolute value.
    pub const fn lagging(&self) -> f64 {
        self.lagging.abs()
    }

    pub const fn lag(&self) -> f64 {
        self.lag
    }

    /// The reference moves uniformly to `to` in `seconds`. With e = reference − x: ė = v − e/lag, so e(t) = v·lag + (e₀ −
    /// v·lag)·exp(−t/lag). The reference continues at this velocity until `stop`. Gives the motion of the piston.
    pub fn advance(&mut self, to: f64, seconds: f64) -> Motion {
        if seconds <= 0.0 {
            return Motion::rest(0.0);
        }
        let velocity = (to - self.reference) / seconds;
        let mut travel = Motion::even(velocity, seconds);
        if self.lag > 0.0 {
            (travel.fading, travel.lag) = (self.lagging / self.lag - velocity, self.lag);
            let steady = velocity * self.lag;
            self.lagging = steady + (self.lagging - steady) * (-seconds / self.lag).exp();
        }
        self.reference = to;
        self.reference_velocity = velocity;
        travel
    }

    /// The piston, which does not lag, goes to a target \[m\] and stops there; the distance to it \[m\].
    #[inline]
    pub const fn jump(&mut self, target: f64) -> f64 {
        let distance = (target - self.reference).abs();
        (self.reference, self.reference_velocity) = (target, 0.0);
        distance
    }

    /// The reference is at its position and passes it at `velocity` \[m/s\]: an interrupted motion is continued.
    pub const fn pass(&mut self, velocity: f64) -> Motion {
        self.reference_velocity = velocity;
        Motion::rest(0.0)
    }

    /// The reference moves to `to` in `seconds`; its velocity is a parabola in time with these end values. With e = reference − x: ė = q
    /// − e/lag, so e = `e_p` + (e₀ − `e_p0`)·exp(−t/lag) with `e_p` = lag·q − lag²·q' + lag³·q''.
    pub fn run(&mut self, to: f64, before: Rate, after: Rate, seconds: f64) -> Motion {
        let mut travel = Motion {
            start: before,
            fading: 0.0,
            lag: 0.0,
            seconds,
        };
        if self.lag > 0.0 {
            let lag = self.lag;
            // ẋ = e/lag; its first part is also a parabola.
            let Rate {
                velocity,
                acceleration,
                jerk,
            } = before;
            let velocity = velocity - lag * (acceleration - lag * jerk);
            travel.start = Rate {
                velocity,
                acceleration: acceleration - lag * jerk,
                jerk,
            };
            (travel.fading, travel.lag) = (self.lagging / lag - velocity, lag);
            let steady =
                |rate: Rate| lag * (rate.velocity - lag * (rate.acceleration - lag * rate.jerk));
            self.lagging = steady(after) + (self.lagging - steady(before)) * (-seconds / lag).exp();
        }
        self.reference = to;
        self.reference_velocity = after.velocity;
        travel
    }

    /// The reference stops; the piston continues towards it.
    pub const fn stop(&mut self) {
        self.reference_velocity = 0.0;
    }

    /// `seconds` pass with the reference at rest.
    pub fn rest(&mut self, seconds: f64) -> Motion {
        self.stop();
        let mut travel = Motion::rest(seconds);
        if self.lag > 0.0 && self.lagging != 0.0 {
            (travel.fading, travel.lag) = (self.lagging / self.lag, self.lag);
            self.lagging *= (-seconds / self.lag).exp();
        }
        travel
    }

    /// Stays at its position.
    pub fn hold(&mut self) {
        self.reference = self.position();
        self.lagging = 0.0;
        self.stop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lag_follows_a_ramp_by_v_tau_and_closes_exponentially() {
        let mut actuator = Actuator::new(0.1, 0.0);
        actuator.advance(2.0, 2.0);
        let behind = 0.1 * (1.0 - (-20.0_f64).exp());
        assert!((actuator.position() - (2.0 - behind)).abs() < 1e-15);
        assert!((actuator.velocity() - 1.0).abs() < 1e-8);
        actuator.rest(0.1);
        assert!((actuator.lagging() - behind * (-1.0_f64).exp()).abs() < 1e-15);
    }

    #[test]
    fn tracking_leaves_its_fraction_of_the_increment() {
        let mut actuator = Actuator::new(0.0, 0.1);
        actuator.advance(actuator.aim(1.0), 1.0);
        assert!((actuator.position() - 0.9).abs() < 1e-15);
        actuator.advance(actuator.aim(2.0), 1.0);
        assert!((actuator.position() - (2.0 - 0.1 * 1.1)).abs() < 1e-15);
    }

    #[test]
    fn hold_stops_the_piston_where_it_is() {
        let mut actuator = Actuator::new(0.5, 0.0);
        actuator.advance(1.0, 0.5);
        let there = actuator.position();
        actuator.hold();
        actuator.rest(10.0);
        assert_eq!(actuator.position(), there);
        assert_eq!(actuator.velocity(), 0.0);
    }
}
