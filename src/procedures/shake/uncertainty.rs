//! The uncertainty of the results of a ground-motion test. In: its inputs with their sources of uncertainty, and the recorded steps. Out:
//! the contributions of each source to each number. The frame is re-integrated along its recorded path, under the same ground motion.

use super::setting::Setting;
use crate::procedures::common::perturbed_inputs::{LEADS_ELSEWHERE, RecordedValues};
use crate::procedures::common::results::{Evaluated, flat, give, layout_of, values};
use crate::procedures::stepping;
use crate::procedures::stepping::frame_uncertainty::{FrameUncertainty, leads_there, with_noise};
use crate::procedures::stepping::setting::Steps;
use crate::run::stop::Stop;
use psd_physics::integrator::input::FrameError;
use psd_physics::reintegration::frame::{Floors, FloorsOutcome, FrameRun};
use psd_physics::reintegration::frame_path::FramePath;
use psd_physics::reintegration::perturbation::Perturbation;
use psd_physics::structure::ground::acceleration_at;
use psd_physics::structure::substructures::Substructures;
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::{NamedResult, ShakeHistory};
use psd_plan::uncertainty::engine::{Evaluate, Evaluation, Progress, Shifts, Unknown};
use psd_plan::uncertainty::{Refinement, Source};
use psd_plan::{Ground, Shake};

/// Steps of the finest run for each of the record.
const FINEST: u8 = Refinement::Quarter.finer();

/// The uncertain inputs of a ground-motion test.
#[derive(Clone, Copy)]
pub(crate) struct ShakeUncertainty<'a, 'run> {
    pub uncertainty: &'a FrameUncertainty<'run>,
    pub plan: &'a Shake,
    pub ground: &'a Ground,
    pub setting: &'a Setting,
    /// At the start of the run; None if the rig carries the whole frame.
    pub substructures: Option<&'a Substructures>,
}

/// Gives `results` their contributions.
pub(crate) fn propagate(
    shake: ShakeUncertainty<'_, '_>,
    history: &ShakeHistory,
    results: &mut [NamedResult],
    progress: Progress<'_, Stop>,
) -> Result<(), Unknown<Stop>> {
    let ShakeUncertainty {
        uncertainty,
        plan,
        ground,
        setting,
        substructures,
    } = shake;
    let path = uncertainty.path(
        &setting.frame,
        history.steps.iter().map(|step| &step.floors),
        substructures,
    )?;
    let Steps {
        time_step, count, ..
    } = setting.frame.steps;
    let ended = history.drift_reached.and(history.steps.last());
    let steps = ended.map_or(count, |last| last.step);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let at = |step: u64| {
        acceleration_at(
            &ground.times,
            &ground.accelerations,
            step as f64 * time_step / f64::from(FINEST),
        )
    };
    let accelerations = (0..=steps * u64::from(FINEST)).map(at).collect();
    let mut evaluate = RecordedShake {
        shake,
        accelerations,
        steps,
        path,
        length: 0,
    };
    let axes = uncertainty.axes();
    let exact = Perturbation::none(axes);
    let inputs = evaluate.inputs(&[])?;
    let mut found = evaluate
        .run(&inputs, &exact)
        .map_err(|error| error.to_string())?;
    if !leads_there(&found.ends, schema::MAX_DISPLACEMENT, results) {
        return Err(LEADS_ELSEWHERE.to_owned().into());
    }
    // With velocities the path is another one.
    let stops = found.velocities.is_empty();
    evaluate.path = uncertainty.with_velocities(
        &setting.frame,
        evaluate.path,
        std::mem::take(&mut found.velocities),
        substructures,
    )?;
    let layout = layout_of(&inputs.numbers(&found.between));
    let mut reported = values(&layout, results);
    evaluate.length = reported.len();
    with_noise(&found.between, &layout, &mut reported);
    let sources = uncertainty.sources(
        &[&plan.scale],
        &[(Source::GroundScale(plan.ground), ground.scale_uncertainty)],
    )?;
    give(
        &layout,
        uncertainty.run.contributions(
            &evaluate,
            axes,
            sources,
            RecordedValues {
                steps: history.steps.len(),
                reported,
                nominal: stops.then(|| inputs.evaluation(&found)),
            },
            progress,
        )?,
        results,
    );
    Ok(())
}

/// A ground-motion test along its recorded path.
struct RecordedShake<'a, 'run> {
    shake: ShakeUncertainty<'a, 'run>,
    /// Ground acceleration at every finest step \[m/s²\].
    accelerations: Vec<f64>,
    /// Number of steps of the run.
    steps: u64,
    path: FramePath,
    /// Number of values of an evaluation.
    length: usize,
}

/// The frame, its periods \[s\] and the factor on the ground.
struct ShakeInputs {
    run: FrameRun,
    periods: Vec<f64>,
    scale: f64,
}

impl ShakeInputs {
    /// The results with their values.
    fn numbers(&self, floors: &Floors) -> Evaluated {
        vec![
            (schema::MAX_DISPLACEMENT, floors.max_displacement.clone()),
            (schema::MAX_DRIFT, floors.max_drift.clone()),
            (schema::FINAL_DRIFT, floors.final_drift.clone()),
            (schema::PERIODS, self.periods.clone()),
            (schema::MAX_BASE_SHEAR, vec![floors.max_base_shear]),
            (schema::MAX_ELEMENT_FORCE, floors.max_element_force.clone()),
        ]
    }

    /// The values of a run.
    fn evaluation(&self, found: &FloorsOutcome) -> Evaluation {
        let numbers = |floors: &Floors| flat(self.numbers(floors));
        Evaluation {
            values: numbers(&found.between),
            before_departure: found.before_departure.as_ref().map(numbers),
            farthest: found.between.farthest(),
        }
    }
}

impl RecordedShake<'_, '_> {
    fn run(
        &self,
        inputs: &ShakeInputs,
        readings: &Perturbation,
    ) -> Result<FloorsOutcome, FrameError> {
        let accelerations = self
            .accelerations
            .iter()
            .step_by(usize::from(FINEST / readings.finer));
        let scaled: Vec<f64> = accelerations
            .map(|acceleration| inputs.scale * acceleration)
            .collect();
        inputs
            .run
            .under_ground_motion(&scaled, &self.path, readings)
    }
}

impl Evaluate for RecordedShake<'_, '_> {
    type Inputs = ShakeInputs;

    fn inputs(&self, shifts: Shifts<'_>) -> Result<ShakeInputs, String> {
        let ShakeUncertainty {
            uncertainty,
            plan,
            ground,
            setting,
            ..
        } = self.shake;
        let (frame, damping) = (
            uncertainty.moved_frame(shifts)?,
            uncertainty.moved_damping(shifts),
        );
        let (properties, scale) = uncertainty.run.with_inputs(shifts, &mut |inputs| {
            let properties = stepping::setting::properties(&frame, &damping, inputs)?;
            Ok((properties, inputs.number(&schema::SCALE, &plan.scale)?))
        })?;
        let source = Source::GroundScale(plan.ground);
        let by: f64 = shifts
            .iter()
            .filter(|(moved, _)| *moved == source)
            .map(|(_, by)| by)
            .sum();
        let periods = properties.modes.periods.clone();
        let run = FrameRun {
            matrices: properties.matrices,
            operator: properties.operator,
            computed_factors: uncertainty.computed_factors(&frame),
            steps: self.steps,
            ..uncertainty.frame_run(&setting.frame)
        };
        Ok(ShakeInputs {
            run,
            periods,
            scale: scale * (1.0 + by * ground.scale_uncertainty),
        })
    }

    fn evaluate(&self, readings: &Perturbation, inputs: &ShakeInputs) -> Evaluation {
        let found = self.run(inputs, readings);
        found.map_or_else(
            |_| Evaluation::none(self.length),
            |found| inputs.evaluation(&found),
        )
    }
}
