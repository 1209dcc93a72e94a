//! The speed of a motion: its limit before it begins, and the speed of the last motion for display. In: the requested speed, the speed
//! decoded from a move, and the observed speed.

use crate::{Guard, LimitedQuantity, RigFault};
use psd_plan::Interval;

/// Fraction of the commanded speed by which the observed speed must exceed it. The rounding of clocks and positions is smaller.
const BEYOND: f64 = 1e-3;

impl Guard<'_> {
    /// The limit of speed \[m/s\]: that of the plan. The motion of a run log had the limit of its own time.
    fn speed_limit(&self) -> Interval {
        self.rig.logged_speed_limit().unwrap_or(self.limits.speed)
    }

    /// The speed of a move \[m/s\]: as requested, otherwise the rig's own, otherwise the highest that the plan allows.
    pub(super) fn speed_of(&self, requested: Option<f64>) -> Option<f64> {
        let high = self.speed_limit().high;
        let own = || self.rig.own_speed().map(|own| own.min(high));
        requested
            .or_else(own)
            .or_else(|| Some(high).filter(|high| high.is_finite()))
    }

    pub(super) fn check_speed(&mut self, speed: f64) -> Result<(), RigFault> {
        self.check(LimitedQuantity::Speed, self.speed_limit(), speed)
    }

    /// Speed of the last motion \[m/s\]. For a move: the commanded speed, or the observed speed if that was higher. For a stroke: the
    /// commanded speed. For smooth paths: the highest speed of the fastest axis. None before the first motion.
    #[must_use]
    pub const fn speed(&self) -> Option<f64> {
        self.speed
    }

    /// Notes that a move with this commanded speed \[m/s\] is done.
    pub fn note_speed(&mut self, commanded_speed: f64) {
        let seen = self
            .rig
            .seen_speed()
            .filter(|seen| *seen > commanded_speed * (1.0 + BEYOND));
        self.speed = Some(seen.unwrap_or(commanded_speed));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VirtualRig;
    use psd_physics::tracking::trajectory::{ActuatorMotion, Path};
    use psd_plan::{Interval, Limits, Settle, VirtualLink};

    const AT_ONCE: Settle = Settle {
        band: 0.0,
        force_rate: 0.0,
        dwell: 0.0,
        timeout: 60.0,
    };

    #[test]
    fn the_speed_is_that_of_the_last_motion() {
        let limits = Limits {
            speed: Interval {
                low: 0.0,
                high: 0.02,
            },
            ..Limits::NONE
        };
        let mut rig = VirtualRig::new(VirtualLink::default(), AT_ONCE, None, 1.0);
        let mut guard = Guard::new(&mut rig, limits, Vec::new()).unwrap();
        assert_eq!(guard.speed(), None, "nothing has moved");
        guard.move_to(&[0.001], None).unwrap();
        assert_eq!(
            guard.speed(),
            Some(0.02),
            "none was asked for: at the limit"
        );
        guard.move_to(&[0.002], Some(0.005)).unwrap();
        assert_eq!(guard.speed(), Some(0.005));
        assert!(guard.move_to(&[0.003], Some(0.03)).is_err());
        assert_eq!(guard.speed(), Some(0.005), "what was refused is no way");
        assert!(guard.traverse(&[0.001], -0.004, 4).fault.is_none());
        assert_eq!(guard.speed(), Some(0.004));
        assert!(
            guard
                .follow_paths(
                    &[Path::accelerated(
                        ActuatorMotion {
                            position: 0.001,
                            velocity: 0.0,
                            acceleration: 0.1
                        },
                        0.1
                    )],
                    2
                )
                .fault
                .is_none()
        );
        assert!(
            (guard.speed().unwrap() - 0.01).abs() < 1e-12,
            "0.1 m/s² for 0.1 s, fastest at its end"
        );
    }
}
