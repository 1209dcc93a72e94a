//! The uncertainty of the results of an impact. In: its inputs with their sources of uncertainty, and the recorded steps. Out: the
//! contributions of each source to each result. The impact is re-integrated along the recorded force–displacement path with perturbed
//! inputs and readings; no rig is moved.

pub(crate) mod storey;

use super::contact;
use super::results::re_integrated;
use super::setting::{Setting, StruckStructure};
use crate::physics::contact::ContactLaw;
use crate::physics::impact::ImpactError;
use crate::physics::impact::summary::ImpactSummary;
use crate::physics::reintegration::hysteresis_replay::{ContinuousMotion, Reading, RecordedPath};
use crate::physics::reintegration::impact::{ImpactValues, Outcome, predicted_velocities, rerun};
use crate::physics::reintegration::perturbation::Perturbation;
use crate::plan::formula::{Formula, ProcedureId};
use crate::plan::{Impact, Mode, Plan, PointTarget, Striker};
use crate::procedures::common::perturbed_inputs::{
    LEADS_ELSEWHERE, UncertainRun, uncertain_inputs,
};
use crate::procedures::common::results::{Evaluated, flat, give, index_of, layout_of, values};
use crate::record::{ImpactStep, NamedResult};
use crate::run::stop::Stop;
use crate::schema::ResultKind;
use crate::schema::procedures::impact as schema;
use crate::uncertainty::Source;
use crate::uncertainty::engine::{
    CLOSE, Contributions, Evaluate, Evaluation, Progress, Shifts, Unknown,
};

/// The numbers of an impact on one degree of freedom.
fn numbers(values: &ImpactValues, setting: &Setting) -> Evaluated {
    let critical = vec![setting.steps().critical_time_step];
    let mut numbers = re_integrated(values);
    numbers.push((schema::CRITICAL_TIME_STEP, critical));
    numbers
}

/// The uncertain inputs of an impact.
#[derive(Clone, Copy)]
pub(crate) struct ImpactUncertainty<'run> {
    pub run: UncertainRun<'run>,
    pub plan: &'run Impact,
    pub point: &'run PointTarget,
}

impl ImpactUncertainty<'_> {
    /// Gives `results` their contributions.
    pub(crate) fn propagate(
        &self,
        setting: &Setting,
        steps: &[ImpactStep],
        recorded: &ImpactSummary,
        results: &mut [NamedResult],
        progress: Progress<'_, Stop>,
    ) -> Result<(), Unknown<Stop>> {
        let path = self
            .path(setting, steps)
            .ok_or_else(|| "nothing was recorded".to_owned())?;
        let mut evaluate = RecordedImpact {
            uncertainty: self,
            setting,
            path,
            length: 0,
        };
        let unperturbed = evaluate
            .run(setting, &Perturbation::none(1))
            .map_err(|error| error.to_string())?;
        if !same(&unperturbed.values.summary, recorded) {
            return Err(LEADS_ELSEWHERE.to_owned().into());
        }
        let layout = layout_of(&numbers(&unperturbed.values, setting));
        evaluate.length = layout.len();
        let reported = values(&layout, results);
        let mut contributions = self.run.contributions(
            &evaluate,
            1,
            self.sources()?,
            steps.len(),
            reported,
            progress,
        )?;
        for (kind, quantum) in whole_steps(setting.input.time_step) {
            at_least(
                quantum,
                self.run.procedure,
                index_of(&layout, kind),
                &mut contributions,
            );
        }
        give(&layout, contributions, results);
        no_known_force(setting.input.law, recorded, results);
        Ok(())
    }

    /// The recorded path; None without readings.
    fn path(&self, setting: &Setting, steps: &[ImpactStep]) -> Option<RecordedPath> {
        let readings = steps.iter().map(|step| Reading {
            target: step.command,
            displacement: step.displacement,
            force: step.restoring_force,
        });
        let (input, readings) = (&setting.input, readings.collect::<Vec<Reading>>());
        let velocities = (self.plan.stepping.mode != Mode::StepAndPause).then(|| {
            predicted_velocities(input, self.plan.until, setting.steps().count, &readings)
        });
        let motion = velocities.as_deref().map(|velocities| ContinuousMotion {
            velocities,
            time_step: input.time_step,
        });
        RecordedPath::new(readings, motion, input.stiffness, input.noise)
    }

    /// The uncertain inputs, each once.
    fn sources(&self) -> Result<Vec<Source>, String> {
        let Impact {
            striker,
            specimen,
            contact,
            ..
        } = self.plan;
        let PointTarget {
            mass,
            stiffness,
            damping,
            ..
        } = self.point;
        let formulas: Vec<&Formula> = [mass, stiffness, damping]
            .into_iter()
            .chain(contact::formulas(contact))
            .collect();
        let stated = striker_sources(self.run.whole, *striker)
            .into_iter()
            .chain([(Source::SpecimenMass(*specimen), self.point.mass_uncertainty)]);
        uncertain_inputs(&formulas, stated, self.run.results)
    }
}

/// The uncertain inputs of a striker, each with its standard uncertainty.
pub(super) fn striker_sources(whole: &Plan, striker: usize) -> [(Source, f64); 2] {
    let Striker {
        mass_uncertainty,
        velocity_uncertainty,
        ..
    } = whole.strikers[striker];
    [
        (Source::StrikerMass(striker), mass_uncertainty),
        (Source::StrikerVelocity(striker), velocity_uncertainty),
    ]
}

/// An impact along its recorded path.
struct RecordedImpact<'a, 'run> {
    uncertainty: &'a ImpactUncertainty<'run>,
    setting: &'a Setting,
    path: RecordedPath,
    /// Number of values of an evaluation.
    length: usize,
}

impl RecordedImpact<'_, '_> {
    fn run(&self, setting: &Setting, readings: &Perturbation) -> Result<Outcome, ImpactError> {
        rerun(
            &setting.input,
            self.uncertainty.plan.until,
            setting.steps().count,
            &self.path,
            readings,
        )
    }
}

impl Evaluate for RecordedImpact<'_, '_> {
    type Inputs = Setting;

    /// The time step does not change: it was chosen, not measured.
    fn inputs(&self, shifts: Shifts<'_>) -> Result<Setting, String> {
        let ImpactUncertainty { run, plan, point } = *self.uncertainty;
        let declared = &run.whole.strikers[plan.striker];
        let mut striker = declared.clone();
        let mut heavier = 0.0;
        for (source, by) in shifts {
            match source {
                Source::StrikerMass(_) => striker.mass += by * striker.mass_uncertainty,
                Source::StrikerVelocity(_) => striker.velocity += by * striker.velocity_uncertainty,
                Source::SpecimenMass(_) => heavier += by * point.mass_uncertainty,
                // Formulas that read the source change with it; the other sources are those of the instruments.
                _ => {}
            }
        }
        // Impacts of one striker at several speeds have the relative uncertainty of the stated one. They share the critical time step of
        // the fastest impact.
        let faster = striker.velocity / declared.velocity;
        striker.velocity = self.setting.fastest * faster;
        let mut found = run.with_inputs(shifts, &mut |inputs| {
            Setting::of_point(plan, point, &striker, inputs, run.noise)
        })?;
        found.add_mass(heavier);
        found.input.time_step = self.setting.input.time_step;
        if let StruckStructure::Point(steps) = &mut found.structure {
            steps.count = self.setting.steps().count;
        }
        found.input.striker_velocity = self.setting.input.striker_velocity * faster;
        Ok(found)
    }

    fn evaluate(&self, readings: &Perturbation, setting: &Setting) -> Evaluation {
        let Ok(found) = self.run(setting, readings) else {
            return Evaluation::none(self.length);
        };
        let with_step = |values: &ImpactValues| flat(numbers(values, setting));
        Evaluation {
            values: with_step(&found.values),
            before_departure: found.before_departure.as_ref().map(with_step),
            farthest: found.farthest,
        }
    }
}

/// The results that are times at the end of a step, with the standard uncertainty of a step Δt, Δt/√12 \[s\].
pub(crate) fn whole_steps(time_step: f64) -> [(ResultKind, f64); 2] {
    [schema::STOP_TIME, schema::TIME_OF_MAX_DISPLACEMENT]
        .map(|kind| (kind, time_step / 12.0_f64.sqrt()))
}

/// Raises the contribution of the time step to the number at an index to at least this amount.
pub(crate) fn at_least(
    most: f64,
    procedure: ProcedureId,
    index: Option<usize>,
    contributions: &mut Contributions,
) {
    let source = Source::TimeStep { procedure };
    let parts = index
        .and_then(|index| contributions.get_mut(index))
        .into_iter()
        .flatten();
    for part in parts.filter(|part| part.source == source && part.amount.abs() < most) {
        part.amount = most;
    }
}

/// A peak contact force that depends on the time step has no known value: the effects of inputs on it are not its uncertainty.
pub(crate) fn no_known_force(
    law: ContactLaw,
    recorded: &ImpactSummary,
    results: &mut [NamedResult],
) {
    if law.force_follows_the_step(recorded.max_contact_force) {
        let force = results
            .iter_mut()
            .find(|result| result.name == schema::MAX_CONTACT_FORCE.name);
        force
            .into_iter()
            .for_each(|force| force.withhold("it grows without bound as the time step shrinks"));
    }
}

/// Whether two runs have the same results.
pub(crate) fn same(one: &ImpactSummary, other: &ImpactSummary) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= CLOSE * a.abs().max(b.abs());
    let read: [fn(&ImpactSummary) -> f64; 6] = [
        |summary| summary.max_displacement,
        |summary| summary.time_of_max_displacement,
        |summary| summary.stop_time.unwrap_or(-1.0),
        |summary| summary.final_displacement,
        |summary| summary.impulse,
        |summary| summary.absorbed_energy,
    ];
    read.iter().all(|read| near(read(one), read(other)))
}
