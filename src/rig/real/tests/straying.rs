//! An axis that deviates from its path, and a force that does not follow from the dwell before it, on a scripted device and
//! a virtual clock: each is caught by its guard, and missed without it.

use super::stand;
use crate::controllers::Force;
use crate::safety::failpoint::{Guarding, without};
use crate::{Rig as _, RigFault};

/// Commanded to 2 mm through a line that multiplies the target by `reaches`. Gives the position at the hold \[m\], and the message.
fn sent(reaches: f64) -> (f64, Option<String>) {
    let mut stand = stand();
    stand.device.inside().reaches = reaches;
    stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    let fault = stand.rig.execute().err().map(|fault| fault.to_string());
    let stopped_at = stand.device.inside().position;
    (stopped_at, fault)
}

/// 2 mm plus a quarter of it, plus two bands of 10 µm.
const BEYOND: f64 = 2.52e-3;

#[test]
fn an_axis_that_goes_past_its_target_is_held_during_the_move() {
    let (stopped_at, fault) = sent(5.0);
    let fault = fault.expect("held");
    assert!(
        fault.starts_with("the rig deviated from the commanded path: it is at 2.5"),
        "{fault}"
    );
    // Two readings, 50 ms apart at 1 mm/s.
    assert!(
        (BEYOND..BEYOND + 2e-4).contains(&stopped_at),
        "{stopped_at}"
    );
    let (stopped_at, fault) = without(Guarding::PathDeviation, || sent(5.0));
    assert!(
        stopped_at > 6e-3 && fault.is_some_and(|fault| fault.contains("settle")),
        "it alone catches it on the way: {stopped_at}"
    );
}

#[test]
fn an_axis_that_goes_in_the_other_direction_is_held() {
    let (stopped_at, fault) = sent(-0.4);
    assert!(
        fault.is_some_and(|fault| fault.contains("deviated"))
            && (-7.2e-4..=-5.2e-4).contains(&stopped_at),
        "{stopped_at}"
    );
}

#[test]
fn an_overshoot_and_a_single_spike_are_no_straying() {
    let mut stand = stand();
    stand.device.alter(|number, sample| {
        // 20 % too far in some readings, ten times the value in one.
        let factor = if number == 20 {
            10.0
        } else if (30..45).contains(&number) {
            1.2
        } else {
            1.0
        };
        sample.channels[0].displacement = sample.channels[0].displacement.map(|at| at * factor);
        Ok(())
    });
    stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    assert_eq!(stand.rig.execute(), Ok(()));
}

/// At 2 mm and 200 N, with ±2 N of declared noise; `lost` readings after settling have lost a digit. Gives the reading \[N\].
fn read_with(lost: u64) -> Result<f64, RigFault> {
    let mut stand = stand();
    stand.rig.propose(&[0.002], Some(0.001)).unwrap();
    stand.rig.execute().unwrap();
    stand.device.alter(move |number, sample| {
        if number < lost {
            sample.channels[0].force = Some(Force::Newtons(20.0));
        }
        Ok(())
    });
    stand.rig.read().map(|reading| reading.force[0])
}

#[test]
fn an_isolated_jump_of_force_is_read_again() {
    assert_eq!(read_with(1), Ok(200.0), "the median");
    assert_eq!(read_with(2), Ok(200.0));
    assert_eq!(without(Guarding::ForceJump, || read_with(2)), Ok(20.0));
    // The reading keeps this value: the force has changed, and the rig settles again.
    assert_eq!(read_with(u64::MAX), Ok(20.0));
}
