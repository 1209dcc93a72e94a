//! Compares the results read from a `stiffness ramp` with its steps. In: procedures, and every result that a formula or text reads. Out:
//! an error if the ramp never gives the result (E655), a warning if it has too few readings (W722). It uses no reading.

use std::collections::BTreeSet;

use crate::codes::{E655, W722};
use psd_language::check::checker::Checker;
use psd_physics::statistics::student_t::coverage;
use psd_plan::formula::Formula;
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::uncertainty::FEW;
use psd_plan::{BreakCount, Procedure, ProcedureKind, RampFit, StiffnessRamp};
use psd_text::count::counted;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::display::significant;

/// Results of a ramp that its fit gives.
const FITTED: [&str; 6] = [
    schema::STIFFNESS.name,
    schema::INTERCEPT_FORCE.name,
    schema::YIELD_FORCE.name,
    schema::YIELD_DISPLACEMENT.name,
    schema::POST_YIELD_STIFFNESS.name,
    schema::POST_YIELD_RATIO.name,
];

/// The results that one straight line does not have.
const OF_A_KNEE: [&str; 4] = [
    schema::YIELD_FORCE.name,
    schema::YIELD_DISPLACEMENT.name,
    schema::POST_YIELD_STIFFNESS.name,
    schema::POST_YIELD_RATIO.name,
];

/// `read` is a ramp result that an expression reads, `lacks` why it never exists, `help` the remedy.
struct NeverGiven<'a> {
    read: &'a str,
    span: Span,
    ramp: (&'a str, Span),
    lacks: &'a str,
    help: &'a str,
}

impl Violation for NeverGiven<'_> {
    const CODE: Code = E655;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            read,
            span,
            ramp,
            lacks,
            help,
        } = self;
        Diagnostic::new(
            Self::CODE,
            format!("ramp `{}` never gives `{read}`: {lacks}", ramp.0),
        )
        .at(span, "read here")
        .at(ramp.1, "from this ramp")
        .help(help.to_owned())
    }
}

struct FewDegreesOfFreedom<'a> {
    ramp: &'a str,
    points: usize,
    degrees: usize,
    displacements: Span,
    required: Span,
}

impl Violation for FewDegreesOfFreedom<'_> {
    const CODE: Code = W722;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            ramp,
            points,
            degrees,
            displacements,
            required,
        } = self;
        #[expect(clippy::cast_precision_loss, reason = "a few")]
        let factor = significant(coverage(degrees as f64), 3);
        let freedom = counted(degrees, "degree of freedom", "degrees of freedom");
        let text = format!(
            "uncertainty is large: {points} steps leave {freedom} in the fit of `{ramp}`, U = {factor} × standard error"
        );
        Diagnostic::new(Self::CODE, text)
            .at(displacements, format!("{points} steps"))
            .at(required, "fitted result read here")
            .help(format!(
                "write {} steps or more",
                points + usize::from(FEW) - degrees
            ))
    }
}

/// Reported once for each ramp; called only if there is no error.
pub fn check(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)]) {
    let (mut never, mut few) = (BTreeSet::new(), BTreeSet::new());
    for (reference, span) in checker.read.clone() {
        let Some((block, Some(procedure))) = procedures.get(reference.procedure.0) else {
            continue;
        };
        let ProcedureKind::StiffnessRamp(ramp) = &procedure.kind else {
            continue;
        };
        let displacements = checker.value_or_head(*block, schema::DISPLACEMENTS.name);
        if let Some((lacks, help)) = lacks(ramp, reference.name) {
            if never.insert(*block) {
                let ramp = (procedure.name.as_str(), displacements);
                checker.report(NeverGiven {
                    read: reference.name,
                    span,
                    ramp,
                    lacks: &lacks,
                    help,
                });
            }
        } else if FITTED.contains(&reference.name)
            && let Some((points, degrees)) = ramp
                .degrees_of_freedom()
                .filter(|(_, degrees)| *degrees < usize::from(FEW))
            && few.insert(*block)
        {
            checker.report(FewDegreesOfFreedom {
                ramp: &procedure.name,
                points,
                degrees,
                displacements,
                required: span,
            });
        }
    }
}

/// Why a ramp never has a result, and the remedy; None if it may have it.
fn lacks(ramp: &StiffnessRamp, result: &str) -> Option<(String, &'static str)> {
    let steps = ramp.displacements.len();
    match result {
        name if name == schema::LOOP_ENERGY.name && !ramp.return_path => {
            Some(("it does not return".to_owned(), "write `return = true`"))
        }
        name if name == schema::TANGENT_STIFFNESS.name && steps < 2 => Some((
            "it has one step".to_owned(),
            "write two displacements or more",
        )),
        name if OF_A_KNEE.contains(&name) && ramp.fit == RampFit::Linear => Some((
            "a straight line has no yield point".to_owned(),
            "write `fit = bilinear`, or `fit = multilinear`",
        )),
        name if FITTED.contains(&name) || name == schema::R_SQUARED.name => fitted_to_too_few(ramp),
        _ => None,
    }
}

/// The minimum of `mechanics`: a line needs three readings, not all at one position. A yield point needs six steps, a curve three per
/// segment and one more.
fn fitted_to_too_few(ramp: &StiffnessRamp) -> Option<(String, &'static str)> {
    let steps = ramp.displacements.len();
    let (points, wanted) = match ramp.fit {
        RampFit::Linear => (steps * ramp.repeats as usize, 3),
        RampFit::Bilinear => (steps, 6),
        RampFit::Multilinear(BreakCount::Exactly(breaks)) => (steps, 3 * (breaks + 1) + 1),
        RampFit::Multilinear(BreakCount::ByCriterion { .. }) => (steps, 4),
    };
    let count = |points: usize| counted(points, "step", "steps");
    if points < wanted {
        let verb = if points == 1 { "is" } else { "are" };
        let lacks = format!(
            "{} {verb} not enough for the fit, which requires {wanted}",
            count(points)
        );
        return Some((
            lacks,
            "write more displacements; for a straight line five or more",
        ));
    }
    let displacements: Option<Vec<f64>> =
        ramp.displacements.iter().map(Formula::constant).collect();
    let at_one_displacement = displacements.is_some_and(|displacements| {
        displacements
            .iter()
            .all(|displacement| *displacement == displacements[0])
    });
    at_one_displacement.then(|| {
        (
            "all its steps are at one position".to_owned(),
            "write different displacements",
        )
    })
}
