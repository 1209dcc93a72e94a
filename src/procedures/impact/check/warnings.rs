//! Warnings on one impact: its time step against eq. 7 and against the one that a limit force needs, its force against the mechanism of
//! a portal. In: an impact, its striker and specimen. Out: warnings with the numbers.

use crate::codes::{W701, W703, W724};
use crate::procedures::common::violations::StepAboveCritical;
use psd_language::check::checker::Checker;
use psd_language::check::wording::{shown, time};
use psd_physics::structure::portal::limit::mechanism_limit;
use psd_plan::formula::{Formula, NoResults};
use psd_plan::procedures::impact::block as schema;
use psd_plan::schema::methods;
use psd_plan::{Behaviour, Contact, Impact, Mechanism, Specimen, Striker};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::time_step::{predicted_critical, time_step_before_the_run};

/// The step compared with the limit from a stiffness that is measured only in the run.
struct StepAbovePredicted {
    span: Span,
    step: f64,
    critical: f64,
}

impl Violation for StepAbovePredicted {
    const CODE: Code = W701;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            span,
            step,
            critical,
        } = self;
        let (step, critical) = (time(step), time(critical));
        let message = format!(
            "peaks may be wrong: time step {step} exceeds the critical step, about {critical} by the declared behaviour"
        );
        Diagnostic::new(Self::CODE, message)
            .at(span, format!("{step}, critical is about {critical}"))
            .help("write `time_step = critical / 20`")
    }
}

/// Warns of a time step above eq. 7, unless it is beyond the stability limit already, and above the one that a limit force needs.
pub(crate) fn time_step(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    striker: &Striker,
    specimen: Option<&Specimen>,
    allowed_beyond_stability: bool,
) {
    let at = checker.value_or_head(block, methods::TIME_STEP.name);
    let critical = predicted_critical(checker, impact, striker, specimen);
    if let Some((critical, predicted)) = critical
        && let Ok(step) = impact
            .stepping
            .time_step
            .evaluate(&NoResults, Some(critical))
        && step.value > critical
        && !allowed_beyond_stability
    {
        let (span, step) = (at, step.value);
        if predicted {
            checker.report(StepAbovePredicted {
                span,
                step,
                critical,
            });
        } else {
            checker.report(StepAboveCritical {
                span,
                step,
                critical,
            });
        }
    }
    let Some(step) = time_step_before_the_run(impact, striker) else {
        return;
    };
    let mass = impact.point().and_then(|point| point.mass.constant());
    if let (Contact::Limit { force }, Some(mass)) = (&impact.contact, mass)
        && let Some(force) = force.constant()
    {
        limit_force(checker, step, at, mass, force, striker);
    }
}

/// A contact force \[N\] that may exceed the largest force of a mechanism \[N\].
struct BeyondMechanism {
    mechanism: Mechanism,
    force: f64,
    most: f64,
    span: Span,
}

impl Violation for BeyondMechanism {
    const CODE: Code = W724;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            mechanism,
            force,
            most,
            span,
        } = self;
        let [force, most] = [force, most].map(|force| shown(force, Dimension::FORCE));
        let name = mechanism.name();
        Diagnostic::new(
        Self::CODE,
        format!("a contact force above {most} forms other hinges than the {name} mechanism"),
    )
    .at(span, format!("can reach {force}"))
    .help(
        "reduce the force to the mechanism's limit, or expect hinges nearer to the impact than the model has",
    )
    }
}

/// Warns of a contact force that may exceed the mechanism load of a portal.
pub(crate) fn mechanism(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    specimen: Option<&Specimen>,
) {
    let bound = impact.contact.force_limit().and_then(Formula::constant);
    let portal = specimen
        .and_then(|specimen| specimen.behaviour.as_ref())
        .and_then(Behaviour::portal);
    if let (Some(force), Some(portal), Some((_, entry))) =
        (bound, portal, checker.field(block, schema::CONTACT.name))
        && let Some(most) = mechanism_limit(portal).filter(|most| force > *most)
    {
        checker.report(BeyondMechanism {
            mechanism: portal.mechanism(),
            force,
            most,
            span: entry.value.span,
        });
    }
}

/// `first`: the longest step at which the limit acts at the first impact; `resolved`: the longest step that resolves the displacement.
struct LimitForceNotResolved {
    step: f64,
    span: Span,
    first: f64,
    resolved: f64,
}

impl Violation for LimitForceNotResolved {
    const CODE: Code = W703;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            step,
            span,
            first,
            resolved,
        } = self;
        let (now, first_text, resolved_text) = (time(step), time(first), time(resolved));
        let message = if step >= first {
            format!(
                "the limit force has no effect on the first impact: time step {now} must be below {first_text}"
            )
        } else {
            format!(
                "indentation may be wrong: time step {now} does not resolve the limit force (at most {resolved_text})"
            )
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, format!("time step {now}"))
            .help(format!("write `time_step = {resolved_text}` or less"))
    }
}

/// Warns of a time step, s, that does not resolve a limit force \[N\] on a structure of `mass` \[kg\]: Δt < 2M·Ms·V0/((2M + Ms)·F_lim), and
/// Δt ≤ μV0/(5F_lim) with μ = M·Ms/(M + Ms).
pub(crate) fn limit_force(
    checker: &mut Checker,
    step: f64,
    at: Span,
    mass: f64,
    force: f64,
    striker: &Striker,
) {
    let first =
        2.0 * mass * striker.mass * striker.velocity / ((2.0 * mass + striker.mass) * force);
    let resolved = mass * striker.mass / (mass + striker.mass) * striker.velocity / (5.0 * force);
    if step > resolved {
        checker.report(LimitForceNotResolved {
            step,
            span: at,
            first,
            resolved,
        });
    }
}
