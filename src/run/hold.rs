//! Holds that are watched: readings while a force relaxes, and what they tell. In: a pause and how many readings. Out: the hold;
//! of all holds the fit, its results and what a person should know. It fits nothing itself.

use super::results::measured;
use super::session::{Session, first};
use super::stop::Stop;
use crate::mechanics::relaxation::{Hold, RelaxationFit, Unrelaxed, fit_relaxation};
use crate::plan::WatchedHold;
use crate::quantity::Dimension;
use crate::quantity::display::readable;
use crate::record::NamedResult;
use crate::rig::Reading;

/// Time (s since the first reading) and force (N) of each reading of a pause: `settled`, then the others, closer at first, where
/// more is lost; and when the last one came, s of rig time.
pub(super) fn watched(
    settled: &Reading,
    pause: f64,
    readings: u32,
    session: &mut Session<'_>,
) -> Result<(Vec<(f64, f64)>, f64), Stop> {
    let mut taken = vec![(0.0, first(settled).1)];
    let mut last = settled.time;
    let share = |index: u32| (f64::from(index) / f64::from(readings)).powi(2);
    for index in 1..=readings {
        session.guard.pause(pause * (share(index) - share(index - 1)))?;
        let reading = session.guard.read()?;
        taken.push((reading.time - settled.time, first(&reading).1));
        last = reading.time;
    }
    Ok((taken, last))
}

/// What the holds of a ramp tell, and remarks.
pub(super) fn fitted(
    holds: &[Hold],
    start: Option<f64>,
    asked: WatchedHold,
    accuracy: Option<f64>,
) -> (Option<RelaxationFit>, Vec<String>) {
    match fit_relaxation(holds, start.unwrap_or(0.0), asked.model) {
        Ok(fit) => {
            let remarks = remarks(&fit, holds, accuracy);
            (Some(fit), remarks)
        }
        Err(reason) => {
            let text = match reason {
                Unrelaxed::TooFew => "no relaxation fitted: the holds have fewer readings than there are numbers to find",
                Unrelaxed::Steady => "no relaxation: by BIC the forces of the holds are as well told without one",
                Unrelaxed::OutOfReach => {
                    "no relaxation fitted: the forces change, but slower than the holds, or faster than their readings, can tell"
                }
            };
            (None, vec![text.to_owned()])
        }
    }
}

fn remarks(fit: &RelaxationFit, holds: &[Hold], accuracy: Option<f64>) -> Vec<String> {
    let mut told = Vec::new();
    let (tau, error) = fit.time_constant;
    if error > 0.5 * tau {
        let shown = readable(tau, Dimension::TIME);
        told.push(format!("the holds hardly tell the time constant {shown}: its standard error is more than half of it"));
    }
    let longest = holds.iter().filter_map(|hold| hold.readings.last()).map(|(time, _)| *time).fold(0.0, f64::max);
    if let Some(accuracy) = accuracy.filter(|accuracy| fit.remaining.0 > *accuracy) {
        told.push(format!(
            "the pause of {} leaves {} to relax, more than the {} asked for: {} would do",
            readable(longest, Dimension::TIME),
            readable(fit.remaining.0, Dimension::FORCE),
            readable(accuracy, Dimension::FORCE),
            readable(fit.needed_pause(accuracy).0, Dimension::TIME),
        ));
    }
    told
}

/// In the order of the reference.
pub(super) fn results(fit: Option<&RelaxationFit>, accuracy: Option<f64>) -> [NamedResult; 5] {
    let told = |(value, error): (f64, f64)| (value, Some(error));
    let of = |name, dimension, value: Option<(f64, f64)>| measured(name, dimension, value.map(told));
    [
        of("time_constant", Dimension::TIME, fit.map(|fit| fit.time_constant)),
        of("relaxed_stiffness", Dimension::STIFFNESS, fit.and_then(|fit| fit.relaxed_stiffness)),
        of("branch_stiffness", Dimension::STIFFNESS, fit.and_then(|fit| fit.branch_stiffness)),
        of("remaining_relaxation", Dimension::FORCE, fit.map(|fit| fit.remaining)),
        of("needed_pause", Dimension::TIME, fit.zip(accuracy).map(|(fit, accuracy)| fit.needed_pause(accuracy))),
    ]
}
