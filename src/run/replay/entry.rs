//! What each record of a journal says, typed. In: what happened. Out: JSON bodies, and back. Numbers are SI; a float is
//! written as the shortest decimal that reads back to the same bits, so that nothing is lost. It knows no file.

use serde::{Deserialize, Serialize};

use crate::physics::tracking::trajectory::Path;
use crate::record::equipment::Equipment;
use crate::rig::{DeclaredNoise, Identity, LastMove, RigFault};
use crate::run::{Inspection, Request};

/// What stands in place of a protocol where a person drives.
pub const BY_HAND: &str = "by hand";

/// HEADER: all a run starts from. Enough to check the plan again, on any machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    pub run_id: String,
    pub psd: String,
    /// SHA-256 of the program's sources, hex.
    pub build: String,
    /// Which rules the run is computed by ([`RULES`](super::RULES)); records of before there were others say none.
    #[serde(default = "first_rules", skip_serializing_if = "is_first")]
    pub rules: u32,
    /// Target, profile and compiler that it was built for and with; empty where they were not recorded.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub toolchain: String,
    /// The plan first, then what it used. Their texts follow in PLAN records.
    pub files: Vec<HeaderFile>,
    /// `--set` values as given.
    pub settings: Vec<(String, String)>,
    /// Name of the rig, as `--rig` would say it; None: the default of the plan.
    pub rig: Option<String>,
    /// What is measured with, and held to; None in records of version 1, which do not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equipment: Option<Equipment>,
    /// Whether only the part that a rehearsal measures was to run.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rehearsal: bool,
    /// Protocol of the clients that drive the rig, or that a person does by hand; None: the plan's procedures do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub served: Option<String>,
    /// As `--date` gave it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Of a real rig: who stands by, on which machine, when it began.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub host: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub began: Option<String>,
}

const fn first_rules() -> u32 {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
const fn is_first(rules: &u32) -> bool {
    *rules == first_rules()
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HeaderFile {
    pub name: String,
    /// Of its text, hex.
    pub sha256: String,
}

/// PLAN: a part of a file's text, for a line of the journal is bounded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanBody {
    /// Place in the list of files before it.
    pub file: usize,
    pub text: String,
}

impl PlanBody {
    /// Characters of a part: at most six bytes each in the journal.
    const PART: usize = 8192;

    /// The parts of the texts, in order.
    pub fn parts_of(texts: &[String]) -> Vec<Self> {
        let parts = |(file, text): (usize, &String)| {
            let characters: Vec<char> = text.chars().collect();
            characters
                .chunks(Self::PART)
                .map(|part| Self {
                    file,
                    text: part.iter().collect(),
                })
                .collect::<Vec<_>>()
        };
        texts.iter().enumerate().flat_map(parts).collect()
    }
}

/// RIG: who answered, when the run began and at every resumption.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigBody {
    /// Rig time, s.
    pub t: f64,
    pub identity: Identity,
    pub axes: usize,
    pub noise: DeclaredNoise,
    /// m/s
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_speed: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last_move: Option<LastMove>,
    /// Of a real rig where the plan's zero lies in its own coordinate, m, one an axis; None in records of older versions, whose zero is
    /// the rig's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub datum: Option<Vec<f64>>,
    /// The replies in which it said who it is, escaped; empty where the dialect has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub said: Vec<String>,
}

/// INTENT: a target about to leave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IntentBody {
    /// Number of the target in this run, from 1.
    pub n: u64,
    /// Rig time of the record before, s.
    pub t: f64,
    /// As computed, m.
    pub to: Vec<f64>,
    /// As asked, m/s; of a stroke signed.
    pub speed: Option<f64>,
    /// As the bytes say, m and m/s, where they differ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub said: Option<Vec<f64>>,
    pub rate: f64,
    /// The bytes that carry the target, escaped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wire: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u64>,
    /// The targets in the rig's own coordinate, as the bytes say, m, where its zero is another than the plan's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own: Option<Vec<f64>>,
    /// Of a smooth way without a stop: its ends, their velocities, and the time between them; `samples` stands beside it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<Vec<Path>>,
    /// Of a stroke read on the way: how many readings, at most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// SAMPLE: a reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampleBody {
    /// Rig time, s.
    pub t: f64,
    /// m
    pub x: Vec<f64>,
    /// N
    pub r: Vec<f64>,
    /// The replies it was made of, escaped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub raw: Vec<String>,
    /// Where it was asked for and seen: begin and end of the even motion that stands for the last move, s of rig time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// STROKE: a stroke came to its end. A record that has readings and not this was cut off on the way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrokeBody {
    /// Rig time of the last reading, s.
    pub t: f64,
    /// Readings it gave: a rig that cannot keep up gives fewer than were asked for.
    pub samples: usize,
}

/// STEP: the end of a step, as computed; in a replay it must come out the same, bit for bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepBody {
    pub step: u64,
    /// Virtual time of an impact, else rig time, s.
    pub time: f64,
    /// Target, m.
    pub u: f64,
    /// Measured, m.
    pub x: f64,
    /// m/s
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v: Option<f64>,
    /// m/s²
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// N
    pub r: f64,
    /// Energy error over the input; none where it is not finite.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub e: Option<f64>,
    /// The axes after the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<AxisBody>,
}

/// One more axis at the end of a step, as the first stands in [`StepBody`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisBody {
    pub u: f64,
    pub x: f64,
    pub v: f64,
    pub a: f64,
    pub r: f64,
}

/// OPERATOR: what a person answered, or asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "what")]
pub enum OperatorBody {
    Answered {
        note: String,
        answer: Inspection,
    },
    Noted {
        text: String,
    },
    AskedToStop,
    /// Ctrl-C or its like, instead of an answer at an inspection: the record alone tells the two apart.
    AskedToStopInspecting,
    /// Asked whether the rig is to take the load off after a person had stopped the run.
    AnsweredToUnload {
        question: String,
        answer: Inspection,
    },
    /// Not a person, but the client that drives the rig.
    Asked {
        request: Request,
    },
}

/// OPERATOR as it stands in the record: what was said, and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OperatorEntry {
    #[serde(flatten)]
    pub said: OperatorBody,
    /// Records of other builds may have none; a virtual run has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// FAULT: a call on the rig that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaultBody {
    pub t: f64,
    pub call: Call,
    pub fault: RigFault,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// HELD: what became of the rig when it was told to hold for good. Records of older versions have none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldBody {
    /// Rig time, s.
    pub t: f64,
    /// Why nobody knows whether it holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubt: Option<String>,
    /// Where it stood, m, and what it felt, N; none where it could not be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found: Option<(Vec<f64>, Vec<f64>)>,
    /// The replies it was made of, escaped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub raw: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Call {
    Propose,
    Execute,
    Pause,
    Read,
    Traverse,
    /// No call on the rig: the record itself could not be kept, whatever was asked for next.
    Record,
}

/// AMEND: plan or program are no longer those of the header, or of the amendment before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AmendBody {
    pub by: String,
    pub reason: String,
    /// What differs, in words.
    pub differences: Vec<String>,
    /// What holds from here on.
    pub header: Header,
}

/// RESUME: the run goes on. Records from `from` on, up to this one, no longer count; they stay as evidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResumeBody {
    pub from: u64,
    pub by: String,
    pub reason: String,
    pub doubt: Doubt,
    /// What the person who resumes it takes upon themselves.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assured: Vec<Assurance>,
    /// Found before anything moved: m, N.
    pub found: (Vec<f64>, Vec<f64>),
    /// As recorded last: m, N.
    pub recorded: Option<(Vec<f64>, Vec<f64>)>,
    /// Where it held when the run had stopped, where that was read: m, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<(Vec<f64>, Vec<f64>)>,
    /// Who let it move again, and with which words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub released: Option<String>,
    /// Rig time at which the record goes on, s.
    pub t: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// What only a person can know of a rig that a run goes on with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Assurance {
    /// It was not switched off since, and cannot say so itself.
    SamePowerUp,
    /// It was referenced anew.
    ReReferenced,
    /// The force that changed means no harm to the specimen.
    AcceptedRelaxation,
    /// It was held, and may be let go of where it stands.
    LetGo,
}

impl Assurance {
    /// As it is told, behind the name of the person.
    #[must_use]
    pub const fn told(self) -> &'static str {
        match self {
            Self::SamePowerUp => "it was not switched off since",
            Self::ReReferenced => "it was referenced anew",
            Self::AcceptedRelaxation => "the change of the force is accepted",
            Self::LetGo => "it was let go of where it was held",
        }
    }
}

/// RECOVER: a torn end of the file was put aside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoverBody {
    /// Rig time of the record before, s.
    pub t: f64,
    /// Name of the file that it was moved to.
    pub put_aside: String,
}

/// END: what the run says of its own end; count and head are the journal's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EndBody {
    pub outcome: EndOutcome,
}

/// A record has an end only where its run came to its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndOutcome {
    Completed,
}

/// What became of a target that was recorded and perhaps sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "target")]
pub enum Doubt {
    /// The record ended at rest: nothing was in doubt.
    None,
    /// It was carried out; its reading is late.
    Executed,
    /// It never arrived: it is sent now.
    NotExecuted,
    /// It was held on the way: the same absolute target is sent anew.
    HeldOnTheWay,
    /// A way that is read as it is gone was cut off, and is gone on with from where the rig stands: no part of it twice. Where
    /// it began, m.
    RestOfTheWay { from: Vec<f64> },
    /// A stroke was cut off, went on to its end and was mostly not read: the rig goes back to where it began (m; the axes after the first
    /// in `others`), and the stroke begins anew.
    Stroke {
        back_to: f64,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        others: Vec<f64>,
    },
}

/// The bytes of a frame as text that any log can hold.
pub fn escaped(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() + 8);
    for byte in bytes {
        match byte {
            b'\\' | b'\'' | b'"' => text.extend(['\\', char::from(*byte)]),
            b' '..=b'~' => text.push(char::from(*byte)),
            _ => text.extend(byte.escape_ascii().map(char::from)),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn every_byte_is_escaped_as_rust_does() {
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(escaped(&all), all.escape_ascii().to_string());
    }
}
