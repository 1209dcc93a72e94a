//! The readings of one dwell at a target. In: a rig at rest behind the guard. Out: their means, the scatter of the forces and the
//! relaxation since the rig settled. It moves nothing.

use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use psd_physics::statistics::samples::{mean, scatter};
use psd_rig::Reading;

/// The readings of one dwell.
pub(crate) struct DwellReadings {
    /// Mean \[m\].
    pub displacement: f64,
    /// Mean \[N\].
    pub restoring_force: f64,
    /// Standard deviation of the forces \[N\].
    pub force_scatter: f64,
    /// Decrease of the force since the rig settled \[N\].
    pub relaxation: f64,
    /// Rig time of the last reading \[s\].
    pub wall_time: f64,
    /// Why the run ends with the last of them.
    pub broken: Option<Stop>,
}

impl DwellReadings {
    /// One reading at a rig time \[s\], before or during a motion: no scatter, no relaxation.
    pub(crate) const fn single(read: (f64, f64), wall_time: f64) -> Self {
        Self {
            displacement: read.0,
            restoring_force: read.1,
            force_scatter: 0.0,
            relaxation: 0.0,
            wall_time,
            broken: None,
        }
    }

    /// Waits for `pause` \[s\] and reads so many samples after the `settled` reading. If that is `broken`, it is the only one.
    pub(crate) fn take(
        settled: &Reading,
        mut broken: Option<Stop>,
        pause: f64,
        samples: u32,
        session: &mut Session<'_>,
    ) -> Result<Self, Stop> {
        let (_, settled_force) = first(settled);
        let mut readings = Vec::new();
        let mut waited = Ok(());
        if broken.is_some() {
            readings.push(first(settled));
        } else {
            waited = session.guard.pause(pause);
        }
        for _ in 0..samples.max(1) {
            if broken.is_none() {
                let (reading, stop) = session.read_after(std::mem::replace(&mut waited, Ok(())))?;
                if stop.is_some() {
                    // It ends the run where it was made: a mean with the readings before it would lie inside the limit.
                    readings.clear();
                }
                readings.push(first(&reading));
                broken = stop;
            }
        }
        let displacement = mean(readings.iter().map(|(x, _)| *x));
        let restoring_force = mean(readings.iter().map(|(_, r)| *r));
        Ok(Self {
            displacement,
            restoring_force,
            force_scatter: scatter(readings.iter().map(|(_, r)| *r), restoring_force),
            relaxation: settled_force - restoring_force,
            wall_time: session.guard.time(),
            broken,
        })
    }
}
