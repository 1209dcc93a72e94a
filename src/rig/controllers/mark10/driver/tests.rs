//! Transcripts of a test frame with its gauge: limits read back, lost characters, silences, overruns.

use super::*;
use crate::controllers::mark10::load_cell::Mark10Gauge;
use crate::testing::rig::{Scripted, ScriptedPort, Transcript, VirtualClock};

const T: f64 = 0.2;
const FORCE: &str = "/?\r\\";

/// One round of status, travel and force.
fn round<'a>(
    script: &'a mut Transcript,
    status: &str,
    travel: &str,
    force: &str,
) -> &'a mut Transcript {
    script.on("p", status).on("x", travel).on(FORCE, force)
}

fn text(frame: &[u8]) -> String {
    String::from_utf8(frame.to_vec()).unwrap()
}

fn line() -> (LineClient, Transcript) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    (
        LineClient::new(Box::new(port.clone()), Box::new(clock), T),
        Transcript::new(port, 0.01, text),
    )
}

/// At 1 mm, stopped.
fn opened() -> (Mark10, Transcript) {
    let (client, mut script) = line();
    let mut stand = Mark10::new(client);
    round(script.on("ilo", "").on("p", "SL"), "SL", "1.00", "100.0 N");
    stand.identify().unwrap();
    (stand, script)
}

#[test]
fn a_sample_is_status_travel_and_force() {
    let (mut stand, mut script) = opened();
    round(&mut script, "UL", "2.35", "-0.25 kN");
    let sample = stand.sample().unwrap();
    assert_eq!(
        (sample.channels[0].displacement, sample.channels[0].force),
        (Some(0.002_35), Some(Force::Newtons(-250.0)))
    );
    assert_eq!(
        (sample.moving, sample.raw),
        (
            Some(true),
            vec![b"UL".to_vec(), b"2.35".to_vec(), b"-0.25 kN".to_vec()]
        )
    );
    script.done();
}

#[test]
fn a_target_is_a_limit_that_is_read_back_before_the_stand_sets_off() {
    let (mut stand, mut script) = opened();
    let going = stand.encode(&[0.002_504], 0.01).unwrap();
    assert_eq!(
        (going.targets[0], going.speed),
        (0.002_5, 0.01),
        "hundredths of a millimetre"
    );
    assert_eq!(
        going.frames,
        [b"e0600.0".to_vec(), b"h002.50".to_vec(), b"u".to_vec()]
    );
    // A letter is lost in transmission: the old limit is reported, and the new limit is set again.
    script
        .on("e0600.0h002.50", "")
        .on("v", "300.00")
        .on("e0600.0h002.50", "")
        .on("v", "2.50");
    // The first `u` is also lost.
    script
        .on("p", "SL")
        .on("u", "")
        .on("p", "SL")
        .on("x", "1.00")
        .on("v", "2.50")
        .on("u", "")
        .on("p", "UL");
    stand.start(&going).unwrap();
    script.done();
    let down = stand.encode(&[-0.001], 0.01).unwrap();
    assert_eq!(
        down.frames,
        [b"e0600.0".to_vec(), b"g-001.00".to_vec(), b"d".to_vec()]
    );
    let here = stand.encode(&[0.001_003], 0.01).unwrap();
    assert_eq!(
        (here.frames.len(), here.targets[0]),
        (2, 0.001),
        "it is there already"
    );
    for (target, speed) in [(1.0, 0.01), (f64::NAN, 0.01), (0.0, 0.0), (0.0, f64::NAN)] {
        assert!(
            matches!(stand.encode(&[target], speed), Err(DeviceFault::Unfit(_))),
            "{target} {speed}"
        );
    }
}

#[test]
fn it_never_sets_off_with_another_limit_or_outside_limit_mode() {
    let (mut stand, mut script) = opened();
    let going = stand.encode(&[0.002], 0.01).unwrap();
    for _ in 0..3 {
        script.on("e0600.0h002.00", "").on("v", "20.00");
    }
    assert!(matches!(
        stand.start(&going),
        Err(DeviceFault::Refused { .. })
    ));
    script
        .on("e0600.0h002.00", "")
        .on("v", "2.00")
        .on("p", "SM")
        .on("s", "")
        .on("p", "SM");
    assert!(matches!(
        stand.start(&going),
        Err(DeviceFault::Rebooted { .. })
    ));
    script.done();
    let (client, mut script) = line();
    script.on("ilo", "").on("p", "SM");
    assert!(matches!(
        Mark10::new(client).identify(),
        Err(DeviceFault::Unfit(_))
    ));
}

#[test]
fn a_stand_past_its_limit_is_stopped() {
    let (mut stand, mut script) = opened();
    let going = stand.encode(&[0.002], 0.01).unwrap();
    script
        .on("e0600.0h002.00", "")
        .on("v", "2.00")
        .on("p", "SL")
        .on("u", "")
        .on("p", "UL");
    stand.start(&going).unwrap();
    script
        .on("p", "UL")
        .on("x", "2.10")
        .on("s", "")
        .on("p", "SL");
    assert!(matches!(stand.sample(), Err(DeviceFault::Unfit(_))));
    script.done();
}

/// The test frame was switched off and on between the last status and the start letter: it no longer stops at a target.
#[test]
fn a_stand_that_left_limit_mode_is_stopped_and_never_sent_off_again() {
    let left =
        |fault: DeviceFault| assert!(matches!(fault, DeviceFault::Rebooted { .. }), "{fault}");
    let (mut stand, mut script) = opened();
    let going = stand.encode(&[0.002], 0.01).unwrap();
    script
        .on("e0600.0h002.00", "")
        .on("v", "2.00")
        .on("p", "SL")
        .on("u", "")
        .on("p", "SM")
        .on("s", "")
        .on("p", "SM");
    left(stand.start(&going).unwrap_err());
    script.done();
    for status in ["UM", "SM", "UC"] {
        let (mut stand, mut script) = opened();
        script
            .on("e0600.0h002.00", "")
            .on("v", "2.00")
            .on("p", "SL")
            .on("u", "")
            .on("p", "UL");
        stand.start(&going).unwrap();
        script.on("p", status).on("s", "").on("p", "SM");
        left(stand.sample().unwrap_err());
        script.done();
    }
    // The test frame lost its limits but kept its mode.
    let (mut stand, mut script) = opened();
    script
        .on("e0600.0h002.00", "")
        .on("v", "2.00")
        .on("p", "SL")
        .on("u", "")
        .on("p", "SL")
        .on("x", "0.00")
        .on("v", "300.00");
    script.on("s", "").on("p", "SL");
    assert!(matches!(
        stand.start(&going),
        Err(DeviceFault::Refused { .. })
    ));
    script.done();
}

#[test]
fn a_garbled_answer_outside_of_a_reading_is_asked_for_again() {
    let (mut stand, mut script) = opened();
    let going = stand.encode(&[0.002], 0.01).unwrap();
    script
        .on("e0600.0h002.00", "")
        .on("v", "2.00")
        .on("p", "L")
        .on("p", "SL")
        .on("u", "")
        .on("p", "D")
        .on("p", "UL");
    stand.start(&going).unwrap();
    script.done();
    assert_eq!(stand.line_statistics().reread, 2);
}

#[test]
fn after_a_silence_travel_and_force_are_asked_twice() {
    let (mut stand, mut script) = opened();
    script
        .on("p", "SL")
        .on("x", "")
        .on("x", "1.01")
        .on("x", "1.02");
    script.on(FORCE, "").on(FORCE, "101 N").on(FORCE, "102 N");
    let sample = stand.sample().unwrap();
    assert_eq!(
        (sample.channels[0].displacement, sample.channels[0].force),
        (Some(0.001_02), Some(Force::Newtons(102.0)))
    );
    script.done();
    // Unsolicited bytes are discarded.
    script
        .port
        .send_unasked(&[Scripted::After(0.0, b"999.99\r\n".to_vec())]);
    round(&mut script, "SL", "1.00", "100 N");
    assert_eq!(
        stand.sample().unwrap().channels[0].displacement,
        Some(0.001)
    );
    assert!(stand.line_statistics().ignored >= 1);
}

#[test]
fn what_is_no_number_or_has_no_known_unit_is_no_reading() {
    for force in [
        "*10", "nan N", "100", "1,5 N", "OVL", "inf N", "100 lb", "1e400 N", " N",
    ] {
        let (mut stand, mut script) = opened();
        round(&mut script, "SL", "1.00", force);
        assert!(
            matches!(stand.sample(), Err(DeviceFault::NoReading { .. })),
            "{force}"
        );
    }
    for travel in ["0.04 in", "1,00", "SL", "nan"] {
        let (mut stand, mut script) = opened();
        script.on("p", "SL").on("x", travel);
        assert!(
            matches!(stand.sample(), Err(DeviceFault::NoReading { .. })),
            "{travel}"
        );
        script.done();
    }
}

#[test]
fn it_holds_by_stopping_and_looks_whether_it_does() {
    let (mut stand, mut script) = opened();
    script.on("s", "").on("p", "UL").on("s", "").on("p", "SL");
    stand.hold().unwrap();
    script.done();
    assert_eq!(stand.emergency(), b"ss");
}

#[test]
fn the_gauge_alone_measures_force_and_does_not_move() {
    let (client, mut script) = line();
    let mut gauge = Mark10Gauge::new(client);
    script
        .on("?\r", "12.5 N")
        .on("?\r", "2 kgF")
        .on("?\r", "*10");
    gauge.identify().unwrap();
    assert_eq!(
        gauge.sample().unwrap().channels[0].force,
        Some(Force::Newtons(19.6133))
    );
    assert!(matches!(gauge.sample(), Err(DeviceFault::NoReading { .. })));
    script.done();
    assert!(
        gauge.encode(&[0.0], 0.01).is_err() && gauge.emergency().is_empty() && gauge.hold().is_ok()
    );
}
