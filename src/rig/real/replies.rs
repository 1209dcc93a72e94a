//! The replies in a run log beside a reading. In: the rig of the plan, its datum, replies and reading of an entry. Out: whether these
//! replies give this reading. It asks nothing.

use super::coordinate::Coordinate;
use super::median::representative;
use super::poll::newtons;
use crate::controllers::{Channel, decoded, replies_to_reading};
use psd_plan::{Behind, RealLink, RigPlan};

/// A reading as it is logged, with the replies beside it.
pub struct LoggedReading<'a> {
    /// One an axis \[m\].
    pub displacement: &'a [f64],
    /// One an axis \[N\].
    pub force: &'a [f64],
    /// Of its devices in order, with those that were no reading.
    pub replies: &'a [Vec<u8>],
    /// Number of readings whose median it is.
    pub median_of: usize,
}

/// Checks that the replies give the reading. `datum`: position of the plan's zero in the coordinate of the rig \[m\], one per axis. The
/// rig reads again after an invalid reading. If there are more readings than the median has, it is one of them.
///
/// # Errors
/// A number of the reading that differs in any bit.
pub fn check_replies(
    plan: &RigPlan,
    datum: &[f64],
    logged: &LoggedReading<'_>,
) -> Result<(), String> {
    let Some(link) = plan.link.as_real() else {
        return Ok(());
    };
    let devices = link.devices().into_iter();
    let Some(length) = devices
        .map(|(_, device)| replies_to_reading(&device.dialect))
        .sum::<Option<usize>>()
    else {
        return Ok(());
    };
    let (mut points, mut rest) = (Vec::new(), logged.replies);
    while let Some(replies) = rest.get(..length).filter(|replies| !replies.is_empty()) {
        let point = point_of(plan, link, datum, replies);
        rest = &rest[if point.is_some() { length } else { 1 }..];
        points.extend(point);
    }
    let quantities = [("x", "m", logged.displacement), ("r", "N", logged.force)];
    for (index, (field, unit, numbers)) in quantities.into_iter().enumerate() {
        for (axis, number) in numbers.iter().enumerate() {
            let found = points.iter().filter_map(|point| point[index].get(axis));
            let found: Vec<f64> = found.copied().collect();
            let same = |value: f64| value.to_bits() == number.to_bits();
            let agrees = if found.len() == logged.median_of {
                same(representative(found))
            } else {
                found.into_iter().any(same)
            };
            if !agrees {
                return Err(format!(
                    "its `{field}` is {number} {unit}, but the replies in its `raw` give another number"
                ));
            }
        }
    }
    Ok(())
}

/// Displacements \[m\] and forces \[N\] of all axes from the replies to one reading.
fn point_of(
    plan: &RigPlan,
    link: &RealLink,
    datum: &[f64],
    replies: &[Vec<u8>],
) -> Option<[Vec<f64>; 2]> {
    let count = plan.axes()?;
    let (actuators, cells) = (link.actuators(), link.load_cells());
    let mut rest = replies;
    let moved = channels_of(&actuators, count, &mut rest)?;
    let weighed = channels_of(&cells, count, &mut rest)?;
    let mut point = [Vec::with_capacity(count), Vec::with_capacity(count)];
    for axis in 0..count {
        let has_own_load_cell = cells.iter().any(|cell| cell.axes.contains(&axis));
        let force = if has_own_load_cell {
            weighed[axis].force?
        } else {
            moved[axis].force?
        };
        let coordinate = Coordinate {
            datum: *datum.get(axis)?,
            ..Coordinate::of_sign(plan.polarity_of(axis))
        };
        point[0].push(coordinate.in_plan(moved[axis].displacement?));
        point[1].push(coordinate.turned(newtons(&plan.calibration_of(axis), force)?));
    }
    Some(point)
}

/// The channels of every axis from the devices of one role, whose replies are taken from `rest`.
fn channels_of(
    devices: &[Behind<'_>],
    count: usize,
    rest: &mut &[Vec<u8>],
) -> Option<Vec<Channel>> {
    let mut channels = vec![Channel::default(); count];
    for Behind { link, axes, .. } in devices {
        let (own, after) = rest.split_at_checked(replies_to_reading(&link.dialect)?)?;
        *rest = after;
        let read = decoded(&link.dialect, axes.len(), own)?;
        for (axis, channel) in axes.iter().zip(read) {
            *channels.get_mut(*axis)? = channel;
        }
    }
    Some(channels)
}
