//! Transcripts of Grbl: commands, replies, and their meaning.

use super::*;
use crate::testing::rig::{Scripted, ScriptedPort, VirtualClock};
use psd_plan::Limits;

const SETTINGS: &str =
    "$1=255\r\n$10=1\r\n$13=0\r\n$20=1\r\n$21=1\r\n$22=1\r\n$100=400.000\r\n$110=500.000\r\nok\r\n";

fn device() -> (GrblDevice, ScriptedPort) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    (
        GrblDevice::new(LineClient::new(
            Box::new(port.clone()),
            Box::new(clock),
            0.25,
        )),
        port,
    )
}

fn reply(port: &ScriptedPort, text: &str) {
    port.reply(&[Scripted::After(0.01, text.as_bytes().to_vec())]);
}

fn status(port: &ScriptedPort, state: &str, x: f64) {
    reply(
        port,
        &format!("<{state}|MPos:{x:.3},0.000,0.000|FS:0,0>\r\n"),
    );
}

/// The replies during identification, up to the settings: the first status alone is not trusted.
fn introduce(port: &ScriptedPort, settings: &str) {
    for _ in 0..3 {
        status(port, "Idle", 0.0);
    }
    reply(
        port,
        "[VER:1.1h.20190825:PSD-SIM-G]\r\n[OPT:V,15,128]\r\nok\r\n",
    );
    reply(port, settings);
}

fn identified() -> (GrblDevice, ScriptedPort) {
    let (mut device, port) = device();
    introduce(&port, SETTINGS);
    device.identify().unwrap();
    (device, port)
}

fn sent(port: &ScriptedPort) -> Vec<String> {
    port.sent()
        .into_iter()
        .map(|(_, bytes)| String::from_utf8(bytes).unwrap())
        .collect()
}

fn reason<T: std::fmt::Debug>(outcome: Result<T, DeviceFault>) -> String {
    outcome.unwrap_err().to_string()
}

#[test]
fn it_identifies_itself_and_its_settings_are_checked() {
    let (mut device, port) = device();
    introduce(&port, SETTINGS);
    let identity = device.identify().unwrap();
    assert_eq!(
        (identity.model.as_str(), identity.firmware.as_str()),
        ("Grbl", "1.1h.20190825")
    );
    assert_eq!(
        (identity.serial.as_str(), identity.simulated),
        ("PSD-SIM-G", true)
    );
    assert_eq!(sent(&port), ["?", "?", "?", "$I\n", "$$\n"]);
    assert_eq!(
        device.line_statistics(),
        LineStatistics::default(),
        "an answer of many lines has nothing that is ignored"
    );
    assert!(device.narrow_limits(&[Limits::NONE]).is_ok());
}

#[test]
fn every_wrong_setting_is_named_with_the_line_that_corrects_it() {
    for (right, wrong, named) in [
        ("$1=255", "$1=25", "`$1=255`"),
        ("$10=1", "$10=2", "`$10=1`"),
        ("$13=0", "$13=1", "`$13=0`"),
        ("$20=1", "$20=0", "`$20=1`"),
        ("$21=1", "$21=0", "`$21=1`"),
        ("$22=1\r\n", "", "$22 is missing"),
    ] {
        let (mut device, port) = device();
        introduce(&port, &SETTINGS.replacen(right, wrong, 1));
        let reason = reason(device.identify());
        assert!(reason.contains(named), "{reason}");
        assert_eq!(reason.matches("send").count(), 1, "{reason}");
    }
    let (mut device, port) = device();
    introduce(&port, &SETTINGS.replace("$10=1", "$10=3"));
    assert!(device.identify().is_ok(), "machine positions and buffers");
}

#[test]
fn a_frame_that_is_not_at_rest_and_free_is_unfit() {
    for (state, expected) in [
        ("Alarm", "$H"),
        ("Hold:0", "`--let-go`"),
        ("Sleep", "asleep"),
        ("Door:1", "door"),
        ("Check", "$C"),
    ] {
        let (mut device, port) = device();
        for _ in 0..3 {
            status(&port, state, 0.0);
        }
        let reason = reason(device.identify());
        assert!(reason.contains(expected), "{reason}");
        assert!(
            sent(&port).iter().all(|bytes| bytes == "?"),
            "nothing but questions was sent"
        );
    }
}

#[test]
fn a_frame_that_is_found_moving_is_held() {
    let (mut device, port) = device();
    for state in ["Jog", "Jog", "Jog"] {
        status(&port, state, 0.0);
    }
    port.reply(&[]);
    for state in ["Hold:1", "Idle", "Idle"] {
        status(&port, state, 0.0);
    }
    let reason = reason(device.identify());
    assert!(reason.ends_with("rig put on hold"), "{reason}");
    assert_eq!(sent(&port).iter().filter(|bytes| *bytes == "!").count(), 1);
}

#[test]
fn a_start_while_its_port_is_opened_is_no_loss_and_later_it_is() {
    let (mut device, port) = device();
    port.reply(&[]);
    reply(&port, "\r\nGrbl 1.1h ['$' for help]\r\n");
    introduce(&port, SETTINGS);
    device.identify().unwrap();
    reply(&port, "<Idle|MPos:0.0\r\nGrbl 1.1h ['$' for help]\r\n");
    assert!(matches!(device.sample(), Err(DeviceFault::Rebooted { .. })));
    let going = device.encode(&[0.001], 1e-3).unwrap();
    status(&port, "Idle", 0.0);
    reply(&port, "Grbl 1.1h ['$' for help]\r\n");
    assert!(matches!(
        device.start(&going),
        Err(DeviceFault::Rebooted { .. })
    ));
}

#[test]
fn a_jog_is_accepted_when_the_axis_shows_it() {
    let (mut device, port) = identified();
    let going = device.encode(&[1.25e-3], 0.5e-3).unwrap();
    assert_eq!(
        (going.targets[0], going.speed, going.id),
        (1.25e-3, 0.5e-3, None)
    );
    status(&port, "Idle", 0.0);
    reply(&port, "ok<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n");
    status(&port, "Jog", 0.01);
    device.start(&going).unwrap();
    assert_eq!(sent(&port)[5..], ["?", "$J=G21G90G53X1.2500F30.000\n", "?"]);
    status(&port, "Jog", 0.75);
    let sample = device.sample().unwrap();
    assert_eq!(
        (
            sample.channels[0].displacement,
            sample.moving,
            sample.channels[0].force
        ),
        (Some(0.75e-3), Some(true), None)
    );
    status(&port, "Idle", 1.25);
    let sample = device.sample().unwrap();
    assert_eq!(
        (sample.channels[0].displacement, sample.moving),
        (Some(1.25e-3), Some(false))
    );
    assert_eq!(sample.raw, [b"<Idle|MPos:1.250,0.000,0.000|FS:0,0>\r"]);
}

#[test]
fn an_ok_without_motion_is_not_believed_unless_it_is_there() {
    let (mut device, port) = identified();
    let going = device.encode(&[0.001], 1e-3).unwrap();
    status(&port, "Idle", 0.0);
    reply(&port, "ok\r\n");
    status(&port, "Idle", 0.0);
    assert!(reason(device.start(&going)).contains("did not move"));
    let (mut device, port) = identified();
    status(&port, "Idle", 0.998);
    reply(&port, "ok\r\n");
    status(&port, "Idle", 0.998);
    assert!(
        device.start(&going).is_ok(),
        "nearer than a step of 1/400 mm"
    );
}

#[test]
fn refusals_are_reported_in_words() {
    for (answer, expected) in [
        ("error:15\r\n", "outside its travel"),
        ("error:9\r\n", "alarm"),
        ("ALARM:1\r\n", "limit switch"),
    ] {
        let (mut device, port) = identified();
        let going = device.encode(&[0.5], 1e-3).unwrap();
        status(&port, "Idle", 0.0);
        reply(&port, answer);
        let fault = device.start(&going).unwrap_err();
        assert!(
            matches!(&fault, DeviceFault::Refused { reason } if reason.contains(expected)),
            "{fault}"
        );
    }
    let (mut device, _) = identified();
    assert!(
        reason(device.encode(&[0.001], 0.009)).contains("$110"),
        "it would go slower and say nothing"
    );
    assert!(reason(device.encode(&[0.001], 1e-5)).contains("lowest speed"));
}

#[test]
fn a_hold_ends_a_jog_and_the_next_jog_begins_at_once() {
    let (mut device, port) = identified();
    port.reply(&[]);
    status(&port, "Jog", 0.5);
    status(&port, "Idle", 0.52);
    device.hold().unwrap();
    assert_eq!(sent(&port)[5..], ["!", "?", "?"]);
    let going = device.encode(&[0.0], 1e-3).unwrap();
    status(&port, "Idle", 0.52);
    reply(&port, "ok\r\n");
    status(&port, "Jog", 0.5);
    device.start(&going).unwrap();
    assert_eq!(device.emergency(), b"!");
}

#[test]
fn an_axis_held_at_rest_is_let_go_of_by_who_held_it_and_by_nobody_else() {
    let (mut device, port) = identified();
    let going = device.encode(&[0.001], 1e-3).unwrap();
    status(&port, "Hold:0", 0.0);
    assert!(reason(device.start(&going)).contains("not by psd"));
    port.reply(&[]);
    status(&port, "Hold:0", 0.0);
    port.reply(&[]);
    status(&port, "Idle", 0.0);
    device.hold().unwrap();
    assert_eq!(
        sent(&port)[6..],
        ["!", "?", "~", "?"],
        "it is loaded and idle"
    );
    status(&port, "Idle", 0.0);
    reply(&port, "ok\r\n");
    status(&port, "Jog", 0.0);
    device.start(&going).unwrap();
}

#[test]
fn a_jog_without_answer_is_never_let_loose() {
    let (mut device, port) = identified();
    let going = device.encode(&[0.001], 1e-3).unwrap();
    status(&port, "Idle", 0.0);
    assert_eq!(
        device.start(&going),
        Err(DeviceFault::Silent { seconds: 2.0 })
    );
    port.reply(&[]);
    status(&port, "Hold:0", 0.0);
    device.hold().unwrap();
    status(&port, "Hold:0", 0.0);
    assert!(reason(device.start(&going)).contains("may be pending in it"));
    assert!(!sent(&port).contains(&"~".to_owned()));
}

#[test]
fn a_late_status_is_not_accepted_as_a_fresh_one() {
    let (mut device, port) = identified();
    port.reply(&[Scripted::After(
        0.4,
        b"<Idle|MPos:0.000,0.000,0.000>\r\n".to_vec(),
    )]);
    status(&port, "Idle", 1.0);
    status(&port, "Idle", 1.0);
    assert_eq!(
        device.sample().unwrap().channels[0].displacement,
        Some(1e-3)
    );
    assert_eq!(device.line_statistics().resent, 1);
}

/// The replies of a board that is in hold at 1 mm when it is opened with a request to clear the hold, up to the reply to the reset.
fn held_and_let_go(answer: &str) -> (GrblDevice, ScriptedPort) {
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    let client = LineClient::new(Box::new(port.clone()), Box::new(clock), 0.25)
        .observing(crate::StopRequest::default().with_release_allowed(true));
    for _ in 0..4 {
        status(&port, "Hold:0", 1.0);
    }
    reply(&port, answer);
    (GrblDevice::new(client), port)
}

const BANNER: &str = "\r\nGrbl 1.1h ['$' for help]\r\n";

#[test]
fn a_held_axis_is_let_go_of_by_a_reset_at_rest_and_stays_where_it_is() {
    let (mut device, port) = held_and_let_go(BANNER);
    for _ in 0..2 {
        status(&port, "Idle", 1.0);
    }
    reply(
        &port,
        "[VER:1.1h.20190825:PSD-SIM-G]\r\n[OPT:V,15,128]\r\nok\r\n",
    );
    reply(&port, SETTINGS);
    let identity = device.identify().unwrap();
    assert_eq!(identity.boot, None, "psd itself reset it");
    assert_eq!(
        sent(&port),
        ["?", "?", "?", "?", "\u{18}", "?", "?", "$I\n", "$$\n"]
    );
}

#[test]
fn an_axis_that_lost_its_position_or_is_elsewhere_is_not_considered_cleared() {
    let (mut device, _port) = held_and_let_go(&format!("ALARM:3\r\n{BANNER}"));
    assert!(reason(device.identify()).contains("ALARM:3"));
    for (state, x) in [("Idle", 0.999), ("Alarm", 1.0), ("Hold:0", 1.0)] {
        let (mut device, port) = held_and_let_go(BANNER);
        for _ in 0..2 {
            status(&port, state, x);
        }
        let reason = reason(device.identify());
        assert!(reason.contains("home it (`$H`)"), "{state}: {reason}");
    }
    // The board still moves slowly: a reset would lose its position.
    let clock = VirtualClock::default();
    let port = ScriptedPort::new(&clock);
    let client = LineClient::new(Box::new(port.clone()), Box::new(clock), 0.25)
        .observing(crate::StopRequest::default().with_release_allowed(true));
    for x in [1.0, 1.0, 1.0, 1.001] {
        status(&port, "Hold:0", x);
    }
    assert!(reason(GrblDevice::new(client).identify()).contains("not at rest"));
    assert!(!sent(&port).contains(&"\u{18}".to_owned()));
}

#[test]
fn a_start_seen_while_its_port_is_opened_is_reported_as_one() {
    let (mut device, port) = device();
    reply(&port, BANNER);
    introduce(&port, SETTINGS);
    assert_eq!(
        device.identify().unwrap().boot.as_deref(),
        Some(crate::JUST_STARTED)
    );
    assert_eq!(device.line_statistics().ignored, 0);
}
