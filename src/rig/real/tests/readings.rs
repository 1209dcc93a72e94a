//! Readings of a real rig: each fault of a reading is caught by its guard, and missed without it.

use super::*;

#[test]
fn counts_become_newtons_by_the_calibration_and_without_one_are_refused() {
    let counting = |device: &FakeDevice| device.inside().newtons_per_count = Some(-0.5);
    let calibration = Calibration {
        newtons_per_count: Some(-0.5),
        zero_offset: -40.0,
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
    // 200 N are −400 counts; the zero offset is −40.
    assert_eq!(stand.go(0.002), Ok((0.002, 180.0)));
    let refused = opened(&plan(), counting).err().unwrap();
    assert_eq!(
        refused.to_string(),
        "the rig gives no force in N: raw counts need a calibration"
    );
}

#[test]
fn a_single_spike_does_not_move_the_median() {
    let read = || {
        let mut stand = stand();
        stand.device.alter(|number, sample| {
            if number == 0 {
                (sample.channels[0].force, sample.channels[0].displacement) =
                    (Some(Force::Newtons(900.0)), Some(0.005));
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
    assert_eq!(
        (reading.raw.len(), fine.rig.line_statistics().reread),
        (6, 3)
    );
    assert_eq!(reading.raw[0], b"9.91E37");
    let mut lost = stand();
    lost.device
        .alter(move |number, _| if number < 4 { Err(overload()) } else { Ok(()) });
    let fault = lost.rig.read().unwrap_err();
    assert_eq!(
        fault.to_string(),
        "actuator on rig:1: `9.91E37` is not a reading: overload"
    );
    assert_eq!(lost.device.inside().holds, 1);
}

#[test]
fn a_frozen_a_saturated_and_a_flagged_reading_hold_the_rig() {
    let frozen = caught_by(Guarding::Frozen, || {
        |_, sample: &mut Sample| {
            sample.channels[0].force = Some(Force::Newtons(3.0));
            Ok(())
        }
    });
    assert!(frozen.starts_with("the force sensor is frozen"), "{frozen}");
    let saturated = caught_by(Guarding::Saturation, || {
        |_, sample: &mut Sample| {
            sample.channels[0].flags.saturated = true;
            Ok(())
        }
    });
    assert!(
        saturated.starts_with(
            "the force reading is saturated: reported by the device; nothing has moved"
        ),
        "{saturated}"
    );
    let stopped = caught_by(Guarding::Flags, || {
        |number, sample: &mut Sample| {
            sample.channels[0].flags.emergency_stop = number > 5;
            Ok(())
        }
    });
    assert_eq!(stopped, "the emergency stop is pressed");
    let stale = caught_by(Guarding::Invalid, || {
        |_, sample: &mut Sample| {
            sample.channels[0].flags.stale = true;
            Ok(())
        }
    });
    assert_eq!(stale, "the reading is out of date");
}

#[test]
fn a_restarted_rig_is_not_moved_any_more() {
    let went_back = caught_by(Guarding::Reboot, || {
        |number, sample: &mut Sample| {
            sample.time = Some(if number < 5 { 100.0 } else { 0.1 });
            Ok(())
        }
    });
    assert!(went_back.contains("restarted"), "{went_back}");
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
            .starts_with("psd did not poll the rig for 30.0 s")
            && holds == 1
    );
    assert_eq!(without(Guarding::Away, away), (Ok(()), 0));
}

#[test]
fn a_separate_load_cell_gives_the_force_and_an_open_loop_is_reported() {
    let clock = VirtualClock::default();
    let (frame, cell) = (FakeDevice::new(&clock), FakeDevice::new(&clock));
    frame.alter(|_, sample| {
        sample.channels[0].force = None;
        Ok(())
    });
    cell.alter(|_, sample| {
        (sample.channels[0].displacement, sample.channels[0].force) =
            (None, Some(Force::Newtons(-3.0)));
        Ok(())
    });
    let mut two = plan();
    let Link::Real(link) = &mut two.link else {
        panic!("real")
    };
    link.actuator.dialect = Dialect::Grbl;
    link.load_cell = Some(device_link(Dialect::Indicator));
    let (stop_request, clock) = (StopRequest::default(), Box::new(clock));
    let mut rig = RealRig::open(
        &two,
        &LIMITS,
        Box::new(frame),
        Some(Box::new(cell)),
        clock,
        stop_request,
    )
    .unwrap();
    let reading = rig.read().unwrap();
    assert_eq!(
        (reading.displacement[0], reading.force[0], reading.raw.len()),
        (0.0, -3.0, 6)
    );
    assert_eq!(
        rig.identity().model,
        "fake + fake (open loop: displacement as commanded)"
    );
}
