//! Results that were still growing when an impact ended: the largest value is not a peak. In: the steps of an impact, or of an impact
//! series, and a condition that reads their results. Out: the reason why the condition is inconclusive, if further growth would change
//! its verdict. It assesses no condition alone, and does not read the plan.

use std::borrow::Cow;

use super::ConditionOutcome;
use super::assess_condition;
use psd_plan::formula::{
    ProcedureId, ResultPart, ResultReference, ResultValue, Results, UncertaintyStatus,
};
use psd_plan::procedures::escalate::block as series;
use psd_plan::procedures::impact::block as schema;
use psd_plan::procedures::shake::block as shake_schema;
use psd_plan::record::{
    EscalateHistory, FloorMotion, Floors, History, ImpactHistory, SeriesImpact, ShakeHistory,
};
use psd_plan::schema::ResultKind;
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{Condition, DecisionRule};

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
        growth(history, reference.name, name)
    })
}

/// Why this result of a procedure was still growing; None if it was not.
pub(super) fn growing(history: &History, result: &str, name: &str) -> Option<String> {
    growth(history, result, name).map(|growth| growth.why)
}

fn growth(history: &History, result: &str, name: &str) -> Option<Growth> {
    match history {
        History::Impact(history) => of_impact(history, result, name),
        History::Escalate(history) => of_row(history, result, name),
        History::Shake(history) => of_shake(history, result, name),
        _ => None,
    }
}

/// The same for a condition on the last impact of a series. It reads the results of that impact as those of the procedure `own`.
pub(super) fn undecided_by(
    condition: &Condition,
    rule: DecisionRule,
    results: &dyn Results,
    own: ProcedureId,
    impact: &ImpactHistory,
) -> Option<String> {
    hangs_on(condition, rule, results, |reference| {
        (reference.procedure == own)
            .then(|| of_own(impact, reference.name, "the impact"))
            .flatten()
    })
}

/// Whether the verdict depends on the further growth. The growing results are increased up to 10¹² times, in steps of half a decade, the
/// largest first. The steps also detect a change of a condition with a window.
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
    (-12..=24).rev().any(changes).then(|| why.clone())
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
            .find(|(growing, _)| *growing == reference && reference.part == ResultPart::Value);
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

    fn contributions(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
        self.results.contributions(reference)
    }

    fn degrees(&self, source: Source) -> f64 {
        self.results.degrees(source)
    }

    fn moved(&self, source: Source) -> f64 {
        self.results.moved(source)
    }

    fn uncertainty_status(
        &self,
        reference: ResultReference,
        entry: Option<usize>,
    ) -> UncertaintyStatus {
        self.results.uncertainty_status(reference, entry)
    }
}

/// Growth of a result of an impact. A run that continues past a largest value has reached a peak, independent of later values.
fn of_impact(impact: &ImpactHistory, result: &str, name: &str) -> Option<Growth> {
    let frame = impact.frame.as_ref();
    let still = |what: &str, largest: &str| {
        format!("{what} when {name} ended: its largest {largest} is not a peak")
    };
    let number = |growing: bool, what: &str, largest: &str| {
        growing.then(|| Growth {
            entries: vec![0],
            why: still(what, largest),
        })
    };
    let list = |entries: &[usize], what: &str, largest: &str| {
        let entry = entries.first()? + 1;
        Some(Growth {
            why: still(&format!("{what} {entry} was still moving"), largest),
            entries: entries.to_vec(),
        })
    };
    // Until the striker has stopped, the largest force may still come, even if the structure moves back meanwhile.
    let ending = impact.ending;
    if ending.still_striking
        && is(result, &PUSHED)
        && !(is(result, &[schema::MAX_DISPLACEMENT]) && ending.still_rising)
    {
        let what = if ending.touched {
            "the striker was still pushing"
        } else {
            "the striker had not touched the structure yet"
        };
        return Some(Growth {
            entries: (0..floors_of(impact).unwrap_or(1)).collect(),
            why: format!("{what} when {name} ended: the peak is not reached"),
        });
    }
    if is(
        result,
        &[
            schema::MAX_DISPLACEMENT,
            schema::TIME_OF_MAX_DISPLACEMENT,
            schema::ABSORBED_ENERGY,
        ],
    ) {
        number(
            ending.still_rising,
            "the structure was still moving",
            "displacement",
        )
    } else if is(result, &[schema::MAX_VELOCITY]) {
        number(
            ending.speeding_up,
            "the velocity of the structure was still increasing",
            "velocity",
        )
    } else if is(result, &[schema::MAX_CONTACT_FORCE]) {
        let what = "the contact force was still increasing";
        number(ending.pushing_harder, what, "size")
    } else if is(result, &[schema::MAX_BASE_SHEAR]) {
        let what = "the base shear was still increasing";
        let growing = frame.is_some_and(|frame| frame.growing.base_shear);
        number(growing, what, "size")
    } else if is(result, &[schema::FLOOR_DISPLACEMENT]) {
        list(&frame?.growing.floors, "floor", "displacement")
    } else if is(result, &[schema::MAX_DRIFT, schema::MAX_ELEMENT_FORCE]) {
        let frame = frame?;
        let [member, drift] = words(frame.floors.first().map(|step| &step.floors));
        let force = is(result, &[schema::MAX_ELEMENT_FORCE]);
        let largest = if force { "force" } else { drift };
        list(&frame.growing.storeys, member, largest)
    } else {
        None
    }
}

/// Growth of a result of a ground-motion test that a drift ended: every peak may have come later.
fn of_shake(shake: &ShakeHistory, result: &str, name: &str) -> Option<Growth> {
    let number = shake.drift_reached? + 1;
    let peaks = [
        shake_schema::MAX_DISPLACEMENT,
        shake_schema::MAX_DRIFT,
        shake_schema::MAX_BASE_SHEAR,
        shake_schema::MAX_ELEMENT_FORCE,
    ];
    let last = &shake.steps.last()?.floors;
    let [member, drift] = words(Some(last));
    is(result, &peaks).then(|| Growth {
        entries: (0..entries_of(last)).collect(),
        why: format!("the {drift} of {member} {number} ended {name}: the peak is not reached"),
    })
}

/// A storey and its drift, or an element and its deformation.
fn words(floors: Option<&FloorMotion>) -> [&'static str; 2] {
    if floors.is_some_and(Floors::has_elements) {
        ["element", "deformation"]
    } else {
        ["storey", "drift"]
    }
}

/// The most entries that a list of floors, storeys or elements has.
fn entries_of(floors: &FloorMotion) -> usize {
    floors.computed.len().max(floors.elements.len())
}

/// The most entries of a list of a struck frame; None for one degree of freedom.
fn floors_of(impact: &ImpactHistory) -> Option<usize> {
    let last = impact.frame.as_ref()?.floors.last()?;
    Some(entries_of(&last.floors))
}

/// Whether this is the name of one of these results.
fn is(result: &str, kinds: &[ResultKind]) -> bool {
    kinds.iter().any(|kind| kind.name == result)
}

/// Results that a moving striker can still increase.
const PUSHED: [ResultKind; 7] = [
    schema::MAX_DISPLACEMENT,
    schema::TIME_OF_MAX_DISPLACEMENT,
    schema::ABSORBED_ENERGY,
    schema::MAX_BASE_SHEAR,
    schema::FLOOR_DISPLACEMENT,
    schema::MAX_DRIFT,
    schema::MAX_ELEMENT_FORCE,
];

/// Growth of a result of an impact, read by the condition of its series. If the impact ended before its peak, its final position is not
/// determined either.
fn of_own(impact: &ImpactHistory, result: &str, name: &str) -> Option<Growth> {
    let of = |kind: ResultKind| of_impact(impact, kind.name, name);
    if is(
        result,
        &[series::RESIDUAL_DISPLACEMENT, series::FINAL_DISPLACEMENT],
    ) {
        of(schema::MAX_DISPLACEMENT)
    } else if is(result, &[series::RESIDUAL_DRIFT, series::FINAL_DRIFT]) {
        let growth = of(schema::MAX_DISPLACEMENT).or_else(|| of(schema::MAX_DRIFT))?;
        Some(Growth {
            entries: (0..floors_of(impact)?).collect(),
            ..growth
        })
    } else {
        of_impact(impact, result, name)
    }
}

/// Growth of a result of an impact series: results that one impact leaves undetermined. If an inconclusive impact ended the series, this
/// includes the last energy that passed.
fn of_row(history: &EscalateHistory, result: &str, name: &str) -> Option<Growth> {
    let numbered_impacts = || history.impacts.iter().enumerate();
    let of = |(index, impact): (usize, &SeriesImpact), own: ResultKind| {
        of_own(
            &impact.history,
            own.name,
            &format!("impact {} of {name}", index + 1),
        )
    };
    let one = |growth: Growth| Growth {
        entries: vec![0],
        ..growth
    };
    // A list with one entry per impact.
    let by_impact = |own: ResultKind| {
        let found: Vec<(usize, Growth)> = numbered_impacts()
            .filter_map(|(index, impact)| Some((index, of((index, impact), own)?)))
            .collect();
        let why = found.first()?.1.why.clone();
        Some(Growth {
            entries: found.into_iter().map(|(index, _)| index).collect(),
            why,
        })
    };
    // A list with one entry per storey.
    let by_storey = |own: ResultKind| {
        let found: Vec<Growth> = numbered_impacts()
            .filter_map(|impact| of(impact, own))
            .collect();
        let why = found.first()?.why.clone();
        let mut entries: Vec<usize> = found
            .into_iter()
            .flat_map(|growth| growth.entries)
            .collect();
        entries.sort_unstable();
        entries.dedup();
        Some(Growth { entries, why })
    };
    if is(
        result,
        &[series::LAST_PASSED_ENERGY, series::PASSED, series::IMPACTS],
    ) {
        let (index, impact) = numbered_impacts()
            .next_back()
            .filter(|(_, impact)| impact.held.is_none())?;
        let why = of((index, impact), schema::MAX_DISPLACEMENT)
            .or_else(|| of((index, impact), schema::MAX_DRIFT))
            .map(|growth| growth.why);
        let reason = why.map_or_else(String::new, |why| format!(": {why}"));
        return Some(Growth {
            entries: vec![0],
            why: format!(
                "{name} ended with impact {}, which is inconclusive{reason}",
                index + 1
            ),
        });
    }
    // The results of the last impact alone.
    let of_last = [
        series::RESIDUAL_DISPLACEMENT,
        series::RESIDUAL_DRIFT,
        series::FINAL_DISPLACEMENT,
        series::FINAL_DRIFT,
    ];
    if let Some(kind) = of_last.into_iter().find(|kind| kind.name == result) {
        return of(numbered_impacts().next_back()?, kind);
    }
    if is(
        result,
        &[series::RESIDUAL_DISPLACEMENTS, series::FINAL_DISPLACEMENTS],
    ) {
        return by_impact(series::RESIDUAL_DISPLACEMENT);
    }
    let kind = series::BLOCK.result(result)?;
    let of_impact = *kind.made_of?;
    if of_impact.list {
        by_storey(of_impact)
    } else if kind.list {
        by_impact(of_impact)
    } else {
        by_impact(of_impact).map(one)
    }
}
