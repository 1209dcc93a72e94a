//! The last hold of a run, on a scripted device and a virtual clock. The hold position is the one where the rig was read at rest. A rig
//! without such a reading is not reported as held.

use super::{Stand, stand};
use crate::controllers::{DeviceFault, Force};
use crate::{FinalHold, Rig as _};

/// A rig that has moved towards 2 mm at 1 mm/s for one second, and the result of its final hold.
fn halted_in_motion(mut stand: Stand) -> (Stand, FinalHold) {
    stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    let stop_request = stand.stop_request.clone();
    stand.device.alter(move |sample, _| {
        if sample == 19 {
            stop_request.hold_now();
        }
        Ok(())
    });
    stand.rig.execute().unwrap_err();
    stand.device.inside().alter = None;
    let halted = stand.rig.halt().unwrap();
    (stand, halted)
}

#[test]
fn it_is_held_where_it_was_seen_at_rest_and_read_there() {
    for reports_motion in [true, false] {
        let stand = stand();
        stand.device.inside().reports_motion = reports_motion;
        let (stand, halted) = halted_in_motion(stand);
        let position = stand.device.inside().position;
        assert!((0.5e-3..1.5e-3).contains(&position), "{position}");
        assert!(halted.is_held(), "{halted}");
        assert_eq!(halted.found, Some((vec![position], vec![1e5 * position])));
        assert!(halted.raw.len() == 3 && halted.time > 0.9, "{halted:?}");
        let newest = stand.rig.live().newest().unwrap();
        assert_eq!(newest.displacement, [position], "who watches sees it too");
    }
}

#[test]
fn a_hold_that_found_no_ear_is_called_none() {
    let mut stand = stand();
    stand.device.inside().deaf = true;
    stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    stand.stop_request.hold_now();
    stand.rig.execute().unwrap_err();
    let halted = stand.rig.halt().unwrap();
    assert!(!halted.is_held() && halted.found.is_none(), "{halted:?}");
    let message = halted.to_string();
    assert!(
        message
            .starts_with("NOT CONFIRMED HELD (actuator on rig:1: no usable answer within 2.81 s)"),
        "{message}"
    );
    assert!(message.ends_with("Press the emergency stop"), "{message}");
}

#[test]
fn a_rig_that_goes_on_is_not_called_held_and_is_not_waited_for_for_ever() {
    let mut stand = stand();
    stand.device.alter(|_, sample| {
        sample.moving = Some(true);
        Ok(())
    });
    let began = stand.rig.time();
    let halted = stand.rig.halt().unwrap();
    assert_eq!(halted.unconfirmed.as_deref(), Some("it is still moving"));
    assert!(
        (5.0..6.5).contains(&(halted.time - began)),
        "{}",
        halted.time - began
    );
    stand.device.alter(|_, _| {
        Err(DeviceFault::Lost {
            reason: "unplugged".to_owned(),
        })
    });
    let halted = stand.rig.halt().unwrap();
    assert!(
        halted.to_string().contains("connection lost: unplugged"),
        "{halted}"
    );
}

#[test]
fn readings_during_a_move_are_shown_beside_the_run() {
    let mut stand = stand();
    let live = stand.rig.live();
    let before = live.newest().unwrap();
    stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    stand.rig.execute().unwrap();
    let after = live.newest().unwrap();
    assert!(
        after.number > before.number + 40,
        "two seconds at twenty a second: {}",
        after.number
    );
    assert_eq!(
        (before.displacement, after.displacement),
        (vec![0.0], vec![0.002])
    );
    stand.rig.pause(2.0).unwrap();
    assert!(
        live.newest().unwrap().number > after.number,
        "and while nothing moves"
    );
}

/// The limits of the motion back are extended to this reading.
#[test]
fn a_spike_does_not_change_where_it_is_held() {
    let mut stand = stand();
    let mut reading = 0;
    stand.device.alter(move |_, sample| {
        reading += 1;
        // The first one shows that it is at rest.
        if reading == 2 {
            sample.channels[0].force = Some(Force::Newtons(1800.0));
        }
        Ok(())
    });
    let halted = stand.rig.halt().unwrap();
    assert_eq!(halted.found, Some((vec![0.0], vec![0.0])), "{halted}");
}
