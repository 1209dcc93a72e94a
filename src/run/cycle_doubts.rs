//! What the calibration of the rig and the errors of its readings make of the results of a `cycle`. In: what was recorded.
//! Out: what each source contributes: the loops are reckoned again from readings with one source moved at a time, by ±u, and
//! from readings with drawn errors. What is fitted to the backbone has its own scatter, and is not touched here.

use super::cycle::results;
use super::cycle_rounding::of_loops;
use super::inputs::Inputs;
use super::rounding_doubts::Quanta;
use super::study::{draws_of, give_entry};
use crate::formula::ResultValue;
use crate::mechanics::cyclic::{LoopPoint, loop_of};
use crate::mechanics::recorded_path::{Distortion, Noise};
use crate::plan::Calibration;
use crate::record::{CycleHistory, CycleStep, NamedResult};
use crate::uncertainty::{Contribution, Source, combined};

/// Results with an entry a cycle.
const LISTS: [&str; 4] = ["amplitudes", "energies", "damping_ratios", "stiffnesses"];

/// Results that follow from the loops.
const OF_LOOPS: [&str; 6] =
    ["dissipated_energy", "max_force", "min_force", "equivalent_damping_ratio", "stiffness", "last_stiffness"];

/// Readings with a source moved by so much.
type Moving = fn(f64) -> Distortion;

/// Gives the results of the loops their contributions.
pub(super) fn propagate(
    history: &CycleHistory,
    samples: u32,
    calibration: &Calibration,
    inputs: &Inputs<'_>,
    quanta: Quanta,
    told: &mut [NamedResult],
) {
    let procedure = inputs.procedure();
    let moved = |distortion| values(&distorted(history, distortion));
    let nominal = values(history);
    let mut contributions: Vec<Vec<Contribution>> = vec![Vec::new(); nominal.len()];
    let at: [(Source, f64, Moving); 3] = [
        (Source::ForceScale(0), calibration.force_uncertainty, |by| Distortion { force_scale: 1.0 + by, ..Distortion::NONE }),
        (Source::DisplacementScale(0), calibration.displacement_uncertainty, |by| Distortion {
            displacement_scale: 1.0 + by,
            ..Distortion::NONE
        }),
        (Source::ForceZero(0), calibration.zero(), |by| Distortion { zero: by, ..Distortion::NONE }),
    ];
    for (source, uncertainty, distortion) in at.into_iter().filter(|(_, uncertainty, _)| *uncertainty > 0.0) {
        let (up, down) = (moved(distortion(uncertainty)), moved(distortion(-uncertainty)));
        for (parts, (up, down)) in contributions.iter_mut().zip(up.into_iter().zip(down)) {
            parts.push(Contribution::new(source, 0.5 * (up - down)));
        }
    }
    if quanta.noise > 0.0 {
        let draws = draws_of(history.steps.len() as u64);
        let force = quanta.noise / f64::from(samples).sqrt();
        for draw in 0..draws {
            let noise = Some(Noise { force, displacement: 0.0, draw });
            let found = moved(Distortion { noise, ..Distortion::NONE });
            for ((parts, found), nominal) in contributions.iter_mut().zip(found).zip(&nominal) {
                let amount = (found - nominal) / f64::from(draws).sqrt();
                parts.push(Contribution::new(Source::Readings { procedure, draw }, amount));
            }
        }
    }
    for (name, entry, amount) in of_loops(history, quanta, samples) {
        let rounding = Contribution::new(Source::Rounding { procedure, result: name, entry }, amount);
        if let Some(index) = OF_LOOPS.iter().position(|of_loop| *of_loop == name) {
            contributions[index].push(rounding);
        } else if let Some(list) = LISTS.iter().position(|list| *list == name) {
            contributions[OF_LOOPS.len() + list * history.cycles.len() + entry].push(rounding);
        }
    }
    let of_cycles = contributions.split_off(OF_LOOPS.len());
    for (list, of_cycles) in LISTS.into_iter().zip(of_cycles.chunks(history.cycles.len().max(1))) {
        let Some(result) = told.iter_mut().find(|result| result.name == list) else { continue };
        for (entry, parts) in of_cycles.iter().enumerate() {
            give_entry(result, entry, parts.clone());
        }
    }
    for (name, parts) in OF_LOOPS.into_iter().zip(contributions) {
        let Some(result) = told.iter_mut().find(|result| result.name == name) else { continue };
        if let ResultValue::Number { value: Some(_), uncertainty } = &mut result.value
            && parts.iter().all(|part| part.amount.is_finite())
        {
            result.contributions = parts.into_iter().filter(|part| part.amount != 0.0).collect();
            *uncertainty = combined(&result.contributions);
        }
    }
}

/// In the order of [`OF_LOOPS`], then of [`LISTS`] with the cycles of each; NaN of what does not exist.
fn values(history: &CycleHistory) -> Vec<f64> {
    let results = results(history);
    let of = |name: &str| match results.iter().find(|result| result.name == name).map(|result| &result.value) {
        Some(ResultValue::Number { value: Some(value), .. }) => vec![*value],
        Some(ResultValue::List(values)) => values.clone(),
        _ => vec![f64::NAN],
    };
    OF_LOOPS.iter().chain(&LISTS).flat_map(|name| of(name)).collect()
}

/// The record as other readings would have made it.
fn distorted(history: &CycleHistory, distortion: Distortion) -> CycleHistory {
    let Distortion { force_scale, displacement_scale, zero, noise, .. } = distortion;
    let mut other = CycleHistory { backbone: None, ..history.clone() };
    for step in &mut other.steps {
        let [of_force, of_displacement] = noise.map_or([0.0; 2], |noise| noise.errors(step.step, 0));
        step.displacement = displacement_scale * step.displacement + of_displacement;
        step.restoring_force = force_scale * step.restoring_force + zero + of_force;
    }
    for cycle in &mut other.cycles {
        // A cycle begins with the last reading of the one before it.
        let first = other.steps.partition_point(|step| step.cycle < cycle.cycle);
        let after = other.steps.partition_point(|step| step.cycle <= cycle.cycle);
        let points: Vec<LoopPoint> = other.steps[first.saturating_sub(1)..after].iter().map(CycleStep::point).collect();
        if let Some(found) = loop_of(&points) {
            cycle.found = found;
        }
    }
    other
}

#[cfg(test)]
mod tests {
    use crate::formula::{Formula, Function};
    use crate::plan::{Behaviour, Calibration, Cycle, Level, Link, Plan, ProcedureKind, Sides, VirtualLink};
    use crate::run::testing::{elastic_plan, number, result_of, run_unwatched};
    use crate::uncertainty::Source;

    const STIFFNESS: f64 = 1000.0;
    const POINTS: u32 = 10;

    fn plan(behaviour: Behaviour, link: VirtualLink, calibration: Calibration) -> Plan {
        let cycle = Cycle {
            specimen: 0,
            levels: vec![Level { amplitude: Formula::Constant(0.02), cycles: 2 }],
            sides: Sides::Both,
            about: Formula::Constant(0.0),
            points: POINTS,
            samples: 4,
            pause: Formula::Constant(0.0),
            speed: None,
            rate: None,
            inspect: Vec::new(),
            fit: None,
        };
        let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::Cycle(cycle)]);
        plan.specimens[0].behaviour = Some(behaviour);
        plan.rig.link = Link::Virtual(link);
        plan.rig.calibration = calibration;
        plan
    }

    /// Energy goes with both factors, stiffness with their ratio, a ratio of energies with neither; a zero shifts forces.
    #[test]
    fn a_calibration_reaches_the_loops_by_its_powers() {
        let behaviour = Behaviour::Bilinear { stiffness: STIFFNESS, yield_force: 10.0, hardening: 0.1 };
        let calibration = Calibration {
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.003,
            zero_uncertainty: 0.3,
            zero_drift: 0.4,
            ..Calibration::default()
        };
        let record = run_unwatched(&plan(behaviour, VirtualLink::default(), calibration));
        let cases = [
            ("dissipated_energy", [1.0, 1.0], 0.0),
            ("max_force", [1.0, 0.0], 0.5),
            ("min_force", [1.0, 0.0], 0.5),
            ("equivalent_damping_ratio", [0.0, 0.0], 0.0),
            ("stiffness", [1.0, -1.0], 0.0),
            ("last_stiffness", [1.0, -1.0], 0.0),
        ];
        for (name, [force, displacement], zero) in cases {
            let value = number(&record, 0, name).0.unwrap();
            let parts = &record.procedures[0].result(name).unwrap().contributions;
            let of = |source| parts.iter().find(|part| part.source == source).map_or(0.0, |part| part.amount);
            for (source, by_hand) in [
                (Source::ForceScale(0), 0.01 * force * value),
                (Source::DisplacementScale(0), 0.003 * displacement * value),
                (Source::ForceZero(0), zero),
            ] {
                let found = of(source);
                assert!((found - by_hand).abs() < 1e-4 * 0.01 * value.abs(), "{name}: {found}, by hand {by_hand}");
            }
        }
    }

    /// One number is told with one uncertainty, whether by a name of its own or as an entry of its list; energies add up source by source.
    #[test]
    fn the_lists_are_as_uncertain_as_the_numbers() {
        let behaviour = Behaviour::Bilinear { stiffness: STIFFNESS, yield_force: 10.0, hardening: 0.1 };
        let calibration = Calibration {
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.003,
            zero_uncertainty: 0.3,
            ..Calibration::default()
        };
        let link = VirtualLink { noise: 0.1, seed: 4, ..VirtualLink::default() };
        let record = run_unwatched(&plan(behaviour, link, calibration));
        let listed = |name: &str| record.procedures[0].result(name).unwrap().entry_uncertainties();
        let told = |name: &str| number(&record, 0, name).1;
        assert_eq!(listed("stiffnesses"), [told("stiffness"), told("last_stiffness")]);
        assert_eq!(listed("damping_ratios")[1], told("equivalent_damping_ratio"));
        let all = result_of(0, "energies");
        let sum = Formula::Call(Function::Sum, vec![all]).evaluate(&record, None).unwrap().uncertainty.unwrap();
        assert!((sum / told("dissipated_energy").unwrap() - 1.0).abs() < 1e-9);
        let amplitude = listed("amplitudes")[0].unwrap();
        assert!((amplitude / (0.003 * 0.02) - 1.0).abs() < 1e-9, "{amplitude}");
        // Rounded too, the numbers are still as uncertain as their entries.
        let link = VirtualLink { noise: 0.1, resolution: 1e-5, force_resolution: 0.05, seed: 4, ..VirtualLink::default() };
        let record = run_unwatched(&plan(Behaviour::Elastic { stiffness: STIFFNESS }, link, Calibration::default()));
        let listed = record.procedures[0].result("stiffnesses").unwrap().entry_uncertainties();
        assert_eq!(listed, [number(&record, 0, "stiffness").1, number(&record, 0, "last_stiffness").1]);
    }

    /// ∫R dX by the trapezoid has the weight (x₊ − x₋)/2 on each R: u = σ/√n·√Σ w², of uniform steps h of ways back and
    /// forth h but for the turns, where it is 0, and the two ends of the whole, where it is h/2.
    #[test]
    fn noise_reaches_the_energy_of_a_loop_by_its_weights() {
        let noise = 0.2;
        let link = VirtualLink { noise, seed: 3, ..VirtualLink::default() };
        let record = run_unwatched(&plan(Behaviour::Elastic { stiffness: STIFFNESS }, link, Calibration::default()));
        let step = 0.02 / f64::from(POINTS);
        // Two cycles of 40 steps: 81 readings, four of them turns, two ends, and the middle one passed twice over.
        let weights = f64::from(81 - 4 - 2) + 2.0 * 0.25;
        let by_hand = noise / 4.0_f64.sqrt() * step * weights.sqrt();
        let u = number(&record, 0, "dissipated_energy").1.unwrap();
        assert!((u / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(), "{u}, by hand {by_hand}");
    }
}
