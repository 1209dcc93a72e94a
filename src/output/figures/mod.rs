//! Figures: what the plan's report asks for, drawn as PNG at 192 dpi and in vectors. In: a run. Out: bytes with the caption
//! the certificate prints below them, one figure at a time: the sheet of a picture takes 60 MB while it is drawn. Knows no HTML.

mod axis;
mod blows;
mod canvas;
mod chart;
mod cyclic;
mod data;
mod draw;
mod identification;
mod impact;
mod plain;
mod points;
mod raster;
mod relaxation;
mod shake;
mod storey;
mod together;
mod vector;

use super::{OutputError, Run};
use crate::formula::ProcedureId;
use crate::plan::{Figure, FigureKind};
use crate::record::{FloorStep, History, ProcedureRecord, RampHistory, ShakeHistory};
use chart::Chart;

pub use data::{FIGURE_DATA, FigureAxis, FigureBand, FigureCurve, FigureData, Figures};
pub use plain::{Curve, Curves, PlainAxis};

/// A figure, drawn in vectors.
pub(super) struct Drawn {
    pub svg: String,
    /// What it shows, in one sentence.
    pub caption: String,
}

/// A figure that is not drawn yet.
pub(super) struct Undrawn {
    /// `figures/NAME_FIGURE`, without its ending.
    pub path: String,
    chart: Chart,
    caption: String,
    kind: FigureKind,
    procedure: String,
}

impl Undrawn {
    /// None where the record cannot draw it: a procedure that was stopped before it recorded anything has no figure.
    pub fn of(run: &Run<'_>, figure: &Figure) -> Option<Self> {
        let procedure = run.record.procedures.get(figure.procedure.0)?;
        let (chart, caption) = chart_of(run, procedure, figure)?;
        let path = format!("figures/{}", name_of(run, figure));
        Some(Self { path, chart, caption, kind: figure.kind, procedure: procedure.name.clone() })
    }

    pub fn png(&self) -> Result<Vec<u8>, OutputError> {
        draw::png(&self.chart).map_err(|reason| self.failed(reason))
    }

    pub fn in_vectors(self) -> Result<Drawn, OutputError> {
        let svg = draw::svg(&self.chart).map_err(|reason| self.failed(reason))?;
        Ok(Drawn { svg, caption: self.caption })
    }

    fn failed(&self, reason: String) -> OutputError {
        OutputError::Figure { figure: self.kind.name(), procedure: self.procedure.clone(), reason }
    }
}

/// What the figures of a report plot, in the report's order.
#[must_use]
pub fn data(run: &Run<'_>) -> Figures {
    let one = |figure: &Figure| {
        let procedure = run.record.procedures.get(figure.procedure.0)?;
        let (chart, _) = chart_of(run, procedure, figure)?;
        Some(data::of(name_of(run, figure), &procedure.name, &chart))
    };
    Figures { figures: run.plan.report.figures.iter().filter_map(one).collect(), ..Figures::default() }
}

/// `hit_displacement`, or `paused-moving_displacement`: no name of a procedure has a hyphen.
fn name_of(run: &Run<'_>, figure: &Figure) -> String {
    let name = |procedure: ProcedureId| run.record.procedures.get(procedure.0).map(|procedure| procedure.name.as_str());
    let names: Vec<&str> = figure.procedures().filter_map(name).collect();
    format!("{}_{}", names.join("-"), figure.kind.name())
}

/// The chart and its caption; None where the procedure does not draw this figure or has no steps.
fn chart_of(run: &Run<'_>, procedure: &ProcedureRecord, figure: &Figure) -> Option<(Chart, String)> {
    if !figure.beside.is_empty() {
        let drawn: Vec<_> = figure.procedures().filter_map(|procedure| run.record.procedures.get(procedure.0)).collect();
        return together::chart(figure.kind, &drawn);
    }
    let name = &procedure.name;
    Some(match (&procedure.history, figure.kind) {
        (History::Impact(history), _) if history.steps.is_empty() => return None,
        (History::Impact(history), FigureKind::Displacement) => (
            impact::displacement(history, &impact::limits_on(run, figure.procedure, "max_displacement")),
            format!("{name}: displacement of the structure and of the striker against virtual time."),
        ),
        (History::Impact(history), FigureKind::Velocity) => {
            (impact::velocity(history), format!("{name}: velocity of the structure and of the striker against virtual time."))
        }
        (History::Impact(history), FigureKind::StrikerVelocity) => (
            impact::striker_velocity(history),
            format!("{name}: velocity of the striker against virtual time; each fall is a blow."),
        ),
        (History::Impact(history), FigureKind::ContactForce) => (
            impact::contact_force(history, &impact::limits_on(run, figure.procedure, "max_contact_force")),
            format!("{name}: contact force, mean over each step, against virtual time."),
        ),
        (History::Impact(history), FigureKind::ForceDisplacement) => (
            impact::force_displacement(history),
            format!("{name}: restoring force against computed displacement; the area below is the absorbed energy."),
        ),
        (History::Impact(history), FigureKind::Energy) => (
            impact::energy(history, impact::taken_by_contact(run, figure.procedure)),
            format!("{name}: where the energy of the striker went; the total of the parts stays level where the balance closes."),
        ),
        (History::Impact(history), FigureKind::Tracking) => (
            impact::tracking(history),
            if history.steps.iter().all(|step| step.displacement == step.command) {
                format!("{name}: what the actuator missed of its commands: nothing.")
            } else {
                format!(
                    "{name}: what the actuator missed of its commands, and the tracking indicator over the largest command; an indicator that falls says that the lag feeds energy into the test."
                )
            },
        ),
        (History::Ramp(history), FigureKind::ForceDisplacement) if !history.steps.is_empty() => (
            identification::force_displacement(history),
            format!("{name}: measured restoring force against displacement, with the least-squares fit."),
        ),
        (History::Ramp(RampHistory { reached: Some(fit), holds, .. }), FigureKind::Relaxation) => (
            relaxation::lost(holds, fit),
            format!("{name}: force lost in the pauses, by the laws of relaxation, against the time held."),
        ),
        (History::Ramp(history), FigureKind::Relaxation) => (
            relaxation::left(history, history.relaxation.as_ref()?),
            format!("{name}: force still to relax, the measured less the fitted one after long, against the time held."),
        ),
        (History::Escalate(history), _) if history.blows.iter().all(|blow| blow.impact().steps.is_empty()) => return None,
        (History::Escalate(history), FigureKind::ForceDisplacement) => (
            blows::force_displacement(history),
            format!("{name}: restoring force against computed displacement, blow over blow; lighter lines are earlier blows."),
        ),
        (History::Escalate(history), FigureKind::Displacement) => (
            blows::displacement(history),
            match history.storeys().next() {
                None => format!("{name}: displacement against the virtual time of each blow; lighter lines are earlier blows."),
                Some(blow) => format!(
                    "{name}: displacement of floor {} against the virtual time of each blow; lighter lines are earlier blows.",
                    blow.struck + 1
                ),
            },
        ),
        (History::Escalate(history), FigureKind::Blows) => (
            blows::blows(history),
            match history.storeys().next() {
                None => format!(
                    "{name}: largest displacement of each blow, and where the specimen rested after it, against its energy."
                ),
                Some(blow) => format!(
                    "{name}: largest displacement of floor {} in each blow, and where it rested after it, against its energy.",
                    blow.struck + 1
                ),
            },
        ),
        (History::Escalate(history), FigureKind::Drift) => (
            blows::drift(history),
            format!("{name}: largest drift of each storey in each blow, and the drift that stayed after it, against its energy."),
        ),
        (History::Escalate(history), FigureKind::Hysteresis) => {
            let steps: Vec<&FloorStep> = history.storeys().flat_map(|blow| &blow.floors).collect();
            let caption = format!(
                "{name}: measured storey shear against drift, blow after blow; between two blows the straight way from the end of \
                 the one to the start of the next."
            );
            (shake::hysteresis(&steps), caption)
        }
        (History::Cycle(history), _) if history.cycles.is_empty() => return None,
        (History::Cycle(history), FigureKind::ForceDisplacement) => (
            cyclic::loops(history),
            format!("{name}: restoring force against displacement; the area of a loop is the energy of its cycle."),
        ),
        (History::Cycle(history), FigureKind::Backbone) => {
            (cyclic::backbone(history), format!("{name}: backbone, the force at the ends of the cycles, amplitude by amplitude."))
        }
        (History::Cycle(history), FigureKind::CycleEnergy) => {
            (cyclic::energy(history), format!("{name}: energy of each cycle, and of all cycles so far."))
        }
        (History::Cycle(history), FigureKind::StiffnessDegradation) => {
            (cyclic::stiffness(history), format!("{name}: secant stiffness of each cycle."))
        }
        (History::Sweep(history), FigureKind::DampingFit) if history.steps.iter().any(|step| step.steady) => (
            identification::damping_fit(history),
            format!(
                "{name}: damping force along the motion against velocity: steady readings of both ways, half the difference of out and back at one place with its standard error, and the line fitted to it."
            ),
        ),
        (History::FrameUnload(steps), FigureKind::Hysteresis) if !steps.is_empty() => (
            shake::hysteresis(steps),
            format!("{name}: measured storey shear against drift, from where the unloading began to where each storey rests."),
        ),
        (History::StoreyImpact(history), kind) => return storey::chart(run, name, history, figure, kind),
        (History::Shake(history), kind) => return shaken(run, name, history, figure, kind),
        _ => return None,
    })
}

/// What the tracking of a frame shows, whatever moved it.
fn followed(name: &str, chosen: &str) -> String {
    format!(
        "{name}: what the actuator of each floor missed of its commands{chosen}, and the tracking indicator of all of them over the \
         largest command; an indicator that falls says that the lag feeds energy into the test."
    )
}

/// The charts of a frame on moving ground; None before its first step.
fn shaken(run: &Run<'_>, name: &str, history: &ShakeHistory, figure: &Figure, kind: FigureKind) -> Option<(Chart, String)> {
    if history.steps.is_empty() {
        return None;
    }
    let limits = |result| shake::of_size(impact::limits_on(run, figure.procedure, result));
    let chosen = if shake::is_chosen(&history.steps) { "; not every one is drawn" } else { "" };
    Some(match kind {
        FigureKind::Modes => (
            shake::modes(history.modes.as_ref()?),
            format!("{name}: shapes of the natural modes and their periods, floor by floor from the ground up."),
        ),
        FigureKind::Ground => {
            (shake::ground(history), format!("{name}: acceleration of the ground, as it was applied, against virtual time."))
        }
        FigureKind::Displacement => (
            shake::displacement(&history.steps),
            format!("{name}: displacement of each floor relative to the ground against virtual time{chosen}."),
        ),
        FigureKind::Drift => (
            shake::drift(&history.steps, &limits("max_drift")),
            format!("{name}: drift of each storey against virtual time{chosen}."),
        ),
        FigureKind::Hysteresis => (
            shake::hysteresis(&history.steps),
            format!(
                "{name}: measured storey shear against drift; the area of a loop is the energy that the storey took{chosen}."
            ),
        ),
        FigureKind::BaseShear => (
            shake::base_shear(&history.steps, &limits("max_base_shear")),
            format!("{name}: base shear, the sum of the measured restoring forces, against virtual time."),
        ),
        FigureKind::Energy => {
            (shake::energy(history), format!("{name}: what the motion of the ground put in, and what became of it."))
        }
        FigureKind::Tracking => (shake::tracking(&history.steps), followed(name, chosen)),
        _ => return None,
    })
}
