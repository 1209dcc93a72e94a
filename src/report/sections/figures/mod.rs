//! The figures of a report: the one that shows the main results on the second page, the others in an annex. In: drawn
//! figures with their captions. Out: blocks.

mod photos;

pub(super) use photos::photographs;

use super::{Source, headline};
use crate::report::document::{Block, Figure};
use crate::report::figures::Drawn;
use crate::report::wording::figures as wording;
use psd_plan::FigureKind;

/// The main figure.
pub(super) fn headline(source: &Source<'_>, body: &mut Vec<Block>) {
    if let Some(figure) = main(source).and_then(|index| source.figures.get(index)) {
        body.push(block(figure));
    }
}

/// Figures of a procedure in the annex, if the plan names none.
const MOST: usize = 2;

/// Figures that support others. They are printed if the plan names them.
const SUPPORTING: &[FigureKind] = &[
    FigureKind::Velocity,
    FigureKind::StrikerVelocity,
    FigureKind::ContactForce,
    FigureKind::Tracking,
    FigureKind::BaseShear,
    FigureKind::Ground,
    FigureKind::Modes,
];

/// The other figures: every one that the plan names, or a few of each procedure.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let main = main(source);
    let named = source.run.plan.report.figures_named;
    let mut printed: Vec<&Drawn> = Vec::new();
    let mut left = 0_usize;
    for (index, figure) in source.figures.iter().enumerate() {
        let own = |other: &&&Drawn| other.procedure == figure.procedure;
        if Some(index) == main {
        } else if named
            || !SUPPORTING.contains(&figure.kind) && printed.iter().filter(own).count() < MOST
        {
            printed.push(figure);
        } else {
            left += 1;
        }
    }
    body.extend(printed.into_iter().map(block));
    match left {
        0 => {}
        1 => body.push(Block::note(wording::ONE_MORE)),
        count => body.push(Block::note(wording::more(count))),
    }
}

/// The first figure of the procedure with the most results on the second page; of the last one if there are several. Modes and
/// ground motion are not results.
fn main(source: &Source<'_>) -> Option<usize> {
    let chosen = headline::chosen(source.run);
    let procedures = &source.run.record.procedures;
    let results = |figure: &Drawn| {
        chosen
            .iter()
            .filter(|chosen| {
                procedures
                    .get(chosen.reference.procedure.0)
                    .is_some_and(|procedure| procedure.name == figure.procedure)
            })
            .count()
    };
    let most = source.figures.iter().map(results).max()?;
    let last = source
        .figures
        .iter()
        .rfind(|figure| results(figure) == most)?;
    let is_own = |figure: &Drawn| figure.procedure == last.procedure;
    let response = source.figures.iter().position(|figure| {
        is_own(figure) && !matches!(figure.kind, FigureKind::Modes | FigureKind::Ground)
    });
    response.or_else(|| source.figures.iter().position(is_own))
}

fn block(figure: &Drawn) -> Block {
    Block::Figure(Figure {
        number: 0,
        caption: figure.caption.as_str().into(),
        description: figure.description.as_str().into(),
        svg: figure.svg.clone(),
    })
}
