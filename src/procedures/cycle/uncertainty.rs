//! The uncertainty of the results of a `cycle`. In: the recorded loops. Out: the contributions of each source, and of the unknown curve
//! between the points of each loop. The backbone fit has its own scatter, and is not touched here.

use std::convert::Infallible;

use super::run::results;
use crate::physics::identification::cyclic::{LoopPoint, loop_of};
use crate::physics::reintegration::perturbation::{Perturbation, ReadingErrors};
use crate::plan::formula::ProcedureId;
use crate::procedures::loop_sampling::{left_open_by, of_open};
use crate::procedures::results::{Layout, give, values};
use crate::record::{CycleHistory, CycleStep, NamedResult, WholeCycle};
use crate::schema::procedures::cycle as schema;
use crate::uncertainty::engine::{Evaluate, Evaluation, Shifts, Study};
use crate::uncertainty::{Contribution, InstrumentUncertainty, Source};

/// Results with an entry a cycle.
const LISTS: [&str; 4] = [
    schema::AMPLITUDES.name,
    schema::ENERGIES.name,
    schema::DAMPING_RATIOS.name,
    schema::STIFFNESSES.name,
];

/// Results that follow from the loops.
const OF_LOOPS: [&str; 6] = [
    schema::DISSIPATED_ENERGY.name,
    schema::MAX_FORCE.name,
    schema::MIN_FORCE.name,
    schema::EQUIVALENT_DAMPING_RATIO.name,
    schema::STIFFNESS.name,
    schema::LAST_STIFFNESS.name,
];

/// Loops as they were read.
pub(crate) struct RecordedLoops<'a> {
    pub history: &'a CycleHistory,
    /// Of which each reading is the mean.
    pub samples: u32,
    /// Of the cell in this run \[N\].
    pub noise: f64,
    /// By how much the points of each loop leave its energy open \[J\].
    pub left_open: &'a [f64],
}

impl RecordedLoops<'_> {
    /// The results that follow from them.
    fn layout(&self) -> Layout {
        let lists = LISTS
            .into_iter()
            .map(|name| (name, self.history.cycles.len()));
        OF_LOOPS
            .into_iter()
            .map(|name| (name, 1))
            .chain(lists)
            .collect()
    }
}

impl Evaluate for RecordedLoops<'_> {
    type Inputs = ();

    fn inputs(&self, _: Shifts<'_>) -> Result<(), String> {
        Ok(())
    }

    fn evaluate(&self, readings: &Perturbation, (): &()) -> Evaluation {
        let mut perturbed = CycleHistory {
            backbone: None,
            ..self.history.clone()
        };
        for step in &mut perturbed.steps {
            let exact = (step.displacement, step.restoring_force);
            (step.displacement, step.restoring_force) =
                readings.read(step.step, 0, self.samples, exact);
        }
        for cycle in &mut perturbed.cycles {
            let points: Vec<LoopPoint> = points_of(&perturbed.steps, cycle)
                .map(CycleStep::point)
                .collect();
            if let Some(found) = loop_of(&points) {
                cycle.found = found;
            }
        }
        let noise = readings
            .trial
            .map_or(self.noise, |_| readings.axes[0].errors.noise);
        Evaluation::of_readings(values(
            &self.layout(),
            &results(&perturbed, noise / f64::from(self.samples).sqrt()),
        ))
    }
}

/// Gives the results of the loops their contributions.
pub(crate) fn propagate(
    loops: &RecordedLoops<'_>,
    instruments: &InstrumentUncertainty,
    procedure: ProcedureId,
    results: &mut [NamedResult],
) {
    let study = Study {
        procedure,
        impact: 0,
        evaluate: loops,
        instruments,
        inputs: Vec::new(),
        steps: loops.history.steps.len() as u64,
        reported: None,
    };
    let layout = loops.layout();
    // Inputs have no bounds here, and nobody waits.
    if let Ok(mut contributions) = study.contributions::<Infallible>(&mut |_, _| Ok(())) {
        for (name, entry, amount) in of_sampling(loops.history, loops.left_open) {
            let before = layout
                .iter()
                .take_while(|(result, _)| *result != name)
                .map(|(_, count)| count)
                .sum::<usize>();
            contributions[before + entry].push(Contribution::new(
                Source::LoopSampling { procedure },
                amount,
            ));
        }
        give(&layout, contributions, results);
    }
}

/// By how much the points of each loop leave its energy open \[J\]; each reading is the mean of so many samples.
pub(crate) fn left_open_by_points(
    history: &CycleHistory,
    samples: u32,
    errors: ReadingErrors,
) -> Vec<f64> {
    let of_cycle = |cycle: &WholeCycle| {
        let points =
            points_of(&history.steps, cycle).map(|step| (step.displacement, step.restoring_force));
        left_open_by(
            &points.collect::<Vec<_>>(),
            cycle.found.stiffness.unwrap_or(0.0),
            errors,
            samples,
        )
    };
    history.cycles.iter().map(of_cycle).collect()
}

/// Uncertainties of the results by the points of the loops. Loops are alike, and so are their corners.
fn of_sampling(history: &CycleHistory, open: &[f64]) -> Vec<(&'static str, usize, f64)> {
    let uncertain: Vec<f64> = open.iter().copied().map(of_open).collect();
    // ζ = E_D/(4π·½K a²)
    let ratio = |(cycle, energy): (&WholeCycle, &f64)| {
        let stored = 0.5 * cycle.found.stiffness? * cycle.found.amplitude * cycle.found.amplitude;
        (stored > 0.0).then(|| energy / (4.0 * std::f64::consts::PI * stored))
    };
    let ratios: Vec<f64> = history
        .cycles
        .iter()
        .zip(&uncertain)
        .map(|each| ratio(each).unwrap_or(0.0))
        .collect();
    let of_each = uncertain.iter().zip(&ratios).enumerate();
    let lists = of_each.flat_map(|(entry, (energy, ratio))| {
        [
            (schema::ENERGIES.name, entry, *energy),
            (schema::DAMPING_RATIOS.name, entry, *ratio),
        ]
    });
    let whole = [
        (schema::DISSIPATED_ENERGY.name, 0, uncertain.iter().sum()),
        (
            schema::EQUIVALENT_DAMPING_RATIO.name,
            0,
            ratios.last().copied().unwrap_or(0.0),
        ),
    ];
    lists.chain(whole).collect()
}

/// The readings of a cycle, which begins with the last one of the cycle before it.
fn points_of<'a>(
    steps: &'a [CycleStep],
    cycle: &WholeCycle,
) -> impl Iterator<Item = &'a CycleStep> {
    let first = steps.partition_point(|step| step.cycle < cycle.cycle);
    let after = steps.partition_point(|step| step.cycle <= cycle.cycle);
    steps[first.saturating_sub(1)..after].iter()
}

#[cfg(test)]
mod tests {
    use crate::plan::formula::{Formula, Function, ResultValue};
    use crate::plan::{
        Behaviour, Bolted, Calibration, Cycle, Level, Link, Plan, ProcedureKind, Sides, VirtualLink,
    };
    use crate::tests::testing::{elastic_plan, number, result_of, run_unwatched};
    use crate::uncertainty::Source;

    const STIFFNESS: f64 = 1000.0;
    const POINTS: u32 = 10;

    fn plan(behaviour: Behaviour, link: VirtualLink, calibration: Calibration) -> Plan {
        let cycle = Cycle {
            specimen: 0,
            levels: vec![Level {
                amplitude: Formula::Constant(0.02),
                cycles: 2,
            }],
            sides: Sides::Both,
            about: Formula::Constant(0.0),
            points: POINTS,
            samples: 4,
            pause: Formula::Constant(0.0),
            speed: None,
            rate: None,
            inspect: Vec::new(),
            fit: None,
            evenly: false,
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
        let behaviour = Behaviour::Bilinear {
            stiffness: STIFFNESS,
            yield_force: 10.0,
            hardening: 0.1,
        };
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
            let of = |source| {
                parts
                    .iter()
                    .find(|part| part.source == source)
                    .map_or(0.0, |part| part.amount)
            };
            for (source, by_hand) in [
                (Source::ForceScale(0), 0.01 * force * value),
                (Source::DisplacementScale(0), 0.003 * displacement * value),
                (Source::ForceZero(0), zero),
            ] {
                let found = of(source);
                assert!(
                    (found - by_hand).abs() < 1e-4 * 0.01 * value.abs(),
                    "{name}: {found}, by hand {by_hand}"
                );
            }
        }
    }

    /// One number is told with one uncertainty, whether by a name of its own or as an entry of its list; energies add up source by source.
    #[test]
    fn the_lists_are_as_uncertain_as_the_numbers() {
        let behaviour = Behaviour::Bilinear {
            stiffness: STIFFNESS,
            yield_force: 10.0,
            hardening: 0.1,
        };
        let calibration = Calibration {
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.003,
            zero_uncertainty: 0.3,
            ..Calibration::default()
        };
        let link = VirtualLink {
            noise: 0.1,
            seed: 4,
            ..VirtualLink::default()
        };
        let record = run_unwatched(&plan(behaviour, link, calibration));
        let listed = |name: &str| {
            record.procedures[0]
                .result(name)
                .unwrap()
                .entry_uncertainties()
        };
        let told = |name: &str| number(&record, 0, name).1;
        assert_eq!(
            listed("stiffnesses"),
            [told("stiffness"), told("last_stiffness")]
        );
        assert_eq!(
            listed("damping_ratios")[1],
            told("equivalent_damping_ratio")
        );
        let all = result_of(0, "energies");
        let sum = Formula::Call(Function::Sum, vec![all])
            .evaluate(&record, None)
            .unwrap()
            .uncertainty
            .unwrap();
        assert!((sum / told("dissipated_energy").unwrap() - 1.0).abs() < 1e-9);
        let amplitude = listed("amplitudes")[0].unwrap();
        assert!(
            (amplitude / (0.003 * 0.02) - 1.0).abs() < 1e-9,
            "{amplitude}"
        );
        // Rounded too, the numbers are still as uncertain as their entries.
        let link = VirtualLink {
            noise: 0.1,
            resolution: 1e-5,
            force_resolution: 0.05,
            seed: 4,
            ..VirtualLink::default()
        };
        let record = run_unwatched(&plan(
            Behaviour::Elastic {
                stiffness: STIFFNESS,
            },
            link,
            Calibration::default(),
        ));
        let listed = record.procedures[0]
            .result("stiffnesses")
            .unwrap()
            .entry_uncertainties();
        assert_eq!(
            listed,
            [
                number(&record, 0, "stiffness").1,
                number(&record, 0, "last_stiffness").1
            ]
        );
    }

    /// Bolted supports whose corners ten points a quarter lose: 131.1 of 135.75 J, the friction alone, 4·1.5 kN·(23 mm − 1.5 kN/4 kN/mm).
    fn of_points(points: u32) -> crate::record::Record {
        let supports = Bolted {
            stiffness: 4e6,
            bearing_force: 8e3,
            clearance: 1e-3,
            slip_force: 1.5e3,
        };
        let mut plan = plan(
            Behaviour::Bolted(supports),
            VirtualLink::default(),
            Calibration::default(),
        );
        let ProcedureKind::Cycle(cycle) = &mut plan.procedures[0].kind else {
            panic!()
        };
        cycle.points = points;
        cycle.levels[0].amplitude = Formula::Constant(0.023);
        run_unwatched(&plan)
    }

    /// However few the points, U holds the energy of the loop and its damping ratio; many leave little open, and few are remarked on.
    #[test]
    fn what_the_points_of_a_loop_leave_open_is_in_its_uncertainty() {
        let exact = 4.0 * 1.5e3 * (0.023 - 1.5e3 / 4e6);
        let mut last = f64::INFINITY;
        let fine = of_points(3000);
        let ratio = number(&fine, 0, "equivalent_damping_ratio").0.unwrap();
        for (points, few) in [
            (1, true),
            (2, true),
            (5, true),
            (10, true),
            (25, false),
            (100, false),
            (400, false),
        ] {
            let record = of_points(points);
            let energies = record.procedures[0].result("energies").unwrap();
            let ResultValue::List(values) = &energies.value else {
                panic!()
            };
            let (energy, u) = (values[1], energies.entry_uncertainties()[1].unwrap());
            assert!(
                (energy - exact).abs() <= 2.0 * u,
                "{points} points: {energy} J ± {u} J of {exact} J"
            );
            // Of one and two, where the corners lie is all.
            assert!(
                points <= 5 || u < last,
                "{points} points: {u} J, {last} J of fewer"
            );
            last = u;
            let (found, u) = number(&record, 0, "equivalent_damping_ratio");
            assert!(
                (found.unwrap() - ratio).abs() <= 2.0 * u.unwrap() + 1e-4 * ratio,
                "{points} points: {found:?} ± {u:?} of {ratio}"
            );
            let told = record
                .events
                .iter()
                .any(|event| event.text.starts_with("few points"));
            assert_eq!(told, few, "{points} points");
        }
        assert!(last < 1e-4 * exact, "{last} J");
        // The default loses 0.2 % at most.
        let energies = of_points(25);
        let ResultValue::List(values) = &energies.procedures[0].result("energies").unwrap().value
        else {
            panic!()
        };
        assert!((values[1] / exact - 1.0).abs() < 0.002, "{} J", values[1]);
    }

    /// An elastic loop has no corners to lose, with noise as without.
    #[test]
    fn the_points_of_an_elastic_loop_leave_nothing_open() {
        for noise in [0.0, 0.1] {
            let link = VirtualLink {
                noise,
                seed: 7,
                ..VirtualLink::default()
            };
            let record = run_unwatched(&plan(
                Behaviour::Elastic {
                    stiffness: STIFFNESS,
                },
                link,
                Calibration::default(),
            ));
            let parts = &record.procedures[0]
                .result("dissipated_energy")
                .unwrap()
                .contributions;
            assert!(
                !parts
                    .iter()
                    .any(|part| matches!(part.source, Source::LoopSampling { .. })),
                "{parts:?}"
            );
            assert!(
                !record
                    .events
                    .iter()
                    .any(|event| event.text.starts_with("few points"))
            );
        }
    }

    /// A plastic force that stays, pushed and pulled: neither the largest nor the smallest reading is off by what noise adds to it.
    #[test]
    fn largest_and_smallest_of_noisy_cycles_are_those_of_the_force() {
        let records = (1..=60).map(|seed| {
            let behaviour = Behaviour::Bilinear {
                stiffness: STIFFNESS,
                yield_force: 10.0,
                hardening: 0.0,
            };
            let link = VirtualLink {
                noise: 0.3,
                seed,
                ..VirtualLink::default()
            };
            run_unwatched(&plan(behaviour, link, Calibration::default()))
        });
        let records: Vec<crate::record::Record> = records.collect();
        for (name, truth) in [("max_force", 10.0), ("min_force", -10.0)] {
            let held = records.iter().filter(|record| {
                let (value, u) = number(record, 0, name);
                (value.unwrap() - truth).abs() <= 2.0 * u.unwrap()
            });
            let held = held.count();
            assert!(held >= 53, "{name}: {held} of 60");
        }
    }

    /// ∫R dX by the trapezoid has the weight (x₊ − x₋)/2 on each R: u = σ/√n·√Σ w², of uniform steps h of ways back and
    /// forth h but for the turns, where it is 0, and the two ends of the whole, where it is h/2.
    #[test]
    fn noise_reaches_the_energy_of_a_loop_by_its_weights() {
        let noise = 0.2;
        let link = VirtualLink {
            noise,
            seed: 3,
            ..VirtualLink::default()
        };
        let record = run_unwatched(&plan(
            Behaviour::Elastic {
                stiffness: STIFFNESS,
            },
            link,
            Calibration::default(),
        ));
        let step = 0.02 / f64::from(POINTS);
        // Two cycles of 40 steps: 81 readings, four of them turns, two ends, and the middle one passed twice over.
        let weights = f64::from(81 - 4 - 2) + 2.0 * 0.25;
        let by_hand = noise / 4.0_f64.sqrt() * step * weights.sqrt();
        let u = number(&record, 0, "dissipated_energy").1.unwrap();
        assert!(
            (u / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(),
            "{u}, by hand {by_hand}"
        );
    }
}
