//! What the uncertainty of the inputs makes of the results of an impact on a storey. In: what went into it, and the recorded
//! steps. Out: for each number, what each source contributes. The recorded way of all floors is taken again.

use super::bounded::{Bounded, farthest};
use super::frame_doubts::{FrameDoubts, Shifts, give_all, leads_there, mark_late, numbers_told};
use super::impact::law;
use super::propagation::{LEADS_ELSEWHERE, at_least, contact_formulas, no_known_force, same, whole_steps};
use super::stepping;
use super::stop::Stop;
use super::storey_impact::Setting;
use super::study::{Taken, Tick, Unknown, over_rules};
use crate::mechanics::approach::Approach;
use crate::mechanics::frame_path::{FrameDistortion, FramePath, FrameReading};
use crate::mechanics::frame_rerun::{Blow, BlowOutcome, FrameRun};
use crate::mechanics::impact::ImpactInput;
use crate::mechanics::rerun::OUTCOMES;
use crate::mechanics::summary::ImpactSummary;
use crate::plan::{StoreyImpact, Striker};
use crate::record::{FloorStep, NamedResult, StoreyImpactHistory};
use crate::uncertainty::Source;

/// One run to take.
struct Job {
    run: FrameRun,
    blow: Blow,
    distortion: FrameDistortion,
    /// s
    periods: Vec<f64>,
    critical_time_step: f64,
}

/// Gives `results` their contributions.
pub(super) fn propagate(
    doubts: &FrameDoubts<'_>,
    plan: &StoreyImpact,
    setting: &Setting,
    history: &StoreyImpactHistory,
    recorded: &ImpactSummary,
    results: &mut [NamedResult],
    tick: Tick,
) -> Result<(), Unknown> {
    let Striker { mass_uncertainty, velocity_uncertainty, .. } = setting.striker;
    let stated =
        [(Source::StrikerMass(plan.striker), mass_uncertainty), (Source::StrikerVelocity(plan.striker), velocity_uncertainty)];
    let sources = doubts.sources(&contact_formulas(&plan.contact), &stated);
    let reading = |step: &FloorStep| FrameReading {
        target: step.command.clone(),
        displacement: step.displacement.clone(),
        force: step.restoring_force.clone(),
    };
    let path = doubts.path(&setting.frame, history.floors.iter().map(reading).collect())?;
    let take = |job: &Job, path: &FramePath| job.run.struck(&job.blow, path, &job.distortion);
    let floors = doubts.floors();
    let as_it_was = Job {
        run: doubts.run(&setting.frame),
        blow: Blow { struck: plan.struck, law: setting.law, until: plan.until, body: setting.body },
        distortion: FrameDistortion::none(floors),
        periods: setting.frame.properties.modes.periods.clone(),
        critical_time_step: setting.frame.critical_time_step,
    };
    let mut found = take(&as_it_was, &path).map_err(|error| error.to_string())?;
    if !same(&found.blow.summary, recorded) || !leads_there(&found.floors.ends, "floor_displacement", results) {
        return Err(LEADS_ELSEWHERE.to_owned().into());
    }
    let path = doubts.under_way(&setting.frame, path, std::mem::take(&mut found.floors.velocities))?;
    let lists = ["floor_displacement", "max_drift", "final_drift", "storey_energy", "periods"].map(|name| (name, floors));
    let layout: Vec<(&'static str, usize)> = OUTCOMES.iter().chain(&SCALARS).map(|name| (*name, 1)).chain(lists).collect();
    let job = |shifts: Shifts<'_>, distortion| {
        moved(doubts, plan, setting, shifts, distortion)
            .map_err(|stop| format!("an input moved by its uncertainty is none: {stop}"))
    };
    let rules = path.rules();
    let study = doubts.study(
        &sources,
        doubts.effort(history.floors.len(), rules.len(), &sources),
        numbers_told(&layout, results),
        job,
    )?;
    let far = |found: &BlowOutcome| farthest(found.floors.between.max_displacement.iter().copied());
    let runs = Bounded::new(far(&found), numbers(&as_it_was, &found).len());
    let parts = over_rules(&rules, tick, &mut |rule, tick| {
        let path = path.supposing(rule);
        let again = |job: &Job| {
            let found = take(job, &path).ok();
            runs.taken(found.map(|found| (far(&found), Taken { values: numbers(job, &found), seen: found.floors.seen })))
        };
        study.contributions(&again(&as_it_was).values, &again, tick)
    });
    let mut parts = runs.told(parts)?;
    no_known_force(setting.law, recorded, &mut parts);
    let time_step = setting.frame.time_step;
    // From the beginning of a step to the end of one: two times.
    let duration = ("contact_duration", time_step / 6.0_f64.sqrt());
    for (name, quantum) in whole_steps(time_step).into_iter().chain([duration]) {
        at_least(quantum, doubts.procedure, layout.iter().position(|(result, _)| *result == name), &mut parts);
    }
    if path.swung_back() {
        mark_late(&layout, &mut parts);
    }
    give_all(&layout, parts, results);
    Ok(())
}

/// Numbers after those of any impact.
const SCALARS: [&str; 4] = ["contact_duration", "rebound_velocity", "max_base_shear", "critical_time_step"];

/// What a run comes to, in the order of the layout.
fn numbers(job: &Job, found: &BlowOutcome) -> Vec<f64> {
    let BlowOutcome { blow, floors, storey_energy, first_blow, striker_velocity } = found;
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let duration = if *first_blow > 0 { *first_blow as f64 * job.run.time_step } else { f64::NAN };
    let back = if *striker_velocity < 0.0 { -striker_velocity } else { f64::NAN };
    let floors = &floors.between;
    let lists = [&floors.max_displacement, &floors.max_drift, &floors.final_drift, storey_energy, &job.periods];
    let scalars = [duration, back, floors.max_base_shear, job.critical_time_step];
    blow.values.iter().copied().chain(scalars).chain(lists.into_iter().flatten().copied()).collect()
}

/// The run to take with sources moved, in the steps that the distortion has.
fn moved(
    doubts: &FrameDoubts<'_>,
    plan: &StoreyImpact,
    setting: &Setting,
    shifts: Shifts<'_>,
    distortion: FrameDistortion,
) -> Result<Job, Stop> {
    let (frame, damping) = (doubts.moved_frame(shifts)?, doubts.moved_damping(shifts));
    let (properties, law) = doubts
        .with_inputs(shifts, &mut |inputs| Ok((stepping::properties(&frame, &damping, inputs)?, law(&plan.contact, inputs)?)))?;
    let (mut striker, declared) = (setting.striker.clone(), &doubts.whole.strikers[plan.striker]);
    for (source, by) in shifts {
        match source {
            Source::StrikerMass(_) => striker.mass += by * striker.mass_uncertainty,
            // Blows of one striker at several speeds are as uncertain as the one that is stated, each in proportion.
            Source::StrikerVelocity(_) => striker.velocity *= 1.0 + by * declared.velocity_uncertainty / declared.velocity,
            _ => {}
        }
    }
    // Blows of a row have the critical time step of the fastest.
    let fastest = Striker { velocity: striker.velocity * (setting.fastest / setting.striker.velocity), ..striker.clone() };
    let critical_time_step = properties.critical_on_impact(plan.struck, &Approach::of(&fastest, law.stiffness()));
    let stiffness = frame.stiffness[plan.struck][plan.struck];
    let run = FrameRun { matrices: properties.matrices.clone(), ..doubts.finer_run(&setting.frame, distortion.finer) };
    let body = ImpactInput {
        time_step: run.time_step,
        mass: properties.struck_mass(plan.struck),
        stiffness,
        operator_stiffness: stiffness,
        striker_mass: striker.mass,
        striker_velocity: striker.velocity,
        law,
        ..setting.body
    };
    let blow = Blow { struck: plan.struck, law, until: plan.until, body };
    let periods = properties.modes.periods.clone();
    Ok(Job { run, blow, distortion, periods, critical_time_step })
}
