//! A multilinear curve, segment by segment, with the plan text of a specimen with this curve. In: the fit. Out: blocks.

use crate::report::document::{Block, Column, Table, Text};
use crate::report::number;
use psd_plan::record::MultilinearFit;
use psd_text::units::{Dimension, display};

/// `reach` \[m\] is the position of the last reading along the curve.
pub(crate) fn table(fit: &MultilinearFit, reach: f64, body: &mut Vec<Block>) {
    let with = |(value, error): (f64, f64), dimension| {
        Text::from(number::with_uncertainty(value, Some(error), dimension))
    };
    let row = |(index, stiffness): (usize, &(f64, f64))| {
        let end = fit.breakpoints.get(index).zip(fit.forces.get(index));
        vec![
            Text::from((index + 1).to_string()),
            with(*stiffness, Dimension::STIFFNESS),
            end.map_or_else(
                || number::text(reach, Dimension::LENGTH).into(),
                |(displacement, _)| with(*displacement, Dimension::LENGTH),
            ),
            end.map_or_else(
                || number::text(fit.force(reach), Dimension::FORCE).into(),
                |(_, force)| with(*force, Dimension::FORCE),
            ),
        ]
    };
    let columns = vec![
        Column::words("Segment", 1),
        Column::numbers("Stiffness (u)"),
        Column::numbers("Ends at (u)"),
        Column::numbers("Force there (u)"),
    ];
    body.push(Block::Table(Table {
        columns,
        rows: fit.stiffnesses.iter().enumerate().map(row).collect(),
    }));
    body.push(Block::note(format!(
        "Straight segments that meet at breakpoints, both fitted by least squares; in parentheses the standard error \
         of the linearised model; R² = {:.6}.{}",
        fit.r_squared,
        criterion(fit)
    )));
    if let Some(corners) = fit
        .backbone_points(reach)
        .filter(|_| !fit.breakpoints.is_empty())
    {
        let list = |index: usize, factor: f64| {
            corners
                .iter()
                .map(|corner| display::significant(corner[index] * factor, 7))
                .collect::<Vec<String>>()
                .join(", ")
        };
        body.push(Block::note(
            Text::from("A model of this curve, from zero force: ").code(format!(
                "multilinear(displacements: [{}] mm, forces: [{}] N)",
                list(0, 1e3),
                list(1, 1.0)
            )),
        ));
    }
}

fn criterion(fit: &MultilinearFit) -> String {
    if fit.criterion.is_empty() {
        return " Their number is stated in the plan.".to_owned();
    }
    let each: Vec<String> = fit
        .criterion
        .iter()
        .enumerate()
        .map(|(count, more)| format!("{count}: {more:.1}"))
        .collect();
    format!(
        " Their number is that of the lowest BIC = N ln(SSE/N) + (2n + 2) ln N; for n breakpoints, BIC exceeds the \
         lowest value by {}. The uncertainty of this choice is not included.",
        each.join(", ")
    )
}
