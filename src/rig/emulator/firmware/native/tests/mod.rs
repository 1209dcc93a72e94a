//! Tests of the native firmware against the vectors and rules of the reference.

mod force_control;
mod several_axes;

use super::*;
use crate::testing::emulator::elastic_rig;

fn rig() -> (Native, EmulatedRig) {
    let emulated = elastic_rig();
    let settings = NativeSettings {
        boot: Some(0x7f3a),
        force_limits: vec![Interval {
            low: -2000.0,
            high: 12_000.0,
        }],
        ..Default::default()
    };
    (Native::new(settings, &emulated), emulated)
}

/// Returns the words of the answer to a request.
fn ask(rig: &mut (Native, EmulatedRig), body: &str) -> String {
    let reply = rig.0.receive(&sealed(body), &mut rig.1);
    let reply = String::from_utf8(reply).expect("text");
    let body = reply
        .strip_prefix('<')
        .and_then(|text| text.strip_suffix('\n'))
        .unwrap_or_else(|| panic!("a reply: `{reply}`"));
    let (body, crc) = body.split_once('*').expect("a checksum");
    assert_eq!(crc, format!("{:04X}", super::crc(body.as_bytes())));
    body.to_owned()
}

fn ready() -> (Native, EmulatedRig) {
    let mut rig = rig();
    ask(&mut rig, "HELLO 40");
    rig
}

#[test]
fn the_vectors_of_the_reference() {
    assert_eq!(crc(b"123456789"), 0x29b1);
    assert_eq!(
        sealed("MOVE 41 17 1.250000 0.500000"),
        b">MOVE 41 17 1.250000 0.500000*6858\n"
    );
    assert_eq!(sealed("MEAS 42 5"), b">MEAS 42 5*5976\n");
    let (mut firmware, mut emulated) = ready();
    let reply = firmware.receive(b">MOVE 41 17 1.250000 0.500000*6858\n", &mut emulated);
    assert_eq!(reply, b"<ACK 41 7F3A MOVING*1F01\n");
    let data = b"DATA 42 7F3A 118203 1.249871 512.375 812344 0x0000 IDLE";
    assert_eq!(crc(data), 0x788b);
}

#[test]
fn hello_states_identity_limits_and_last_target() {
    let mut rig = rig();
    let bounds = "-1.000000 10.000000 -2000.000 12000.000 10.000000";
    assert_eq!(
        ask(&mut rig, "HELLO 7"),
        format!("ACK 7 7F3A PSD-SIM 0042 1.3 {bounds} 0 0.000000")
    );
    assert_eq!(
        ask(&mut rig, "MOVE 8 17 1.250000 0.500000"),
        "ACK 8 7F3A MOVING"
    );
    assert_eq!(
        ask(&mut rig, "HELLO 1"),
        format!("ACK 1 7F3A PSD-SIM 0042 1.3 {bounds} 17 1.250000")
    );
    let longest = ask(&mut rig, "HELLO 1").len() + "<*0000\n".len();
    assert!(longest <= LONGEST, "{longest} bytes");
}

#[test]
fn the_same_request_again_is_answered_again_and_does_nothing() {
    let mut rig = ready();
    let first = ask(&mut rig, "MOVE 41 17 1.250000 10.000000");
    rig.1.advance(2.0);
    assert_eq!(ask(&mut rig, "MOVE 41 17 1.250000 10.000000"), first);
    assert_eq!(
        ask(&mut rig, "MOVE 42 17 1.250000 10.000000"),
        "ACK 42 7F3A IDLE",
        "the same move under another number"
    );
    assert_eq!(rig.1.moves().len(), 1);
    let reading = ask(&mut rig, "MEAS 43 5");
    assert_eq!(
        reading,
        "DATA 43 7F3A 2000 1.250000 125.000 -11500 0x0000 IDLE"
    );
    rig.1.advance(2.5);
    assert_eq!(ask(&mut rig, "MEAS 43 5"), reading, "not measured again");
    assert_eq!(rig.1.readings(), 5);
}

#[test]
fn what_it_cannot_do_exactly_it_refuses() {
    let mut rig = rig();
    assert_eq!(ask(&mut rig, "STAT 1"), "ERR 1 7F3A SEQ", "no HELLO yet");
    ask(&mut rig, "HELLO 0");
    let cases = [
        ("STAT 2", "SEQ"),
        ("MOVE 1 1 10.000001 1.000000", "LIMIT"),
        ("MOVE 2 1 -1.000001 1.000000", "LIMIT"),
        ("MOVE 3 1 5.000000 10.000001", "RATE"),
        ("MOVE 4 1 5.000000 0.000000", "RATE"),
        ("MOVE 5 1 nan 1.000000", "ARG"),
        ("MOVE 6 1 1e0 1.000000", "ARG"),
        ("MOVE 7 1 5.000000", "ARG"),
        ("DANCE 8", "VERB"),
        ("MEAS 9 0", "ARG"),
        ("LIM 10 -1.000001 10.000000 0.000 1.000 1.000000", "LIMIT"),
    ];
    for (request, code) in cases {
        let sequence = request.split(' ').nth(1).expect("a number");
        assert_eq!(
            ask(&mut rig, request),
            format!("ERR {sequence} 7F3A {code}"),
            "{request}"
        );
    }
    assert!(rig.1.moves().is_empty() && rig.1.violations() == [0.010_000_001, -0.001_000_001]);
    assert_eq!(
        ask(&mut rig, "MOVE 11 5 10.000000 10.000000"),
        "ACK 11 7F3A MOVING",
        "a limit is within"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 12 6 1.000000 10.000000"),
        "ERR 12 7F3A BUSY"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 13 5 1.000000 10.000000"),
        "ERR 13 7F3A ID"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 14 4 1.000000 10.000000"),
        "ERR 14 7F3A ID"
    );
}

#[test]
fn limits_of_a_run_are_only_narrower_and_end_with_it() {
    let mut rig = ready();
    assert_eq!(
        ask(
            &mut rig,
            "LIM 41 0.000000 2.000000 -100.000 100.000 1.000000"
        ),
        "ACK 41 7F3A IDLE"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 42 1 2.000001 1.000000"),
        "ERR 42 7F3A LIMIT"
    );
    assert!(
        rig.1.violations().is_empty(),
        "within what the bench may do"
    );
    assert_eq!(
        ask(&mut rig, "MOVE 43 1 1.000000 1.000001"),
        "ERR 43 7F3A RATE"
    );
    ask(&mut rig, "HELLO 1");
    assert_eq!(
        ask(&mut rig, "MOVE 2 1 2.000001 1.000000"),
        "ACK 2 7F3A MOVING"
    );
}

#[test]
fn an_exclamation_mark_anywhere_holds_at_once() {
    let mut rig = ready();
    ask(&mut rig, "MOVE 41 1 5.000000 1.000000");
    rig.1.advance(1.0);
    let reply = rig.0.receive(b">STA!", &mut rig.1);
    assert!(reply.is_empty() && !rig.1.moving());
    let rest = sealed("STAT 42").split_off(">STA".len());
    let reply = rig.0.receive(&rest, &mut rig.1);
    assert!(
        reply.starts_with(b"<ACK 42 7F3A HELD 0x0000*"),
        "{}",
        reply.escape_ascii()
    );
    assert_eq!(
        ask(&mut rig, "MOVE 43 2 6.000000 1.000000"),
        "ERR 43 7F3A HELD"
    );
    assert_eq!(ask(&mut rig, "CLR 44"), "ACK 44 7F3A IDLE");
    assert!(!rig.1.moving(), "nothing goes on by itself");
    assert_eq!(
        ask(&mut rig, "MOVE 45 2 6.000000 1.000000"),
        "ACK 45 7F3A MOVING"
    );
    assert_eq!(ask(&mut rig, "STOP 46"), "ACK 46 7F3A HELD");
}

#[test]
fn silence_holds_until_it_is_cleared() {
    let mut rig = ready();
    ask(&mut rig, "MOVE 41 1 10.000000 1.000000");
    rig.1.advance(3.0);
    rig.0.tick(&mut rig.1);
    assert!(rig.1.moving());
    // An invalid frame does not count as a heartbeat.
    rig.0.receive(b">STAT 42*0000\n", &mut rig.1);
    rig.1.advance(3.001);
    rig.0.tick(&mut rig.1);
    assert!(!rig.1.moving());
    assert_eq!(ask(&mut rig, "STAT 42"), "ACK 42 7F3A HELD 0x0080");
    assert_eq!(
        ask(&mut rig, "MOVE 43 2 6.000000 1.000000"),
        "ERR 43 7F3A HELD"
    );
    ask(&mut rig, "CLR 44");
    assert_eq!(ask(&mut rig, "STAT 45"), "ACK 45 7F3A IDLE 0x0000");
}

#[test]
fn broken_and_overlong_frames_are_not_answered() {
    let (mut firmware, mut emulated) = ready();
    let mut bytes = sealed("STAT 41");
    for at in 0..bytes.len() - 1 {
        for bit in 0..8 {
            bytes[at] ^= 1 << bit;
            let answer = firmware.receive(&bytes, &mut emulated);
            assert!(answer.is_empty(), "{}", answer.escape_ascii());
            firmware.receive(b"\n", &mut emulated);
            bytes[at] ^= 1 << bit;
        }
    }
    let long = vec![b'>'; 1 << 20];
    assert!(firmware.receive(&long, &mut emulated).is_empty() && firmware.line.len() <= LONGEST);
    assert!(firmware.receive(b"\n", &mut emulated).is_empty());
    assert!(
        firmware
            .receive(&bytes, &mut emulated)
            .starts_with(b"<ACK 41 7F3A ")
    );
}

#[test]
fn a_new_power_up_has_another_word_and_trusts_nothing() {
    let mut rig = ready();
    ask(&mut rig, "MOVE 41 3 5.000000 1.000000");
    rig.0.reboot(&mut rig.1);
    let hello = ask(&mut rig, "HELLO 1");
    assert!(
        !rig.1.moving() && !hello.contains("7F3A") && hello.ends_with(" 0 0.000000"),
        "{hello}"
    );
    assert!(ask(&mut rig, "STAT 2").ends_with("IDLE 0x0020"));
    assert!(ask(&mut rig, "MOVE 3 1 1.000000 1.000000").ends_with(" REF"));
    ask(&mut rig, "REF 4 token-1");
    assert!(ask(&mut rig, "MOVE 5 1 1.000000 1.000000").ends_with(" MOVING"));
}
