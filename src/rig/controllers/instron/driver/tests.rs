//! Transcripts of a console: a ramp read back before it starts, glitches to zero, silences, trips.

use super::*;
use crate::testing::rig::{ScriptedPort, Transcript, VirtualClock};

const T: f64 = 0.5;
const RAMP: &str = "P909,1 C904,0 C1,0 C300,1 C2,1,3 C86,1,5.000 C4,1,0.05000000 P909,0 ";
const START: &str = "P909,1 C904,0 C1,1 P909,0 ";
const HOLD: &str = "P909,1 C904,0 C1,2 P909,0 ";

/// One round of status, movement, position and load.
fn round<'a>(
    script: &'a mut Transcript,
    movement: &str,
    position: &str,
    load: &str,
) -> &'a mut Transcript {
    script
        .on("Q22 ", "0")
        .on("Q1 ", movement)
        .on("Q134,1,0 ", position)
        .on("Q134,2,0 ", load)
}

fn text(frame: &[u8]) -> String {
    String::from_utf8(frame.to_vec())
        .unwrap()
        .replace("\r\n", " ")
}

fn console() -> (Instron, Transcript) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    let client = LineClient::new(Box::new(port.clone()), Box::new(clock), T);
    (Instron::new(client), Transcript::new(port, 0.02, text))
}

/// Both full scales, each asked twice.
fn full_scales(script: &mut Transcript) -> &mut Transcript {
    script
        .on("Q308,1 ", "0.1")
        .on("Q308,1 ", "0.1")
        .on("Q308,2 ", "50000")
        .on("Q308,2 ", "50000")
}

/// Full scale 100 mm and 50 kN; at rest at 1 % of each.
fn opened() -> (Instron, Transcript) {
    let (mut console, mut script) = console();
    round(full_scales(&mut script), "0", "0.01", "0.01");
    console.identify().unwrap();
    (console, script)
}

#[test]
fn readings_are_fractions_of_full_scale_and_polls_keep_their_distance() {
    let (mut console, mut script) = opened();
    round(&mut script, "1", "0.02500000", "-0.005");
    let sample = console.sample().unwrap();
    assert_eq!(
        (sample.channels[0].displacement, sample.channels[0].force),
        (Some(0.025 * 0.1), Some(Force::Newtons(-250.0)))
    );
    assert_eq!((sample.moving, sample.raw.len()), (Some(true), 4));
    script.done();
    let polls: Vec<f64> = script
        .port
        .sent()
        .iter()
        .filter(|(_, frame)| frame == b"Q22\r\n")
        .map(|(time, _)| *time)
        .collect();
    assert!(polls[1] - polls[0] >= 0.1 - 1e-9, "{polls:?}");
}

#[test]
fn a_ramp_is_read_back_before_it_starts() {
    let (mut console, mut script) = opened();
    // From 1 mm to 5 mm at 0.8 mm/s: 5 s.
    let going = console.encode(&[0.005], 0.0008).unwrap();
    assert_eq!((going.targets[0], going.speed), (0.005, 0.0008));
    assert_eq!(text(&going.frames.concat()), format!("{RAMP}{START}"));
    // The first set of commands is incomplete: the old target applies.
    script.on(RAMP, "").on("Q4,1 ", "0.01").on("Q86,1 ", "5");
    script.on(RAMP, "").on("Q4,1 ", "0.05").on("Q86,1 ", "5");
    // The first start command is lost.
    script
        .on(START, "")
        .on("Q1 ", "0")
        .on("Q134,1,0 ", "0.01")
        .on(START, "")
        .on("Q1 ", "1");
    console.start(&going).unwrap();
    script.done();
    assert_eq!(console.line_statistics().resent, 2);
}

/// The line has no checksum: one bit makes 8.01 of 0.01, and 0.05 of 0.01.
#[test]
fn a_ramp_never_follows_a_single_wrong_position() {
    for wrong in ["8.01", "0.05"] {
        let (mut console, mut script) = opened();
        round(&mut script, "0", "0.01", "0.01");
        console.sample().unwrap();
        round(&mut script, "0", wrong, "0.01");
        console.sample().unwrap();
        let going = console.encode(&[0.005], 0.0008).unwrap();
        assert_eq!(text(&going.frames.concat()), format!("{RAMP}{START}"));
    }
}

#[test]
fn a_ramp_that_is_never_read_back_is_never_started() {
    let (mut console, mut script) = opened();
    let going = console.encode(&[0.005], 0.0008).unwrap();
    for _ in 0..3 {
        script.on(RAMP, "").on("Q4,1 ", "0.5").on("Q86,1 ", "5");
    }
    assert!(matches!(
        console.start(&going),
        Err(DeviceFault::Refused { .. })
    ));
    script.done();
}

#[test]
fn a_move_states_the_values_of_its_bytes_and_is_never_faster_than_requested() {
    let (mut console, ..) = opened();
    for step in 0..500 {
        let (target, speed) = (
            f64::from(step) * 1.237e-5 - 0.002,
            1e-6 + f64::from(step) * 3.1e-6,
        );
        let going = console.encode(&[target], speed).unwrap();
        assert!(
            (going.targets[0] - target).abs() <= 0.5e-9 + 1e-15,
            "{target}"
        );
        assert!(going.speed <= speed, "{target} {speed}");
    }
    for (target, speed) in [
        (0.2, 1e-3),
        (f64::NAN, 1e-3),
        (0.0, 0.0),
        (0.0, f64::NAN),
        (0.0, -1.0),
    ] {
        assert!(
            matches!(console.encode(&[target], speed), Err(DeviceFault::Unfit(_))),
            "{target} {speed}"
        );
    }
}

#[test]
fn an_exact_zero_is_asked_again_and_believed_twice() {
    let (mut console, mut script) = opened();
    script
        .on("Q22 ", "0")
        .on("Q1 ", "0")
        .on("Q134,1,0 ", "0")
        .on("Q134,1,0 ", "0.012");
    script.on("Q134,2,0 ", "0.00000000").on("Q134,2,0 ", "-0.0");
    let sample = console.sample().unwrap();
    assert_eq!(
        (sample.channels[0].displacement, sample.channels[0].force),
        (Some(0.012 * 0.1), Some(Force::Newtons(0.0)))
    );
    // The load is now known to be zero: the question is not repeated without limit.
    round(&mut script, "0", "0.012", "0.0");
    console.sample().unwrap();
    script.done();
    assert_eq!(
        console.line_statistics().reread,
        1,
        "a true zero corrects nothing"
    );
}

#[test]
fn a_stop_that_is_a_glitch_is_asked_again() {
    let (mut console, mut script) = opened();
    round(&mut script, "1", "0.02", "0.02");
    assert_eq!(console.sample().unwrap().moving, Some(true));
    script
        .on("Q22 ", "0")
        .on("Q1 ", "0")
        .on("Q1 ", "1")
        .on("Q134,1,0 ", "0.02")
        .on("Q134,2,0 ", "0.02");
    assert_eq!(console.sample().unwrap().moving, Some(true));
    script.done();
}

#[test]
fn after_a_silence_only_the_second_of_two_lone_answers_counts() {
    let (mut console, mut script) = opened();
    script.on("Q22 ", "0").on("Q1 ", "0").on("Q134,1,0 ", "");
    script
        .on("Q134,1,0 ", "0.02")
        .on("Q134,1,0 ", "0.03")
        .on("Q134,2,0 ", "0.01");
    assert_eq!(
        console.sample().unwrap().channels[0].displacement,
        Some(0.003)
    );
    script.done();
    assert_eq!(console.line_statistics().resent, 1);
    // No reply at all: the time is bounded.
    let (mut console, script) = self::console();
    assert!(matches!(
        console.identify(),
        Err(DeviceFault::Silent { .. })
    ));
    assert_eq!(script.port.sent().len(), 4);
}

#[test]
fn what_is_no_number_is_no_reading() {
    for word in [
        "nan", "inf", "1e400", "0,05", "OVL", "9.91E999", "0.0.5", "--1", " ",
    ] {
        let (mut console, mut script) = opened();
        script.on("Q22 ", "0").on("Q1 ", "0").on("Q134,1,0 ", word);
        assert!(
            matches!(console.sample(), Err(DeviceFault::NoReading { .. })),
            "{word}"
        );
        script.done();
    }
}

#[test]
fn what_has_tripped_is_a_flag_or_makes_it_unfit() {
    let status = |word: u32| {
        let (mut console, mut script) = opened();
        script
            .on("Q22 ", &word.to_string())
            .on("Q1 ", "0")
            .on("Q134,1,0 ", "0.01")
            .on("Q134,2,0 ", "0.01");
        console.sample().map(|sample| sample.channels[0].flags)
    };
    assert!(status(6 << 9).unwrap().emergency_stop);
    assert!(status(1 << 9).unwrap().limit_high);
    assert_eq!(status(0x1E00).unwrap(), Flags::default());
    assert_eq!(
        status(8),
        Err(DeviceFault::Unfit("the actuator is off".to_owned()))
    );
    assert_eq!(
        status(7 << 9),
        Err(DeviceFault::Unfit("oil too hot".to_owned()))
    );
    let (mut console, mut script) = self::console();
    full_scales(&mut script)
        .on("Q22 ", "3072")
        .on("Q1 ", "0")
        .on("Q134,1,0 ", "0.01")
        .on("Q134,2,0 ", "0.01");
    assert_eq!(
        console.identify(),
        Err(DeviceFault::Unfit("emergency stop pushed".to_owned()))
    );
    let (mut console, mut script) = self::console();
    for _ in 0..4 {
        script.on("Q308,1 ", "0");
    }
    assert!(
        matches!(console.identify(), Err(DeviceFault::Unfit(_))),
        "a full scale of nothing"
    );
    script.done();
}

/// One bit makes 4.1 of 0.1: every reading and every target would be 41 times too large.
#[test]
fn a_full_scale_counts_when_two_answers_in_turn_give_it() {
    let (mut console, mut script) = console();
    for answer in ["0.1", "4.1", "0.1", "0.1"] {
        script.on("Q308,1 ", answer);
    }
    script.on("Q308,2 ", "50000").on("Q308,2 ", "50000");
    round(&mut script, "0", "0.01", "0.01");
    console.identify().unwrap();
    script.done();
    let (mut console, mut script) = self::console();
    for answer in ["0.1", "4.1", "0.1", "4.1"] {
        script.on("Q308,1 ", answer);
    }
    assert!(matches!(console.identify(), Err(DeviceFault::Unfit(_))));
    script.done();
}

#[test]
fn it_holds_in_words_that_are_wrapped_and_looks_whether_it_does() {
    let (mut console, mut script) = opened();
    script
        .on(HOLD, "")
        .on("Q1 ", "1")
        .on(HOLD, "")
        .on("Q1 ", "2");
    console.hold().unwrap();
    script.done();
    assert_eq!(text(&console.emergency()), HOLD);
}
