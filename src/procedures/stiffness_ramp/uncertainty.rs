//! The direct readings of a `stiffness ramp`, beside its fits, and their uncertainty. In: the readings of the ramp. Out: forces,
//! displacements, secants and the energy of its loops, with the contributions of each source. It fits nothing.

use psd_plan::schema::ResultKind;
use std::convert::Infallible;

use super::points::{Point, point, secant};
use crate::procedures::common::loop_sampling::{left_open_by, of_open};
use crate::procedures::common::results::{give, index_of, largest};
use psd_physics::identification::loop_energy;
use psd_physics::reintegration::perturbation::{Perturbation, ReadingErrors};
use psd_physics::statistics::noisy_largest::NoisyLargest;
use psd_physics::statistics::samples::mean;
use psd_plan::StiffnessRamp;
use psd_plan::formula::ProcedureId;
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::record::{NamedResult, RampStep};
use psd_plan::uncertainty::engine::{Evaluate, Evaluation, Propagation, Shifts};
use psd_plan::uncertainty::{Contribution, InstrumentUncertainty, Source};
use psd_rig::DeclaredNoise;

/// The results that are read directly, SI; None for a result that does not exist.
#[derive(Default)]
pub(crate) struct Direct {
    pub secant_stiffness: Option<f64>,
    pub max_force: Option<f64>,
    pub max_displacement: Option<f64>,
    pub loop_energy: Option<f64>,
    pub relaxation: Option<f64>,
    pub tangent_stiffness: Option<f64>,
}

type ReadDirect = fn(&Direct) -> Option<f64>;

/// The same, each with its value.
const DIRECT: [(ResultKind, ReadDirect); 6] = [
    (schema::SECANT_STIFFNESS, |direct| direct.secant_stiffness),
    (schema::MAX_FORCE, |direct| direct.max_force),
    (schema::MAX_DISPLACEMENT, |direct| direct.max_displacement),
    (schema::LOOP_ENERGY, |direct| direct.loop_energy),
    (schema::RELAXATION, |direct| direct.relaxation),
    (schema::TANGENT_STIFFNESS, |direct| direct.tangent_stiffness),
];

/// The readings of a ramp.
#[derive(Clone)]
pub(crate) struct Readings {
    /// Before the first increment of each repeat.
    pub starts: Vec<Point>,
    pub steps: Vec<RampStep>,
}

impl Readings {
    /// The results that are read without a fit. `noise` is that of one reading of the cell \[N\].
    pub(crate) fn direct(&self, plan: &StiffnessRamp, noise: f64) -> Direct {
        let Self { starts, steps } = self;
        let targets = plan.displacements.len();
        let a_repeat = if plan.return_path {
            2 * targets
        } else {
            targets
        };
        let last = steps.iter().rposition(|step| !step.returning);
        let before = last
            .filter(|last| last % a_repeat != 0)
            .map(|last| point(&steps[last - 1]));
        let tangent = before
            .zip(last)
            .and_then(|(before, last)| secant(before, point(&steps[last])));
        let sizes = steps.iter().map(|step| step.restoring_force.abs());
        let first_secant = starts
            .first()
            .zip(steps.first())
            .and_then(|(start, step)| secant(*start, point(step)));
        let energy = |points: Vec<Point>| {
            let (x, r): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            loop_energy(&x, &r)
        };
        let loops: Vec<f64> = self.loops(plan).map(energy).collect();
        let noise = noise / f64::from(plan.samples.max(1)).sqrt();
        Direct {
            secant_stiffness: first_secant,
            max_force: NoisyLargest::of(noise, sizes).value(),
            max_displacement: largest(steps.iter().map(|step| step.displacement)),
            loop_energy: (!loops.is_empty()).then(|| mean(loops.iter().copied())),
            relaxation: (!steps.is_empty()).then(|| mean(steps.iter().map(|step| step.relaxation))),
            tangent_stiffness: tangent,
        }
    }

    /// The points of every repeat that returns.
    fn loops(&self, plan: &StiffnessRamp) -> impl Iterator<Item = Vec<Point>> {
        let returns = plan.return_path;
        let whole = self
            .steps
            .chunks_exact((2 * plan.displacements.len()).max(1))
            .zip(&self.starts)
            .filter(move |_| returns);
        whole.map(|(steps, start)| {
            std::iter::once(*start)
                .chain(steps.iter().map(point))
                .collect()
        })
    }

    /// The undetermined part of the mean energy of the loops \[J\]: the loops are alike, and so are their corners.
    fn left_open(&self, plan: &StiffnessRamp, errors: ReadingErrors) -> f64 {
        let open = |points: Vec<Point>| {
            let ends = points.first().zip(points.get(plan.displacements.len()));
            let stiffness = ends
                .and_then(|(start, turn)| secant(*start, *turn))
                .unwrap_or(0.0);
            left_open_by(&points, stiffness, errors, plan.samples.max(1))
        };
        let loops: Vec<f64> = self.loops(plan).map(open).collect();
        if loops.is_empty() {
            0.0
        } else {
            mean(loops.into_iter())
        }
    }

    /// The readings of perturbed instruments, with means of so many samples.
    pub(super) fn perturbed(&self, by: &Perturbation, samples: u32) -> Self {
        let mut other = self.clone();
        for (repeat, start) in (0..).zip(&mut other.starts) {
            *start = by.read(4 * repeat, 0, 1, *start);
        }
        for step in &mut other.steps {
            let (settled, averaged) = (4 * step.step + 1, 4 * step.step + 2);
            let below = |force| by.axes[0].force_below.error_of(force);
            let exact = by.axes[0].force_scale * step.relaxation
                + (below(step.restoring_force + step.relaxation) - below(step.restoring_force));
            step.relaxation = exact
                + (by.read(settled, 0, 1, (0.0, 0.0)).1
                    - by.read(averaged, 0, samples, (0.0, 0.0)).1);
            (step.displacement, step.restoring_force) = by.read(averaged, 0, samples, point(step));
        }
        other
    }
}

struct RecordedRamp<'a> {
    plan: &'a StiffnessRamp,
    readings: &'a Readings,
    /// Noise of the cell in this run \[N\].
    noise: f64,
}

impl Evaluate for RecordedRamp<'_> {
    type Inputs = ();

    fn inputs(&self, _: Shifts<'_>) -> Result<(), String> {
        Ok(())
    }

    fn evaluate(&self, readings: &Perturbation, (): &()) -> Evaluation {
        let noise = readings
            .trial
            .map_or(self.noise, |_| readings.axes[0].errors.noise);
        let direct = self
            .readings
            .perturbed(readings, self.plan.samples)
            .direct(self.plan, noise);
        let values = DIRECT.map(|(_, read)| read(&direct).unwrap_or(f64::NAN));
        Evaluation::of_readings(values.to_vec())
    }
}

/// Gives the direct readings their contributions.
pub(crate) fn propagate(
    readings: &Readings,
    plan: &StiffnessRamp,
    declared: DeclaredNoise,
    instruments: &InstrumentUncertainty,
    procedure: ProcedureId,
    results: &mut [NamedResult],
) {
    let propagation = Propagation {
        procedure,
        impact: 0,
        evaluate: &RecordedRamp {
            plan,
            readings,
            noise: declared.force,
        },
        instruments,
        inputs: Vec::new(),
        steps: readings.steps.len() as u64,
        reported: None,
        nominal: None,
    };
    // Inputs have no bounds here, and no one waits for progress.
    if let Ok(mut contributions) = propagation.contributions::<Infallible>(&mut |_, _| Ok(())) {
        let layout = DIRECT.map(|(kind, _)| (kind.name, 1));
        if let Some(of_loops) = index_of(&layout, schema::LOOP_ENERGY) {
            contributions[of_loops].push(Contribution::new(
                Source::LoopSampling { procedure },
                of_open(readings.left_open(plan, instruments.errors(0))),
            ));
        }
        give(&layout, contributions, results);
    }
}

#[cfg(test)]
mod tests {
    use crate::tests::testing::{elastic_plan, number, ramp, run_unwatched};
    use psd_plan::formula::Formula::Constant;
    use psd_plan::uncertainty::Source;
    use psd_plan::{Behaviour, Calibration, Link, ProcedureKind, StiffnessRamp, VirtualLink};

    const STIFFNESS: f64 = 1000.0;

    fn record(
        link: VirtualLink,
        calibration: Calibration,
        samples: u32,
    ) -> psd_plan::record::Record {
        let out = StiffnessRamp {
            return_path: true,
            samples,
            pause: Constant(0.1),
            ..ramp(2e-3)
        };
        let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(out)]);
        plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
            stiffness: STIFFNESS,
            yield_force: 10.0,
            post_yield_ratio: 0.1,
        });
        plan.rig.link = Link::Virtual(link);
        plan.rig.calibration = calibration;
        run_unwatched(&plan)
    }

    /// F is proportional to the factor of the cell, X to that of the transducer, a slope to their ratio, a loop to their product. A zero
    /// offset shifts forces only.
    #[test]
    fn a_calibration_reaches_what_is_read_by_its_powers() {
        let calibration = Calibration {
            force_uncertainty: 0.02,
            displacement_uncertainty: 0.01,
            zero_uncertainty: 0.4,
            ..Calibration::default()
        };
        let record = record(VirtualLink::default(), calibration, 1);
        for (name, [force, displacement], zero) in [
            ("secant_stiffness", [1.0, -1.0], 0.0),
            ("max_force", [1.0, 0.0], 0.4),
            ("max_displacement", [0.0, 1.0], 0.0),
            ("loop_energy", [1.0, 1.0], 0.0),
            ("tangent_stiffness", [1.0, -1.0], 0.0),
        ] {
            let (value, u) = number(&record, 0, name);
            let value = value.unwrap();
            let parts = &record.procedures[0].result(name).unwrap().contributions;
            let of = |source| {
                parts
                    .iter()
                    .find(|part| part.source == source)
                    .map_or(0.0, |part| part.amount)
            };
            let by_hand = [0.02 * force * value, 0.01 * displacement * value, zero];
            for (source, by_hand) in [
                Source::ForceScale(0),
                Source::DisplacementScale(0),
                Source::ForceZero(0),
            ]
            .into_iter()
            .zip(by_hand)
            {
                assert!(
                    (of(source) - by_hand).abs() < 2e-4 * 0.02 * value.abs() + 1e-9,
                    "{name}: {}, {by_hand}",
                    of(source)
                );
            }
            let sampling = parts
                .iter()
                .find(|part| matches!(part.source, Source::LoopSampling { .. }));
            let all = by_hand
                .into_iter()
                .chain(sampling.map(|part| part.amount))
                .map(|part| part * part)
                .sum::<f64>()
                .sqrt();
            assert!((u.unwrap() / all - 1.0).abs() < 1e-3, "{name}");
        }
    }

    /// However few the increments, U contains the energy of the loop; an elastic loop leaves nothing undetermined.
    #[test]
    fn what_the_points_of_a_loop_leave_open_is_in_its_uncertainty() {
        let energy = |behaviour: Behaviour, points: u32| {
            let displacements = (1..=points)
                .map(|index| Constant(0.0317 * f64::from(index) / f64::from(points)))
                .collect::<Vec<_>>();
            let out = StiffnessRamp {
                displacements,
                return_path: true,
                ..ramp(1.0)
            };
            let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(out)]);
            plan.specimens[0].behaviour = Some(behaviour);
            let (value, u) = number(&run_unwatched(&plan), 0, "loop_energy");
            (value.unwrap(), u)
        };
        let yielding = || Behaviour::Bilinear {
            stiffness: STIFFNESS,
            yield_force: 10.0,
            post_yield_ratio: 0.1,
        };
        let (exact, _) = energy(yielding(), 3000);
        let mut last = f64::INFINITY;
        for points in [3, 4, 7, 12, 40, 150] {
            let (value, u) = energy(yielding(), points);
            let u = u.unwrap();
            assert!(
                (value - exact).abs() <= 2.0 * u,
                "{points} points: {value} J ± {u} J of {exact} J"
            );
            assert!(u < last, "{points} points: {u} J, {last} J of fewer");
            last = u;
        }
        assert!(last < 2e-3 * exact, "{last} J");
        assert_eq!(
            energy(
                Behaviour::Elastic {
                    stiffness: STIFFNESS
                },
                7
            )
            .1,
            None
        );
    }

    /// Noise σ of a cell, n samples: σ/√n on a largest force, σ√(1 + 1/n) on a first secant over its increment, σ√(2/n) on a tangent,
    /// σ√((1 + 1/n)/N) on the mean relaxation of N pauses.
    #[test]
    fn noise_reaches_what_is_read_by_its_weights() {
        let (noise, samples, step) = (0.05, 4, 2e-3);
        let record = record(
            VirtualLink {
                noise,
                seed: 3,
                ..VirtualLink::default()
            },
            Calibration::default(),
            samples,
        );
        let n = f64::from(samples);
        for (name, by_hand) in [
            ("max_force", noise / n.sqrt()),
            ("secant_stiffness", noise * (1.0 + 1.0 / n).sqrt() / step),
            ("tangent_stiffness", noise * (2.0 / n).sqrt() / step),
            ("relaxation", noise * ((1.0 + 1.0 / n) / 20.0).sqrt()),
        ] {
            let u = number(&record, 0, name).1.unwrap();
            assert!(
                (u / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(),
                "{name}: {u}, by hand {by_hand}"
            );
        }
        // The displacements have no rounding and no calibration.
        assert_eq!(number(&record, 0, "max_displacement").1, None);
    }

    /// Sixty readings of a constant force: the largest of them is 2.3σ too large, and U would contain the force in two of sixty runs.
    #[test]
    fn the_largest_of_many_noisy_readings_is_that_of_the_force() {
        let (noise, mut sum, mut held) = (4.0, 0.0, 0);
        for seed in 1..=60 {
            let displacements = (1..=60)
                .map(|index| Constant(5e-4 * f64::from(index)))
                .collect();
            let mut plan = elastic_plan(
                STIFFNESS,
                vec![ProcedureKind::StiffnessRamp(StiffnessRamp {
                    displacements,
                    ..ramp(1.0)
                })],
            );
            plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
                stiffness: 9e4,
                yield_force: 420.0,
                post_yield_ratio: 0.0,
            });
            plan.rig.link = Link::Virtual(VirtualLink {
                noise,
                seed,
                ..VirtualLink::default()
            });
            let (value, u) = number(&run_unwatched(&plan), 0, "max_force");
            let error = value.unwrap() - 420.0;
            sum += error / 60.0;
            held += u32::from(error.abs() <= 2.0 * u.unwrap());
        }
        assert!(
            sum.abs() < 3.0 * noise / 60.0_f64.sqrt(),
            "{sum} N off on the average"
        );
        assert!(held >= 53, "{held} of 60");
    }

    /// A line through a yielding ramp has no meaning as a stiffness, and an observation states this. A straight ramp, also with noise,
    /// has none.
    #[test]
    fn a_line_through_a_bend_is_remarked_on() {
        let has_remark = |behaviour, noise| {
            let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(ramp(2e-3))]);
            plan.specimens[0].behaviour = Some(behaviour);
            plan.rig.link = Link::Virtual(VirtualLink {
                noise,
                seed: 9,
                ..VirtualLink::default()
            });
            run_unwatched(&plan).events.iter().any(|event| {
                event
                    .text
                    .starts_with("the outward steps are nonlinear near")
            })
        };
        for noise in [0.0, 0.1] {
            assert!(has_remark(
                Behaviour::Bilinear {
                    stiffness: STIFFNESS,
                    yield_force: 10.0,
                    post_yield_ratio: 0.05
                },
                noise
            ));
            assert!(!has_remark(
                Behaviour::Elastic {
                    stiffness: STIFFNESS
                },
                noise
            ));
        }
    }
}
