//! A damping sweep as a report gives it: the line through its pairs. In: a history. Out: a block.

use crate::report::document::Block;
use crate::report::sections::results::line_fit::{Coefficient, fitted};
use psd_plan::record::DampingSweepHistory;
use psd_text::units::Dimension;

/// The block below its results.
pub(crate) fn report(history: &DampingSweepHistory, body: &mut Vec<Block>) {
    if let Some(fit) = history.fit {
        body.push(fitted(
            "F = c·v + F₀·sign v",
            &Coefficient("c", Dimension::DAMPING),
            &Coefficient("F₀", Dimension::FORCE),
            fit,
        ));
    }
}
