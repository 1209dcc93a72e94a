//! `escalate`: blows of rising energy on one specimen. In: the blow, its levels, the condition. Out: every blow as an impact
//! of its own, and which was the last that passed. Each decision follows from results, and they from recorded answers.

use super::Performed;
use super::blow::{Blown, Struck};
use super::inputs::Inputs;
use super::results::{measured, result};
use super::session::Session;
use super::stop::Stop;
use super::unload::{MOST_TARGETS, to_rest};
use crate::formula::{ProcedureId, ResultReference, ResultValue, Results};
use crate::plan::{Between, Escalate, Plan};
use crate::quantity::Dimension;
use crate::quantity::display::readable;
use crate::record::{Blow, EscalateHistory, EventKind, History, NamedResult, Rest};
use crate::uncertainty::{Contribution, Source, combined, share};
use crate::verdict::{Verdict, assess_condition};

pub(super) fn perform(plan: &Escalate, whole: &Plan, inputs: &mut Inputs<'_>, session: &mut Session<'_>) -> Performed {
    let mut history = EscalateHistory::default();
    let stop = run(plan, whole, inputs, session, &mut history).err();
    Performed { results: results(&history), history: History::Escalate(history), stop }
}

fn run(
    plan: &Escalate,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
    history: &mut EscalateHistory,
) -> Result<(), Stop> {
    let (mut struck, velocities) = Struck::evaluate(plan, whole, inputs, session)?;
    // As the plan gives them: a square of a root is not always what the root was taken of.
    let energies = plan.energies.as_ref().map(|energies| inputs.list("energies", energies)).transpose()?;
    let home = session.guard.commanded().to_vec();
    let mut done = 0;
    for (index, velocity) in velocities.iter().copied().enumerate() {
        let given = energies.as_ref().and_then(|energies| energies.get(index).copied());
        let energy = given.unwrap_or_else(|| struck.energy(velocity));
        let blown = struck.blow((index, velocity), done, session);
        done += blown.steps;
        let over = blown.stop.is_none();
        let known = OfBlow { own: plan.own, blow: &blown.results, before: inputs.results() };
        let held = over.then(|| {
            plan.condition.iter().all(|part| assess_condition(part, whole.decision_rule, &known).verdict == Verdict::Pass)
        });
        let Blown { results, history: steps, stop, .. } = blown;
        history.blows.push(Blow { velocity, energy, results, history: steps, held, rest: None });
        if let Some(stop) = stop {
            return Err(stop);
        }
        let rest = bring(plan.between, &home, &struck, &mut done, session)?;
        if let Some(blow) = history.blows.last_mut() {
            blow.rest = Some(rest);
        }
        let told = readable(energy, Dimension::ENERGY);
        if held == Some(false) {
            let text = format!("blow {} of {told}: the condition no longer holds", index + 1);
            session.event(EventKind::Remark, text);
            return Ok(());
        }
        if plan.inspect_between && index + 1 < velocities.len() {
            session.inspect(&format!("after blow {} of {told}", index + 1))?;
        }
    }
    session.event(EventKind::Remark, "the condition held after every blow of the list".to_owned());
    Ok(())
}

/// To where the next blow begins.
fn bring(between: Between, home: &[f64], struck: &Struck<'_>, done: &mut u64, session: &mut Session<'_>) -> Result<Rest, Stop> {
    if between == Between::Unload {
        let mut steps = Vec::new();
        let rest = to_rest(struck.unloading(), None, None, *done, session, &mut steps)?;
        // The first is where it began.
        *done += steps.len() as u64 - 1;
        return Ok(rest);
    }
    if between == Between::Home {
        session.go_to_all(home, None)?;
    }
    let reading = session.guard.read()?;
    if between == Between::Home {
        *done += 1;
        let time = session.guard.time();
        session.measured_all(*done, time, &reading)?;
    }
    Ok(Rest { displacement: reading.displacement, force: reading.force })
}

/// Moves from one blow to the next, at most.
pub(super) const fn most_moves(between: Between) -> u64 {
    match between {
        Between::Stay => 0,
        Between::Home => 1,
        Between::Unload => MOST_TARGETS,
    }
}

/// The results of the blow that is just over, by the procedure they will belong to, and those before it.
struct OfBlow<'a> {
    own: ProcedureId,
    blow: &'a [NamedResult],
    before: &'a dyn Results,
}

impl Results for OfBlow<'_> {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        if reference.procedure == self.own {
            return self.blow.iter().find(|result| result.name == reference.name).map(|result| result.value.clone());
        }
        self.before.result(reference)
    }

    fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
        if reference.procedure == self.own {
            let found = self.blow.iter().find(|result| result.name == reference.name);
            return found.map_or_else(Vec::new, |result| result.contributions_of(reference));
        }
        self.before.contributions(reference)
    }

    fn degrees(&self, source: Source) -> f64 {
        self.before.degrees(source)
    }
}

/// The largest of a result of length over all blows, as uncertain as that of its blow.
fn largest(blows: &[Blow], name: &'static str) -> NamedResult {
    let found = blows.iter().filter_map(|blow| Some((blow.number(name)?, blow))).filter(|(value, _)| value.is_finite());
    let most = found.reduce(|most, next| if next.0 > most.0 { next } else { most });
    let parts = most.map_or_else(Vec::new, |(_, blow)| contributions(blow, name));
    told(name, Dimension::LENGTH, most.map(|(value, _)| value), parts)
}

/// The sum of a result of energy over all blows: what they share of their sources adds up before it is squared.
fn sum(blows: &[Blow], name: &'static str, total: Option<f64>) -> NamedResult {
    let mut parts: Vec<Contribution> = Vec::new();
    for part in blows.iter().flat_map(|blow| contributions(blow, name)) {
        share(&mut parts, part);
    }
    told(name, Dimension::ENERGY, total, parts)
}

fn contributions(blow: &Blow, name: &str) -> Vec<Contribution> {
    let found = blow.results.iter().find(|result| result.name == name);
    found.map_or_else(Vec::new, |result| result.contributions.clone())
}

fn told(name: &'static str, dimension: Dimension, value: Option<f64>, contributions: Vec<Contribution>) -> NamedResult {
    let result = measured(name, dimension, value.map(|value| (value, combined(&contributions))));
    NamedResult { contributions, ..result }
}

/// In the order of the reference.
fn results(history: &EscalateHistory) -> Vec<NamedResult> {
    let blows = &history.blows;
    let of = |name: &str| blows.iter().map(|blow| blow.number(name).unwrap_or(f64::NAN)).collect::<Vec<_>>();
    let list =
        |name, dimension, values| NamedResult { name, value: ResultValue::List(values), dimension, contributions: Vec::new() };
    // Each as uncertain as that of its blow.
    let known = |name, dimension, of_blow: &str| {
        let parts = blows
            .iter()
            .enumerate()
            .flat_map(|(entry, blow)| contributions(blow, of_blow).into_iter().map(move |part| Contribution { entry, ..part }));
        NamedResult { contributions: parts.collect(), ..list(name, dimension, of(of_blow)) }
    };
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_BLOWS")]
    let count = |held: Option<bool>| blows.iter().filter(|blow| held.is_none() || blow.held == held).count() as f64;
    let passed = blows.iter().rev().find(|blow| blow.held == Some(true)).map(|blow| blow.energy);
    let failed = blows.iter().find(|blow| blow.held == Some(false)).map(|blow| blow.energy);
    let some = |values: Vec<f64>| values.into_iter().filter(|value| value.is_finite());
    let place = |blow: &Blow| blow.rest_of_struck().map(|(displacement, _)| displacement);
    let rest = blows.last().and_then(place);
    let rests = blows.iter().map(|blow| place(blow).unwrap_or(f64::NAN)).collect();
    let absorbed = some(of("absorbed_energy")).reduce(|sum, energy| sum + energy);
    let mut results = vec![
        result("blows", Dimension::NUMBER, Some(count(None))),
        result("passed", Dimension::NUMBER, Some(count(Some(true)))),
        result("last_passed_energy", Dimension::ENERGY, passed),
        result("first_failed_energy", Dimension::ENERGY, failed),
        largest(blows, "max_displacement"),
        result("residual_displacement", Dimension::LENGTH, rest),
        sum(blows, "absorbed_energy", absorbed),
        list("velocities", Dimension::VELOCITY, blows.iter().map(|blow| blow.velocity).collect()),
        list("blow_energies", Dimension::ENERGY, blows.iter().map(|blow| blow.energy).collect()),
        known("max_displacements", Dimension::LENGTH, "max_displacement"),
        list("residual_displacements", Dimension::LENGTH, rests),
        known("absorbed_energies", Dimension::ENERGY, "absorbed_energy"),
        known("impulses", Dimension::IMPULSE, "impulse"),
        list("energy_errors", Dimension::NUMBER, of("energy_error")),
    ];
    if blows.iter().any(|blow| blow.storey().is_some()) {
        let rest = blows.last().and_then(|blow| blow.rest.as_ref());
        results.extend([
            list("max_drift", Dimension::LENGTH, over_blows(blows, "max_drift", f64::max)),
            list("residual_drift", Dimension::LENGTH, rest.map(Rest::drift).unwrap_or_default()),
            list("storey_energy", Dimension::ENERGY, over_blows(blows, "storey_energy", |sum, next| sum + next)),
        ]);
    }
    results
}

/// A list that every blow has an entry of for each storey, taken together storey by storey.
fn over_blows(blows: &[Blow], name: &str, together: fn(f64, f64) -> f64) -> Vec<f64> {
    let lists = blows.iter().filter_map(|blow| blow.list(name));
    let all =
        lists.map(<[f64]>::to_vec).reduce(|all, next| all.iter().zip(next).map(|(all, next)| together(*all, next)).collect());
    all.unwrap_or_default()
}
