//! The virtual rig of a frame along smooth paths: all floors together, read on the way, without a stop. In: a path a floor, in
//! the plan's directions. Out: readings. The pistons follow in closed form, so that the number of readings changes none of them.

use super::VirtualFrame;
use crate::mechanics::maxwell::Travel;
use crate::mechanics::path::Path;
use crate::rig::virtual_rig::glide::{Course, instants};
use crate::rig::{EachReading, Rig as _, RigFault};

impl VirtualFrame {
    /// Reads at `samples` equal times, of which the first may be done; the last at the end of the paths, where the references
    /// are still moving.
    ///
    /// # Errors
    /// The paths lead nowhere, or `each` refuses; the rig then holds.
    pub(super) fn glide_along(
        &mut self,
        paths: &[Path],
        (samples, done): (usize, usize),
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        if paths.len() != self.axes.len() {
            let reason = format!("this rig has {} degrees of freedom, not {}", self.axes.len(), paths.len());
            return Err(RigFault::Device(reason));
        }
        let instants = instants(paths, samples)?;
        let before = |axis: usize| self.under_way.get(axis).copied();
        let axes = paths.iter().zip(&self.axes).enumerate();
        let course = |(number, (path, axis)): (usize, (&Path, &super::Axis))| {
            Course::again(*path, self.sign, &axis.actuator, before(number))
        };
        let courses: Vec<Course> = axes.map(course).collect();
        self.under_way.clone_from(&courses);
        let began = self.time - instants.get(done).copied().unwrap_or(0.0);
        for pair in instants.windows(2).skip(done) {
            let axes = courses.iter().zip(&mut self.axes);
            let travels: Vec<Travel> = axes.map(|(course, axis)| course.advance(&mut axis.actuator, pair[0], pair[1])).collect();
            self.time = began + pair[1];
            self.follow(&travels);
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
    use super::*;
    use crate::plan::{Behaviour, Frame, Settle, Storey, VirtualLink};

    const AT_ONCE: Settle = Settle { band: 0.0, force_rate: 0.0, dwell: 0.0, timeout: 60.0 };

    /// 3 kN/m with 50 N·s/m and 0.25 N; 2 kN/m with 20 N·s/m.
    fn rig(link: VirtualLink) -> VirtualFrame {
        let storey = |stiffness, damping, coulomb| Storey {
            damping,
            coulomb,
            ..Storey::new(1.0, stiffness, Behaviour::Elastic { stiffness })
        };
        let frame = Frame::of_storeys(vec![storey(3000.0, 50.0, 0.25), storey(2000.0, 20.0, 0.0)]);
        VirtualFrame::new("frame", link, AT_ONCE, &frame, 1.0)
    }

    const LOWER: Path = Path { from: 0.0, to: 2e-3, start_velocity: 0.0, end_velocity: 0.03, seconds: 0.1 };
    const UPPER: Path = Path { from: 0.0, to: 1e-3, start_velocity: 0.0, end_velocity: -0.01, seconds: 0.1 };

    fn readings(link: VirtualLink, samples: usize) -> Vec<crate::rig::Reading> {
        let (mut rig, mut readings) = (rig(link), Vec::new());
        rig.glide_along(&[LOWER, UPPER], (samples, 0), &mut |reading| {
            readings.push(reading);
            Ok(())
        })
        .unwrap();
        readings
    }

    /// Each storey resists its own drift and the velocity of it: k d + c ḋ + F_c sign ḋ, and a floor feels its storey less the
    /// one above.
    #[test]
    fn storeys_are_damped_at_the_velocity_of_their_drifts() {
        for reading in readings(VirtualLink::default(), 4) {
            let time = reading.time;
            let (x, y) = (LOWER.place(time), UPPER.place(time));
            let (v, w) = (LOWER.rate(time).velocity, UPPER.rate(time).velocity);
            assert!((reading.displacement[0] - x).abs() < 1e-15 && (reading.displacement[1] - y).abs() < 1e-15);
            let (first, second) = (3000.0 * x + 50.0 * v + 0.25 * v.signum(), 2000.0 * (y - x) + 20.0 * (w - v));
            assert!((reading.force[0] - (first - second)).abs() < 1e-12, "{time} s: {reading:?}");
            assert!((reading.force[1] - second).abs() < 1e-12, "{time} s: {reading:?}");
        }
    }

    #[test]
    fn the_number_of_readings_is_of_no_account_to_a_lag() {
        let link = VirtualLink { lag: 0.02, tracking: 0.05, ..VirtualLink::default() };
        let (few, many) = (readings(link, 1), readings(link, 50));
        for axis in 0..2 {
            assert!((few[0].displacement[axis] - many[49].displacement[axis]).abs() < 1e-15);
            assert!((few[0].force[axis] - many[49].force[axis]).abs() < 1e-12);
        }
    }

    /// At rest a damper gives nothing, and friction keeps the direction of the last motion.
    #[test]
    fn friction_stays_through_a_pause() {
        let mut rig = rig(VirtualLink::default());
        rig.propose(&[1e-3, 1e-3], Some(0.01)).unwrap();
        rig.execute().unwrap();
        rig.pause(1.0).unwrap();
        assert!((rig.read().unwrap().force[0] - (3.0 + 0.25)).abs() < 1e-12);
        rig.propose(&[0.0, 0.0], Some(0.01)).unwrap();
        rig.execute().unwrap();
        assert!((rig.read().unwrap().force[0] + 0.25).abs() < 1e-12);
    }

    #[test]
    fn paths_that_are_not_of_one_length_lead_nowhere() {
        let short = Path { seconds: 0.05, ..UPPER };
        assert!(rig(VirtualLink::default()).glide_along(&[LOWER, short], (4, 0), &mut |_| Ok(())).is_err());
        assert!(rig(VirtualLink::default()).glide_along(&[LOWER], (4, 0), &mut |_| Ok(())).is_err());
    }
}
