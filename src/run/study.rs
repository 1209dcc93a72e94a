//! A study of a run: the run taken again, with one input moved at a time, with drawn errors of all its readings and in finer time
//! steps. In: inputs of every kind of run, and what takes it again. Out: for each number that a run comes to, what each source
//! contributes (JCGM 100:2008, 5.1.3 and 5.1.4: half the difference of the results at ±u). It knows no procedure, and moves no rig.
//!
//! What a study costs is bounded by how long the run is ([`Effort`]). Its runs are independent of each other and are shared
//! out among threads; each has its place, so that the same bytes come out whatever the number of threads.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use super::stop::Stop;
use crate::formula::{ProcedureId, ResultValue};
use crate::mechanics::recorded_path::Rule;
use crate::record::NamedResult;
pub use crate::uncertainty::MOST_DRAWS;
use crate::uncertainty::{Contribution, Source, combined};

/// Draws of the readings' errors at least.
const FEWEST_DRAWS: u16 = 8;
/// And at least where inputs are drawn with them.
const FEWEST_DRAWS_OF_INPUTS: u16 = 16;
/// Steps that all draws take together, about, and all moves of inputs: what a long run is allowed to cost.
const STEPS_OF_DRAWS: u64 = 512_000;
const STEPS_OF_MOVES: u64 = 512_000;
/// Moves of inputs that a run of any length may cost.
const MOVES_OF_ANY: u64 = 24;
/// The run taken again as it was must come out as it did, relatively.
pub(super) const CLOSE: f64 = 1e-9;
/// What moving a source up does may differ by so much from what moving it down does, of the larger; beyond it the result
/// does not follow the source smoothly. Twice what half the difference may be off by.
const ONE_SIDED: f64 = 0.2;
/// And half the difference at ±u from that at ±u/2.
const HALVED: f64 = 0.1;
/// An input that cannot be moved by its uncertainty to either side is moved by no less than this share of it.
const LEAST_SHARE: f64 = 1e-3;
/// How many steps a run is integrated in again for each of its own.
pub(super) const FINER: [u8; 2] = [2, 4];
/// Halving the step again may change a result by so much of what halving it first did: by half where the scheme is of first order,
/// and room for what is beyond. Otherwise the steps do not converge.
const CONVERGES: f64 = 0.75;
/// Suppositions about the specimen that come to results so near to each other, of the larger, agree.
const AGREED: f64 = 0.2;
/// How long to wait for the next run before those who watch hear that it goes on.
const MOMENT: Duration = Duration::from_millis(20);

/// Why no uncertainty is told.
pub(super) enum Unknown {
    /// The rig failed while it waited.
    Stop(Stop),
    Reason(String),
}

impl From<String> for Unknown {
    fn from(reason: String) -> Self {
        Self::Reason(reason)
    }
}

/// Hears how many of how many runs are done; its error ends the study.
pub(super) type Tick<'a> = &'a mut dyn FnMut(usize, usize) -> Result<(), Stop>;

/// How many runs a study takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Effort {
    /// Whether every input is moved by half its uncertainty too, to see whether the results follow it in proportion.
    pub halves: bool,
    /// Whether inputs of which there is one a storey are drawn together, with the errors of the readings.
    pub together: bool,
    pub draws: u16,
}

impl Effort {
    /// `steps` of one degree of freedom, of a run with so many uncertain inputs, of which so many are one of many alike;
    /// `sampled`: whether its readings have errors.
    pub fn of(steps: u64, inputs: usize, alike: usize, sampled: bool) -> Self {
        let together = alike > 0 && 2 * inputs as u64 > (STEPS_OF_MOVES / steps.max(1)).max(MOVES_OF_ANY);
        let moved = if together { inputs - alike } else { inputs } as u64;
        let halves = 4 * moved * steps <= STEPS_OF_MOVES;
        let draws = match (sampled, together) {
            (_, true) => draws_of(steps).max(FEWEST_DRAWS_OF_INPUTS),
            (true, false) => draws_of(steps),
            (false, false) => 0,
        };
        Self { halves, together, draws }
    }

    /// By how many standard uncertainties an input is moved.
    pub fn moves(self) -> &'static [f64] {
        if self.halves { &[1.0, -1.0, 0.5, -0.5] } else { &[1.0, -1.0] }
    }

    /// The runs with one input moved; `job` makes one of by how many standard uncertainties, where its bounds let it be moved so far.
    pub fn shifted<J>(self, job: impl Fn(f64) -> Result<J, String>) -> Result<Shifted<J>, String> {
        let mut share = 1.0;
        loop {
            let jobs: Vec<Result<J, String>> = self.moves().iter().map(|by| job(share * by)).collect();
            match jobs.iter().take(2).find_map(|job| job.as_ref().err()) {
                Some(reason) if jobs.iter().take(2).all(Result::is_err) => {
                    if share < LEAST_SHARE {
                        return Err(reason.clone());
                    }
                    share *= 0.5;
                }
                _ => return Ok(Shifted { jobs: jobs.into_iter().map(Result::ok).collect(), share }),
            }
        }
    }
}

/// Runs with one input moved.
pub(super) struct Shifted<J> {
    /// At each of [`Effort::moves`]; None where the input would be past its bound.
    pub jobs: Vec<Option<J>>,
    /// By which share of its standard uncertainty it was moved.
    pub share: f64,
}

/// The run in finer time steps.
pub(super) struct Refined<J> {
    pub source: Source,
    /// The numbers as the run itself told them.
    pub told: Vec<f64>,
    /// One of each of [`FINER`].
    pub jobs: [J; 2],
}

/// How many draws a run of so many steps is worth.
pub(super) fn draws_of(steps: u64) -> u16 {
    u16::try_from(STEPS_OF_DRAWS / steps.max(1)).unwrap_or(u16::MAX).clamp(FEWEST_DRAWS, MOST_DRAWS)
}

/// Whether an input has many like it: one a storey, a mode or an axis.
pub(super) const fn is_alike(source: Source) -> bool {
    matches!(
        source,
        Source::StoreyMass { .. }
            | Source::StoreyStiffness { .. }
            | Source::DampingRatio { .. }
            | Source::ForceScale(_)
            | Source::DisplacementScale(_)
            | Source::ForceZero(_)
    )
}

/// What a run that was taken again comes to.
pub(super) struct Taken {
    pub values: Vec<f64>,
    /// Whether the record tells the way to them.
    pub seen: bool,
}

/// The runs to take.
pub(super) struct Study<J> {
    pub moved: Vec<(Source, Shifted<J>)>,
    pub refined: Option<Refined<J>>,
    /// One draw of all errors each.
    pub draws: Vec<(Source, J)>,
}

impl<J: Sync> Study<J> {
    /// What each source contributes to each of the `nominal` numbers, those of the run as it was. `again` takes a run.
    pub fn contributions(
        &self,
        nominal: &[f64],
        again: &(dyn Fn(&J) -> Taken + Sync),
        tick: Tick,
    ) -> Result<Vec<Vec<Contribution>>, Stop> {
        let moved = self.moved.iter().flat_map(|(_, shifted)| shifted.jobs.iter().flatten());
        let refined = self.refined.iter().flat_map(|refined| &refined.jobs);
        let jobs: Vec<&J> = moved.chain(refined).chain(self.draws.iter().map(|(_, job)| job)).collect();
        let found = in_threads(&jobs, &|job| again(job), tick)?;
        let mut found = found.into_iter();
        let mut contributions: Vec<Vec<Contribution>> = vec![Vec::new(); nominal.len()];
        for (source, Shifted { jobs, share }) in &self.moved {
            let taken: Vec<Option<Taken>> = jobs.iter().map(|job| job.as_ref().and_then(|_| found.next())).collect();
            let seen = taken.iter().flatten().all(|taken| taken.seen);
            let moved: Vec<Option<Vec<f64>>> = taken.into_iter().map(|taken| taken.map(|taken| taken.values)).collect();
            let [up, down, halves @ ..] = moved.as_slice() else { continue };
            for (index, (parts, nominal)) in contributions.iter_mut().zip(nominal).enumerate() {
                let at = |values: &Option<Vec<f64>>| values.as_ref().map(|values| values[index]);
                let both = |[up, down]: [Option<f64>; 2]| one_sided(*nominal, [up, down]);
                let half = match halves {
                    // To the sides that the whole move went to.
                    [half_up, half_down] => Some(both([up.as_ref().and(at(half_up)), down.as_ref().and(at(half_down))])),
                    _ => None,
                };
                let (amount, smooth) = effect(*nominal, both([at(up), at(down)]), half);
                let smooth = smooth && (seen || amount == 0.0);
                parts.push(Contribution { smooth, ..Contribution::new(*source, amount / share) });
            }
        }
        if let Some(Refined { source, told, .. }) = &self.refined {
            let taken: Vec<Taken> = found.by_ref().take(FINER.len()).collect();
            let [half, quarter] = taken.as_slice() else { return Ok(contributions) };
            for (index, (parts, told)) in contributions.iter_mut().zip(told).enumerate() {
                if told.is_finite() {
                    let (amount, smooth) = of_the_step(*told, nominal[index], [half.values[index], quarter.values[index]]);
                    let smooth = smooth && (half.seen && quarter.seen || amount == 0.0);
                    parts.push(Contribution { smooth, ..Contribution::new(*source, amount) });
                }
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_DRAWS")]
        let root = (self.draws.len() as f64).sqrt();
        for ((source, _), found) in self.draws.iter().zip(found) {
            for ((parts, found), nominal) in contributions.iter_mut().zip(found.values).zip(nominal) {
                // A result that does not exist has no uncertainty, and none is looked for in its draws.
                if nominal.is_finite() {
                    parts.push(Contribution::new(*source, (found - nominal) / root));
                }
            }
        }
        Ok(contributions)
    }
}

impl Effort {
    /// The draws of a procedure and their sources: those of its `blow`, from 0, are its own.
    pub fn draws(self, procedure: ProcedureId, blow: u16) -> impl Iterator<Item = (u16, Source)> {
        let first = blow.saturating_mul(MOST_DRAWS);
        let source = move |draw| {
            if self.together { Source::Drawn { procedure, draw } } else { Source::Readings { procedure, draw } }
        };
        (first..first.saturating_add(self.draws)).map(move |draw| (draw, source(draw)))
    }
}

/// What each job comes to, in the order of the jobs, worked on by as many threads as the machine has cores.
fn in_threads<J: Sync, T: Send>(jobs: &[J], work: &(dyn Fn(&J) -> T + Sync), tick: Tick) -> Result<Vec<T>, Stop> {
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let (next, given_up) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (tell, told) = channel();
    let mut found: Vec<Option<T>> = jobs.iter().map(|_| None).collect();
    let ended = std::thread::scope(|scope| {
        let mut threads = 0;
        for _ in 0..cores.min(jobs.len()) {
            let (tell, next, given_up) = (tell.clone(), &next, &given_up);
            let run = move || {
                while !given_up.load(Ordering::Relaxed) {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(place) else { break };
                    if tell.send((place, work(job))).is_err() {
                        break;
                    }
                }
            };
            threads += usize::from(std::thread::Builder::new().spawn_scoped(scope, run).is_ok());
        }
        drop(tell);
        let mut done = 0;
        // The rig has moved and the record is open: a machine that starts no thread costs time, and not the run.
        if threads == 0 {
            for (job, found) in jobs.iter().zip(&mut found) {
                *found = Some(work(job));
                done += 1;
                tick(done, jobs.len())?;
            }
        }
        while done < jobs.len() {
            match told.recv_timeout(MOMENT) {
                Ok((place, value)) => {
                    found[place] = Some(value);
                    done += 1;
                }
                Err(RecvTimeoutError::Timeout) => {}
                // A thread that panicked: the scope says so.
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if let Err(stop) = tick(done, jobs.len()) {
                given_up.store(true, Ordering::Relaxed);
                return Err(stop);
            }
        }
        Ok(())
    });
    ended.map(|()| found.into_iter().flatten().collect())
}

/// Results at both sides; of a side that an input cannot be moved to, as far off as at the other.
fn one_sided(nominal: f64, sides: [Option<f64>; 2]) -> [f64; 2] {
    let mirrored = |value: f64| nominal + (nominal - value);
    match sides {
        [Some(up), Some(down)] => [up, down],
        [Some(up), None] => [up, mirrored(up)],
        [None, Some(down)] => [mirrored(down), down],
        [None, None] => [f64::NAN; 2],
    }
}

/// What the length of the time step does to a number that the run `told`, which came to `nominal` when it was integrated again and to
/// these in finer steps: how far it is from them, at most. It is sure where the steps converge.
fn of_the_step(told: f64, nominal: f64, [half, quarter]: [f64; 2]) -> (f64, bool) {
    let off = [told - half, told - quarter].into_iter().reduce(|one, other| if other.abs() > one.abs() { other } else { one });
    let converges = (half - quarter).abs() <= CONVERGES * (nominal - half).abs() + CLOSE * nominal.abs();
    (off.unwrap_or_default(), converges)
}

/// What moving a source by ±u does, and whether that is smooth: `[up, down]`, and the same at ±u/2 where it was tried. Where
/// the two sides, or the two sizes of the move, disagree, the largest change stands for it.
fn effect(nominal: f64, [up, down]: [f64; 2], half: Option<[f64; 2]>) -> (f64, bool) {
    let (above, below, central) = (up - nominal, nominal - down, 0.5 * (up - down));
    let halved = half.map_or(central, |[up, down]| up - down);
    let widest = above.abs().max(below.abs());
    let rounding = CLOSE * nominal.abs();
    let one_sided = (above - below).abs() > ONE_SIDED * widest + rounding;
    let step_dependent = (central - halved).abs() > HALVED * widest + rounding;
    if one_sided || step_dependent {
        return (widest.max(central.abs()).max(halved.abs()).copysign(central), false);
    }
    (central, true)
}

/// What each source contributes to each number, if the specimen keeps to a rule.
pub(super) type Find<'a> = &'a mut dyn FnMut(Rule, Tick) -> Result<Vec<Vec<Contribution>>, Stop>;

/// What the specimen may have done for all the record tells: `find` what each source contributes by each rule, and the most
/// that any of it makes of a source is told.
pub(super) fn over_rules(rules: &[Rule], tick: Tick, find: Find) -> Result<Vec<Vec<Contribution>>, Stop> {
    let mut contributions: Vec<Vec<Contribution>> = Vec::new();
    for (place, rule) in rules.iter().enumerate() {
        let found = find(*rule, &mut |done, of| tick(place * of + done, rules.len() * of))?;
        if contributions.is_empty() {
            contributions = found;
        } else {
            for (told, other) in contributions.iter_mut().zip(found) {
                widen(told, &other);
            }
        }
    }
    Ok(contributions)
}

/// Lets `told` be the most of what two suppositions make of one result: source by source of inputs that are moved, the draws
/// of readings together, for it is their sum that tells. Where the two do not agree, none of them is sure.
fn widen(told: &mut [Contribution], other: &[Contribution]) {
    let drawn = |part: &Contribution| matches!(part.source, Source::Readings { .. } | Source::Drawn { .. });
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

/// Contributions that say something; of a result that nothing moves, not even the time step, that of the step, for its uncertainty is
/// known to be none. Nothing is known of one that is not finite.
fn told(mut parts: Vec<Contribution>) -> Vec<Contribution> {
    if !parts.iter().all(|part| part.amount.is_finite()) {
        return Vec::new();
    }
    let moves = parts.iter().any(|part| part.amount != 0.0);
    parts.retain(|part| if moves { part.amount != 0.0 } else { matches!(part.source, Source::TimeStep { .. }) });
    parts
}

/// Gives a result that is one number its contributions.
pub(super) fn give(result: &mut NamedResult, parts: Vec<Contribution>) {
    result.contributions = told(parts);
    if let ResultValue::Number { value: Some(_), uncertainty } = &mut result.value {
        *uncertainty = combined(&result.contributions);
    }
}

/// Gives one entry of a list its contributions.
pub(super) fn give_entry(result: &mut NamedResult, entry: usize, parts: Vec<Contribution>) {
    result.contributions.extend(told(parts).into_iter().map(|part| Contribution { entry, ..part }));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(index: usize) -> Source {
        Source::StrikerMass(index)
    }

    /// y = 3a + b², a moved by 0.1, b = 2 by 0.5: half the difference is exact of both; what a quadratic does to either side
    /// differs by 2·0.25 of 2.25, more than a fifth.
    #[test]
    fn a_study_finds_what_each_source_does() {
        let moves = Effort::of(10, 2, 0, false).moves();
        let of = |a: f64, b: f64| moves.iter().map(|by| (1.0 + a * by, 2.0 + b * by)).collect::<Vec<(f64, f64)>>();
        let shifted = |a, b| Shifted { jobs: of(a, b).into_iter().map(Some).collect(), share: 1.0 };
        let moved = vec![(source(0), shifted(0.1, 0.0)), (source(1), shifted(0.0, 0.5))];
        let study = Study { moved, refined: None, draws: Vec::new() };
        let again = |(a, b): &(f64, f64)| Taken { values: vec![3.0 * a + b * b], seen: *a < 1.05 };
        let found = study.contributions(&[7.0], &again, &mut |_, _| Ok(())).ok().unwrap();
        assert!((found[0][0].amount - 0.3).abs() < 1e-12 && !found[0][0].smooth, "where nothing is recorded");
        assert!((found[0][1].amount - 2.25).abs() < 1e-12 && !found[0][1].smooth, "{found:?}");
    }

    /// c = 1 ± 2 with c² at least 0: down is not there, and up is told for both sides. e = 0.5 ± 0.8 between 0 and 1 is moved by half
    /// of it. What cannot be moved at all is told why.
    #[test]
    fn an_input_is_moved_as_far_as_its_bounds_let_it() {
        let effort = Effort { halves: true, together: false, draws: 0 };
        let within = |low: f64, high: f64, value: f64, u: f64| {
            effort.shifted(move |by| {
                let moved = value + by * u;
                if (low..=high).contains(&moved) { Ok(moved) } else { Err("out of bounds".to_owned()) }
            })
        };
        let found = |shifted: Shifted<f64>, nominal: f64| {
            let study = Study { moved: vec![(source(0), shifted)], refined: None, draws: Vec::new() };
            let again = |moved: &f64| Taken { values: vec![3.0 * moved], seen: true };
            study.contributions(&[nominal], &again, &mut |_, _| Ok(())).ok().unwrap()[0][0]
        };
        let one_sided = within(0.0, f64::INFINITY, 1.0, 2.0).unwrap();
        assert_eq!(one_sided.jobs, [Some(3.0), None, Some(2.0), Some(0.0)]);
        let part = found(one_sided, 3.0);
        assert!((part.amount - 6.0).abs() < 1e-12 && part.smooth, "{part:?}");
        let smaller = within(0.0, 1.0, 0.5, 0.8).unwrap();
        assert_eq!((smaller.share, smaller.jobs[0]), (0.5, Some(0.9)));
        let part = found(smaller, 1.5);
        assert!((part.amount - 2.4).abs() < 1e-12 && part.smooth, "{part:?}");
        assert_eq!(within(2.0, 1.0, 0.5, 0.8).err().as_deref(), Some("out of bounds"));
    }

    /// Of first and of second order, and steps that do not converge.
    #[test]
    fn the_time_step_contributes_what_finer_steps_leave_out() {
        let of = |errors: [f64; 3]| {
            let [own, half, quarter] = errors.map(|error| 10.0 + error);
            of_the_step(own, own, [half, quarter])
        };
        let (first, sure) = of([1.0, 0.5, 0.25]);
        assert!((first - 0.75).abs() < 1e-12 && sure);
        let (second, sure) = of([1.0, 0.25, 0.0625]);
        assert!((second - 0.9375).abs() < 1e-12 && sure);
        let (none, sure) = of([0.0, 0.0, 0.0]);
        assert!(none == 0.0 && sure);
        let (wild, sure) = of([0.1, -0.4, 0.3]);
        assert!((wild - 0.5).abs() < 1e-12 && !sure);
        // What is told at the end of a step is off by that too.
        assert!((of_the_step(10.5, 10.0, [10.0, 10.0]).0 - 0.5).abs() < 1e-12);
    }

    /// Every job is done once, in whatever order, and stands in its place; whoever watches is told of all, and may stop it.
    #[test]
    fn jobs_keep_their_places_in_threads() {
        let jobs: Vec<u64> = (0..500).collect();
        let mut most = 0;
        let slow_first = |job: &u64| (0..(500 - job) * 50).fold(*job, |sum, more| sum ^ more << 20 >> 60);
        let found = in_threads(&jobs, &slow_first, &mut |done, of| {
            most = most.max(done);
            assert_eq!(of, 500);
            Ok(())
        });
        assert_eq!(found.ok().unwrap(), jobs);
        assert_eq!(most, 500);
        let stop = in_threads(&jobs, &|job| *job, &mut |_, _| Err(Stop::Person { reason: "enough".to_owned() }));
        assert!(matches!(stop, Err(Stop::Person { .. })));
    }

    /// However long the run and however many its inputs, a study takes few times as many steps.
    #[test]
    fn the_cost_of_a_study_is_bounded() {
        let runs = |steps, inputs, alike| {
            let effort = Effort::of(steps, inputs, alike, true);
            let moved = if effort.together { inputs - alike } else { inputs };
            moved * effort.moves().len() + usize::from(effort.draws)
        };
        assert_eq!(Effort::of(1000, 7, 3, true), Effort { halves: true, together: false, draws: 64 });
        assert_eq!(Effort::of(1000, 7, 3, false).draws, 0);
        for steps in [1_u64, 100, 8_000, 52_000, 1_000_000, 10_000_000] {
            for alike in [0, 3, 320] {
                let inputs = alike + 8;
                let bound = (STEPS_OF_DRAWS + STEPS_OF_MOVES).max(steps * (MOVES_OF_ANY + 16));
                let runs = runs(steps, inputs, alike) as u64;
                assert!(runs * steps <= bound || inputs * 4 + 64 >= 1300, "{runs} runs of {steps} steps, {inputs} inputs");
            }
        }
        assert_eq!(runs(52_000, 6, 3), 2 * 6 + 9);
        assert_eq!(runs(10_000_000, 328, 320), 2 * 8 + 16);
    }
}
