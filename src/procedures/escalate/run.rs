//! `escalate`: a series of impacts of increasing energy on one specimen. In: the impact, its levels, the condition. Out: every impact, and
//! the last one after which the condition held. Each decision follows from results, and they follow from logged readings.

use std::borrow::Cow;

use super::repeated_impact::RepeatedImpact;
use super::results::{Left, results};
use crate::procedures::common::calibrated_range;
use crate::procedures::common::perturbed_inputs::UncertainRun;
use crate::procedures::common::reached::{of_axes, of_impact};
use crate::procedures::impact::run::ImpactRun;
use crate::procedures::stepping::setting::above_critical;
use crate::procedures::unload::run::{MOST_TARGETS, to_rest, withhold_position};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::verdict::{Declared, Verdict, assess_on_impact};
use psd_physics::structure::Unloading;
use psd_plan::formula::{ProcedureId, ResultReference, ResultValue, Results, UncertaintyStatus};
use psd_plan::procedures::escalate::block as schema;
use psd_plan::record::{EscalateHistory, EventKind, History, NamedResult, Rest, SeriesImpact};
use psd_plan::uncertainty::Contribution;
use psd_plan::{Between, Escalate, Plan};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

pub(crate) fn perform(
    plan: &Escalate,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut history = EscalateHistory::default();
    let stop = run(plan, whole, inputs, session, &mut history).err();
    if stop.is_none() {
        session.remark_again();
    }
    Performed {
        results: results(&history, plan.between),
        history: History::Escalate(history),
        stop,
    }
}

fn run(
    plan: &Escalate,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
    history: &mut EscalateHistory,
) -> Result<(), Stop> {
    let velocities = inputs.list(&schema::SPEEDS, &plan.velocities)?;
    let mut impact = RepeatedImpact::evaluate(plan, &velocities, whole, inputs, session)?;
    // As the plan gives them: in floating point, the square of a root is not always the number itself.
    let energies = plan
        .energies
        .as_ref()
        .map(|energies| inputs.list(&schema::ENERGIES, energies))
        .transpose()?;
    above_critical(impact.steps(), session);
    let home = session.guard.commanded().to_vec();
    let uncertainty = UncertainRun::new(whole, inputs, session.guard.declared_noise());
    let mut done = 0;
    for (index, velocity) in velocities.iter().copied().enumerate() {
        let given = energies
            .as_ref()
            .and_then(|energies| energies.get(index).copied());
        let energy = given.unwrap_or_else(|| impact.energy(velocity));
        let ImpactRun {
            mut results,
            history: steps,
            stop,
        } = impact.strike(index, velocity, done, session);
        // The condition of the series reads these results; the series itself remarks on them.
        let given: calibrated_range::Readings<'_> =
            &|give| of_impact(&steps, &mut of_axes(whole, give));
        calibrated_range::withhold(&whole.rig, home.len(), given, &mut results);
        done += steps.steps.last().map_or(0, |last| last.step);
        history.impacts.push(SeriesImpact {
            velocity,
            energy,
            results,
            history: steps,
            held: None,
            rest: None,
        });
        if let Some(stop) = stop {
            return Err(stop);
        }
        let rest = bring(
            plan.between,
            &home,
            impact.unloading(),
            &uncertainty.of_impact(index),
            &mut done,
            session,
        )?;
        let stated = readable(energy, Dimension::ENERGY);
        if let Some(struck) = history.impacts.last_mut() {
            struck.rest = Some(rest);
            let (held, why) = decide(plan, whole, struck, inputs.results());
            struck.held = held;
            if held != Some(true) {
                session.event(
                    EventKind::Remark,
                    format!("impact {} of {stated} ends the series: {why}", index + 1),
                );
                return Ok(());
            }
        }
        if plan.inspect_between && index + 1 < velocities.len() {
            session.inspect(&format!("after impact {} of {stated}", index + 1))?;
        }
    }
    let conditions: Vec<&str> = plan
        .condition
        .iter()
        .map(|part| part.text.as_str())
        .collect();
    session.event(
        EventKind::Remark,
        format!(
            "{} was true after every impact of the series",
            conditions.join(" and ")
        ),
    );
    Ok(())
}

/// Whether the condition holds after an impact, assessed where the next one begins; None if that is inconclusive. With the part of the
/// condition that ends the series, and why.
fn decide(
    plan: &Escalate,
    whole: &Plan,
    struck: &SeriesImpact,
    before: &dyn Results,
) -> (Option<bool>, String) {
    let of_impact = OfImpact {
        own: plan.own,
        results: as_brought(struck, plan.between),
        before,
    };
    let (rule, known) = (whole.decision_rule, Declared::of(whole, &of_impact));
    let parts = plan
        .condition
        .iter()
        .map(|part| assess_on_impact(part, rule, &known, plan.own, &struck.history));
    let worst = parts.reduce(|worst, next| {
        if next.verdict > worst.verdict {
            next
        } else {
            worst
        }
    });
    match worst {
        Some(part) if part.verdict == Verdict::Inconclusive => {
            let reason = part.reason.unwrap_or_default();
            (None, format!("{} is inconclusive: {reason}", part.text))
        }
        Some(part) if part.verdict != Verdict::Pass => {
            let value = part.value.map_or_else(String::new, |value| {
                format!(", the value is {}", readable(value, part.dimension))
            });
            (Some(false), format!("{} is false{value}", part.text))
        }
        Some(_) | None => (Some(true), String::new()),
    }
}

/// The results of an impact, with the position to which the specimen was brought after it, named as in the results of the series.
fn as_brought(struck: &SeriesImpact, between: Between) -> Vec<NamedResult> {
    let mut results = struck.results.clone();
    let Some(rest) = &struck.rest else {
        return results;
    };
    let left = Left::of(between);
    let [parts, _] = struck.rest_contributions().unwrap_or_default();
    let position = left
        .displacement
        .found_by(struck.rest_of_struck().map(|(position, _)| position), parts);
    let drift = struck.storey().map(|_| {
        left.drift
            .found_list_by(Some(rest.drift()), rest.drift_contributions())
    });
    let mut brought: Vec<NamedResult> = [Some(position), drift].into_iter().flatten().collect();
    withhold_position(Some(rest), &mut brought);
    for brought in brought {
        match results
            .iter_mut()
            .find(|result| result.name == brought.name)
        {
            Some(own) => *own = brought,
            None => results.push(brought),
        }
    }
    results
}

/// Moves the specimen to the start position of the next impact.
fn bring(
    between: Between,
    home: &[f64],
    unloading: &Unloading,
    uncertainty: &UncertainRun<'_>,
    done: &mut u64,
    session: &mut Session<'_>,
) -> Result<Rest, Stop> {
    if between == Between::Unload {
        let mut steps = Vec::new();
        let mut rest = to_rest(unloading.clone(), None, None, *done, session, &mut steps)?;
        uncertainty.unloaded(&mut rest, unloading, &steps);
        // The first step is the start.
        *done += steps.len() as u64 - 1;
        return Ok(rest);
    }
    if between == Between::Home {
        session.go_to_all(home, None)?;
    }
    let (_, reading) = session.floors_at_rest()?;
    if between == Between::Home {
        *done += 1;
        let time = session.guard.time();
        session.measured_all(*done, time, &reading)?;
    }
    let mut rest = Rest {
        displacement: reading.displacement,
        force: reading.force,
        ..Rest::default()
    };
    uncertainty.brought(&mut rest);
    Ok(rest)
}

/// An upper bound of its steps, if the plan alone gives one.
pub(crate) fn most_steps(series: &Escalate, plan: &Plan) -> Option<u64> {
    let steps = series.known_steps_of_an_impact(plan)?;
    let steps = steps.saturating_add(most_moves(series.between));
    Some(steps.saturating_mul(series.velocities.len() as u64))
}

/// Moves between two impacts, at most.
const fn most_moves(between: Between) -> u64 {
    match between {
        Between::Stay => 0,
        Between::Home => 1,
        Between::Unload => MOST_TARGETS,
    }
}

/// The results of the last impact, under the procedure to which they will belong, and those of earlier procedures.
struct OfImpact<'a> {
    own: ProcedureId,
    results: Vec<NamedResult>,
    before: &'a dyn Results,
}

impl Results for OfImpact<'_> {
    fn base(&self) -> Option<&dyn Results> {
        Some(self.before)
    }

    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        if reference.procedure == self.own {
            return NamedResult::of(&self.results, reference.name)
                .map(|result| result.value.clone());
        }
        self.before.result(reference)
    }

    fn contributions(&self, reference: ResultReference) -> Cow<'_, [Contribution]> {
        if reference.procedure == self.own {
            let found = NamedResult::of(&self.results, reference.name);
            return found.map_or_else(Cow::default, |result| result.contributions_of(reference));
        }
        self.before.contributions(reference)
    }

    fn uncertainty_status(
        &self,
        reference: ResultReference,
        entry: Option<usize>,
    ) -> UncertaintyStatus {
        if reference.procedure == self.own {
            return NamedResult::of(&self.results, reference.name)
                .map_or(UncertaintyStatus::Exact, |result| {
                    result.uncertainty_status(IMPACT, entry)
                });
        }
        self.before.uncertainty_status(reference, entry)
    }
}

/// The keyword of one impact.
const IMPACT: &str = "impact";
