//! Dwells with readings while a force relaxes, and their evaluation. In: a pause and the number of readings. Out: the dwell; for all
//! dwells the fit, its results and observations. It fits nothing itself.

use super::points::{Point, secant};
use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use psd_physics::identification::StatedVariance;
use psd_physics::relaxation::hold::{Hold, Unrelaxed};
use psd_physics::relaxation::law::RelaxationLaw;
use psd_physics::relaxation::superposition::{SuperpositionFit, fit_superposition};
use psd_physics::relaxation::time_constant::{RelaxationFit, RelaxationModel, fit_relaxation};
use psd_plan::WatchedModel;
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::record::NamedResult;
use psd_plan::schema::ResultKind;
use psd_rig::Reading;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// The readings of a pause.
pub(crate) struct Watched {
    /// Time since the first reading \[s\] and force \[N\].
    pub readings: Vec<(f64, f64)>,
    /// Displacement at each \[m\].
    displacements: Vec<f64>,
    /// Laboratory time of the last one \[s\].
    pub last: f64,
}

/// Readings of a pause: `settled`, then the others, closer together at first, when more is lost.
pub(crate) fn watched(
    settled: &Reading,
    pause: f64,
    readings: u32,
    session: &mut Session<'_>,
) -> Result<Watched, Stop> {
    let (displacement, force) = first(settled);
    let mut watched = Watched {
        readings: vec![(0.0, force)],
        displacements: vec![displacement],
        last: settled.time,
    };
    let share = |index: u32| (f64::from(index) / f64::from(readings)).powi(2);
    for index in 1..=readings {
        session
            .guard
            .pause(pause * (share(index) - share(index - 1)))?;
        let reading = session.guard.read()?;
        let (displacement, force) = first(&reading);
        watched.readings.push((reading.time - settled.time, force));
        watched.displacements.push(displacement);
        watched.last = reading.time;
    }
    Ok(watched)
}

/// A dwell with the distances at which its readings found the actuator: it can still arrive during the first ones.
pub(crate) struct Arriving {
    pub hold: Hold,
    /// Missing to the displacement of the dwell at each reading \[m\]; 0 if the rig does not resolve it.
    missing: Vec<f64>,
    /// Secant stiffness of the move to it \[N/m\].
    secant: f64,
}

impl Arriving {
    /// `before`: the point where the move began; `resolution` of the displacement \[m\].
    pub(crate) fn new(hold: Hold, watched: &Watched, before: Point, resolution: f64) -> Self {
        let began = (watched.displacements[0], watched.readings[0].1);
        let missing = |displacement: &f64| hold.displacement - displacement;
        let resolved = |missing: f64| {
            if missing.abs() > resolution {
                missing
            } else {
                0.0
            }
        };
        Self {
            missing: watched
                .displacements
                .iter()
                .map(missing)
                .map(resolved)
                .collect(),
            secant: secant(before, began).unwrap_or(0.0),
            hold,
        }
    }

    /// The dwell with the force of every reading at its displacement, by this stiffness \[N/m\] or by that of the move.
    fn arrived(&self, stiffness: Option<f64>) -> Hold {
        let stiffness = stiffness.unwrap_or(self.secant);
        let readings = self.hold.readings.iter().zip(&self.missing);
        Hold {
            readings: readings
                .map(|((time, force), missing)| (*time, force + stiffness * missing))
                .collect(),
            ..self.hold.clone()
        }
    }
}

/// Seconds during which a rig waited, moved and settled between a reading before a move and one after it; `moved` is the observed
/// interval of motion. If it was not observed, all the time counts as motion.
pub(crate) fn parts(before: f64, moved: Option<[f64; 2]>, after: f64) -> [f64; 3] {
    let [from, to] = moved.unwrap_or([before, after]);
    let from = from.max(before).min(after);
    let to = to.max(from).min(after);
    [from - before, to - from, after - to].map(|seconds| seconds.max(0.0))
}

/// The evaluation of the dwells of a ramp.
#[derive(Default)]
pub(crate) struct DwellEvaluation {
    pub relaxation: Option<RelaxationFit>,
    pub reached: Option<SuperpositionFit>,
    pub results: Vec<NamedResult>,
    pub remarks: Vec<String>,
}

/// The fit of a decay. A solid shows its instantaneous stiffness, which brings the readings of an arriving actuator to the displacement of
/// their dwell better than the secant of a move during which the specimen relaxes.
fn decay(
    dwells: &[Arriving],
    start: f64,
    model: RelaxationModel,
    stated: StatedVariance,
) -> Result<RelaxationFit, Unrelaxed> {
    let fit = |stiffness| {
        let holds: Vec<Hold> = dwells
            .iter()
            .map(|dwell| dwell.arrived(stiffness))
            .collect();
        fit_relaxation(&holds, start, model, stated)
    };
    let by_secants = fit(None)?;
    let late = || dwells.iter().flat_map(|dwell| &dwell.missing);
    match (by_secants.relaxed_stiffness, by_secants.branch_stiffness) {
        (Some((relaxed, _)), Some((branch, _))) if late().any(|missing| *missing != 0.0) => {
            fit(Some(relaxed + branch))
        }
        _ => Ok(by_secants),
    }
}

/// `start`: displacement \[m\] and force \[N\] before the first move; `noise`: the declared noise of the cell \[N\]; `stated`: the
/// variance of a single reading.
pub(crate) fn evaluate_dwells(
    dwells: &[Arriving],
    start: (f64, f64),
    asked: Option<WatchedModel>,
    noise: Option<f64>,
    stated: StatedVariance,
) -> DwellEvaluation {
    let mut evaluation = DwellEvaluation::default();
    let holds: Vec<Hold> = dwells.iter().map(|dwell| dwell.arrived(None)).collect();
    let mut accuracy = noise;
    match asked {
        Some(WatchedModel::Decay {
            model,
            accuracy: asked,
        }) => {
            accuracy = asked.or(noise);
            match decay(dwells, start.0, model, stated) {
                Ok(fit) => {
                    evaluation.remarks = remarks(&fit, &holds, accuracy);
                    evaluation.relaxation = Some(fit);
                }
                Err(reason) => evaluation.remarks.push(unrelaxed(reason).to_owned()),
            }
        }
        Some(WatchedModel::Reached { law, rate }) => {
            match fit_superposition(&holds, start.1, law, rate, stated) {
                Ok(fit) => {
                    evaluation.remarks = reached_remarks(&fit, &holds, rate, noise);
                    evaluation.reached = Some(fit);
                }
                Err(reason) => evaluation.remarks.push(unrelaxed(reason).to_owned()),
            }
        }
        None => {}
    }
    evaluation.results = results(
        evaluation.relaxation.as_ref(),
        evaluation.reached.as_ref(),
        accuracy,
    )
    .into();
    if matches!(asked, Some(WatchedModel::Reached { .. })) {
        evaluation
            .results
            .extend(of_the_law(evaluation.reached.as_ref()));
    }
    evaluation
}

const fn unrelaxed(reason: Unrelaxed) -> &'static str {
    match reason {
        Unrelaxed::TooFew => "no relaxation fitted: the pauses have fewer readings than parameters",
        Unrelaxed::Steady => {
            "no relaxation: by BIC the forces in the pauses are described equally well without it"
        }
        Unrelaxed::OutOfReach => {
            "no relaxation fitted: the forces change too slowly for the pauses, or too fast for their readings"
        }
    }
}

/// If the readings scatter about a law by more than this many times the cell's noise, the law does not describe them.
const FAR: f64 = 2.0;
/// Differences of BIC below this are not strong (Kass & Raftery, *Bayes factors*, J. Amer. Stat. Assoc. 90 (1995) 773–795).
const STRONG: f64 = 6.0;

fn reached_remarks(
    fit: &SuperpositionFit,
    holds: &[Hold],
    rate: f64,
    noise: Option<f64>,
) -> Vec<String> {
    let mut texts = Vec::new();
    let best = fit.best();
    if fit.margin().is_some_and(|margin| margin.abs() < STRONG) {
        texts.push(
            "the pauses do not distinguish exponential from logarithmic relaxation: use longer pauses, or more readings"
                .to_owned(),
        );
    }
    if let Some(noise) = noise.filter(|noise| best.scatter > FAR * noise) {
        texts.push(format!(
            "the readings in the pauses scatter by {} about the law, but the noise is {}: relaxation is not the only effect",
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
        texts.push(format!(
            "at the end of the pause of {} the force rate was {} (limit {}): a pause of {} is sufficient",
            readable(longest, Dimension::TIME),
            readable(best.rate.0, Dimension::FORCE_RATE),
            readable(rate, Dimension::FORCE_RATE),
            readable(best.required_pause.0, Dimension::TIME),
        ));
    }
    texts
}

fn remarks(fit: &RelaxationFit, holds: &[Hold], accuracy: Option<f64>) -> Vec<String> {
    let mut texts = Vec::new();
    let (tau, error) = fit.time_constant;
    if error > 0.5 * tau {
        let shown = readable(tau, Dimension::TIME);
        texts.push(format!(
            "the time constant {shown} is uncertain: its standard error is more than half of it"
        ));
    }
    let longest = holds
        .iter()
        .filter_map(|hold| hold.readings.last())
        .map(|(time, _)| *time)
        .fold(0.0, f64::max);
    if let Some(accuracy) = accuracy.filter(|accuracy| fit.remaining.0 > *accuracy) {
        texts.push(format!(
            "the pause of {} leaves a relaxation of {} (limit {}): a pause of {} is sufficient",
            readable(longest, Dimension::TIME),
            readable(fit.remaining.0, Dimension::FORCE),
            readable(accuracy, Dimension::FORCE),
            readable(fit.required_pause(accuracy).0, Dimension::TIME),
        ));
    }
    texts
}

/// A result with its standard error.
fn with_error(kind: ResultKind, value: Option<(f64, f64)>) -> NamedResult {
    kind.found_with(value.map(|(value, error)| (value, Some(error))))
}

/// In the order of the reference.
fn results(
    fit: Option<&RelaxationFit>,
    reached: Option<&SuperpositionFit>,
    accuracy: Option<f64>,
) -> [NamedResult; 5] {
    let reached = reached.map(SuperpositionFit::best);
    let decays = reached.filter(|fit| fit.law == RelaxationLaw::Exponential);
    let needed = fit
        .zip(accuracy)
        .map(|(fit, accuracy)| fit.required_pause(accuracy));
    [
        with_error(
            schema::TIME_CONSTANT,
            fit.map(|fit| fit.time_constant)
                .or(decays.map(|fit| fit.time)),
        ),
        with_error(
            schema::RELAXED_STIFFNESS,
            fit.and_then(|fit| fit.relaxed_stiffness),
        ),
        with_error(
            schema::BRANCH_STIFFNESS,
            fit.and_then(|fit| fit.branch_stiffness),
        ),
        with_error(
            schema::REMAINING_RELAXATION,
            fit.map(|fit| fit.remaining)
                .or(decays.and_then(|fit| fit.remaining)),
        ),
        with_error(
            schema::REQUIRED_PAUSE,
            needed.or(reached.map(|fit| fit.required_pause)),
        ),
    ]
}

/// The results that only a law of the instantaneous force has.
fn of_the_law(fit: Option<&SuperpositionFit>) -> [NamedResult; 4] {
    let best = fit.map(SuperpositionFit::best);
    let by_logarithm = best.filter(|fit| fit.law == RelaxationLaw::Logarithmic);
    [
        with_error(schema::RELAXATION_SHARE, best.map(|fit| fit.share)),
        with_error(schema::REFERENCE_TIME, by_logarithm.map(|fit| fit.time)),
        with_error(schema::RELAXATION_RATE, best.map(|fit| fit.rate)),
        schema::BIC_MARGIN.found(fit.and_then(SuperpositionFit::margin)),
    ]
}
