//! The figures of a report, numbered from 1: the one that shows the main results on the second page, the others in an annex. In: drawn
//! figures with their captions. Out: blocks.

use super::{Source, headline};
use crate::plan::FigureKind;
use crate::report::document::{Block, Figure};
use crate::report::figures::Drawn;

/// The main figure.
pub(super) fn headline(source: &Source<'_>, body: &mut Vec<Block>) {
    if let Some(figure) = main(source).and_then(|index| source.figures.get(index)) {
        body.push(block(figure, 1));
    }
}

/// Every other figure.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let main = main(source);
    let others = source
        .figures
        .iter()
        .enumerate()
        .filter(|(index, _)| Some(*index) != main);
    body.extend(
        others
            .enumerate()
            .map(|(number, (_, figure))| block(figure, number + 2)),
    );
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

fn block(figure: &Drawn, number: usize) -> Block {
    Block::Figure(Figure {
        number,
        caption: figure.caption.as_str().into(),
        description: figure.description.as_str().into(),
        svg: figure.svg.clone(),
    })
}
