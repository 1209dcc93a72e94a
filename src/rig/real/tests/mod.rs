//! A real rig on a scripted device and a virtual clock: each fault is caught by its guard, and missed without it.

mod disturbed;
mod final_hold;
mod readings;
mod speed;
mod straying;
mod strokes;

use super::*;
use crate::LimitedQuantity;
use crate::controllers::{Force, Sample};
use crate::safety::failpoint::without;
use crate::testing::rig::{FakeDevice, VirtualClock};
use psd_plan::{
    Calibration, Datum, DeviceLink, Dialect, Interval, Limits, Link, PortPlan, PretestCheck,
    ReadingRules, RigPlan, SafeState,
};

pub(super) const LIMITS: Limits = Limits {
    displacement: Interval {
        low: -0.001,
        high: 0.02,
    },
    force: Interval {
        low: -100.0,
        high: 5000.0,
    },
    ..Limits::NONE
};

fn device_link(dialect: Dialect) -> DeviceLink {
    let port = PortPlan::Tcp {
        address: "rig:1".to_owned(),
    };
    DeviceLink {
        port,
        dialect,
        reply_timeout: 0.5,
        serial_number: Some("F-1".to_owned()),
    }
}

fn plan() -> RigPlan {
    let range = Interval {
        low: -1e4,
        high: 1e4,
    };
    let readings = ReadingRules {
        samples: 3,
        rate: 20.0,
        resolution: 1e-6,
        noise: 2.0,
        force_range: range,
        frozen_after: 6,
    };
    let link = RealLink {
        actuator: device_link(Dialect::Native),
        load_cell: None,
        safe_state: SafeState::Hold,
        datum: Datum::Machine,
        pretest_check: PretestCheck {
            zero: 10.0,
            probe: 1e-4,
            stiffness: Interval {
                low: 5e4,
                high: 2e5,
            },
        },
        readings,
        watchdog: 3.0,
        own_speed: 0.001,
        axes: Vec::new(),
    };
    let settle = Settle {
        band: 1e-5,
        force_rate: 5.0,
        dwell: 0.5,
        timeout: 5.0,
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

pub(super) struct Stand {
    pub(super) rig: RealRig,
    pub(super) device: FakeDevice,
    clock: VirtualClock,
    pub(super) stop_request: StopRequest,
}

fn opened(plan: &RigPlan, prepare: impl FnOnce(&FakeDevice)) -> Result<Stand, RigFault> {
    let clock = VirtualClock::default();
    let (device, stop_request) = (FakeDevice::new(&clock), StopRequest::default());
    prepare(&device);
    let rig = RealRig::open(
        plan,
        &LIMITS,
        Box::new(device.clone()),
        None,
        Box::new(clock.clone()),
        stop_request.clone(),
    )?;
    Ok(Stand {
        rig,
        device,
        clock,
        stop_request,
    })
}

pub(super) fn stand() -> Stand {
    opened(&plan(), |_| {}).unwrap()
}

impl Stand {
    /// Moves at 1 mm/s and reads: displacement and force.
    fn go(&mut self, target: f64) -> Result<(f64, f64), RigFault> {
        self.rig.propose(&[target], Some(0.001))?;
        self.rig.execute()?;
        let reading = self.rig.read()?;
        Ok((reading.displacement[0], reading.force[0]))
    }

    /// The fault on the path to 2 mm, after which the rig holds; None without a fault.
    fn fault(mut self) -> Option<RigFault> {
        let fault = self.go(0.002).err();
        assert_eq!(
            fault.is_some(),
            self.device.inside().holds > 0,
            "held where it failed, {fault:?}"
        );
        fault
    }
}

/// The fault that these altered samples cause; without the guard it must be missed.
fn caught_by<A>(guard: Guarding, alter: impl Fn() -> A) -> String
where
    A: FnMut(u64, &mut Sample) -> Result<(), DeviceFault> + Send + 'static,
{
    let fault = || {
        let stand = stand();
        stand.device.alter(alter());
        stand.fault()
    };
    assert_eq!(without(guard, fault), None, "{guard:?}");
    fault().expect("caught").to_string()
}

#[test]
fn it_moves_settles_for_the_dwell_and_reads_with_all_its_bytes() {
    let mut stand = stand();
    assert_eq!(stand.device.inside().narrowed, Some(LIMITS));
    let propose = stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    assert_eq!(
        (
            propose.targets.as_slice(),
            propose.speed,
            propose.wire.as_slice()
        ),
        (&[0.002][..], 0.001, &b"0.002 0.001"[..])
    );
    assert!(
        stand.device.inside().started.is_empty(),
        "nothing moves yet"
    );
    let began = stand.rig.time();
    stand.rig.execute().unwrap();
    // 2 s of motion, half a second of dwell, and less than three polls.
    let took = stand.rig.time() - began;
    assert!((2.5..2.75).contains(&took), "{took}");
    let reading = stand.rig.read().unwrap();
    assert_eq!(
        (reading.displacement[0], reading.force[0], reading.raw.len()),
        (0.002, 200.0, 3)
    );
    stand.rig.pause(10.0).unwrap();
    assert!((stand.rig.time() - began - took - 10.0).abs() < 0.25);
    assert_eq!(stand.rig.line_statistics(), LineStatistics::default());
    assert!(stand.rig.execute().is_err(), "nothing was proposed");
    assert_eq!(stand.device.inside().started, [0.002]);
}

#[test]
fn many_short_stays_leave_no_silence_longer_than_the_watchdog() {
    let mut stand = stand();
    let asked = stand.device.inside().samples;
    for _ in 0..1000 {
        stand.rig.pause(0.01).unwrap();
    }
    // In 10 s, one poll in each quarter of the 3 s.
    let asked = stand.device.inside().samples - asked;
    assert!((12..=14).contains(&asked), "{asked}");
    assert_eq!(stand.go(0.002), Ok((0.002, 200.0)));
}

#[test]
fn a_device_that_cannot_report_motion_is_given_the_time_of_the_move() {
    let mut stand = stand();
    stand.device.inside().reports_motion = false;
    assert_eq!(stand.go(0.002), Ok((0.002, 200.0)));
}

#[test]
fn a_negative_sign_turns_targets_readings_limits_and_the_remembered_move() {
    let turned = RigPlan {
        polarity: -1.0,
        ..plan()
    };
    let remember = |device: &FakeDevice| {
        device.inside().last_move = Some(LastMove {
            id: 7,
            targets: vec![-0.003],
        });
    };
    let mut stand = opened(&turned, remember).unwrap();
    assert_eq!(stand.go(0.002), Ok((0.002, 200.0)));
    assert_eq!(stand.device.inside().started, [-0.002]);
    let narrowed = stand.device.inside().narrowed.unwrap();
    assert_eq!(
        narrowed.displacement,
        Interval {
            low: -0.02,
            high: 0.001
        }
    );
    assert_eq!(
        narrowed.force,
        Interval {
            low: -5000.0,
            high: 100.0
        }
    );
    assert_eq!(
        stand.rig.last_move(),
        Some(LastMove {
            id: 7,
            targets: vec![0.003]
        })
    );
}

#[test]
fn another_device_than_the_plan_s_is_refused() {
    let another = |device: &FakeDevice| device.inside().identity.serial = "F-2".to_owned();
    let refused = opened(&plan(), another).err().unwrap();
    assert_eq!(
        refused.to_string(),
        "actuator on rig:1: the plan requires serial number `F-1`; this device has `F-2`"
    );
}

#[test]
fn what_never_settles_is_held_after_the_timeout() {
    let mut stand = stand();
    // 6 N/s without end; 5 N/s are allowed.
    stand.device.alter(|_, sample| {
        sample.channels[0].force = sample.time.map(|time| Force::Newtons(6.0 * time));
        Ok(())
    });
    let began = stand.rig.time();
    assert_eq!(
        stand.go(0.002),
        Err(RigFault::NotSettled {
            timeout: 5.0,
            axis: None
        })
    );
    assert!((7.0..7.3).contains(&(stand.rig.time() - began)));
    assert_eq!(stand.device.inside().holds, 1);
}

#[test]
fn without_the_guard_of_settling_a_reading_comes_too_early() {
    let too_early = || {
        let mut stand = stand();
        let began = stand.rig.time();
        stand.go(0.002).unwrap();
        stand.rig.time() - began
    };
    assert!(too_early() > 2.5 && without(Guarding::Settling, too_early) < 2.4);
}

#[test]
fn an_actuator_that_stops_short_is_a_following_error() {
    let fault = || {
        let stand = stand();
        stand.device.inside().reaches = 0.9;
        stand.fault()
    };
    assert_eq!(without(Guarding::Following, fault), None);
    let Some(RigFault::Following {
        error,
        band,
        axis: None,
    }) = fault()
    else {
        panic!("not caught")
    };
    assert!((error - 2e-4).abs() < 1e-12 && band == 1e-5);
}

#[test]
fn bytes_that_decode_to_another_number_are_not_sent() {
    let fault = || {
        let stand = stand();
        stand.device.inside().misspoken = 5e-6;
        let device = stand.device.clone();
        (stand.rig_refuses(), device.inside().started.len())
    };
    assert_eq!(fault(), (true, 0));
    assert_eq!(without(Guarding::WireNumber, fault), (false, 1));
    for target in [f64::NAN, f64::INFINITY] {
        assert!(stand().rig.propose(&[target], None).is_err());
    }
}

impl Stand {
    fn rig_refuses(mut self) -> bool {
        self.rig
            .propose(&[0.002], None)
            .and_then(|_| self.rig.execute_briefly())
            .is_err()
    }
}

impl RealRig {
    /// Commands the proposed move and does not poll further.
    fn execute_briefly(&mut self) -> Result<(), RigFault> {
        let going = self.proposed.take().unwrap().going;
        self.actuator
            .start(&going)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))
    }
}

#[test]
fn a_hold_request_ends_a_move_within_a_slice_and_the_rig_is_at_rest() {
    let mut stand = stand();
    let (stop_request, clock) = (stand.stop_request.clone(), stand.clock.clone());
    stand.device.alter(move |number, _| {
        if number == 10 {
            stop_request.hold_now();
        }
        Ok(())
    });
    assert_eq!(stand.go(0.002), Err(RigFault::Interrupted));
    let stopped_at = stand.device.inside().position;
    assert!(
        stopped_at > 1e-4 && stopped_at < 1e-3,
        "in mid-move, {stopped_at}"
    );
    clock.advance(1.0);
    assert_eq!(stand.device.inside().position, stopped_at);
    assert_eq!(stand.device.inside().holds, 1);
    assert!(
        stand.rig.read().is_ok() && stand.stop_request.end_requested(),
        "heeded, and not forgotten"
    );
}

#[test]
fn a_force_beyond_its_limit_stops_a_move_and_a_single_spike_does_not() {
    let fault_and_position = || {
        let mut stand = stand();
        stand.device.inside().stiffness = 1e6;
        let fault = stand.go(0.008).err();
        (fault, stand.device.inside().position)
    };
    let (fault, stopped_at) = fault_and_position();
    assert!(
        matches!(
            fault,
            Some(RigFault::LimitBreached {
                quantity: LimitedQuantity::Force,
                ..
            })
        ),
        "{fault:?}"
    );
    assert!((0.005..0.0052).contains(&stopped_at), "{stopped_at}");
    assert_eq!(
        without(Guarding::ReadingLimits, fault_and_position),
        (None, 0.008)
    );
    let mut spiked = stand();
    spiked.device.alter(|number, sample| {
        if number == 8 {
            sample.channels[0].force = Some(Force::Newtons(6000.0));
        }
        Ok(())
    });
    assert_eq!(spiked.go(0.002), Ok((0.002, 200.0)));
}

#[test]
fn a_device_that_reports_rest_before_it_has_begun_is_waited_for() {
    let mut stand = stand();
    stand.device.alter(|number, sample| {
        if number < 4 {
            sample.moving = Some(false);
        }
        Ok(())
    });
    assert_eq!(stand.go(0.012), Ok((0.012, 1200.0)));
}

#[test]
fn a_rig_that_moves_before_a_command_is_held() {
    let moving = |device: &FakeDevice| {
        let mut inside = device.inside();
        (inside.target, inside.speed) = (0.01, 0.001);
    };
    let refused = opened(&plan(), moving).err().unwrap();
    assert_eq!(
        refused.to_string(),
        "it was already moving before any command: rig put on hold"
    );
}

#[test]
fn many_short_stays_are_heard_as_one_long_one() {
    let mut stand = stand();
    for _ in 0..1000 {
        stand.rig.pause(0.01).unwrap();
    }
    // Three times the watchdog.
    stand.rig.read().unwrap();
}
