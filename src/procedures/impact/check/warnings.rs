//! Warnings on one impact: its time step against eq. 7 and against the one that a limit force needs, its force against the mechanism of
//! a portal. In: an impact, its striker and specimen. Out: warnings with the numbers.

use super::time_step::{predicted_critical, time_step_before_the_run};
use crate::language::check::checker::Checker;
use crate::language::check::messages::{specimens, whole as fault};
use crate::physics::structure::portal::limit::mechanism_limit;
use crate::plan::formula::{Formula, NoResults};
use crate::plan::procedures::impact::block as schema;
use crate::plan::{Behaviour, Contact, Impact, Specimen, Striker};
use crate::schema::methods;
use crate::text::source::Span;

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
        let fault = if predicted {
            fault::step_above_predicted
        } else {
            fault::step_above_critical
        };
        checker.diagnostics.push(fault(at, step.value, critical));
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
        checker.diagnostics.push(specimens::beyond_mechanism(
            portal.mechanism(),
            force,
            most,
            entry.value.span,
        ));
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
        checker
            .diagnostics
            .push(fault::limit_force_not_resolved(step, at, first, resolved));
    }
}
