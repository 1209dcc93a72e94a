//! Questions to the operator and typed answers: release, hold, resume, inspection.

use std::cell::Cell;
use std::rc::Rc;
use std::sync::mpsc::{Sender, channel};
use std::time::Duration;

use super::*;
use crate::operator::question::{After, Stay};

/// A clock that a test sets, and an operator whose lines the test types.
struct Typist {
    now: Rc<Cell<Duration>>,
    send: Option<Sender<String>>,
    person: Person,
}

impl Typist {
    fn new(operator: Option<&str>) -> Self {
        let (now, (send, lines)) = (Rc::new(Cell::new(Duration::ZERO)), channel());
        let clock = Rc::clone(&now);
        let typed = Typed::of(lines, Box::new(move || clock.get()));
        Self {
            now,
            send: Some(send),
            person: Person {
                dialogue: Dialogue::new(operator.map(str::to_owned)),
                typed: Some(typed),
            },
        }
    }

    fn ask(&mut self, kind: QuestionKind) -> Inspection {
        self.person.wait_for(&[], &Inspection::Wait, |dialogue| {
            dialogue.ask(&question(kind))
        })
    }

    fn ask_to_unload(&mut self) -> Option<Inspection> {
        self.person
            .wait_for(&[], &Some(Inspection::Wait), |dialogue| {
                dialogue.ask_to_unload(&question(QuestionKind::Unload))
            })
    }

    fn stay(&mut self, after: After) -> Stay {
        self.person
            .wait_for(&[], &Stay::Wait, |dialogue| dialogue.stay(after))
    }

    fn types(&self, line: &str) {
        self.send.as_ref().unwrap().send(line.to_owned()).unwrap();
    }
}

const LOOK: QuestionKind = QuestionKind::Look;

fn question(kind: QuestionKind) -> Question {
    Question {
        kind,
        lines: vec!["look".to_owned()],
    }
}

/// The result of these lines, typed after the question can be answered and followed by the end of the input.
fn answer_to(kind: QuestionKind, lines: &[&str], operator: Option<&str>) -> Inspection {
    let mut typist = Typist::new(operator);
    assert_eq!(typist.ask(kind), Inspection::Wait);
    typist.now.set(Duration::from_secs(1));
    assert_eq!(typist.ask(kind), Inspection::Wait);
    for line in lines {
        typist.types(line);
    }
    typist.send = None;
    loop {
        match typist.ask(kind) {
            Inspection::Wait => {}
            answer => return answer,
        }
    }
}

#[test]
fn only_a_clear_yes_with_a_name_goes_on_and_a_remark_is_a_line_of_its_own() {
    let by = |name: &str| Some(name.to_owned());
    assert_eq!(
        answer_to(LOOK, &["y"], Some("A")),
        Inspection::GoOn {
            note: None,
            by: by("A")
        }
    );
    assert_eq!(
        answer_to(LOOK, &["yes"], Some("A")),
        Inspection::GoOn {
            note: None,
            by: by("A")
        }
    );
    let note = Some("crack at\\u{7} midspan".to_owned());
    let lines = ["what", "i crack at\u{7} midspan ", "yes", "", "B"];
    assert_eq!(
        answer_to(LOOK, &lines, None),
        Inspection::GoOn { note, by: by("B") }
    );
    assert!(matches!(
        answer_to(LOOK, &["no"], Some("A")),
        Inspection::Stop { by: Some(_), .. }
    ));
    let released = answer_to(
        QuestionKind::Release,
        &["y", "yes", "xyz", "release", "RELEASE"],
        Some("A"),
    );
    assert_eq!(
        released,
        Inspection::GoOn {
            note: None,
            by: by("A")
        }
    );
    for none in ["y", "yes", "xyz", "release", "UNLOAD", "y RELEASE"] {
        assert!(
            matches!(
                answer_to(QuestionKind::Release, &[none], Some("A")),
                Inspection::Stop { by: None, .. }
            ),
            "{none}"
        );
    }
    let declined = Inspection::Stop {
        reason: "declined by the operator: not clear".to_owned(),
        by: by("A"),
    };
    assert_eq!(
        answer_to(QuestionKind::Release, &["i not clear", "n"], Some("A")),
        declined
    );
}

#[test]
fn a_release_typed_before_its_question_could_be_read_is_none() {
    let mut typist = Typist::new(Some("A"));
    let ask = |typist: &mut Typist| typist.ask(QuestionKind::Release);
    typist.types("RELEASE");
    assert_eq!(ask(&mut typist), Inspection::Wait);
    typist.types("RELEASE");
    typist.now.set(Duration::from_millis(999));
    assert_eq!(ask(&mut typist), Inspection::Wait);
    typist.types("RELEASE");
    typist.now.set(Duration::from_secs(1));
    assert_eq!(
        [ask(&mut typist), ask(&mut typist)],
        [Inspection::Wait, Inspection::Wait]
    );
    typist.types("RELEASE");
    assert!(matches!(ask(&mut typist), Inspection::GoOn { .. }));
}

#[test]
fn the_next_question_takes_no_line_of_the_one_before() {
    let mut typist = Typist::new(Some("A"));
    let ask = |typist: &mut Typist, kind| typist.ask(kind);
    ask(&mut typist, QuestionKind::Release);
    typist.now.set(Duration::from_secs(1));
    ask(&mut typist, QuestionKind::Release);
    typist.types("RELEASE");
    typist.types("RELEASE");
    assert!(matches!(
        ask(&mut typist, QuestionKind::Release),
        Inspection::GoOn { .. }
    ));
    assert_eq!(
        [
            ask(&mut typist, QuestionKind::GoOn),
            ask(&mut typist, QuestionKind::GoOn)
        ],
        [Inspection::Wait, Inspection::Wait]
    );
    typist.now.set(Duration::from_secs(2));
    assert_eq!(
        [
            ask(&mut typist, QuestionKind::GoOn),
            ask(&mut typist, QuestionKind::GoOn)
        ],
        [Inspection::Wait, Inspection::Wait]
    );
    typist.types("RELEASE");
    assert!(matches!(
        ask(&mut typist, QuestionKind::GoOn),
        Inspection::GoOn { .. }
    ));
}

const HELD: After = After::Held {
    resume: true,
    unload: false,
};

/// A rig on hold, at the time when input counts.
fn held(operator: Option<&str>) -> Typist {
    let mut typist = Typist::new(operator);
    typist.types("x");
    for _ in 0..2 {
        let answer = typist.ask_to_unload();
        assert_eq!(answer, Some(Inspection::Wait));
        typist.now.set(typist.now.get() + Duration::from_secs(1));
    }
    typist
}

/// The result of these lines at a rig on hold; each question can be answered.
fn typed_before_it(typist: &mut Typist, lines: &[&str]) -> Option<Inspection> {
    let mut answer = Some(Inspection::Wait);
    for line in lines {
        typist.types(line);
        // The line, the text it shows, the second without input.
        for _ in 0..3 {
            answer = typist.ask_to_unload();
            typist.now.set(typist.now.get() + Duration::from_secs(1));
            if answer != Some(Inspection::Wait) {
                return answer;
            }
        }
    }
    answer
}

#[test]
fn a_held_rig_unloads_for_its_word_alone() {
    let mut typist = held(Some("A"));
    let yes = typed_before_it(&mut typist, &["u", "UNLOAD"]);
    assert!(
        matches!(yes, Some(Inspection::GoOn { by: Some(_), .. })),
        "{yes:?}"
    );
    assert_eq!(
        typist.stay(HELD),
        Stay::Wait,
        "the operator still looks at it"
    );
    let all: [&[&str]; 7] = [
        &["UNLOAD"],
        &["u", "y"],
        &["u", "RELEASE"],
        &["u", "n"],
        &["y"],
        &["r"],
        &["u", "n", "r", "", "UNLOAD"],
    ];
    for lines in all {
        let mut typist = held(Some("A"));
        assert_eq!(
            typed_before_it(&mut typist, lines),
            Some(Inspection::Wait),
            "{lines:?}"
        );
    }
}

#[test]
fn a_held_rig_is_left_or_gone_on_with_for_a_reason() {
    let all: [(&[&str], Stay); 4] = [
        (&["x"], Stay::Leave),
        (&["u", "n", "X"], Stay::Leave),
        (
            &["r", " it looks well "],
            Stay::Resume("it looks well".to_owned()),
        ),
        (&["r", "", "r", "now"], Stay::Resume("now".to_owned())),
    ];
    for (lines, chosen) in all {
        let mut typist = held(Some("A"));
        assert_eq!(typed_before_it(&mut typist, lines), None, "{lines:?}");
        assert_eq!(typist.stay(HELD), chosen, "{lines:?}");
    }
    for lines in [&[][..], &["u"], &["r"]] {
        let mut typist = held(Some("A"));
        typed_before_it(&mut typist, lines);
        typist.send = None;
        assert_eq!(typed_before_it(&mut typist, &[]), Some(Inspection::Wait));
        assert_eq!(typist.ask_to_unload(), None, "{lines:?}");
        assert_eq!(typist.stay(HELD), Stay::Leave, "the end of the input");
    }
}

#[test]
fn a_rig_that_may_still_move_waits_until_that_has_been_seen() {
    let mut typist = Typist::new(None);
    typist.types("a");
    assert_eq!(typist.stay(After::NotHeld), Stay::Wait);
    typist.now.set(Duration::from_secs(1));
    assert_eq!(
        typist.stay(After::NotHeld),
        Stay::Wait,
        "what was typed before"
    );
    for line in ["r", "u", "x", ""] {
        typist.types(line);
        assert_eq!(typist.stay(After::NotHeld), Stay::Wait, "{line:?}");
    }
    typist.types("a");
    assert_eq!(
        [typist.stay(After::NotHeld), typist.stay(After::NotHeld)],
        [Stay::Leave, Stay::Leave]
    );
    // The operator left while the rig was on hold.
    let mut typist = held(None);
    assert_eq!(typed_before_it(&mut typist, &["x"]), None);
    assert_eq!(
        [typist.stay(HELD), typist.stay(After::NotHeld)],
        [Stay::Leave, Stay::Wait]
    );
}

#[test]
fn a_line_ends_with_the_input_and_with_ctrl_c() {
    let typed = || {
        let (send, lines) = channel();
        (send, Typed::of(lines, Box::new(|| Duration::ZERO)))
    };
    let stop_request = StopRequest::default();
    let (send, mut lines) = typed();
    send.send("y".to_owned()).unwrap();
    drop(send);
    let line = |typed: &mut Typed| next_line(typed, &stop_request, || Ok::<_, ()>(()));
    assert_eq!(line(&mut lines), Ok(Some("y".to_owned())));
    assert_eq!(line(&mut lines), Ok(None));
    let (kept, mut lines) = typed();
    stop_request.stop_after_step();
    assert_eq!(line(&mut lines), Ok(None), "Ctrl-C while a question waits");
    let stop_request = StopRequest::default();
    let mut looks = 0;
    let heard = next_line(&mut lines, &stop_request, || {
        looks += 1;
        if looks == 3 {
            kept.send("late".to_owned())
        } else {
            Ok(())
        }
    });
    assert_eq!(
        (heard, looks),
        (Ok(Some("late".to_owned())), 3),
        "the rig is heard from while a person thinks"
    );
    let (_kept, mut lines) = typed();
    assert_eq!(
        next_line(&mut lines, &stop_request, || Err("it trips")),
        Err("it trips")
    );
}

#[test]
fn one_move_by_hand_wants_its_word() {
    for (typed, moves) in [(&["y", "MOVE"][..], true), (&["n"], false), (&["y"], false)] {
        let (send, lines) = channel();
        let now = Rc::new(Cell::new(Duration::ZERO));
        let clock = Rc::clone(&now);
        let mut person = Person {
            dialogue: Dialogue::new(Some("A".to_owned())),
            typed: Some(Typed::of(lines, Box::new(move || clock.get()))),
        };
        send.send("MOVE".to_owned()).unwrap();
        let mut send = Some(send);
        let mut looks = 0;
        let agreed = person.agrees(
            &question(QuestionKind::Jog),
            &StopRequest::default(),
            || {
                looks += 1;
                if looks == 1 {
                    now.set(Duration::from_secs(1));
                } else if looks == 2 {
                    let send = send.take().unwrap();
                    for line in typed {
                        send.send((*line).to_owned()).unwrap();
                    }
                }
                Ok::<_, ()>(())
            },
        );
        assert_eq!(agreed, Ok(moves), "{typed:?}");
    }
}

#[test]
fn the_end_of_the_input_is_no_yes() {
    for lines in [&[][..], &["yesterday"], &["y"], &["y", " "]] {
        assert!(
            matches!(
                answer_to(LOOK, lines, None),
                Inspection::Stop { by: None, .. }
            ),
            "{lines:?}"
        );
    }
}
