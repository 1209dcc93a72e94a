//! Whether the rig that answers is the one of the run log: identity, power-up, resolution, calibration.

use super::refusal::ResumeRefusal;
use crate::run::replay::entry::{Assurance, FaultBody};
use crate::run::replay::logged_run::{LoggedRun, body};
use psd_plan::{RealLink, RigPlan};
use psd_rig::controllers::NOT_TRUSTED;
use psd_rig::journal::EntryKind;
use psd_rig::safety::failpoint::{Guarding, on};
use psd_rig::{DeclaredNoise, Identity, JUST_STARTED, NO_POWER_UP};

/// Whether the rig that answers is that of the run log, and has neither restarted nor changed its firmware. If it cannot report whether
/// it was switched off, the operator must.
///
/// # Errors
/// It is not. If it was referenced again, a restart and a different firmware are accepted.
pub fn same_rig(
    recorded: &Identity,
    found: &Identity,
    assured: &[Assurance],
) -> Result<(), ResumeRefusal> {
    let named = |identity: &Identity| format!("{} {}", identity.model, identity.serial);
    if (&recorded.model, &recorded.serial) != (&found.model, &found.serial) {
        return Err(ResumeRefusal::OtherRig {
            recorded: named(recorded),
            found: named(found),
        });
    }
    if assured.contains(&Assurance::ReReferenced) {
        return Ok(());
    }
    if recorded.firmware != found.firmware {
        return Err(ResumeRefusal::OtherFirmware {
            recorded: recorded.firmware.clone(),
            found: found.firmware.clone(),
        });
    }
    let power_up = |identity: &Identity| {
        identity
            .boot
            .clone()
            .unwrap_or_else(|| NO_POWER_UP.to_owned())
    };
    let (was, is) = (power_up(recorded), power_up(found));
    let (before, now): (Vec<&str>, Vec<&str>) =
        (was.split(" + ").collect(), is.split(" + ").collect());
    let pairs = || before.iter().copied().zip(now.iter().copied());
    let restarted = |(before, now): (&str, &str)| {
        now == JUST_STARTED || before != now && (before, now) != (JUST_STARTED, NO_POWER_UP)
    };
    if before.len() != now.len() || pairs().any(restarted) {
        let shown = |word: &str| {
            if word == NO_POWER_UP {
                "none".to_owned()
            } else {
                word.to_owned()
            }
        };
        return Err(ResumeRefusal::Rebooted {
            recorded: shown(&was),
            found: shown(&is),
        });
    }
    if on(Guarding::PowerUp)
        && now.contains(&NO_POWER_UP)
        && !assured.contains(&Assurance::SamePowerUp)
    {
        return Err(ResumeRefusal::PowerUpUnknown);
    }
    Ok(())
}

/// Whether every device kept its position after the rig was opened last. The run log takes precedence over an assurance that the rig was
/// not switched off.
///
/// # Errors
/// A device lost its position, and was not referenced since then.
pub fn not_restarted(logged: &LoggedRun, assured: &[Assurance]) -> Result<(), ResumeRefusal> {
    if assured.contains(&Assurance::ReReferenced) {
        return Ok(());
    }
    let faults = logged
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Fault);
    let messages = faults
        .filter_map(|line| body::<FaultBody>(line).ok())
        .map(|fault| fault.fault.to_string());
    match { messages }.find(|fault| fault.contains(NOT_TRUSTED)) {
        Some(fault) => Err(ResumeRefusal::Restarted { fault }),
        None => Ok(()),
    }
}

/// Whether a position is read with the same resolution as before. The stiffness of the next step depends on it.
///
/// # Errors
/// It is not.
pub fn same_resolution(recorded: DeclaredNoise, found: DeclaredNoise) -> Result<(), ResumeRefusal> {
    if recorded.resolution.to_bits() == found.resolution.to_bits() {
        return Ok(());
    }
    Err(ResumeRefusal::OtherMeasure { what: "resolution" })
}

/// Whether the rig moves no faster than before: by its own speed, by the limit of speed, and by the highest speed of the plan. Pairs of
/// speeds before and now \[m/s\].
///
/// # Errors
/// It moves faster, and the operator has not accepted it.
pub fn no_faster(
    speeds: &[(&'static str, Option<f64>, Option<f64>)],
    assured: &[Assurance],
) -> Result<(), ResumeRefusal> {
    if assured.contains(&Assurance::AcceptedSpeed) {
        return Ok(());
    }
    for (what, was, is) in speeds {
        if let (Some(was), Some(is)) = (*was, *is)
            && is > was
        {
            return Err(ResumeRefusal::Faster { what, was, is });
        }
    }
    Ok(())
}

/// Whether a logged number means the same position and the same force under a different plan: no amendment may change polarity or scale.
///
/// # Errors
/// Polarity, calibration or protocol differ.
pub fn same_measure(recorded: &RigPlan, now: &RigPlan) -> Result<(), ResumeRefusal> {
    let dialects = |rig: &RigPlan| {
        let devices = rig.link.as_real().map_or_else(Vec::new, RealLink::devices);
        devices
            .into_iter()
            .map(|(name, device)| (name, device.dialect.clone()))
            .collect::<Vec<_>>()
    };
    let scale = |rig: &RigPlan| {
        let of = |axis| rig.calibration_of(axis);
        let axes = (0..rig.axes().unwrap_or(1)).map(of);
        axes.map(|all| {
            (
                all.newtons_per_count.map(f64::to_bits),
                all.zero_offset.to_bits(),
            )
        })
        .collect::<Vec<_>>()
    };
    let differs = |what| Err(ResumeRefusal::OtherMeasure { what });
    if recorded.axes() != now.axes() {
        return differs("axes");
    }
    let signs = |rig: &RigPlan| {
        (0..rig.axes().unwrap_or(1))
            .map(|axis| rig.polarity_of(axis).to_bits())
            .collect::<Vec<_>>()
    };
    if signs(recorded) != signs(now) {
        return differs("polarity");
    }
    if scale(recorded) != scale(now) {
        return differs("calibration");
    }
    if dialects(recorded) != dialects(now) {
        return differs("link");
    }
    let datum = |rig: &RigPlan| rig.link.as_real().map(|link| link.datum.clone());
    if datum(recorded) != datum(now) {
        return differs("datum");
    }
    Ok(())
}
