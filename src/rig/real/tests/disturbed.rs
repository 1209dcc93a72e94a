//! A frame whose axes settle at different times and disturb one another. A reading is valid only when all axes are at rest, with all axes
//! in one sample. In: an emulated device of two axes whose errors are known at every time. Out: readings inside the band, or the axis
//! that never settled.

use super::*;
use crate::controllers::{Channel, DeviceIdentity, Force, Sample};
use crate::safety::failpoint::without;
use crate::testing::rig::VirtualClock;
use psd_plan::{
    AxisPlan, Datum, DeviceLink, Dialect, Interval, Link, PortPlan, PretestCheck, RigPlan,
    SafeState,
};

const BAND: f64 = 1e-5;
const LIMITS: Limits = Limits {
    displacement: Interval {
        low: -0.01,
        high: 0.01,
    },
    force: Interval {
        low: -5e3,
        high: 5e3,
    },
    ..Limits::NONE
};

/// Distances of the axes from their targets \[m\], as a function of the time since the start of the move \[s\].
type Errors = fn(f64) -> [f64; 2];

/// Two axes on springs of 10 kN/m, at a known distance from their targets.
struct Coupled {
    clock: VirtualClock,
    errors: Errors,
    targets: [f64; 2],
    /// \[s\], by the clock.
    set_off: f64,
}

impl Device for Coupled {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        Ok(DeviceIdentity::default())
    }

    fn axes(&self) -> usize {
        2
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        Ok(DeviceMove {
            frames: Vec::new(),
            targets: targets.to_vec(),
            speed,
            id: None,
        })
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        (self.targets, self.set_off) = ([going.targets[0], going.targets[1]], self.clock.now());
        Ok(())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        self.clock.advance(0.01);
        let errors = if self.set_off > 0.0 {
            (self.errors)(self.clock.now() - self.set_off)
        } else {
            [0.0; 2]
        };
        let channels = [0, 1].map(|axis| {
            let position = self.targets[axis] + errors[axis];
            Channel {
                displacement: Some(position),
                force: Some(Force::Newtons(1e4 * position)),
                ..Channel::default()
            }
        });
        Ok(Sample {
            moving: Some(false),
            channels: channels.to_vec(),
            ..Sample::default()
        })
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        Ok(())
    }

    fn emergency(&self) -> Vec<u8> {
        Vec::new()
    }

    fn line_statistics(&self) -> LineStatistics {
        LineStatistics::default()
    }
}

fn plan() -> RigPlan {
    let range = Interval {
        low: -1e4,
        high: 1e4,
    };
    let port = PortPlan::Tcp {
        address: "rig:1".to_owned(),
    };
    let link = RealLink {
        actuator: DeviceLink {
            port,
            dialect: Dialect::Native,
            reply_timeout: 0.4,
            serial_number: None,
        },
        load_cell: None,
        safe_state: SafeState::Hold,
        datum: Datum::Machine,
        pretest_check: PretestCheck {
            zero: 10.0,
            probe: 1e-4,
            stiffness: Interval::ALL,
        },
        readings: ReadingRules {
            samples: 3,
            rate: 20.0,
            resolution: 1e-6,
            noise: 0.1,
            force_range: range,
            frozen_after: 100,
        },
        watchdog: 3.0,
        own_speed: 1.0,
        axes: vec![AxisPlan::default(), AxisPlan::default()],
    };
    let settle = Settle {
        band: BAND,
        force_rate: 5.0,
        dwell: 0.5,
        timeout: 4.0,
    };
    let (name, calibration) = ("frame".to_owned(), Calibration::default());
    RigPlan {
        name,
        link: Link::Real(link),
        settle,
        polarity: 1.0,
        calibration,
        zero_drift: None,
        simulated_axes: Vec::new(),
    }
}

const TARGETS: [f64; 2] = [1e-3, 2e-3];

/// Moves to the targets and reads. Gives the time of the reading after the start, and the distance of each axis from its target.
fn read(errors: Errors) -> Result<(f64, [f64; 2]), RigFault> {
    let clock = VirtualClock::default();
    let device = Coupled {
        clock: clock.clone(),
        errors,
        targets: [0.0; 2],
        set_off: 0.0,
    };
    let mut rig = RealRig::open(
        &plan(),
        &LIMITS,
        Box::new(device),
        None,
        Box::new(clock),
        StopRequest::default(),
    )?;
    rig.propose(&TARGETS, Some(1.0))?;
    let began = rig.time();
    rig.execute()?;
    let reading = rig.read()?;
    let error = |axis: usize| reading.displacement[axis] - TARGETS[axis];
    Ok((reading.time - began, [error(0), error(1)]))
}

const fn within(time: f64, from: f64, to: f64) -> bool {
    from <= time && time < to
}

/// The upper axis enters its band at 0.56 s. The lower axis is in its band from the start and settled at 0.5 s. It is pushed out of the
/// band from 0.9 s to 1.0 s, when the upper axis would be settled.
fn late(time: f64) -> [f64; 2] {
    let creeping = 5e-5 * (1.0 - time / 0.7).max(0.0);
    [if within(time, 0.9, 1.0) { 3e-5 } else { 0.0 }, creeping]
}

/// The same, and the upper axis is pushed while the readings are made.
fn pushed(time: f64) -> [f64; 2] {
    let [lower, upper] = late(time);
    [
        lower,
        upper - if within(time, 1.56, 1.62) { 3e-5 } else { 0.0 },
    ]
}

/// The upper axis is at rest for just long enough, again and again.
fn restless(time: f64) -> [f64; 2] {
    [0.0, if time % 0.7 > 0.6 { 3e-5 } else { 0.0 }]
}

fn inside(errors: [f64; 2]) -> bool {
    errors.iter().all(|error| error.abs() <= BAND)
}

#[test]
fn an_axis_that_another_disturbs_after_it_had_settled_is_waited_for() {
    let (time, errors) = read(late).unwrap();
    // A dwell after the push, and three readings.
    assert!(
        within(time, 1.0 + 0.5, 1.85) && inside(errors),
        "{time} s, {errors:?}"
    );
}

#[test]
fn a_reading_in_which_one_axis_has_moved_does_not_count() {
    let (time, errors) = read(pushed).unwrap();
    assert!(
        within(time, 1.62 + 0.5, 2.5) && inside(errors),
        "{time} s, {errors:?}"
    );
    let (_, missed) = without(Guarding::Settling, || read(pushed)).unwrap();
    assert!(!inside(missed), "the guard alone sees it: {missed:?}");
}

#[test]
fn a_frame_that_never_rests_long_enough_is_held_and_the_axis_named() {
    let fault = read(restless).unwrap_err();
    assert_eq!(
        fault,
        RigFault::NotSettled {
            timeout: 4.0,
            axis: Some(2)
        }
    );
}
