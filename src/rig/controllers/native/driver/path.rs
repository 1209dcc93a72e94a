//! Continuous motion in psd's own protocol: smooth paths whose ends are passed. In: a path per axis, in the device's own
//! directions. Out: the frame of a `GLIDE`, and its decoded values. It sends nothing.

use super::{DeviceMove, NativeDevice, RequestedMove};
use crate::controllers::DeviceFault;
use crate::controllers::native;
use crate::controllers::native::codec::{End, Request};
use crate::controllers::{metres, number};
use psd_physics::tracking::trajectory::Path;

impl NativeDevice {
    pub(super) fn glide_move(&mut self, paths: &[Path]) -> Result<DeviceMove, DeviceFault> {
        let bounds = &self.hello()?.bounds;
        if self.out_of_step {
            return Err(DeviceFault::Unfit(
                "an answer is missing: the rig must be read before it moves again".to_owned(),
            ));
        }
        if paths.len() != bounds.axes.len() {
            return Err(DeviceFault::Unfit(format!(
                "it has {} axes, not {}",
                bounds.axes.len(),
                paths.len()
            )));
        }
        let read_back = |meant: f64| number::read_back(&native::codec::length(meant)?, 1e3, meant);
        let end = |path: &Path| {
            Some(End {
                position: read_back(path.to)?,
                velocity: read_back(path.end_velocity)?,
            })
        };
        let ends: Option<Vec<End>> = paths.iter().map(end).collect();
        let seconds = paths.first().map_or(0.0, |path| path.seconds);
        let encoded = native::codec::time(seconds)
            .and_then(|written| number::read_back(&written, 1e3, seconds));
        let unsaid = || {
            DeviceFault::Unfit(format!(
                "a path of {seconds} s to {} cannot be expressed in a frame",
                metres(&paths.iter().map(|path| path.to).collect::<Vec<_>>())
            ))
        };
        let (ends, seconds) = ends
            .zip(encoded.filter(|seconds| *seconds > 0.0))
            .ok_or_else(unsaid)?;
        let inside = |(axis, path): (&native::codec::AxisBounds, &Path)| {
            let (low, high) = path.reach();
            axis.displacement.contains(low) && axis.displacement.contains(high)
        };
        if !bounds.axes.iter().zip(paths).all(inside) {
            return Err(DeviceFault::Refused {
                reason: "a path leaves the limits that the rig reports".to_owned(),
            });
        }
        let speed = paths.iter().map(Path::fastest).fold(0.0, f64::max);
        if !(speed.is_finite() && speed <= bounds.top_speed) {
            return Err(DeviceFault::Refused {
                reason: format!("{} mm/s is not a valid speed of this rig", speed * 1e3),
            });
        }
        let id = match &self.proposed {
            Some(proposed) if !proposed.sent => proposed.id,
            Some(proposed) => proposed.id + 1,
            None => self.next_id,
        };
        let written = native::codec::lengths(&native::codec::in_turn(&ends)).ok_or_else(unsaid)?;
        let frames = self.frames_of(Request::Glide {
            id,
            ends: &ends,
            seconds,
        })?;
        self.proposed = Some(RequestedMove {
            id,
            targets: written,
            sent: false,
        });
        Ok(DeviceMove {
            frames,
            targets: ends.iter().map(|end| end.position).collect(),
            speed,
            id: Some(id),
        })
    }
}
