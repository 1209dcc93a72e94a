//! The bodies of the entries of a run log, typed. In: events of the run. Out: JSON bodies, and back. Numbers are SI; a
//! float is written as the shortest decimal that reads back to the same bits. It knows no file.

use serde::{Deserialize, Serialize};

use crate::run::{Inspection, Request};
use psd_physics::tracking::trajectory::Path;
use psd_plan::record::equipment::Equipment;
use psd_rig::{DeclaredNoise, FinalHold, Identity, LastMove, RigFault};

/// Written instead of a protocol if the operator drives by hand.
pub const BY_HAND: &str = "by hand";

/// The computation rules of this version. A run log of other rules is refused: its replay would give another run.
pub const RULES: u32 = 1;

/// HEADER: the initial data of a run. They are sufficient to check the plan again on any machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    pub run_id: String,
    pub psd: String,
    /// SHA-256 of the program's sources, hex.
    pub build: String,
    /// The computation rules of the run ([`RULES`]).
    pub rules: u32,
    /// Target, profile and compiler of the build.
    pub toolchain: String,
    /// The plan first, then the files it uses. Their texts follow in PLAN entries.
    pub files: Vec<HeaderFile>,
    /// `--set` values as given.
    pub settings: Vec<(String, String)>,
    /// Name of the rig, as for `--rig`. None: the default of the plan.
    pub rig: Option<String>,
    /// Measuring equipment and limits.
    pub equipment: Equipment,
    /// What the run log keeps of the steps.
    #[serde(default, skip_serializing_if = "LogForm::is_full")]
    pub log: LogForm,
    /// Whether only the measured part of a check run was to run.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub check_run: bool,
    /// Protocol of the clients that drive the rig, or that it is driven by hand. None: the plan's procedures drive it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub served: Option<String>,
    /// As given by `--date`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// For a real rig: the operator and the machine.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub host: Option<String>,
    /// The start, UTC. None if the run log is not kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub began: Option<String>,
}

/// What a run log keeps of the targets, readings and steps of its run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LogForm {
    /// Each of them.
    #[default]
    Full,
    /// Their digests: a simulation repeats them.
    Compact,
}

impl LogForm {
    /// Whether each target, reading and step is an entry.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    fn is_full(&self) -> bool {
        *self == Self::Full
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HeaderFile {
    pub name: String,
    /// Digest of its text, hex.
    pub sha256: String,
}

/// PLAN: a part of a file's text, because a line of the run log has a maximum length.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanBody {
    /// Index in the list of files of the header.
    pub file: usize,
    pub text: String,
}

impl PlanBody {
    /// Characters of a part: at most six bytes each in the run log.
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

/// RIG: the identity of the rig, at the start of the run and at every resumption.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigBody {
    /// Rig time \[s\].
    pub t: f64,
    pub identity: Identity,
    pub axes: usize,
    pub noise: DeclaredNoise,
    /// \[m/s\]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_speed: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last_move: Option<LastMove>,
    /// For a real rig, the position of the plan's zero in its own coordinate \[m\], one per axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub datum: Option<Vec<f64>>,
    /// The replies with its identity, escaped. Empty if the protocol has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub replies: Vec<String>,
}

/// INTENT: a target that is about to be sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IntentBody {
    /// Number of the target in this run, from 1.
    pub n: u64,
    /// Rig time of the entry before \[s\].
    pub t: f64,
    /// As computed \[m\].
    pub to: Vec<f64>,
    /// As requested \[m/s\]; signed for a stroke.
    pub speed: Option<f64>,
    /// As decoded from the bytes \[m\] and \[m/s\], if different.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encoded: Option<Vec<f64>>,
    pub rate: f64,
    /// The bytes that carry the target, escaped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wire: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u64>,
    /// The targets in the rig's own coordinate, as decoded from the bytes \[m\], if its zero is not the plan's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own: Option<Vec<f64>>,
    /// For a smooth motion without a stop: its ends, their velocities, and the time between them; `samples` is then stated
    /// too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<Vec<Path>>,
    /// For a motion with readings during the motion: the largest number of readings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// SAMPLE: a reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampleBody {
    /// Rig time \[s\].
    pub t: f64,
    /// \[m\]
    pub x: Vec<f64>,
    /// \[N\]
    pub r: Vec<f64>,
    /// The replies from which it was decoded, escaped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub raw: Vec<String>,
    /// If it was requested and observed: start and end of the uniform motion equivalent to the last move, rig time \[s\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// STROKE: the end of a stroke. A run log with readings and without this entry was interrupted during the motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrokeBody {
    /// Rig time of the last reading \[s\].
    pub t: f64,
    /// Its number of readings: a rig that cannot keep up makes fewer than requested.
    pub samples: usize,
}

/// STEP: the end of a step, as computed. A replay must give a bit-identical step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepBody {
    pub step: u64,
    /// Simulated time of an impact, else rig time \[s\].
    pub time: f64,
    /// Target \[m\].
    pub u: f64,
    /// Measured \[m\].
    pub x: f64,
    /// \[m/s\]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v: Option<f64>,
    /// \[m/s²\]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// \[N\]
    pub r: f64,
    /// Energy error over the input energy; None if it is not finite.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub e: Option<f64>,
    /// The axes after the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<AxisBody>,
}

/// A further axis at the end of a step; the first axis is in [`StepBody`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisBody {
    pub u: f64,
    pub x: f64,
    pub v: f64,
    pub a: f64,
    pub r: f64,
}

/// DIGEST: targets, readings, ends of strokes and steps since the entry before, as their digest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DigestBody {
    /// Number of all of them.
    pub entries: u64,
    pub steps: u64,
    pub targets: u64,
    /// Rig time of the last reading \[s\].
    pub t: f64,
    /// SHA-256 of them, hex.
    pub sha256: String,
}

/// OPERATOR: an answer or a request of the operator.
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
    /// Ctrl-C or similar, instead of an answer at an inspection: only the run log distinguishes the two.
    AskedToStopInspecting,
    /// The answer to the question whether the rig is to be unloaded after an operator stop.
    AnsweredToUnload {
        question: String,
        answer: Inspection,
    },
    /// Not the operator, but the client that drives the rig.
    Asked {
        request: Request,
    },
}

/// OPERATOR as it is logged: the statement, and its time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OperatorEntry {
    #[serde(flatten)]
    pub statement: OperatorBody,
    /// A virtual run has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// FAULT: a call on the rig that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaultBody {
    pub t: f64,
    pub call: Call,
    pub fault: RigFault,
    /// The reading that exceeded a limit during a motion and ended it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reading: Option<SampleBody>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// HELD: the result of the final hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldBody {
    /// Rig time \[s\].
    pub t: f64,
    /// The reason why the hold is not confirmed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unconfirmed: Option<String>,
    /// Its position \[m\] and force \[N\]. None if they could not be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found: Option<(Vec<f64>, Vec<f64>)>,
    /// The replies from which it was decoded, escaped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub raw: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

impl HeldBody {
    /// The result of a final hold, at its time in the run log.
    pub(super) fn of(halted: &FinalHold, wall: Option<String>) -> Self {
        let FinalHold {
            time,
            unconfirmed,
            found,
            raw,
        } = halted.clone();
        Self {
            t: time,
            unconfirmed,
            found,
            raw: raw.iter().map(|raw| escaped(raw)).collect(),
            wall,
        }
    }

    /// The final hold, without its bytes.
    pub(super) fn into_final_hold(self) -> FinalHold {
        FinalHold {
            time: self.t,
            unconfirmed: self.unconfirmed,
            found: self.found,
            raw: Vec::new(),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Call {
    Propose,
    Execute,
    Pause,
    Read,
    Traverse,
    /// Not a call on the rig: the run log itself failed, whatever the next call was.
    Record,
}

/// AMEND: plan or program differ from those of the header, or of the previous amendment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AmendBody {
    pub by: String,
    pub reason: String,
    /// The differences, as text.
    pub differences: Vec<String>,
    /// The header that applies from this entry on.
    pub header: Header,
}

/// RESUME: the run is continued. The entries from `from` up to this one no longer count; they remain as evidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResumeBody {
    pub from: u64,
    pub by: String,
    pub reason: String,
    pub target_status: TargetStatus,
    /// The assurances of the operator who resumes it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assured: Vec<Assurance>,
    /// Found before any motion: \[m\], \[N\].
    pub found: (Vec<f64>, Vec<f64>),
    /// The last logged values: \[m\], \[N\].
    pub recorded: Option<(Vec<f64>, Vec<f64>)>,
    /// The position and force of the final hold, if they were read: \[m\], \[N\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<(Vec<f64>, Vec<f64>)>,
    /// The operator who enabled motion, and the typed text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub released: Option<String>,
    /// Rig time at which the run log continues \[s\].
    pub t: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<String>,
}

/// An assurance about a rig that only the operator can give when a run is resumed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Assurance {
    /// It was not switched off since then; it cannot report this itself.
    SamePowerUp,
    /// It was referenced again.
    ReReferenced,
    /// The change of force has not damaged the specimen.
    AcceptedRelaxation,
    /// It was on hold, and the hold may be cleared at its position.
    LetGo,
    /// It may move faster than before.
    AcceptedSpeed,
}

impl Assurance {
    /// The text of the report, after the name of the operator.
    #[must_use]
    pub const fn describe(self) -> &'static str {
        match self {
            Self::SamePowerUp => "it was not power-cycled since",
            Self::ReReferenced => "it was referenced again",
            Self::AcceptedRelaxation => "the change of the force is accepted",
            Self::LetGo => "its hold was cleared, and it did not move",
            Self::AcceptedSpeed => "the higher speed is accepted",
        }
    }
}

/// RECOVER: a torn end of the file was put aside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecoverBody {
    /// Rig time of the entry before \[s\].
    pub t: f64,
    /// Name of the file that it was moved to.
    pub put_aside: String,
}

/// END: the end of the run; the run log writes count and head.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EndBody {
    pub outcome: EndOutcome,
}

/// A run log has an END only if its run was completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndOutcome {
    Completed,
}

/// The status of a target that was logged and perhaps sent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "target")]
pub enum TargetStatus {
    /// The run log ended at rest: no target was uncertain.
    None,
    /// It was executed; its reading is made late.
    Executed,
    /// It never arrived: it is sent again.
    NotExecuted,
    /// The rig was held during the motion: the same absolute target is sent again.
    HeldDuringMotion,
    /// A motion with readings during the motion was interrupted. It is continued from the present position: no part of it is travelled
    /// twice. Its start \[m\].
    RemainingMotion { from: Vec<f64> },
    /// A stroke was interrupted, continued to its end, and most of its readings are missing. The rig moves back to its start (\[m\]; the
    /// axes after the first in `others`), and the stroke is repeated.
    Stroke {
        back_to: f64,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        others: Vec<f64>,
    },
}

impl TargetStatus {
    /// Whether the target is sent again, as a new INTENT. Its first INTENT then no longer counts.
    #[must_use]
    pub const fn sends_again(&self) -> bool {
        matches!(self, Self::NotExecuted | Self::HeldDuringMotion)
    }
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

/// The bytes of which [`escaped`] makes this text. None: of none.
pub fn unescaped(text: &str) -> Option<Vec<u8>> {
    let (mut bytes, mut rest) = (Vec::with_capacity(text.len()), text.as_bytes());
    while let [first, after @ ..] = rest {
        let (byte, after) = match (first, after) {
            (b'\\', [b'n', after @ ..]) => (b'\n', after),
            (b'\\', [b'r', after @ ..]) => (b'\r', after),
            (b'\\', [b't', after @ ..]) => (b'\t', after),
            (b'\\', [b'x', high, low, after @ ..]) => (
                u8::from_str_radix(str::from_utf8(&[*high, *low]).ok()?, 16).ok()?,
                after,
            ),
            (b'\\', [own, after @ ..]) | (own, after) => (*own, after),
        };
        bytes.push(byte);
        rest = after;
    }
    (escaped(&bytes) == text).then_some(bytes)
}

#[cfg(test)]
mod tests {
    use super::{escaped, unescaped};

    #[test]
    fn every_byte_is_escaped_as_rust_does() {
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(escaped(&all), all.escape_ascii().to_string());
        assert_eq!(unescaped(&escaped(&all)), Some(all));
        assert!(["\\", "\\x4", "\\x41", "\\q", "\""].map(unescaped) == [const { None }; 5]);
    }
}
