//! Reasons why a run must not be resumed automatically, each with its message.

use crate::rig::{of_axis, who};
use crate::run::replay::logged_run::{Mismatch, UnreadableLog};

/// Why a run must not be resumed automatically.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResumeRefusal {
    #[error("the run came to its end: there is nothing to go on with")]
    Ended,
    #[error("nothing was recorded of the rig: start the run anew")]
    NothingRecorded,
    #[error("the specimen was unloaded when the run stopped: its history cannot be continued")]
    Unloaded,
    #[error("this is another rig: {found} answered, the record is of {recorded}")]
    OtherRig { recorded: String, found: String },
    #[error(
        "the rig started anew since ({recorded} became {found}): reference it, then say so with --re-referenced"
    )]
    Rebooted { recorded: String, found: String },
    #[error(
        "this rig cannot say whether it was switched off since: if you know that it was not, say so with --same-power-up; else \
         reference it, then say so with --re-referenced"
    )]
    PowerUpUnknown,
    #[error(
        "the record says that it started anew in the run ({told}): reference it, then say so with --re-referenced"
    )]
    Restarted { told: String },
    #[error(
        "the rig's firmware is no longer the one of the record ({recorded} became {found}): see that it means the same, reference \
         the rig, then say so with --re-referenced"
    )]
    OtherFirmware { recorded: String, found: String },
    #[error(
        "{} stands at {found} m; the record left it at {recorded} m, {band} m is allowed: bring it back by hand, then resume",
        who(*.axis)
    )]
    Elsewhere {
        recorded: f64,
        found: f64,
        band: f64,
        axis: Option<usize>,
    },
    #[error("{} stands at {found} m, between nothing the record knows: from {from} m to {to} m it was to go", who(*.axis))]
    Lost {
        from: f64,
        to: f64,
        found: f64,
        axis: Option<usize>,
    },
    #[error(
        "the force{} is {found} N, the record left it at {recorded} N, {band} N is allowed: look at the specimen, then say so with --accept-relaxation",
        of_axis(*.axis)
    )]
    Relaxed {
        recorded: f64,
        found: f64,
        band: f64,
        axis: Option<usize>,
    },
    #[error("the plan is not the one of the record: {0}")]
    Otherwise(#[from] Mismatch),
    #[error("done again from its record, the run ends where it ended: {reason}")]
    EndsAgain { reason: String },
    #[error(
        "`{what}` of the rig is no longer the one of the record: what was measured would mean something else"
    )]
    OtherMeasure { what: &'static str },
    #[error(transparent)]
    UnreadableLog(#[from] UnreadableLog),
}
