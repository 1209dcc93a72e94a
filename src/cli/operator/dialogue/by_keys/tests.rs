//! Keys at the times that the test sets.

use super::*;
use crate::operator::question::{DEAF, Question, Stay};
use psd::run::{Inspection, Next};

/// A time long after the last question appeared.
const LATER: Duration = Duration::from_secs(100);

fn look() -> Question {
    of(QuestionKind::Look)
}

fn of(kind: QuestionKind) -> Question {
    Question {
        kind,
        lines: vec!["look".to_owned()],
    }
}

/// Draws the open question, waits until it could be read, then types these keys.
fn type_in(dialogue: &mut Dialogue, text: &str) {
    let stop_request = StopRequest::default();
    for character in text.chars() {
        dialogue.drawn(dialogue.appeared, Duration::ZERO);
        dialogue.press(key(character), LATER, &stop_request);
    }
}

const fn key(character: char) -> Key {
    match character {
        '\n' => Key::Enter,
        '\u{1b}' => Key::Escape,
        '\u{3}' => Key::Interrupt,
        '\u{4}' => Key::End,
        other => Key::Character(other),
    }
}

fn answered(kind: QuestionKind, operator: Option<&str>, typed: &str) -> Inspection {
    let mut dialogue = Dialogue::new(operator.map(str::to_owned));
    assert_eq!(dialogue.ask(&of(kind)), Inspection::Wait);
    type_in(&mut dialogue, typed);
    dialogue.ask(&of(kind))
}

#[test]
fn only_yes_with_a_name_goes_on() {
    let by = |name: &str| Some(name.to_owned());
    let look = |operator, typed| answered(QuestionKind::Look, operator, typed);
    assert_eq!(
        look(Some("A. Engineer"), "y\n"),
        Inspection::GoOn {
            note: None,
            by: by("A. Engineer")
        }
    );
    assert_eq!(
        look(Some("A"), "yes\n"),
        Inspection::GoOn {
            note: None,
            by: by("A")
        },
        "and no remark"
    );
    let typed = Inspection::GoOn {
        note: Some("no crack".to_owned()),
        by: by("B"),
    };
    assert_eq!(
        look(None, "ino crack\nyes\n  \nB\n"),
        typed,
        "a blank name is asked for again"
    );
    for undecided in [
        "",
        "\n",
        " ",
        "x",
        "y",
        "yyes\n",
        "y\n",
        "y\n  \n",
        "y\u{1b}\n",
        "p",
        "i",
        "iyes\n",
    ] {
        assert_eq!(look(None, undecided), Inspection::Wait, "{undecided:?}");
    }
    assert!(
        matches!(look(None, "\u{4}"), Inspection::Stop { .. }),
        "the end of the input is no yes"
    );
    assert!(matches!(look(None, "y\u{4}"), Inspection::Stop { .. }));
    let stop = look(Some("C"), "icrack\u{202e}\nn\n");
    let reason = "stopped by the operator at an inspection: crack\\u{202e}".to_owned();
    assert_eq!(
        stop,
        Inspection::Stop {
            reason,
            by: by("C")
        }
    );
}

#[test]
fn only_the_word_releases_a_rig() {
    let released = Inspection::GoOn {
        note: None,
        by: Some("A".to_owned()),
    };
    let release = |typed| answered(QuestionKind::Release, Some("A"), typed);
    assert_eq!(release("RELEASE\n"), released);
    assert_eq!(
        release("y\nxyz\nRELEASE\n"),
        released,
        "what answers nothing leaves nothing"
    );
    for none in [
        "y\n",
        "yes\n",
        "xyz\n",
        "release\n",
        "RELEASE",
        "UNLOAD\n",
        "RELEASE it\n",
        "\n",
        " \n",
    ] {
        assert_eq!(release(none), Inspection::Wait, "{none:?}");
    }
    let declined = Inspection::Stop {
        reason: "declined by the operator".to_owned(),
        by: Some("A".to_owned()),
    };
    assert_eq!(release("n\n"), declined);
}

#[test]
fn no_key_counts_before_a_question_could_be_read() {
    let stop_request = StopRequest::default();
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    let press = |dialogue: &mut Dialogue, text: &str, now: Duration| {
        text.chars()
            .for_each(|character| dialogue.press(key(character), now, &stop_request));
    };
    dialogue.ask(&of(QuestionKind::Release));
    press(&mut dialogue, "RELEASE\nqhn\n\u{4}", LATER);
    assert_eq!(
        dialogue.ask(&of(QuestionKind::Release)),
        Inspection::Wait,
        "it has not been drawn"
    );
    dialogue.drawn(dialogue.appeared - 1, LATER);
    assert!(dialogue.is_new(), "the page shows the earlier content");
    dialogue.drawn(dialogue.appeared, LATER);
    dialogue.drawn(dialogue.appeared, LATER + DEAF);
    press(
        &mut dialogue,
        "RELEASE\nqhn\n",
        LATER + Duration::from_millis(999),
    );
    assert_eq!(
        dialogue.ask(&of(QuestionKind::Release)),
        Inspection::Wait,
        "in its first second"
    );
    assert!(
        dialogue
            .typing
            .as_ref()
            .is_some_and(|typing| typing.text.is_empty())
    );
    press(&mut dialogue, "RELEASE\n", LATER + DEAF);
    assert!(matches!(
        dialogue.ask(&of(QuestionKind::Release)),
        Inspection::GoOn { .. }
    ));
    assert!(!stop_request.end_requested());
    dialogue.ask(&of(QuestionKind::GoOn));
    press(&mut dialogue, "RELEASE\n", LATER + 2 * DEAF);
    assert_eq!(
        dialogue.ask(&of(QuestionKind::GoOn)),
        Inspection::Wait,
        "the next question is a new one"
    );
    press(&mut dialogue, "\u{3}", LATER);
    assert!(stop_request.end_requested(), "Ctrl-C always counts");
}

#[test]
fn a_note_being_typed_is_no_answer() {
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    type_in(&mut dialogue, "i");
    assert_eq!(dialogue.ask(&look()), Inspection::Wait);
    type_in(&mut dialogue, "yes\n");
    assert_eq!(dialogue.next(), Next::Record("yes (A)".to_owned()));
    assert_eq!(
        dialogue.ask(&look()),
        Inspection::Wait,
        "the question comes after the note"
    );
    assert!(dialogue.is_new());
    type_in(&mut dialogue, "y\n");
    assert!(matches!(dialogue.ask(&look()), Inspection::GoOn { .. }));
}

#[test]
fn a_paused_run_goes_on_step_by_step() {
    let mut dialogue = Dialogue::new(None);
    type_in(&mut dialogue, "s");
    assert_eq!(dialogue.next(), Next::GoOn);
    type_in(&mut dialogue, "p");
    assert_eq!(
        dialogue.next(),
        Next::Record("paused by the operator".to_owned())
    );
    assert_eq!(dialogue.next(), Next::Wait);
    type_in(&mut dialogue, "s ");
    assert_eq!(
        [dialogue.next(), dialogue.next(), dialogue.next()],
        [Next::GoOn, Next::GoOn, Next::Wait]
    );
    type_in(&mut dialogue, "p");
    assert_eq!(
        dialogue.next(),
        Next::Record("went on by the operator".to_owned())
    );
    assert_eq!(dialogue.next(), Next::GoOn);
}

#[test]
fn the_help_lets_the_keys_through_that_it_names_for_stopping() {
    for (key, held) in [('h', true), ('H', true), ('q', false), ('p', false)] {
        let stop_request = StopRequest::default();
        let mut dialogue = Dialogue::new(None);
        dialogue.press(Key::Character('?'), LATER, &stop_request);
        dialogue.press(Key::Character(key), LATER, &stop_request);
        assert_eq!(
            (stop_request.hold_requested(), stop_request.end_requested()),
            (held, key != 'p'),
            "{key}"
        );
        assert!(
            !dialogue.help && !dialogue.paused,
            "any other key only closes it"
        );
        assert_eq!(dialogue.attended, key != 'p');
    }
}

#[test]
fn a_pause_is_one_when_the_step_has_ended() {
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    type_in(&mut dialogue, "p");
    assert!(dialogue.paused && !dialogue.waiting, "the rig still moves");
    assert!(matches!(dialogue.next(), Next::Record(_)));
    assert_eq!((dialogue.next(), dialogue.waiting), (Next::Wait, true));
    type_in(&mut dialogue, "s");
    assert_eq!(
        (dialogue.next(), dialogue.waiting),
        (Next::GoOn, false),
        "one step moves"
    );
}

/// A rig that the operator put on hold, and these keys.
fn held(typed: &str) -> (Dialogue, Option<Inspection>) {
    let mut dialogue = Dialogue::new(Some("A".to_owned()));
    assert_eq!(
        dialogue.ask_to_unload(&of(QuestionKind::Unload)),
        Some(Inspection::Wait)
    );
    let mut answer = None;
    for character in typed.chars() {
        type_in(&mut dialogue, &character.to_string());
        answer = dialogue.ask_to_unload(&of(QuestionKind::Unload));
        if answer != Some(Inspection::Wait) {
            break;
        }
    }
    (dialogue, answer)
}

const HELD: After = After::Held {
    resume: true,
    unload: false,
};

#[test]
fn a_held_rig_unloads_for_its_word_alone() {
    assert!(matches!(
        held("uUNLOAD\n").1,
        Some(Inspection::GoOn { by: Some(_), .. })
    ));
    for undecided in [
        "u",
        "uu",
        "uy\n",
        "uRELEASE\n",
        "UNLOAD\n",
        "un\n",
        "u\u{1b}",
        "u\u{3}",
        "u\u{4}",
        "r",
        "r\n",
        "q",
        "h",
        "n\n",
    ] {
        assert_eq!(held(undecided).1, Some(Inspection::Wait), "{undecided:?}");
    }
    let mut hasty = Dialogue::new(Some("A".to_owned()));
    hasty.ask_to_unload(&of(QuestionKind::Unload));
    type_in(&mut hasty, "uRELEASE\nx");
    assert_eq!(
        hasty.ask_to_unload(&of(QuestionKind::Unload)),
        Some(Inspection::Wait),
        "what comes before its question chooses nothing else"
    );
    assert_eq!(
        hasty.stay(After::Held {
            resume: true,
            unload: true
        }),
        Stay::Wait
    );
    let (mut unloaded, _) = held("uUNLOAD\n");
    assert_eq!(
        unloaded.stay(HELD),
        Stay::Wait,
        "the screen stays after that, too"
    );
    type_in(&mut unloaded, "u");
    assert_eq!(
        unloaded.stay(HELD),
        Stay::Wait,
        "and nothing is unloaded twice"
    );
    type_in(&mut unloaded, "x");
    assert_eq!(unloaded.stay(HELD), Stay::Leave);
}

#[test]
fn a_held_rig_is_left_or_gone_on_with() {
    for left in ["x", "\u{3}", "u\u{1b}x", "un\nx"] {
        let (mut dialogue, answer) = held(left);
        assert_eq!(
            (answer, dialogue.stay(HELD)),
            (None, Stay::Leave),
            "{left:?}"
        );
    }
    let (mut dialogue, answer) = held("r \nit looks well\n");
    assert_eq!(
        (answer, dialogue.stay(HELD)),
        (None, Stay::Resume("it looks well".to_owned()))
    );
    assert_eq!(held("rno").0.stay(HELD), Stay::Wait);
    let mut unmoved = Dialogue::new(None);
    assert_eq!(
        unmoved.stay(After::Held {
            resume: false,
            unload: false
        }),
        Stay::Wait
    );
    type_in(&mut unmoved, "ru");
    assert_eq!(unmoved.typing, None, "what is not offered cannot be chosen");
}

#[test]
fn nobody_leaves_a_rig_that_may_still_move_unseen() {
    let (mut dialogue, _) = held("x");
    assert_eq!(
        dialogue.stay(After::NotHeld),
        Stay::Wait,
        "it was left while it held"
    );
    let stop_request = StopRequest::default();
    dialogue.press(Key::Character('a'), LATER, &stop_request);
    assert_eq!(
        dialogue.stay(After::NotHeld),
        Stay::Wait,
        "nobody has seen it yet"
    );
    type_in(&mut dialogue, "xruqh\n\u{3}\u{1b}");
    assert_eq!(dialogue.stay(After::NotHeld), Stay::Wait);
    type_in(&mut dialogue, "a");
    assert_eq!(dialogue.stay(After::NotHeld), Stay::Leave);
    let mut lost = Dialogue::new(None);
    lost.lose(&stop_request);
    assert_eq!(
        (
            lost.ask_to_unload(&of(QuestionKind::Unload)),
            lost.stay(After::NotHeld)
        ),
        (None, Stay::Leave),
        "nobody there"
    );
}

#[test]
fn stop_and_hold_are_wishes_and_a_lost_terminal_is_a_hold() {
    let stop_request = StopRequest::default();
    let mut dialogue = Dialogue::default();
    dialogue.press(Key::Character('q'), LATER, &stop_request);
    assert!(stop_request.end_requested() && !stop_request.hold_requested());
    dialogue.press(Key::Interrupt, LATER, &stop_request);
    assert!(stop_request.hold_requested());
    let stop_request = StopRequest::default();
    dialogue.press(Key::Quit, LATER, &stop_request);
    assert!(stop_request.hold_requested());
    let stop_request = StopRequest::default();
    dialogue.paused = true;
    dialogue.lose(&stop_request);
    assert!(stop_request.hold_requested());
    assert_eq!(
        dialogue.next(),
        Next::GoOn,
        "a pause does not outlast its terminal"
    );
    assert!(matches!(dialogue.ask(&look()), Inspection::Stop { .. }));
}
