//! Transcripts of a session: proposals, refusals, a slow execution, replies to other transactions.

use super::*;
use crate::StopRequest;
use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};
use crate::transport::Clock as _;

const T: f64 = 1.0;
const POINT: &str = "MDL-00-01";

fn session() -> (Nees, ScriptedPort, VirtualClock, StopRequest) {
    let (clock, stop_request) = (VirtualClock::default(), StopRequest::default());
    let port = ScriptedPort::new(&clock);
    let client = LineClient::new(Box::new(port.clone()), Box::new(clock.clone()), T)
        .observing(stop_request.clone());
    (
        Nees::new(client, vec![POINT.to_owned()], 5.0),
        port,
        clock,
        stop_request,
    )
}

fn after(seconds: f64, text: &str) -> Scripted {
    Scripted::After(
        seconds,
        format!("{}\n", text.replace(' ', "\t")).into_bytes(),
    )
}

fn sent(port: &ScriptedPort) -> Vec<String> {
    port.sent()
        .iter()
        .map(|(_, frame)| String::from_utf8(frame.clone()).unwrap().replace('\t', " "))
        .collect()
}

/// At 1 mm and 100 N.
fn opened() -> (Nees, ScriptedPort, VirtualClock, StopRequest) {
    let (mut rig, port, clock, stop_request) = session();
    port.reply(&[after(0.1, "OK 0 hall")]);
    port.reply(&[after(0.1, "OK 0 yes")]);
    port.reply(&[after(
        0.1,
        "OK 0 psd-000002 MDL-00-01 x displacement 1.0E-03 x force 1.0E+02",
    )]);
    assert_eq!(
        rig.identify().unwrap().model,
        "NEES control point MDL-00-01: hall"
    );
    (rig, port, clock, stop_request)
}

#[test]
fn a_session_is_opened_and_read_before_anything_moves_and_closed_at_the_end() {
    let (rig, port, ..) = opened();
    drop(rig);
    let frames = [
        "open-session psd\n",
        "set-parameter psd-000001 nstep 1000000\n",
        "get-control-point psd-000002 MDL-00-01\n",
        "close-session psd\n",
    ];
    assert_eq!(sent(&port), frames);
}

#[test]
fn a_move_is_a_proposal_and_an_execution_that_is_waited_for() {
    let (mut rig, port, clock, _) = opened();
    let going = rig.encode(&[0.011], 0.001).unwrap();
    assert_eq!(going.targets[0], 0.011);
    // 10 mm at 1 mm/s: answered after 15 s, waited for 2 · 10 + 5 s.
    port.reply(&[after(0.1, "OK 0 psd-000003")]);
    port.reply(&[after(15.0, "OK 0 psd-000003")]);
    rig.start(&going).unwrap();
    assert!(clock.now() > 15.0);
    assert_eq!(
        sent(&port)[3..],
        [
            "propose psd-000003 MDL-00-01 x displacement 1.1000000000E-02\n",
            "execute psd-000003\n"
        ]
    );
    assert!(rig.emergency().is_empty(), "nothing is being executed");
    let going = rig.encode(&[0.011], 0.001).unwrap();
    let began = clock.now();
    port.reply(&[after(0.1, "OK 0 psd-000004")]);
    assert!(matches!(rig.start(&going), Err(DeviceFault::Silent { .. })));
    assert!(clock.now() - began < 26.0, "bounded");
    assert_eq!(rig.emergency(), b"cancel\tpsd-000004\n");
}

#[test]
fn a_proposal_that_is_refused_is_not_executed() {
    for refusal in [
        "NOT\u{a0}OK",
        "NOTOK 0",
        "NOTOK 3 psd-000003 beyond",
        "ERROR",
    ] {
        let (mut rig, port, ..) = opened();
        let going = rig.encode(&[0.002], 0.001).unwrap();
        port.reply(&[after(0.1, refusal)]);
        assert!(
            matches!(rig.start(&going), Err(DeviceFault::Refused { .. })),
            "{refusal}"
        );
        assert_eq!(sent(&port).len(), 4, "one proposal, no execution");
    }
}

#[test]
fn a_reply_to_another_transaction_is_counted_and_left() {
    let (mut rig, port, ..) = opened();
    port.reply(&[
        after(
            0.1,
            "OK 0 psd-000002 MDL-00-01 x displacement 9.0E-03 x force 9.0E+02",
        ),
        after(0.1, "NOTOK 1 psd-000001 late"),
        after(
            0.1,
            "OK 0 psd-000003 MDL-00-01 x displacement 2.0E-03 x force 2.0E+02",
        ),
    ]);
    let sample = rig.sample().unwrap();
    assert_eq!(
        (sample.channels[0].displacement, sample.channels[0].force),
        (Some(0.002), Some(Force::Newtons(200.0)))
    );
    assert_eq!(
        (
            sample.moving,
            sample.raw.len(),
            rig.line_statistics().ignored
        ),
        (Some(false), 1, 2)
    );
}

#[test]
fn what_is_no_number_is_no_reading() {
    for values in [
        "x displacement nan x force 1.0",
        "x displacement 1.0 x force inf",
        "x displacement 1,0 x force 1.0",
    ] {
        let (mut rig, port, ..) = opened();
        port.reply(&[after(0.1, &format!("OK 0 psd-000003 MDL-00-01 {values}"))]);
        assert!(
            matches!(rig.sample(), Err(DeviceFault::NoReading { .. })),
            "{values}"
        );
    }
    for values in [
        "x displacement 1.0",
        "x force 1.0",
        "x displacement 1.0 x force",
        "",
    ] {
        let (mut rig, port, ..) = opened();
        port.reply(&[after(0.1, &format!("OK 0 psd-000003 MDL-00-01 {values}"))]);
        assert!(
            matches!(rig.sample(), Err(DeviceFault::NoReading { .. })),
            "{values}"
        );
    }
}

#[test]
fn holding_cancels_an_execution_and_sends_nothing_at_rest() {
    let (mut rig, port, _, stop_request) = opened();
    rig.hold().unwrap();
    assert_eq!(sent(&port).len(), 3);
    let going = rig.encode(&[0.011], 0.001).unwrap();
    port.reply(&[after(0.1, "OK 0 psd-000003")]);
    stop_request.hold_now();
    assert_eq!(rig.start(&going), Err(DeviceFault::Interrupted));
    rig.hold().unwrap();
    assert_eq!(sent(&port).len(), 4, "not executed: nothing to cancel");
    stop_request.acknowledge();
    let going = rig.encode(&[0.011], 0.001).unwrap();
    port.reply(&[after(0.1, "OK 0 psd-000003"), after(0.1, "OK 0 psd-000004")]);
    assert!(matches!(rig.start(&going), Err(DeviceFault::Silent { .. })));
    assert_eq!(
        rig.sample(),
        Err(DeviceFault::Silent { seconds: T }),
        "it hears nothing yet"
    );
    // The reply to the execution arrives first.
    port.reply(&[
        after(0.1, "NOTOK 5 psd-000004 cancelled"),
        after(0.1, "OK 0 psd-000004"),
    ]);
    rig.hold().unwrap();
    assert_eq!(sent(&port).last().unwrap(), "cancel psd-000004\n");
    assert!(rig.emergency().is_empty());
}

#[test]
fn a_wrong_reading_makes_no_endless_wait() {
    let (mut rig, port, clock, _) = opened();
    port.reply(&[after(
        0.1,
        "OK 0 psd-000003 MDL-00-01 x displacement 1e300 x force 0",
    )]);
    rig.sample().unwrap();
    let going = rig.encode(&[0.011], 0.001).unwrap();
    port.reply(&[after(0.1, "OK 0 psd-000004")]);
    let began = clock.now();
    assert!(matches!(rig.start(&going), Err(DeviceFault::Silent { .. })));
    let waited = clock.now() - began;
    assert!((3600.0..3700.0).contains(&waited), "{waited}");
}

#[test]
fn the_late_answer_to_an_execution_reports_its_end() {
    let (mut rig, port, ..) = opened();
    let going = rig.encode(&[0.002], 0.001).unwrap();
    port.reply(&[after(0.1, "OK 0 psd-000003")]);
    assert!(matches!(rig.start(&going), Err(DeviceFault::Silent { .. })));
    let reading = "OK 0 psd-000004 MDL-00-01 x displacement 2.0E-03 x force 2.0E+02";
    port.reply(&[after(0.1, "OK 0 psd-000003"), after(0.1, reading)]);
    assert_eq!(rig.sample().unwrap().moving, Some(false));
    assert!(rig.emergency().is_empty() && rig.hold().is_ok());
    assert_eq!(port.sent().len(), 6, "nothing to cancel");
}

#[test]
fn targets_and_names_that_cannot_be_encoded_are_refused() {
    let (mut rig, ..) = opened();
    for (target, speed) in [
        (f64::NAN, 1e-3),
        (f64::INFINITY, 1e-3),
        (0.0, 0.0),
        (0.0, f64::NAN),
    ] {
        assert!(
            matches!(rig.encode(&[target], speed), Err(DeviceFault::Unfit(_))),
            "{target} {speed}"
        );
    }
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    let client = LineClient::new(Box::new(port.clone()), Box::new(clock), T);
    let mut rig = Nees::new(client, vec!["MDL\tx".to_owned()], 1.0);
    assert!(matches!(rig.identify(), Err(DeviceFault::Unfit(_))) && port.sent().is_empty());
}
