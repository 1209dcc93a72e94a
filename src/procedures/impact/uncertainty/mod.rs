//! The uncertainty of the results of an impact. In: its inputs with their sources of uncertainty, and the recorded steps. Out: the
//! contributions of each source to each result. The impact is re-integrated along the recorded force–displacement path with perturbed
//! inputs and readings; no rig is moved.

mod storey;

use super::contact;
use super::results::re_integrated;
use super::setting::{Setting, StruckStructure};
use crate::procedures::common::perturbed_inputs::{
    LEADS_ELSEWHERE, RecordedValues, UncertainRun, uncertain_inputs,
};
use crate::procedures::common::results::{Evaluated, flat, give, layout_of, values};
use crate::procedures::stepping::frame_uncertainty::FrameUncertainty;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::contact::ContactLaw;
use psd_physics::impact::ImpactError;
use psd_physics::impact::summary::ImpactSummary;
use psd_physics::reintegration::impact::{ImpactValues, Outcome, predicted_velocities, rerun};
use psd_physics::reintegration::perturbation::Perturbation;
use psd_physics::reintegration::recorded_path::{ContinuousMotion, Reading, RecordedPath};
use psd_physics::structure::substructures::Substructures;
use psd_plan::formula::Formula;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{ImpactHistory, NamedResult};
use psd_plan::schema::ResultKind;
use psd_plan::uncertainty::engine::{
    CLOSE, Contributions, Evaluate, Evaluation, Progress, Shifts, Unknown,
};
use psd_plan::uncertainty::{Contribution, Refinement, Source};
use psd_plan::{Impact, ImpactTarget, Mode, Plan, PointTarget, Striker};
use storey::StoreyRecord;

/// The numbers of an impact on one degree of freedom.
fn numbers(values: &ImpactValues, setting: &Setting) -> Evaluated {
    let critical = vec![setting.steps().critical_time_step];
    let mut numbers = re_integrated(values);
    numbers.push((schema::CRITICAL_TIME_STEP, critical));
    numbers.push(counted(values));
    numbers
}

/// The number of contacts. It is exact; only its change in finer steps is read.
#[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
pub(crate) fn counted(values: &ImpactValues) -> (ResultKind, Vec<f64>) {
    (schema::CONTACTS, vec![values.summary.contacts as f64])
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
        readings: Vec<Reading>,
        recorded: &ImpactSummary,
        results: &mut [NamedResult],
        progress: Progress<'_, Stop>,
    ) -> Result<(), Unknown<Stop>> {
        let steps = readings.len();
        let path = self
            .path(setting, readings)
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
        let contributions = self.run.contributions(
            &evaluate,
            1,
            self.sources()?,
            RecordedValues {
                steps,
                reported,
                nominal: Some(RecordedImpact::evaluation(&unperturbed, setting)),
            },
            progress,
        )?;
        give_resolved(setting.input.law, recorded, &layout, contributions, results);
        Ok(())
    }

    /// The recorded path; None without readings.
    fn path(&self, setting: &Setting, readings: Vec<Reading>) -> Option<RecordedPath> {
        let input = &setting.input;
        let velocities = (self.plan.stepping.mode != Mode::RampAndHold).then(|| {
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

/// An impact as it was recorded.
#[derive(Clone, Copy)]
pub(crate) struct RecordedRun<'a> {
    pub setting: &'a Setting,
    pub history: &'a ImpactHistory,
    pub summary: &'a ImpactSummary,
    /// At its start; None if the rig carries the whole structure.
    pub substructures: Option<&'a Substructures>,
}

/// The uncertain inputs of an impact on either structure.
#[derive(Clone, Copy)]
pub(crate) enum UncertaintyInputs<'a> {
    Point(ImpactUncertainty<'a>),
    Storey(FrameUncertainty<'a>),
}

impl<'a> UncertaintyInputs<'a> {
    pub(crate) fn new(
        plan: &'a Impact,
        whole: &'a Plan,
        inputs: &Inputs<'a>,
        session: &Session<'_>,
    ) -> Self {
        let run = UncertainRun::new(whole, inputs, session.guard.declared_noise());
        match &plan.target {
            ImpactTarget::Point(point) => Self::Point(ImpactUncertainty { run, plan, point }),
            ImpactTarget::Storey(storey) => Self::Storey(FrameUncertainty::new(
                run,
                plan.specimen,
                &storey.damping,
                storey.damping_uncertainty,
                &plan.stepping,
            )),
        }
    }

    /// Gives the results of an impact their contributions.
    pub(crate) fn propagate(
        &self,
        plan: &Impact,
        recorded: RecordedRun<'_>,
        results: &mut [NamedResult],
        progress: Progress<'_, Stop>,
    ) -> Result<(), Unknown<Stop>> {
        let RecordedRun {
            setting,
            history,
            summary,
            substructures,
        } = recorded;
        match (self, &history.frame) {
            (Self::Storey(storey), Some(frame)) => storey::propagate(
                storey,
                plan,
                StoreyRecord {
                    setting,
                    floors: &frame.floors,
                    summary,
                    substructures,
                },
                results,
                progress,
            ),
            (Self::Point(point), _) => point.propagate(
                setting,
                history.steps.readings(),
                summary,
                results,
                progress,
            ),
            (Self::Storey(_), None) => Ok(()),
        }
    }

    /// Those of impact number `index` of a series, from 0.
    pub(crate) fn of_impact(mut self, index: usize) -> Self {
        let run = match &mut self {
            Self::Point(ImpactUncertainty { run, .. })
            | Self::Storey(FrameUncertainty { run, .. }) => run,
        };
        *run = run.of_impact(index);
        self
    }
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

    fn evaluation(found: &Outcome, setting: &Setting) -> Evaluation {
        let with_step = |values: &ImpactValues| flat(numbers(values, setting));
        Evaluation {
            values: with_step(&found.values),
            before_departure: found.before_departure.as_ref().map(with_step),
            farthest: found.farthest,
        }
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
        self.run(setting, readings).map_or_else(
            |_| Evaluation::none(self.length),
            |found| Self::evaluation(&found, setting),
        )
    }
}

/// Gives results their contributions; the last of the layout are the contacts, which are exact. Results whose size or whose change with
/// the time step is not known have their uncertainty withheld.
pub(crate) fn give_resolved(
    law: ContactLaw,
    recorded: &ImpactSummary,
    layout: &[(&'static str, usize)],
    mut contributions: Contributions,
    results: &mut [NamedResult],
) {
    let largest = recorded.max_contact_force;
    let contacts = contributions.pop().unwrap_or_default();
    let other_contacts = contacts
        .iter()
        .any(|part| !part.source.is_of_uncertainty() && part.amount != 0.0);
    let mut withheld = Vec::new();
    let mut first = 0;
    for (name, count) in &layout[..layout.len() - 1] {
        let parts = &contributions[first..first + count];
        first += count;
        let grows = schema::BLOCK
            .result(name)
            .is_some_and(|kind| kind.grows_as_inverse_step);
        if grows && law.force_follows_the_step(largest) {
            withheld.push((*name, GROWS));
        } else if law.blows_follow_the_step(largest)
            && parts
                .iter()
                .any(|parts| is_unresolved(parts, other_contacts))
        {
            withheld.push((*name, UNRESOLVED));
        }
    }
    give(&layout[..layout.len() - 1], contributions, results);
    for (name, reason) in withheld {
        if let Some(result) = results.iter_mut().find(|result| result.name == name) {
            result.withhold(reason);
        }
    }
}

/// Why a peak contact force has no uncertainty.
const GROWS: &str = "it grows without bound as the time step shrinks";
/// Why the effect of the time step is not known.
const UNRESOLVED: &str = "its contacts follow the time step, and finer steps change them. Use a smaller time step, or a contact law that \
    converges, such as `restitution(…)`";

/// Whether the differences in finer steps do not show where they lead: there are other contacts, or the two halvings change the number in
/// opposite directions.
fn is_unresolved(parts: &[Contribution], other_contacts: bool) -> bool {
    let of = |steps| {
        let part = parts
            .iter()
            .find(|part| part.source == Source::TimeStep(steps));
        part.map_or(0.0, |part| part.amount)
    };
    let [own, half, quarter] = Refinement::ALL.map(of);
    let (first, second) = (half - own, quarter - half);
    (first != 0.0 || second != 0.0) && (other_contacts || first * second <= 0.0)
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
