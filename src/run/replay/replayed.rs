//! A journal's records as they count: what a resumption has set aside is left out, and what must be told of it is kept.
//! In: lines. Out: what a replay answers from. It judges no physics.

use std::collections::VecDeque;

use serde::de::DeserializeOwned;

use super::entry::{AmendBody, Doubt, Header, PlanBody, ResumeBody, RigBody};
use crate::record::journal::{EntryKind, Line, Recovered};
use crate::record::{Event, EventKind};
use crate::rig::{Tally, place_and_force};

/// What a journal says of its run.
#[derive(Clone, Debug)]
pub struct Played {
    /// What holds at the end: that of the last amendment, else of the first record.
    pub header: Header,
    /// Text of each file of the header.
    pub texts: Vec<String>,
    /// The rig as it was when the run began.
    pub rig: Option<RigBody>,
    /// The rig as it answered last.
    pub last_rig: Option<RigBody>,
    /// Records that count, in order: targets, readings, steps, answers, faults, events.
    pub lines: VecDeque<Line>,
    /// Resumptions and amendments, as events of the run.
    pub interruptions: Vec<Event>,
    /// What the last resumption found of a target in doubt, as long as nothing followed it.
    pub doubt: Option<Doubt>,
    /// Rig time of the last record, s.
    pub time: f64,
    /// Whether the run came to its own end.
    pub ended: bool,
    /// What was mended on the lines of the rig up to the last record, also where the record no longer counts.
    pub tally: Tally,
}

/// The file is whole, but is no record of a run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unplayable {
    #[error("record {seq} is no {kind:?} that this version can read: {reason}")]
    Body {
        seq: u64,
        kind: EntryKind,
        reason: String,
    },
    #[error("it has no header")]
    NoHeader,
}

/// The run, done again from the record, came out otherwise.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("record {seq}: the run calls for {called}, but the record has {found}")]
pub struct Mismatch {
    pub seq: u64,
    pub called: String,
    pub found: String,
}

impl Played {
    /// Sorts the records of a journal.
    ///
    /// # Errors
    /// A record cannot be read.
    pub fn of(recovered: &Recovered) -> Result<Self, Unplayable> {
        let mut lines = recovered.lines.iter();
        let first = lines
            .next()
            .filter(|line| line.kind == EntryKind::Header)
            .ok_or(Unplayable::NoHeader)?;
        let mut played = Self {
            texts: Vec::new(),
            header: body(first)?,
            rig: None,
            last_rig: None,
            lines: VecDeque::with_capacity(recovered.lines.len()),
            interruptions: Vec::new(),
            doubt: None,
            time: 0.0,
            ended: recovered.ended,
            tally: Tally::default(),
        };
        for line in lines {
            played.take(line)?;
        }
        // An empty file has no part.
        played
            .texts
            .resize(played.header.files.len(), String::new());
        Ok(played)
    }

    fn take(&mut self, line: &Line) -> Result<(), Unplayable> {
        if let Some(time) = line.time() {
            self.time = time;
        }
        match line.kind {
            EntryKind::Rig => {
                let rig: RigBody = body(line)?;
                self.rig.get_or_insert_with(|| rig.clone());
                self.last_rig = Some(rig);
            }
            EntryKind::Plan => {
                let part: PlanBody = body(line)?;
                if part.file >= self.header.files.len() {
                    let reason = "there is no such file".to_owned();
                    return Err(Unplayable::Body {
                        seq: line.seq,
                        kind: line.kind,
                        reason,
                    });
                }
                self.texts.resize(self.header.files.len(), String::new());
                self.texts[part.file].push_str(&part.text);
            }
            EntryKind::Amend => self.amended(body(line)?),
            EntryKind::Resume => self.resumed(body(line)?),
            EntryKind::Recover => self.recovered(),
            EntryKind::Tally => self.tally = body(line)?,
            EntryKind::Header | EntryKind::End => {}
            EntryKind::Intent
            | EntryKind::Sample
            | EntryKind::Stroke
            | EntryKind::Step
            | EntryKind::Operator
            | EntryKind::Event
            | EntryKind::Fault
            | EntryKind::Held => {
                self.doubt = None;
                self.lines.push_back(line.clone());
            }
        }
        Ok(())
    }

    /// Something else holds from here on; its texts follow.
    pub fn amended(&mut self, amend: AmendBody) {
        let text = format!(
            "{} ({}): {}",
            amend.differences.join("; "),
            amend.by,
            amend.reason
        );
        self.interrupted(EventKind::Amendment, text);
        self.header = amend.header;
        self.texts.clear();
    }

    /// The run goes on from here.
    pub fn resumed(&mut self, resume: ResumeBody) {
        while self
            .lines
            .back()
            .is_some_and(|last| last.seq >= resume.from)
        {
            self.lines.pop_back();
        }
        self.interrupted(EventKind::Resume, told(&resume));
        self.doubt = Some(resume.doubt);
    }

    /// Bytes behind the last record were put aside.
    pub fn recovered(&mut self) {
        self.interrupted(
            EventKind::Resume,
            "a torn end of the record was put aside".to_owned(),
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

/// A resumption, told in one sentence.
fn told(resume: &ResumeBody) -> String {
    let target = match resume.doubt {
        Doubt::None => "no target was in doubt",
        Doubt::Executed => "the last target had been carried out, its reading is late",
        Doubt::NotExecuted => "the last target had not arrived and was sent",
        Doubt::HeldOnTheWay if resume.held.is_some() => {
            "the last target had been held on the way and was sent anew"
        }
        Doubt::HeldOnTheWay => "the last target had not been reached and was sent anew",
        Doubt::RestOfTheWay { .. } => {
            "a way had been cut off and was gone on with from where the rig stood"
        }
        Doubt::Stroke { .. } => {
            "a way had been cut off, and the rig was brought back to where it begins"
        }
    };
    // At another place than the last reading's the force tells nothing of the specimen.
    let relaxed = match (&resume.recorded, resume.found.1.as_slice()) {
        (Some((_, recorded)), [found]) if recorded.len() == 1 && resume.doubt == Doubt::None => {
            format!("; the force had changed by {:.3} N", found - recorded[0])
        }
        _ => String::new(),
    };
    let released = resume
        .released
        .as_ref()
        .map_or_else(String::new, |by| format!("; released by {by}"));
    let stood = match resume.doubt {
        Doubt::HeldOnTheWay => format!(
            ", from {}",
            place_and_force(&resume.found.0, &resume.found.1)
        ),
        _ => String::new(),
    };
    let when = resume
        .wall
        .as_ref()
        .map_or_else(String::new, |wall| format!(" at {wall}"));
    let assured = resume.assured.iter().map(|assured| assured.told());
    let said: Vec<&str> = std::iter::once(resume.reason.as_str())
        .chain(assured)
        .collect();
    format!(
        "resumed{when} by {}: {}; {target}{stood}{relaxed}{released}",
        resume.by,
        said.join("; ")
    )
}

/// A record's body, typed.
pub(super) fn body<T: DeserializeOwned>(line: &Line) -> Result<T, Unplayable> {
    line.read().map_err(|error| Unplayable::Body {
        seq: line.seq,
        kind: line.kind,
        reason: error.to_string(),
    })
}
