//! Tests of scripts: the meaning of each line, and invalid lines.

use super::*;

fn one(line: &str) -> ScriptedFault {
    let script = Script::parse(line).unwrap_or_else(|error| panic!("{line}: {error}"));
    script.faults.into_iter().next().expect("a fault")
}

#[test]
fn a_line_states_time_and_event() {
    let fault = one("after 12 moves: drop replies 3  # and why");
    assert_eq!(
        fault,
        ScriptedFault {
            on_load_cell: false,
            own_of: None,
            actuator: 0,
            when: When::AfterMoves(12),
            what: What::Replies(ReplyFault::Drop, Some(3))
        }
    );
    assert_eq!(one("at 4.5 s: hang up").when, When::At(4.5));
    assert_eq!(
        one("after 20 readings: spike 500 N").what,
        What::Rig(MechanicalFault::Spike(500.0))
    );
    assert_eq!(
        one("each reply: flip a bit with 0.01").when,
        When::EachReply(0.01)
    );
    assert_eq!(
        (
            one("at 0 s: axis 2 stick").actuator,
            one("at 0 s: stick").actuator
        ),
        (1, 0)
    );
    assert!(one("at 0 s: load cell split replies for ever every 1 bytes").on_load_cell);
    let names = [
        "actuator",
        "actuator of axis 2",
        "load cell of axis 1",
        "load cell of axis 2",
    ]
    .map(str::to_owned);
    let line_index = |text: &str| one(text).line_index(&names);
    assert_eq!(
        (
            line_index("at 0 s: hang up"),
            line_index("at 0 s: load cell hang up")
        ),
        (Some(0), Some(2))
    );
    assert_eq!(
        (
            line_index("at 0 s: actuator of axis 2 hang up"),
            line_index("at 0 s: load cell of axis 2 hang up")
        ),
        (Some(1), Some(3))
    );
    assert_eq!(line_index("at 0 s: load cell of axis 3 hang up"), None);
    assert_eq!(
        one("at 1 s: number \"\"").what,
        What::Rig(MechanicalFault::Number(String::new()))
    );
    let fill = ReplyFault::Garbage {
        count: 3,
        byte: Some(255),
        position: GarbagePosition::Inside,
    };
    assert_eq!(
        one("after 1 reply: fill 3 bytes of ff inside").what,
        What::Replies(fill, Some(1))
    );
    assert_eq!(
        one("at 0 s: coast 2 s").what,
        What::Rig(MechanicalFault::Coast(2.0))
    );
    assert_eq!(
        one("at 1 s: fracture at 3 mm to 10 %").what,
        What::Rig(MechanicalFault::Fracture {
            displacement: 0.003,
            left: 0.1
        })
    );
}

#[test]
fn every_line_of_the_description_is_read() {
    let text = include_str!("../script.rs");
    let described = text
        .lines()
        .skip_while(|line| *line != "//! ```text")
        .skip(1)
        .take_while(|line| *line != "//! ```");
    let mut count = 0;
    for phrase in described.flat_map(|line| line.trim_start_matches("//! ").split("  ")) {
        let phrase = phrase.split('(').next().unwrap_or_default().trim();
        if !phrase.is_empty() {
            let plain = phrase
                .replace("[of REPLIES]", "of REPLIES")
                .replace("[REPLIES]", "REPLIES");
            for replies in ["reply", "replies 3", "replies for ever"] {
                one(&format!("at 1 s: {}", plain.replace("REPLIES", replies)));
            }
            count += 1;
        }
    }
    assert_eq!(count, 32, "as many phrases as there are");
}

#[test]
fn a_wrong_line_is_named_with_its_reason() {
    let reason = |text: &str| Script::parse(text).expect_err(text).to_string();
    assert_eq!(
        reason("# fine\n\nat 1 s hang up"),
        "line 3: `:` is missing between the time and the fault"
    );
    assert_eq!(reason("at nan s: hang up"), "line 1: `nan` is not a number");
    assert_eq!(
        reason("at 1 ms: hang up"),
        "line 1: found `ms`, expected `s`"
    );
    assert_eq!(
        reason("after 3 steps: reboot"),
        "line 1: `steps` cannot be counted: write moves, readings or replies"
    );
    assert_eq!(reason("at 1 s: explode"), "line 1: unknown fault `explode`");
    assert_eq!(reason("at 1 s: reboot now"), "line 1: unexpected `now`");
    assert_eq!(
        reason("each reply: drop reply with 2"),
        "line 1: 2 is not a probability"
    );
    assert_eq!(
        reason("at 1 s: drop reply with 0.5"),
        "line 1: a probability requires `each reply` or `each reading`"
    );
    assert_eq!(
        reason("each reading: reboot"),
        "line 1: `each reading` allows only a spike or a bad number"
    );
    assert_eq!(
        reason("at 1 s: axis 0 stick"),
        "line 1: `0` is not an axis: the first is 1"
    );
    assert_eq!(
        reason("at 1 s: axis 2 reboot"),
        "line 1: only a fault of an actuator, its specimen or its sensors can have an axis"
    );
    assert_eq!(
        reason("at 1 s: drop replies"),
        "line 1: the line ends too early"
    );
}

#[test]
fn a_line_without_a_time_states_the_position_of_an_actuator() {
    let script =
        Script::parse("stands at 3 mm\naxis 2 stands at -41.7 mm  # unloaded\nat 0 s: stick")
            .unwrap();
    assert_eq!(
        (script.starts, script.faults.len()),
        (vec![(0, 0.003), (1, -0.0417)], 1)
    );
    for wrong in [
        "stands at 3",
        "stands at 3 um",
        "stands at 3 mm now",
        "axis 0 stands at 3 mm",
    ] {
        assert!(Script::parse(wrong).is_err(), "{wrong}");
    }
}
