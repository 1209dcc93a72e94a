//! The critical time step and the time step of an impact before the run. In: the plan. Out: times \[s\], if they are known.

use psd_language::check::checker::Checker;
use psd_plan::formula::{Formula, NoResults, ResultPart, ResultReference, ResultValue, Results};
use psd_plan::procedures::cycle::block as cycle;
use psd_plan::procedures::stiffness_ramp::block as stiffness_ramp;
use psd_plan::{Impact, Specimen, Striker};

/// Δtc of an impact of this striker on one degree of freedom, s, where all its quantities are known before the run.
pub(crate) fn critical_before_the_run(impact: &Impact, striker: &Striker) -> Option<f64> {
    impact.critical_time_step(striker, Formula::constant)
}

/// Δtc \[s\]. If an earlier procedure measures the stiffness, it uses the initial stiffness of the specimen of a simulated rig. The
/// second value is true if Δtc is such a prediction.
pub(crate) fn predicted_critical(
    checker: &Checker,
    impact: &Impact,
    striker: &Striker,
    specimen: Option<&Specimen>,
) -> Option<(f64, bool)> {
    if let Some(critical) = critical_before_the_run(impact, striker) {
        return Some((critical, false));
    }
    let behaviour = specimen
        .filter(|_| checker.real_rig.is_none())?
        .behaviour
        .as_ref()?;
    let predicted = Predicted {
        stiffness: behaviour.initial_stiffness(),
    };
    let known = |formula: &Formula| {
        formula
            .evaluate(&predicted, None)
            .ok()
            .map(|estimate| estimate.value)
    };
    Some((impact.critical_time_step(striker, known)?, true))
}

/// The results that ramps and cycles will find for a declared specimen.
struct Predicted {
    /// \[N/m\]
    stiffness: f64,
}

/// Results that the initial stiffness predicts.
const PREDICTED: [&str; 3] = [
    stiffness_ramp::STIFFNESS.name,
    stiffness_ramp::SECANT_STIFFNESS.name,
    cycle::STIFFNESS.name,
];

impl Results for Predicted {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let found = PREDICTED.contains(&reference.name) && reference.part == ResultPart::Value;
        found.then_some(ResultValue::Number {
            value: Some(self.stiffness),
            uncertainty: None,
        })
    }
}

/// Δt \[s\], if it is known before the run.
pub(crate) fn time_step_before_the_run(impact: &Impact, striker: &Striker) -> Option<f64> {
    let critical = critical_before_the_run(impact, striker);
    impact
        .stepping
        .time_step
        .evaluate(&NoResults, critical)
        .ok()
        .map(|estimate| estimate.value)
}
