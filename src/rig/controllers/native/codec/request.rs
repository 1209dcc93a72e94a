//! Requests of the native protocol. In: a request and its sequence number. Out: its frame, and lengths as text.

use std::fmt::Write as _;

use super::checksum::checksum;
use super::{AxisBounds, Bounds};
use crate::controllers::number;
use psd_plan::AxialAxis;

/// Longest request with its ending \[bytes\]: for one axis, for several axes.
pub const LONGEST_FRAME: usize = 96;

pub const LONGEST_FRAME_OF_SEVERAL: usize = 512;

/// A request. Lengths \[m\], speeds \[m/s\], forces \[N\].
#[derive(Clone, Debug, PartialEq)]
pub enum Request<'a> {
    Hello,
    Limits(&'a Bounds),
    /// Rate \[N/s\] and tolerance \[N\] of each axis in force control.
    Force(&'a [Option<AxialAxis>]),
    /// Targets of every axis and the speed, formatted by [`length`] and [`force`], so that each is formatted only once.
    Move {
        id: u64,
        targets: &'a str,
        speed: &'a str,
    },
    /// Position and velocity of each axis at the end of the path, and its duration.
    Glide {
        id: u64,
        ends: &'a [End],
        seconds: f64,
    },
    Measure {
        readings: u32,
    },
    Status,
    Stop,
    Clear,
    Reference {
        token: &'a str,
    },
}

/// The end of a smooth path: \[m\], \[m/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    pub position: f64,
    pub velocity: f64,
}

/// The frame of a request. None if one of its numbers cannot be written or the frame would be too long.
#[must_use]
pub fn frame(sequence: u32, request: &Request<'_>) -> Option<Vec<u8>> {
    let mut longest = LONGEST_FRAME;
    let mut several = |axes: usize| {
        if axes > 1 {
            longest = LONGEST_FRAME_OF_SEVERAL;
        }
    };
    let mut out = String::with_capacity(LONGEST_FRAME);
    match request {
        Request::Hello => write!(out, ">HELLO {sequence}"),
        Request::Limits(bounds) => {
            several(bounds.axes.len());
            let axes: Vec<String> = bounds.axes.iter().map(bounds_of).collect::<Option<_>>()?;
            write!(
                out,
                ">LIM {sequence} {} {}",
                axes.join(" "),
                length(bounds.top_speed)?
            )
        }
        Request::Force(axes) => {
            several(axes.len());
            let axes: Vec<String> = axes
                .iter()
                .map(|axis| control_of(*axis))
                .collect::<Option<_>>()?;
            write!(out, ">FORCE {sequence} {}", axes.join(" "))
        }
        Request::Move { id, targets, speed } => {
            several(targets.split(' ').count());
            write!(out, ">MOVE {sequence} {id} {targets} {speed}")
        }
        Request::Glide { id, ends, seconds } => {
            several(ends.len());
            write!(
                out,
                ">GLIDE {sequence} {id} {} {}",
                lengths(&in_turn(ends))?,
                time(*seconds)?
            )
        }
        Request::Measure { readings } => write!(out, ">MEAS {sequence} {readings}"),
        Request::Status => write!(out, ">STAT {sequence}"),
        Request::Stop => write!(out, ">STOP {sequence}"),
        Request::Clear => write!(out, ">CLR {sequence}"),
        Request::Reference { token } => {
            let word = !token.is_empty()
                && token
                    .bytes()
                    .all(|byte| byte.is_ascii_alphanumeric() || byte == b'-');
            word.then(|| write!(out, ">REF {sequence} {token}"))?
        }
    }
    .ok()?;
    let sum = checksum(&out.as_bytes()[1..]);
    writeln!(out, "*{sum:04X}").ok()?;
    (out.len() <= longest).then(|| out.into_bytes())
}

/// `d_low d_high f_low f_high`
fn bounds_of(axis: &AxisBounds) -> Option<String> {
    let (low, high) = (
        length(axis.displacement.low)?,
        length(axis.displacement.high)?,
    );
    let (least, most) = (force(axis.force.low)?, force(axis.force.high)?);
    Some(format!("{low} {high} {least} {most}"))
}

/// `rate tolerance`; zeros for an axis that holds displacements.
fn control_of(axis: Option<AxialAxis>) -> Option<String> {
    let (rate, tolerance) = axis.map_or((0.0, 0.0), |axis| (axis.rate, axis.tolerance));
    Some(format!("{} {}", force(rate)?, force(tolerance)?))
}

/// Lengths after each other.
#[must_use]
pub fn lengths(values: &[f64]) -> Option<String> {
    let words: Vec<String> = values
        .iter()
        .map(|value| length(*value))
        .collect::<Option<_>>()?;
    Some(words.join(" "))
}

/// Position and velocity of each end, one after the other.
pub fn in_turn(ends: &[End]) -> Vec<f64> {
    ends.iter()
        .flat_map(|end| [end.position, end.velocity])
        .collect()
}

/// \[s\] as ms in text.
pub fn time(seconds: f64) -> Option<String> {
    number::write(seconds * 1e3, 3)
}

/// The sequence number of a frame to be sent.
#[must_use]
pub fn sequence(frame: &[u8]) -> Option<u32> {
    let word = frame.split(|byte| matches!(byte, b' ' | b'*')).nth(1)?;
    number::count(word).and_then(|count| u32::try_from(count).ok())
}

/// \[N\] or \[N/s\] in text.
#[must_use]
pub fn force(value: f64) -> Option<String> {
    number::write(value, 3)
}

/// \[m\] or \[m/s\] as mm or mm/s in text.
#[must_use]
pub fn length(value: f64) -> Option<String> {
    number::write(value * 1e3, 6)
}
