//! The shape of a run log, checked before it is replayed. In: the lines of a run log, and their plan. Out: the first entry
//! in a wrong order, or with lists whose length differs from the number of axes. It compares no numbers: that is done by
//! the replay.

use super::entry::Header;
use super::entry::{
    Call, DigestBody, FaultBody, HeldBody, IntentBody, LogForm, ResumeBody, RigBody, SampleBody,
    StepBody, TargetStatus,
};
use super::plain_body::Body;
use super::steps_digest::DIGEST_STEPS;
use psd_plan::Plan;
use psd_rig::journal::{EntryKind, Line, Recovered};
use psd_text::count::counted;

/// An entry that no run of its plan can have written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("entry {seq} ({}) is malformed: {reason}", .kind.word())]
pub struct Malformed {
    pub seq: u64,
    pub kind: EntryKind,
    pub reason: String,
}

/// Checks every line against the axes of the rig and against the lines before it.
///
/// # Errors
/// The first inconsistent line.
pub fn well_formed(recovered: &Recovered, plan: &Plan, header: &Header) -> Result<(), Malformed> {
    let mut shape = Shape {
        plan,
        header,
        rig: None,
        short_digest: false,
    };
    let malformed = |line: &Line, reason| Malformed {
        seq: line.seq,
        kind: line.kind,
        reason,
    };
    recovered
        .lines
        .iter()
        .try_for_each(|line| shape.take(line).map_err(|reason| malformed(line, reason)))
}

struct Shape<'a> {
    plan: &'a Plan,
    header: &'a Header,
    /// The first rig that answered.
    rig: Option<FirstRig>,
    /// Whether the entry before is a digest that another entry ended.
    short_digest: bool,
}

#[derive(Clone, Copy)]
struct FirstRig {
    axes: usize,
    /// Number of its entry.
    seq: u64,
    /// A pause of a virtual rig never fails.
    is_virtual: bool,
}

impl Shape<'_> {
    fn take(&mut self, line: &Line) -> Result<(), String> {
        self.fits_its_form(line.kind)?;
        let after_short_digest = std::mem::take(&mut self.short_digest);
        match line.kind {
            EntryKind::Rig => self.answered(&body_of(line)?, line.seq),
            EntryKind::Intent => self.sent(&body_of(line)?),
            EntryKind::Sample => {
                let SampleBody { x, r, .. } = body_of(line)?;
                self.moves(&[("x", &x), ("r", &r)])
            }
            EntryKind::Step => self.ended(&body_of(line)?),
            EntryKind::Digest if after_short_digest => {
                Err("the digest before it has fewer steps, and no other entry ended it".to_owned())
            }
            EntryKind::Digest => {
                let digest: DigestBody = body_of(line)?;
                self.short_digest = digest.steps < DIGEST_STEPS;
                self.rig().map(drop)
            }
            EntryKind::Held => {
                let held: HeldBody = body_of(line)?;
                held.found
                    .map_or(Ok(()), |(x, r)| self.moves(&[("found", &x), ("found", &r)]))
            }
            EntryKind::Fault => self.failed(&body_of(line)?),
            EntryKind::Resume => self.resumed(&body_of(line)?, line.seq),
            EntryKind::Stroke
            | EntryKind::Operator
            | EntryKind::Event
            | EntryKind::LineStatistics => self.rig().map(drop),
            EntryKind::Header
            | EntryKind::Plan
            | EntryKind::Amend
            | EntryKind::Recover
            | EntryKind::End => Ok(()),
        }
    }

    /// A compact run log is that of a simulation, which was not resumed. It has digests where a full one has entries.
    fn fits_its_form(&self, kind: EntryKind) -> Result<(), String> {
        let is_compact = self.header.log == LogForm::Compact;
        let fits = match kind {
            EntryKind::Header if is_compact => {
                self.plan.rig.link.as_virtual().is_some() && self.header.served.is_none()
            }
            EntryKind::Rig => !is_compact || self.rig.is_none(),
            EntryKind::Digest => is_compact,
            EntryKind::Intent
            | EntryKind::Sample
            | EntryKind::Stroke
            | EntryKind::Step
            | EntryKind::Held
            | EntryKind::LineStatistics
            | EntryKind::Recover
            | EntryKind::Amend
            | EntryKind::Resume => !is_compact,
            EntryKind::Header
            | EntryKind::Plan
            | EntryKind::Operator
            | EntryKind::Event
            | EntryKind::Fault
            | EntryKind::End => true,
        };
        let form = if is_compact { "compact" } else { "full" };
        fits.then_some(())
            .ok_or_else(|| format!("a {form} run log has no such entry"))
    }

    fn rig(&self) -> Result<FirstRig, String> {
        self.rig.ok_or_else(|| "no RIG precedes it".to_owned())
    }

    /// Checks that each list has an entry for every axis of the rig, and that the plan moves the same number of axes.
    fn moves(&self, lists: &[(&str, &[f64])]) -> Result<(), String> {
        let FirstRig { axes, .. } = self.rig()?;
        let planned = self.plan.axes_on_the_rig();
        if axes != planned {
            return Err(format!(
                "the plan moves {}, but the rig has {axes}",
                counted(planned, "axis", "axes")
            ));
        }
        match lists.iter().find(|(_, list)| list.len() != axes) {
            Some((name, list)) => Err(format!(
                "its `{name}` has {}, but the rig has {}",
                counted(list.len(), "entry", "entries"),
                counted(axes, "axis", "axes")
            )),
            None => Ok(()),
        }
    }

    fn answered(&mut self, rig: &RigBody, seq: u64) -> Result<(), String> {
        let is_virtual = rig.identity.simulated && self.plan.rig.link.as_real().is_none();
        let first = *self.rig.get_or_insert(FirstRig {
            axes: rig.axes,
            seq,
            is_virtual,
        });
        if rig.axes != first.axes {
            return Err(format!(
                "it has {}, but the rig of entry {} has {}",
                counted(rig.axes, "axis", "axes"),
                first.seq,
                first.axes
            ));
        }
        match &rig.last_move {
            Some(last) if last.targets.len() != rig.axes => Err(format!(
                "its `last_move` has {}, but the rig has {}",
                counted(last.targets.len(), "entry", "entries"),
                counted(rig.axes, "axis", "axes")
            )),
            _ => Ok(()),
        }
    }

    fn sent(&self, intent: &IntentBody) -> Result<(), String> {
        self.moves(&[
            ("to", &intent.to),
            ("encoded", intent.encoded.as_ref().unwrap_or(&intent.to)),
        ])?;
        let paths = intent.path.as_ref().map_or(intent.to.len(), Vec::len);
        if paths == intent.to.len() {
            return Ok(());
        }
        Err(format!(
            "its `path` has {}, but the rig has {}",
            counted(paths, "entry", "entries"),
            counted(intent.to.len(), "axis", "axes")
        ))
    }

    fn ended(&self, step: &StepBody) -> Result<(), String> {
        let FirstRig { axes, .. } = self.rig()?;
        // A step has no axial axis.
        let axial = self.plan.rig.axial_axes(&self.plan.limits).count();
        let axes = axes.saturating_sub(axial);
        if step.axes.is_empty() || step.axes.len() + 1 == axes {
            return Ok(());
        }
        Err(format!(
            "its `axes` has {}, but the rig has {}",
            counted(step.axes.len(), "entry", "entries"),
            counted(axes, "axis", "axes")
        ))
    }

    /// A failure of the run log itself may be reported before any rig answered.
    fn failed(&self, fault: &FaultBody) -> Result<(), String> {
        if fault.call == Call::Record {
            return Ok(());
        }
        let is_virtual = self.rig()?.is_virtual;
        if is_virtual && fault.call == Call::Pause {
            return Err("no pause of a virtual rig fails".to_owned());
        }
        match &fault.reading {
            Some(_) if is_virtual => Err("no limit ends a motion of a virtual rig".to_owned()),
            Some(SampleBody { x, r, .. }) => self.moves(&[("x", x), ("r", r)]),
            None => Ok(()),
        }
    }

    fn resumed(&self, resume: &ResumeBody, seq: u64) -> Result<(), String> {
        let FirstRig { seq: first, .. } = self.rig()?;
        if resume.from <= first || resume.from > seq {
            return Err(format!(
                "it continues from entry {}, which is not an earlier entry of this run",
                resume.from
            ));
        }
        let found = Some(&resume.found);
        for (name, measured) in [
            ("found", found),
            ("recorded", resume.recorded.as_ref()),
            ("held", resume.held.as_ref()),
        ] {
            let Some((x, r)) = measured else { continue };
            self.moves(&[(name, x), (name, r)])?;
        }
        match &resume.target_status {
            TargetStatus::None
            | TargetStatus::Executed
            | TargetStatus::NotExecuted
            | TargetStatus::HeldDuringMotion => Ok(()),
            TargetStatus::RemainingMotion { from } => self.moves(&[("from", from)]),
            TargetStatus::Stroke { back_to, others } => {
                let back: Vec<f64> = std::iter::once(*back_to)
                    .chain(others.iter().copied())
                    .collect();
                self.moves(&[("back_to", &back)])
            }
        }
    }
}

fn body_of<T: Body>(line: &Line) -> Result<T, String> {
    line.read_by(T::of_plain).map_err(|fault| fault.to_string())
}
