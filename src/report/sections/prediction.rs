//! The prediction of a check run: the margin of the whole run to each limit, and the demand of each procedure on the rig. In: a
//! run with a prediction. Out: blocks; none for any other run.

use super::{Source, capitalised, with_spaces};
use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use crate::report::summary::{PredictedLimit, PredictedProcedure, PredictedZeros};
use crate::report::wording::{common, prediction as wording};
use psd_plan::Limits;
use psd_plan::schema::limits;
use psd_text::units::Dimension;

/// Returns nothing if the run has no prediction.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let Some(prediction) = &source.run.provenance.prediction else {
        return;
    };
    body.push(Block::section(wording::TITLE));
    body.push(Block::paragraph(wording::model(capitalised(
        &prediction.model,
    ))));
    if source.run.plan.specimens_at_scale().is_some() {
        body.push(Block::paragraph(wording::OF_THE_RIG));
    }
    if let Some(stopped) = &prediction.stopped {
        body.push(Block::paragraph(stopped.as_str()));
    }
    body.push(Block::Table(Table {
        columns: wording::LIMIT_COLUMNS.map(Column::short).into(),
        rows: prediction.limits.iter().map(limit).collect(),
    }));
    body.push(Block::Table(Table {
        columns: wording::PROCEDURE_COLUMNS.map(Column::short).into(),
        rows: prediction.procedures.iter().map(procedure).collect(),
    }));
    if let Some(found) = &prediction.zeros {
        body.push(Block::paragraph(zeros(found)));
    }
    if !prediction.requirements.is_empty() {
        let rows = prediction
            .requirements
            .iter()
            .map(|each| vec![each.name.as_str().into(), each.verdict.into()]);
        let [requirement, verdict] = wording::REQUIREMENT_COLUMNS;
        body.push(Block::Table(Table {
            columns: vec![Column::words(requirement, 3), Column::short(verdict)],
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
    let value = |value: f64| number::of_result(&limit.quantity, value, None, dimension);
    let allowed = match (limit.low, limit.high) {
        (Some(low), Some(high)) => wording::range(value(low), value(high)),
        (Some(low), None) => format!("≥ {}", value(low)),
        (None, Some(high)) => format!("≤ {}", value(high)),
        (None, None) => wording::ANY.to_owned(),
    };
    let reached = limit.reached.map_or_else(no_value, |[low, high]| {
        wording::range(value(low), value(high))
    });
    let name = if limit.quantity == limits::NRMS_ERROR.name {
        common::NRMS_TRACKING_ERROR.to_owned()
    } else {
        with_spaces(&limit.quantity)
    };
    vec![
        name.into(),
        allowed.into(),
        reached.into(),
        limit.margin.map_or_else(no_value, value).into(),
    ]
}

fn procedure(procedure: &PredictedProcedure) -> Vec<Text> {
    let range = |ends: Option<[f64; 2]>, dimension| {
        ends.map_or_else(no_value, |ends| {
            let [low, high] = ends.map(|end| number::text(end, dimension));
            wording::range(&low, &high)
        })
    };
    let speed = procedure
        .speed_m_per_s
        .map_or_else(no_value, |speed| number::text(speed, Dimension::VELOCITY));
    vec![
        procedure.name.as_str().into(),
        procedure.kind.as_str().into(),
        range(procedure.displacement_m, Dimension::LENGTH).into(),
        range(procedure.force_n, Dimension::FORCE).into(),
        speed.into(),
        procedure.steps.to_string().into(),
        number::text(procedure.rig_time_s, Dimension::TIME).into(),
    ]
}

/// The cell of a quantity without a value.
fn no_value() -> String {
    "–".to_owned()
}

/// The times of the zero readings, and the zero drift that is allowed between them.
fn zeros(zeros: &PredictedZeros) -> String {
    let seconds = |value| number::text(value, Dimension::TIME);
    let force = |value| number::text(value, Dimension::FORCE);
    let again = zeros.between_s.map_or_else(
        || wording::AND_NOT_AGAIN.to_owned(),
        |between| wording::and_again(seconds(between)),
    );
    wording::zeros(
        seconds(zeros.over_s),
        again,
        force(zeros.steady_force_n_per_s),
        force(zeros.allowed_force_n),
    )
}
