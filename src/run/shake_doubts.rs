//! What the uncertainty of the inputs makes of the results of a shake. In: what went into it, and the recorded steps. Out: for
//! each number, what each source contributes. The recorded way is taken again, under the same ground.

use super::bounded::{Bounded, farthest};
use super::frame_doubts::{FrameDoubts, Shifts, give_all, leads_there, mark_late, numbers_told};
use super::propagation::LEADS_ELSEWHERE;
use super::shake::Setting;
use super::stepping::{self, FrameSteps};
use super::stop::Stop;
use super::study::{FINER, Taken, Tick, Unknown, over_rules};
use crate::mechanics::frame_path::{FrameDistortion, FramePath, FrameReading};
use crate::mechanics::frame_rerun::{Floors, FloorsOutcome, FrameRun};
use crate::mechanics::ground::acceleration_at;
use crate::plan::{Ground, Shake};
use crate::quantity::Dimension;
use crate::record::{NamedResult, ShakeHistory};
use crate::uncertainty::Source;

/// One run to take.
struct Job {
    run: FrameRun,
    /// Of the ground.
    scale: f64,
    distortion: FrameDistortion,
    /// s
    periods: Vec<f64>,
}

/// Steps of the finest run for each of the record.
const FINEST: u8 = FINER[1];

/// Gives `results` their contributions.
pub(super) fn propagate(
    doubts: &FrameDoubts<'_>,
    plan: &Shake,
    ground: &Ground,
    setting: &Setting,
    history: &ShakeHistory,
    results: &mut [NamedResult],
    tick: Tick,
) -> Result<(), Unknown> {
    let sources = doubts.sources(&[&plan.scale], &[(Source::GroundScale(plan.ground), ground.scale_uncertainty)]);
    let reading = |step: &crate::record::ShakeStep| FrameReading {
        target: step.command.clone(),
        displacement: step.displacement.clone(),
        force: step.restoring_force.clone(),
    };
    let path = doubts.path(&setting.frame, history.steps.iter().map(reading).collect())?;
    let FrameSteps { time_step, steps, .. } = setting.frame;
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let at = |step: u64| acceleration_at(&ground.times, &ground.accelerations, step as f64 * time_step / f64::from(FINEST));
    let accelerations: Vec<f64> = (0..=steps * u64::from(FINEST)).map(at).collect();
    let take = |job: &Job, path: &FramePath| {
        let own = accelerations.iter().step_by(usize::from(FINEST / job.distortion.finer));
        let scaled: Vec<f64> = own.map(|acceleration| job.scale * acceleration).collect();
        job.run.shaken(&scaled, path, &job.distortion)
    };
    let numbers = |job: &Job, floors: &Floors| {
        let lists = [&floors.max_displacement, &floors.max_drift, &floors.final_drift, &job.periods];
        lists.into_iter().flatten().copied().chain([floors.max_base_shear]).collect::<Vec<f64>>()
    };
    let floors = doubts.floors();
    let as_it_was = Job {
        run: doubts.run(&setting.frame),
        scale: setting.scale,
        distortion: FrameDistortion::none(floors),
        periods: setting.frame.properties.modes.periods.clone(),
    };
    let mut found = take(&as_it_was, &path).map_err(|error| error.to_string())?;
    if !leads_there(&found.ends, "max_displacement", results) {
        return Err(LEADS_ELSEWHERE.to_owned().into());
    }
    let path = doubts.under_way(&setting.frame, path, std::mem::take(&mut found.velocities))?;
    let lists = ["max_displacement", "max_drift", "final_drift", "periods"].map(|name| (name, floors));
    let layout: Vec<(&'static str, usize)> = lists.into_iter().chain([("max_base_shear", 1)]).collect();
    let job = |shifts: Shifts<'_>, distortion: FrameDistortion| {
        let (run, periods, scale) = moved(doubts, plan, (setting, distortion.finer), (ground, shifts))
            .map_err(|stop| format!("an input moved by its uncertainty is none: {stop}"))?;
        Ok(Job { run, scale, distortion, periods })
    };
    let rules = path.rules();
    let study =
        doubts.study(&sources, doubts.effort(history.steps.len(), rules.len(), &sources), numbers_told(&layout, results), job)?;
    let far = |floors: &Floors| farthest(floors.max_displacement.iter().copied());
    let runs = Bounded::new(far(&found.between), numbers(&as_it_was, &found.between).len());
    let parts = over_rules(&rules, tick, &mut |rule, tick| {
        let path = path.supposing(rule);
        let again = |job: &Job| {
            let found = take(job, &path).ok();
            runs.taken(
                found.map(|FloorsOutcome { between, seen, .. }| (far(&between), Taken { values: numbers(job, &between), seen })),
            )
        };
        study.contributions(&again(&as_it_was).values, &again, tick)
    });
    let mut parts = runs.told(parts)?;
    if path.swung_back() {
        mark_late(&layout, &mut parts);
    }
    give_all(&layout, parts, results);
    Ok(())
}

/// The frame, its periods (s) and the factor of the ground with sources moved, in so many steps for each of its own.
fn moved(
    doubts: &FrameDoubts<'_>,
    plan: &Shake,
    (setting, finer): (&Setting, u8),
    (ground, shifts): (&Ground, Shifts<'_>),
) -> Result<(FrameRun, Vec<f64>, f64), Stop> {
    let (frame, damping) = (doubts.moved_frame(shifts)?, doubts.moved_damping(shifts));
    let (properties, scale) = doubts.with_inputs(shifts, &mut |inputs| {
        let properties = stepping::properties(&frame, &damping, inputs)?;
        Ok((properties, inputs.number("scale", &plan.scale, Dimension::NUMBER)?))
    })?;
    let source = Source::GroundScale(plan.ground);
    let by: f64 = shifts.iter().filter(|(moved, _)| *moved == source).map(|(_, by)| by).sum();
    let periods = properties.modes.periods.clone();
    let run = FrameRun { matrices: properties.matrices, ..doubts.finer_run(&setting.frame, finer) };
    Ok((run, periods, scale * (1.0 + by * ground.scale_uncertainty)))
}
