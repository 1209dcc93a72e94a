//! Reasons why a run must not be resumed automatically, each with its message.

use crate::run::replay::logged_run::{Mismatch, UnreadableLog};
use psd_rig::{of_axis, who};
use psd_text::units::Dimension;
use psd_text::units::display::plain;

/// Why a run must not be resumed automatically.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResumeRefusal {
    #[error("the run is complete: nothing is left to resume")]
    Ended,
    #[error("the run log has no rig: start a new run")]
    NothingRecorded,
    #[error("the specimen was unloaded when the run stopped: its history cannot be continued")]
    Unloaded,
    #[error("this is a different rig: {found} answered, the run log has {recorded}")]
    OtherRig { recorded: String, found: String },
    #[error(
        "the rig was restarted since ({recorded} became {found}): reference it, then confirm with --re-referenced"
    )]
    Rebooted { recorded: String, found: String },
    #[error(
        "this rig cannot report whether it was power-cycled since. If it was not, confirm with --same-power-up; otherwise \
         reference it, then confirm with --re-referenced"
    )]
    PowerUpUnknown,
    #[error(
        "the run log shows that the rig restarted during the run ({fault}): reference it, then confirm with --re-referenced"
    )]
    Restarted { fault: String },
    #[error(
        "the firmware of the rig differs from the run log ({recorded} became {found}): check that its meaning is the same, \
         reference the rig, then confirm with --re-referenced"
    )]
    OtherFirmware { recorded: String, found: String },
    #[error(
        "{} is at {}, but its last logged position is {} (limit ±{}). Move it back with `psd rig jog`, then resume",
        who(*.axis), position(*.found), position(*.recorded), position(*.band)
    )]
    Elsewhere {
        recorded: f64,
        found: f64,
        band: f64,
        axis: Option<usize>,
    },
    #[error(
        "{} is at {}, outside its last commanded move ({} → {}). Move it back with `psd rig jog`, then resume",
        who(*.axis), position(*.found), position(*.from), position(*.to)
    )]
    Lost {
        from: f64,
        to: f64,
        found: f64,
        axis: Option<usize>,
    },
    #[error(
        "{} holds {}, but the run log allows {} .. {}: the axial load of the run is not on the specimen any more",
        who(*.axis), force(*.found), force(*.low), force(*.high)
    )]
    WithoutLoad {
        found: f64,
        low: f64,
        high: f64,
        axis: Option<usize>,
    },
    #[error(
        "the force{} is {}, but its last logged value, {}, allows {} .. {} here: inspect the specimen and the load cell, then confirm with \
         --accept-relaxation",
        of_axis(*.axis), force(*.found), force(*.recorded), force(*.low), force(*.high)
    )]
    Relaxed {
        recorded: f64,
        found: f64,
        low: f64,
        high: f64,
        axis: Option<usize>,
    },
    #[error("{}", faster(.what, *.was, *.is))]
    Faster {
        what: &'static str,
        was: f64,
        is: f64,
    },
    #[error("the plan differs from the plan of the run log: {0}")]
    Otherwise(#[from] Mismatch),
    #[error("the recorded run already ended with: {reason}. Nothing is left to resume")]
    EndsAgain { reason: String },
    #[error(
        "`{what}` of the rig differs from the run log: earlier readings would have a different meaning"
    )]
    OtherMeasure { what: &'static str },
    #[error(transparent)]
    UnreadableLog(#[from] UnreadableLog),
}

/// A position in m, as text with its unit.
fn position(position: f64) -> String {
    plain(position, Dimension::LENGTH, 6)
}

/// A force in N, as text with its unit.
fn force(force: f64) -> String {
    plain(force, Dimension::FORCE, 6)
}

/// The rig would move faster than before; an infinite limit is none.
fn faster(what: &str, was: f64, is: f64) -> String {
    let speed = |speed: f64| {
        if speed.is_finite() {
            plain(speed, Dimension::VELOCITY, 6)
        } else {
            "none".to_owned()
        }
    };
    format!(
        "the rig would move faster than before: its {what}, {}, became {}. If it may, confirm with --accept-speed",
        speed(was),
        speed(is)
    )
}
