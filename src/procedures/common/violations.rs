//! Violations that the checks of several procedures find.

use crate::codes::{E643, W701, W712};
use psd_language::check::wording::{shown, time};
use psd_language::codes::{E405, E641};
use psd_plan::Integrator;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// A field of the other kind of impact.
#[derive(Violation)]
#[violation(E641, "`{field}` has no effect in {of}")]
#[help("{}", help)]
pub struct NoUseOnAFrame<'a> {
    pub field: &'a str,
    pub of: &'a str,
    #[label("no effect here")]
    pub at: Span,
    pub help: &'a str,
}

#[derive(Violation)]
#[violation(
    W712,
    "the motion will grow: time step {step} exceeds the stability limit {limit}",
    step = shown(step, Dimension::TIME),
    limit = shown(limit, Dimension::TIME)
)]
#[help("remove `allow_unstable`, unless the growth itself is to be shown")]
pub struct UnstableAsAllowed {
    #[label("allowed here")]
    pub span: Span,
    pub step: f64,
    pub limit: f64,
}

pub struct UnstableStep {
    pub span: Span,
    pub integrator: Integrator,
    pub step: f64,
    pub limit: f64,
    /// The computed storey that dictates the limit of explicit Newmark, from 0.
    pub computed: Option<usize>,
}

impl Violation for UnstableStep {
    const CODE: Code = E643;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            span,
            integrator,
            step,
            limit,
            computed,
        } = self;
        let time = |value| shown(value, Dimension::TIME);
        let (step, longest) = (time(step), time(limit));
        let why = match integrator {
            Integrator::AlphaOs { .. } => "the specimen is stiffer than the `stiffness` of α-OS",
            Integrator::Tangent | Integrator::Explicit => {
                "explicit Newmark is stable up to the period over π"
            }
        };
        Diagnostic::new(
            Self::CODE,
            format!("time step {step} exceeds the stability limit {longest}: {why}"),
        )
        .at(span, format!("{step}, stable up to {longest}"))
        .help(computed.map_or_else(
            || "write `time_step = critical / 20`; `allow_unstable = true` permits the step".to_owned(),
            |storey| {
                let storey = storey + 1;
                format!("the computed storey {storey} dictates the limit: write `integrator = alpha_os(alpha: -0.05)`, or `time_step = critical / 20`")
            },
        ))
    }
}

pub struct TooManyInProcedure<'a> {
    pub what: &'a str,
    pub found: f64,
    pub most: f64,
    pub span: Span,
    pub help: &'a str,
}

impl Violation for TooManyInProcedure<'_> {
    const CODE: Code = E405;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            what,
            found,
            most,
            span,
            help,
        } = self;
        // A readable count; for a larger one its order of magnitude.
        let found = if found < 1e12 {
            found.to_string()
        } else {
            format!("about {found:.0e}")
        };
        Diagnostic::new(
            Self::CODE,
            format!("too many {what} in a procedure: {found} (at most {most})"),
        )
        .at(span, "too many")
        .help(help)
    }
}

#[derive(Violation)]
#[violation(
    W701,
    "peaks may be wrong: time step {step} exceeds the critical step {critical}",
    step = time(step),
    critical = time(critical)
)]
#[help("write `time_step = critical / 20`")]
pub struct StepAboveCritical {
    #[label("{step}, critical is {critical}", step = time(step), critical = time(critical))]
    pub span: Span,
    pub step: f64,
    pub critical: f64,
}
