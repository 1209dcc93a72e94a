//! The results of a series of impacts: those of each impact, their maxima and sums. In: its history. Out: results in the order of the
//! reference, with their contributions. It moves nothing.

use psd_plan::Between;
use psd_plan::procedures::escalate::block as schema;
use psd_plan::procedures::impact::block as impact;
use psd_plan::record::{EscalateHistory, NamedResult, SeriesImpact};
use psd_plan::schema::ResultKind;
use psd_plan::uncertainty::{Contribution, Source, share};

/// In the order of the reference.
pub(crate) fn results(history: &EscalateHistory, between: Between) -> Vec<NamedResult> {
    let impacts = &history.impacts;
    let left = Left::of(between);
    let mut results = of_series(impacts, &left);
    results.extend(of_impacts(impacts, &left));
    if impacts.iter().any(|impact| impact.storey().is_some()) {
        results.extend(of_storeys(impacts, &left));
    }
    for result in &mut results {
        withhold(result, impacts, &left);
    }
    results
}

/// Withholds the uncertainty of a result of the series if that of one of its impacts, or of the
/// position after it, is withheld.
fn withhold(result: &mut NamedResult, impacts: &[SeriesImpact], left: &Left) {
    let is = |kind: ResultKind| kind.name == result.name;
    let incomplete = |impact: &SeriesImpact| impact.rest.as_ref()?.incomplete.clone();
    let reason = if is(left.displacement) || is(left.drift) {
        impacts.last().and_then(incomplete)
    } else if is(left.displacements) {
        impacts.iter().find_map(incomplete)
    } else {
        let of_impact = schema::BLOCK.result(result.name);
        of_impact.and_then(|kind| kind.made_of).and_then(|kind| {
            let own = |impact: &SeriesImpact| impact.result(kind.name)?.withheld.clone();
            impacts.iter().find_map(own)
        })
    };
    if let Some(reason) = reason {
        result.withhold(&reason);
    }
}

/// The results for the position in which an impact leaves the specimen: residual only where it is unloaded.
pub(crate) struct Left {
    pub displacement: ResultKind,
    pub displacements: ResultKind,
    pub drift: ResultKind,
}

impl Left {
    pub(crate) const fn of(between: Between) -> Self {
        match between {
            Between::Unload => Self {
                displacement: schema::RESIDUAL_DISPLACEMENT,
                displacements: schema::RESIDUAL_DISPLACEMENTS,
                drift: schema::RESIDUAL_DRIFT,
            },
            Between::Home | Between::Stay => Self {
                displacement: schema::FINAL_DISPLACEMENT,
                displacements: schema::FINAL_DISPLACEMENTS,
                drift: schema::FINAL_DRIFT,
            },
        }
    }
}

/// Results of the series as a whole.
fn of_series(impacts: &[SeriesImpact], left: &Left) -> Vec<NamedResult> {
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_IMPACTS")]
    let count = |held: Option<bool>| {
        impacts
            .iter()
            .filter(|impact| held.is_none() || impact.held == held)
            .count() as f64
    };
    let energy = |kind: ResultKind, impact: Option<&SeriesImpact>, without: Option<f64>| {
        let parts = impact.map_or_else(Vec::new, |impact| {
            contributions(impact, impact::STRIKER_ENERGY)
        });
        kind.found_by(impact.map(|impact| impact.energy).or(without), parts)
    };
    let passed = impacts
        .iter()
        .rev()
        .find(|impact| impact.held == Some(true));
    let failed = impacts.iter().find(|impact| impact.held == Some(false));
    // If the condition fails after the first impact, no energy was withstood; if that is inconclusive, the energy is not known.
    let nothing = impacts
        .first()
        .filter(|first| first.held == Some(false))
        .map(|_| 0.0);
    let last = impacts.last();
    let absorbed = of_each(impacts, impact::ABSORBED_ENERGY)
        .into_iter()
        .filter(|energy| energy.is_finite())
        .reduce(|sum, energy| sum + energy);
    vec![
        schema::IMPACTS.found(Some(count(None))),
        schema::PASSED.found(Some(count(Some(true)))),
        energy(schema::LAST_PASSED_ENERGY, passed, nothing),
        energy(schema::FIRST_FAILED_ENERGY, failed, None),
        largest(impacts, schema::MAX_DISPLACEMENT, impact::MAX_DISPLACEMENT),
        left.displacement.found_by(
            last.and_then(position),
            last.map_or_else(Vec::new, contributions_to_position),
        ),
        schema::ABSORBED_ENERGY.found_by(
            absorbed,
            contributions_to_sum(impacts, impact::ABSORBED_ENERGY),
        ),
    ]
}

/// Lists with an entry for each impact.
fn of_impacts(impacts: &[SeriesImpact], left: &Left) -> Vec<NamedResult> {
    let known = |kind: ResultKind, of_impact: ResultKind| {
        let parts = by_impact(impacts, |impact| contributions(impact, of_impact));
        kind.found_list_by(Some(of_each(impacts, of_impact)), parts)
    };
    let rests = impacts
        .iter()
        .map(|impact| position(impact).unwrap_or(f64::NAN))
        .collect();
    vec![
        schema::VELOCITIES.found_list_by(
            Some(impacts.iter().map(|impact| impact.velocity).collect()),
            by_impact(impacts, contributions_to_velocity),
        ),
        schema::IMPACT_ENERGIES.found_list_by(
            Some(impacts.iter().map(|impact| impact.energy).collect()),
            by_impact(impacts, |impact| {
                contributions(impact, impact::STRIKER_ENERGY)
            }),
        ),
        known(schema::MAX_DISPLACEMENTS, impact::MAX_DISPLACEMENT),
        left.displacements
            .found_list_by(Some(rests), by_impact(impacts, contributions_to_position)),
        known(schema::ABSORBED_ENERGIES, impact::ABSORBED_ENERGY),
        known(schema::IMPULSES, impact::IMPULSE),
        schema::ENERGY_ERRORS.found_list(Some(of_each(impacts, impact::ENERGY_ERROR))),
    ]
}

/// Lists with an entry for each storey.
fn of_storeys(impacts: &[SeriesImpact], left: &Left) -> [NamedResult; 3] {
    let rest = impacts.last().and_then(|impact| impact.rest.as_ref());
    let (drift, parts) = rest
        .map(|rest| (rest.drift(), rest.drift_contributions()))
        .unwrap_or_default();
    [
        largest_of_storeys(impacts),
        left.drift.found_list_by(Some(drift), parts),
        sum_of_storeys(impacts),
    ]
}

/// The displacement of the struck degree of freedom after an impact \[m\].
fn position(impact: &SeriesImpact) -> Option<f64> {
    impact
        .rest_of_struck()
        .map(|(displacement, _)| displacement)
}

fn contributions_to_position(impact: &SeriesImpact) -> Vec<Contribution> {
    impact
        .rest_contributions()
        .map_or_else(Vec::new, |[position, _]| position)
}

/// A number of every impact; NaN if an impact does not have it.
fn of_each(impacts: &[SeriesImpact], kind: ResultKind) -> Vec<f64> {
    impacts
        .iter()
        .map(|impact| impact.number(kind.name).unwrap_or(f64::NAN))
        .collect()
}

/// The contributions to a list with an entry for each impact.
fn by_impact(
    impacts: &[SeriesImpact],
    of_impact: impl Fn(&SeriesImpact) -> Vec<Contribution>,
) -> Vec<Contribution> {
    let of_entry = |(entry, impact)| {
        of_impact(impact)
            .into_iter()
            .map(move |part| Contribution { entry, ..part })
    };
    impacts.iter().enumerate().flat_map(of_entry).collect()
}

/// E = ½ Ms V0²: the relative contribution of the velocity to the energy is twice that to the velocity.
fn contributions_to_velocity(impact: &SeriesImpact) -> Vec<Contribution> {
    let parts = contributions(impact, impact::STRIKER_ENERGY).into_iter();
    let of_speed = parts.filter(|part| matches!(part.source, Source::StrikerVelocity(_)));
    of_speed
        .map(|part| Contribution {
            amount: part.amount * 0.5 * impact.velocity / impact.energy,
            ..part
        })
        .collect()
}

/// The largest drift of each storey over all impacts, with the uncertainty of its impact.
fn largest_of_storeys(impacts: &[SeriesImpact]) -> NamedResult {
    let lists: Vec<(&[f64], &SeriesImpact)> = impacts
        .iter()
        .filter_map(|impact| Some((impact.list(impact::MAX_DRIFT.name)?, impact)))
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
        let Some((found, impact)) = largest else {
            continue;
        };
        values.push(found[storey]);
        parts.extend(
            contributions(impact, impact::MAX_DRIFT)
                .into_iter()
                .filter(|part| part.entry == storey),
        );
    }
    schema::MAX_DRIFT.found_list_by(Some(values), parts)
}

/// The energy of each storey, summed over all impacts.
fn sum_of_storeys(impacts: &[SeriesImpact]) -> NamedResult {
    let lists = impacts
        .iter()
        .filter_map(|impact| impact.list(impact::STOREY_ENERGY.name));
    let sum = lists
        .map(<[f64]>::to_vec)
        .reduce(|sum, next| sum.iter().zip(next).map(|(sum, next)| sum + next).collect());
    let parts = contributions_to_sum(impacts, impact::STOREY_ENERGY);
    schema::STOREY_ENERGY.found_list_by(Some(sum.unwrap_or_default()), parts)
}

/// The largest value of a result over all impacts, with the uncertainty of its impact.
fn largest(impacts: &[SeriesImpact], kind: ResultKind, of_impact: ResultKind) -> NamedResult {
    let found = impacts
        .iter()
        .filter_map(|impact| Some((impact.number(of_impact.name)?, impact)))
        .filter(|(value, _)| value.is_finite());
    let most = found.reduce(|most, next| if next.0 > most.0 { next } else { most });
    let parts = most.map_or_else(Vec::new, |(_, impact)| contributions(impact, of_impact));
    kind.found_by(most.map(|(value, _)| value), parts)
}

/// The contributions to the sum of a result over all impacts: those from a shared source are added before they are squared.
fn contributions_to_sum(impacts: &[SeriesImpact], of_impact: ResultKind) -> Vec<Contribution> {
    let mut parts: Vec<Contribution> = Vec::new();
    for part in impacts
        .iter()
        .flat_map(|impact| contributions(impact, of_impact))
    {
        share(&mut parts, part);
    }
    parts
}

fn contributions(impact: &SeriesImpact, kind: ResultKind) -> Vec<Contribution> {
    let found = impact.result(kind.name);
    found.map_or_else(Vec::new, |result| result.contributions.clone())
}
