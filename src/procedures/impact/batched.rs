//! Impacts that run in batches, for studies. In: the plan of a run whose only procedure is an impact. Out: the record of its procedure
//! without steps, or None where the impact has to run on the rig. It moves nothing.
//!
//! On an ideal rig every reading is its target and the force there, so the steps of `physics::impact::batch` are those of the run. An
//! impact that a limit would stop, or whose peaks were not reached, runs on the rig: its outcome depends on its steps.

use crate::procedures::impact::results::{of_impact, of_steps};
use crate::procedures::impact::setting::Setting;
use crate::run::inputs::Inputs;
use psd_physics::impact::batch::{self, Batched, Reach};
use psd_physics::specimen::SpecimenModel;
use psd_plan::formula::{NoResults, ProcedureId};
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{History, ImpactHistory, ProcedureRecord, StillGrowing};
use psd_plan::{Impact, Interval, Limits, Mode, Plan, Procedure, Until};
use psd_rig::DeclaredNoise;

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

/// Whether a batch gives this result of an impact.
pub(crate) fn gives(result: &str) -> bool {
    let history = without_steps(0.0, 0.0);
    let known = of_impact(None, &history).map(|found| found.name);
    let times = of_steps(&history).map(|found| found.name);
    known.chain(times).any(|name| name == result) && !OF_STEPS.contains(&result)
}

impl BatchedImpact {
    /// The impact that is the only procedure of a plan; None if it has to run on the rig.
    pub(crate) fn of(plan: &Impact, whole: &Plan) -> Option<Self> {
        let point = plan.point().filter(|_| whole.procedures.len() == 1)?;
        let specimen = &whole.specimens[plan.specimen];
        let behaviour = specimen.behaviour.as_ref()?;
        let undamped = specimen.damping == 0.0 && specimen.coulomb == 0.0;
        if !(is_ideal(whole) && undamped && plan.stepping.mode == Mode::StepAndPause) {
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

    /// The record of its procedure, unless its outcome depends on its steps.
    fn record(&self, of: &Procedure, result: &Batched) -> Option<ProcedureRecord> {
        let Batched { summary, reach } = result;
        // A largest value at the last step may not be the peak.
        let peaked = summary.stop_time.is_some()
            && !summary.still_rising
            && reach.last_velocity.abs() < summary.max_velocity
            && (reach.last_contact_force < summary.max_contact_force
                || reach.last_contact_force == 0.0);
        if !(peaked && summary.energy_error.is_finite() && within(&self.limits, reach)) {
            return None;
        }
        let history = without_steps(self.time_step, self.critical_time_step);
        let results = of_impact(Some(summary), &history).chain(of_steps(&history));
        Some(ProcedureRecord {
            name: of.name.clone(),
            kind: of.kind.keyword(),
            complete: true,
            inputs: Vec::new(),
            results: results.collect(),
            history: History::Impact(history),
        })
    }
}

fn without_steps(time_step: f64, critical_time_step: f64) -> ImpactHistory {
    ImpactHistory {
        steps: Vec::new(),
        frame: None,
        time_step,
        critical_time_step,
        growing: StillGrowing::default(),
    }
}

/// The records of impacts of one procedure, in their order; None for one that has to run on the rig.
pub(crate) fn run(of: &Procedure, impacts: &[BatchedImpact]) -> Vec<Option<ProcedureRecord>> {
    let mut records = vec![None; impacts.len()];
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
            .zip(batch::run(&batch, Some(until), steps))
        {
            records[at] = result
                .ok()
                .and_then(|result| impacts[at].record(of, &result));
        }
        left = others;
    }
    records
}

/// Whether every reading of the rig is the target and the force there, and no limit depends on more than the reach of an impact.
fn is_ideal(plan: &Plan) -> bool {
    let Some(link) = plan.rig.link.as_virtual() else {
        return false;
    };
    let errors = [
        link.noise,
        link.resolution,
        link.force_resolution,
        link.lag,
        link.tracking,
        link.drift,
    ];
    let limits = &plan.limits;
    let not_watched = |limit: Interval| !limit.is_bounded();
    errors.iter().all(|error| *error == 0.0)
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
