//! The board: jogs, limits, holds, resets, its settings and its dwell.

use super::*;
use crate::testing::emulator::elastic_rig;

fn replies_to(board: &mut (Grbl, EmulatedRig), bytes: &[u8]) -> String {
    String::from_utf8(board.0.receive(bytes, &mut board.1)).expect("text")
}

fn wait(board: &mut (Grbl, EmulatedRig), seconds: f64) -> String {
    let until = board.1.time() + seconds;
    board.1.advance(until);
    String::from_utf8(board.0.tick(&mut board.1)).expect("text")
}

fn board() -> (Grbl, EmulatedRig) {
    (Grbl::new("PSD-SIM"), elastic_rig().resting_at(&[-0.001]))
}

#[test]
fn a_jog_is_understood_at_once_and_done_later() {
    let mut board = board();
    assert_eq!(
        replies_to(&mut board, b"$J=G21G90G53X-2.2500F60.000\n"),
        "ok\r\n"
    );
    wait(&mut board, 0.5);
    assert_eq!(
        replies_to(&mut board, b"?"),
        "<Jog|MPos:-1.500,0.000,0.000|FS:60,0>\r\n"
    );
    wait(&mut board, 1.0);
    assert_eq!(
        replies_to(&mut board, b"?"),
        "<Idle|MPos:-2.250,0.000,0.000|FS:0,0>\r\n"
    );
    assert_eq!(
        replies_to(&mut board, b"$J=G91X-0.25F60\n$J=G91X-0.25F60\n"),
        "ok\r\nok\r\n",
        "the second is planned"
    );
    wait(&mut board, 0.3);
    wait(&mut board, 0.3);
    let near = |(target, wanted): (&f64, f64)| (target - wanted).abs() < 1e-12;
    assert!(
        board
            .1
            .targets()
            .iter()
            .zip([-0.002_25, -0.002_5, -0.002_75])
            .all(near),
        "{:?}",
        board.1.targets()
    );
    assert_eq!(board.1.targets().len(), 3);
}

#[test]
fn a_target_beyond_the_travel_is_refused_and_counted() {
    let mut board = board();
    for beyond in ["0.001", "-200.001", "-1000"] {
        assert_eq!(
            replies_to(&mut board, format!("$J=G21G90G53X{beyond}F60\n").as_bytes()),
            "error:15\r\n",
            "{beyond}"
        );
    }
    // 0.001 mm is within the limits of the test, the other targets are not.
    assert_eq!((board.1.violations().len(), board.1.moves().len()), (2, 0));
    for within in ["0.000", "-1.000"] {
        assert_eq!(
            replies_to(&mut board, format!("$J=G21G90G53X{within}F60\n").as_bytes()),
            "ok\r\n",
            "{within}"
        );
    }
    assert_eq!(board.1.violations().len(), 2);
    for (line, answer) in [
        ("$J=X-1", "error:22"),
        ("$J=F60", "error:16"),
        ("$J=X1e0F60", "error:20"),
        ("$J=X-F60", "error:2"),
        ("$Q", "error:3"),
        ("", "ok"),
        ("G1X0", "error:9"),
    ] {
        assert_eq!(
            replies_to(&mut board, format!("{line}\r").as_bytes()),
            format!("{answer}\r\n"),
            "{line}"
        );
    }
    assert_eq!(
        replies_to(&mut board, &[[b'x'; 100].as_slice(), b"\n"].concat()),
        "error:11\r\n"
    );
}

#[test]
fn a_hold_cancels_the_jog_and_at_rest_stays_until_it_is_let_go() {
    let mut board = board();
    replies_to(&mut board, b"$J=X-6F60\n");
    wait(&mut board, 1.0);
    assert_eq!(
        replies_to(&mut board, b"!?"),
        "<Idle|MPos:-2.000,0.000,0.000|FS:0,0>\r\n"
    );
    assert_eq!(
        replies_to(&mut board, b"!?"),
        "<Hold:0|MPos:-2.000,0.000,0.000|FS:0,0>\r\n"
    );
    assert_eq!(replies_to(&mut board, b"$J=X-6F60\n"), "error:8\r\n");
    assert_eq!(replies_to(&mut board, b"~$J=X-6F60\n"), "ok\r\n");
    assert_eq!(
        replies_to(&mut board, b"\x85?"),
        "<Idle|MPos:-2.000,0.000,0.000|FS:0,0>\r\n"
    );
}

#[test]
fn a_reset_in_motion_is_an_alarm() {
    let mut board = board();
    assert_eq!(
        replies_to(&mut board, b"\x18"),
        "\r\nGrbl 1.1h ['$' for help]\r\n"
    );
    replies_to(&mut board, b"$J=X-6F60\n");
    assert!(replies_to(&mut board, b"\x18").starts_with("ALARM:3\r\n\r\nGrbl 1.1h "));
    assert_eq!(replies_to(&mut board, b"$J=X-6F60\n"), "error:8\r\n");
    assert_eq!(
        replies_to(&mut board, b"$X\n"),
        "[MSG:Caution: Unlocked]\r\nok\r\n"
    );
    assert_eq!(
        replies_to(&mut board, b"!\x18?"),
        "\r\nGrbl 1.1h ['$' for help]\r\n<Idle|MPos:-1.000,0.000,0.000|FS:0,0>\r\n"
    );
    assert_eq!(
        board.0.reboot(&mut board.1),
        b"\r\nGrbl 1.1h ['$' for help]\r\n[MSG:'$H'|'$X' to unlock]\r\n"
    );
    assert!(
        replies_to(&mut board, b"?").starts_with("<Alarm|"),
        "not homed"
    );
}

#[test]
fn it_reports_how_it_is_set_up() {
    let mut board = board();
    let settings = replies_to(&mut board, b"$$\n");
    for setting in [
        "$1=255\r\n",
        "$13=0\r\n",
        "$20=1\r\n",
        "$21=1\r\n",
        "$22=1\r\n",
        "$110=600.000\r\n",
        "$130=200.000\r\n",
    ] {
        assert!(
            settings.contains(setting),
            "{setting} is not in\n{settings}"
        );
    }
    assert!(replies_to(&mut board, b"$I\n").starts_with("[VER:1.1h.20190825:PSD-SIM]\r\n"));
}

#[test]
fn a_dwell_answers_once_the_axis_is_at_rest() {
    let mut board = board();
    assert_eq!(replies_to(&mut board, b"$J=X-1.5F60\nG4P0.01\n"), "ok\r\n");
    assert_eq!(wait(&mut board, 0.4), "");
    assert_eq!(wait(&mut board, 0.2), "");
    assert_eq!(wait(&mut board, 0.02), "ok\r\n");
}
