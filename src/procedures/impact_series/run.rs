//! `escalate`: blows of rising energy on one specimen. In: the blow, its levels, the condition. Out: every blow as an impact
//! of its own, and which was the last that passed. Each decision follows from results, and they from recorded answers.

use crate::plan::formula::{ProcedureId, ResultReference, ResultValue, Results};
use crate::plan::{Between, Escalate, Plan};
use crate::procedures::impact::one_impact::{Blown, Struck};
use crate::procedures::results::{measured, result};
use crate::procedures::stepping::run::above_critical;
use crate::procedures::unload::run::{MOST_TARGETS, to_rest};
use crate::procedures::unload::uncertainty::RestUncertainty;
use crate::record::{Blow, EscalateHistory, EventKind, History, NamedResult, Rest};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::uncertainty::{Contribution, Source, combined, share};
use crate::units::Dimension;
use crate::units::display::readable;
use crate::verdict::{Declared, Verdict, assess_on_blow};

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
    let (mut struck, velocities) = Struck::evaluate(plan, whole, inputs, session)?;
    // As the plan gives them: a square of a root is not always what the root was taken of.
    let energies = plan
        .energies
        .as_ref()
        .map(|energies| inputs.list("energies", energies))
        .transpose()?;
    let (time_step, critical) = struck.time_steps();
    above_critical(time_step, critical, session);
    let home = session.guard.commanded().to_vec();
    let doubts = RestUncertainty::new(whole, inputs, session);
    let mut done = 0;
    for (index, velocity) in velocities.iter().copied().enumerate() {
        let given = energies
            .as_ref()
            .and_then(|energies| energies.get(index).copied());
        let energy = given.unwrap_or_else(|| struck.energy(velocity));
        let blown = struck.blow((index, velocity), done, session);
        done += blown.steps;
        let Blown {
            results,
            history: steps,
            stop,
            ..
        } = blown;
        history.blows.push(Blow {
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
            (&struck, &doubts.of_blow(index)),
            &mut done,
            session,
        )?;
        let told = readable(energy, Dimension::ENERGY);
        if let Some(blow) = history.blows.last_mut() {
            blow.rest = Some(rest);
            let (held, reason) = decide(plan, whole, blow, inputs.results());
            blow.held = held;
            let ends = match held {
                Some(true) => None,
                Some(false) => Some("the condition no longer holds".to_owned()),
                None => Some(format!("it decides nothing: {reason}")),
            };
            if let Some(why) = ends {
                session.event(
                    EventKind::Remark,
                    format!("blow {} of {told}: {why}", index + 1),
                );
                return Ok(());
            }
        }
        if plan.inspect_between && index + 1 < velocities.len() {
            session.inspect(&format!("after blow {} of {told}", index + 1))?;
        }
    }
    session.event(
        EventKind::Remark,
        "the condition held after every blow of the list".to_owned(),
    );
    Ok(())
}

/// Whether the condition holds after a blow, decided once the specimen is where the next one begins; else why that is not known.
fn decide(
    plan: &Escalate,
    whole: &Plan,
    blow: &Blow,
    before: &dyn Results,
) -> (Option<bool>, String) {
    let of_blow = OfBlow {
        own: plan.own,
        results: as_brought(blow, plan.between),
        before,
    };
    let (rule, known) = (whole.decision_rule, Declared::of(whole, &of_blow));
    let parts = plan
        .condition
        .iter()
        .map(|part| assess_on_blow(part, rule, &known, (plan.own, &blow.history)));
    let worst = parts.reduce(|worst, next| {
        if next.verdict > worst.verdict {
            next
        } else {
            worst
        }
    });
    match worst {
        Some(part) if part.verdict == Verdict::Inconclusive => {
            (None, part.reason.unwrap_or_default())
        }
        Some(part) => (Some(part.verdict == Verdict::Pass), String::new()),
        None => (Some(true), String::new()),
    }
}

/// The results of a blow, with where the specimen was brought to after it, as the results of the row name it.
fn as_brought(blow: &Blow, between: Between) -> Vec<NamedResult> {
    let mut results = blow.results.clone();
    let Some(rest) = &blow.rest else {
        return results;
    };
    let left = Left::of(between);
    let [parts, _] = blow.doubts_of_rest().unwrap_or_default();
    let place = told(
        left.displacement,
        Dimension::LENGTH,
        blow.rest_of_struck().map(|(place, _)| place),
        parts,
    );
    let drift = blow.storey().map(|_| {
        list(
            left.drift,
            Dimension::LENGTH,
            rest.drift(),
            rest.doubts_of_drifts(),
        )
    });
    for brought in [Some(place), drift].into_iter().flatten() {
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

/// What the place is called where a blow leaves the specimen: a residual one only where the load is off.
struct Left {
    displacement: &'static str,
    displacements: &'static str,
    drift: &'static str,
}

impl Left {
    const fn of(between: Between) -> Self {
        match between {
            Between::Unload => Self {
                displacement: "residual_displacement",
                displacements: "residual_displacements",
                drift: "residual_drift",
            },
            Between::Home | Between::Stay => Self {
                displacement: "final_displacement",
                displacements: "final_displacements",
                drift: "final_drift",
            },
        }
    }
}

/// To where the next blow begins.
fn bring(
    between: Between,
    home: &[f64],
    (struck, doubts): (&Struck<'_>, &RestUncertainty<'_>),
    done: &mut u64,
    session: &mut Session<'_>,
) -> Result<Rest, Stop> {
    if between == Between::Unload {
        let mut steps = Vec::new();
        let unloading = struck.unloading();
        let mut rest = to_rest(unloading.clone(), None, None, *done, session, &mut steps)?;
        doubts.unloaded(&mut rest, &unloading, &steps);
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
    let mut rest = Rest {
        displacement: reading.displacement,
        force: reading.force,
        ..Rest::default()
    };
    doubts.brought(&mut rest);
    Ok(rest)
}

/// Moves from one blow to the next, at most.
pub(crate) const fn most_moves(between: Between) -> u64 {
    match between {
        Between::Stay => 0,
        Between::Home => 1,
        Between::Unload => MOST_TARGETS,
    }
}

/// The results of the blow that is just over, by the procedure they will belong to, and those before it.
struct OfBlow<'a> {
    own: ProcedureId,
    results: Vec<NamedResult>,
    before: &'a dyn Results,
}

impl Results for OfBlow<'_> {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        if reference.procedure == self.own {
            return self
                .results
                .iter()
                .find(|result| result.name == reference.name)
                .map(|result| result.value.clone());
        }
        self.before.result(reference)
    }

    fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
        if reference.procedure == self.own {
            let found = self
                .results
                .iter()
                .find(|result| result.name == reference.name);
            return found.map_or_else(Vec::new, |result| result.contributions_of(reference));
        }
        self.before.contributions(reference)
    }

    fn degrees(&self, source: Source) -> f64 {
        self.before.degrees(source)
    }

    fn no_uncertainty(&self, reference: ResultReference) -> Option<String> {
        if reference.procedure == self.own {
            return self
                .results
                .iter()
                .find(|result| result.name == reference.name)?
                .no_uncertainty(IMPACT);
        }
        self.before.no_uncertainty(reference)
    }
}

/// What a blow is a procedure of.
const IMPACT: &str = "impact";

/// The largest of a result of length over all blows, as uncertain as that of its blow.
fn largest(blows: &[Blow], name: &'static str) -> NamedResult {
    let found = blows
        .iter()
        .filter_map(|blow| Some((blow.number(name)?, blow)))
        .filter(|(value, _)| value.is_finite());
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

fn told(
    name: &'static str,
    dimension: Dimension,
    value: Option<f64>,
    contributions: Vec<Contribution>,
) -> NamedResult {
    let result = measured(
        name,
        dimension,
        value.map(|value| (value, combined(&contributions))),
    );
    NamedResult {
        contributions,
        ..result
    }
}

/// In the order of the reference.
fn results(history: &EscalateHistory, between: Between) -> Vec<NamedResult> {
    let blows = &history.blows;
    let left = Left::of(between);
    // Each as uncertain as that of its blow.
    let known = |name, dimension, of_blow: &str| {
        list(
            name,
            dimension,
            of(blows, of_blow),
            by_blow(blows, |blow| contributions(blow, of_blow)),
        )
    };
    let unknown =
        |name, dimension, of_blow: &str| list(name, dimension, of(blows, of_blow), Vec::new());
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_BLOWS")]
    let count = |held: Option<bool>| {
        blows
            .iter()
            .filter(|blow| held.is_none() || blow.held == held)
            .count() as f64
    };
    let energy = |name, blow: Option<&Blow>, without: Option<f64>| {
        let parts = blow.map_or_else(Vec::new, |blow| contributions(blow, "striker_energy"));
        told(
            name,
            Dimension::ENERGY,
            blow.map(|blow| blow.energy).or(without),
            parts,
        )
    };
    let passed = blows.iter().rev().find(|blow| blow.held == Some(true));
    let failed = blows.iter().find(|blow| blow.held == Some(false));
    // What the first blow breaks has withstood nothing; what it left undecided is not known.
    let nothing = blows
        .first()
        .filter(|first| first.held == Some(false))
        .map(|_| 0.0);
    let some = |values: Vec<f64>| values.into_iter().filter(|value| value.is_finite());
    let place = |blow: &Blow| blow.rest_of_struck().map(|(displacement, _)| displacement);
    let doubts_of_place = |blow: &Blow| {
        blow.doubts_of_rest()
            .map_or_else(Vec::new, |[place, _]| place)
    };
    let last = blows.last();
    let absorbed = some(of(blows, "absorbed_energy")).reduce(|sum, energy| sum + energy);
    let rests = blows
        .iter()
        .map(|blow| place(blow).unwrap_or(f64::NAN))
        .collect();
    let mut results = vec![
        result("blows", Dimension::NUMBER, Some(count(None))),
        result("passed", Dimension::NUMBER, Some(count(Some(true)))),
        energy("last_passed_energy", passed, nothing),
        energy("first_failed_energy", failed, None),
        largest(blows, "max_displacement"),
        told(
            left.displacement,
            Dimension::LENGTH,
            last.and_then(place),
            last.map_or_else(Vec::new, doubts_of_place),
        ),
        sum(blows, "absorbed_energy", absorbed),
        list(
            "velocities",
            Dimension::VELOCITY,
            blows.iter().map(|blow| blow.velocity).collect(),
            by_blow(blows, of_velocity),
        ),
        list(
            "blow_energies",
            Dimension::ENERGY,
            blows.iter().map(|blow| blow.energy).collect(),
            by_blow(blows, |blow| contributions(blow, "striker_energy")),
        ),
        known("max_displacements", Dimension::LENGTH, "max_displacement"),
        list(
            left.displacements,
            Dimension::LENGTH,
            rests,
            by_blow(blows, doubts_of_place),
        ),
        known("absorbed_energies", Dimension::ENERGY, "absorbed_energy"),
        known("impulses", Dimension::IMPULSE, "impulse"),
        unknown("energy_errors", Dimension::NUMBER, "energy_error"),
    ];
    if blows.iter().any(|blow| blow.storey().is_some()) {
        let rest = last.and_then(|blow| blow.rest.as_ref());
        let (drift, doubts) = rest
            .map(|rest| (rest.drift(), rest.doubts_of_drifts()))
            .unwrap_or_default();
        results.extend([
            largest_of_storeys(blows, "max_drift"),
            list(left.drift, Dimension::LENGTH, drift, doubts),
            sum_of_storeys(blows, "storey_energy"),
        ]);
    }
    results
}

const fn list(
    name: &'static str,
    dimension: Dimension,
    values: Vec<f64>,
    contributions: Vec<Contribution>,
) -> NamedResult {
    NamedResult {
        name,
        value: ResultValue::List(values),
        dimension,
        contributions,
    }
}

/// A number of every blow; NaN where a blow does not have it.
fn of(blows: &[Blow], name: &str) -> Vec<f64> {
    blows
        .iter()
        .map(|blow| blow.number(name).unwrap_or(f64::NAN))
        .collect()
}

/// What is uncertain of a list with an entry for each blow.
fn by_blow(blows: &[Blow], of_blow: impl Fn(&Blow) -> Vec<Contribution>) -> Vec<Contribution> {
    let of_entry = |(entry, blow)| {
        of_blow(blow)
            .into_iter()
            .map(move |part| Contribution { entry, ..part })
    };
    blows.iter().enumerate().flat_map(of_entry).collect()
}

/// E = ½ Ms V0²: what the velocity alone does to the energy is 2E/V0 times what it does to itself.
fn of_velocity(blow: &Blow) -> Vec<Contribution> {
    let parts = contributions(blow, "striker_energy").into_iter();
    let of_speed = parts.filter(|part| matches!(part.source, Source::StrikerVelocity(_)));
    of_speed
        .map(|part| Contribution {
            amount: part.amount * 0.5 * blow.velocity / blow.energy,
            ..part
        })
        .collect()
}

/// The largest of each storey over all blows, as uncertain as that of its blow.
fn largest_of_storeys(blows: &[Blow], name: &'static str) -> NamedResult {
    let lists: Vec<(&[f64], &Blow)> = blows
        .iter()
        .filter_map(|blow| Some((blow.list(name)?, blow)))
        .collect();
    let storeys = lists.first().map_or(0, |(values, _)| values.len());
    let (mut values, mut parts) = (Vec::new(), Vec::new());
    for storey in 0..storeys {
        let largest = lists.iter().reduce(|most, next| {
            if next.0[storey] > most.0[storey] {
                next
            } else {
                most
            }
        });
        let Some((found, blow)) = largest else {
            continue;
        };
        values.push(found[storey]);
        parts.extend(
            contributions(blow, name)
                .into_iter()
                .filter(|part| part.entry == storey),
        );
    }
    list(name, Dimension::LENGTH, values, parts)
}

/// The sum of each storey over all blows: what they share of their sources adds up before it is squared.
fn sum_of_storeys(blows: &[Blow], name: &'static str) -> NamedResult {
    let lists = blows.iter().filter_map(|blow| blow.list(name));
    let sum = lists
        .map(<[f64]>::to_vec)
        .reduce(|sum, next| sum.iter().zip(next).map(|(sum, next)| sum + next).collect());
    let mut parts: Vec<Contribution> = Vec::new();
    blows
        .iter()
        .flat_map(|blow| contributions(blow, name))
        .for_each(|part| share(&mut parts, part));
    list(name, Dimension::ENERGY, sum.unwrap_or_default(), parts)
}
