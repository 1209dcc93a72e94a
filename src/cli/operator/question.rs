//! Questions to the operator and their answers, the same on the live screen and in a line terminal. In: the object of an inspection, a
//! motion, or a rig on hold. Out: a title, lines, the confirmation text, the keys of a choice. No single key permits a motion, and input
//! typed before the question does not count.

use std::time::Duration;

use psd::run::{Inspection, Motion};
use psd_text::diagnostic::excerpt::escape;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Input within this time after a question appears does not count: the operator cannot have read it yet.
pub const DEAF: Duration = Duration::from_secs(1);

/// A question of the run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    pub kind: QuestionKind,
    pub lines: Vec<String>,
}

/// The effect of a confirmation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuestionKind {
    /// An inspection; no real rig moves.
    Look,
    /// An inspection, after which the rig moves on.
    GoOn,
    /// The first move of a run, of a resumed run, or of a served rig.
    Release,
    /// Unloading after a stop.
    Unload,
    /// One manual move.
    Jog,
}

/// The state of the rig after the early end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum After {
    /// The rig is on hold, and these choices are available.
    Held { resume: bool, unload: bool },
    /// It is not confirmed that the rig is on hold.
    NotHeld,
}

/// The operator's choice for a rig whose run has ended early. No choice moves the rig yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    Resume,
    Unload,
    Leave,
}

/// The operator's choice for a run that has ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stay {
    /// No choice yet: the observation continues.
    Wait,
    /// The operator leaves.
    Leave,
    /// The run resumes, for this reason.
    Resume(String),
}

/// The question to the operator who resumes a held run.
pub const WHY_RESUME: &str = "Why was the run held, and why may it continue? With the reason you confirm that the rig was not \
                              power-cycled. Both are logged.";

/// Position of a rig and its measured force there.
pub fn position_and_force(displacement: f64, force: f64) -> String {
    format!(
        "X {}   R {}",
        readable(displacement, Dimension::LENGTH),
        readable(force, Dimension::FORCE)
    )
}

impl After {
    /// The available choices: key and effect.
    pub fn choices(self) -> Vec<(char, Choice, &'static str)> {
        let Self::Held { resume, unload } = self else {
            return vec![('a', Choice::Leave, "I have seen this")];
        };
        let resume = resume.then_some((
            'r',
            Choice::Resume,
            "resume the run; the rig MOVES only after its release",
        ));
        let unload = unload.then_some((
            'u',
            Choice::Unload,
            "unload; the rig MOVES only after its release",
        ));
        resume
            .into_iter()
            .chain(unload)
            .chain([('x', Choice::Leave, "leave; the rig stays HELD")])
            .collect()
    }

    /// The choice of this key.
    pub fn choice(self, key: char) -> Option<Choice> {
        let chosen = |(own, ..): &(char, Choice, &str)| own.eq_ignore_ascii_case(&key);
        self.choices()
            .into_iter()
            .find(chosen)
            .map(|(_, choice, _)| choice)
    }
}

impl Question {
    /// An inspection. If a real rig was released before, a motion follows it.
    pub fn look(note: &str, released: Option<&Motion>) -> Self {
        let note = format!("inspect: {}", escape(note));
        let Some(motion) = released else {
            return Self {
                kind: QuestionKind::Look,
                lines: vec![note],
            };
        };
        let onward = Motion {
            does: "it MOVES on as the plan specifies".to_owned(),
            ..motion.clone()
        };
        Self {
            kind: QuestionKind::GoOn,
            lines: [vec![note, String::new()], onward.lines()].concat(),
        }
    }

    /// Title and lines, for a line terminal.
    pub fn text(&self) -> String {
        let title = self.kind.title();
        format!("\n  {title}\n  {}\n", self.lines.join("\n  "))
    }

    /// A motion that requires the operator's confirmation.
    pub fn of(kind: QuestionKind, motion: &Motion) -> Self {
        Self {
            kind,
            lines: motion.lines().iter().map(|line| escape(line)).collect(),
        }
    }
}

impl QuestionKind {
    pub const fn title(self) -> &'static str {
        match self {
            Self::Look => "INSPECTION",
            Self::GoOn => "INSPECTION, THEN THE RIG WILL MOVE",
            Self::Release => "RELEASE: THE RIG WILL MOVE",
            Self::Unload => "UNLOAD: THE RIG WILL MOVE",
            Self::Jog => "JOG: THE RIG WILL MOVE",
        }
    }

    /// The confirmation text.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Look => "yes",
            Self::GoOn | Self::Release => "RELEASE",
            Self::Unload => "UNLOAD",
            Self::Jog => "MOVE",
        }
    }

    /// The effect of `n`.
    pub const fn declined(self) -> &'static str {
        match self {
            Self::Look | Self::GoOn => "the run ends here and the rig holds",
            Self::Release | Self::Jog => "nothing moves",
            Self::Unload => "it stays HELD",
        }
    }

    /// The meaning of an entered line; None: no meaning. A confirmation that permits a motion must be typed exactly as shown.
    pub fn answer(self, line: &str) -> Option<bool> {
        let line = line.trim();
        if line == self.word() || self == Self::Look && line.eq_ignore_ascii_case("y") {
            return Some(true);
        }
        ["n", "no"]
            .iter()
            .any(|no| line.eq_ignore_ascii_case(no))
            .then_some(false)
    }

    /// An answer for the run log, with the remark and the name.
    pub fn to_inspection(self, yes: bool, remark: Option<String>, by: String) -> Inspection {
        let by = Some(by);
        if yes {
            return Inspection::GoOn { note: remark, by };
        }
        let reason = match self {
            Self::Look | Self::GoOn => "stopped by the operator at an inspection",
            Self::Release => "declined by the operator",
            Self::Unload | Self::Jog => "no",
        };
        let reason =
            remark.map_or_else(|| reason.to_owned(), |remark| format!("{reason}: {remark}"));
        Inspection::Stop { reason, by }
    }

    /// No operator answers.
    pub fn unanswered(self) -> Inspection {
        let reason = match self {
            Self::Look | Self::GoOn => "no answer at an inspection",
            Self::Release | Self::Unload | Self::Jog => "no answer",
        };
        Inspection::Stop {
            reason: reason.to_owned(),
            by: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_word_as_it_is_shown_lets_something_move() {
        for kind in [
            QuestionKind::GoOn,
            QuestionKind::Release,
            QuestionKind::Unload,
            QuestionKind::Jog,
        ] {
            assert_eq!(kind.answer(&format!(" {} ", kind.word())), Some(true));
            for other in [
                "y",
                "Y",
                "yes",
                "",
                "release",
                "unload",
                "move",
                "R",
                "RELEASE it",
                "ok",
                "go",
            ] {
                assert_eq!(kind.answer(other), None, "{kind:?} {other:?}");
            }
            assert_eq!(
                (kind.answer("n"), kind.answer("No")),
                (Some(false), Some(false))
            );
        }
        assert_eq!(
            QuestionKind::Unload.answer("RELEASE"),
            None,
            "each motion has its own word"
        );
        assert_eq!(
            (
                QuestionKind::Look.answer("y"),
                QuestionKind::Look.answer("yes"),
                QuestionKind::Look.answer("yesterday")
            ),
            (Some(true), Some(true), None)
        );
    }
}
