//! The virtual rig along a smooth path: read on the way, without a stop. In: a path in the plan's directions. Out:
//! readings. The piston follows in closed form, so that the number of readings changes none of them.

use super::VirtualRig;
use crate::mechanics::path::{Path, Rate};
use crate::rig::{EachReading, Rig as _, RigFault};

impl VirtualRig {
    /// Reads at `samples` equal times, the last at the end of the path, where the reference is still moving.
    ///
    /// # Errors
    /// The path leads nowhere, or `each` refuses; the rig then holds.
    pub(super) fn glide_along(&mut self, path: &Path, samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        let numbers = [path.from, path.to, path.start_velocity, path.end_velocity, path.seconds];
        if samples == 0 || path.seconds <= 0.0 || !numbers.iter().all(|number| number.is_finite()) {
            return Err(RigFault::Device(format!("a path of {} s with {samples} readings leads nowhere", path.seconds)));
        }
        let began = self.time;
        // What the actuator misses of its increments goes over evenly from what it missed before to what it misses of
        // this one, so that its reference has no step.
        let missed = self.sign * path.from - self.actuator.reference();
        let misses = self.sign * path.to - self.actuator.aim(self.sign * path.to);
        let drifts = (misses - missed) / path.seconds;
        let reference = |time: f64| self.sign * path.place(time) - (missed + drifts * time);
        let rate = |time: f64| {
            let Rate { velocity, acceleration, jerk } = path.rate(time);
            Rate { velocity: self.sign * velocity - drifts, acceleration: self.sign * acceleration, jerk: self.sign * jerk }
        };
        #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
        let times: Vec<f64> = (0..=samples).map(|sample| path.seconds * sample as f64 / samples as f64).collect();
        let course: Vec<(f64, f64, Rate, Rate)> =
            times.windows(2).map(|pair| (pair[1] - pair[0], reference(pair[1]), rate(pair[0]), rate(pair[1]))).collect();
        for (part, (seconds, to, before, after)) in course.into_iter().enumerate() {
            let course = self.actuator.run(to, before, after, seconds);
            self.time = began + times[part + 1];
            self.follow(&course);
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
    use crate::plan::VirtualLink;

    fn readings(link: VirtualLink, path: &Path, samples: usize) -> Vec<(f64, f64, f64)> {
        let mut rig = VirtualRig::new(link, AT_ONCE, Some(&specimen(50.0, 0.25)), 1.0);
        let mut readings = Vec::new();
        rig.glide_along(path, samples, &mut |reading| {
            readings.push((reading.time, reading.displacement[0], reading.force[0]));
            Ok(())
        })
        .unwrap();
        readings
    }

    const PATH: Path = Path { from: 0.0, to: 2e-3, start_velocity: 0.0, end_velocity: 0.03, seconds: 0.1 };

    /// K X + c v + F_c on the way, at the path's own velocity.
    #[test]
    fn damping_is_felt_at_the_velocity_of_the_path() {
        for (time, place, force) in readings(VirtualLink::default(), &PATH, 4) {
            let velocity = PATH.rate(time).velocity;
            assert!((place - PATH.place(time)).abs() < 1e-15);
            let friction = 0.25 * velocity.signum();
            assert!((force - (1000.0 * place + 50.0 * velocity + friction)).abs() < 1e-12, "{time} s: {force} N");
        }
    }

    /// ẋ = (path − x)/lag by the midpoint rule, against the closed form; and the number of readings is of no account.
    #[test]
    fn a_lag_follows_the_path_exactly_whatever_the_number_of_readings() {
        let link = VirtualLink { lag: 0.02, ..VirtualLink::default() };
        let (few, many) = (readings(link, &PATH, 1), readings(link, &PATH, 50));
        assert!((few[0].1 - many[49].1).abs() < 1e-15);
        let (mut place, parts) = (0.0, 20_000);
        let step = PATH.seconds / f64::from(parts);
        for part in 0..parts {
            let half = 0.5 * step / 0.02;
            place = (place * (1.0 - half) + 2.0 * half * PATH.place(step * (f64::from(part) + 0.5))) / (1.0 + half);
        }
        assert!((few[0].1 - place).abs() < 1e-12, "{} m, by steps {place} m", few[0].1);
    }

    /// A tenth of the increment is missed at the end, and the way there has no step.
    #[test]
    fn what_is_missed_of_an_increment_comes_evenly() {
        let found = readings(VirtualLink { tracking: 0.1, ..VirtualLink::default() }, &PATH, 100);
        assert!((found[99].1 - 1.8e-3).abs() < 1e-15);
        assert!(found.windows(2).all(|pair| (pair[1].1 - pair[0].1).abs() < 4e-5));
    }
}
