//! The page of a rehearsal: how near the whole run would come to each limit, and what each procedure would ask of the rig. In: a run
//! with a prediction. Out: blocks; nothing of any other run. It foretells, and says so.

use super::super::document::{Block, Column, Table, Text};
use super::super::prediction::{PredictedLimit, PredictedProcedure, PredictedZeros};
use super::super::{Run, number};
use super::words;
use crate::plan::Limits;
use crate::units::Dimension;

/// The prediction, where the run is a rehearsal that came to one.
pub(super) fn all(run: &Run<'_>, body: &mut Vec<Block>) {
    let Some(prediction) = &run.provenance.prediction else {
        return;
    };
    body.push(Block::section("Prediction of the whole run"));
    body.push(Block::paragraph(Text::from(format!(
        "{}. Nothing below was measured on the specimen.",
        capital(&prediction.model)
    ))));
    if let Some(stopped) = &prediction.stopped {
        body.push(Block::paragraph(Text::from(stopped.as_str())));
    }
    let columns = ["Limit", "Allowed", "Reached", "Margin"]
        .map(Column::short)
        .into();
    body.push(Block::Table(Table {
        columns,
        rows: prediction.limits.iter().map(limit).collect(),
    }));
    let columns = [
        "Procedure",
        "Kind",
        "Displacement",
        "Force",
        "Fastest",
        "Steps",
        "Rig time",
    ]
    .map(Column::short)
    .into();
    body.push(Block::Table(Table {
        columns,
        rows: prediction.procedures.iter().map(procedure).collect(),
    }));
    if let Some(told) = &prediction.zeros {
        body.push(Block::paragraph(Text::from(zeros(told))));
    }
    if !prediction.requirements.is_empty() {
        let rows = prediction
            .requirements
            .iter()
            .map(|each| vec![each.name.as_str().into(), each.verdict.into()]);
        let columns = vec![
            Column::words("Requirement, as predicted", 3),
            Column::short("Verdict"),
        ];
        body.push(Block::Table(Table {
            columns,
            rows: rows.collect(),
        }));
    }
}

fn limit(limit: &PredictedLimit) -> Vec<Text> {
    let known = Limits::NONE
        .named()
        .into_iter()
        .find(|(name, ..)| *name == limit.quantity);
    let dimension = known.map_or(Dimension::NUMBER, |(.., dimension)| dimension);
    let value = |value: f64| number::text(value, dimension);
    let allowed = match (limit.low, limit.high) {
        (Some(low), Some(high)) => format!("{} to {}", value(low), value(high)),
        (Some(low), None) => format!("≥ {}", value(low)),
        (None, Some(high)) => format!("≤ {}", value(high)),
        (None, None) => "any".to_owned(),
    };
    let nothing = || "–".to_owned();
    let reached = limit.reached.map_or_else(nothing, |[low, high]| {
        format!("{} to {}", value(low), value(high))
    });
    let name = if limit.quantity == "nrms_error" {
        "NRMS tracking error".to_owned()
    } else {
        words(&limit.quantity)
    };
    vec![
        name.into(),
        allowed.into(),
        reached.into(),
        limit.margin.map_or_else(nothing, value).into(),
    ]
}

fn procedure(procedure: &PredictedProcedure) -> Vec<Text> {
    let nothing = || "–".to_owned();
    let span = |ends: Option<[f64; 2]>, dimension| {
        ends.map_or_else(nothing, |[low, high]| {
            format!(
                "{} to {}",
                number::text(low, dimension),
                number::text(high, dimension)
            )
        })
    };
    let one = |value: Option<f64>, dimension| {
        value.map_or_else(nothing, |value| number::text(value, dimension))
    };
    vec![
        procedure.name.as_str().into(),
        procedure.kind.as_str().into(),
        span(procedure.displacement_m, Dimension::LENGTH).into(),
        span(procedure.force_n, Dimension::FORCE).into(),
        one(procedure.speed_m_per_s, Dimension::VELOCITY).into(),
        procedure.steps.to_string().into(),
        number::text(procedure.rig_time_s, Dimension::TIME).into(),
    ]
}

/// When they would be read, and the drift that leaves room for.
fn zeros(told: &PredictedZeros) -> String {
    let seconds = |value| number::text(value, Dimension::TIME);
    let force = |value| number::text(value, Dimension::FORCE);
    let again = match told.between_s {
        Some(between) => format!("and again {} later", seconds(between)),
        None => "and not again".to_owned(),
    };
    format!(
        "The zeros of the rig would be read over {} before the test {again}. A steady drift of up to {} a second keeps them within the \
         {} that are allowed.",
        seconds(told.over_s),
        force(told.steady_force_n_per_s),
        force(told.allowed_force_n),
    )
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
