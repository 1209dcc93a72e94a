//! The facts about a procedure that the drivers of check and report need without carrying it out. Each folder gives its own. In: nothing.
//! Out: types.

use super::unload;
use psd_plan::record::BroughtTogether;
use psd_plan::{
    Condition, Contact, Dependence, FigureKind, Ground, ShakeDamping, Specimen, Stepping,
};

/// The structure that a procedure tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Tests {
    #[default]
    OneDegreeOfFreedom,
    Frame,
    Nothing,
}

/// Facts about a procedure of the plan.
#[derive(Default)]
pub(crate) struct Facts<'a> {
    pub tests: Tests,
    /// Its time stepping, if it integrates.
    pub stepping: Option<&'a Stepping>,
    /// The contact law of an impact.
    pub contact: Option<&'a Contact>,
    /// The conditions under which a series of impacts continues.
    pub conditions: Option<&'a [Condition]>,
    /// The damping that the plan gives a frame, with its relative standard uncertainty.
    pub frame_damping: Option<(&'a ShakeDamping, f64)>,
    /// The uncertain inputs of striker and specimen that it depends on.
    pub dependence: Dependence,
    /// Whether it leaves the specimen without load.
    pub unloads: bool,
    /// Whether it moves the storeys of a frame to zero shear, at its end or in between.
    pub unloads_storeys: bool,
    /// Its figures, in the order of a report.
    pub figures: &'static [FigureKind],
    /// Those that several procedures of its kind can share, one curve of each.
    pub shared_figures: &'static [FigureKind],
    /// The end of the observations that the plan itself implies, so that a report does not print them.
    pub implied: &'static [&'static str],
}

/// The results of a procedure of the plan, as a report lists them.
#[derive(Default)]
pub(crate) struct Listed {
    /// The most important ones, in order.
    pub headline: Vec<&'static str>,
    /// Those that no table prints: zero by construction, without a meaning, or stated in a sentence.
    pub unprinted: Vec<&'static str>,
}

/// Facts about the record of a procedure.
pub(crate) struct Recorded {
    /// Whether the numbers of its lists have a separate table.
    pub lists_are_tabled: bool,
    /// Integrated simulated time \[s\], and the laboratory time \[s\] that it took.
    pub time_spans: Option<(f64, f64)>,
    /// Results that have an uncertainty budget even if no requirement reads any.
    pub budgeted: &'static [&'static str],
    /// The name of the entries of its lists, if the names of the lists do not give it.
    pub entries: &'static str,
    /// The name of the entries of its lists of drifts and shears.
    pub members: &'static str,
    /// The method by which the contributions to the uncertainty of its results were found.
    pub uncertainty: &'static str,
    /// A result that says nothing if its expanded uncertainty includes zero.
    pub distinct_from_zero: Option<&'static str>,
    /// The correction of the readings of a sweep's strokes to one position.
    pub strokes: Option<BroughtTogether>,
}

impl Default for Recorded {
    fn default() -> Self {
        Self {
            lists_are_tabled: false,
            time_spans: None,
            budgeted: &[],
            entries: "number",
            members: "storey",
            uncertainty: unload::uncertainty::UNCERTAINTY,
            distinct_from_zero: None,
            strokes: None,
        }
    }
}

/// The state in which a procedure leaves the specimen to the next one that integrates.
pub(crate) enum Leaves<'a> {
    /// In the state in which it was found.
    AsFound,
    /// At rest, or at the position that the plan commands.
    AtRest,
    /// Under load or in motion.
    Moving(Motion<'a>),
    /// Unloaded, where the rest of the structure is not in balance: the end in words, and the help for the next one.
    Unbalanced { ends: &'a str, help: &'a str },
}

/// What the state at the end of a procedure depends on besides the procedure.
#[derive(Clone, Copy)]
pub(crate) struct Left<'a> {
    pub grounds: &'a [Option<Ground>],
    pub specimens: &'a [Option<Specimen>],
}

/// A motion that begins at the end of the one before it.
pub(crate) struct Motion<'a> {
    pub what: &'a str,
    /// Its end, in words.
    pub ends: &'a str,
    /// The help for the next one.
    pub help: &'a str,
    /// Whether its own end is at rest.
    pub rests: bool,
}

/// Delay of the actuators of a procedure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Delay {
    /// D, simulated time \[s\].
    pub late: f64,
    /// Δt \[s\]
    pub time_step: f64,
    /// Natural circular frequency of the specimen, or of the first mode of a frame \[rad/s\].
    pub omega: f64,
}

impl Delay {
    /// Apparent damping ratio of a motion at ω with a delay D: a force K·d(t − D) is K·d − KD·v, so that C = −KD and ζ = −ωD/2.
    pub(crate) fn damping_ratio(self) -> f64 {
        -0.5 * self.omega * self.late
    }

    /// Energy that it adds to a vibration in one cycle, over that of the vibration: −4πζ.
    pub(crate) fn energy(self) -> f64 {
        -4.0 * std::f64::consts::PI * self.damping_ratio()
    }
}

#[cfg(test)]
mod tests {
    use psd_plan::{Plan, ProcedureKind};
    use psd_testing::plans::ChangeTarget as _;

    /// An impact also names striker and specimen, and a plan that declares everything names nothing.
    #[test]
    fn what_is_not_declared_of_striker_and_specimen_is_named() {
        use crate::procedures::facts_of;
        use crate::tests::testing::{elastic_plan, impact, ramp, struck_frame};
        use psd_plan::formula::Formula;
        let struck = ProcedureKind::Impact(impact(Formula::Constant(300.0)));
        let mut plan = elastic_plan(
            300.0,
            vec![ProcedureKind::StiffnessRamp(ramp(1e-3)), struck],
        );
        let undeclared = |plan: &Plan, index: usize| {
            plan.undeclared(facts_of(&plan.procedures[index].kind).dependence)
        };
        assert_eq!(undeclared(&plan, 0).len(), 4);
        assert_eq!(
            undeclared(&plan, 1)[..3],
            ["striker mass", "striker velocity", "specimen mass"]
        );
        plan.strikers[0].velocity_uncertainty = 0.01;
        if let ProcedureKind::Impact(struck) = &mut plan.procedures[1].kind {
            struck.point_mut().mass_uncertainty = 0.01;
        }
        assert_eq!(
            undeclared(&plan, 1)[..2],
            ["striker mass", "force calibration"]
        );
        let mut frame = struck_frame();
        assert!(undeclared(&frame, 0).contains(&"specimen mass"));
        if let Some(frame) = &mut frame.specimens[0].frame {
            *frame = frame.with(|storeys| {
                for storey in storeys {
                    storey.mass_uncertainty = 0.01;
                }
            });
        }
        assert!(!undeclared(&frame, 0).contains(&"specimen mass"));
        assert!(!undeclared(&frame, 0).contains(&"weights of the floors"));
        if let Some(frame) = &mut frame.specimens[0].frame {
            *frame = frame.with(|storeys| storeys[0].gravity = 1e4);
        }
        assert!(undeclared(&frame, 0).contains(&"weights of the floors"));
    }
}
