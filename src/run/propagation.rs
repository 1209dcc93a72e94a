//! What the uncertainty of the inputs makes of the results of a blow. In: what went into it, with its sources of
//! uncertainty, and the recorded steps. Out: for each result, what each source contributes. The run itself is not touched:
//! its recorded way is taken again with one input moved at a time (JCGM 100:2008, 5.1.3 and 5.1.4: half the difference of
//! the results at ±u), and with drawn errors of all its readings. It moves no rig.

use super::impact::Setting;
use super::inputs::Inputs;
use crate::formula::{ProcedureId, ResultValue, Results};
use crate::mechanics::recorded_path::{Distortion, Noise, Reading, RecordedPath};
use crate::mechanics::rerun::{OUTCOMES, rerun};
use crate::mechanics::summary::ImpactSummary;
use crate::plan::{Contact, Impact, Plan, Striker};
use crate::record::{ImpactStep, NamedResult};
use crate::rig::DeclaredNoise;
use crate::uncertainty::{Contribution, Moved, Source, combined, sources_of};

/// Draws of the readings' errors at most: the standard uncertainty they give is known to 1/√(2·64), 9 %.
const MOST_DRAWS: u16 = 64;
/// And at least.
const FEWEST_DRAWS: u16 = 8;
/// Steps that all draws take together, about: what a long run is allowed to cost.
const STEPS_OF_DRAWS: u64 = 512_000;
/// The run taken again as it was must come out as it did, relatively.
const CLOSE: f64 = 1e-9;
/// What moving a source up does may differ by so much from what moving it down does, of the larger; beyond it the result
/// does not follow the source smoothly. Twice what half the difference may be off by.
const ONE_SIDED: f64 = 0.2;
/// And half the difference at ±u from that at ±u/2.
const HALVED: f64 = 0.1;

/// Suppositions about the specimen that come to results so near to each other, of the larger, agree.
const AGREED: f64 = 0.2;
/// A way taken again that leaves the recorded one for more than this share of the largest displacement is not known by it.
const UNSEEN: f64 = 1e-3;

/// Results that wait for the end of the run.
const LATE: [&str; 4] = ["residual_displacement", "impulse", "restoring_energy", "damping_energy"];

/// The results as the run with one source moved gives them, and the critical time step, which follows from inputs alone.
type Values = [f64; OUTCOMES.len() + 1];

/// Everything uncertain about a blow.
#[derive(Clone, Copy)]
pub(super) struct Doubts<'run> {
    plan: &'run Impact,
    whole: &'run Plan,
    results: &'run dyn Results,
    procedure: ProcedureId,
    noise: DeclaredNoise,
    /// Which blow of the procedure it is, from 0: each has errors of its own.
    blow: u16,
}

impl<'run> Doubts<'run> {
    pub(super) fn new(plan: &'run Impact, whole: &'run Plan, inputs: &Inputs<'run>, noise: DeclaredNoise) -> Self {
        Self { plan, whole, results: inputs.results(), procedure: inputs.procedure(), noise, blow: 0 }
    }

    /// Of another blow of the same procedure, from 0.
    pub(super) fn of_blow(self, index: usize) -> Self {
        Self { blow: u16::try_from(index).unwrap_or(u16::MAX), ..self }
    }

    /// Gives `results` their contributions. The error says why nothing is known of them.
    pub(super) fn propagate(
        &self,
        setting: &Setting,
        steps: &[ImpactStep],
        recorded: &ImpactSummary,
        results: &mut [NamedResult],
    ) -> Result<(), String> {
        let sources = self.sources();
        let sampled = self.noise.force > 0.0 || self.noise.resolution > 0.0;
        if sources.is_empty() && !sampled {
            return Ok(());
        }
        let readings = steps.iter().map(|step| Reading {
            target: step.command,
            displacement: step.displacement,
            force: step.restoring_force,
        });
        let input = &setting.input;
        let path = RecordedPath::new(readings.collect(), input.stiffness, input.force_noise, input.resolution);
        let path = path.ok_or("nothing was recorded")?;
        let again = rerun(&setting.input, self.plan.until, setting.steps, &path, Distortion::NONE).summary;
        if !same(&again, recorded) {
            return Err("the recorded way, taken again, does not lead to the recorded results".to_owned());
        }
        // What the specimen may have done for all the record tells: the most that any of it makes of a source is told.
        let mut contributions: Vec<Vec<Contribution>> = Vec::new();
        for rule in path.rules() {
            let found =
                self.supposing(setting, &path.clone().supposing(rule), &sources, sampled.then_some(steps.len() as u64))?;
            if contributions.is_empty() {
                contributions = found;
            } else {
                for (told, other) in contributions.iter_mut().zip(found) {
                    widen(told, &other);
                }
            }
        }
        if path.swung_back() {
            let late = OUTCOMES.iter().zip(&mut contributions).filter(|(name, _)| LATE.contains(name));
            for part in late.flat_map(|(_, parts)| parts) {
                part.smooth = false;
            }
        }
        self.round_times(setting.input.time_step, &mut contributions);
        let names = OUTCOMES.iter().copied().chain(["critical_time_step"]);
        for (name, parts) in names.zip(contributions) {
            let Some(result) = results.iter_mut().find(|result| result.name == name) else { continue };
            let known = parts.iter().all(|part| part.amount.is_finite());
            result.contributions = if known { parts.into_iter().filter(|part| part.amount != 0.0).collect() } else { Vec::new() };
            if let ResultValue::Number { value: Some(_), uncertainty } = &mut result.value {
                *uncertainty = combined(&result.contributions);
            }
        }
        Ok(())
    }

    /// What each source contributes to each result, if the specimen keeps to the rule of `path`; of readings too where the
    /// steps that have them are given.
    fn supposing(
        &self,
        setting: &Setting,
        path: &RecordedPath,
        sources: &[Source],
        sampled: Option<u64>,
    ) -> Result<Vec<Vec<Contribution>>, String> {
        let (nominal, _) = self.values(setting, path, Distortion::NONE);
        let mut contributions: Vec<Vec<Contribution>> = vec![Vec::new(); nominal.len()];
        for source in sources {
            let at = |by| self.moved(setting, path, *source, by);
            let moved = [at(1.0)?, at(0.5)?, at(-0.5)?, at(-1.0)?];
            let seen = moved.iter().all(|(_, seen)| *seen);
            for (index, parts) in contributions.iter_mut().enumerate() {
                let (amount, smooth) = effect(nominal[index], moved.map(|(values, _)| values[index]));
                parts.push(Contribution { source: *source, amount, smooth: smooth && (seen || amount == 0.0) });
            }
        }
        if let Some(steps) = sampled {
            self.sample(setting, path, steps, &nominal, &mut contributions);
        }
        Ok(contributions)
    }

    /// The sources that can be moved, each once.
    fn sources(&self) -> Vec<Source> {
        let Impact { striker, specimen, mass, stiffness, damping, contact, .. } = self.plan;
        let mut references = Vec::new();
        let mut read = vec![mass, stiffness, damping];
        match contact {
            Contact::Rigid => {}
            Contact::Limit { force } => read.push(force),
            Contact::Restitution { coefficient } => read.push(coefficient),
            Contact::Hertz { stiffness, loss, force_limit } => {
                read.extend([stiffness, loss]);
                read.extend(force_limit);
            }
        }
        for formula in read {
            formula.collect_references(&mut references);
        }
        let mut sources = sources_of(&references, self.results);
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

    /// The run again, with a source moved by `by` standard uncertainties. The time step stays: it was chosen, not measured.
    fn moved(&self, setting: &Setting, path: &RecordedPath, source: Source, by: f64) -> Result<(Values, bool), String> {
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
            // Of another axis, or of no input of a blow: only what follows from it moves.
            _ => {}
        }
        let results = Moved { results: self.results, source, by };
        let mut inputs = Inputs::new(&results, self.procedure);
        let mut moved = Setting::evaluate(self.plan, &striker, &mut inputs, self.noise)
            .map_err(|stop| format!("an input moved by its uncertainty is none: {stop}"))?;
        moved.heavier(heavier);
        moved.input.time_step = setting.input.time_step;
        moved.steps = setting.steps;
        // Blows of one striker at several speeds are as uncertain as the one that is stated, each in proportion.
        moved.input.striker_velocity = setting.input.striker_velocity * (striker.velocity / declared.velocity);
        Ok(self.values(&moved, path, distortion))
    }

    /// And whether the record tells the way to them.
    fn values(&self, setting: &Setting, path: &RecordedPath, distortion: Distortion) -> (Values, bool) {
        let found = rerun(&setting.input, self.plan.until, setting.steps, path, distortion);
        let mut values = [setting.critical_time_step; OUTCOMES.len() + 1];
        values[..OUTCOMES.len()].copy_from_slice(&found.values);
        (values, found.unseen <= UNSEEN * found.summary.max_displacement.abs())
    }

    /// Draws errors of all readings: what each draw does, over the root of their number, is a contribution of its own, so that
    /// results that suffer from the same errors are correlated as much as they do.
    fn sample(
        &self,
        setting: &Setting,
        path: &RecordedPath,
        steps: u64,
        nominal: &Values,
        contributions: &mut [Vec<Contribution>],
    ) {
        let draws = draws_of(steps);
        // Rounding to a quantum q is even over it: q/√12.
        let (force, displacement) = (self.noise.force, self.noise.resolution / 12.0_f64.sqrt());
        let first = self.blow.saturating_mul(MOST_DRAWS);
        for draw in first..first.saturating_add(draws) {
            let noise = Some(Noise { force, displacement, draw });
            let (found, _) = self.values(setting, path, Distortion { noise, ..Distortion::NONE });
            let source = Source::Readings { procedure: self.procedure, draw };
            for ((parts, found), nominal) in contributions.iter_mut().zip(found).zip(nominal) {
                // A result that does not exist has no uncertainty, and none is looked for in its draws.
                if nominal.is_finite() {
                    parts.push(Contribution::new(source, (found - nominal) / f64::from(draws).sqrt()));
                }
            }
        }
    }

    /// A stop is told at the end of its step, up to Δt late; a peak at the nearer end, up to Δt/2 off.
    fn round_times(&self, time_step: f64, contributions: &mut [Vec<Contribution>]) {
        let source = Source::TimeStep { procedure: self.procedure };
        for (name, off) in [("stop_time", time_step / 3.0_f64.sqrt()), ("time_of_max_displacement", time_step / 12.0_f64.sqrt())]
        {
            if let Some(index) = OUTCOMES.iter().position(|outcome| *outcome == name) {
                contributions[index].push(Contribution::new(source, off));
            }
        }
    }
}

/// How many draws a run of so many steps is worth.
pub(super) fn draws_of(steps: u64) -> u16 {
    u16::try_from(STEPS_OF_DRAWS / steps.max(1)).unwrap_or(u16::MAX).clamp(FEWEST_DRAWS, MOST_DRAWS)
}

/// What moving a source by ±u does, and whether that is smooth. `moved` is at +u, +u/2, −u/2, −u. Where the two sides, or
/// the two sizes of the move, disagree, the largest change stands for it.
fn effect(nominal: f64, [up, half_up, half_down, down]: [f64; 4]) -> (f64, bool) {
    let (above, below, central, halved) = (up - nominal, nominal - down, 0.5 * (up - down), half_up - half_down);
    let widest = above.abs().max(below.abs());
    let rounding = CLOSE * nominal.abs();
    let one_sided = (above - below).abs() > ONE_SIDED * widest + rounding;
    let step_dependent = (central - halved).abs() > HALVED * widest + rounding;
    if one_sided || step_dependent {
        return (widest.max(central.abs()).max(halved.abs()).copysign(central), false);
    }
    (central, true)
}

/// Lets `told` be the most of what two suppositions make of one result: source by source of inputs that are moved, the draws
/// of readings together, for it is their sum that tells. Where the two do not agree, none of them is sure.
fn widen(told: &mut [Contribution], other: &[Contribution]) {
    let drawn = |part: &Contribution| matches!(part.source, Source::Readings { .. });
    let all_drawn =
        |parts: &[Contribution]| parts.iter().filter(|part| drawn(part)).map(|part| part.amount.powi(2)).sum::<f64>().sqrt();
    let (draws, of_other) = (all_drawn(told), all_drawn(other));
    for (told, other) in told.iter_mut().zip(other) {
        let (one, two, apart) = if drawn(told) {
            (draws, of_other, (draws - of_other).abs())
        } else {
            (told.amount.abs(), other.amount.abs(), (told.amount - other.amount).abs())
        };
        let smooth = told.smooth && other.smooth && apart <= AGREED * one.max(two);
        *told = Contribution { smooth, ..if two > one { *other } else { *told } };
    }
}

/// Whether two runs came to the same.
fn same(one: &ImpactSummary, other: &ImpactSummary) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= CLOSE * a.abs().max(b.abs());
    let read: [fn(&ImpactSummary) -> f64; 6] = [
        |summary| summary.max_displacement,
        |summary| summary.time_of_max_displacement,
        |summary| summary.stop_time.unwrap_or(-1.0),
        |summary| summary.residual_displacement,
        |summary| summary.impulse,
        |summary| summary.absorbed_energy,
    ];
    read.iter().all(|read| near(read(one), read(other)))
}
