//! What the drivers of check and report must know of a procedure without carrying it out: each folder gives its own. In: nothing.
//! Out: types.

use super::unload;
use crate::plan::{Condition, Contact, Dependence, FigureKind, ShakeDamping, Stepping};

/// What a procedure tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Tests {
    #[default]
    OneDegreeOfFreedom,
    Frame,
    Nothing,
}

/// Of a procedure of the plan.
#[derive(Default)]
pub(crate) struct Facts<'a> {
    pub tests: Tests,
    /// How it integrates, where it does.
    pub stepping: Option<&'a Stepping>,
    /// The contact law of a blow.
    pub contact: Option<&'a Contact>,
    /// The conditions under which a row of blows goes on.
    pub conditions: Option<&'a [Condition]>,
    /// The damping that the plan gives a frame, with its relative standard uncertainty.
    pub frame_damping: Option<(&'a ShakeDamping, f64)>,
    /// The uncertain inputs of striker and specimen that it depends on.
    pub dependence: Dependence,
    /// Whether it leaves the specimen without load.
    pub unloads: bool,
    /// What it can draw, in the order of a report.
    pub figures: &'static [FigureKind],
    /// Of these, what several procedures of its kind can share, one curve of each.
    pub shared_figures: &'static [FigureKind],
}

/// Of what a procedure recorded.
pub(crate) struct Recorded {
    /// Whether the numbers of its lists stand in a table of their own.
    pub lists_are_tabled: bool,
    /// Virtual time (s) that it integrated, and the rig's (s) for it.
    pub time_spans: Option<(f64, f64)>,
    /// Results that are worth an uncertainty budget where no requirement reads any.
    pub budgeted: &'static [&'static str],
    /// What the entries of its lists are, where their names do not say it.
    pub entries: &'static str,
    /// How the contributions to the uncertainty of its results were found.
    pub uncertainty: &'static str,
}

impl Default for Recorded {
    fn default() -> Self {
        Self {
            lists_are_tabled: false,
            time_spans: None,
            budgeted: &[],
            entries: "number",
            uncertainty: unload::report::UNCERTAINTY,
        }
    }
}

/// How a procedure leaves the specimen to the next one that integrates.
pub(crate) enum Leaves<'a> {
    /// As it found it.
    AsFound,
    /// At rest, or wherever the plan wants it.
    AtRest,
    /// Under load or in motion.
    Moving(Motion<'a>),
}

/// A motion that begins from where the one before it ended.
pub(crate) struct Motion<'a> {
    pub what: &'a str,
    /// Where it ends.
    pub ends: &'a str,
    /// What helps the next one.
    pub help: &'a str,
    /// Whether its own end is at rest.
    pub rests: bool,
}
