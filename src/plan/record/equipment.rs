//! The equipment and the limits of a run. In: a checked plan, and the identity that the rig reports. Out: [`Equipment`], as
//! data in the first line of the run log, so that the run log alone states it. It knows no rig and no file.

use serde::{Deserialize, Serialize};

use crate::DeclaredNoise;
use crate::record::Identity;
use crate::schema::limits;
use crate::{Dialect, Interval, Limits, Link, Plan, RigPlan};
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// The rig that answered, the calibration of its readings, and its limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Equipment {
    pub device: Device,
    /// Displacement and force of each axis.
    pub channels: Vec<Channel>,
    /// The limits that have a bound, as the guard enforces them.
    pub limits: Vec<HeldLimit>,
}

/// The identity that the rig reported before the first move.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Device {
    #[serde(flatten)]
    pub identity: Identity,
    /// Resolution of a displacement reading \[m\].
    pub resolution: f64,
    /// Standard deviation of one force reading \[N\].
    pub noise: f64,
}

impl Device {
    #[must_use]
    pub fn of(identity: &Identity, noise: DeclaredNoise) -> Self {
        Self {
            identity: identity.clone(),
            resolution: noise.resolution,
            noise: noise.force,
        }
    }
}

/// The quantity that a channel measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measures {
    /// \[m\]
    Displacement,
    /// \[N\]
    Force,
}

impl Measures {
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::Displacement => Dimension::LENGTH,
            Self::Force => Dimension::FORCE,
        }
    }

    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Force => "force",
        }
    }
}

/// Conversion of the number of a channel to a quantity: (number − zero) · factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// From 1.
    pub axis: usize,
    pub measures: Measures,
    /// The kind of number that the device gives.
    pub given_in: GivenIn,
    /// \[m\] or \[N\] per unit of the number, with the polarity of the rig.
    pub factor: f64,
    /// The number at zero of the quantity.
    pub zero: f64,
    /// Resolution of a displacement \[m\], standard deviation of one force reading \[N\], as declared.
    pub declared_scatter: f64,
    /// Relative standard uncertainty of the factor, if it is stated.
    pub uncertainty: f64,
    /// The calibration that the factor is traced to.
    pub certificate: Option<String>,
    /// Calibration due date, `YYYY-MM-DD`.
    pub due: Option<String>,
    /// Class of the measurement, as stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class: Option<String>,
    /// Ends of the range \[m\] or \[N\], if they are stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Absolute values for which the calibration is valid \[m\] or \[N\], if they are stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibrated: Option<[f64; 2]>,
}

/// The kind of number that a device gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GivenIn {
    /// A quantity with a unit that the protocol specifies.
    Units,
    /// Counts of a converter, or of a register.
    Counts,
}

/// A limit of the guard, SI; a missing end is unbounded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldLimit {
    /// The name in the `limits` of the plan.
    pub quantity: String,
    /// From 1, if it applies to one axis only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
}

impl Equipment {
    #[must_use]
    pub fn of(plan: &Plan, device: Device) -> Self {
        let axes = axes(plan);
        let mut limits = held(&plan.limits, None);
        for axis in axes {
            let own = plan.rig.limits_of(axis, &plan.limits);
            limits.extend(
                held(&own, Some(axis + 1))
                    .into_iter()
                    .filter(|own| !limits.iter().any(|all| all.bounds_as(own)))
                    .collect::<Vec<_>>(),
            );
        }
        Self {
            device,
            channels: Self::channels_of(plan),
            limits,
        }
    }

    /// The measuring channels of the plan's rig.
    #[must_use]
    pub fn channels_of(plan: &Plan) -> Vec<Channel> {
        axes(plan)
            .flat_map(|axis| channels(&plan.rig, axis))
            .collect()
    }

    /// The limit of speed, of all axes \[m/s\].
    #[must_use]
    pub fn speed_limit(&self) -> Interval {
        let of_speed =
            |limit: &&HeldLimit| limit.quantity == limits::SPEED.name && limit.axis.is_none();
        let limit = self.limits.iter().find(of_speed);
        limit.map_or(Interval::ALL, HeldLimit::interval)
    }

    /// The change that makes the same number a different quantity, if there is one.
    #[must_use]
    pub fn measures_otherwise(&self, now: &Self) -> Option<&'static str> {
        let scale = |channel: &Channel| {
            let resolution = if channel.measures == Measures::Displacement {
                channel.declared_scatter.to_bits()
            } else {
                0
            };
            (
                channel.axis,
                channel.measures,
                channel.given_in,
                channel.factor.to_bits(),
                channel.zero.to_bits(),
                resolution,
            )
        };
        if !self
            .channels
            .iter()
            .map(scale)
            .eq(now.channels.iter().map(scale))
        {
            return Some("calibration");
        }
        (self.device.resolution.to_bits() != now.device.resolution.to_bits())
            .then_some("resolution")
    }

    /// Limits and certificates that have changed, as text.
    #[must_use]
    pub fn changes(&self, now: &Self) -> Vec<String> {
        let mut named: Vec<(&str, Option<usize>)> = self
            .limits
            .iter()
            .chain(&now.limits)
            .map(|limit| (limit.quantity.as_str(), limit.axis))
            .collect();
        named.sort_unstable();
        named.dedup();
        let limit = |of: &Self, name: (&str, Option<usize>)| {
            of.limits
                .iter()
                .find(|limit| (limit.quantity.as_str(), limit.axis) == name)
                .cloned()
        };
        let limit_text = |limit: Option<HeldLimit>| {
            limit.map_or_else(|| "none".to_owned(), |limit| limit.describe())
        };
        let limits = named
            .into_iter()
            .filter(|name| limit(self, *name) != limit(now, *name))
            .map(|name| {
                let axis = name
                    .1
                    .map_or_else(String::new, |axis| format!(" of axis {axis}"));
                format!(
                    "limit {}{axis}: {} became {}",
                    name.0,
                    limit_text(limit(self, name)),
                    limit_text(limit(now, name))
                )
            });
        let traced = |of: &Self| {
            let channel_text = |channel: &Channel| {
                (
                    channel.certificate.clone(),
                    channel.due.clone(),
                    channel.uncertainty.to_bits(),
                )
            };
            of.channels.iter().map(channel_text).collect()
        };
        let (was, is): (Vec<_>, Vec<_>) = (traced(self), traced(now));
        limits
            .chain((was != is).then(|| "a different calibration certificate is named".to_owned()))
            .collect()
    }
}

impl HeldLimit {
    #[must_use]
    pub fn interval(&self) -> Interval {
        Interval {
            low: self.low.unwrap_or(f64::NEG_INFINITY),
            high: self.high.unwrap_or(f64::INFINITY),
        }
    }

    #[must_use]
    pub fn dimension(&self) -> Dimension {
        let known = Limits::NONE
            .named()
            .into_iter()
            .find(|(name, ..)| *name == self.quantity);
        known.map_or(Dimension::NUMBER, |(.., dimension)| dimension)
    }

    /// Whether both are the same limit of the same quantity, for any axis.
    fn bounds_as(&self, other: &Self) -> bool {
        (&self.quantity, self.low, self.high) == (&other.quantity, other.low, other.high)
    }

    fn describe(&self) -> String {
        let end = |end: Option<f64>| {
            end.map_or_else(|| "any".to_owned(), |end| stated(end, self.dimension()))
        };
        format!("{} .. {}", end(self.low), end(self.high))
    }
}

fn axes(plan: &Plan) -> std::ops::Range<usize> {
    0..plan.rig.axes().unwrap_or_else(|| plan.degrees_of_freedom())
}

/// The two channels of the axis with this index.
fn channels(rig: &RigPlan, axis: usize) -> [Channel; 2] {
    let link = rig.link.as_real();
    let moves = link.map(|link| &link.moved_by(axis).dialect);
    let (length_given, length) = match moves {
        Some(Dialect::Modbus(map)) => (GivenIn::Counts, map.length_unit),
        _ => (GivenIn::Units, 1.0),
    };
    let (sign, calibration) = (rig.polarity_of(axis), rig.calibration_of(axis));
    let (force_given, force, zero) = match link
        .map(|link| link.load_cell_of(axis))
        .map(|(cell, channel)| (&cell.dialect, channel))
    {
        Some((Dialect::Modbus(map), _)) => (GivenIn::Counts, map.force_unit, 0.0),
        Some((Dialect::Scpi { newtons_per_unit }, channel)) => (
            GivenIn::Counts,
            newtons_per_unit.get(channel).copied().unwrap_or(1.0),
            0.0,
        ),
        Some((dialect, _)) if dialect.abilities().counts => (
            GivenIn::Counts,
            calibration.newtons_per_count.unwrap_or(1.0),
            calibration.zero_offset,
        ),
        _ => (GivenIn::Units, 1.0, 0.0),
    };
    let (resolution, noise) = match &rig.link {
        Link::Virtual(link) => (link.resolution, link.noise),
        Link::Real(link) => (
            link.readings_of(axis).resolution,
            link.readings_of(axis).noise,
        ),
    };
    let channel = |measures, given_in, factor: f64, zero, declared_scatter, uncertainty| Channel {
        axis: axis + 1,
        measures,
        given_in,
        factor: sign * factor,
        zero,
        declared_scatter,
        uncertainty,
        certificate: calibration.reference.clone(),
        due: calibration.due.clone(),
        class: None,
        range: None,
        calibrated: None,
    };
    let ends = |range: Option<Interval>| range.map(|Interval { low, high }| [low, high]);
    let cell = link.map(|link| link.readings_of(axis).force_range);
    let cell = cell
        .map(|Interval { low, high }| [low, high])
        .filter(|ends| ends.iter().all(|end| end.is_finite()));
    let displacement = channel(
        Measures::Displacement,
        length_given,
        length,
        0.0,
        resolution,
        calibration.displacement_uncertainty,
    );
    let (certificate, due) = calibration.displacement.clone().map_or(
        (calibration.reference.clone(), calibration.due.clone()),
        |(own, due)| (Some(own), due),
    );
    [
        Channel {
            certificate,
            due,
            class: calibration.displacement_class.clone(),
            calibrated: ends(calibration.displacement_calibrated),
            ..displacement
        },
        Channel {
            class: calibration.force_class.clone(),
            range: cell,
            calibrated: ends(calibration.force_calibrated),
            ..channel(
                Measures::Force,
                force_given,
                force,
                zero,
                noise,
                calibration.force_uncertainty,
            )
        },
    ]
}

fn held(limits: &Limits, axis: Option<usize>) -> Vec<HeldLimit> {
    let end = |end: f64| Some(end).filter(|end| end.is_finite());
    let bounded = limits
        .held()
        .named()
        .into_iter()
        .filter(|(_, interval, _)| interval.is_bounded());
    bounded
        .map(|(name, Interval { low, high }, _)| HeldLimit {
            quantity: name.to_owned(),
            axis,
            low: end(low),
            high: end(high),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Calibration;
    use crate::testing::elastic_plan;

    fn equipment(plan: &Plan) -> Equipment {
        let unknown = String::new;
        let identity = Identity {
            name: unknown(),
            model: unknown(),
            serial: unknown(),
            firmware: unknown(),
            boot: None,
            simulated: true,
        };
        Equipment::of(plan, Device::of(&identity, DeclaredNoise::NONE))
    }

    #[test]
    fn another_sign_or_factor_is_another_measure_and_another_limit_a_change() {
        let plan = elastic_plan(300.0, Vec::new());
        let was = equipment(&plan);
        let mut turned = plan.clone();
        turned.rig.polarity = -1.0;
        assert_eq!(
            was.measures_otherwise(&equipment(&turned)),
            Some("calibration")
        );
        let mut narrow = plan.clone();
        narrow.limits.force = Interval {
            low: f64::NEG_INFINITY,
            high: 1000.0,
        };
        narrow.limits.tracking_energy_error = Interval {
            low: 0.0,
            high: 0.02,
        };
        let now = equipment(&narrow);
        assert_eq!(was.measures_otherwise(&now), None);
        assert_eq!(
            was.changes(&now),
            [
                "limit force: none became any .. 1 kN",
                "limit tracking_energy_error: 0 .. 0.05 became 0 .. 0.02"
            ]
        );
        let mut traced = plan;
        traced.rig.calibration = Calibration {
            reference: Some("ACME 17".to_owned()),
            ..Calibration::default()
        };
        assert_eq!(
            was.changes(&equipment(&traced)),
            ["a different calibration certificate is named"]
        );
    }
}
