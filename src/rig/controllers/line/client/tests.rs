//! Requests with replies in pieces, noise, silence and disconnections.

use super::*;
use crate::safety::failpoint::without;
use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};

fn client() -> (LineClient, ScriptedPort, VirtualClock) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    (
        LineClient::new(Box::new(port.clone()), Box::new(clock.clone()), 0.5),
        port,
        clock,
    )
}

fn after(seconds: f64, bytes: &[u8]) -> Scripted {
    Scripted::After(seconds, bytes.to_vec())
}

/// Accepts lines that begin with `ok`.
fn ok(line: &[u8]) -> Answer<Vec<u8>> {
    if line.starts_with(b"ok") {
        Answer::Take(line.to_vec())
    } else {
        Answer::Ignore
    }
}

#[test]
fn bytes_one_at_a_time_and_two_lines_at_once_are_whole_lines() {
    let (mut client, port, _) = client();
    for byte in b"12.5\r\n" {
        port.send_unasked(&[after(0.01, &[*byte])]);
    }
    port.send_unasked(&[after(0.0, b"one\r\ntwo\r\nthr")]);
    assert_eq!(client.line(b"\r\n", 1.0).unwrap(), b"12.5");
    assert_eq!(client.line(b"\r\n", 1.0).unwrap(), b"one");
    assert_eq!(client.line(b"\r\n", 1.0).unwrap(), b"two");
    assert_eq!(
        client.line(b"\r\n", 1.0),
        Err(Missed::TimedOut),
        "never a part of a line"
    );
    port.send_unasked(&[after(0.5, b"ee\r\n")]);
    assert_eq!(
        client.line(b"\r\n", 3.0).unwrap(),
        b"three",
        "what came of it was kept"
    );
}

#[test]
fn a_line_without_end_is_thrown_away_and_the_next_is_good() {
    let (mut client, port, _) = client();
    for _ in 0..100 {
        port.send_unasked(&[after(0.0, &[b'x'; 100])]);
    }
    port.send_unasked(&[after(0.0, b"\r"), after(0.0, b"\n1.0\r\n")]);
    assert_eq!(client.line(b"\r\n", 1.0), Err(Missed::TooLong));
    assert!(
        client.waiting.len() <= LONGEST_LINE && client.waiting.capacity() < 2 * LONGEST_LINE + 1
    );
    assert_eq!(client.line(b"\r\n", 1.0).unwrap(), b"1.0");
    assert_eq!(client.line_statistics().ignored, 1);
    // The longest line with its ending fits; one byte more does not.
    for (length, fits) in [(LONGEST_LINE - 1, true), (LONGEST_LINE, false)] {
        let line = [vec![b'y'; length], b"\n".to_vec()].concat();
        port.send_unasked(&[after(0.0, &line)]);
        assert_eq!(client.line(b"\n", 2.0).is_ok(), fits);
    }
}

#[test]
fn a_frame_is_sent_again_after_one_two_and_four_timeouts_then_given_up() {
    let (mut client, port, clock) = client();
    let fault = client.exchange(b"?\n", b"\n", ok).unwrap_err();
    assert_eq!(fault, DeviceFault::Silent { seconds: 4.0 });
    let times: Vec<f64> = port
        .sent()
        .iter()
        .map(|(time, _)| (time * 1e6).round() / 1e6)
        .collect();
    assert_eq!(times, [0.0, 0.5, 1.0, 2.0]);
    assert!(port.sent().iter().all(|(_, frame)| frame == b"?\n"));
    assert!((clock.now() - 4.0).abs() < 1e-6, "bounded");
    assert_eq!(client.line_statistics().resent, 3);
}

#[test]
fn without_the_guard_a_lost_frame_is_the_end() {
    let lost_once = || {
        let (mut client, port, _) = client();
        port.reply(&[]);
        port.reply(&[after(0.1, b"ok\n")]);
        client.exchange(b"?\n", b"\n", ok)
    };
    assert_eq!(lost_once().unwrap(), b"ok");
    assert_eq!(
        without(Guarding::Resend, lost_once).unwrap_err(),
        DeviceFault::Silent { seconds: 0.5 }
    );
}

#[test]
fn what_does_not_answer_is_counted_and_does_not_prolong_the_wait() {
    let (mut client, port, clock) = client();
    port.reply(&[after(0.1, b"\0\xff noise\nbanner\n"), after(0.1, b"ok 7\n")]);
    assert_eq!(client.exchange(b"?\n", b"\n", ok).unwrap(), b"ok 7");
    assert_eq!(
        client.line_statistics(),
        LineStatistics {
            ignored: 2,
            ..LineStatistics::default()
        }
    );
    let began = clock.now();
    for _ in 0..1000 {
        port.send_unasked(&[after(0.01, b"banner\n")]);
    }
    assert_eq!(
        client.exchange_once(b"?\n", b"\n", ok),
        Err(DeviceFault::Silent { seconds: 0.5 })
    );
    assert!(clock.now() - began < 0.52 && port.sent().len() == 2);
    let refuse = |_: &[u8]| {
        Answer::<()>::Fault(DeviceFault::Refused {
            reason: "no".to_owned(),
        })
    };
    assert!(matches!(
        client.exchange(b"?\n", b"\n", refuse),
        Err(DeviceFault::Refused { .. })
    ));
}

#[test]
fn a_hangup_gives_the_last_line_first() {
    let (mut client, port, _) = client();
    port.send_unasked(&[after(0.1, b"last\n"), Scripted::HangUp]);
    assert_eq!(client.line(b"\n", 1.0).unwrap(), b"last");
    assert_eq!(
        client.line(b"\n", 1.0),
        Err(Missed::Lost("the other side closed it".to_owned()))
    );
    assert!(matches!(
        client.exchange(b"?", b"\n", ok),
        Err(DeviceFault::Lost { .. })
    ));
}

#[test]
fn exactly_so_many_bytes_or_none() {
    let (mut client, port, _) = client();
    port.send_unasked(&[after(0.1, &[1, 3, 4]), after(0.1, &[0, 0, 9])]);
    assert_eq!(client.exactly(5, 0.15), Err(Missed::TimedOut));
    assert_eq!(client.exactly(5, 1.0).unwrap(), [1, 3, 4, 0, 0]);
    assert_eq!(client.exactly(LONGEST_LINE + 1, 1.0), Err(Missed::TooLong));
    client.drain().unwrap();
    port.send_unasked(&[after(0.3, &[7]), after(0.3, &[8])]);
    client.until_quiet(0.4).unwrap();
    assert_eq!(client.exactly(1, client.now() + 1.0), Err(Missed::TimedOut));
}

#[test]
fn a_wish_to_hold_ends_a_wait_within_a_slice_and_does_not_stop_the_words_that_hold() {
    let (client, port, clock) = client();
    let stop_request = StopRequest::default();
    let mut client = client.observing(stop_request.clone());
    let at_once = stop_request.clone();
    port.send_unasked(&[after(0.2, b"banner\n")]);
    let fault = client.exchange(b"?\n", b"\n", |_| {
        at_once.hold_now();
        Answer::<()>::Ignore
    });
    assert_eq!(fault, Err(DeviceFault::Interrupted));
    assert!(clock.now() <= 0.2 + SLICE);
    assert_eq!(client.sleep(1.0), Err(DeviceFault::Interrupted));
    stop_request.acknowledge();
    port.reply(&[after(0.1, b"ok\n")]);
    assert!(client.exchange(b"!\n", b"\n", ok).is_ok());
}
