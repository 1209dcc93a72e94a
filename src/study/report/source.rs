//! The data of a study's report: metadata, answers, drawn figures. In: nothing. Out: types. It writes no text.

use super::figures::FigureKind;
use crate::report::document::{Block, Figure};
use crate::study::answers::Answers;
use crate::study::data_set::Metadata;

/// A figure in vectors.
pub struct DrawnFigure {
    pub kind: FigureKind,
    pub result: Option<usize>,
    pub caption: String,
    pub description: String,
    pub svg: String,
}

/// The data that the sections read.
pub struct Source<'a> {
    pub metadata: &'a Metadata,
    pub answers: &'a Answers,
    pub figures: &'a [DrawnFigure],
    /// First digits of the SHA-256 of the metadata.
    pub id: &'a str,
}

impl Source<'_> {
    /// The figures of this kind, as blocks.
    pub fn figures_of(&self, wanted: impl Fn(&DrawnFigure) -> bool) -> impl Iterator<Item = Block> {
        let chosen: Vec<Block> = self
            .figures
            .iter()
            .enumerate()
            .filter(|(_, figure)| wanted(figure))
            .map(|(index, figure)| {
                Block::Figure(Figure {
                    number: index + 1,
                    caption: figure.caption.clone().into(),
                    description: figure.description.clone().into(),
                    svg: figure.svg.clone(),
                })
            })
            .collect();
        chosen.into_iter()
    }
}
