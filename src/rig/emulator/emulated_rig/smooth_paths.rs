//! Smooth moves of an emulated rig's actuators. Each move ends with a position and a velocity, and the next one follows without a stop.
//! Without a next move, the actuators continue at their velocity. In: end points, one per actuator, and times. Out: the paths
//! to these end points. It checks no limit: the controller does that.

use crate::emulator::EmulatedRig;
use crate::emulator::SentMove;
use psd_physics::tracking::trajectory::Path;

/// The end of a smooth move: position \[m\] and velocity \[m/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEnd {
    pub position: f64,
    pub velocity: f64,
}

/// The commanded smooth moves of an emulated rig.
#[derive(Debug, Default)]
pub struct PathQueue {
    /// End time of the last move that began \[s\]; none while the actuators go to targets.
    end: Option<f64>,
    ends: Vec<PathEnd>,
    /// The next move and its duration \[s\].
    next: Option<(Vec<PathEnd>, f64)>,
}

impl PathQueue {
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

/// The reason why a move is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathRefusal {
    /// The actuators go to targets, or one move is already waiting.
    Busy,
    /// The move would have ended before now.
    Late,
}

impl EmulatedRig {
    /// Calculates the paths, one per actuator, of a move of `seconds` after the last one, or from now on.
    ///
    /// # Errors
    /// The move is refused.
    pub fn paths_to(&self, ends: &[PathEnd], seconds: f64) -> Result<Vec<Path>, PathRefusal> {
        let path = |from: PathEnd, to: &PathEnd, seconds| Path {
            from: from.position,
            to: to.position,
            start_velocity: from.velocity,
            end_velocity: to.velocity,
            seconds,
        };
        let here = self.actuators.iter().map(|actuator| PathEnd {
            position: actuator.position,
            velocity: actuator.velocity(),
        });
        match self.paths.end.filter(|_| self.follows_path()) {
            Some(end) if end > self.time => match self.paths.next {
                Some(_) => Err(PathRefusal::Busy),
                None => Ok(self
                    .paths
                    .ends
                    .iter()
                    .zip(ends)
                    .map(|(from, to)| path(*from, to, seconds))
                    .collect()),
            },
            Some(end) => match end + seconds - self.time {
                left if left > 0.0 => Ok(here
                    .zip(ends)
                    .map(|(from, to)| path(from, to, left))
                    .collect()),
                _ => Err(PathRefusal::Late),
            },
            None if self.moving() => Err(PathRefusal::Busy),
            None => Ok(here
                .zip(ends)
                .map(|(from, to)| path(from, to, seconds))
                .collect()),
        }
    }

    /// Follows these paths, which `paths_to` returned for these end points. Returns the time to their end \[s\].
    pub fn follow(
        &mut self,
        id: Option<u64>,
        paths: &[Path],
        ends: &[PathEnd],
        seconds: f64,
    ) -> f64 {
        for (actuator, path) in paths.iter().enumerate() {
            let (low, high) = path.reach();
            self.check_limits(actuator, low);
            self.check_limits(actuator, high);
        }
        let speed = paths.iter().map(Path::fastest).fold(0.0, f64::max);
        self.moves.push(SentMove {
            time: self.time,
            id,
            actuators: (0..paths.len()).collect(),
            targets: paths.iter().map(|path| path.to).collect(),
            speed,
        });
        let paths_end = self.paths.end.filter(|_| self.follows_path());
        if let Some(end) = paths_end.filter(|end| *end > self.time) {
            self.paths.next = Some((ends.to_vec(), seconds));
            return end + seconds - self.time;
        }
        let end = paths_end.unwrap_or(self.time) + seconds;
        (self.paths.end, self.paths.ends) = (Some(end), ends.to_vec());
        for (actuator, path) in self.actuators.iter_mut().zip(paths) {
            actuator.follow(*path);
        }
        end - self.time
    }

    /// Returns the time since the end of the last move \[s\]; none during a move or at rest.
    #[must_use]
    pub fn overrun(&self) -> Option<f64> {
        let end = self.paths.end.filter(|_| self.follows_path())?;
        Some(self.time - end).filter(|overrun| *overrun > 0.0)
    }

    /// Returns the duration of the motion after a move without a successor \[s\], if a fault has changed it.
    #[must_use]
    pub fn coasts_for(&self) -> Option<f64> {
        let changed = self.actuators.iter().filter_map(|one| one.faults.coast);
        changed.reduce(f64::max)
    }

    fn follows_path(&self) -> bool {
        self.actuators
            .iter()
            .any(super::actuator::ActuatorModel::follows_path)
    }

    /// Returns the start time of the waiting move \[s\].
    pub fn next_path_start(&self) -> Option<f64> {
        self.paths.end.filter(|_| self.paths.next.is_some())
    }

    pub fn begin_next_path(&mut self) {
        let (Some((ends, seconds)), Some(end)) = (self.paths.next.take(), self.paths.end) else {
            return;
        };
        let from = self
            .actuators
            .iter()
            .map(|actuator| (actuator.position, actuator.velocity()));
        let path = |((from, start_velocity), to): ((f64, f64), &PathEnd)| Path {
            from,
            to: to.position,
            start_velocity,
            end_velocity: to.velocity,
            seconds: end + seconds - self.time,
        };
        let paths: Vec<Path> = from.zip(&ends).map(path).collect();
        for (actuator, path) in self.actuators.iter_mut().zip(paths) {
            actuator.follow(path);
        }
        (self.paths.end, self.paths.ends) = (Some(end + seconds), ends);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::emulator::elastic_rig;

    fn follow(
        rig: &mut EmulatedRig,
        position: f64,
        velocity: f64,
        seconds: f64,
    ) -> Result<f64, PathRefusal> {
        let ends = [PathEnd { position, velocity }];
        let paths = rig.paths_to(&ends, seconds)?;
        Ok(rig.follow(None, &paths, &ends, seconds))
    }

    #[test]
    fn paths_are_followed_in_position_and_time_also_if_the_next_comes_late() {
        let mut rig = elastic_rig();
        assert_eq!(follow(&mut rig, 0.001, 0.002, 1.0), Ok(1.0));
        rig.advance(0.5);
        // x = 3·1 mm·s² − 2·1 mm·s³ + 2 mm/s·(s³ − s²)·1 s at s = 0.5.
        assert!((rig.commanded() - (0.75e-3 - 0.25e-3 + 2e-3 * (0.125 - 0.25))).abs() < 1e-15);
        assert_eq!(follow(&mut rig, 0.002, -0.001, 0.5), Ok(1.0), "one waits");
        assert_eq!(follow(&mut rig, 0.0, 0.0, 0.5), Err(PathRefusal::Busy));
        rig.advance(1.5);
        assert!((rig.commanded() - 0.002).abs() < 1e-15 && rig.moving());
        rig.advance(1.6);
        assert!(
            (rig.commanded() - 0.0019).abs() < 1e-15
                && rig
                    .overrun()
                    .is_some_and(|overrun| (overrun - 0.1).abs() < 1e-12)
        );
        assert!(
            follow(&mut rig, 0.001, 0.0, 0.5).is_ok_and(|left| (left - 0.4).abs() < 1e-12),
            "its time began at 1.5 s"
        );
        rig.advance(2.0);
        assert!(rig.commanded() == 0.001 && !rig.moving() && rig.overrun().is_none());
    }

    #[test]
    fn an_expired_path_is_refused_and_a_held_actuator_goes_no_farther() {
        let mut rig = elastic_rig();
        follow(&mut rig, 0.001, 0.002, 1.0).unwrap();
        rig.advance(1.3);
        assert_eq!(follow(&mut rig, 0.002, 0.0, 0.2), Err(PathRefusal::Late));
        rig.hold();
        let held = rig.commanded();
        rig.advance(2.0);
        assert!(rig.commanded() == held && !rig.moving());
        assert!(
            follow(&mut rig, 0.001, 0.0, 0.1).is_ok_and(|left| (left - 0.1).abs() < 1e-12),
            "from rest"
        );
    }

    /// A spring and a damper: the force depends on position and velocity only, and not on the time steps.
    #[test]
    fn the_force_is_that_of_position_and_velocity() {
        let mut rig = elastic_rig();
        follow(&mut rig, 0.004, 0.01, 1.0).unwrap();
        rig.advance(0.777);
        let path = Path {
            from: 0.0,
            to: 0.004,
            start_velocity: 0.0,
            end_velocity: 0.01,
            seconds: 1.0,
        };
        assert!((rig.commanded() - path.position(0.777)).abs() < 1e-12);
        assert!(
            (rig.force() - 1e5 * path.position(0.777)).abs() < 1e-6,
            "{}",
            rig.force()
        );
    }
}
