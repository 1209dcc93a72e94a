//! The motion of a rig after its release, as the operator must read it before. In: the rig, the plan's limits, the known facts of the
//! motion. Out: lines of text. It has no side effects: every prompt for motion states the same facts in the same order.

use psd_plan::{Interval, Limits, Plan};
use psd_rig::Identity;
use psd_text::units::Dimension;
use psd_text::units::display::{plain, readable, readable_beside, stated, stated_beside};

/// A motion that waits for its release.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Name of the rig in the plan.
    pub rig: String,
    /// The identity of the rig that answered.
    pub identity: Identity,
    /// Its position and force, if they were read: `at 0 mm, 0.2 N`.
    pub position: Option<String>,
    /// The motion, as the end of a sentence that begins with the name of the rig: `it moves to 1 mm`.
    pub does: String,
    /// The expected extent of the motion.
    pub expected: Extent,
    /// The limits that stop it.
    pub limits: Limits,
    /// The specimens that are not their storeys themselves, if there are any: all numbers are then those of the rig.
    pub at_scale: Option<String>,
}

/// Range of displacement and force, speed and duration, SI. None: not known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// \[m\], over all axes.
    pub travel: Option<Interval>,
    /// \[N\], over all axes.
    pub force: Option<Interval>,
    /// The highest speed \[m/s\].
    pub speed: Option<f64>,
    /// \[s\]
    pub duration: Option<f64>,
}

impl Motion {
    /// The motion of a plan's rig, with the values that the plan alone determines.
    #[must_use]
    pub fn of(plan: &Plan, identity: Identity, does: String) -> Self {
        Self {
            rig: plan.rig.name.clone(),
            identity,
            position: None,
            does,
            expected: Extent::default(),
            limits: plan.lateral_limits(),
            at_scale: plan.specimens_at_scale(),
        }
    }

    /// The same motion, with these values if they were not known before.
    #[must_use]
    pub fn expecting(mut self, expected: Extent) -> Self {
        let before = self.expected;
        self.expected = Extent {
            travel: before.travel.or(expected.travel),
            force: before.force.or(expected.force),
            speed: before.speed.or(expected.speed),
            duration: before.duration.or(expected.duration),
        };
        self
    }

    /// The expected duration of one move over `distance` \[m\] at `speed` \[m/s\], with its settling \[s\].
    #[must_use]
    pub fn duration(plan: &Plan, distance: f64, speed: f64) -> f64 {
        distance / speed + plan.rig.settle.dwell
    }

    /// The lines of a prompt: rig, motion, displacement, force, speed, duration.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let Extent {
            travel,
            force,
            speed,
            duration,
        } = self.expected;
        let speed = speed.map(|speed| format!("up to {}", readable(speed, Dimension::VELOCITY)));
        let position = self
            .position
            .as_ref()
            .map(|position| row("position", position));
        let numbers = self
            .at_scale
            .as_ref()
            .map(|specimens| row("numbers", &format!("of the rig: {specimens}")));
        let first = std::iter::once(row("rig", &self.who()))
            .chain(position)
            .chain(numbers);
        let rest = [
            row("motion", &self.does),
            row(
                "travel",
                &within(
                    travel.map(|travel| span(travel, Dimension::LENGTH, readable_beside)),
                    self.limits.displacement,
                    Dimension::LENGTH,
                ),
            ),
            row(
                "force",
                &within(
                    force.map(|force| span(force, Dimension::FORCE, readable_beside)),
                    self.limits.force,
                    Dimension::FORCE,
                ),
            ),
            row(
                "speed",
                &within(speed, self.limits.speed, Dimension::VELOCITY),
            ),
            row(
                "duration",
                &duration.map_or_else(|| "not known".to_owned(), about),
            ),
        ];
        first.chain(rest).collect()
    }

    /// The rig's name, and the identity that it reported.
    fn who(&self) -> String {
        let Identity {
            model,
            serial,
            simulated,
            ..
        } = &self.identity;
        let words: Vec<&str> = [model.as_str(), serial.as_str()]
            .into_iter()
            .filter(|word| !word.is_empty())
            .collect();
        let simulated = if *simulated { ", simulated" } else { "" };
        format!("{} ({}{simulated})", self.rig, words.join(" "))
    }
}

fn row(name: &str, text: &str) -> String {
    format!("{name:<9} {text}")
}

/// The expected value, and the limit that stops the motion.
fn within(expected: Option<String>, limit: Interval, dimension: Dimension) -> String {
    let expected = expected.unwrap_or_else(|| "not known".to_owned());
    let limit = match (limit.low.is_finite(), limit.high.is_finite()) {
        (true, true) if limit.low == 0.0 || dimension == Dimension::VELOCITY => {
            format!("limit {}", stated(limit.high, dimension))
        }
        (true, true) => format!("limits {}", span(limit, dimension, stated_beside)),
        (false, true) => format!("limit {}", stated(limit.high, dimension)),
        (true, false) => format!("limit {}", stated(limit.low, dimension)),
        (false, false) => "no limit".to_owned(),
    };
    format!("{expected}; {limit}")
}

/// Both ends of an interval. A zero has the unit of the other end; `written` gets a value, and the value that chooses its unit.
fn span(
    Interval { low, high }: Interval,
    dimension: Dimension,
    written: fn(f64, f64, Dimension) -> String,
) -> String {
    let end = |end: f64, other: f64| {
        let beside = if end == 0.0 { other } else { end };
        written(end, beside, dimension)
    };
    format!("{} .. {}", end(low, high), end(high, low))
}

/// The duration of a motion, as text. Below ten seconds in whole seconds, at least one.
fn about(seconds: f64) -> String {
    let (number, unit) = match seconds {
        seconds if seconds < 10.0 => (seconds.ceil().max(1.0), "s"),
        seconds if seconds < 60.0 => (seconds, "s"),
        seconds if seconds < 5400.0 => (seconds / 60.0, "min"),
        seconds => (seconds / 3600.0, "h"),
    };
    let number = plain(number, Dimension::NUMBER, 2);
    format!("about {number} {unit}, with settling")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::testing::empty_plan;

    #[test]
    fn a_motion_names_the_rig_and_how_far_how_hard_how_fast_and_how_long() {
        let mut plan = empty_plan();
        plan.rig.name = "bench".to_owned();
        plan.limits.displacement = Interval {
            low: -5e-3,
            high: 10e-3,
        };
        plan.limits.speed = Interval {
            low: 0.0,
            high: 0.2,
        };
        let text = |word: &str| word.to_owned();
        let identity = Identity {
            name: text("bench"),
            model: text("ACT-1"),
            serial: text("17"),
            firmware: text("1"),
            boot: None,
            simulated: false,
        };
        let unknown = Motion::of(&plan, identity, "it moves to 1 mm".to_owned());
        assert_eq!(
            unknown.lines(),
            [
                "rig       bench (ACT-1 17)",
                "motion    it moves to 1 mm",
                "travel    not known; limits −5 mm .. 10 mm",
                "force     not known; no limit",
                "speed     not known; limit 0.2 m/s",
                "duration  not known",
            ]
        );
        let expected = Extent {
            travel: Some(Interval {
                low: 0.0,
                high: 8.165e-3,
            }),
            force: Some(Interval {
                low: 0.0,
                high: 2450.0,
            }),
            speed: Some(0.02),
            duration: Some(90.0),
        };
        let known = unknown.expecting(expected);
        let lines = known.lines();
        assert!(
            lines[2] == "travel    0 mm .. 8.165 mm; limits −5 mm .. 10 mm"
                && lines[3] == "force     0 kN .. 2.450 kN; no limit",
            "{lines:#?}"
        );
        assert!(
            lines[4].contains("20.00 mm/s") && lines[5] == "duration  about 1.5 min, with settling",
            "{lines:#?}"
        );
        let light = Interval {
            low: 0.0,
            high: 78.0,
        };
        let light = span(light, Dimension::FORCE, readable_beside);
        assert_eq!(
            light, "0 N .. 78.00 N",
            "a zero has the unit of the other end"
        );
        let moved = known.expecting(Extent {
            duration: Some(1.0),
            ..Extent::default()
        });
        assert_eq!(moved.expected, expected, "what is known stays");
        let scaled = Motion {
            at_scale: Some("storey 1 at scale 0.5".to_owned()),
            ..moved
        };
        assert_eq!(
            scaled.lines()[1],
            "numbers   of the rig: storey 1 at scale 0.5"
        );
    }
}
