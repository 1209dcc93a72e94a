//! The virtual rig along smooth paths: all axes together, read during the motion, without a stop. In: a path per axis, in
//! the plan's directions. Out: readings. The pistons follow in closed form, so the number of readings does not change them.

use super::{Axis, VirtualRig};
use crate::virtual_rig::actuator::Actuator;
use crate::{EachReading, Rig as _, RigFault};
use psd_physics::relaxation::maxwell::Motion;
use psd_physics::tracking::trajectory::{Path, Rate};

/// The reference of one actuator along a path. The undershoot of the actuator changes uniformly from that of the last
/// increment to that of this one, so its reference has no step.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    path: Path,
    sign: f64,
    /// The undershoot at the beginning \[m\].
    missed: f64,
    /// The change of the undershoot \[m/s\].
    drifts: f64,
}

impl Course {
    pub fn along(path: Path, sign: f64, actuator: &Actuator) -> Self {
        let missed = sign * path.from - actuator.reference();
        let misses = sign * path.to - actuator.aim(sign * path.to);
        Self {
            path,
            sign,
            missed,
            drifts: (misses - missed) / path.seconds,
        }
    }

    /// For the path on which the actuator was stopped before, otherwise for a new path.
    pub fn resumed(path: Path, sign: f64, actuator: &Actuator, interrupted: Option<Self>) -> Self {
        interrupted
            .filter(|course| course.path == path)
            .unwrap_or_else(|| Self::along(path, sign, actuator))
    }

    /// The actuator moves from one time on the path to another \[s\]. Gives the motion of the piston.
    pub fn advance(&self, actuator: &mut Actuator, from: f64, to: f64) -> Motion {
        let position = self.sign * self.path.position(to) - (self.missed + self.drifts * to);
        actuator.run(position, self.rate(from), self.rate(to), to - from)
    }

    fn rate(&self, time: f64) -> Rate {
        let Rate {
            velocity,
            acceleration,
            jerk,
        } = self.path.rate(time);
        let sign = self.sign;
        Rate {
            velocity: sign * velocity - self.drifts,
            acceleration: sign * acceleration,
            jerk: sign * jerk,
        }
    }
}

/// The times at which paths are read, from their beginning \[s\]: 0 and the ends of `samples` equal parts.
///
/// # Errors
/// The paths differ in duration, or contain no motion.
pub fn instants(paths: &[Path], samples: usize) -> Result<Vec<f64>, RigFault> {
    let seconds = paths.first().map_or(0.0, |path| path.seconds);
    let numbers = |path: &Path| {
        [
            path.from,
            path.to,
            path.start_velocity,
            path.end_velocity,
            path.seconds,
        ]
    };
    let finite = paths.iter().flat_map(numbers).all(f64::is_finite);
    let together = paths
        .iter()
        .all(|path| path.seconds.to_bits() == seconds.to_bits());
    if samples == 0 || seconds <= 0.0 || !finite || !together {
        return Err(RigFault::Device(format!(
            "invalid path of {seconds} s with {samples} readings"
        )));
    }
    #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
    let instants = (0..=samples).map(|sample| seconds * sample as f64 / samples as f64);
    Ok(instants.collect())
}

impl VirtualRig {
    /// Reads at `samples` equally spaced times, of which the first may be done. The last is at the end of the paths, where the references
    /// still move.
    ///
    /// # Errors
    /// The paths contain no motion, or `each` refuses; the rig then holds.
    pub(super) fn follow_paths_after(
        &mut self,
        paths: &[Path],
        samples: usize,
        done: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        if paths.len() != self.axes.len() {
            return Err(self.other_order(paths.len()));
        }
        let instants = instants(paths, samples)?;
        let before = |axis: usize| self.interrupted.get(axis).copied();
        let axes = paths.iter().zip(&self.axes).enumerate();
        let course = |(number, (path, axis)): (usize, (&Path, &Axis))| {
            Course::resumed(*path, self.sign, &axis.actuator, before(number))
        };
        let courses: Vec<Course> = axes.map(course).collect();
        self.interrupted.clone_from(&courses);
        let began = self.time - instants.get(done).copied().unwrap_or(0.0);
        for pair in instants.windows(2).skip(done) {
            let axes = courses.iter().zip(&mut self.axes);
            self.travels.clear();
            self.travels.extend(
                axes.map(|(course, axis)| course.advance(&mut axis.actuator, pair[0], pair[1])),
            );
            self.time = began + pair[1];
            self.follow();
            let reading = self.reading();
            if let Err(refused) = each(reading) {
                self.hold();
                return Err(refused);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{AT_ONCE, specimen};
    use super::*;
    use psd_plan::VirtualLink;

    fn readings(link: VirtualLink, path: &Path, samples: usize) -> Vec<(f64, f64, f64)> {
        let mut rig = VirtualRig::new(link, AT_ONCE, Some(&specimen(50.0, 0.25)), 1.0);
        let mut readings = Vec::new();
        rig.follow_paths_after(&[*path], samples, 0, &mut |reading| {
            readings.push((reading.time, reading.displacement[0], reading.force[0]));
            Ok(())
        })
        .unwrap();
        readings
    }

    const PATH: Path = Path {
        from: 0.0,
        to: 2e-3,
        start_velocity: 0.0,
        end_velocity: 0.03,
        seconds: 0.1,
    };

    /// K X + c v + F_c during the motion, at the velocity of the path.
    #[test]
    fn damping_is_measured_at_the_velocity_of_the_path() {
        for (time, position, force) in readings(VirtualLink::default(), &PATH, 4) {
            let velocity = PATH.rate(time).velocity;
            assert!((position - PATH.position(time)).abs() < 1e-15);
            let friction = 0.25 * velocity.signum();
            assert!(
                (force - (1000.0 * position + 50.0 * velocity + friction)).abs() < 1e-12,
                "{time} s: {force} N"
            );
        }
    }

    /// ẋ = (path − x)/lag by the midpoint rule, compared with the closed form; the number of readings has no effect.
    #[test]
    fn a_lag_follows_the_path_exactly_whatever_the_number_of_readings() {
        let link = VirtualLink {
            lag: 0.02,
            ..VirtualLink::default()
        };
        let (few, many) = (readings(link, &PATH, 1), readings(link, &PATH, 50));
        assert!((few[0].1 - many[49].1).abs() < 1e-15);
        let (mut position, parts) = (0.0, 20_000);
        let step = PATH.seconds / f64::from(parts);
        for part in 0..parts {
            let half = 0.5 * step / 0.02;
            position = (position * (1.0 - half)
                + 2.0 * half * PATH.position(step * (f64::from(part) + 0.5)))
                / (1.0 + half);
        }
        assert!(
            (few[0].1 - position).abs() < 1e-12,
            "{} m, by steps {position} m",
            few[0].1
        );
    }

    /// The undershoot at the end is a tenth of the increment, and the path has no step.
    #[test]
    fn what_is_missed_of_an_increment_comes_evenly() {
        let found = readings(
            VirtualLink {
                tracking: 0.1,
                ..VirtualLink::default()
            },
            &PATH,
            100,
        );
        assert!((found[99].1 - 1.8e-3).abs() < 1e-15);
        assert!(
            found
                .windows(2)
                .all(|pair| (pair[1].1 - pair[0].1).abs() < 4e-5)
        );
    }
}
