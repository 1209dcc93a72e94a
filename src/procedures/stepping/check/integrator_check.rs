//! `integrator = …` of a procedure that integrates, and the stability of its time step. In: a block. Out: the integrator, or an error.

use crate::codes::{E642, W718};
use crate::procedures::common::violations::{UnstableAsAllowed, UnstableStep};
use crate::procedures::impact::check::time_step::time_step_before_the_run;
use psd_language::check::checker::Checker;
use psd_language::check::wording::shown;
use psd_physics::integrator::stability::{Met, longest_stable_step};
use psd_physics::structure::Matrices;
use psd_plan::procedures::impact::block as impact;
use psd_plan::schema::methods;
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::{Behaviour, Contact, Impact, Integrator, Mode, PointTarget, Specimen, Striker};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// The integrator that a block names, else the tangent form. In continuous mode the secant of two readings would include the force of a
/// damper: there the default is explicit Newmark, if the contact law does not need the tangent.
pub fn integrator(
    checker: &mut Checker,
    block: usize,
    mode: Option<Mode>,
    contact: Option<&Contact>,
) -> Option<Integrator> {
    let Some((entry, _)) = checker.field(block, methods::INTEGRATOR.name) else {
        let continuous = matches!(mode, Some(Mode::Continuous { .. }));
        let whole_steps = contact.is_some_and(|contact| !contact.needs_tangent());
        return Some(if continuous && whole_steps {
            Integrator::Explicit
        } else {
            Integrator::Tangent
        });
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choice(block, methods::INTEGRATOR.name)?;
    Some(match chosen.variant.name {
        "explicit" => Integrator::Explicit,
        "alpha_os" => Integrator::AlphaOs {
            alpha: checker.constant_argument(&chosen, methods::ALPHA.name, context)?,
        },
        _ => Integrator::Tangent,
    })
}

#[derive(Violation)]
#[violation(
    E642,
    "`{law}` requires the tangent stiffness within a step, which `{integrator}` does not have"
)]
#[help("write `integrator = tangent`, or `contact = rigid`, or `contact = limit(1500 N)`")]
struct LawNeedsTheTangent<'a> {
    integrator: &'a str,
    #[label("requires a tangent")]
    struck: Span,
    law: &'a str,
    #[label("`{integrator}` has the force only at the end")]
    named: Span,
}

/// Refuses a contact law that finds the instant of contact inside a step by the tangent's prediction of the force, with an integrator
/// that imposes the displacement before it solves.
pub fn meets_the_contact(
    checker: &mut Checker,
    block: usize,
    integrator: Integrator,
    contact: &Contact,
) -> Option<()> {
    if !contact.needs_tangent() || integrator == Integrator::Tangent {
        return Some(());
    }
    let at = |field| checker.value_or_head(block, field);
    let (named, struck) = (at(methods::INTEGRATOR.name), at(impact::CONTACT.name));
    checker.fail(LawNeedsTheTangent {
        integrator: integrator.name(),
        named,
        law: contact.name(),
        struck,
    })
}

/// α-OS with a `K_I` \[N/m\] below the specimen's stiffness, within the limit \[s\] that follows.
struct StifferThanOperator {
    specimen: f64,
    operator: f64,
    span: Span,
    limit: f64,
}

impl Violation for StifferThanOperator {
    const CODE: Code = W718;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            specimen,
            operator,
            span,
            limit,
        } = self;
        let (specimen, operator) = (
            shown(specimen, Dimension::STIFFNESS),
            shown(operator, Dimension::STIFFNESS),
        );
        let limit = shown(limit, Dimension::TIME);
        let message = format!(
            "motion may grow: specimen stiffness {specimen} exceeds the {operator} of α-OS, which is then stable up to {limit} only"
        );
        Diagnostic::new(Self::CODE, message)
        .at(span, format!("K_I = {operator}"))
        .help("write the high end of the ramp's interval: a `stiffness` above the specimen's is stable at every step")
    }
}

/// The tangent form with a bound on its tangent \[N/m\] below the specimen's stiffness.
struct StifferThanTangent {
    span: Span,
    specimen: f64,
    bound: f64,
}

impl Violation for StifferThanTangent {
    const CODE: Code = W718;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            span,
            specimen,
            bound,
        } = self;
        let (specimen, bound) = (
            shown(specimen, Dimension::STIFFNESS),
            shown(bound, Dimension::STIFFNESS),
        );
        let message = format!(
            "motion may grow: specimen stiffness {specimen} exceeds the upper bound {bound} of the tangent"
        );
        Diagnostic::new(Self::CODE, message)
        .at(span, "tangent limited to `max_tangent_ratio` times this")
        .help(
            "write the stiffness of the specimen at its stiffest, or a larger `max_tangent_ratio`",
        )
    }
}

/// Compares the time step with the longest stable one, as far as both are known before the run: for the initial stiffness of the
/// procedure, and for the model of a simulated specimen.
pub fn stable(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    point: &PointTarget,
    striker: &Striker,
    specimen: Option<&Specimen>,
) {
    let (Some(step), Some(mass)) = (
        time_step_before_the_run(impact, striker),
        point.mass.constant(),
    ) else {
        return;
    };
    let virtual_rig = checker.real_rig.is_none();
    let specimen = specimen
        .filter(|_| virtual_rig)
        .and_then(|specimen| specimen.behaviour.as_ref());
    let behaves = specimen
        .and_then(Behaviour::largest_stiffness)
        .unwrap_or(0.0);
    let assumed = point.stiffness.constant();
    let stiffest = assumed.unwrap_or(0.0).max(behaves);
    let met = Met::one(
        &Matrices {
            mass,
            damping: point.damping.constant().unwrap_or(0.0),
            stiffness: stiffest,
            gravity: None,
        },
        assumed.unwrap_or(stiffest),
    );
    let limit = longest_stable_step(impact.stepping.integrator, &met);
    if let (Integrator::AlphaOs { .. }, Some(assumed)) = (impact.stepping.integrator, assumed)
        && behaves > assumed * (1.0 + 1e-9)
        && step <= limit
    {
        let at = checker.value_or_head(block, STIFFNESS.name);
        checker.report(StifferThanOperator {
            specimen: behaves,
            operator: assumed,
            span: at,
            limit,
        });
    }
    if let (Integrator::Tangent, Some(assumed), Some(ratio)) = (
        impact.stepping.integrator,
        assumed,
        impact.stepping.max_tangent_ratio.constant(),
    ) && behaves > assumed * ratio * (1.0 + 1e-9)
    {
        let at = checker.value_or_head(block, STIFFNESS.name);
        checker.report(StifferThanTangent {
            span: at,
            specimen: behaves,
            bound: assumed * ratio,
        });
    }
    if step <= limit {
        return;
    }
    let at = checker.value_or_head(block, methods::TIME_STEP.name);
    checker.diagnostics.push(if impact.stepping.allow_unstable {
        UnstableAsAllowed {
            span: at,
            step,
            limit,
        }
        .diagnostic()
    } else {
        UnstableStep {
            span: at,
            integrator: impact.stepping.integrator,
            step,
            limit,
            computed: None,
        }
        .diagnostic()
    });
}
