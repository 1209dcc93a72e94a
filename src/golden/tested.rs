//! The outcomes of the tested plans, as data: the console, TAP, JUnit and JSON are functions of it.

use super::finding::Finding;

/// One plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Tested {
    /// For example `plans/beam`.
    pub name: String,
    /// The folder of its accepted results.
    pub folder: String,
    pub outcome: Outcome,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// As accepted. The verdict; None for a plan that fails its check, as intended.
    Same {
        verdict: Option<&'static str>,
    },
    Differs(Vec<Finding>),
    /// There are no accepted results for a comparison.
    NotAccepted,
    /// It could not be run or compared.
    Failed(String),
    /// An earlier plan failed, and the first failure ends the test.
    NotRun,
    Accepted(Accepted),
}

/// The effect of accepting results.
#[derive(Clone, Debug, PartialEq)]
pub enum Accepted {
    New,
    /// The differences from before; empty if the same results were written again.
    Changed(Vec<Finding>),
    Unchanged,
    Refused(String),
}

/// All outcomes, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    pub tested: Vec<Tested>,
    /// Folders of accepted results that belong to no plan.
    pub unused: Vec<String>,
}

impl Outcome {
    #[must_use]
    pub const fn is_good(&self) -> bool {
        matches!(
            self,
            Self::Same { .. }
                | Self::Accepted(Accepted::New | Accepted::Changed(_) | Accepted::Unchanged)
        )
    }

    /// The name in the JSON report.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Same { .. } => "same",
            Self::Differs(_) => "differs",
            Self::NotAccepted => "not accepted",
            Self::Failed(_) => "failed",
            Self::NotRun => "not run",
            Self::Accepted(Accepted::New) => "accepted new",
            Self::Accepted(Accepted::Changed(_)) => "accepted changed",
            Self::Accepted(Accepted::Unchanged) => "unchanged",
            Self::Accepted(Accepted::Refused(_)) => "refused",
        }
    }

    /// The differences from the accepted results, or those before they were accepted.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        match self {
            Self::Differs(found) | Self::Accepted(Accepted::Changed(found)) => found,
            _ => &[],
        }
    }
}

impl Tested {
    /// The reason of a failure, in one line; None if there is no failure.
    #[must_use]
    pub fn complaint(&self) -> Option<String> {
        match &self.outcome {
            Outcome::Differs(found) if found.len() == 1 => {
                Some("1 difference from the accepted results".to_owned())
            }
            Outcome::Differs(found) => Some(format!(
                "{} differences from the accepted results",
                found.len()
            )),
            Outcome::NotAccepted => Some(format!(
                "no accepted results in {}; review a run, then use `--accept`",
                self.folder
            )),
            Outcome::Failed(reason) => Some(reason.clone()),
            Outcome::NotRun => Some("not run: the test ended at the first failure".to_owned()),
            Outcome::Accepted(Accepted::Refused(reason)) => Some(format!("not accepted: {reason}")),
            Outcome::Same { .. } | Outcome::Accepted(_) => None,
        }
    }
}

impl Report {
    /// Number of plans without a failure.
    #[must_use]
    pub fn good(&self) -> usize {
        self.tested
            .iter()
            .filter(|tested| tested.outcome.is_good())
            .count()
    }
}
