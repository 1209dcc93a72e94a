//! One line of an uncertainty budget: its input with value, uncertainty and origin. In: a run and a contribution. Out: a line.

use crate::procedures;
use crate::report::run::Run;
use crate::report::wording::budget as wording;
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference, ResultValue, Results};
use psd_plan::named_axis;
use psd_plan::record::ProcedureRecord;
use psd_plan::schema::frames::{DAMPING_RATIO, MASS_MATRIX, STIFFNESS_MATRIX};
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{BelowRange, Element, Frame, Plan, ShakeDamping, Specimen, Storey, Striker};
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// One input of a budget.
#[derive(Clone, Debug)]
pub(in crate::report) struct BudgetLine {
    /// The name in the plan, if it has one: `k0.stiffness`, `pendulum.mass`.
    pub input: String,
    pub origin: Origin,
    pub value: Option<f64>,
    /// Standard uncertainty of the input.
    pub uncertainty: Option<f64>,
    /// Dimension of the input.
    pub dimension: Dimension,
    /// Change of the result for a change of the input by its standard uncertainty; for Monte Carlo trials, their root mean
    /// square.
    pub contribution: f64,
    /// Change of the result per unit of the input; None for Monte Carlo trials.
    pub sensitivity: Option<f64>,
    /// Number of Monte Carlo trials; None for first-order propagation.
    pub draws: Option<usize>,
    /// Degrees of freedom of the contribution; infinite if it was not estimated from readings.
    pub degrees: f64,
    /// Whether the response of the result to this input is smooth.
    pub smooth: bool,
}

/// The origin of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Origin {
    /// An earlier procedure, or the scatter of this one.
    Result,
    /// A specimen or a striker of the plan.
    Plan,
    /// The rig of the plan.
    Rig,
    /// The program, such as its time step.
    Program,
}

/// The input of a line.
struct Input {
    name: String,
    origin: Origin,
    value: Option<f64>,
    uncertainty: Option<f64>,
    dimension: Dimension,
}

impl BudgetLine {
    /// The line of one contribution.
    pub(super) fn of(run: &Run<'_>, part: &Contribution) -> Self {
        let input = Input::of(run, part.source);
        let uncertainty = input.uncertainty;
        Self {
            sensitivity: uncertainty.filter(|u| *u > 0.0).map(|u| part.amount / u),
            input: input.name,
            origin: input.origin,
            value: input.value,
            uncertainty,
            dimension: input.dimension,
            contribution: part.amount,
            draws: None,
            degrees: run.record.degrees(part.source),
            smooth: part.smooth,
        }
    }
}

impl Input {
    fn of(run: &Run<'_>, source: Source) -> Self {
        let plan = run.plan;
        match source {
            Source::Fit { procedure, result } => Self::fitted(run, procedure, result, None, source),
            Source::FitEntry {
                procedure,
                result,
                entry,
            } => Self::fitted(run, procedure, result, Some(entry), source),
            Source::StrikerMass(index) => {
                let striker = plan.strikers.get(index);
                let read = |striker: &Striker| (striker.mass, striker.mass_uncertainty);
                let name = striker.map_or("", |striker| striker.name.as_str());
                Self::stated(format!("{name}.mass"), striker.map(read), Dimension::MASS)
            }
            Source::StrikerVelocity(index) => {
                let striker = plan.strikers.get(index);
                let read = |striker: &Striker| (striker.velocity, striker.velocity_uncertainty);
                let name = striker.map_or("", |striker| striker.name.as_str());
                let name = format!("{name}.velocity");
                Self::stated(name, striker.map(read), Dimension::VELOCITY)
            }
            Source::SpecimenMass(index) => {
                let specimen = plan.specimens.get(index);
                let read = |specimen: &Specimen| (specimen.mass, specimen.mass_uncertainty);
                let name = format!("{}.mass", specimen_name(plan, index));
                Self::stated(name, specimen.map(read), Dimension::MASS)
            }
            Source::StoreyMass { specimen, storey } => {
                let read = |storey: &Storey| (storey.mass, storey.mass_uncertainty);
                let name = format!("{}.storeys[{storey}].mass", specimen_name(plan, specimen));
                let found = storey_of(plan, specimen, storey).map(read);
                Self::of_storey(name, found, Dimension::MASS)
            }
            Source::StoreyStiffness { specimen, storey } => {
                let read = |storey: &Storey| (storey.stiffness, storey.stiffness_uncertainty);
                let specimen_name = specimen_name(plan, specimen);
                let name = format!("{specimen_name}.storeys[{storey}].stiffness");
                let found = storey_of(plan, specimen, storey).map(read);
                Self::of_storey(name, found, Dimension::STIFFNESS)
            }
            Source::ElementStiffness { specimen, element } => {
                let read = |element: &Element| (element.stiffness, element.stiffness_uncertainty);
                let specimen_name = specimen_name(plan, specimen);
                let name = format!("{specimen_name}.elements[{element}].stiffness");
                let frame = frame_of(plan, specimen);
                let found = frame.and_then(|frame| frame.elements.get(element));
                Self::of_storey(name, found.map(read), Dimension::STIFFNESS)
            }
            Source::DampingRatio { procedure, mode } => Self::damping_ratio(run, procedure, mode),
            Source::GroundScale(index) => {
                let ground = plan.grounds.get(index);
                let name = ground.map_or("", |ground| ground.name.as_str());
                let u = ground.map_or(0.0, |ground| ground.scale_uncertainty);
                Self::factor(wording::factor_on(name), Some(u))
            }
            Source::ForceScale(axis) => {
                let u = plan.rig.calibration_of(axis).force_uncertainty;
                Self::factor(of_axis(wording::FORCE_CALIBRATION, plan, axis), Some(u))
            }
            Source::DisplacementScale(axis) => {
                let u = plan.rig.calibration_of(axis).displacement_uncertainty;
                let name = of_axis(wording::DISPLACEMENT_CALIBRATION, plan, axis);
                Self::factor(name, Some(u))
            }
            Source::ForceZero(axis) => Self {
                value: Some(0.0),
                dimension: Dimension::FORCE,
                ..Self::factor(
                    of_axis(wording::LOAD_CELL_ZERO, plan, axis),
                    Some(plan.rig.calibration_of(axis).zero()),
                )
            },
            Source::ForceBelowRange(axis) => Self::below_range(
                &of_axis(wording::FORCE_CALIBRATION, plan, axis),
                plan.rig.calibration_of(axis).force_below(),
                Dimension::FORCE,
            ),
            Source::DisplacementBelowRange(axis) => Self::below_range(
                &of_axis(wording::DISPLACEMENT_CALIBRATION, plan, axis),
                plan.rig.calibration_of(axis).displacement_below(),
                Dimension::LENGTH,
            ),
            Source::MassMatrix(index) => Self::matrix(plan, index, MASS_MATRIX.name, 0),
            Source::StiffnessMatrix(index) => Self::matrix(plan, index, STIFFNESS_MATRIX.name, 1),
            Source::RestLoad { .. } => {
                Self::unnamed(wording::REST_LOAD, Origin::Program, Dimension::FORCE)
            }
            Source::Readings { .. } | Source::RestReading { .. } => {
                Self::unnamed(wording::READINGS, Origin::Rig, Dimension::FORCE)
            }
            Source::Drawn { .. } => {
                Self::unnamed(wording::READINGS_AND_INPUTS, Origin::Rig, Dimension::FORCE)
            }
            Source::Rounding { procedure, .. } | Source::CommonRounding { procedure } => {
                let name = wording::resolution_of(procedure_name(run, procedure));
                Self::unnamed(name, Origin::Rig, Dimension::FORCE)
            }
            Source::StrokeStiffness { procedure } => {
                let strokes = procedure_of(run, procedure)
                    .and_then(|procedure| procedures::recorded(&procedure.history).strokes);
                Self {
                    name: wording::stroke_stiffness_of(procedure_name(run, procedure)),
                    origin: Origin::Result,
                    value: strokes.map(|found| found.stiffness),
                    uncertainty: strokes.and_then(|found| found.error),
                    dimension: Dimension::STIFFNESS,
                }
            }
            Source::LoopSampling { .. } => {
                Self::unnamed(wording::LOOP_POINTS, Origin::Program, Dimension::ENERGY)
            }
            Source::WholeSteps { .. } => {
                Self::unnamed(wording::WHOLE_STEPS, Origin::Program, Dimension::TIME)
            }
            Source::TimeStep(_) => {
                Self::unnamed(wording::TIME_STEP, Origin::Program, Dimension::TIME)
            }
        }
    }

    /// A value of a striker or a specimen with its uncertainty.
    fn stated(name: String, stated: Option<(f64, f64)>, dimension: Dimension) -> Self {
        Self::of_storey(name, Some(stated.unwrap_or_default()), dimension)
    }

    /// A value of a storey with its uncertainty, if the storey exists.
    fn of_storey(name: String, stated: Option<(f64, f64)>, dimension: Dimension) -> Self {
        Self {
            name,
            origin: Origin::Plan,
            value: stated.map(|(value, _)| value),
            uncertainty: stated.map(|(_, uncertainty)| uncertainty),
            dimension,
        }
    }

    /// A factor of 1 with its relative standard uncertainty.
    fn factor(name: String, uncertainty: Option<f64>) -> Self {
        Self {
            name,
            origin: Origin::Rig,
            value: Some(1.0),
            uncertainty,
            dimension: Dimension::NUMBER,
        }
    }

    /// The scale factor of a matrix of a frame; index 0 is the mass matrix, index 1 the stiffness matrix.
    fn matrix(plan: &Plan, specimen: usize, field: &str, index: usize) -> Self {
        let frame = plan.specimens.get(specimen);
        let frame = frame.and_then(|specimen| specimen.frame.as_ref());
        let name = format!("{}.{field}", specimen_name(plan, specimen));
        let uncertainty = frame.map(|frame| frame.matrix_uncertainty[index]);
        Self::factor(wording::factor_on(name), uncertainty)
    }

    /// The readings below the lower end of a calibrated range, with the uncertainty at that end.
    fn below_range(calibration: &str, below: BelowRange, dimension: Dimension) -> Self {
        let end = stated(below.end, dimension);
        Self {
            uncertainty: Some(below.of_end()),
            ..Self::unnamed(wording::below(calibration, end), Origin::Rig, dimension)
        }
    }

    /// A source without a value and an uncertainty of an input.
    fn unnamed(name: impl Into<String>, origin: Origin, dimension: Dimension) -> Self {
        Self {
            name: name.into(),
            origin,
            value: None,
            uncertainty: None,
            dimension,
        }
    }

    fn damping_ratio(run: &Run<'_>, procedure: ProcedureId, mode: usize) -> Self {
        let damping = run.plan.procedures.get(procedure.0).and_then(|planned| {
            let (damping, uncertainty) = procedures::facts_of(&planned.kind).frame_damping?;
            Some((&planned.name, damping, uncertainty))
        });
        let Some((procedure, damping, uncertainty)) = damping else {
            return Self::unnamed(DAMPING_RATIO.name, Origin::Plan, Dimension::NUMBER);
        };
        let (name, ratio) = match damping {
            ShakeDamping::Rayleigh(ratio) => (format!("{procedure}.damping_ratio"), Some(ratio)),
            ShakeDamping::Modal(ratios) => (
                format!("{procedure}.damping_ratio[{mode}]"),
                ratios.get(mode),
            ),
        };
        let ratio = ratio.and_then(|ratio| ratio.evaluate(run.record, None).ok());
        Self {
            name,
            origin: Origin::Plan,
            value: ratio.map(|ratio| ratio.value),
            uncertainty: Some(uncertainty),
            dimension: Dimension::NUMBER,
        }
    }

    /// A fitted result, or an entry of one, with the part of its uncertainty that comes from this source.
    fn fitted(
        run: &Run<'_>,
        procedure: ProcedureId,
        result: &'static str,
        entry: Option<usize>,
        source: Source,
    ) -> Self {
        let reference = ResultReference {
            procedure,
            name: result,
            part: ResultPart::Value,
        };
        let value = match (run.record.result(reference), entry) {
            (Some(ResultValue::Number { value, .. }), _) => value,
            (Some(ResultValue::List(values)), Some(entry)) => values.get(entry).copied(),
            _ => None,
        };
        let contributions = run.record.contributions(reference);
        let uncertainty = contributions
            .iter()
            .find(|part| part.entry == entry.unwrap_or(0) && part.source == source)
            .map(|part| part.amount);
        let found = procedure_of(run, procedure).and_then(|procedure| procedure.result(result));
        let index = entry.map_or_else(String::new, |entry| format!("[{entry}]"));
        Self {
            name: format!("{}.{result}{index}", procedure_name(run, procedure)),
            origin: Origin::Result,
            value,
            uncertainty,
            dimension: found.map_or(Dimension::NUMBER, |found| found.dimension),
        }
    }
}

/// The channel with the number of its axis; without it on a rig of one axis.
fn of_axis(channel: &str, plan: &Plan, axis: usize) -> String {
    let axes = plan.rig.axes().unwrap_or_else(|| plan.degrees_of_freedom());
    named_axis(axis, axes).map_or_else(
        || channel.to_owned(),
        |axis| wording::of_axis(channel, axis),
    )
}

fn procedure_of<'a>(run: &Run<'a>, procedure: ProcedureId) -> Option<&'a ProcedureRecord> {
    run.record.procedures.get(procedure.0)
}

fn procedure_name<'a>(run: &Run<'a>, procedure: ProcedureId) -> &'a str {
    procedure_of(run, procedure).map_or("", |procedure| procedure.name.as_str())
}

fn specimen_name(plan: &Plan, specimen: usize) -> &str {
    plan.specimens
        .get(specimen)
        .map_or("", |specimen| specimen.name.as_str())
}

fn storey_of(plan: &Plan, specimen: usize, storey: usize) -> Option<&Storey> {
    frame_of(plan, specimen)?.storeys.get(storey)
}

fn frame_of(plan: &Plan, specimen: usize) -> Option<&Frame> {
    plan.specimens.get(specimen)?.frame.as_ref()
}
