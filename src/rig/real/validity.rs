//! Validity of one reading. In: the replies of the devices, in SI. Out: valid, "ask again", or the reason why the rig must
//! hold. It moves nothing and keeps only the history that shows a frozen sensor.

use crate::controllers::{Flags, Force, NOT_TRUSTED};
use crate::safety::failpoint::{Guarding, on};
use psd_plan::ReadingRules;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Nearness to an end of the range at which a reading is saturated, as a fraction of that end.
const SATURATION: f64 = 1e-3;

/// Displacement, in resolutions, over which a constant force counts as frozen.
const FROZEN_OVER: f64 = 5.0;

/// One answer of the rig, in the polarity of the rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RawSample {
    /// \[m\]
    pub(super) displacement: f64,
    /// \[N\]
    pub(super) force: f64,
    /// As received from the converter.
    pub(super) original: Force,
    pub(super) flags: Flags,
    /// The device's own clock \[s\].
    pub(super) device_time: Option<f64>,
}

/// Why a reading may not be used.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Invalid {
    /// The next reading may be valid.
    AskAgain(String),
    /// A rig without faults never gives this at rest. After a motion, the next reading may be valid.
    Impossible(String),
    /// The rig holds.
    Hold(String),
    /// As `Hold`: the force is at or beyond an end of its range.
    Saturated(String),
    /// The rig holds, and its position is unknown.
    Untrusted(String),
}

impl Invalid {
    /// The same, with its axis.
    fn named(self, axis: Option<usize>) -> Self {
        let Some(axis) = axis else { return self };
        let named = |reason| format!("axis {axis}: {reason}");
        match self {
            Self::AskAgain(reason) => Self::AskAgain(named(reason)),
            Self::Impossible(reason) => Self::Impossible(named(reason)),
            Self::Hold(reason) => Self::Hold(named(reason)),
            Self::Saturated(reason) => Self::Saturated(named(reason)),
            Self::Untrusted(reason) => Self::Untrusted(named(reason)),
        }
    }
}

/// The history against which a reading is validated.
#[derive(Clone, Debug, Default)]
pub(super) struct ReadingValidator {
    /// Number of the axis, from 1, if the rig has several.
    axis: Option<usize>,
    control: Control,
    same: Option<Same>,
    /// The device's own clock \[s\].
    device_time: Option<f64>,
}

/// The quantity of an axis that its controller holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Control {
    #[default]
    Displacement,
    /// It is an axial axis, and its controller was not seen to hold its force yet.
    Entering,
    Force,
}

/// Consecutive readings with exactly the same force.
#[derive(Clone, Copy, Debug)]
struct Same {
    /// \[N\]
    force: f64,
    /// Number of them at a different position from the previous one: an actuator at rest at its target does not indicate a frozen sensor.
    repeats: u32,
    /// The last, lowest and highest of these positions \[m\].
    last: f64,
    low: f64,
    high: f64,
}

impl ReadingValidator {
    pub(super) fn of_axis(axis: Option<usize>, is_axial: bool) -> Self {
        let control = if is_axial {
            Control::Entering
        } else {
            Control::Displacement
        };
        Self {
            axis,
            control,
            ..Self::default()
        }
    }

    /// The next move enters force control, if the axis is axial.
    pub(super) fn begin_force_control(&mut self) {
        if self.control == Control::Entering {
            self.control = Control::Force;
        }
    }

    /// Whether the axis was seen in force control, or entered it.
    pub(super) fn is_in_force_control(&self) -> bool {
        self.control == Control::Force
    }

    /// The controller holds of this axis what the plan moves it by.
    fn controlled(&mut self, flags: Flags) -> Result<(), Invalid> {
        if !on(Guarding::Flags) {
            return Ok(());
        }
        let hold = |reason: &str| Err(Invalid::Hold(reason.to_owned()));
        if let Some(reason) = flags.left_force_control() {
            return hold(reason);
        }
        match (self.control, flags.in_force_control) {
            (Control::Displacement, true) => {
                hold("its controller holds a force, but the plan moves its displacement")
            }
            (Control::Force, false) => hold("its controller does not hold the force any more"),
            (Control::Entering, true) => {
                self.control = Control::Force;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    pub(super) fn validate(
        &mut self,
        sample: &RawSample,
        rules: &ReadingRules,
    ) -> Result<(), Invalid> {
        self.same_device(sample)?;
        whole_rig(sample.flags)?;
        let of_axis = flags(sample.flags)
            .and_then(|()| number(sample))
            .and_then(|()| saturation(sample, rules));
        of_axis
            .and_then(|()| self.controlled(sample.flags))
            .and_then(|()| self.frozen(sample, rules))
            .map_err(|invalid| invalid.named(self.axis))
    }

    /// A clock that runs backwards indicates a device that restarted.
    fn same_device(&mut self, sample: &RawSample) -> Result<(), Invalid> {
        let before = self.device_time;
        self.device_time = sample.device_time.or(before);
        match (before, sample.device_time) {
            (Some(before), Some(now)) if on(Guarding::Reboot) && now < before => {
                Err(Invalid::Untrusted(format!(
                    "its clock ran backwards from {before} s to {now} s: it restarted, and {NOT_TRUSTED}"
                )))
            }
            _ => Ok(()),
        }
    }

    /// The force stays exactly the same while the specimen is displaced.
    fn frozen(&mut self, sample: &RawSample, rules: &ReadingRules) -> Result<(), Invalid> {
        // A controlled force changes by the noise of its cell alone.
        if self.control != Control::Displacement && rules.noise == 0.0 {
            return Ok(());
        }
        let x = sample.displacement;
        let same = match self.same {
            Some(same)
                if same.force == sample.force && (x - same.last).abs() <= rules.resolution =>
            {
                same
            }
            Some(same) if same.force == sample.force => Same {
                repeats: same.repeats.saturating_add(1),
                last: x,
                low: same.low.min(x),
                high: same.high.max(x),
                ..same
            },
            _ => Same {
                force: sample.force,
                repeats: 1,
                last: x,
                low: x,
                high: x,
            },
        };
        self.same = Some(same);
        let Same {
            repeats, low, high, ..
        } = same;
        let moved = high - low > FROZEN_OVER * rules.resolution;
        if on(Guarding::Frozen) && repeats >= rules.frozen_after.max(2) && moved {
            return Err(Invalid::Hold(format!(
                "the force sensor is frozen: {repeats} readings of {} while the displacement changed by {}",
                readable(sample.force, Dimension::FORCE),
                readable(high - low, Dimension::LENGTH)
            )));
        }
        Ok(())
    }
}

/// Flags that concern all axes.
fn whole_rig(flags: Flags) -> Result<(), Invalid> {
    if on(Guarding::Flags) {
        for (set, what) in [
            (flags.emergency_stop, "the emergency stop is pressed"),
            (
                flags.watchdog_tripped,
                "its watchdog tripped: it holds after a communication time-out",
            ),
        ] {
            if set {
                return Err(Invalid::Hold(what.to_owned()));
            }
        }
    }
    Ok(())
}

fn flags(flags: Flags) -> Result<(), Invalid> {
    if on(Guarding::Flags) && flags.unreferenced {
        return Err(Invalid::Untrusted(
            "its position is not referenced".to_owned(),
        ));
    }
    if on(Guarding::Invalid) && flags.stale {
        return Err(Invalid::AskAgain("the reading is out of date".to_owned()));
    }
    Ok(())
}

fn number(sample: &RawSample) -> Result<(), Invalid> {
    let (x, force) = (sample.displacement, sample.force);
    if !on(Guarding::Invalid) || x.is_finite() && force.is_finite() {
        return Ok(());
    }
    Err(Invalid::Impossible(format!(
        "invalid reading: {x} m, {force} N"
    )))
}

/// At an end of the range of converter or cell, the true force may be anywhere beyond it. A force that is not finite is not checked here.
fn saturation(sample: &RawSample, rules: &ReadingRules) -> Result<(), Invalid> {
    if !on(Guarding::Saturation) {
        return Ok(());
    }
    let hold = |what: String| {
        Err(Invalid::Saturated(format!(
            "the force reading is saturated: {what}"
        )))
    };
    if sample.flags.saturated {
        return hold("reported by the device".to_owned());
    }
    if let Force::Counts { count, low, high } = sample.original {
        #[expect(
            clippy::cast_precision_loss,
            reason = "converters have at most 32 bits"
        )]
        let (value, low, high) = (count as f64, low as f64, high as f64);
        let margin = SATURATION * (high - low) / 2.0;
        if value <= low + margin || value >= high - margin {
            return hold(format!("{count} counts of {low} .. {high}"));
        }
    }
    let range = rules.force_range;
    let (low, high) = (
        range.low + SATURATION * range.low.abs(),
        range.high - SATURATION * range.high.abs(),
    );
    // An end that is not given is infinite; the margin then makes it NaN, and every comparison is false.
    if sample.force <= low || sample.force >= high {
        return hold(format!(
            "{} N of {} .. {} N",
            sample.force, range.low, range.high
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safety::failpoint::without;
    use psd_plan::Interval;

    const RULES: ReadingRules = ReadingRules {
        samples: 1,
        rate: 10.0,
        resolution: 1e-6,
        noise: 1.0,
        force_range: Interval {
            low: -1000.0,
            high: 1000.0,
        },
        frozen_after: 4,
    };

    fn raw_sample(force: f64) -> RawSample {
        RawSample {
            displacement: 0.001,
            force,
            original: Force::Newtons(force),
            flags: Flags::default(),
            device_time: None,
        }
    }

    /// The last of these is refused with `guard` on, and is missed without it.
    fn only_caught_by(guard: Guarding, rules: ReadingRules, readings: &[RawSample]) -> Invalid {
        let last = || {
            let mut validator = ReadingValidator::default();
            let (last, before) = readings.split_last().unwrap();
            for sample in before {
                validator.validate(sample, &rules).unwrap();
            }
            validator.validate(last, &rules)
        };
        assert_eq!(without(guard, last), Ok(()), "{guard:?}");
        last().unwrap_err()
    }

    #[test]
    fn what_is_no_number_or_old_is_asked_again() {
        let unbounded = ReadingRules {
            force_range: Interval::ALL,
            ..RULES
        };
        let stale = RawSample {
            flags: Flags {
                stale: true,
                ..Flags::default()
            },
            ..raw_sample(1.0)
        };
        let nowhere = RawSample {
            displacement: f64::NAN,
            ..raw_sample(1.0)
        };
        assert!(matches!(
            only_caught_by(Guarding::Invalid, unbounded, &[stale]),
            Invalid::AskAgain(_)
        ));
        for bad in [raw_sample(f64::NAN), nowhere] {
            assert!(matches!(
                only_caught_by(Guarding::Invalid, unbounded, &[bad]),
                Invalid::Impossible(_)
            ));
        }
        let infinite = ReadingValidator::default().validate(&raw_sample(f64::INFINITY), &unbounded);
        assert!(matches!(infinite, Err(Invalid::Impossible(_))));
    }

    #[test]
    fn an_end_of_the_range_is_saturated_and_what_lies_inside_is_not() {
        let counts = |count| RawSample {
            original: Force::Counts {
                count,
                low: -8_388_608,
                high: 8_388_607,
            },
            ..raw_sample(10.0)
        };
        let flagged = RawSample {
            flags: Flags {
                saturated: true,
                ..Flags::default()
            },
            ..raw_sample(1.0)
        };
        for bad in [
            raw_sample(999.1),
            raw_sample(-5000.0),
            counts(8_388_607),
            counts(-8_380_300),
            flagged,
        ] {
            assert!(matches!(
                only_caught_by(Guarding::Saturation, RULES, &[bad]),
                Invalid::Saturated(_)
            ));
        }
        for good in [
            raw_sample(998.9),
            raw_sample(-998.9),
            raw_sample(0.0),
            counts(8_380_000),
        ] {
            assert_eq!(ReadingValidator::default().validate(&good, &RULES), Ok(()));
        }
    }

    #[test]
    fn a_fault_flag_of_the_device_holds_the_rig() {
        let flagged = |flags| RawSample {
            flags,
            ..raw_sample(1.0)
        };
        let none = Flags::default();
        for (flags, untrusted) in [
            (
                Flags {
                    emergency_stop: true,
                    ..none
                },
                false,
            ),
            (
                Flags {
                    watchdog_tripped: true,
                    ..none
                },
                false,
            ),
            (
                Flags {
                    unreferenced: true,
                    ..none
                },
                true,
            ),
        ] {
            let invalid = only_caught_by(Guarding::Flags, RULES, &[flagged(flags)]);
            assert_eq!(matches!(invalid, Invalid::Untrusted(_)), untrusted);
        }
    }

    #[test]
    fn a_clock_that_goes_back_is_that_of_a_restarted_device() {
        let at = |time| RawSample {
            device_time: Some(time),
            ..raw_sample(time)
        };
        let invalid = only_caught_by(
            Guarding::Reboot,
            RULES,
            &[at(100.0), raw_sample(3.0), at(0.5)],
        );
        assert!(matches!(invalid, Invalid::Untrusted(_)));
    }

    #[test]
    fn a_force_that_stays_while_the_specimen_is_bent_is_frozen() {
        let at = |displacement, force| RawSample {
            displacement,
            ..raw_sample(force)
        };
        let stuck: Vec<RawSample> = (0..4).map(|i| at(f64::from(i) * 3e-6, 5.0)).collect();
        assert!(matches!(
            only_caught_by(Guarding::Frozen, RULES, &stuck),
            Invalid::Hold(_)
        ));
        // If displacement and force are read one after the other, the first reading after a move may be mixed. It may combine the force
        // at the end with a displacement during the motion. A constant force at rest afterwards does not indicate a frozen sensor.
        let mut validator = ReadingValidator::default();
        validator.validate(&at(1e-5, 5.0), &RULES).unwrap();
        for _ in 0..50 {
            validator.validate(&at(3e-5, 5.0), &RULES).unwrap();
        }
        // At rest, or with a changing force, no sensor is frozen.
        let mut validator = ReadingValidator::default();
        for i in 0..50 {
            validator
                .validate(&at(1e-6 * f64::from(i % 5), 5.0), &RULES)
                .unwrap();
        }
        let mut validator = ReadingValidator::default();
        for i in 0..50 {
            validator
                .validate(&at(1e-5 * f64::from(i), 5.0 + f64::from(i / 3)), &RULES)
                .unwrap();
        }
    }
}
