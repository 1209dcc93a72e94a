//! Conditions whose results are not conclusive. The causes: an incomplete procedure, an energy balance error, a time step above the
//! critical one, a zero drift, or a peak that was not reached. In: the outcome of a condition. Out: the outcome, or inconclusive with the
//! reason.

use super::{ConditionOutcome, unfinished_peaks};
use psd_physics::impact::energy::WORTHLESS;
use psd_plan::formula::{ResultReference, ResultValue, Results};
use psd_plan::procedures::damping_sweep::block as damping_sweep;
use psd_plan::procedures::escalate::block as escalate;
use psd_plan::procedures::impact::block as impact;
use psd_plan::procedures::stiffness_ramp::block as stiffness_ramp;
use psd_plan::record::failpoint;
use psd_plan::record::failpoint::Guarding;
use psd_plan::record::{Beyond, ProcedureRecord, Record};
use psd_plan::schema::ResultKind;
use psd_plan::{Condition, DecisionRule};
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// A result that a condition reads: its procedure, and its name.
type Read<'a> = (&'a ProcedureRecord, &'static str);

/// The outcome of a condition; inconclusive, with the reason, if its results are not conclusive.
pub(super) fn unless_undecided(
    condition: &Condition,
    rule: DecisionRule,
    outcome: ConditionOutcome,
    record: &Record,
    results: &dyn Results,
) -> ConditionOutcome {
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    let read = results_read(&references, record);
    let unfinished = || {
        let no_peak = || {
            unfinished_peaks::undecided(condition, rule, results, |procedure| {
                record
                    .procedures
                    .get(procedure.0)
                    .map(|procedure| (&procedure.history, procedure.name.as_str()))
            })
        };
        match worthless(&read) {
            // A result that does not exist has its own reason.
            Some(why) => match &outcome.reason {
                Some(missing) if outcome.margin.is_none() => Some(missing.clone()),
                _ => Some(why),
            },
            None => no_peak(),
        }
    };
    match drifted(&read, record).or_else(unfinished) {
        Some(reason) => outcome.inconclusive(reason),
        None => outcome,
    }
}

/// Why a number that is made of these results is not that of a finished motion; None if it is.
pub fn unfinished(references: &[ResultReference], record: &Record) -> Option<String> {
    let read = results_read(references, record);
    let growing = || {
        read.iter().find_map(|(procedure, result)| {
            unfinished_peaks::growing(&procedure.history, result, &procedure.name)
        })
    };
    worthless(&read).or_else(growing)
}

/// The results of procedures that took place.
fn results_read<'a>(references: &[ResultReference], record: &'a Record) -> Vec<Read<'a>> {
    let procedure = |reference: &ResultReference| {
        Some((
            record.procedures.get(reference.procedure.0)?,
            reference.name,
        ))
    };
    references.iter().filter_map(procedure).collect()
}

/// Why the motion of these results is not that of the specimen; None if it is.
fn worthless(read: &[Read<'_>]) -> Option<String> {
    cut_short(read)
        .or_else(|| unbalanced(read))
        .or_else(|| above_critical(read))
}

/// A procedure that is not complete: its peaks may not have been reached.
fn cut_short(read: &[Read<'_>]) -> Option<String> {
    let (procedure, _) = read.iter().find(|(procedure, _)| !procedure.complete)?;
    Some(format!("{} was not completed", procedure.name))
}

/// Results that do not depend on the energy balance or on the length of the time steps.
const BESIDE_THE_BALANCE: [&str; 6] = [
    impact::ENERGY_ERROR.name,
    escalate::ENERGY_ERRORS.name,
    impact::TIME_STEP.name,
    impact::CRITICAL_TIME_STEP.name,
    impact::STEPS.name,
    impact::PERIODS.name,
];

/// An energy balance error of more than half of the input: the computed motion is not that of the specimen.
fn unbalanced(read: &[Read<'_>]) -> Option<String> {
    let is_unbalanced =
        |(procedure, result): &&Read<'_>| !BESIDE_THE_BALANCE.contains(result) && off(procedure);
    let (procedure, _) = read.iter().find(is_unbalanced)?;
    Some(format!(
        "the energy balance of {} is in error by more than half of the input energy",
        procedure.name
    ))
}

/// Time steps above the critical one do not follow the motion of the specimen.
fn above_critical(read: &[Read<'_>]) -> Option<String> {
    let of = |(procedure, result): &Read<'_>| {
        let (step, critical) = procedure
            .history
            .above_critical()
            .filter(|_| !BESIDE_THE_BALANCE.contains(result))?;
        Some(longer_than_critical(&procedure.name, step, critical))
    };
    read.iter().find_map(of)
}

/// The observation on a time step \[s\] above the critical one \[s\].
pub(super) fn longer_than_critical(name: &str, step: f64, critical: f64) -> String {
    let (step, critical) = (
        stated(step, Dimension::TIME),
        stated(critical, Dimension::TIME),
    );
    format!("the time step of {name}, {step}, exceeds the critical step {critical} (W701)")
}

/// Whether the energy balance error of a procedure, or of one of its impacts, exceeds its bound.
fn off(procedure: &ProcedureRecord) -> bool {
    let found = |kind: ResultKind| procedure.result(kind.name).map(|result| &result.value);
    let beyond = |error: &f64| error.is_nan() || error.abs() > WORTHLESS;
    match found(impact::ENERGY_ERROR).or_else(|| found(escalate::ENERGY_ERRORS)) {
        Some(ResultValue::Number { value, .. }) => value.as_ref().is_none_or(beyond),
        Some(ResultValue::List(errors)) => errors.iter().any(beyond),
        None => false,
    }
}

/// Results from readings whose zero drift exceeds the allowed value.
fn drifted(read: &[Read<'_>], record: &Record) -> Option<String> {
    let reason = |(procedure, result): &Read<'_>| {
        beyond(record, |beyond| {
            enters(beyond.of_force, procedure.kind, result)
        })
        .map(|beyond| beyond.reason)
    };
    read.iter().find_map(reason)
}

/// The first zero drift beyond its bound that is `of_interest`.
pub(super) fn beyond(record: &Record, of_interest: impl Fn(&Beyond) -> bool) -> Option<Beyond> {
    let drift = record
        .drift
        .as_ref()
        .filter(|_| failpoint::on(Guarding::ZeroDrift))?;
    drift.beyond().find(of_interest)
}

/// Whether readings of the force, or else of the displacement, enter a result. Results that are integrated or fitted depend on both;
/// travels and speeds do not depend on the force.
fn enters(of_force: bool, kind: &str, result: &str) -> bool {
    let given = [impact::TIME_STEP, impact::STEPS];
    let given = given.iter().any(|given| given.name == result);
    let of_travel = [
        (&stiffness_ramp::BLOCK, stiffness_ramp::MAX_DISPLACEMENT),
        (&damping_sweep::BLOCK, damping_sweep::MAX_VELOCITY),
    ];
    let of_travel = of_travel
        .iter()
        .any(|(block, of_travel)| block.words() == kind && of_travel.name == result);
    !(given || (of_force && of_travel))
}
