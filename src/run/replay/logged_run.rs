//! The entries of a run log that count. Entries that a resumption sets aside are omitted, with the events that report this. In: lines.
//! Out: the source of a replay. It knows no physics.

use std::collections::VecDeque;

use super::entry::{
    AmendBody, DigestBody, Header, PlanBody, RULES, ResumeBody, RigBody, TargetStatus,
};
use super::in_force::Rigs;
use super::plain_body::Body;
use psd_plan::record::{Event, EventKind};
use psd_rig::journal::{EntryKind, Line, Recovered};
use psd_rig::{LineStatistics, position_and_force};

/// The content of a run log.
#[derive(Clone, Debug)]
pub struct LoggedRun {
    /// The header that applies at the end: that of the last amendment with which the run went on, otherwise the first.
    pub header: Header,
    /// Text of each file of the header.
    pub texts: Vec<String>,
    /// An amendment that holds from the next resumption on, and the texts of its files. Without a resumption it has changed nothing.
    pub(super) amendment: Option<(AmendBody, Vec<String>)>,
    pub rigs: Rigs,
    /// Entries that count, in order: targets, readings, steps, answers, faults, events.
    pub lines: VecDeque<Line>,
    /// Resumptions and amendments, as events of the run.
    pub interruptions: Vec<Event>,
    /// The last resumption, if no entry followed it.
    pub resumption: Option<ResumeBody>,
    /// The last target, if that resumption set it aside in order to send it again.
    pub set_aside: Option<Line>,
    /// Rig time of the last entry \[s\].
    pub time: f64,
    /// Whether the run was completed.
    pub ended: bool,
    /// Communication errors recovered up to the last entry, also if that entry no longer counts.
    pub line_statistics: LineStatistics,
}

/// The file is complete, but is not the run log of a run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnreadableLog {
    #[error("this version cannot read entry {seq} ({}): {reason}", .kind.word())]
    Body {
        seq: u64,
        kind: EntryKind,
        reason: String,
    },
    #[error("it has no header")]
    NoHeader,
    #[error("its rules are {found}; this psd reads rules {RULES}")]
    Rules { found: u32 },
}

/// The replay of the run log gave a different result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("entry {seq}: the run requires {called}, but the run log has {found}")]
pub struct Mismatch {
    pub seq: u64,
    pub called: String,
    pub found: String,
}

impl LoggedRun {
    /// Sorts the entries of a run log.
    ///
    /// # Errors
    /// An entry cannot be read.
    pub fn of(recovered: &Recovered) -> Result<Self, UnreadableLog> {
        let mut lines = recovered.lines.iter();
        let first = lines
            .next()
            .filter(|line| line.kind == EntryKind::Header)
            .ok_or(UnreadableLog::NoHeader)?;
        let mut logged = Self {
            texts: Vec::new(),
            header: by_these_rules(body(first)?)?,
            amendment: None,
            rigs: Rigs::default(),
            lines: VecDeque::with_capacity(recovered.lines.len()),
            interruptions: Vec::new(),
            resumption: None,
            set_aside: None,
            time: 0.0,
            ended: recovered.ended,
            line_statistics: LineStatistics::default(),
        };
        for line in lines {
            logged.take(line)?;
        }
        // An empty file has no PLAN entry.
        logged
            .texts
            .resize(logged.header.files.len(), String::new());
        Ok(logged)
    }

    fn take(&mut self, line: &Line) -> Result<(), UnreadableLog> {
        if let Some(time) = line.time() {
            self.time = time;
        }
        match line.kind {
            EntryKind::Rig => {
                let rig = body(line)?;
                self.answered(rig);
            }
            EntryKind::Plan => {
                let part: PlanBody = body(line)?;
                let (header, texts) = match &mut self.amendment {
                    Some((amendment, texts)) => (&amendment.header, texts),
                    None => (&self.header, &mut self.texts),
                };
                if part.file >= header.files.len() {
                    let reason = "there is no such file".to_owned();
                    return Err(UnreadableLog::Body {
                        seq: line.seq,
                        kind: line.kind,
                        reason,
                    });
                }
                texts.resize(header.files.len(), String::new());
                texts[part.file].push_str(&part.text);
            }
            EntryKind::Amend => {
                let amend: AmendBody = body(line)?;
                self.amended(AmendBody {
                    header: by_these_rules(amend.header)?,
                    ..amend
                });
            }
            EntryKind::Resume => self.resumed(body(line)?),
            EntryKind::Recover => self.recovered(),
            EntryKind::LineStatistics => self.line_statistics = body(line)?,
            EntryKind::Header | EntryKind::End => {}
            EntryKind::Intent
            | EntryKind::Sample
            | EntryKind::Stroke
            | EntryKind::Step
            | EntryKind::Digest
            | EntryKind::Operator
            | EntryKind::Event
            | EntryKind::Fault
            | EntryKind::Held => {
                (self.resumption, self.set_aside) = (None, None);
                self.lines.push_back(line.clone());
            }
        }
        Ok(())
    }

    /// A different header applies from the next resumption on; its texts follow.
    pub fn amended(&mut self, amend: AmendBody) {
        self.amendment = Some((amend, Vec::new()));
    }

    /// A rig answered; it applies from the next resumption on.
    pub fn answered(&mut self, rig: RigBody) {
        self.rigs.answered(rig, &self.header);
    }

    /// The run is continued from here.
    pub fn resumed(&mut self, resume: ResumeBody) {
        // A target that an earlier resumption set aside without sending it is decided again.
        self.lines.extend(self.set_aside.take());
        while self
            .lines
            .back()
            .is_some_and(|last| last.seq >= resume.from)
        {
            let last = self.lines.pop_back();
            self.set_aside = last.filter(|last| last.kind == EntryKind::Intent);
        }
        if !resume.target_status.sends_again() {
            self.set_aside = None;
        }
        if let Some((amend, texts)) = self.amendment.take() {
            let text = format!(
                "{} ({}): {}",
                amend.differences.join("; "),
                amend.by,
                amend.reason
            );
            self.interrupted(EventKind::Amendment, text);
            (self.header, self.texts) = (amend.header, texts);
        }
        self.rigs.applies(resume.from, &self.header);
        self.interrupted(EventKind::Resume, describe(&resume));
        self.resumption = Some(resume);
    }

    /// Bytes after the last entry were put aside.
    pub fn recovered(&mut self) {
        self.interrupted(
            EventKind::Resume,
            "an incomplete last entry was moved aside".to_owned(),
        );
    }

    fn interrupted(&mut self, kind: EventKind, text: String) {
        self.interruptions.push(Event {
            time: self.time,
            procedure: None,
            step: None,
            kind,
            text,
        });
    }
}

/// Number of targets and of steps in a run log.
#[must_use]
pub fn number_of_steps(recovered: &Recovered) -> (u64, u64) {
    let count = |(targets, steps), line: &Line| match line.kind {
        EntryKind::Intent => (targets + 1, steps),
        EntryKind::Step => (targets, steps + 1),
        EntryKind::Digest => match line.read::<DigestBody>() {
            Ok(digest) => (
                digest.targets.saturating_add(targets),
                digest.steps.saturating_add(steps),
            ),
            Err(_) => (targets, steps),
        },
        _ => (targets, steps),
    };
    recovered.lines.iter().fold((0, 0), count)
}

/// The header, if its run follows the rules of this version.
fn by_these_rules(header: Header) -> Result<Header, UnreadableLog> {
    match header.rules {
        RULES => Ok(header),
        found => Err(UnreadableLog::Rules { found }),
    }
}

/// A resumption, in one sentence.
fn describe(resume: &ResumeBody) -> String {
    let target = match resume.target_status {
        TargetStatus::None => "no target was uncertain",
        TargetStatus::Executed => "the last target had been executed; its reading is late",
        TargetStatus::NotExecuted => "the last target had not arrived, and was sent",
        TargetStatus::HeldDuringMotion if resume.held.is_some() => {
            "the move to the last target had been held, and the target was sent again"
        }
        TargetStatus::HeldDuringMotion => {
            "the last target had not been reached, and was sent again"
        }
        TargetStatus::RemainingMotion { .. } => {
            "a motion had been interrupted, and was continued from the position of the rig"
        }
        TargetStatus::Stroke { .. } => {
            "a motion had been interrupted, and the rig was moved back to its start"
        }
    };
    // At a position different from that of the last reading, the force gives no information about the specimen.
    let relaxed = match (&resume.recorded, resume.found.1.as_slice()) {
        (Some((_, recorded)), [found])
            if recorded.len() == 1 && resume.target_status == TargetStatus::None =>
        {
            format!("; the force had changed by {:.3} N", found - recorded[0])
        }
        _ => String::new(),
    };
    let released = resume
        .released
        .as_ref()
        .map_or_else(String::new, |by| format!("; released by {by}"));
    let held_at = match resume.target_status {
        TargetStatus::HeldDuringMotion => format!(
            ", from {}",
            position_and_force(&resume.found.0, &resume.found.1)
        ),
        _ => String::new(),
    };
    let when = resume
        .wall
        .as_ref()
        .map_or_else(String::new, |wall| format!(" at {wall}"));
    let assured = resume.assured.iter().map(|assured| assured.describe());
    let reasons: Vec<&str> = std::iter::once(resume.reason.as_str())
        .chain(assured)
        .collect();
    format!(
        "resumed{when} by {}: {}; {target}{held_at}{relaxed}{released}",
        resume.by,
        reasons.join("; ")
    )
}

/// The body of an entry, typed.
pub(super) fn body<T: Body>(line: &Line) -> Result<T, UnreadableLog> {
    line.read_by(T::of_plain)
        .map_err(|error| UnreadableLog::Body {
            seq: line.seq,
            kind: line.kind,
            reason: error.to_string(),
        })
}
