//! Faults on the line of a rig with numbered and check-summed frames: silence, partial replies, garbage, flipped bits, replies out of
//! order. In: runs with such a line. Out: the same numbers as on a sound line, or a rig on hold.

pub(super) mod unnumbered;

use super::stage::{
    Ended, REPLY_TIMEOUT, emulator, link, open, plan, plan_of, run, run_without, to,
};
use psd_plan::record::EventKind;
use psd_rig::controllers::LONGEST_LINE;
use psd_rig::emulator::Log;
use psd_rig::safety::failpoint::{Guarding, without};
use psd_rig::{LineStatistics, Rig as _};

/// Times at which a frame was sent, with the frame, from the first that contains `part`.
fn sent<'a>(ended: &'a Ended, part: &str) -> Vec<(f64, &'a str)> {
    let frames = ended
        .log
        .lines()
        .filter_map(|line| line.split_once(" actuator > "));
    let frames = frames.map(|(time, frame)| (time.parse().unwrap(), frame));
    frames
        .skip_while(|(_, frame)| !frame.contains(part))
        .collect()
}

#[test]
fn a_reply_that_never_comes_is_asked_for_at_t_2t_and_4t_and_then_the_rig_is_held() {
    let ended = run(&plan(), "after 3 moves: drop replies for ever");
    ended.held();
    assert!(
        ended.reason().contains("no usable answer within 0.8 s"),
        "{}",
        ended.reason()
    );
    let frames = sent(&ended, "MOVE");
    let third = frames
        .iter()
        .filter(|(_, frame)| frame.contains("MOVE"))
        .nth(2)
        .unwrap();
    let same: Vec<f64> = frames
        .iter()
        .filter(|(_, frame)| frame == &third.1)
        .map(|(time, _)| (time - third.0) / REPLY_TIMEOUT)
        .collect();
    for (at, expected) in same.iter().zip([0.0, 1.0, 2.0, 4.0]) {
        assert!((at - expected).abs() < 0.1, "{same:?}");
    }
    assert_eq!(same.len(), 4);
    // The first `!` after 8 T, whether or not it is answered.
    let held = frames
        .iter()
        .find(|(_, frame)| frame.starts_with('!'))
        .unwrap()
        .0;
    assert!(((held - third.0) / REPLY_TIMEOUT - 8.0).abs() < 0.2);
    // psd waits for its answer for the same time: the last frame is sent after 12 T, the program ends after 16.
    let last = frames.last().unwrap().0;
    assert!(
        ((last - third.0) / REPLY_TIMEOUT - 12.0).abs() < 0.3,
        "{}",
        (last - third.0) / REPLY_TIMEOUT
    );
    assert_eq!(
        ended.emulator.lock().rig().moves().len(),
        3,
        "the move itself was begun once"
    );

    // One lost reply is recovered, and page one of the report states this.
    let once = run(&plan(), "after 3 moves: drop reply");
    once.sound();
    assert_eq!(
        once.line_statistics,
        LineStatistics {
            resent: 1,
            ..LineStatistics::default()
        }
    );
    assert_eq!(once.events(EventKind::Recovered), ["1 frame sent again"]);
    assert!(run(&plan(), "").events(EventKind::Recovered).is_empty());
    run_without(Guarding::Resend, &plan(), "after 3 moves: drop reply").held();
}

#[test]
fn a_reply_in_any_two_pieces_or_byte_by_byte_is_the_same_reply() {
    let short = plan_of(vec![to(2e-4)]);
    for at in 1..60 {
        let ended = run(
            &short,
            &format!(
                "after 8 replies: split reply at {at} bytes\nafter 12 replies: split reply at {at} bytes"
            ),
        );
        ended.sound();
        assert_eq!(
            ended.line_statistics,
            LineStatistics::default(),
            "nothing was missing"
        );
    }
    // At 20 ms a byte a reply takes more than a second.
    let mut patient = short;
    link(&mut patient).actuator.reply_timeout = 2.0;
    run(&patient, "after 8 replies: split replies 5 every 1 bytes").sound();
}

#[test]
fn a_reply_cut_anywhere_is_never_a_shorter_number() {
    let short = plan_of(vec![to(2e-4)]);
    for at in 1..60 {
        let ended = run(
            &short,
            &format!("after 12 replies: cut reply at {at} bytes"),
        );
        ended.sound();
        // Without a line end between them, the rest of the cut reply also spoils the next reply.
        assert!(ended.line_statistics.resent <= 2);
    }
}

#[test]
fn garbage_of_any_kind_is_counted_and_none_of_it_is_used() {
    for dirt in [
        "garbage 40 bytes",
        "fill 3 bytes of 00",
        "fill 3 bytes of ff",
        "fill 3 bytes of 0a",
        "fill 600 bytes of 41",
    ] {
        for where_in_reply in ["before", "inside", "after"] {
            let ended = run(
                &plan(),
                &format!(
                    "after 10 replies: {dirt} {where_in_reply}\nafter 20 replies: {dirt} {where_in_reply}"
                ),
            );
            ended.sound();
            let LineStatistics {
                resent, ignored, ..
            } = ended.line_statistics;
            assert!(
                resent + ignored > 0 || dirt.contains("0a"),
                "{dirt} {where_in_reply}"
            );
        }
    }
    let megabyte = run(&plan(), "after 20 replies: fill 1048576 bytes of 41 before");
    assert!(megabyte.log.len() > 1 << 20);
    // At 115200 baud it takes a minute and a half to arrive. This exceeds every time-out, so the rig is put on hold.
    assert!(
        megabyte.reason().contains("no usable answer"),
        "{}",
        megabyte.reason()
    );
    let raw = megabyte
        .lines
        .iter()
        .map(|line| line.body().to_string().len())
        .max()
        .unwrap();
    assert!(raw < 8 * LONGEST_LINE, "{raw}");
}

#[test]
fn every_flipped_bit_of_a_reply_is_seen() {
    let plan = plan_of(vec![to(2e-4)]);
    // The reading of a rig at rest, from its first byte to the last byte before the line end.
    let reading = |bit: Option<usize>| {
        let text = psd_testing::emulator::SharedText::default();
        let emulator = emulator(&plan, "", Log::to(Box::new(text.clone())), 1);
        let mut rig = open(&plan, &emulator).unwrap();
        let replies = text.text().matches(" actuator < ").count();
        drop(rig);
        let script = bit.map_or_else(String::new, |bit| {
            format!("after {replies} replies: flip bit {bit}")
        });
        let emulator = self::emulator(&plan, &script, Log::none(), 1);
        rig = open(&plan, &emulator).unwrap();
        rig.propose(&[2e-4], None)
            .and_then(|_| rig.execute())
            .and_then(|()| rig.read())
            .map(|reading| (reading, rig.line_statistics()))
    };
    let (sound, line_statistics) = reading(None).unwrap();
    assert_eq!(line_statistics, LineStatistics::default());
    let bits = 8 * (sound.raw[0].len() + 1);
    let mut accepted = 0;
    for bit in 0..bits {
        let (flipped, line_statistics) =
            reading(Some(bit)).unwrap_or_else(|fault| panic!("bit {bit}: {fault}"));
        assert_eq!(
            (&flipped.displacement, &flipped.force),
            (&sound.displacement, &sound.force),
            "bit {bit}"
        );
        assert!(
            line_statistics.resent + line_statistics.ignored > 0,
            "bit {bit} was not seen"
        );
        accepted += without(Guarding::Checksum, || {
            usize::from(
                reading(Some(bit))
                    .is_ok_and(|(_, line_statistics)| line_statistics == LineStatistics::default()),
            )
        });
    }
    assert!(
        bits > 300 && accepted > 30,
        "without the checksum {accepted} of {bits} are taken for good"
    );
}

#[test]
fn a_doubled_a_late_and_an_old_reply_are_ignored() {
    for (fault, resent) in [
        ("repeat replies 5", 0),
        ("replay reply", 1),
        ("delay reply 0.15 s", 1),
        ("delay replies 3 0.25 s", 2),
    ] {
        let ended = run(&plan(), &format!("after 5 moves: {fault}"));
        ended.sound();
        assert!(
            ended.line_statistics.ignored > 0 && ended.line_statistics.resent >= resent,
            "{fault}: {:?}",
            ended.line_statistics
        );
    }
    // A reply of the previous reading, used for the present one.
    let old = "after 40 readings: replay replies 9";
    let seen = run(&plan(), old);
    seen.sound();
    let missed = run_without(Guarding::Sequence, &plan(), old);
    assert!(
        missed.line_statistics.ignored < seen.line_statistics.ignored,
        "{:?}, {:?}",
        missed.line_statistics,
        seen.line_statistics
    );
}
