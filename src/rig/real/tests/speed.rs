//! The observed speed of a real rig, on a scripted device and a virtual clock. It is never above the true speed, and it is above the
//! commanded speed if the rig was faster.

use super::{LIMITS, stand};
use crate::{Guard, Rig as _};

#[test]
fn a_move_is_seen_no_faster_than_it_went_and_a_little_slower() {
    let mut stand = stand();
    assert_eq!(stand.rig.seen_speed(), None);
    let mut guard = Guard::new(&mut stand.rig, LIMITS, Vec::new()).unwrap();
    guard.move_to(&[0.002], Some(0.001)).unwrap();
    assert_eq!(guard.speed(), Some(0.001), "as it was commanded");
    // Polled 20 times a second, 2 s appear as up to 2.1 s.
    let seen = stand.rig.seen_speed().unwrap();
    assert!((0.95e-3..=1e-3).contains(&seen), "{seen}");
}

#[test]
fn an_actuator_faster_than_commanded_is_detected() {
    let mut stand = stand();
    let device = stand.device.clone();
    let mut guard = Guard::new(&mut stand.rig, LIMITS, Vec::new()).unwrap();
    stand.device.alter(move |sample, _| {
        if sample == 5 {
            device.inside().speed = 0.01;
        }
        Ok(())
    });
    guard.move_to(&[0.002], Some(0.001)).unwrap();
    // A third of a second at 1 mm/s, and the rest at 10 mm/s.
    let seen = guard.speed().unwrap();
    assert!((3e-3..6e-3).contains(&seen), "{seen}");
}
