//! The record of a run: every event, reading and result, typed, in SI. `run` and `procedures` write
//! it; verdict, tables, figures and reports are functions of it. It does not know how it is
//! printed.

pub mod equipment;
pub mod failpoint;
pub mod floors;
mod found;
mod held;
mod identity;
pub mod remote;
mod zero_drift;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::formula::{Estimate, ResultReference, ResultValue, Results, UncertaintyStatus};
pub use crate::procedures::histories::*;
pub use crate::procedures::{History, Integrated};
use crate::schema::block_of_words;
use crate::uncertainty::{Contribution, Source, combined_entries};
pub use floors::{FloorMotion, FloorStep, Floors, FloorsAt, StillGrowing, StruckFrame};
pub use held::Held;
pub use identity::Identity;
pub use psd_physics::contact::state::StepState;
pub use psd_physics::identification::LineFit;
pub use psd_physics::identification::bilinear_fit::BilinearFit;
pub use psd_physics::identification::multilinear_fit::MultilinearFit;
pub use psd_physics::relaxation::hold::Hold;
pub use psd_physics::relaxation::superposition::{LawFit, SuperpositionFit};
pub use psd_physics::relaxation::time_constant::RelaxationFit;
pub use psd_physics::structure::{FrameEnergies, Modes};
use psd_text::units::Dimension;
pub use zero_drift::{AxisDrift, Beyond, Drift, Zero};

/// The measurements and events of a run, all numbers in SI. Every output is a function of it, its plan and its assessment.
#[derive(Clone, Debug)]
pub struct Record {
    pub rig: Identity,
    /// In the order of execution; procedures after a stop are missing.
    pub procedures: Vec<ProcedureRecord>,
    pub events: Vec<Event>,
    pub outcome: Outcome,
    /// The zero drift of the rig, if the rig states a limit for it.
    pub drift: Option<Drift>,
}

impl Record {
    /// The procedure in which a run ended early, and the number of the step; None: in no procedure.
    #[must_use]
    pub fn stop_position(&self) -> Option<(&str, u64)> {
        let mut events = self.events.iter().rev();
        let last = events.find(|event| event.procedure.is_some())?;
        let next = last.step.map_or(1, |step| step + 1);
        Some((last.procedure.as_deref()?, next))
    }
}

/// How the run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    Completed,
    /// Stopped by a limit or by the operator: exit 4.
    Aborted {
        reason: String,
    },
    /// No motion was enabled, and nothing moved: exit 4.
    NotReleased {
        reason: String,
    },
    /// A value of the plan, known only in the run, cannot be used: exit 1.
    Blocked {
        reason: String,
    },
    /// The rig failed: exit 3.
    Faulted {
        reason: String,
    },
}

/// The end of the text of an inspection of a simulated rig without a terminal.
pub const NO_OPERATOR_ASKED: &str = "no operator was asked: simulated rig, no terminal";

/// The event in the run log before a stopped run unloads.
pub const UNLOADING: &str = "unloading to where the run began";

/// Between a value and its limit, in the text of a limit that was broken.
pub const IS_OUTSIDE: &str = " is outside its limit ";

/// An event for the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Rig time \[s\].
    pub time: f64,
    pub procedure: Option<String>,
    pub step: Option<u64>,
    pub kind: EventKind,
    pub text: String,
}

/// The kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    Note,
    Inspection,
    LimitBreach,
    Hold,
    /// The position at which the rig holds after an early end.
    Held,
    /// The hold is not confirmed.
    NotHeld,
    Fault,
    /// Communication errors that were recovered: frames sent again, replies ignored, readings repeated.
    Recovered,
    /// A numerical observation: the contact was still active at the last step, a maximum was not reached, …
    Remark,
    /// The run is continued after an interruption or a stop.
    Resume,
    /// The plan, the program or a limit has changed since the start of the run.
    Amendment,
}

impl EventKind {
    /// Its name in reports, also in `summary.json`.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Inspection => "inspection",
            Self::LimitBreach => "limit breach",
            Self::Hold => "hold",
            Self::Held => "held",
            Self::NotHeld => "not confirmed held",
            Self::Fault => "fault",
            Self::Recovered => "recovered",
            Self::Remark => "observation",
            Self::Resume => "resume",
            Self::Amendment => "amendment",
        }
    }
}

/// The inputs and results of one procedure.
#[derive(Clone, Debug)]
pub struct ProcedureRecord {
    pub name: String,
    /// The block's keyword: `impact`.
    pub kind: &'static str,
    /// Whether it was completed.
    pub complete: bool,
    /// Inputs as evaluated for this procedure: name, value, dimension.
    pub inputs: Vec<(&'static str, Estimate, Dimension)>,
    /// In the order of the schema.
    pub results: Vec<NamedResult>,
    pub history: History,
    /// Readings of the axial axes during it; empty without an axial axis.
    pub axial: Vec<AxialReading>,
}

/// A result under its name in the language.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedResult {
    pub name: &'static str,
    pub value: ResultValue,
    pub dimension: Dimension,
    /// The uncertainty contributions of a number, or of each entry of a list. Empty if its uncertainty is a separate contribution, or if
    /// it has none.
    pub contributions: Vec<Contribution>,
    /// Why its uncertainty is withheld; it then has no contributions.
    pub withheld: Option<String>,
}

impl ProcedureRecord {
    /// The value of the result with this name. None for a list, and if this run has no value.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.result(name)?.value.number()
    }

    /// The entries of the list with this name. None for a number.
    #[must_use]
    pub fn list(&self, name: &str) -> Option<&[f64]> {
        self.result(name)?.value.list()
    }

    /// The result of this name.
    #[must_use]
    pub fn result(&self, name: &str) -> Option<&NamedResult> {
        NamedResult::of(&self.results, name)
    }
}

impl NamedResult {
    /// The result of this name.
    #[must_use]
    pub fn of<'a>(results: &'a [Self], name: &str) -> Option<&'a Self> {
        results.iter().find(|result| result.name == name)
    }

    /// Standard uncertainty of each entry of a list; empty if none is known.
    #[must_use]
    pub fn entry_uncertainties(&self) -> Vec<Option<f64>> {
        match &self.value {
            ResultValue::List(values) if !self.contributions.is_empty() => {
                combined_entries(&self.contributions, values.len())
            }
            _ => Vec::new(),
        }
    }

    /// The uncertainty contributions of the result of this `reference`.
    #[must_use]
    pub fn contributions_of(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
        match self.value {
            ResultValue::Number {
                uncertainty: Some(own),
                ..
            } if self.contributions.is_empty() => {
                let result = Source::Fit {
                    procedure: reference.procedure,
                    result: self.name,
                };
                vec![Contribution::new(result, own)].into()
            }
            _ => Cow::Borrowed(&self.contributions),
        }
    }
}

impl NamedResult {
    /// Withholds its uncertainty for this reason. The first reason remains.
    pub fn withhold(&mut self, reason: &str) {
        self.contributions.clear();
        if let ResultValue::Number { uncertainty, .. } = &mut self.value {
            *uncertainty = None;
        }
        self.withheld.get_or_insert_with(|| reason.to_owned());
    }

    /// What is known of the uncertainty of a result, or of one entry of a list, for a procedure of this kind.
    #[must_use]
    pub fn uncertainty_status(&self, kind: &str, entry: Option<usize>) -> UncertaintyStatus {
        let words: Vec<&str> = kind.split(' ').collect();
        let measured = block_of_words(&words)
            .and_then(|block| block.result(self.name))
            .is_some_and(|result| result.measured);
        let exists = self.value.values().iter().any(|value| value.is_finite());
        if !measured || !exists {
            return UncertaintyStatus::Exact;
        }
        if let Some(reason) = &self.withheld {
            return UncertaintyStatus::Withheld(format!(
                "U of `{}` is withheld: {reason}",
                self.name
            ));
        }
        let lacks = match &self.value {
            ResultValue::Number { value, uncertainty } => value.is_some() && uncertainty.is_none(),
            ResultValue::List(values) => {
                let known = self.entry_uncertainties();
                let lacks = |(at, value): (usize, &f64)| {
                    value.is_finite() && known.get(at).is_none_or(Option::is_none)
                };
                let read = |at: usize| entry.is_none_or(|entry| entry == at);
                let mut values = values.iter().enumerate().filter(|(at, _)| read(*at));
                values.any(lacks)
            }
        };
        if lacks {
            UncertaintyStatus::Partial(format!(
                "no uncertainty of `{}` is known, but a guard band requires one",
                self.name
            ))
        } else {
            UncertaintyStatus::Known
        }
    }
}

impl Results for Record {
    /// Procedures are recorded in the plan's order, so the index is the same.
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let found = self
            .procedures
            .get(reference.procedure.0)?
            .result(reference.name)?;
        Some(found.value.clone())
    }

    fn contributions(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
        let found = self
            .procedures
            .get(reference.procedure.0)
            .and_then(|procedure| procedure.result(reference.name));
        found.map_or_else(Cow::default, |found| found.contributions_of(reference))
    }

    fn degrees(&self, source: Source) -> f64 {
        let (Source::Fit { procedure, result }
        | Source::FitEntry {
            procedure, result, ..
        }) = source
        else {
            return f64::INFINITY;
        };
        let history = self
            .procedures
            .get(procedure.0)
            .map(|procedure| &procedure.history);
        history
            .and_then(|history| history.degrees(result))
            .unwrap_or(f64::INFINITY)
    }

    fn uncertainty_status(
        &self,
        reference: ResultReference,
        entry: Option<usize>,
    ) -> UncertaintyStatus {
        let found = self.procedures.get(reference.procedure.0);
        found
            .and_then(|procedure| Some((procedure.result(reference.name)?, procedure.kind)))
            .map_or(UncertaintyStatus::Exact, |(result, kind)| {
                result.uncertainty_status(kind, entry)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::EventKind;

    /// Run logs of all versions have these words.
    #[test]
    fn the_kinds_of_events_keep_their_words_in_a_run_log() {
        let words = [
            (EventKind::Note, "note"),
            (EventKind::Inspection, "inspection"),
            (EventKind::LimitBreach, "limit_breach"),
            (EventKind::Hold, "hold"),
            (EventKind::Held, "held"),
            (EventKind::NotHeld, "not_held"),
            (EventKind::Fault, "fault"),
            (EventKind::Recovered, "recovered"),
            (EventKind::Remark, "remark"),
            (EventKind::Resume, "resume"),
            (EventKind::Amendment, "amendment"),
        ];
        for (kind, word) in words {
            assert_eq!(serde_json::to_value(kind).unwrap(), word);
        }
    }
}
