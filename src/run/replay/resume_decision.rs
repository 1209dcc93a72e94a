//! Where a cut-off run stands, before it may go on. In: its record, and what the rig says now without having moved. Out:
//! from which record on it is done again, or why it must not be. A target is sent again only if it never arrived.

use super::entry::{
    Assurance, Doubt, FaultBody, HeldBody, IntentBody, OperatorBody, ResumeBody, RigBody,
    SampleBody,
};
use super::replayed::{Mismatch, Played, Unplayable, body};
use crate::physics::tracking::trajectory::Path;
use crate::plan::{RealLink, RigPlan};
use crate::record::journal::{EntryKind, Line};
use crate::record::{Event, EventKind};
use crate::rig::controllers::NOT_TRUSTED;
use crate::rig::safety::failpoint::{Guarding, on};
use crate::rig::{
    DeclaredNoise, Identity, JUST_STARTED, NO_POWER_UP, Reading, named_axis, of_axis, who,
};
use crate::run::{Inspection, UNLOADING};

/// A rig that no next path is told goes on for so long at most before it holds, s: a controller's 0.25 s, and what its line and
/// its clock may add.
const GOES_ON: f64 = 1.0;

/// How near the rig must stand to where the record left it, one entry an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// m
    pub displacement: Vec<f64>,
    /// N, for the relaxation since.
    pub force: Vec<f64>,
}

impl Bands {
    /// What a rig can tell apart: each axis its own, since what is nothing to a coarse one may be half the force of another.
    #[must_use]
    pub fn of(rig: &RigPlan, link: &RealLink) -> Self {
        let axes = 0..rig.axes().unwrap_or(1);
        let readings = axes.map(|axis| (link.readings_of(axis), link.gate_of(axis)));
        let bands = readings.map(|(read, gate)| {
            (
                rig.settle.band.max(4.0 * read.resolution),
                gate.zero.max(6.0 * read.noise),
            )
        });
        let (displacement, force) = bands.unzip();
        Self {
            displacement,
            force,
        }
    }
}

/// That of the axis at this place; an axis that has none is allowed nothing.
fn band(bands: &[f64], axis: usize) -> f64 {
    bands.get(axis).copied().unwrap_or(0.0)
}

/// The record goes on from here.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Records from this one on no longer count.
    pub from: u64,
    pub doubt: Doubt,
    /// The last reading that counts: m, N.
    pub recorded: Option<(Vec<f64>, Vec<f64>)>,
    /// Where the rig was held when the run had stopped, where that was read: m, N.
    pub held: Option<(Vec<f64>, Vec<f64>)>,
    /// What is sent before anything of the plan is: targets, m, and the speed of the axis with the farthest way, m/s.
    pub sends: Option<(Vec<f64>, f64)>,
}

impl Decision {
    /// The entry that a run goes on with, whose rig was found like this: who resumes it and why, the rig time it goes on at (s).
    #[must_use]
    pub fn resumption(self, by: &str, reason: &str, found: &Reading, time: f64) -> ResumeBody {
        ResumeBody {
            from: self.from,
            by: by.to_owned(),
            reason: reason.to_owned(),
            doubt: self.doubt,
            assured: Vec::new(),
            found: (found.displacement.clone(), found.force.clone()),
            recorded: self.recorded,
            held: self.held,
            released: None,
            t: time,
            wall: None,
        }
    }
}

/// Why a run must not go on by itself.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
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
    Unplayable(#[from] Unplayable),
}

/// Whether the rig that answers is the one of the record, and has neither started anew nor become another program. Where it
/// cannot say whether it was switched off, a person must.
///
/// # Errors
/// It is not; to have referenced it accepts a new start and another firmware.
pub fn same_rig(
    recorded: &Identity,
    found: &Identity,
    assured: &[Assurance],
) -> Result<(), Refusal> {
    let named = |identity: &Identity| format!("{} {}", identity.model, identity.serial);
    if (&recorded.model, &recorded.serial) != (&found.model, &found.serial) {
        return Err(Refusal::OtherRig {
            recorded: named(recorded),
            found: named(found),
        });
    }
    if assured.contains(&Assurance::ReReferenced) {
        return Ok(());
    }
    if recorded.firmware != found.firmware {
        return Err(Refusal::OtherFirmware {
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
    let anew = |(before, now): (&str, &str)| {
        now == JUST_STARTED || before != now && (before, now) != (JUST_STARTED, NO_POWER_UP)
    };
    if before.len() != now.len() || pairs().any(anew) {
        let told = |word: &str| {
            if word == NO_POWER_UP {
                "none".to_owned()
            } else {
                word.to_owned()
            }
        };
        return Err(Refusal::Rebooted {
            recorded: told(&was),
            found: told(&is),
        });
    }
    if on(Guarding::PowerUp)
        && now.contains(&NO_POWER_UP)
        && !assured.contains(&Assurance::SamePowerUp)
    {
        return Err(Refusal::PowerUpUnknown);
    }
    Ok(())
}

/// Whether no device lost its position after the rig was opened last: nobody's word that it was not switched off outweighs the record.
///
/// # Errors
/// One did, and nobody has referenced it since.
pub fn not_restarted(played: &Played, assured: &[Assurance]) -> Result<(), Refusal> {
    if assured.contains(&Assurance::ReReferenced) {
        return Ok(());
    }
    let faults = played
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Fault);
    let told = faults
        .filter_map(|line| body::<FaultBody>(line).ok())
        .map(|fault| fault.fault.to_string());
    match { told }.find(|told| told.contains(NOT_TRUSTED)) {
        Some(told) => Err(Refusal::Restarted { told }),
        None => Ok(()),
    }
}

/// Whether a place is read as finely as before: the stiffness of the next step hangs on it.
///
/// # Errors
/// It is not.
pub fn same_resolution(recorded: DeclaredNoise, found: DeclaredNoise) -> Result<(), Refusal> {
    if recorded.resolution.to_bits() == found.resolution.to_bits() {
        return Ok(());
    }
    Err(Refusal::OtherMeasure { what: "resolution" })
}

/// Whether a number on record means the same place and the same force by another plan: no amendment may turn or scale them.
///
/// # Errors
/// Sign, calibration or dialect differ.
pub fn same_measure(recorded: &RigPlan, now: &RigPlan) -> Result<(), Refusal> {
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
                all.zero_count.to_bits(),
            )
        })
        .collect::<Vec<_>>()
    };
    let differs = |what| Err(Refusal::OtherMeasure { what });
    if recorded.axes() != now.axes() {
        return differs("axes");
    }
    let signs = |rig: &RigPlan| {
        (0..rig.axes().unwrap_or(1))
            .map(|axis| rig.sign_of(axis).to_bits())
            .collect::<Vec<_>>()
    };
    if signs(recorded) != signs(now) {
        return differs("sign");
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

/// Decides from the record, the rig's own memory and one reading.
///
/// # Errors
/// The rig is not where the record can leave it.
pub fn decide(
    played: &Played,
    rig: &RigBody,
    found: &Reading,
    bands: &Bands,
    accept_relaxation: bool,
) -> Result<Decision, Refusal> {
    if played.ended {
        return Err(Refusal::Ended);
    }
    let lines = without_the_end(played)?;
    let Some(last) = lines.last() else {
        return Err(Refusal::NothingRecorded);
    };
    let place = Place {
        positions: &found.displacement,
        bands: &bands.displacement,
    };
    let recorded = last_reading(&lines)?;
    let last_intent = lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent);
    let held = last_held(played, last.seq)?;
    let decision = |from, doubt| Decision {
        from,
        doubt,
        recorded: recorded.clone(),
        held: held.clone(),
        sends: None,
    };
    if let Some((held_at, _)) = &held {
        // Whatever moved it since, nobody recorded: the specimen's history is another one now.
        place.expect(held_at)?;
        relaxed(held.as_ref(), found, bands, accept_relaxation)?;
    }

    let Some(at) = last_intent else {
        // Nothing was ever sent: only readings at rest.
        let start = recorded
            .as_ref()
            .map_or_else(|| vec![0.0; found.displacement.len()], |(x, _)| x.clone());
        place.expect(&start)?;
        relaxed(recorded.as_ref(), found, bands, accept_relaxation)?;
        return Ok(decision(last.seq + 1, Doubt::None));
    };
    let intent: IntentBody = body(&lines[at])?;
    let before = place_before(&lines[..at], found.displacement.len())?;
    let target = intent.to;
    if intent.samples.is_some()
        && lines[at..]
            .iter()
            .all(|line| line.kind != EntryKind::Stroke)
    {
        let taken = lines[at..]
            .iter()
            .filter(|line| line.kind == EntryKind::Sample)
            .count();
        let reached = if taken > 0 {
            recorded.as_ref().map_or(&before, |(x, _)| x)
        } else {
            &before
        };
        let samples = intent.samples.unwrap_or(0);
        let way = Cut {
            reached,
            target: &target,
            paths: intent.path.as_deref(),
            samples,
            taken,
        };
        return Ok(match way.doubt(place, &before)? {
            doubt @ Doubt::Stroke { .. } => decision(lines[at].seq, doubt),
            doubt => decision(last.seq + 1, doubt),
        });
    }
    if at + 1 < lines.len()
        && let Some(paths) = intent.path.as_ref().filter(|_| !place.is(&target))
    {
        // It passed its target, went on as fast as there, and held: brought back, it goes on from rest.
        place.behind(paths)?;
        return Ok(decision(
            last.seq + 1,
            Doubt::Stroke {
                back_to: target[0],
                others: target[1..].to_vec(),
            },
        ));
    }
    if at + 1 < lines.len() {
        place.expect(&target)?;
        relaxed(recorded.as_ref(), found, bands, accept_relaxation)?;
        return Ok(decision(last.seq + 1, Doubt::None));
    }
    if let Some(Doubt::Stroke { .. }) = played.doubt {
        return Ok(decision(
            last.seq + 1,
            played.doubt.clone().unwrap_or(Doubt::None),
        ));
    }
    let doubt = match (&rig.last_move, intent.id) {
        (Some(moved), Some(id))
            if moved.id >= id && place.is(&moved.targets) && place.is(&target) =>
        {
            Doubt::Executed
        }
        (Some(moved), Some(id)) if moved.id < id => {
            place.expect(&before)?;
            Doubt::NotExecuted
        }
        (Some(_), Some(_)) => place.on_the_way(&before, &target)?,
        // Without a memory of moves the place alone tells; where both are as near, the same place is asked for again.
        _ if place.is(&before) => Doubt::NotExecuted,
        _ if place.is(&target) => Doubt::Executed,
        _ => place.on_the_way(&before, &target)?,
    };
    let sends =
        matches!(doubt, Doubt::NotExecuted | Doubt::HeldOnTheWay).then_some((target, intent.rate));
    Ok(Decision {
        sends,
        ..decision(last.seq + 1, doubt)
    })
}

/// Where the rig was held for good behind the record of this number.
fn last_held(played: &Played, last: u64) -> Result<Option<Measured>, Unplayable> {
    let held = played
        .lines
        .iter()
        .rev()
        .take_while(|line| line.seq > last)
        .find(|line| line.kind == EntryKind::Held);
    let held: Option<HeldBody> = held.map(body).transpose()?;
    Ok(held
        .filter(|held| held.doubt.is_none())
        .and_then(|held| held.found))
}

/// The records without what only says that the run stopped: those are said anew, or no more.
pub(super) fn without_the_end(played: &Played) -> Result<Vec<Line>, Refusal> {
    let mut lines: Vec<Line> = played.lines.iter().cloned().collect();
    while let Some(last) = lines.last() {
        match last.kind {
            EntryKind::Fault | EntryKind::Held => {}
            EntryKind::Event => {
                let event: Event = body(last)?;
                if event.kind == EventKind::Hold && event.text == UNLOADING {
                    return Err(Refusal::Unloaded);
                }
            }
            EntryKind::Operator => match body(last)? {
                OperatorBody::AskedToStop
                | OperatorBody::AskedToStopInspecting
                | OperatorBody::AnsweredToUnload { .. }
                | OperatorBody::Answered {
                    answer: Inspection::Stop { .. },
                    ..
                } => {}
                OperatorBody::Answered { .. }
                | OperatorBody::Noted { .. }
                | OperatorBody::Asked { .. } => break,
            },
            _ => break,
        }
        lines.pop();
    }
    let unloading = |line: &Line| {
        line.kind == EntryKind::Event
            && line.body().get("text").and_then(|text| text.as_str()) == Some(UNLOADING)
    };
    if lines.iter().any(unloading) {
        Err(Refusal::Unloaded)
    } else {
        Ok(lines)
    }
}

/// The record from which on a cut-off run may be done again: the stroke that it ends in, where most of it was not read. What the rig did
/// then decides.
pub(super) fn undecided(lines: &[Line]) -> Result<Option<u64>, Unplayable> {
    let Some(at) = lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent)
    else {
        return Ok(None);
    };
    let intent: IntentBody = body(&lines[at])?;
    let is_cut = intent.path.is_none()
        && lines[at..]
            .iter()
            .all(|line| line.kind != EntryKind::Stroke);
    let taken = lines[at..]
        .iter()
        .filter(|line| line.kind == EntryKind::Sample)
        .count();
    let lost = intent
        .samples
        .is_some_and(|samples| mostly_lost(samples, taken));
    Ok((is_cut && lost).then_some(lines[at].seq))
}

/// One reading that is lost is made at the end of the way, late.
const fn mostly_lost(samples: usize, taken: usize) -> bool {
    taken + 1 < samples && 2 * taken < samples
}

/// m and N, one entry a degree of freedom.
type Measured = (Vec<f64>, Vec<f64>);

fn last_reading(lines: &[Line]) -> Result<Option<Measured>, Unplayable> {
    let last = lines
        .iter()
        .rev()
        .find(|line| line.kind == EntryKind::Sample);
    last.map(|line| body::<SampleBody>(line).map(|sample| (sample.x, sample.r)))
        .transpose()
}

/// Where the rig stood before an intent: at the targets before, or where it was first read.
fn place_before(lines: &[Line], axes: usize) -> Result<Vec<f64>, Unplayable> {
    if let Some(line) = lines
        .iter()
        .rev()
        .find(|line| line.kind == EntryKind::Intent)
    {
        return body::<IntentBody>(line).map(|intent| intent.to);
    }
    let first = lines.iter().find(|line| line.kind == EntryKind::Sample);
    first.map_or_else(
        || Ok(vec![0.0; axes]),
        |line| body::<SampleBody>(line).map(|sample| sample.x),
    )
}

/// A relaxation beyond its band is for a person to accept.
fn relaxed(
    recorded: Option<&(Vec<f64>, Vec<f64>)>,
    found: &Reading,
    bands: &Bands,
    accept: bool,
) -> Result<(), Refusal> {
    let Some((_, recorded)) = recorded.filter(|_| !accept) else {
        return Ok(());
    };
    let inside = |(axis, (recorded, found)): (usize, (&f64, &f64))| {
        (found - recorded).abs() <= band(&bands.force, axis)
    };
    let Some(place) = recorded
        .iter()
        .zip(&found.force)
        .enumerate()
        .position(|axis| !inside(axis))
    else {
        return Ok(());
    };
    let (axis, band) = (
        named_axis(place, found.force.len()),
        band(&bands.force, place),
    );
    Err(Refusal::Relaxed {
        recorded: recorded[place],
        found: found.force[place],
        band,
        axis,
    })
}

/// A way that was read as it was gone, and cut off.
struct Cut<'a> {
    /// Where its last reading was, else where it began, m.
    reached: &'a [f64],
    target: &'a [f64],
    /// Of a way that is no straight one.
    paths: Option<&'a [Path]>,
    /// Readings that were wanted, and those on record.
    samples: usize,
    taken: usize,
}

impl Cut<'_> {
    /// A specimen that has a memory goes no way twice: what is left is gone from where the rig stands. Only a stroke that went on to
    /// its end by itself, and of which most was not read, is begun anew.
    fn doubt(&self, place: Place<'_>, before: &[f64]) -> Result<Doubt, Refusal> {
        match self.paths {
            Some(paths) => {
                let (low, high): (Vec<f64>, Vec<f64>) = paths.iter().map(may_be_held).unzip();
                place.on_the_way(&low, &high)?;
            }
            None if mostly_lost(self.samples, self.taken)
                && place.is(self.target)
                && !place.is(self.reached) =>
            {
                return Ok(Doubt::Stroke {
                    back_to: before[0],
                    others: before[1..].to_vec(),
                });
            }
            None => {
                place.on_the_way(self.reached, self.target)?;
            }
        }
        Ok(Doubt::RestOfTheWay {
            from: before.to_vec(),
        })
    }
}

/// Where an axis may hold that was on a path, on its way to it, or past it, m: as fast as it was at either end it goes on.
fn may_be_held(path: &Path) -> (f64, f64) {
    let (low, high) = path.reach();
    let (short, past) = (
        path.from + GOES_ON * path.start_velocity,
        path.to + GOES_ON * path.end_velocity,
    );
    (low.min(short).min(past), high.max(short).max(past))
}

#[derive(Clone, Copy)]
struct Place<'a> {
    /// One an axis, m.
    positions: &'a [f64],
    /// One an axis, m.
    bands: &'a [f64],
}

impl Place<'_> {
    fn is(self, place: &[f64]) -> bool {
        self.astray(place).is_none()
    }

    /// The first axis that is not at its `place`; one that has none is nowhere.
    fn astray(self, place: &[f64]) -> Option<usize> {
        let near =
            |axis, place: &f64, position: &f64| (position - place).abs() <= band(self.bands, axis);
        let at = |(axis, position): (usize, &f64)| {
            place
                .get(axis)
                .is_some_and(|place| near(axis, place, position))
        };
        self.positions.iter().enumerate().position(|axis| !at(axis))
    }

    fn expect(self, recorded: &[f64]) -> Result<(), Refusal> {
        let Some(place) = self.astray(recorded) else {
            return Ok(());
        };
        let (found, recorded) = (
            self.positions[place],
            recorded.get(place).copied().unwrap_or(f64::NAN),
        );
        let band = band(self.bands, place);
        Err(Refusal::Elsewhere {
            recorded,
            found,
            band,
            axis: named_axis(place, self.positions.len()),
        })
    }

    /// Whether each axis stands between the end of its path and where it may have come from there before it held.
    fn behind(self, paths: &[Path]) -> Result<(), Refusal> {
        let ends: Vec<f64> = paths.iter().map(|path| path.to).collect();
        let farthest: Vec<f64> = paths
            .iter()
            .map(|path| path.to + GOES_ON * path.end_velocity)
            .collect();
        self.on_the_way(&ends, &farthest).map(drop)
    }

    fn on_the_way(self, from: &[f64], to: &[f64]) -> Result<Doubt, Refusal> {
        let ways = self.positions.iter().zip(from.iter().zip(to));
        for (place, (found, (from, to))) in ways.enumerate() {
            let band = band(self.bands, place);
            let (low, high) = (from.min(*to) - band, from.max(*to) + band);
            if !(low <= *found && *found <= high) {
                let axis = named_axis(place, self.positions.len());
                return Err(Refusal::Lost {
                    from: *from,
                    to: *to,
                    found: *found,
                    axis,
                });
            }
        }
        Ok(Doubt::HeldOnTheWay)
    }
}
