//! Holds that are watched: readings while a force relaxes, and what they tell. In: a pause and how many readings. Out: the hold;
//! of all holds the fit, its results and what a person should know. It fits nothing itself.

use crate::physics::identification::StatedVariance;
use crate::physics::relaxation::hold::{Hold, Unrelaxed};
use crate::physics::relaxation::law::RelaxationLaw;
use crate::physics::relaxation::superposition::{SuperpositionFit, fit_superposition_stated};
use crate::physics::relaxation::time_constant::{RelaxationFit, fit_relaxation_stated};
use crate::plan::WatchedModel;
use crate::record::NamedResult;
use crate::rig::Reading;
use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use crate::schema::ResultKind;
use crate::schema::procedures::stiffness_ramp as schema;
use crate::units::Dimension;
use crate::units::display::readable;

/// Time (s since the first reading) and force (N) of each reading of a pause: `settled`, then the others, closer at first, where
/// more is lost; and when the last one came, s of rig time.
pub(crate) fn watched(
    settled: &Reading,
    pause: f64,
    readings: u32,
    session: &mut Session<'_>,
) -> Result<(Vec<(f64, f64)>, f64), Stop> {
    let mut taken = vec![(0.0, first(settled).1)];
    let mut last = settled.time;
    let share = |index: u32| (f64::from(index) / f64::from(readings)).powi(2);
    for index in 1..=readings {
        session
            .guard
            .pause(pause * (share(index) - share(index - 1)))?;
        let reading = session.guard.read()?;
        taken.push((reading.time - settled.time, first(&reading).1));
        last = reading.time;
    }
    Ok((taken, last))
}

/// s that a rig waited, moved and settled between a reading before a move and one after it, which is seen to have gone from one instant to
/// another. Where it was not seen, as in the records of older versions, all of it counts as moved.
pub(crate) fn parts(before: f64, moved: Option<[f64; 2]>, after: f64) -> [f64; 3] {
    let [from, to] = moved.unwrap_or([before, after]);
    let from = from.max(before).min(after);
    let to = to.max(from).min(after);
    [from - before, to - from, after - to].map(|seconds| seconds.max(0.0))
}

/// What the holds of a ramp tell.
#[derive(Default)]
pub(crate) struct Told {
    pub relaxation: Option<RelaxationFit>,
    pub reached: Option<SuperpositionFit>,
    pub results: Vec<NamedResult>,
    pub remarks: Vec<String>,
}

/// `start`: displacement (m) and force (N) before the first move; `noise`: what the rig declares of its cell, N; `stated`: of a single
/// reading.
pub(crate) fn told(
    holds: &[Hold],
    start: (f64, f64),
    asked: Option<WatchedModel>,
    noise: Option<f64>,
    stated: StatedVariance,
) -> Told {
    let mut told = Told::default();
    let mut accuracy = noise;
    match asked {
        Some(WatchedModel::Decay {
            model,
            accuracy: asked,
        }) => {
            accuracy = asked.or(noise);
            match fit_relaxation_stated(holds, start.0, model, stated) {
                Ok(fit) => {
                    told.remarks = remarks(&fit, holds, accuracy);
                    told.relaxation = Some(fit);
                }
                Err(reason) => told.remarks.push(unrelaxed(reason).to_owned()),
            }
        }
        Some(WatchedModel::Reached { law, rate }) => {
            match fit_superposition_stated(holds, start.1, law, rate, stated) {
                Ok(fit) => {
                    told.remarks = reached_remarks(&fit, holds, rate, noise);
                    told.reached = Some(fit);
                }
                Err(reason) => told.remarks.push(unrelaxed(reason).to_owned()),
            }
        }
        None => {}
    }
    told.results = results(told.relaxation.as_ref(), told.reached.as_ref(), accuracy).into();
    if matches!(asked, Some(WatchedModel::Reached { .. })) {
        told.results.extend(of_the_law(told.reached.as_ref()));
    }
    told
}

const fn unrelaxed(reason: Unrelaxed) -> &'static str {
    match reason {
        Unrelaxed::TooFew => {
            "no relaxation fitted: the holds have fewer readings than there are numbers to find"
        }
        Unrelaxed::Steady => {
            "no relaxation: by BIC the forces of the holds are as well told without one"
        }
        Unrelaxed::OutOfReach => {
            "no relaxation fitted: the forces change, but slower than the holds, or faster than their readings, can tell"
        }
    }
}

/// Readings about a law farther than this many times the cell's noise are not told by it.
const FAR: f64 = 2.0;
/// Differences of BIC below this are not strong (Kass & Raftery, *Bayes factors*, J. Amer. Stat. Assoc. 90 (1995) 773–795).
const STRONG: f64 = 6.0;

fn reached_remarks(
    fit: &SuperpositionFit,
    holds: &[Hold],
    rate: f64,
    noise: Option<f64>,
) -> Vec<String> {
    let mut told = Vec::new();
    let best = fit.best();
    if fit.margin().is_some_and(|margin| margin.abs() < STRONG) {
        told.push(
            "the holds hardly tell whether the force relaxes exponentially or with the logarithm of time: longer pauses, or more readings, would"
                .to_owned(),
        );
    }
    if let Some(noise) = noise.filter(|noise| best.scatter > FAR * noise) {
        told.push(format!(
            "the readings of the holds scatter by {} about the law, the cell by {}: they do not relax by it alone",
            readable(best.scatter, Dimension::FORCE),
            readable(noise, Dimension::FORCE),
        ));
    }
    if best.rate.0 > rate {
        let longest = holds
            .iter()
            .filter_map(|hold| hold.readings.last())
            .map(|(time, _)| *time)
            .fold(0.0, f64::max);
        told.push(format!(
            "at the end of the pause of {} the force was still falling by {}, faster than the {} asked for: {} would do",
            readable(longest, Dimension::TIME),
            readable(best.rate.0, Dimension::FORCE_RATE),
            readable(rate, Dimension::FORCE_RATE),
            readable(best.required_pause.0, Dimension::TIME),
        ));
    }
    told
}

fn remarks(fit: &RelaxationFit, holds: &[Hold], accuracy: Option<f64>) -> Vec<String> {
    let mut told = Vec::new();
    let (tau, error) = fit.time_constant;
    if error > 0.5 * tau {
        let shown = readable(tau, Dimension::TIME);
        told.push(format!("the holds hardly tell the time constant {shown}: its standard error is more than half of it"));
    }
    let longest = holds
        .iter()
        .filter_map(|hold| hold.readings.last())
        .map(|(time, _)| *time)
        .fold(0.0, f64::max);
    if let Some(accuracy) = accuracy.filter(|accuracy| fit.remaining.0 > *accuracy) {
        told.push(format!(
            "the pause of {} leaves {} to relax, more than the {} asked for: {} would do",
            readable(longest, Dimension::TIME),
            readable(fit.remaining.0, Dimension::FORCE),
            readable(accuracy, Dimension::FORCE),
            readable(fit.required_pause(accuracy).0, Dimension::TIME),
        ));
    }
    told
}

const fn told_with((value, error): (f64, f64)) -> (f64, Option<f64>) {
    (value, Some(error))
}

/// In the order of the reference.
fn results(
    fit: Option<&RelaxationFit>,
    reached: Option<&SuperpositionFit>,
    accuracy: Option<f64>,
) -> [NamedResult; 5] {
    let of = |kind: ResultKind, value: Option<(f64, f64)>| kind.found_with(value.map(told_with));
    let reached = reached.map(SuperpositionFit::best);
    let decays = reached.filter(|fit| fit.law == RelaxationLaw::Exponential);
    let needed = fit
        .zip(accuracy)
        .map(|(fit, accuracy)| fit.required_pause(accuracy));
    [
        of(
            schema::TIME_CONSTANT,
            fit.map(|fit| fit.time_constant)
                .or(decays.map(|fit| fit.time)),
        ),
        of(
            schema::RELAXED_STIFFNESS,
            fit.and_then(|fit| fit.relaxed_stiffness),
        ),
        of(
            schema::BRANCH_STIFFNESS,
            fit.and_then(|fit| fit.branch_stiffness),
        ),
        of(
            schema::REMAINING_RELAXATION,
            fit.map(|fit| fit.remaining)
                .or(decays.and_then(|fit| fit.remaining)),
        ),
        of(
            schema::NEEDED_PAUSE,
            needed.or(reached.map(|fit| fit.required_pause)),
        ),
    ]
}

/// What only a law of the reached force has.
fn of_the_law(fit: Option<&SuperpositionFit>) -> [NamedResult; 4] {
    let of = |kind: ResultKind, value: Option<(f64, f64)>| kind.found_with(value.map(told_with));
    let best = fit.map(SuperpositionFit::best);
    let by_logarithm = best.filter(|fit| fit.law == RelaxationLaw::Logarithmic);
    [
        of(schema::RELAXATION_SHARE, best.map(|fit| fit.share)),
        of(schema::REFERENCE_TIME, by_logarithm.map(|fit| fit.time)),
        of(schema::RELAXATION_RATE, best.map(|fit| fit.rate)),
        schema::BIC_MARGIN.found(fit.and_then(SuperpositionFit::margin)),
    ]
}
