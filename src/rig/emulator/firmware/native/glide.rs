//! `GLIDE` of the native firmware: consecutive smooth moves. In: the words of the request. Out: the time to the end of the
//! move, or the code of a refusal. The whole move is compared with the limits of the run before it begins.

use super::{AxisBounds, Native, decimal, of_axis};
use crate::emulator::{EmulatedRig, PathEnd, PathRefusal};
use psd_physics::tracking::trajectory::Path;

/// Duration of the motion after a move without a successor \[s\]; then it holds. A fault can change it.
const GOES_ON: f64 = 0.25;
/// Tolerance of a limit \[mm or mm/s\]: the rounding errors of a cubic.
const ROUNDING: f64 = 1e-6;

impl Native {
    /// Returns the time to the end of the move \[s\].
    pub(super) fn glide(
        &mut self,
        id: &str,
        ends: &[&str],
        time: &str,
        rig: &mut EmulatedRig,
    ) -> Result<f64, String> {
        let id: u64 = id.parse().ok().filter(|id| *id > 0).ok_or("ARG")?;
        let words: Option<Vec<f64>> = ends.iter().map(|word| decimal(word)).collect();
        let (words, time) = words.zip(decimal(time)).ok_or("ARG")?;
        if time <= 0.0 {
            return Err("ARG".to_owned());
        }
        if self.last_move.as_ref().is_some_and(|(last, _)| id <= *last) {
            return Err("ID".to_owned());
        }
        let end = |pair: &[f64]| PathEnd {
            position: pair[0] / 1e3,
            velocity: pair[1] / 1e3,
        };
        let ends: Vec<PathEnd> = words.chunks_exact(2).map(end).collect();
        for (refused, code) in [(!self.referenced, "REF"), (self.held, "HELD")] {
            if refused {
                return Err(code.to_owned());
            }
        }
        let seconds = time / 1e3;
        let paths = rig.paths_to(&ends, seconds).map_err(|why| match why {
            PathRefusal::Busy => "BUSY".to_owned(),
            PathRefusal::Late => "LATE".to_owned(),
        })?;
        let outside = |(axis, path): (&AxisBounds, &Path)| {
            let ((low, high), (least, most)) = (path.reach(), axis.displacement);
            !(least - ROUNDING <= low * 1e3 && high * 1e3 <= most + ROUNDING)
        };
        if let Some(axis) = self.run.axes.iter().zip(&paths).position(outside) {
            let farthest = |path: &Path| {
                if path.reach().1.abs() > path.reach().0.abs() {
                    path.reach().1
                } else {
                    path.reach().0
                }
            };
            rig.refuse_all(&paths.iter().map(farthest).collect::<Vec<f64>>());
            return Err(of_axis("LIMIT", axis, paths.len()));
        }
        if !paths
            .iter()
            .all(|path| path.fastest() * 1e3 <= self.run.top_speed + ROUNDING)
        {
            return Err("RATE".to_owned());
        }
        self.last_move = Some((id, words.chunks_exact(2).map(|pair| pair[0]).collect()));
        Ok(rig.follow(Some(id), &paths, &ends, seconds))
    }

    /// After a move without a successor the motion continues for a short time, within its limits. Then it holds.
    pub(super) fn coast(&mut self, rig: &mut EmulatedRig) {
        let Some(overrun) = rig.overrun().filter(|_| self.has_all_of(rig)) else {
            return;
        };
        let inside = |(actuator, axis): (usize, &AxisBounds)| {
            let (position, (low, high)) = (rig.commanded_of(actuator) * 1e3, axis.displacement);
            low - ROUNDING <= position && position <= high + ROUNDING
        };
        if overrun > rig.coasts_for().unwrap_or(GOES_ON)
            || !self.run.axes.iter().enumerate().all(inside)
        {
            self.hold(rig);
        }
    }
}
