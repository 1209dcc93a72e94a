//! Uncertainty budgets: what each input contributes to the uncertainty of a result. In: a run. Out: lines, the largest
//! contribution first. Knows neither certificate nor summary, which both print them.

use super::Run;
use crate::plan::formula::{Part, ProcedureId, ResultReference, ResultValue, Results};
use crate::plan::{Plan, ShakeDamping, Storey};
use crate::procedures;
use crate::record::{NamedResult, ProcedureRecord};
use crate::rig::named_axis;
use crate::uncertainty::{Contribution, Known, Source, known};
use crate::units::Dimension;

/// The budget of one result.
#[derive(Clone, Debug)]
pub(super) struct Budget<'a> {
    pub result: &'a NamedResult,
    /// Of a list, which of its numbers, from 0.
    pub entry: Option<usize>,
    pub value: f64,
    /// u, of all lines together.
    pub uncertainty: f64,
    /// The same with its degrees of freedom.
    pub known: Known,
    pub lines: Vec<Line>,
}

/// One input of a budget.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// As the plan calls it, where it does: `k0.stiffness`, `pendulum.mass`.
    pub input: String,
    pub from: From,
    pub value: Option<f64>,
    /// Standard, of the input.
    pub uncertainty: Option<f64>,
    /// Of the input.
    pub dimension: Dimension,
    /// Change of the result when the input moves by its standard uncertainty; of draws, their root mean square.
    pub contribution: f64,
    /// Change of the result over that of the input; none of draws.
    pub sensitivity: Option<f64>,
    /// Number of draws of what is sampled; all else is linearised.
    pub draws: Option<usize>,
    /// Of the contribution's size; infinite where it was not estimated from readings.
    pub degrees: f64,
    /// Whether the result follows the input smoothly.
    pub smooth: bool,
}

/// Where an input comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum From {
    /// An earlier procedure, or the procedure's own scatter.
    Result,
    /// The plan states it of the specimen or a striker.
    Plan,
    /// The plan states it of the rig.
    Rig,
    /// The program: its time step.
    Program,
}

impl Budget<'_> {
    /// Share of u² that a line has.
    pub fn share(&self, line: &Line) -> f64 {
        (line.contribution / self.uncertainty).powi(2)
    }
}

/// Budgets of a procedure's results, those that more enters than its own scatter.
pub(super) fn budgets<'a>(
    run: &Run<'a>,
    index: usize,
    procedure: &'a ProcedureRecord,
) -> Vec<Budget<'a>> {
    let own = |part: &Contribution| matches!(part.source, Source::Fit { procedure, .. } | Source::FitEntry { procedure, .. } if procedure == ProcedureId(index));
    let made = procedure
        .results
        .iter()
        .filter(|result| !result.contributions.iter().all(own));
    made.flat_map(|result| match &result.value {
        ResultValue::Number {
            value: Some(value),
            uncertainty: Some(uncertainty),
        } => {
            let lines = lines(run, result.contributions.iter());
            let known = how_well(run, &result.contributions, *uncertainty);
            let budget = Budget {
                result,
                entry: None,
                value: *value,
                uncertainty: *uncertainty,
                known,
                lines,
            };
            if *uncertainty > 0.0 {
                vec![budget]
            } else {
                Vec::new()
            }
        }
        ResultValue::Number { .. } => Vec::new(),
        ResultValue::List(values) => of_entries(run, result, values),
    })
    .collect()
}

/// A budget for each number of a list whose uncertainty is known.
fn of_entries<'a>(run: &Run<'_>, result: &'a NamedResult, values: &[f64]) -> Vec<Budget<'a>> {
    let known = values.iter().zip(result.entry_uncertainties()).enumerate();
    let budget = |(entry, (value, uncertainty)): (usize, (&f64, Option<f64>))| {
        let mine: Vec<Contribution> = result
            .contributions
            .iter()
            .filter(|part| part.entry == entry)
            .copied()
            .collect();
        let lines = lines(run, mine.iter());
        let uncertainty = uncertainty.filter(|uncertainty| *uncertainty > 0.0)?;
        Some(Budget {
            result,
            entry: Some(entry),
            value: *value,
            uncertainty,
            known: how_well(run, &mine, uncertainty),
            lines,
        })
    };
    known.filter_map(budget).collect()
}

/// u with its degrees of freedom.
fn how_well(run: &Run<'_>, parts: &[Contribution], uncertainty: f64) -> Known {
    known(parts, run.record).unwrap_or(Known::surely(uncertainty))
}

/// A line for each source; the draws of the readings are one, and so are the readings at a place of rest.
fn lines<'a>(run: &Run<'_>, contributions: impl Iterator<Item = &'a Contribution>) -> Vec<Line> {
    let drawn = |part: &&Contribution| {
        matches!(part.source, Source::Readings { .. } | Source::Drawn { .. })
    };
    let (draws, moved): (Vec<&Contribution>, Vec<&Contribution>) = contributions.partition(drawn);
    let (readings, moved): (Vec<&Contribution>, Vec<&Contribution>) = moved
        .into_iter()
        .partition(|part| matches!(part.source, Source::RestReading { .. }));
    let mut lines: Vec<Line> = moved.into_iter().map(|part| line(run, part)).collect();
    for (parts, sampled) in [(draws, true), (readings, false)] {
        if let Some(first) = parts.first() {
            let together = parts
                .iter()
                .map(|part| part.amount * part.amount)
                .sum::<f64>()
                .sqrt();
            let one = line(run, first);
            #[expect(clippy::cast_precision_loss, reason = "a few")]
            let degrees = if sampled {
                parts.len() as f64
            } else {
                one.degrees
            };
            let draws = sampled.then_some(parts.len());
            lines.push(Line {
                contribution: together,
                draws,
                degrees,
                sensitivity: None,
                ..one
            });
        }
    }
    lines.sort_by(|a, b| b.contribution.abs().total_cmp(&a.contribution.abs()));
    lines
}

fn line(run: &Run<'_>, part: &Contribution) -> Line {
    let plan = run.plan;
    let striker = |index: usize| plan.strikers.get(index);
    let (input, from, value, uncertainty, dimension) = match part.source {
        Source::Fit { procedure, result } => {
            let (value, uncertainty, dimension) =
                fitted(run, procedure, (result, None), part.source);
            let name = run
                .record
                .procedures
                .get(procedure.0)
                .map_or("", |procedure| procedure.name.as_str());
            (
                format!("{name}.{result}"),
                From::Result,
                value,
                uncertainty,
                dimension,
            )
        }
        Source::FitEntry {
            procedure,
            result,
            entry,
        } => {
            let (value, uncertainty, dimension) =
                fitted(run, procedure, (result, Some(entry)), part.source);
            let name = run
                .record
                .procedures
                .get(procedure.0)
                .map_or("", |procedure| procedure.name.as_str());
            (
                format!("{name}.{result}[{entry}]"),
                From::Result,
                value,
                uncertainty,
                dimension,
            )
        }
        Source::StrikerMass(index) => {
            let (name, value, u) = striker(index).map_or(("", 0.0, 0.0), |s| {
                (s.name.as_str(), s.mass, s.mass_uncertainty)
            });
            (
                format!("{name}.mass"),
                From::Plan,
                Some(value),
                Some(u),
                Dimension::MASS,
            )
        }
        Source::StrikerVelocity(index) => {
            let (name, value, u) = striker(index).map_or(("", 0.0, 0.0), |s| {
                (s.name.as_str(), s.velocity, s.velocity_uncertainty)
            });
            (
                format!("{name}.velocity"),
                From::Plan,
                Some(value),
                Some(u),
                Dimension::VELOCITY,
            )
        }
        Source::SpecimenMass(index) => {
            let (name, value, u) = plan.specimens.get(index).map_or(("", 0.0, 0.0), |s| {
                (s.name.as_str(), s.mass, s.mass_uncertainty)
            });
            (
                format!("{name}.mass"),
                From::Plan,
                Some(value),
                Some(u),
                Dimension::MASS,
            )
        }
        Source::StoreyMass { specimen, storey } => {
            let (name, value, u) =
                storey_of(run, specimen, storey, |it| (it.mass, it.mass_uncertainty));
            (
                format!("{name}.storeys[{storey}].mass"),
                From::Plan,
                value,
                u,
                Dimension::MASS,
            )
        }
        Source::StoreyStiffness { specimen, storey } => {
            let (name, value, u) = storey_of(run, specimen, storey, |it| {
                (it.stiffness, it.stiffness_uncertainty)
            });
            (
                format!("{name}.storeys[{storey}].stiffness"),
                From::Plan,
                value,
                u,
                Dimension::STIFFNESS,
            )
        }
        Source::DampingRatio { procedure, mode } => damping_ratio(run, procedure, mode),
        Source::GroundScale(index) => {
            let (name, u) = plan.grounds.get(index).map_or(("", 0.0), |ground| {
                (ground.name.as_str(), ground.scale_uncertainty)
            });
            (
                format!("factor on {name}"),
                From::Rig,
                Some(1.0),
                Some(u),
                Dimension::NUMBER,
            )
        }
        Source::ForceScale(axis) => {
            let u = plan.rig.calibration_of(axis).force_uncertainty;
            (
                of_axis("force calibration", plan, axis),
                From::Rig,
                Some(1.0),
                Some(u),
                Dimension::NUMBER,
            )
        }
        Source::DisplacementScale(axis) => {
            let u = plan.rig.calibration_of(axis).displacement_uncertainty;
            (
                of_axis("displacement calibration", plan, axis),
                From::Rig,
                Some(1.0),
                Some(u),
                Dimension::NUMBER,
            )
        }
        Source::ForceZero(axis) => {
            let u = plan.rig.calibration_of(axis).zero();
            (
                of_axis("zero of the load cell", plan, axis),
                From::Rig,
                Some(0.0),
                Some(u),
                Dimension::FORCE,
            )
        }
        Source::MassMatrix(index) => of_matrix(plan, index, "mass_matrix", 0),
        Source::StiffnessMatrix(index) => of_matrix(plan, index, "stiffness_matrix", 1),
        Source::RestLoad { .. } => (
            "load that was left".to_owned(),
            From::Program,
            None,
            None,
            Dimension::FORCE,
        ),
        Source::Readings { .. } | Source::RestReading { .. } => (
            "noise and resolution of the readings".to_owned(),
            From::Rig,
            None,
            None,
            Dimension::FORCE,
        ),
        Source::Drawn { .. } => {
            let name =
                "noise and resolution of the readings, and the inputs of each floor, mode and axis";
            (name.to_owned(), From::Rig, None, None, Dimension::FORCE)
        }
        Source::Rounding { procedure, .. } | Source::CommonRounding { procedure } => {
            let name = run
                .record
                .procedures
                .get(procedure.0)
                .map_or("", |procedure| procedure.name.as_str());
            (
                format!("resolution of the readings of {name}"),
                From::Rig,
                None,
                None,
                Dimension::FORCE,
            )
        }
        Source::StrokeStiffness { procedure } => {
            let found = run.record.procedures.get(procedure.0);
            let name = found.map_or("", |procedure| procedure.name.as_str());
            let together = found.and_then(|procedure| procedures::strokes(&procedure.history));
            let (value, u) = (
                together.map(|found| found.stiffness),
                together.and_then(|found| found.error),
            );
            (
                format!("stiffness along the strokes of {name}"),
                From::Result,
                value,
                u,
                Dimension::STIFFNESS,
            )
        }
        Source::LoopSampling { .. } => (
            "points of the loops".to_owned(),
            From::Program,
            None,
            None,
            Dimension::ENERGY,
        ),
        Source::TimeStep { .. } => (
            "time step: integrated again in its half and quarter".to_owned(),
            From::Program,
            None,
            None,
            Dimension::TIME,
        ),
    };
    let sensitivity = uncertainty.filter(|u| *u > 0.0).map(|u| part.amount / u);
    let degrees = run.record.degrees(part.source);
    let contribution = part.amount;
    Line {
        input,
        from,
        value,
        uncertainty,
        dimension,
        contribution,
        sensitivity,
        draws: None,
        degrees,
        smooth: part.smooth,
    }
}

/// What a channel of the axis at this place is called; of a rig of one axis nothing is said of it.
fn of_axis(what: &str, plan: &Plan, axis: usize) -> String {
    let axes = plan.rig.axes().unwrap_or_else(|| plan.degrees_of_freedom());
    named_axis(axis, axes).map_or_else(|| what.to_owned(), |axis| format!("{what} of axis {axis}"))
}

/// The factor on a matrix of a frame, with its uncertainty; 0 is that of the masses.
fn of_matrix(
    plan: &Plan,
    specimen: usize,
    field: &str,
    which: usize,
) -> (String, From, Option<f64>, Option<f64>, Dimension) {
    let specimen = plan.specimens.get(specimen);
    let name = specimen.map_or("", |specimen| specimen.name.as_str());
    let u = specimen
        .and_then(|specimen| specimen.frame.as_ref())
        .map(|frame| frame.matrix_uncertainty[which]);
    (
        format!("factor on {name}.{field}"),
        From::Rig,
        Some(1.0),
        u,
        Dimension::NUMBER,
    )
}

/// The specimen's name, and a number of one of its storeys with its uncertainty.
fn storey_of<'a>(
    run: &Run<'a>,
    specimen: usize,
    storey: usize,
    read: fn(&Storey) -> (f64, f64),
) -> (&'a str, Option<f64>, Option<f64>) {
    let Some(specimen) = run.plan.specimens.get(specimen) else {
        return ("", None, None);
    };
    let found = specimen
        .frame
        .as_ref()
        .and_then(|frame| frame.storeys.get(storey))
        .map(read);
    (
        &specimen.name,
        found.map(|found| found.0),
        found.map(|found| found.1),
    )
}

fn damping_ratio(
    run: &Run<'_>,
    procedure: ProcedureId,
    mode: usize,
) -> (String, From, Option<f64>, Option<f64>, Dimension) {
    let damping = run.plan.procedures.get(procedure.0).and_then(|planned| {
        let (damping, uncertainty) = procedures::facts_of(&planned.kind).frame_damping?;
        Some((&planned.name, damping, uncertainty))
    });
    let Some((name, damping, uncertainty)) = damping else {
        return (
            "damping_ratio".to_owned(),
            From::Plan,
            None,
            None,
            Dimension::NUMBER,
        );
    };
    let (label, ratio) = match damping {
        ShakeDamping::Rayleigh(ratio) => (format!("{name}.damping_ratio"), Some(ratio)),
        ShakeDamping::Modal(ratios) => (format!("{name}.damping_ratio[{mode}]"), ratios.get(mode)),
    };
    let value = ratio
        .and_then(|ratio| ratio.evaluate(run.record, None).ok())
        .map(|ratio| ratio.value);
    (
        label,
        From::Plan,
        value,
        Some(uncertainty),
        Dimension::NUMBER,
    )
}

/// Value and dimension of a fitted result or of an entry of one, and how much of its uncertainty is of this source.
fn fitted(
    run: &Run<'_>,
    procedure: ProcedureId,
    (name, entry): (&'static str, Option<usize>),
    source: Source,
) -> (Option<f64>, Option<f64>, Dimension) {
    let reference = ResultReference {
        procedure,
        name,
        part: Part::Value,
    };
    let value = match (run.record.result(reference), entry) {
        (Some(ResultValue::Number { value, .. }), _) => value,
        (Some(ResultValue::List(values)), Some(entry)) => values.get(entry).copied(),
        _ => None,
    };
    let parts = run.record.contributions(reference);
    let mut mine = parts.iter().filter(|part| part.entry == entry.unwrap_or(0));
    let uncertainty = mine
        .find(|part| part.source == source)
        .map(|part| part.amount);
    let found = run
        .record
        .procedures
        .get(procedure.0)
        .and_then(|procedure| procedure.result(name));
    (
        value,
        uncertainty,
        found.map_or(Dimension::NUMBER, |found| found.dimension),
    )
}
