//! What became of the plans under test, as data: the console, TAP, JUnit and JSON are functions of it.

use super::finding::Finding;

/// One plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Tested {
    /// `plans/beam`
    pub name: String,
    pub outcome: Outcome,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// As accepted. The verdict; None of a plan that fails to check, as it should.
    Same {
        verdict: Option<&'static str>,
    },
    Differs(Vec<Finding>),
    /// There is nothing to hold it against.
    NotAccepted {
        folder: String,
    },
    /// It could not be run or compared.
    Failed(String),
    /// Another failed before it, and the first failure ends the test.
    NotRun,
    Accepted(Accepted),
}

/// What blessing did.
#[derive(Clone, Debug, PartialEq)]
pub enum Accepted {
    New,
    /// What is different from before; nothing where all was only written anew.
    Changed(Vec<Finding>),
    Unchanged,
    Refused(&'static str),
}

/// All of them, in order.
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

    /// The word of the JSON report.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Same { .. } => "same",
            Self::Differs(_) => "differs",
            Self::NotAccepted { .. } => "not blessed",
            Self::Failed(_) => "failed",
            Self::NotRun => "not run",
            Self::Accepted(Accepted::New) => "blessed new",
            Self::Accepted(Accepted::Changed(_)) => "blessed changed",
            Self::Accepted(Accepted::Unchanged) => "unchanged",
            Self::Accepted(Accepted::Refused(_)) => "refused",
        }
    }

    /// What differs from the accepted results, or differed before it was accepted.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        match self {
            Self::Differs(found) | Self::Accepted(Accepted::Changed(found)) => found,
            _ => &[],
        }
    }

    /// Why it is not good, in one line; None where it is.
    #[must_use]
    pub fn complaint(&self) -> Option<String> {
        match self {
            Self::Differs(found) if found.len() == 1 => {
                Some("1 difference from the blessed results".to_owned())
            }
            Self::Differs(found) => Some(format!(
                "{} differences from the blessed results",
                found.len()
            )),
            Self::NotAccepted { folder } => Some(format!(
                "no blessed results in {folder}; look at a run, then `--bless`"
            )),
            Self::Failed(reason) => Some(reason.clone()),
            Self::NotRun => Some("not run: the test ended at the first failure".to_owned()),
            Self::Accepted(Accepted::Refused(reason)) => Some(format!("not blessed: {reason}")),
            Self::Same { .. } | Self::Accepted(_) => None,
        }
    }
}

impl Report {
    /// How many came out well.
    #[must_use]
    pub fn good(&self) -> usize {
        self.tested
            .iter()
            .filter(|tested| tested.outcome.is_good())
            .count()
    }
}
