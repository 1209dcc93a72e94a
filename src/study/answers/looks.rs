//! Outcomes counted, and the counts at every look of the stopping rule. In: rows in the order of their runs. Out: counts for each
//! requirement. A run without a result is a count of its own.

use crate::study::counts::Counts;
use crate::study::data_set::{Metadata, Stopping, StudyKind, StudyRow};
use crate::study::stopping::Looks;
use crate::study::stopping::rare::RareRuns;
use psd_physics::study::Confidence;
use psd_physics::study::probability::stopping::Look;
use psd_plan::study::Runs;

/// Counts so far.
pub struct CountsWithLooks {
    rule: Looks,
    pub evaluated: Vec<CountsAtLook>,
}

/// Counts at a look.
pub struct CountsAtLook {
    pub look: Look,
    pub counts: Counts,
}

impl CountsWithLooks {
    pub fn new(metadata: &Metadata, confidence: Confidence) -> Self {
        let at_most = metadata.at_most;
        let runs = match metadata.kind {
            StudyKind::Study(Stopping::Fixed) | StudyKind::Fragility(_) => Runs::Fixed(at_most),
            StudyKind::Study(Stopping::Rare(rare)) => Runs::Rare(rare),
            StudyKind::Study(Stopping::Decided) => Runs::Decided {
                confidence,
                at_most,
            },
            StudyKind::Study(Stopping::HalfWidth(half_width)) => Runs::HalfWidth {
                half_width,
                confidence,
                at_most,
            },
        };
        Self {
            rule: Looks::of(runs, metadata),
            evaluated: Vec::new(),
        }
    }

    pub fn add(&mut self, row: &StudyRow) {
        let look = self.rule.planned();
        self.rule.add(row);
        let counts = self.counts();
        if let Some(look) = look.filter(|look| look.runs == counts.runs) {
            let counts = counts.clone();
            self.evaluated.push(CountsAtLook { look, counts });
        }
    }

    pub const fn counts(&self) -> &Counts {
        &self.rule.counts
    }

    /// The confidence of the interval of a probability. A study that chose its own end has that of its last look: then the interval holds
    /// with the confidence of the study, although it was looked at before.
    pub fn confidence(&self, fixed: Confidence) -> Confidence {
        let last = self.evaluated.last();
        last.map_or(fixed, |last| last.look.confidence)
    }

    /// The subset simulation of the study, if it is one.
    pub const fn rare(&self) -> Option<&RareRuns> {
        self.rule.rare()
    }

    /// Whether the study has all the runs that it asks for.
    pub fn are_complete(&self) -> bool {
        self.rule.are_over()
    }
}
