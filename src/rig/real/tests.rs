//! A real rig on a scripted device and a virtual clock: each fault is caught by its guard, and missed without it.

use super::*;
use crate::plan::{
    Calibration, Datum, DeviceLink, Dialect, Gate, Interval, Limits, Link, PortPlan, ReadingRules,
    RigPlan, SafeState,
};
use crate::rig::LimitedQuantity;
use crate::rig::controllers::{Force, Sample};
use crate::rig::safety::failpoint::without;
use crate::rig::testing::{FakeDevice, VirtualClock};

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
        gate: Gate {
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
        sign: 1.0,
        calibration,
        drift: None,
    }
}

pub(super) struct Stand {
    pub(super) rig: RealRig,
    pub(super) device: FakeDevice,
    clock: VirtualClock,
    pub(super) wish: Wish,
}

fn opened(plan: &RigPlan, prepare: impl FnOnce(&FakeDevice)) -> Result<Stand, RigFault> {
    let clock = VirtualClock::default();
    let (device, wish) = (FakeDevice::new(&clock), Wish::default());
    prepare(&device);
    let rig = RealRig::open(
        plan,
        &LIMITS,
        Box::new(device.clone()),
        None,
        Box::new(clock.clone()),
        wish.clone(),
    )?;
    Ok(Stand {
        rig,
        device,
        clock,
        wish,
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

    /// What goes wrong on the way to 2 mm; the rig holds, or nothing went wrong.
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

/// What goes wrong where samples are altered so; it must be missed without the guard.
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
    let offer = stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    assert_eq!(
        (offer.targets.as_slice(), offer.speed, offer.wire.as_slice()),
        (&[0.002][..], 0.001, &b"0.002 0.001"[..])
    );
    assert!(
        stand.device.inside().started.is_empty(),
        "nothing moves yet"
    );
    let began = stand.rig.time();
    stand.rig.execute().unwrap();
    // 2 s on the way, half a second of dwell, and less than three polls.
    let took = stand.rig.time() - began;
    assert!((2.5..2.75).contains(&took), "{took}");
    let reading = stand.rig.read().unwrap();
    assert_eq!(
        (reading.displacement[0], reading.force[0], reading.raw.len()),
        (0.002, 200.0, 3)
    );
    stand.rig.pause(10.0).unwrap();
    assert!((stand.rig.time() - began - took - 10.0).abs() < 0.25);
    assert_eq!(stand.rig.tally(), Tally::default());
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
    // 10 s, heard from each quarter of the 3 s.
    let asked = stand.device.inside().samples - asked;
    assert!((12..=14).contains(&asked), "{asked}");
    assert_eq!(stand.go(0.002), Ok((0.002, 200.0)));
}

#[test]
fn a_device_that_cannot_say_whether_it_moves_is_given_the_time_of_the_way() {
    let mut stand = stand();
    stand.device.inside().tells_motion = false;
    assert_eq!(stand.go(0.002), Ok((0.002, 200.0)));
}

#[test]
fn a_negative_sign_turns_targets_readings_limits_and_the_remembered_move() {
    let turned = RigPlan {
        sign: -1.0,
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
fn counts_become_newtons_by_the_calibration_and_without_one_are_refused() {
    let counting = |device: &FakeDevice| device.inside().newtons_per_count = Some(-0.5);
    let calibration = Calibration {
        newtons_per_count: Some(-0.5),
        zero_count: -40.0,
        ..Calibration::default()
    };
    let mut stand = opened(
        &RigPlan {
            calibration,
            ..plan()
        },
        counting,
    )
    .unwrap();
    // 200 N are −400 counts; zero lies at −40.
    assert_eq!(stand.go(0.002), Ok((0.002, 180.0)));
    let refused = opened(&plan(), counting).err().unwrap();
    assert_eq!(
        refused.to_string(),
        "the rig gives no force in N: raw counts need a calibration"
    );
}

#[test]
fn another_device_than_the_plan_s_is_refused() {
    let another = |device: &FakeDevice| device.inside().identity.serial = "F-2".to_owned();
    let refused = opened(&plan(), another).err().unwrap();
    assert_eq!(
        refused.to_string(),
        "actuator on rig:1: the plan wants serial number `F-1`, this one is `F-2`"
    );
}

#[test]
fn what_never_settles_is_held_after_the_timeout() {
    let mut stand = stand();
    // 6 N/s for ever, where 5 are allowed.
    stand.device.alter(|_, sample| {
        sample.force = sample.time.map(|time| Force::Newtons(6.0 * time));
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
fn a_ram_that_stops_short_is_a_following_error() {
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
fn bytes_that_say_another_number_are_not_sent() {
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
    /// Sends what was offered and looks no further.
    fn execute_briefly(&mut self) -> Result<(), RigFault> {
        let going = self.proposed.take().unwrap().going;
        self.actuator
            .start(&going)
            .map_err(|fault| self.told(Part::Actuator, &fault))
    }
}

#[test]
fn a_single_spike_does_not_move_the_median() {
    let read = || {
        let mut stand = stand();
        stand.device.alter(|number, sample| {
            if number == 0 {
                (sample.force, sample.displacement) = (Some(Force::Newtons(900.0)), Some(0.005));
            }
            Ok(())
        });
        let reading = stand.rig.read().unwrap();
        (reading.displacement[0], reading.force[0], reading.raw.len())
    };
    assert_eq!(read(), (0.0, 0.0, 3));
    assert_eq!(without(Guarding::Median, read), (0.005, 900.0, 3));
}

#[test]
fn no_reading_is_asked_for_again_three_times_and_its_bytes_are_kept() {
    let overload = || DeviceFault::NoReading {
        raw: b"9.91E37".to_vec(),
        reason: "overload".to_owned(),
    };
    let mut fine = stand();
    fine.device
        .alter(move |number, _| if number < 3 { Err(overload()) } else { Ok(()) });
    let reading = fine.rig.read().unwrap();
    assert_eq!((reading.raw.len(), fine.rig.tally().reread), (6, 3));
    assert_eq!(reading.raw[0], b"9.91E37");
    let mut lost = stand();
    lost.device
        .alter(move |number, _| if number < 4 { Err(overload()) } else { Ok(()) });
    let fault = lost.rig.read().unwrap_err();
    assert_eq!(
        fault.to_string(),
        "actuator on rig:1: `9.91E37` is no reading: overload"
    );
    assert_eq!(lost.device.inside().holds, 1);
}

#[test]
fn a_frozen_a_saturated_and_a_flagged_reading_hold_the_rig() {
    let frozen = caught_by(Guarding::Frozen, || {
        |_, sample: &mut Sample| {
            sample.force = Some(Force::Newtons(3.0));
            Ok(())
        }
    });
    assert!(frozen.starts_with("the force sensor is frozen"), "{frozen}");
    let saturated = caught_by(Guarding::Saturation, || {
        |_, sample: &mut Sample| {
            sample.flags.saturated = true;
            Ok(())
        }
    });
    assert!(
        saturated
            .starts_with("the force reading is saturated: the device says so; nothing has moved"),
        "{saturated}"
    );
    let stopped = caught_by(Guarding::Flags, || {
        |number, sample: &mut Sample| {
            sample.flags.emergency_stop = number > 5;
            Ok(())
        }
    });
    assert_eq!(stopped, "the emergency stop is pressed");
    let stale = caught_by(Guarding::Invalid, || {
        |_, sample: &mut Sample| {
            sample.flags.stale = true;
            Ok(())
        }
    });
    assert_eq!(stale, "the reading is an old one");
}

#[test]
fn a_rig_that_started_anew_is_not_moved_any_more() {
    let went_back = caught_by(Guarding::Reboot, || {
        |number, sample: &mut Sample| {
            sample.time = Some(if number < 5 { 100.0 } else { 0.1 });
            Ok(())
        }
    });
    assert!(went_back.contains("started anew"), "{went_back}");
    let mut stand = stand();
    stand.device.alter(|_, _| {
        Err(DeviceFault::Rebooted {
            was: "7F3A".to_owned(),
            is: "0B11".to_owned(),
        })
    });
    assert!(stand.rig.trusted() && stand.go(0.002).is_err() && !stand.rig.trusted());
    stand.device.alter(|_, _| Ok(()));
    assert!(stand.rig.read().is_ok(), "it may be read");
    assert!(stand.go(0.001).is_err() && stand.device.inside().started.is_empty());
}

#[test]
fn a_program_that_was_away_does_not_go_on_by_itself() {
    let away = || {
        let mut stand = stand();
        stand.go(0.002).unwrap();
        stand.clock.advance(30.0);
        let read = stand.rig.read();
        (
            read.map(|_| ()).map_err(|fault| fault.to_string()),
            stand.device.inside().holds,
        )
    };
    let (read, holds) = away();
    assert!(
        read.unwrap_err()
            .starts_with("the program was away for 30.0 s")
            && holds == 1
    );
    assert_eq!(without(Guarding::Away, away), (Ok(()), 0));
}

#[test]
fn a_wish_to_hold_ends_a_move_within_a_slice_and_the_rig_stands() {
    let mut stand = stand();
    let (wish, clock) = (stand.wish.clone(), stand.clock.clone());
    stand.device.alter(move |number, _| {
        if number == 10 {
            wish.hold_now();
        }
        Ok(())
    });
    assert_eq!(stand.go(0.002), Err(RigFault::Interrupted));
    let stood = stand.device.inside().position;
    assert!(stood > 1e-4 && stood < 1e-3, "in mid-move, {stood}");
    clock.advance(1.0);
    assert_eq!(stand.device.inside().position, stood);
    assert_eq!(stand.device.inside().holds, 1);
    assert!(
        stand.rig.read().is_ok() && stand.wish.wants_end(),
        "heeded, and not forgotten"
    );
}

#[test]
fn a_force_beyond_its_limit_stops_a_move_on_the_way_and_a_lone_spike_does_not() {
    let stands_at = || {
        let mut stand = stand();
        stand.device.inside().stiffness = 1e6;
        let fault = stand.go(0.008).err();
        (fault, stand.device.inside().position)
    };
    let (fault, stood) = stands_at();
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
    assert!((0.005..0.0052).contains(&stood), "{stood}");
    assert_eq!(without(Guarding::ReadingLimits, stands_at), (None, 0.008));
    let mut spiked = stand();
    spiked.device.alter(|number, sample| {
        if number == 8 {
            sample.force = Some(Force::Newtons(6000.0));
        }
        Ok(())
    });
    assert_eq!(spiked.go(0.002), Ok((0.002, 200.0)));
}

#[test]
fn a_device_that_says_it_rests_before_it_has_begun_is_waited_for() {
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
fn a_rig_that_moves_before_it_is_told_to_is_held() {
    let moving = |device: &FakeDevice| {
        let mut inside = device.inside();
        (inside.target, inside.speed) = (0.01, 0.001);
    };
    let refused = opened(&plan(), moving).err().unwrap();
    assert_eq!(
        refused.to_string(),
        "it was moving before it was told to: held"
    );
}

#[test]
fn a_stroke_reads_at_equal_times_and_ends_at_its_target() {
    let mut stand = stand();
    let mut readings = Vec::new();
    let mut keep = |reading: Reading| {
        readings.push((reading.time, reading.displacement[0]));
        Ok(())
    };
    stand.rig.traverse(&[0.008], 0.001, 4, &mut keep).unwrap();
    let began = readings[0].0 - 2.0;
    for (sample, (time, x)) in (1..).zip(&readings) {
        let expected = 0.002 * f64::from(sample);
        assert!(
            (time - began - 2.0 * f64::from(sample)).abs() < 1e-6,
            "{readings:?}"
        );
        assert!((x - expected).abs() < 2e-5, "{readings:?}");
    }
    assert_eq!(stand.device.inside().position, 0.008);
    assert!(
        stand
            .rig
            .traverse(&[0.0], 0.001, 4, &mut |_| Ok(()))
            .is_err(),
        "away from the target"
    );
    assert!(
        stand
            .rig
            .traverse(&[0.0], -0.001, 0, &mut |_| Ok(()))
            .is_err()
    );
}

#[test]
fn a_stroke_stops_at_a_refused_reading() {
    let mut stand = stand();
    let mut count = 0;
    let refused = stand.rig.traverse(&[0.008], 0.001, 8, &mut |_| {
        count += 1;
        if count == 3 {
            Err(RigFault::Interrupted)
        } else {
            Ok(())
        }
    });
    assert_eq!((refused, count), (Err(RigFault::Interrupted), 3));
    let stood = stand.device.inside().position;
    assert!((0.003..0.0031).contains(&stood) && stand.device.inside().target == stood);
    // What is left is gone from there; at the end only the reading that is missing is made.
    let mut on = |done| {
        let mut places = Vec::new();
        let cut_off = CutOff {
            from: &[0.0],
            to: &[0.008],
            samples: 8,
            done,
        };
        let rest = stand.rig.traverse_on(&cut_off, 0.001, &mut |reading| {
            places.push(reading.displacement[0]);
            Ok(())
        });
        rest.map(|()| places).unwrap()
    };
    let rest = on(2);
    assert!(
        rest.len() == 6 && rest[0] > stood && rest.is_sorted() && rest[5] == 0.008,
        "{rest:?}"
    );
    assert_eq!((on(7), on(8)), (vec![0.008], Vec::new()));
}

#[test]
fn a_stroke_reads_as_often_as_the_line_carries_and_waits_until_it_rests() {
    let mut stand = stand();
    stand.device.inside().answer_time = 0.3;
    let mut readings = Vec::new();
    let mut keep = |reading: Reading| {
        readings.push((reading.time, reading.displacement[0]));
        Ok(())
    };
    // 100 readings in 8 s would come every 0.08 s: one takes 0.3 s.
    stand.rig.traverse(&[0.008], 0.001, 100, &mut keep).unwrap();
    assert!((25..=27).contains(&readings.len()), "{}", readings.len());
    let began = readings[0].0 - readings[0].1 / 0.001;
    for (time, x) in &readings {
        assert!(
            (x - (0.001 * (time - began)).min(0.008)).abs() < 1e-6,
            "each with its own time and place: {readings:?}"
        );
    }
    assert_eq!(readings.last().unwrap().1, 0.008, "the last at the end");
    // Of a stroke that is over before the first answer there is only one.
    let late = stand
        .rig
        .traverse(&[0.0], -0.1, 8, &mut |_| Ok(()))
        .unwrap_err();
    assert!(
        late.to_string()
            .starts_with("the readings cannot keep up: 1 in a stroke of 0.080 s"),
        "{late}"
    );
}

#[test]
fn a_stroke_that_ends_elsewhere_is_a_following_error() {
    let mut stand = stand();
    stand.device.inside().reaches = 0.9;
    let short = stand
        .rig
        .traverse(&[0.008], 0.001, 8, &mut |_| Ok(()))
        .unwrap_err();
    assert!(
        matches!(short, RigFault::Following { error, .. } if (error - 0.0008).abs() < 1e-9),
        "{short:?}"
    );
    assert_eq!(stand.device.inside().holds, 1);
}

#[test]
fn a_load_cell_of_its_own_gives_the_force_and_an_open_loop_says_so() {
    let clock = VirtualClock::default();
    let (frame, cell) = (FakeDevice::new(&clock), FakeDevice::new(&clock));
    frame.alter(|_, sample| {
        sample.force = None;
        Ok(())
    });
    cell.alter(|_, sample| {
        (sample.displacement, sample.force) = (None, Some(Force::Newtons(-3.0)));
        Ok(())
    });
    let mut two = plan();
    let Link::Real(link) = &mut two.link else {
        panic!("real")
    };
    link.actuator.dialect = Dialect::Grbl;
    link.load_cell = Some(device_link(Dialect::Indicator));
    let (wish, clock) = (Wish::default(), Box::new(clock));
    let mut rig = RealRig::open(
        &two,
        &LIMITS,
        Box::new(frame),
        Some(Box::new(cell)),
        clock,
        wish,
    )
    .unwrap();
    let reading = rig.read().unwrap();
    assert_eq!(
        (reading.displacement[0], reading.force[0], reading.raw.len()),
        (0.0, -3.0, 6)
    );
    assert!(rig.open_loop());
    assert_eq!(
        rig.identity().model,
        "fake + fake (open loop: displacement as commanded)"
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
