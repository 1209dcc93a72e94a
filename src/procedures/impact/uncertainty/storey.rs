//! The uncertainty of the results of an impact on a storey. In: its inputs with their sources of uncertainty, and the recorded steps. Out:
//! the contributions of each source to each number. The frame is re-integrated along its recorded path.

use super::super::contact;
use super::super::results::re_integrated;
use super::super::setting::Setting;
use super::{counted, give_resolved, same, striker_sources};
use crate::procedures::common::perturbed_inputs::{LEADS_ELSEWHERE, RecordedValues};
use crate::procedures::common::results::{Evaluated, flat, index_of, layout_of, values};
use crate::procedures::stepping;
use crate::procedures::stepping::frame_uncertainty::{FrameUncertainty, leads_there, with_noise};
use crate::procedures::stepping::setting::FrameSteps;
use crate::run::stop::Stop;
use psd_physics::impact::ImpactInput;
use psd_physics::impact::summary::ImpactSummary;
use psd_physics::reintegration::frame::{
    FloorImpact, FloorImpactOutcome, Floors, FrameRun, StrikerOutcome,
};
use psd_physics::reintegration::frame_path::FramePath;
use psd_physics::reintegration::impact::ImpactValues;
use psd_physics::reintegration::perturbation::Perturbation;
use psd_physics::structure::substructures::Substructures;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{FloorStep, NamedResult};
use psd_plan::uncertainty::engine::{Evaluate, Evaluation, Progress, Shifts, Unknown};
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{Impact, StoreyTarget, Striker};

/// An impact on a storey as it was recorded.
#[derive(Clone, Copy)]
pub(crate) struct StoreyRecord<'a> {
    pub setting: &'a Setting,
    pub floors: &'a [FloorStep],
    pub summary: &'a ImpactSummary,
    /// At the start of the impact; None if the rig carries the whole frame.
    pub substructures: Option<&'a Substructures>,
}

/// Gives `results` their contributions.
pub(crate) fn propagate(
    uncertainty: &FrameUncertainty<'_>,
    plan: &Impact,
    recorded: StoreyRecord<'_>,
    results: &mut [NamedResult],
    progress: Progress<'_, Stop>,
) -> Result<(), Unknown<Stop>> {
    let StoreyRecord {
        setting,
        floors: history,
        summary,
        substructures,
    } = recorded;
    let (Some(target), Some(frame)) = (plan.storey(), setting.frame()) else {
        return Err("no floor of a frame is struck".to_owned().into());
    };
    let path = uncertainty.path(
        frame,
        history.iter().map(|step| &step.floors),
        substructures,
    )?;
    let axes = uncertainty.axes();
    let mut evaluate = RecordedStoreyImpact {
        uncertainty,
        plan,
        target,
        setting,
        frame,
        path,
        length: 0,
    };
    let inputs = evaluate.inputs(&[])?;
    let mut found = inputs
        .run
        .struck(&inputs.impact, &evaluate.path, &Perturbation::none(axes))
        .map_err(|error| error.to_string())?;
    if !same(&found.impact.values.summary, summary)
        || !leads_there(&found.floors.ends, schema::FLOOR_DISPLACEMENT, results)
    {
        return Err(LEADS_ELSEWHERE.to_owned().into());
    }
    // With velocities the path is another one.
    let stops = found.floors.velocities.is_empty();
    evaluate.path = uncertainty.with_velocities(
        frame,
        evaluate.path,
        std::mem::take(&mut found.floors.velocities),
        substructures,
    )?;
    let layout = layout_of(&inputs.numbers(
        &found.impact.values,
        &found.striker,
        &found.floors.between,
        inputs.run.time_step,
    ));
    let mut reported = values(&layout, results);
    evaluate.length = reported.len();
    with_noise(&found.floors.between, &layout, &mut reported);
    let stated = striker_sources(uncertainty.run.whole, plan.striker);
    let sources = uncertainty.sources(&contact::formulas(&plan.contact), &stated)?;
    let mut contributions = uncertainty.run.contributions(
        &evaluate,
        axes,
        sources,
        RecordedValues {
            steps: history.len(),
            reported,
            nominal: stops.then(|| inputs.evaluation(&found, 1)),
        },
        progress,
    )?;
    if let Some(duration) = index_of(&layout, schema::CONTACT_DURATION) {
        // From the beginning of a step to the end of one: two times, each rectangular over a step.
        let source = Source::WholeSteps {
            procedure: uncertainty.run.procedure,
        };
        let quantum = frame.steps.time_step / 6.0_f64.sqrt();
        contributions[duration].push(Contribution::new(source, quantum));
    }
    give_resolved(setting.input.law, summary, &layout, contributions, results);
    Ok(())
}

/// An impact on a storey along its recorded path.
struct RecordedStoreyImpact<'a, 'run> {
    uncertainty: &'a FrameUncertainty<'run>,
    plan: &'a Impact,
    target: &'a StoreyTarget,
    setting: &'a Setting,
    frame: &'a FrameSteps,
    path: FramePath,
    /// Number of values of an evaluation.
    length: usize,
}

struct StoreyInputs {
    run: FrameRun,
    impact: FloorImpact,
    /// \[s\]
    periods: Vec<f64>,
    critical_time_step: f64,
}

impl StoreyInputs {
    /// The results with their values: those of any impact, then those of a storey.
    fn numbers(
        &self,
        values: &ImpactValues,
        striker: &StrikerOutcome,
        floors: &Floors,
        time_step: f64,
    ) -> Evaluated {
        let StrikerOutcome {
            storey_energy,
            first_contact_steps,
            striker_velocity,
        } = striker;
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        let duration = if *first_contact_steps > 0 {
            *first_contact_steps as f64 * time_step
        } else {
            f64::NAN
        };
        let back = if *striker_velocity < 0.0 {
            -striker_velocity
        } else {
            f64::NAN
        };
        let mut numbers = re_integrated(values);
        numbers.extend([
            (schema::CONTACT_DURATION, vec![duration]),
            (schema::REBOUND_VELOCITY, vec![back]),
            (schema::MAX_BASE_SHEAR, vec![floors.max_base_shear]),
            (schema::CRITICAL_TIME_STEP, vec![self.critical_time_step]),
            (schema::FLOOR_DISPLACEMENT, floors.max_displacement.clone()),
            (schema::MAX_DRIFT, floors.max_drift.clone()),
            (schema::FINAL_DRIFT, floors.final_drift.clone()),
            (schema::STOREY_ENERGY, storey_energy.clone()),
            (schema::MAX_ELEMENT_FORCE, floors.max_element_force.clone()),
            (schema::PERIODS, self.periods.clone()),
            counted(values),
        ]);
        numbers
    }

    /// The values of a run with so many steps for each of the record.
    fn evaluation(&self, found: &FloorImpactOutcome, finer: u8) -> Evaluation {
        let time_step = self.run.time_step / f64::from(finer);
        let numbers = |values: &ImpactValues, striker: &StrikerOutcome, floors: &Floors| {
            flat(self.numbers(values, striker, floors, time_step))
        };
        let before = (
            &found.impact.before_departure,
            &found.before_departure,
            &found.floors.before_departure,
        );
        Evaluation {
            values: numbers(&found.impact.values, &found.striker, &found.floors.between),
            before_departure: match before {
                (Some(values), Some(striker), Some(floors)) => {
                    Some(numbers(values, striker, floors))
                }
                _ => None,
            },
            farthest: found.floors.between.farthest(),
        }
    }
}

impl Evaluate for RecordedStoreyImpact<'_, '_> {
    type Inputs = StoreyInputs;

    fn inputs(&self, shifts: Shifts<'_>) -> Result<StoreyInputs, String> {
        let Self {
            uncertainty,
            plan,
            target,
            setting,
            frame: steps,
            ..
        } = self;
        let (frame, damping) = (
            uncertainty.moved_frame(shifts)?,
            uncertainty.moved_damping(shifts),
        );
        let (properties, law) = uncertainty.run.with_inputs(shifts, &mut |inputs| {
            Ok((
                stepping::setting::properties(&frame, &damping, inputs)?,
                contact::with_numbers(&plan.contact, inputs)?,
            ))
        })?;
        let declared = &uncertainty.run.whole.strikers[plan.striker];
        let recorded_velocity = setting.input.striker_velocity;
        let mut striker = Striker {
            velocity: recorded_velocity,
            ..declared.clone()
        };
        for (source, by) in shifts {
            match source {
                Source::StrikerMass(_) => striker.mass += by * striker.mass_uncertainty,
                // Impacts of one striker at several speeds are as uncertain as the one that is stated, each in proportion.
                Source::StrikerVelocity(_) => {
                    striker.velocity *=
                        1.0 + by * declared.velocity_uncertainty / declared.velocity;
                }
                _ => {}
            }
        }
        // Impacts of a series have the critical time step of the fastest.
        let fastest = Striker {
            velocity: striker.velocity * (setting.fastest / recorded_velocity),
            ..striker.clone()
        };
        let critical_time_step =
            properties.critical_on_impact(target.storey, &fastest.approach(contact::spring(law)));
        let stiffness = frame.stiffness[target.storey][target.storey];
        let body = ImpactInput {
            mass: properties.struck_mass(target.storey),
            stiffness,
            operator_stiffness: stiffness,
            striker_mass: striker.mass,
            striker_velocity: striker.velocity,
            law,
            ..setting.input
        };
        let impact = FloorImpact {
            struck: target.storey,
            law,
            until: plan.until,
            body,
        };
        let periods = properties.modes.periods.clone();
        let run = FrameRun {
            matrices: properties.matrices,
            operator: properties.operator,
            computed_factors: uncertainty.computed_factors(&frame),
            ..uncertainty.frame_run(steps)
        };
        Ok(StoreyInputs {
            run,
            impact,
            periods,
            critical_time_step,
        })
    }

    fn evaluate(&self, readings: &Perturbation, inputs: &StoreyInputs) -> Evaluation {
        let found = inputs.run.struck(&inputs.impact, &self.path, readings);
        found.map_or_else(
            |_| Evaluation::none(self.length),
            |found| inputs.evaluation(&found, readings.finer),
        )
    }
}
