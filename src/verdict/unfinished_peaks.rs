//! Results that were still growing when an impact ended: the largest value is not a peak. In: the steps of an impact, or of an impact
//! series, and a condition that reads their results. Out: the reason why the condition is inconclusive, if further growth would change
//! its verdict. It assesses no condition alone, and does not read the plan.

use super::ConditionOutcome;
use super::assess_condition;
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference, ResultValue, Results};
use psd_plan::procedures::{escalate, impact, shake};
use psd_plan::record::{
    EscalateHistory, FloorMotion, Floors, History, ImpactHistory, Integrated, SeriesImpact,
    ShakeHistory,
};
use psd_plan::schema::{BlockKind, Peak, ResultKind};
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
    match history.integrated()? {
        Integrated::Impact(history) => {
            of_impact(history, peak_of(&impact::block::BLOCK, result)?, name)
        }
        Integrated::Impacts(history) => {
            of_series(history, escalate::block::BLOCK.result(result)?, name)
        }
        Integrated::GroundMotion(history) => {
            peak_of(&shake::block::BLOCK, result)?;
            of_shake(history, name)
        }
    }
}

/// The peak on which a result of this block depends.
fn peak_of(block: &BlockKind, result: &str) -> Option<Peak> {
    block.result(result)?.peak
}

/// The peak on which a result depends that the condition of a series reads: the position after an impact, or a result of the impact.
fn peak_read(result: &str) -> Option<Peak> {
    let own = peak_of(&escalate::block::BLOCK, result);
    own.or_else(|| peak_of(&impact::block::BLOCK, result))
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
            .then(|| of_impact(impact, peak_read(reference.name)?, "the impact"))
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
    fn base(&self) -> Option<&dyn Results> {
        Some(self.results)
    }

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
}

/// Growth towards a peak of an impact. A run that continues past a largest value has reached a peak, independent of later values.
fn of_impact(impact: &ImpactHistory, peak: Peak, name: &str) -> Option<Growth> {
    let frame = impact.frame.as_ref();
    let ending = impact.ending;
    let of = |peak: Peak| of_impact(impact, peak, name);
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
    let moving = || {
        let what = "the structure was still moving";
        number(ending.still_rising, what, "displacement")
    };
    // Until the striker has stopped, the largest force may still come, even if the structure moves back meanwhile.
    let pushed = || {
        let what = if ending.touched {
            "the striker was still pushing"
        } else {
            "the striker had not touched the structure yet"
        };
        ending.still_striking.then(|| Growth {
            entries: (0..floors_of(impact).unwrap_or(1)).collect(),
            why: format!("{what} when {name} ended: the peak is not reached"),
        })
    };
    let members = |force: Option<&str>| {
        let frame = frame?;
        let [member, drift] = words(frame.floors.first().map(|step| &step.floors));
        list(&frame.growing.storeys, member, force.unwrap_or(drift))
    };
    match peak {
        Peak::Displacement => moving().or_else(pushed),
        Peak::InstantOfDisplacement => pushed().or_else(moving),
        Peak::Velocity => {
            let what = "the velocity of the structure was still increasing";
            number(ending.speeding_up, what, "velocity")
        }
        Peak::ContactForce => {
            let what = "the contact force was still increasing";
            number(ending.pushing_harder, what, "size")
        }
        Peak::BaseShear => pushed().or_else(|| {
            let growing = frame.is_some_and(|frame| frame.growing.base_shear);
            number(growing, "the base shear was still increasing", "size")
        }),
        Peak::FloorDisplacement => {
            pushed().or_else(|| list(&frame?.growing.floors, "floor", "displacement"))
        }
        Peak::Drift => pushed().or_else(|| members(None)),
        Peak::ElementForce => pushed().or_else(|| members(Some("force"))),
        // If the impact ended before its peak, its final position is not determined either.
        Peak::PositionAfter => of(Peak::Displacement),
        Peak::DriftAfter => {
            let growth = of(Peak::LastImpact)?;
            Some(Growth {
                entries: (0..floors_of(impact)?).collect(),
                ..growth
            })
        }
        Peak::LastImpact => of(Peak::Displacement).or_else(|| of(Peak::Drift)),
    }
}

/// Growth towards the peaks of a ground-motion test that a drift ended: every peak may have come later.
fn of_shake(shake: &ShakeHistory, name: &str) -> Option<Growth> {
    let number = shake.drift_reached? + 1;
    let last = &shake.steps.last()?.floors;
    let [member, drift] = words(Some(last));
    Some(Growth {
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

/// Growth of a result of an impact series: results that one impact leaves undetermined. If an inconclusive impact ended the series, this
/// includes the last energy that passed.
fn of_series(history: &EscalateHistory, kind: &ResultKind, name: &str) -> Option<Growth> {
    let numbered_impacts = || history.impacts.iter().enumerate();
    let of = |(index, impact): (usize, &SeriesImpact), peak: Peak| {
        of_impact(
            &impact.history,
            peak,
            &format!("impact {} of {name}", index + 1),
        )
    };
    // A list with one entry per impact.
    let by_impact = |peak: Peak| {
        let found: Vec<(usize, Growth)> = numbered_impacts()
            .filter_map(|(index, impact)| Some((index, of((index, impact), peak)?)))
            .collect();
        let why = found.first()?.1.why.clone();
        Some(Growth {
            entries: found.into_iter().map(|(index, _)| index).collect(),
            why,
        })
    };
    // A list with one entry per storey.
    let by_storey = |peak: Peak| {
        let found: Vec<Growth> = numbered_impacts()
            .filter_map(|impact| of(impact, peak))
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
    match (kind.peak, kind.made_of) {
        (Some(Peak::LastImpact), _) => {
            let (index, impact) = numbered_impacts()
                .next_back()
                .filter(|(_, impact)| impact.held.is_none())?;
            let why = of((index, impact), Peak::LastImpact).map(|growth| growth.why);
            let reason = why.map_or_else(String::new, |why| format!(": {why}"));
            Some(Growth {
                entries: vec![0],
                why: format!(
                    "{name} ended with impact {}, which is inconclusive{reason}",
                    index + 1
                ),
            })
        }
        (Some(Peak::PositionAfter), _) if kind.list => by_impact(Peak::PositionAfter),
        // Otherwise a result of the last impact alone.
        (Some(peak), _) => of(numbered_impacts().next_back()?, peak),
        (None, Some(of_impact)) if of_impact.list => by_storey(of_impact.peak?),
        (None, Some(of_impact)) if kind.list => by_impact(of_impact.peak?),
        (None, Some(of_impact)) => by_impact(of_impact.peak?).map(|growth| Growth {
            entries: vec![0],
            ..growth
        }),
        (None, None) => None,
    }
}
