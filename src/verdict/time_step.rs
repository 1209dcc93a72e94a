//! A condition in finer time steps. In: a condition, and results with their differences in finer steps. Out: its outcome. It is
//! inconclusive if finer steps change the decision; the uncertainty U is that of all other sources.

use super::condition::{decide, is_equality};
use super::{ConditionOutcome, Verdict};
use psd_physics::statistics::samples::peak;
use psd_plan::formula::{ResultPart, ResultReference, Results};
use psd_plan::procedures::impact::block::TIME_STEP;
use psd_plan::time_step::{FINER, in_finer_steps};
use psd_plan::uncertainty::sources_of;
use psd_plan::{Condition, DecisionRule};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

/// The smallest time step that is recommended, as a fraction of that of the run.
const FINEST: f64 = 1024.0;

/// The outcome of a condition: decided with these results, and with those in finer steps. All results of a procedure are those of one
/// re-integration. An equality, and a published number, are compared with the number of the run itself.
pub fn assess_condition(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
) -> ConditionOutcome {
    let own = decide(condition, rule, results);
    let in_own_steps = rule == DecisionRule::ValueAlone || is_equality(condition);
    if own.value.is_none() || in_own_steps {
        return own;
    }
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    let follows = sources_of(&references, results)
        .into_iter()
        .any(|source| !source.is_of_uncertainty());
    if !follows {
        return own;
    }
    let finer = FINER.map(|weights| {
        in_finer_steps(results, weights, &mut |results| {
            decide(condition, rule, results)
        })
    });
    let values = finer
        .iter()
        .chain([&own])
        .filter_map(|outcome| outcome.value);
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    let conforms = finer
        .iter()
        .map(|outcome| outcome.conforms)
        .fold(own.conforms, |least, next| {
            least.zip(next).map(|(least, next)| least.min(next))
        });
    let differs = |outcome: &ConditionOutcome| outcome.verdict != own.verdict;
    let decides = own.verdict != Verdict::Inconclusive && finer.iter().any(differs);
    let own = ConditionOutcome {
        conforms,
        in_finer_steps: Some(ends),
        ..own
    };
    if !decides {
        return own;
    }
    let [low, high] = ends.map(|value| readable(value, own.dimension));
    let advice = advice(&own, &finer, &references, results);
    ConditionOutcome {
        verdict: Verdict::Inconclusive,
        reason: Some(format!(
            "the time step decides: finer steps give {low} to {high}{advice}"
        )),
        ..own
    }
}

/// The time steps with which the condition can be decided.
fn advice(
    own: &ConditionOutcome,
    finer: &[ConditionOutcome; 4],
    references: &[ResultReference],
    results: &dyn Results,
) -> String {
    let Some(times) = finer_by(own, finer) else {
        return "; the value is too near to the limit for a step to be recommended".to_owned();
    };
    let mut steps: Vec<String> = Vec::new();
    for reference in references {
        let step = ResultReference {
            name: TIME_STEP.name,
            part: ResultPart::Value,
            ..*reference
        };
        let found = results.result(step).and_then(|step| step.number());
        let text = found.map(|step| stated(step / times, Dimension::TIME));
        if let Some(text) = text.filter(|text| !steps.contains(text)) {
            steps.push(text);
        }
    }
    match steps.as_slice() {
        [step] => format!("; use a time step of {step} or less"),
        _ => format!("; use time steps that are {times} times smaller"),
    }
}

/// The number of steps for each of the run with which finer ones no longer change the decision: a power of two, at least 2. The interval
/// of a method of first order is proportional to the step.
fn finer_by(own: &ConditionOutcome, finer: &[ConditionOutcome; 4]) -> Option<f64> {
    let agree = |from: usize| {
        finer[from..]
            .iter()
            .all(|outcome| outcome.verdict == finer[from].verdict)
    };
    if agree(0) {
        return Some(2.0);
    }
    if agree(1) {
        return Some(4.0);
    }
    let margin = |outcome: &ConditionOutcome| outcome.margin;
    let (here, quarter) = (margin(own)?, margin(&finer[1])?);
    let wide = peak(finer.iter().filter_map(margin).map(|there| there - here));
    let band = finer[1].guard_band.unwrap_or(0.0);
    let away = (quarter - band).abs().min((quarter + band).abs());
    let times = (wide / away).log2().ceil().exp2().max(8.0);
    (times <= FINEST).then_some(times)
}
