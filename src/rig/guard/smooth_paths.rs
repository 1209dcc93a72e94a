//! The guard of continuous motion. In: smooth paths, one after the other. Out: readings during the motion, each inside
//! every limit. A path is checked completely before it begins, at its reversal points too, and must continue the last one
//! in position and velocity.

use crate::safety::failpoint::{Guarding, on};
use crate::{Guard, RigFault, Traversed};
use psd_physics::tracking::trajectory::Path;

impl Guard<'_> {
    /// Follows `paths`, one per degree of freedom, and reads at up to `samples` times. The last reading is at the end or at the point
    /// where a limit was exceeded.
    pub fn follow_paths(&mut self, paths: &[Path], samples: usize) -> Traversed {
        let refused = |fault| Traversed {
            readings: Vec::new(),
            fault: Some(fault),
        };
        if let Err(fault) = self.check_paths(paths) {
            return refused(fault);
        }
        self.leave();
        self.speed = paths.iter().map(Path::fastest).reduce(f64::max);
        let traversed =
            self.read_during(samples, |rig, each| rig.follow_paths(paths, samples, each));
        if traversed.fault.is_none() {
            self.commanded = paths.iter().map(|path| path.to).collect();
            self.going = paths.iter().map(|path| path.end_velocity).collect();
        }
        traversed
    }

    fn check_paths(&mut self, paths: &[Path]) -> Result<(), RigFault> {
        let ends: Vec<f64> = paths.iter().map(|path| path.to).collect();
        self.check_targets(&ends)?;
        let before = self.rig.before_motion(&ends, None);
        self.or_hold(before)?;
        for (axis, path) in paths.iter().enumerate() {
            let going = self.going.get(axis).copied().unwrap_or(0.0);
            let smooth = path.from.to_bits() == self.commanded[axis].to_bits()
                && (path.start_velocity - going).abs() <= 1e-12 * going.abs().max(path.fastest());
            if !smooth {
                self.hold();
                let reason =
                    "a path must begin where, and as fast as, the last one ended".to_owned();
                return Err(RigFault::Device(reason));
            }
            let (low, high) = path.reach();
            for position in [low, high]
                .into_iter()
                .filter(|_| on(Guarding::TargetLimits))
            {
                self.check_target(axis, position)?;
            }
            self.check_speed(path.fastest())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LimitedQuantity;
    use crate::VirtualRig;
    use psd_physics::tracking::trajectory::ActuatorMotion;
    use psd_plan::{Interval, Limits, Settle, VirtualLink};

    const AT_ONCE: Settle = Settle {
        band: 0.0,
        force_rate: 0.0,
        dwell: 0.0,
        timeout: 60.0,
    };

    fn fault_of(limits: Limits, paths: &[Path]) -> Option<RigFault> {
        let mut rig = VirtualRig::new(VirtualLink::default(), AT_ONCE, None, 1.0);
        let mut guard = Guard::new(&mut rig, limits, Vec::new()).unwrap();
        paths
            .iter()
            .find_map(|path| guard.follow_paths(&[*path], 5).fault)
    }

    fn quantity(fault: Option<&RigFault>) -> Option<LimitedQuantity> {
        match fault {
            Some(RigFault::LimitBreached { quantity, .. }) => Some(*quantity),
            _ => None,
        }
    }

    #[test]
    fn paths_join_in_position_and_velocity() {
        let first = Path::accelerated(
            ActuatorMotion {
                position: 0.0,
                velocity: 0.0,
                acceleration: 1.0,
            },
            0.1,
        );
        let on = Path::accelerated(
            ActuatorMotion {
                position: first.to,
                velocity: first.end_velocity,
                acceleration: -1.0,
            },
            0.1,
        );
        assert_eq!(fault_of(Limits::NONE, &[first, on]), None);
        let jumps = Path {
            from: first.to + 1e-9,
            ..on
        };
        let kinks = Path {
            start_velocity: 0.0,
            ..on
        };
        for broken in [jumps, kinks] {
            assert!(
                matches!(fault_of(Limits::NONE, &[first, broken]), Some(RigFault::Device(reason)) if reason.contains("begin"))
            );
        }
    }

    /// Loading and unloading: both ends are at 0, the reversal point is at 2.5 mm. The speed is 0.1 m/s at the ends and nowhere higher.
    #[test]
    fn the_whole_path_is_held_against_the_limits_before_it_begins() {
        let first = Path::accelerated(
            ActuatorMotion {
                position: 0.0,
                velocity: 0.0,
                acceleration: 1.0,
            },
            0.1,
        );
        let turn = Path::accelerated(
            ActuatorMotion {
                position: first.to,
                velocity: 0.1,
                acceleration: -2.0,
            },
            0.1,
        );
        let within = |high| Limits {
            displacement: Interval { low: -0.01, high },
            ..Limits::NONE
        };
        assert_eq!(fault_of(within(0.008), &[first, turn]), None);
        assert_eq!(
            quantity(fault_of(within(0.007), &[first, turn]).as_ref()),
            Some(LimitedQuantity::TargetDisplacement)
        );
        let slow = |high| Limits {
            speed: Interval { low: 0.0, high },
            ..Limits::NONE
        };
        assert_eq!(fault_of(slow(0.101), &[first, turn]), None);
        assert_eq!(
            quantity(fault_of(slow(0.099), &[first]).as_ref()),
            Some(LimitedQuantity::Speed)
        );
    }
}
