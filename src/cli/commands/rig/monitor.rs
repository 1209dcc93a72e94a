//! `psd rig monitor`: continuous readings, on the live screen of a terminal or one line per reading in a pipe. Nothing moves.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use super::typed;
use crate::args::PlanSettings;
use crate::exit::{Exit, Failure};
use crate::operator::screen::{Screen, is_large_enough};
use crate::operator::watch::Signals;
use crate::output::print_while_read;
use crate::settings::Settings;
use psd::run::{Observer as _, StepReport};
use psd_plan::Plan;
use psd_rig::{Reading, Rig, StopRequest};

#[derive(Debug, Args)]
#[command(after_help = "In a pipe: one line per reading, in SI units.\n\n\
Exit codes:\n\
\x20 0  ended by Ctrl-C, `q`, `--count` or its reader\n\
\x20 2  error in the plan or on the command line\n\
\x20 3  fault of the rig, or no answer")]
pub struct MonitorArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Stop after this number of readings
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub count: Option<u64>,
    /// Time between two readings, from 10 ms to 1 min
    #[arg(long, value_name = "TIME", default_value = "100 ms")]
    pub every: String,
}

/// Interval and number of readings.
pub struct MonitorRequest {
    /// Time from one reading to the next \[s\].
    pub every: f64,
    /// None: until Ctrl-C.
    pub count: Option<u64>,
}

impl MonitorRequest {
    /// The request of the command line.
    pub fn of(arguments: &MonitorArguments) -> Result<Self, Failure> {
        Ok(Self {
            every: typed::every(&arguments.every)?,
            count: arguments.count,
        })
    }
}

/// Reads until Ctrl-C, `q`, `count` readings, or until the reader of the lines has gone.
pub fn monitor(
    rig: &mut dyn Rig,
    plan: &Plan,
    request: &MonitorRequest,
    stop_request: &StopRequest,
    settings: Settings,
) -> Result<Exit, Failure> {
    let MonitorRequest { every, count } = *request;
    let _signals = Signals::ending(stop_request).map_err(Failure::Signals)?;
    let simulated = rig.identity().simulated;
    let on_screen =
        settings.can_ask && settings.stdout_terminal && settings.unicode && is_large_enough();
    let mut screen = on_screen.then(|| {
        Screen::monitor(
            plan,
            simulated,
            "MONITOR",
            stop_request.clone(),
            settings.color,
        )
    });
    if let Some(screen) = &mut screen {
        screen.procedure_started("readings", "monitor", None);
    } else {
        print_while_read(&header(rig.degrees_of_freedom()))?;
    }
    let mut number = 0;
    while !stop_request.end_requested() && count.is_none_or(|count| number < count) {
        if number > 0 {
            rig.pause(every).map_err(Failure::Rig)?;
            // A simulated rig does not wait: slow down for the operator.
            if simulated && count.is_none() {
                std::thread::sleep(Duration::from_secs_f64(every));
            }
        }
        number += 1;
        let reading = rig.read().map_err(Failure::Rig)?;
        match &mut screen {
            Some(screen) => screen.step_done(&step(number, &reading)),
            None if print_while_read(&line(&reading))? => {}
            None => break,
        }
    }
    Ok(Exit::Met)
}

/// A reading as a step without a target.
fn step(number: u64, reading: &Reading) -> StepReport {
    let positions = &reading.displacement;
    StepReport::of_readings(number, reading.time, positions, positions, &reading.force)
}

/// The names of the columns of [`line`].
fn header(axes: usize) -> String {
    let columns = |quantity: &str, unit: &str| match axes {
        1 => format!("{quantity}_{unit}"),
        _ => (1..=axes)
            .map(|axis| format!("{quantity}_{axis}_{unit}"))
            .collect::<Vec<_>>()
            .join(","),
    };
    format!(
        "time_s,{},{}\n",
        columns("displacement", "m"),
        columns("force", "n")
    )
}

/// SI values, comma-separated; with several degrees of freedom all displacements, then all forces.
fn line(reading: &Reading) -> String {
    let values = std::iter::once(&reading.time)
        .chain(&reading.displacement)
        .chain(&reading.force);
    let cells: Vec<String> = values.map(ToString::to_string).collect();
    format!("{}\n", cells.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_is_one_line_that_reads_back() {
        let reading = Reading {
            time: 0.1,
            displacement: vec![1e-3],
            force: vec![-0.3],
            raw: Vec::new(),
        };
        assert_eq!(line(&reading), "0.1,0.001,-0.3\n");
        assert_eq!(step(3, &reading).axes[0].force, -0.3);
        assert_eq!(header(1), "time_s,displacement_m,force_n\n");
        assert_eq!(
            header(2),
            "time_s,displacement_1_m,displacement_2_m,force_1_n,force_2_n\n"
        );
    }
}
