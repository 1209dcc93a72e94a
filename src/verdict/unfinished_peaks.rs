//! Results that were still growing when an impact ended: the largest value is not a peak. In: the steps of an impact, or of an impact
//! series, and a condition that reads their results. Out: the reason why the condition is inconclusive, if further growth would change
//! its verdict. It assesses no condition alone, and does not read the plan.

use super::ConditionOutcome;
use super::condition::assess_condition;
use crate::plan::formula::{Part, ProcedureId, ResultReference, ResultValue, Results};
use crate::plan::{Condition, DecisionRule};
use crate::record::{Blow, EscalateHistory, FloorStep, Floors, History, ImpactHistory};
use crate::uncertainty::{Contribution, Source};

/// The part of one result that may have grown further, and the reason.
#[derive(Clone, Debug, PartialEq)]
struct Growth {
    /// The entries of a list; entry 0 for a number.
    entries: Vec<usize>,
    why: String,
}

/// The reason why a condition is inconclusive: a result that it reads was still growing, and the verdict depends on the further growth.
/// Such a largest value cannot show that a bound is satisfied; it can show that a bound is exceeded.
pub(super) fn undecided<'a>(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
    history_of: impl Fn(ProcedureId) -> Option<(&'a History, &'a str)>,
) -> Option<String> {
    hangs_on(condition, rule, results, |reference| {
        let (history, name) = history_of(reference.procedure)?;
        match history {
            History::Impact(history) => of_blow(Steps::of(history), reference.name, name),
            History::Escalate(history) => of_row(history, reference.name, name),
            _ => None,
        }
    })
}

/// The same for a condition on the last impact of a series. It reads the results of that impact as those of the procedure `own`.
pub(super) fn undecided_by(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
    (own, blow): (ProcedureId, &ImpactHistory),
) -> Option<String> {
    hangs_on(condition, rule, results, |reference| {
        (reference.procedure == own)
            .then(|| of_own(Steps::of(blow), reference.name, "the blow"))
            .flatten()
    })
}

/// Whether the verdict depends on the further growth. The growing results are increased up to 10¹² times, in steps of half a decade. The
/// steps also detect a change of a condition with a window.
fn hangs_on(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
    growth_of: impl Fn(ResultReference) -> Option<Growth>,
) -> Option<String> {
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    let growing: Vec<(ResultReference, Growth)> = references
        .iter()
        .filter_map(|reference| Some((*reference, growth_of(*reference)?)))
        .collect();
    let (_, Growth { why, .. }) = growing.first()?;
    let ConditionOutcome {
        verdict: now,
        value,
        ..
    } = assess_condition(condition, rule, results);
    if value.is_none() {
        return Some(why.clone());
    }
    let changes = |half_decade: i32| {
        let by = 10_f64.powf(0.5 * f64::from(half_decade));
        assess_condition(
            condition,
            rule,
            &Grown {
                results,
                growing: &growing,
                by,
            },
        )
        .verdict
            != now
    };
    (-12..=24).any(changes).then(|| why.clone())
}

/// The results after further growth.
struct Grown<'a> {
    results: &'a dyn Results,
    growing: &'a [(ResultReference, Growth)],
    /// As a fraction of the result.
    by: f64,
}

/// Smaller than any relevant value of a test, SI: a result of 0 may grow, too.
const LEAST: f64 = 1e-9;

impl Results for Grown<'_> {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let mut found = self.results.result(reference)?;
        let growing = self
            .growing
            .iter()
            .find(|(growing, _)| *growing == reference && reference.part == Part::Value);
        if let Some((_, growth)) = growing {
            let grow = |value: &mut f64| *value += self.by * value.abs().max(LEAST);
            match &mut found {
                ResultValue::Number { value, .. } => value.iter_mut().for_each(grow),
                ResultValue::List(values) => {
                    growth
                        .entries
                        .iter()
                        .for_each(|entry| values.get_mut(*entry).into_iter().for_each(grow));
                }
            }
        }
        Some(found)
    }

    fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
        self.results.contributions(reference)
    }

    fn degrees(&self, source: Source) -> f64 {
        self.results.degrees(source)
    }

    fn moved(&self, source: Source) -> f64 {
        self.results.moved(source)
    }

    fn no_uncertainty(&self, reference: ResultReference) -> Option<String> {
        self.results.no_uncertainty(reference)
    }
}

/// The steps of an impact; for a frame also the steps of its floors.
#[derive(Clone, Copy)]
struct Steps<'a> {
    impact: &'a ImpactHistory,
    floors: &'a [FloorStep],
}

impl<'a> Steps<'a> {
    fn of(impact: &'a ImpactHistory) -> Self {
        Self {
            impact,
            floors: impact.frame.as_ref().map_or(&[], |frame| &frame.floors),
        }
    }
}

/// Growth of a result of an impact. A run that continues past a largest value has reached a peak, independent of later values.
fn of_blow(Steps { impact, floors }: Steps<'_>, result: &str, name: &str) -> Option<Growth> {
    let number = |growing: bool, why: String| {
        growing.then_some(Growth {
            entries: vec![0],
            why,
        })
    };
    let still = |what: &str, largest: &str| {
        format!("{what} as {name} ended: its largest {largest} is no peak")
    };
    let last_largest = |values: &mut dyn Iterator<Item = f64>| {
        let values: Vec<f64> = values.collect();
        values
            .split_last()
            .is_some_and(|(last, before)| *last > 0.0 && before.iter().all(|value| value < last))
    };
    let list = |of: fn(&FloorStep) -> Vec<f64>,
                rate: fn(&FloorStep) -> Vec<f64>,
                what: &str,
                largest: &str| {
        let entries = growing_entries(floors, of, rate);
        let place = entries.first()? + 1;
        Some(Growth {
            why: still(&format!("{what} {place} was still moving on"), largest),
            entries,
        })
    };
    // Until the striker has stopped, the largest force may still come, even if the structure moves back meanwhile.
    let under_way = impact.steps.len() > 1
        && impact.steps[1..]
            .iter()
            .all(|step| step.striker_velocity > 0.0);
    if under_way
        && PUSHED.contains(&result)
        && !(result == "max_displacement" && impact.still_rising())
    {
        let entries = (0..floors.last().map_or(1, |floor| floor.computed.len())).collect();
        let touched = impact.steps.iter().any(|step| step.contact_force > 0.0);
        let what = if touched {
            "the striker was still pushing on"
        } else {
            "the striker had touched nothing"
        };
        return Some(Growth {
            entries,
            why: format!("{what} as {name} ended: the largest is yet to come"),
        });
    }
    match result {
        "max_displacement" | "time_of_max_displacement" | "absorbed_energy" => number(
            impact.still_rising(),
            still("the structure was still moving on", "displacement"),
        ),
        "max_velocity" => {
            let growing = last_largest(&mut impact.steps.iter().map(|step| step.velocity.abs()));
            number(
                growing,
                still("the structure was still gaining speed", "velocity"),
            )
        }
        "max_contact_force" => {
            let growing = last_largest(&mut impact.steps.iter().map(|step| step.contact_force));
            number(
                growing,
                still("the contact force was still growing", "size"),
            )
        }
        "max_base_shear" => {
            let growing = last_largest(
                &mut floors
                    .iter()
                    .map(|floor| floor.restoring_force.iter().sum::<f64>().abs()),
            );
            number(growing, still("the base shear was still growing", "size"))
        }
        "floor_displacement" => list(
            |floor| floor.computed.clone(),
            |floor| floor.velocity.clone(),
            "floor",
            "displacement",
        ),
        "max_drift" => list(Floors::drift, drift_rate, "storey", "drift"),
        _ => None,
    }
}

/// Results that a moving striker can still increase.
const PUSHED: [&str; 6] = [
    "max_displacement",
    "time_of_max_displacement",
    "absorbed_energy",
    "max_base_shear",
    "floor_displacement",
    "max_drift",
];

fn drift_rate(floor: &FloorStep) -> Vec<f64> {
    let mut rate = vec![0.0; floor.velocity.len()];
    crate::physics::structure::drifts(&floor.velocity, &mut rate);
    rate
}

/// Entries whose absolute value was the largest at the last step and was still increasing.
fn growing_entries(
    floors: &[FloorStep],
    of: fn(&FloorStep) -> Vec<f64>,
    rate: fn(&FloorStep) -> Vec<f64>,
) -> Vec<usize> {
    let Some((last, before)) = floors.split_last() else {
        return Vec::new();
    };
    let (value, rate) = (of(last), rate(last));
    let mut growing: Vec<usize> = (0..value.len())
        .filter(|entry| value[*entry] * rate[*entry] > 0.0)
        .collect();
    for floor in before {
        let earlier = of(floor);
        growing.retain(|entry| earlier[*entry].abs() <= value[*entry].abs());
    }
    growing
}

/// Growth of a result of an impact, read by the condition of its series. If the impact ended before its peak, its final position is not
/// determined either.
fn of_own(steps: Steps<'_>, result: &str, name: &str) -> Option<Growth> {
    match result {
        "residual_displacement" | "final_displacement" => of_blow(steps, "max_displacement", name),
        "residual_drift" | "final_drift" => {
            let growth = of_blow(steps, "max_displacement", name)
                .or_else(|| of_blow(steps, "max_drift", name))?;
            Some(Growth {
                entries: (0..steps.floors.last()?.computed.len()).collect(),
                ..growth
            })
        }
        result => of_blow(steps, result, name),
    }
}

/// Growth of a result of an impact series: results that one impact leaves undetermined. If an inconclusive impact ended the series, this
/// includes the last energy that passed.
fn of_row(history: &EscalateHistory, result: &str, name: &str) -> Option<Growth> {
    let blows = || history.blows.iter().enumerate();
    let of = |(index, blow): (usize, &Blow), own: &str| {
        of_own(
            Steps::of(&blow.history),
            own,
            &format!("blow {} of {name}", index + 1),
        )
    };
    let one = |growth: Growth| Growth {
        entries: vec![0],
        ..growth
    };
    // A list with one entry per impact.
    let by_blow = |own: &str| {
        let found: Vec<(usize, Growth)> = blows()
            .filter_map(|(index, blow)| Some((index, of((index, blow), own)?)))
            .collect();
        let why = found.first()?.1.why.clone();
        Some(Growth {
            entries: found.into_iter().map(|(index, _)| index).collect(),
            why,
        })
    };
    match result {
        "last_passed_energy" | "passed" | "blows" => {
            let (index, blow) = blows()
                .next_back()
                .filter(|(_, blow)| blow.held.is_none())?;
            let why = of((index, blow), "max_displacement")
                .or_else(|| of((index, blow), "max_drift"))
                .map(|growth| growth.why);
            let reason = why.map_or_else(String::new, |why| format!(": {why}"));
            Some(Growth {
                entries: vec![0],
                why: format!(
                    "{name} ended with blow {}, which decided nothing{reason}",
                    index + 1
                ),
            })
        }
        "max_displacement" | "absorbed_energy" => by_blow(result).map(one),
        "max_displacements" => by_blow("max_displacement"),
        "absorbed_energies" => by_blow("absorbed_energy"),
        "residual_displacements" | "final_displacements" => by_blow("residual_displacement"),
        "residual_displacement" | "residual_drift" | "final_displacement" | "final_drift" => {
            of(blows().next_back()?, result)
        }
        "max_drift" => {
            let found: Vec<Growth> = blows().filter_map(|blow| of(blow, result)).collect();
            let why = found.first()?.why.clone();
            let mut entries: Vec<usize> = found
                .into_iter()
                .flat_map(|growth| growth.entries)
                .collect();
            entries.sort_unstable();
            entries.dedup();
            Some(Growth { entries, why })
        }
        _ => None,
    }
}
