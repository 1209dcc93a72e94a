//! Impacts that run in batches, for studies. In: the plan of a run whose only procedure is an impact. Out: its outcome, and the record of
//! its procedure without steps; or why the impact has to run on the rig. It moves nothing.
//!
//! On an ideal rig every reading at rest is its target and the force there, so the steps of `physics::impact::batch` are those of the run. An
//! impact beyond a limit is integrated again, to find the step in which the guard stops it.

use crate::procedures::impact::results::{of_impact, of_steps};
use crate::procedures::impact::setting::Setting;
use crate::run::inputs::Inputs;
use crate::run::stop::Stop;
use psd_physics::impact::batch::{self, Batched, Reach};
use psd_physics::impact::summary::{ImpactEnding, Wanted};
use psd_physics::impact::{ImpactState, Sink};
use psd_physics::integrator::state::State;
use psd_physics::relaxation::relaxation_state::RelaxationState;
use psd_physics::specimen::SpecimenModel;
use psd_plan::formula::{NoResults, ProcedureId};
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{
    History, Identity, ImpactHistory, ImpactSteps, Outcome, ProcedureRecord, Record,
};
use psd_plan::schema::ResultKind;
use psd_plan::{Impact, Interval, Limits, Mode, Plan, Procedure, Until};
use psd_rig::{DeclaredNoise, RigFault, fault_of_ideal_step};

/// An impact that can run in a batch.
#[derive(Clone, Debug)]
pub(crate) struct BatchedImpact {
    impact: batch::Impact,
    until: Until,
    steps: u64,
    limits: Limits,
    time_step: f64,
    critical_time_step: f64,
}

/// Results of an impact that only its steps give.
const OF_STEPS: [&str; 3] = [
    schema::RESTORING_ENERGY.name,
    schema::DAMPING_ENERGY.name,
    schema::STEPS.name,
];

/// Whether a result is wanted, as a part of what is.
type WantedPart = fn(&mut Wanted) -> &mut bool;

/// Results of an impact that cost a part of each step.
const OF_EVERY_STEP: [(ResultKind, WantedPart); 5] = [
    (schema::TIME_OF_MAX_DISPLACEMENT, |it| {
        &mut it.time_of_max_displacement
    }),
    (schema::ABSORBED_ENERGY, |it| &mut it.absorbed_energy),
    (schema::MAX_VELOCITY, |it| &mut it.max_velocity),
    (schema::MAX_CONTACT_FORCE, |it| &mut it.max_contact_force),
    (schema::IMPULSE, |it| &mut it.impulse),
];

/// What a batch has to find for these results.
fn wanted(results: &[&str]) -> Wanted {
    let mut wanted = Wanted::default();
    for name in results {
        if let Some((_, part)) = OF_EVERY_STEP.iter().find(|(kind, _)| kind.name == *name) {
            *part(&mut wanted) = true;
        }
    }
    wanted
}

/// Whether a batch gives this result of an impact.
pub(crate) fn gives(result: &str) -> bool {
    let history = without_steps(0.0, 0.0, ImpactEnding::default());
    let known = of_impact(None, &history).chain(of_steps(&history));
    let mut names = known.map(|(kind, _)| kind.name);
    names.any(|name| name == result) && !OF_STEPS.contains(&result)
}

impl BatchedImpact {
    /// The impact that is the only procedure of a plan; None if it has to run on the rig.
    pub(crate) fn of(plan: &Impact, whole: &Plan) -> Option<Self> {
        let point = plan.point().filter(|_| whole.procedures.len() == 1)?;
        let specimen = &whole.specimens[plan.specimen];
        let behaviour = specimen.behaviour.as_ref()?;
        let relaxes = !RelaxationState::new(behaviour).is_none();
        let stops = plan.stepping.mode == Mode::RampAndHold;
        // A damper has no force at rest; friction remains.
        let has_friction = specimen.coulomb != 0.0;
        if !(is_ideal(whole) && stops) || has_friction || relaxes {
            return None;
        }
        let striker = &whole.strikers[plan.striker];
        let mut inputs = Inputs::new(&NoResults, ProcedureId(0));
        let setting =
            Setting::of_point(plan, point, striker, &mut inputs, DeclaredNoise::NONE).ok()?;
        let steps = setting.steps();
        let impact = batch::Impact {
            input: setting.input,
            specimen: SpecimenModel::new(behaviour),
        };
        impact.is_batched(Some(plan.until)).then_some(Self {
            impact,
            until: plan.until,
            steps: steps.count,
            limits: whole.limits.held(),
            time_step: steps.time_step,
            critical_time_step: steps.critical_time_step,
        })
    }

    /// Gives a record its outcome and those of its results that are `read`, unless the rig has to find them.
    fn end(&self, result: &Batched, read: &[bool], record: &mut Record) -> Result<(), Leaves> {
        let Batched {
            summary,
            ending,
            reach,
        } = result;
        if !(summary.energy_error.is_finite() && summary.final_displacement.is_finite()) {
            return Err(Leaves::NotFinite);
        }
        if !within(&self.limits, &Reach::default()) {
            return Err(Leaves::OutsideAtStart);
        }
        let stop = if within(&self.limits, reach) {
            None
        } else {
            self.stop()
        };
        let history = without_steps(self.time_step, self.critical_time_step, *ending);
        // What is known of an impact that was stopped is not a result.
        let summary = stop.is_none().then_some(summary);
        let results = of_impact(summary, &history).chain(of_steps(&history));
        let results = results.zip(read).filter(|(_, read)| **read);
        let results = results.map(|((kind, value), _)| kind.found(value));
        let procedure = &mut record.procedures[0];
        procedure.complete = stop.is_none();
        procedure.results.clear();
        procedure.results.extend(results);
        procedure.history = History::Impact(history);
        record.outcome = stop.map_or(Outcome::Completed, |fault| Stop::Rig(fault).outcome());
        Ok(())
    }

    /// The fault with which the guard stops it.
    fn stop(&self) -> Option<RigFault> {
        let mut stopped = Stopped {
            limits: &self.limits,
            position: 0.0,
            fault: None,
        };
        // An impact that has results can be integrated.
        let _ = self
            .impact
            .simulate(Some(self.until), self.steps, &mut stopped);
        stopped.fault
    }
}

/// Why an impact leaves its batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leaves {
    /// Its values need the rig.
    NeedsRig,
    OutsideAtStart,
    NotFinite,
}

/// Finds the first step that a guard stops.
struct Stopped<'a> {
    limits: &'a Limits,
    /// At the last step end \[m\].
    position: f64,
    fault: Option<RigFault>,
}

impl<V> Sink<V> for Stopped<'_> {
    fn push(&mut self, _: &State<V>, state: &ImpactState, _: bool) {
        if self.fault.is_none() {
            let step = [self.position, state.displacement];
            self.fault = fault_of_ideal_step(self.limits, step, state.restoring_force);
            self.position = state.displacement;
        }
    }
}

fn without_steps(time_step: f64, critical_time_step: f64, ending: ImpactEnding) -> ImpactHistory {
    ImpactHistory {
        steps: ImpactSteps::default(),
        ending,
        frame: None,
        time_step,
        critical_time_step,
    }
}

/// The records of impacts of one procedure on a rig, each with its number among them and without steps: it is the same record, with other
/// results. `results`: the names of those that are read.
pub(crate) fn run(
    of: &Procedure,
    rig: Identity,
    impacts: &[BatchedImpact],
    results: &[&str],
    mut read: impl FnMut(usize, Result<&Record, Leaves>),
) {
    let mut record = Record {
        rig,
        procedures: vec![ProcedureRecord {
            name: of.name.clone(),
            kind: of.kind.keyword(),
            complete: false,
            inputs: Vec::new(),
            results: Vec::new(),
            history: History::Impact(without_steps(0.0, 0.0, ImpactEnding::default())),
            axial: Vec::new(),
        }],
        events: Vec::new(),
        outcome: Outcome::Completed,
        drift: None,
    };
    let bounds = |limits: &Limits| {
        [limits.displacement, limits.force, limits.increment]
            .iter()
            .any(|limit| limit.is_bounded())
    };
    let wanted = Wanted {
        reach: impacts.iter().any(|impact| bounds(&impact.limits)),
        ..wanted(results)
    };
    let mut found: Vec<Option<Batched>> = impacts.iter().map(|_| None).collect();
    let mut left: Vec<usize> = (0..impacts.len()).collect();
    while let Some(first) = left.first() {
        let (until, steps) = (impacts[*first].until, impacts[*first].steps);
        let (together, others): (Vec<usize>, Vec<usize>) = left
            .into_iter()
            .partition(|at| impacts[*at].until == until && impacts[*at].steps == steps);
        let batch: Vec<batch::Impact> = together
            .iter()
            .map(|at| impacts[*at].impact.clone())
            .collect();
        for (at, result) in together
            .into_iter()
            .zip(batch::run(&batch, Some(until), steps, wanted))
        {
            found[at] = result.ok();
        }
        left = others;
    }
    let history = without_steps(0.0, 0.0, ImpactEnding::default());
    let known = of_impact(None, &history).chain(of_steps(&history));
    let is_read: Vec<bool> = known
        .map(|(kind, _)| results.contains(&kind.name))
        .collect();
    for (number, (impact, found)) in impacts.iter().zip(found).enumerate() {
        let ended = match found {
            Some(found) => impact.end(&found, &is_read, &mut record),
            None => Err(Leaves::NeedsRig),
        };
        read(number, ended.map(|()| &record));
    }
}

/// Whether every reading of the rig at rest is the target and the force there, and no limit depends on more than the reach of an impact.
fn is_ideal(plan: &Plan) -> bool {
    let Some(link) = plan.rig.link.as_virtual() else {
        return false;
    };
    let limits = &plan.limits;
    let not_watched = |limit: Interval| !limit.is_bounded();
    link.is_exact()
        && link.predicted.is_none()
        && plan.rig.polarity == 1.0
        && plan.rig.zero_drift.is_none()
        && plan.rig.limits_of_axes(limits).is_empty()
        // The rig moves at its own speed, the largest that the limit allows.
        && limits.speed.low <= 0.0
        && not_watched(limits.energy_error)
        // Errors of tracking are zero.
        && limits.tracking_error.contains(0.0)
        && limits.tracking_energy_error.low <= 0.0
        && limits.nrms_error.contains(0.0)
}

/// Whether every target, reading and increment was inside its limit.
fn within(limits: &Limits, reach: &Reach) -> bool {
    let inside = |limit: Interval, range: [f64; 2]| range.iter().all(|end| limit.contains(*end));
    inside(limits.displacement, reach.displacement)
        && inside(limits.force, reach.restoring_force)
        && inside(limits.increment, [0.0, reach.increment])
}
