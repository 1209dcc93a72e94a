//! `psd rig probe`: the identity of the rig, its readings at rest, their scatter and zero drift, and its margin to each limit. Nothing
//! moves.

use std::path::PathBuf;

use clap::Args;

use crate::args::PlanSettings;
use std::fmt::Write as _;

use crate::exit::{Exit, Failure};
use crate::output::print_result;
use psd_physics::identification::fit_line;
use psd_plan::{Datum, Interval, Plan};
use psd_rig::{Identity, Reading, Rig};
use psd_text::diagnostic::excerpt::escape;
use psd_text::units::Dimension;
use psd_text::units::display::{plain, readable};

/// Number of readings; time between two readings \[s\].
const READINGS: usize = 10;
const APART: f64 = 0.1;

/// Relative rounding error of the mean of ten equal readings.
const DUST: f64 = 1e-12;

#[derive(Debug, Args)]
#[command(after_help = "Exit codes:\n\
\x20 0  the rig answers and is within its limits\n\
\x20 2  error in the plan or on the command line\n\
\x20 3  no rig answers, or a different rig than the plan names\n\
\x20 4  the rig is outside a limit")]
pub struct ProbeArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
}

/// Prints the report; exit 4 if the rig is outside a limit.
pub fn probe(rig: &mut dyn Rig, plan: &Plan) -> Result<Exit, Failure> {
    let identity = rig.identity();
    let mut readings = Vec::with_capacity(READINGS);
    for index in 0..READINGS {
        if index > 0 {
            rig.pause(APART).map_err(Failure::Rig)?;
        }
        readings.push(rig.read().map_err(Failure::Rig)?);
    }
    let axes = (0..rig.degrees_of_freedom())
        .map(|axis| Axis::of(&readings, axis))
        .collect::<Vec<_>>();
    let datum = rig.datum().filter(|_| {
        plan.rig
            .link
            .as_real()
            .is_some_and(|link| link.datum != Datum::Machine)
    });
    print_result(&report(&identity, &axes, plan, datum.as_deref()))?;
    let inside = |(axis_index, axis): (usize, &Axis)| {
        let limits = plan.rig.limits_of(axis_index, &plan.limits);
        limits.displacement.contains(axis.displacement.mean)
            && limits.force.contains(axis.force.mean)
    };
    Ok(if axes.iter().enumerate().all(inside) {
        Exit::Met
    } else {
        Exit::Stopped
    })
}

/// One degree of freedom.
struct Axis {
    displacement: Channel,
    force: Channel,
}

/// Statistics of the readings of one channel at rest, SI.
struct Channel {
    mean: f64,
    /// Standard deviation about the zero drift.
    noise: f64,
    /// Change per second, and its standard error: noise alone also gives a small slope.
    drift: f64,
    drift_error: f64,
}

impl Axis {
    fn of(readings: &[Reading], axis: usize) -> Self {
        let times: Vec<f64> = readings.iter().map(|reading| reading.time).collect();
        let values = |of: fn(&Reading) -> &Vec<f64>| -> Vec<f64> {
            readings
                .iter()
                .filter_map(|reading| of(reading).get(axis).copied())
                .collect()
        };
        let displacement = Channel::of(&times, &values(|reading| &reading.displacement));
        Self {
            displacement,
            force: Channel::of(&times, &values(|reading| &reading.force)),
        }
    }
}

impl Channel {
    #[expect(clippy::cast_precision_loss, reason = "ten readings")]
    fn of(times: &[f64], values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let middle = times.iter().sum::<f64>() / count;
        let (drift, drift_error) =
            fit_line(times, values).map_or((0.0, 0.0), |fit| (fit.slope, fit.slope_error));
        let square = |(time, value): (&f64, &f64)| (value - mean - drift * (time - middle)).powi(2);
        let squares: f64 = times.iter().zip(values).map(square).sum();
        let noise = (squares / (count - 2.0).max(1.0)).sqrt();
        let lasted = times
            .last()
            .zip(times.first())
            .map_or(0.0, |(last, first)| last - first);
        // The rounding error of a sum is neither noise nor zero drift.
        let dust = DUST
            * values
                .iter()
                .fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let above_rounding = |value: f64, over: f64| {
            if value.abs() * over > dust {
                value
            } else {
                0.0
            }
        };
        Self {
            mean,
            noise: above_rounding(noise, 1.0),
            drift: above_rounding(drift, lasted),
            drift_error: above_rounding(drift_error, lasted),
        }
    }
}

impl Channel {
    /// Ten readings justify two digits.
    fn noise_text(&self, dimension: Dimension) -> String {
        if self.noise > 0.0 {
            format!("noise {}", plain(self.noise, dimension, 2))
        } else {
            "no noise".to_owned()
        }
    }

    /// A zero drift within the noise is reported as an upper bound only.
    fn drift_text(&self, rate: Dimension) -> String {
        let per_second = if rate == Dimension::VELOCITY {
            ""
        } else {
            "/s"
        };
        let rounded = |drift| format!("{}{per_second}", plain(drift, rate, 2));
        if self.drift == 0.0 && self.drift_error == 0.0 {
            "no drift".to_owned()
        } else if self.drift.abs() > 3.0 * self.drift_error {
            format!("drift {}", rounded(self.drift))
        } else {
            format!(
                "drift below {}",
                rounded(self.drift.abs() + 2.0 * self.drift_error)
            )
        }
    }
}

/// Values that are too small or missing in the rig block, ready to be copied into it.
fn advice(axes: &[Axis], plan: &Plan) -> Option<String> {
    let stated = plan.rig.link.as_real()?.readings.noise;
    let noise = axes.iter().map(|axis| axis.force.noise).fold(0.0, f64::max);
    // Ten readings give the noise to about a quarter of its value.
    let more = noise > 1.5 * stated;
    more.then(|| {
        format!(
            "  the declared noise is too low: write noise = {}\n",
            plain(noise, Dimension::FORCE, 2)
        )
    })
}

fn report(identity: &Identity, axes: &[Axis], plan: &Plan, datum: Option<&[f64]>) -> String {
    let mut text = format!(
        "{}{}\n",
        escape(&identity.name),
        if identity.simulated {
            " (simulated)"
        } else {
            ""
        }
    );
    for (what, word) in [
        ("model", &identity.model),
        ("serial number", &identity.serial),
        ("firmware", &identity.firmware),
    ] {
        if !word.is_empty() {
            let _ = writeln!(text, "  {what:<14}{}", escape(word));
        }
    }
    if let Some(positions) = datum {
        let positions: Vec<String> = positions
            .iter()
            .map(|position| plain(*position, Dimension::LENGTH, 6))
            .collect();
        let _ = writeln!(
            text,
            "  at {} in its own coordinate: a run would start there, at 0",
            positions.join(", ")
        );
    }
    for (number, axis) in (1..).zip(axes) {
        if axes.len() > 1 {
            let _ = writeln!(text, "  axis {number}");
        }
        let limits = plan.rig.limits_of(number - 1, &plan.limits);
        channel(
            &mut text,
            "displacement",
            Dimension::LENGTH,
            Dimension::VELOCITY,
            &axis.displacement,
            limits.displacement,
        );
        let (force, limit) = (&axis.force, limits.force);
        channel(
            &mut text,
            "force",
            Dimension::FORCE,
            Dimension::FORCE,
            force,
            limit,
        );
    }
    text.push_str(&advice(axes, plan).unwrap_or_default());
    text
}

fn channel(
    text: &mut String,
    name: &str,
    dimension: Dimension,
    rate: Dimension,
    channel: &Channel,
    limit: Interval,
) {
    let mean = channel.mean;
    let (noise, drift) = (channel.noise_text(dimension), channel.drift_text(rate));
    let _ = writeln!(
        text,
        "  {name:<14}{:<11} {noise:<15} {drift}",
        readable(mean, dimension)
    );
    for (end, bound, margin) in [
        ("low", limit.low, mean - limit.low),
        ("high", limit.high, limit.high - mean),
    ] {
        if bound.is_finite() {
            let bound = plain(bound, dimension, 4);
            let past = if margin >= 0.0 {
                "margin"
            } else {
                "LIMIT EXCEEDED by"
            };
            let _ = writeln!(
                text,
                "    {end:<12}{bound:<11} {past} {}",
                readable(margin.abs(), dimension)
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drift_is_not_counted_as_noise() {
        let times: Vec<f64> = (0..10).map(|index| f64::from(index) * 0.1).collect();
        let drifting: Vec<f64> = times.iter().map(|time| 5.0 + 2.0 * time).collect();
        let channel = Channel::of(&times, &drifting);
        assert!(
            (channel.drift - 2.0).abs() < 1e-9
                && channel.noise < 1e-9
                && (channel.mean - 5.9).abs() < 1e-9
        );
        assert_eq!(channel.drift_text(Dimension::FORCE), "drift 2 N/s");
        // Alternating ±1: scatter of about 1 about its line, with two parameters fitted to ten readings.
        let noisy: Vec<f64> = (0..10)
            .map(|index| if index % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let channel = Channel::of(&times, &noisy);
        assert!((1.0..1.2).contains(&channel.noise), "{}", channel.noise);
        assert_eq!(channel.noise_text(Dimension::FORCE), "noise 1.1 N");
        let drift_text = channel.drift_text(Dimension::FORCE);
        assert!(
            drift_text.starts_with("drift below "),
            "noise is not taken for drift: {drift_text}"
        );
        for alike in [0.1, 1.249_871e-3, -812.344] {
            let still = Channel::of(&times, &[alike; 10]);
            assert_eq!(
                (still.noise, still.drift, still.drift_error),
                (0.0, 0.0, 0.0),
                "{alike}"
            );
        }
        let still = Channel::of(&times, &[0.25; 10]);
        assert_eq!(
            (
                still.noise_text(Dimension::FORCE),
                still.drift_text(Dimension::FORCE)
            ),
            ("no noise".into(), "no drift".into())
        );
    }

    #[test]
    fn columns_are_separate_however_long_their_words() {
        let mut text = String::new();
        let still = Channel {
            mean: -12_345.678,
            noise: 0.001_234,
            drift: 0.0,
            drift_error: 1.2e-9,
        };
        channel(
            &mut text,
            "displacement",
            Dimension::LENGTH,
            Dimension::VELOCITY,
            &still,
            Interval {
                low: -1e5,
                high: 1e5,
            },
        );
        for line in text.lines() {
            assert!(
                line.contains(" noise ") && line.contains(" drift ") || line.contains(" margin "),
                "{line}"
            );
        }
    }
}
