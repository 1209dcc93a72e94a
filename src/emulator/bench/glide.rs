//! Smooth moves of a bench's actuators. Each move ends with a position and a velocity, and the next one follows without a stop.
//! Without a next move, the actuators continue at their velocity. In: end points, one per actuator, and times. Out: the paths
//! to these end points. It checks no limit: the controller does that.

use crate::emulator::Bench;
use crate::emulator::SentMove;
use crate::physics::tracking::trajectory::Path;

/// The end of a smooth move: position \[m\] and velocity \[m/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WayEnd {
    pub place: f64,
    pub velocity: f64,
}

/// The commanded smooth moves of a bench.
#[derive(Debug, Default)]
pub(crate) struct Glides {
    /// End time of the last move that began \[s\]; none while the actuators go to targets.
    end: Option<f64>,
    ends: Vec<WayEnd>,
    /// The next move and its duration \[s\].
    next: Option<(Vec<WayEnd>, f64)>,
}

impl Glides {
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}

/// The reason why a move is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoWay {
    /// The actuators go to targets, or one move is already waiting.
    Busy,
    /// The move would have ended before now.
    Late,
}

impl Bench {
    /// Calculates the paths, one per actuator, of a move of `seconds` after the last one, or from now on.
    ///
    /// # Errors
    /// The move is refused.
    pub fn paths_to(&self, ends: &[WayEnd], seconds: f64) -> Result<Vec<Path>, NoWay> {
        let path = |from: WayEnd, to: &WayEnd, seconds| Path {
            from: from.place,
            to: to.place,
            start_velocity: from.velocity,
            end_velocity: to.velocity,
            seconds,
        };
        let here = self.rams.iter().map(|ram| WayEnd {
            place: ram.position,
            velocity: ram.velocity(),
        });
        match self.glides.end.filter(|_| self.glide_under_way()) {
            Some(end) if end > self.time => match self.glides.next {
                Some(_) => Err(NoWay::Busy),
                None => Ok(self
                    .glides
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
                _ => Err(NoWay::Late),
            },
            None if self.moving() => Err(NoWay::Busy),
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
        ends: &[WayEnd],
        seconds: f64,
    ) -> f64 {
        for (ram, path) in paths.iter().enumerate() {
            let (low, high) = path.reach();
            self.judge(ram, low);
            self.judge(ram, high);
            self.targets.push(path.to);
        }
        let speed = paths.iter().map(Path::fastest).fold(0.0, f64::max);
        self.moves.push(SentMove {
            time: self.time,
            id,
            targets: paths.iter().map(|path| path.to).collect(),
            speed,
        });
        let under_way = self.glides.end.filter(|_| self.glide_under_way());
        if let Some(end) = under_way.filter(|end| *end > self.time) {
            self.glides.next = Some((ends.to_vec(), seconds));
            return end + seconds - self.time;
        }
        let end = under_way.unwrap_or(self.time) + seconds;
        (self.glides.end, self.glides.ends) = (Some(end), ends.to_vec());
        for (ram, path) in self.rams.iter_mut().zip(paths) {
            ram.follow(*path);
        }
        end - self.time
    }

    /// Returns the time since the end of the last move \[s\]; none during a move or at rest.
    #[must_use]
    pub fn gone_on(&self) -> Option<f64> {
        let end = self.glides.end.filter(|_| self.glide_under_way())?;
        Some(self.time - end).filter(|gone_on| *gone_on > 0.0)
    }

    fn glide_under_way(&self) -> bool {
        self.rams.iter().any(super::ram::Ram::glides)
    }

    /// Returns the start time of the waiting move \[s\].
    pub(crate) fn next_glide(&self) -> Option<f64> {
        self.glides.end.filter(|_| self.glides.next.is_some())
    }

    pub(crate) fn begin_next_glide(&mut self) {
        let (Some((ends, seconds)), Some(end)) = (self.glides.next.take(), self.glides.end) else {
            return;
        };
        let from = self.rams.iter().map(|ram| (ram.position, ram.velocity()));
        let path = |((from, start_velocity), to): ((f64, f64), &WayEnd)| Path {
            from,
            to: to.place,
            start_velocity,
            end_velocity: to.velocity,
            seconds: end + seconds - self.time,
        };
        let paths: Vec<Path> = from.zip(&ends).map(path).collect();
        for (ram, path) in self.rams.iter_mut().zip(paths) {
            ram.follow(path);
        }
        (self.glides.end, self.glides.ends) = (Some(end + seconds), ends);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::testing::bench;

    fn told(bench: &mut Bench, place: f64, velocity: f64, seconds: f64) -> Result<f64, NoWay> {
        let ends = [WayEnd { place, velocity }];
        let paths = bench.paths_to(&ends, seconds)?;
        Ok(bench.follow(None, &paths, &ends, seconds))
    }

    #[test]
    fn ways_are_passed_in_place_and_time_also_where_the_next_comes_late() {
        let mut bench = bench();
        assert_eq!(told(&mut bench, 0.001, 0.002, 1.0), Ok(1.0));
        bench.advance(0.5);
        // x = 3·1 mm·s² − 2·1 mm·s³ + 2 mm/s·(s³ − s²)·1 s at s = 0.5.
        assert!((bench.commanded() - (0.75e-3 - 0.25e-3 + 2e-3 * (0.125 - 0.25))).abs() < 1e-15);
        assert_eq!(told(&mut bench, 0.002, -0.001, 0.5), Ok(1.0), "one waits");
        assert_eq!(told(&mut bench, 0.0, 0.0, 0.5), Err(NoWay::Busy));
        bench.advance(1.5);
        assert!((bench.commanded() - 0.002).abs() < 1e-15 && bench.moving());
        bench.advance(1.6);
        assert!(
            (bench.commanded() - 0.0019).abs() < 1e-15
                && bench
                    .gone_on()
                    .is_some_and(|gone_on| (gone_on - 0.1).abs() < 1e-12)
        );
        assert!(
            told(&mut bench, 0.001, 0.0, 0.5).is_ok_and(|left| (left - 0.4).abs() < 1e-12),
            "its time began at 1.5 s"
        );
        bench.advance(2.0);
        assert!(bench.commanded() == 0.001 && !bench.moving() && bench.gone_on().is_none());
    }

    #[test]
    fn a_way_that_would_have_ended_is_none_and_a_held_ram_goes_no_farther() {
        let mut bench = bench();
        told(&mut bench, 0.001, 0.002, 1.0).unwrap();
        bench.advance(1.3);
        assert_eq!(told(&mut bench, 0.002, 0.0, 0.2), Err(NoWay::Late));
        bench.hold();
        let held = bench.commanded();
        bench.advance(2.0);
        assert!(bench.commanded() == held && !bench.moving());
        assert!(
            told(&mut bench, 0.001, 0.0, 0.1).is_ok_and(|left| (left - 0.1).abs() < 1e-12),
            "from rest"
        );
    }

    /// A spring and a damper: the force depends on position and velocity only, and not on the time steps.
    #[test]
    fn the_force_is_that_of_place_and_velocity() {
        let mut bench = bench();
        told(&mut bench, 0.004, 0.01, 1.0).unwrap();
        bench.advance(0.777);
        let path = Path {
            from: 0.0,
            to: 0.004,
            start_velocity: 0.0,
            end_velocity: 0.01,
            seconds: 1.0,
        };
        assert!((bench.commanded() - path.place(0.777)).abs() < 1e-12);
        assert!(
            (bench.force() - 1e5 * path.place(0.777)).abs() < 1e-6,
            "{}",
            bench.force()
        );
    }
}
