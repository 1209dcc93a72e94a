//! What the uncertainty of the inputs makes of the results of a blow. In: what went into it, with its sources of
//! uncertainty, and the recorded steps. Out: for each result, what each source contributes. The run itself is not touched:
//! its recorded way is taken again with one input moved at a time (JCGM 100:2008, 5.1.3 and 5.1.4: half the difference of
//! the results at ±u), with drawn errors of all its readings, and in finer time steps. It moves no rig.

use super::bounded::Bounded;
use super::impact::Setting;
use super::inputs::Inputs;
use super::rounding_doubts::Quanta;
use super::study::{CLOSE, Effort, FINER, Refined, Study, Taken, Tick, Unknown, give, over_rules};
use crate::formula::{Formula, ProcedureId, ResultValue, Results};
use crate::mechanics::contact::ContactLaw;
use crate::mechanics::recorded_path::{Distortion, Noise, Reading, RecordedPath, UNSEEN};
use crate::mechanics::rerun::{OUTCOMES, Outcome, foretold, rerun};
use crate::mechanics::summary::ImpactSummary;
use crate::plan::{Contact, Impact, Link, Mode, Plan, ReadingRules, Striker, VirtualLink};
use crate::record::{ImpactStep, NamedResult};
use crate::rig::DeclaredNoise;
use crate::uncertainty::{Contribution, Moved, Source, sources_of};

/// Why no uncertainty is told of a run.
pub(super) const LEADS_ELSEWHERE: &str = "the recorded way, taken again, does not lead to the recorded results";

/// Results that wait for the end of the run.
pub(super) const LATE: [&str; 4] = ["final_displacement", "impulse", "restoring_energy", "damping_energy"];

/// One run to take.
struct Job {
    setting: Setting,
    distortion: Distortion,
}

/// Everything uncertain about a blow.
#[derive(Clone, Copy)]
pub(super) struct Doubts<'run> {
    plan: &'run Impact,
    whole: &'run Plan,
    results: &'run dyn Results,
    procedure: ProcedureId,
    noise: DeclaredNoise,
    /// By how much its damping was raised to none.
    lift: f64,
    /// Which blow of the procedure it is, from 0: each has errors of its own.
    blow: u16,
}

impl<'run> Doubts<'run> {
    pub(super) fn new(plan: &'run Impact, whole: &'run Plan, inputs: &Inputs<'run>, noise: DeclaredNoise) -> Self {
        Self { plan, whole, results: inputs.results(), procedure: inputs.procedure(), noise, lift: inputs.lift(), blow: 0 }
    }

    /// Of another blow of the same procedure, from 0.
    pub(super) fn of_blow(self, index: usize) -> Self {
        Self { blow: u16::try_from(index).unwrap_or(u16::MAX), ..self }
    }

    /// Gives `results` their contributions.
    pub(super) fn propagate(
        &self,
        setting: &Setting,
        steps: &[ImpactStep],
        recorded: &ImpactSummary,
        results: &mut [NamedResult],
        tick: Tick,
    ) -> Result<(), Unknown> {
        let sources = self.sources();
        let (force, displacement) = reading_errors(self.whole, self.noise, 0);
        let sampled = force > 0.0 || displacement > 0.0;
        let path = self.path(setting, steps).ok_or_else(|| "nothing was recorded".to_owned())?;
        let again = rerun(&setting.input, self.plan.until, setting.steps, &path, Distortion::NONE);
        if !same(&again.summary, recorded) {
            return Err(LEADS_ELSEWHERE.to_owned().into());
        }
        let rules = path.rules();
        let effort = Effort::of(steps.len() as u64 * rules.len() as u64, sources.len(), 0, sampled);
        let finer = |finer: u8| {
            let mut setting = *setting;
            setting.input.time_step /= f64::from(finer);
            setting.steps *= u64::from(finer);
            Job { setting, distortion: Distortion { finer, ..Distortion::NONE } }
        };
        let names = || OUTCOMES.iter().copied().chain(["critical_time_step"]);
        let told = names().map(|name| told_of(results, name)).collect();
        let refined = Refined { source: Source::TimeStep { procedure: self.procedure }, told, jobs: FINER.map(finer) };
        let mut study = Study { moved: Vec::new(), refined: Some(refined), draws: Vec::new() };
        for source in sources {
            study.moved.push((source, effort.shifted(|by| self.moved(setting, source, by))?));
        }
        for (draw, source) in effort.draws(self.procedure, self.blow) {
            let distortion = Distortion { noise: Some(Noise { force, displacement, draw }), ..Distortion::NONE };
            study.draws.push((source, Job { setting: *setting, distortion }));
        }
        let runs = Bounded::new(again.farthest, again.values.len() + 1);
        let contributions = over_rules(rules, tick, &mut |rule, tick| {
            let path = path.clone().supposing(rule);
            let take = |Job { setting, distortion }: &Job| {
                let found = rerun(&setting.input, self.plan.until, setting.steps, &path, *distortion);
                runs.taken(Some((found.farthest, taken(setting, &found))))
            };
            let as_it_was = take(&Job { setting: *setting, distortion: Distortion::NONE });
            study.contributions(&as_it_was.values, &take, tick)
        });
        let mut contributions = runs.told(contributions)?;
        if path.swung_back() {
            let late = OUTCOMES.iter().zip(&mut contributions).filter(|(name, _)| LATE.contains(name));
            for part in late.flat_map(|(_, parts)| parts) {
                part.smooth = false;
            }
        }
        for (name, quantum) in whole_steps(setting.input.time_step) {
            at_least(quantum, self.procedure, OUTCOMES.iter().position(|outcome| *outcome == name), &mut contributions);
        }
        no_known_force(setting.input.law, recorded, &mut contributions);
        for (name, parts) in names().zip(contributions) {
            if let Some(result) = results.iter_mut().find(|result| result.name == name) {
                give(result, parts);
            }
        }
        Ok(())
    }

    /// The way that was recorded; None of no reading.
    fn path(&self, setting: &Setting, steps: &[ImpactStep]) -> Option<RecordedPath> {
        let readings = steps.iter().map(|step| Reading {
            target: step.command,
            displacement: step.displacement,
            force: step.restoring_force,
        });
        let (input, readings) = (&setting.input, readings.collect::<Vec<Reading>>());
        if self.plan.stepping.mode == Mode::StepAndPause {
            return RecordedPath::new(readings, input.stiffness, input.force_noise, input.resolution);
        }
        let velocities = foretold(input, self.plan.until, setting.steps, &readings);
        RecordedPath::under_way(readings, (&velocities, input.time_step), input.stiffness, input.force_noise, input.resolution)
    }

    /// The sources that can be moved, each once.
    fn sources(&self) -> Vec<Source> {
        let Impact { striker, specimen, mass, stiffness, damping, contact, .. } = self.plan;
        let mut references = Vec::new();
        let read = || [mass, stiffness, damping].into_iter().chain(contact_formulas(contact));
        for formula in read() {
            formula.collect_references(&mut references);
        }
        let mut sources = sources_of(&references, self.results);
        read().for_each(|formula| formula.collect_stated(&mut sources));
        let Striker { mass_uncertainty, velocity_uncertainty, .. } = self.whole.strikers[*striker];
        let calibration = &self.whole.rig.calibration_of(0);
        let stated = [
            (Source::StrikerMass(*striker), mass_uncertainty),
            (Source::StrikerVelocity(*striker), velocity_uncertainty),
            (Source::SpecimenMass(*specimen), self.plan.mass_uncertainty),
            (Source::ForceScale(0), calibration.force_uncertainty),
            (Source::DisplacementScale(0), calibration.displacement_uncertainty),
            (Source::ForceZero(0), calibration.zero()),
        ];
        let stated = stated.into_iter().filter(|(_, uncertainty)| *uncertainty > 0.0).map(|(source, _)| source);
        sources.extend(stated);
        sources.sort_unstable();
        sources.dedup();
        sources
    }

    /// The run to take with a source moved by `by` standard uncertainties. The time step stays: it was chosen, not measured.
    fn moved(&self, setting: &Setting, source: Source, by: f64) -> Result<Job, String> {
        let declared = &self.whole.strikers[self.plan.striker];
        let mut striker = declared.clone();
        let mut distortion = Distortion::NONE;
        let mut heavier = 0.0;
        let calibration = &self.whole.rig.calibration_of(0);
        match source {
            Source::StrikerMass(_) => striker.mass += by * striker.mass_uncertainty,
            Source::StrikerVelocity(_) => striker.velocity += by * striker.velocity_uncertainty,
            Source::SpecimenMass(_) => heavier = by * self.plan.mass_uncertainty,
            Source::ForceScale(0) => distortion.force_scale += by * calibration.force_uncertainty,
            Source::DisplacementScale(0) => distortion.displacement_scale += by * calibration.displacement_uncertainty,
            Source::ForceZero(0) => distortion.zero = by * calibration.zero(),
            // Formulas are moved by it, where they read it; the rest is of frames or of no input.
            _ => {}
        }
        let results = Moved { results: self.results, source, by };
        let mut inputs = Inputs::moved(&results, self.procedure, self.lift);
        // Blows of one striker at several speeds are as uncertain as the one that is stated, each in proportion; they share the
        // critical time step of the fastest.
        let faster = striker.velocity / declared.velocity;
        striker.velocity = setting.fastest * faster;
        let mut moved = Setting::evaluate(self.plan, &striker, &mut inputs, self.noise)
            .map_err(|stop| format!("an input moved by its uncertainty is none: {stop}"))?;
        moved.heavier(heavier);
        moved.input.time_step = setting.input.time_step;
        moved.steps = setting.steps;
        moved.input.striker_velocity = setting.input.striker_velocity * faster;
        Ok(Job { setting: moved, distortion })
    }
}

/// What a blow comes to, and its critical time step, which follows from inputs alone.
fn taken(setting: &Setting, found: &Outcome) -> Taken {
    let seen = found.unseen <= UNSEEN * found.summary.max_displacement.abs();
    Taken { values: found.values.iter().copied().chain([setting.critical_time_step]).collect(), seen }
}

/// What a contact law reads.
pub(super) fn contact_formulas(contact: &Contact) -> Vec<&Formula> {
    match contact {
        Contact::Rigid => Vec::new(),
        Contact::Limit { force } => vec![force],
        Contact::Restitution { coefficient } => vec![coefficient],
        Contact::Hertz { stiffness, loss, force_limit } => [stiffness, loss].into_iter().chain(force_limit).collect(),
    }
}

/// Standard deviations of one reading of the axis at this place, N and m: noise, and rounding to a quantum q, which is even
/// over it: q/√12.
pub(super) fn reading_errors(plan: &Plan, declared: DeclaredNoise, axis: usize) -> (f64, f64) {
    let Quanta { noise, force, displacement } = quanta(plan, declared, axis);
    let rounding = 12.0_f64.sqrt();
    (noise.hypot(force / rounding), displacement / rounding)
}

/// What the rig declares of a reading of the axis at this place.
pub(super) fn quanta(plan: &Plan, declared: DeclaredNoise, axis: usize) -> Quanta {
    let (noise, displacement, force) = match &plan.rig.link {
        Link::Virtual(VirtualLink { foretold: Some(errors), .. }) => (errors.noise, errors.resolution, errors.force_resolution),
        Link::Virtual(link) => (declared.force, declared.resolution, link.force_resolution),
        Link::Real(link) => {
            let ReadingRules { noise, resolution, .. } = link.readings_of(axis);
            (noise, resolution, plan.rig.calibration.newtons_per_count.unwrap_or(0.0).abs())
        }
    };
    Quanta { noise, force, displacement }
}

/// Times that are told to a whole step, with the standard uncertainty of a quantum Δt, Δt/√12 (s).
pub(super) fn whole_steps(time_step: f64) -> [(&'static str, f64); 2] {
    ["stop_time", "time_of_max_displacement"].map(|name| (name, time_step / 12.0_f64.sqrt()))
}

/// Lets the time step contribute so much at least to the number at a place.
pub(super) fn at_least(most: f64, procedure: ProcedureId, place: Option<usize>, contributions: &mut [Vec<Contribution>]) {
    let source = Source::TimeStep { procedure };
    let parts = place.and_then(|place| contributions.get_mut(place)).into_iter().flatten();
    for part in parts.filter(|part| part.source == source && part.amount.abs() < most) {
        part.amount = most;
    }
}

/// The number of a result that is one; NaN where it does not exist.
pub(super) fn told_of(results: &[NamedResult], name: &str) -> f64 {
    match results.iter().find(|result| result.name == name).map(|result| &result.value) {
        Some(ResultValue::Number { value: Some(value), .. }) => *value,
        _ => f64::NAN,
    }
}

/// A largest contact force that follows the time step is known to nobody: what inputs do to it is not its uncertainty.
pub(super) fn no_known_force(law: ContactLaw, recorded: &ImpactSummary, contributions: &mut [Vec<Contribution>]) {
    if law.force_follows_the_step(recorded.max_contact_force)
        && let Some(index) = OUTCOMES.iter().position(|outcome| *outcome == "max_contact_force")
    {
        contributions[index].clear();
    }
}

/// Whether two runs came to the same.
pub(super) fn same(one: &ImpactSummary, other: &ImpactSummary) -> bool {
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
