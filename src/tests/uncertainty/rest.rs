//! Unloaded position of a specimen on rigs with calibration errors, compared with the prediction of one run.

use crate::procedures::common::perturbed_inputs::UncertainRun;
use crate::procedures::unload::run::{of_frame, to_rest};
use crate::run::Unwatched;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::tests::procedures::frame::{close, three};
use crate::tests::testing::elastic_plan;
use psd_physics::structure::Unloading;
use psd_physics::tracking::trajectory::Path;
use psd_plan::formula::{NoResults, ProcedureId};
use psd_plan::record::Rest;
use psd_plan::uncertainty::{Contribution, Source, combined};
use psd_plan::{Behaviour, Calibration, Link, Plan, VirtualLink};
use psd_rig::{EachReading, EncodedMove, Reading, Rig, RigFault, virtual_rig};
use psd_testing::forwarded;

/// Force factor of the cell, its zero error \[N\], and displacement factor of the transducer, for each axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wrong {
    pub force: f64,
    pub zero: f64,
    pub displacement: f64,
}

pub(crate) const RIGHT: Wrong = Wrong {
    force: 1.0,
    zero: 0.0,
    displacement: 1.0,
};

/// A rig that moves and reads with wrong factors.
pub(crate) struct Misread {
    pub rig: Box<dyn Rig>,
    pub axes: Vec<Wrong>,
}

fn misread(axes: &[Wrong], mut reading: Reading) -> Reading {
    for (axis, (displacement, force)) in axes
        .iter()
        .zip(reading.displacement.iter_mut().zip(&mut reading.force))
    {
        *displacement *= axis.displacement;
        *force = axis.force * *force + axis.zero;
    }
    reading
}

impl Rig for Misread {
    forwarded!(rig: identity, degrees_of_freedom, time, execute, pause, traverse, hold, declared_noise);

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        let true_targets: Vec<f64> = targets
            .iter()
            .zip(&self.axes)
            .map(|(target, axis)| target / axis.displacement)
            .collect();
        let encoded = self.rig.propose(&true_targets, speed)?;
        Ok(EncodedMove {
            targets: targets.to_vec(),
            ..encoded
        })
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        Ok(misread(&self.axes, self.rig.read()?))
    }
    fn follow_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let truly = |(path, axis): (&Path, &Wrong)| Path {
            from: path.from / axis.displacement,
            to: path.to / axis.displacement,
            start_velocity: path.start_velocity / axis.displacement,
            end_velocity: path.end_velocity / axis.displacement,
            seconds: path.seconds,
        };
        let true_paths: Vec<Path> = paths.iter().zip(&self.axes).map(truly).collect();
        let axes = &self.axes;
        self.rig.follow_paths(&true_paths, samples, &mut |reading| {
            each(misread(axes, reading))
        })
    }
}

/// The specimen pushed through `positions` (m, one entry per axis) and then unloaded by a rig with these errors.
fn rests(plan: &Plan, positions: &[&[f64]], axes: Vec<Wrong>, within: Option<f64>) -> Rest {
    let mut rig = virtual_rig(plan);
    for displacement in positions {
        rig.propose(displacement, None).unwrap();
        rig.execute().unwrap();
    }
    let mut rig = Misread { rig, axes };
    let mut watched = Unwatched;
    let mut session = Session::begin(plan, &mut rig, &mut watched)
        .unwrap_or_else(|_| panic!("the rig is refused"));
    let frame = plan.specimens[0].frame.as_ref();
    let stiffness = || {
        plan.specimens[0]
            .behaviour
            .as_ref()
            .unwrap()
            .initial_stiffness()
    };
    let unloading = frame.map_or_else(
        || Unloading::of_one(stiffness()),
        |frame| of_frame(frame).unwrap(),
    );
    let mut steps = Vec::new();
    let mut rest = to_rest(unloading.clone(), within, None, 0, &mut session, &mut steps).unwrap();
    let inputs = Inputs::new(&NoResults, ProcedureId(0));
    UncertainRun::new(plan, &inputs, session.guard.declared_noise())
        .unloaded(&mut rest, &unloading, &steps);
    rest
}

fn of(parts: &[Contribution], source: Source) -> f64 {
    parts
        .iter()
        .filter(|part| part.source == source)
        .map(|part| part.amount)
        .sum()
}

fn calibrated(mut plan: Plan) -> Plan {
    plan.rig.calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.004,
        zero_uncertainty: 0.3,
        zero_drift: 0.4,
        ..Calibration::default()
    };
    plan
}

/// One degree of freedom, for specimens that unload with their initial stiffness and for others. Expected is half the difference between
/// rigs whose cell or transducer has an error of ± its uncertainty.
#[test]
fn a_rig_with_calibration_errors_unloads_as_predicted() {
    let specimens = [
        ("elastic", Behaviour::Elastic { stiffness: 500.0 }),
        (
            "bilinear",
            Behaviour::Bilinear {
                stiffness: 500.0,
                yield_force: 10.0,
                post_yield_ratio: 0.1,
            },
        ),
        (
            "degrading",
            Behaviour::Degrading {
                stiffness: 500.0,
                half_displacement: 0.05,
                residual: 0.1,
            },
        ),
        (
            "bouc_wen",
            Behaviour::BoucWen {
                stiffness: 500.0,
                yield_force: 10.0,
                post_yield_ratio: 0.1,
                sharpness: 2.0,
                beta: 0.5,
            },
        ),
    ];
    for (name, behaviour) in specimens {
        let mut plan = calibrated(elastic_plan(500.0, Vec::new()));
        plan.specimens[0].behaviour = Some(behaviour);
        let at = |wrong: Wrong| rests(&plan, &[&[0.06]], vec![wrong], Some(1e-6));
        let reported = at(RIGHT);
        let [of_displacement, of_force] = reported.contributions_at_floor(0);
        let cases = [
            (Source::ForceScale(0), 0.01, |by| Wrong {
                force: 1.0 + by,
                ..RIGHT
            }),
            (Source::ForceZero(0), 0.5, |by| Wrong { zero: by, ..RIGHT }),
            (Source::DisplacementScale(0), 0.004, |by| Wrong {
                displacement: 1.0 + by,
                ..RIGHT
            }),
        ] as [(Source, f64, fn(f64) -> Wrong); 3];
        let u = combined(&of_displacement).unwrap();
        for (source, by, wrong) in cases {
            let found = 0.5 * (at(wrong(by)).displacement[0] - at(wrong(-by)).displacement[0]);
            let predicted = of(&of_displacement, source);
            assert!(
                (found - predicted).abs() < 0.02 * u,
                "{name} by {source:?}: {found} m, predicted {predicted} m of {u} m"
            );
        }
        // If the specimen carries almost no load, only the zero contributes to the uncertainty of that load.
        assert!(
            (combined(&of_force).unwrap() / 0.5 - 1.0).abs() < 1e-6,
            "{name}: {of_force:?}"
        );
    }
}

/// Three storeys that yielded. A zero error z of the top floor's cell changes the drift of each storey by −z/k. One of the lowest floor
/// changes that of the lowest storey only. Displacements add the drifts below.
#[test]
fn a_false_zero_of_a_floor_moves_the_storeys_below_it() {
    let plan = calibrated(three(0.1));
    let positions: [f64; 3] = [0.025, -0.005, -0.001];
    let at = |axis: usize, zero: f64| {
        let mut axes = vec![RIGHT; 3];
        axes[axis].zero = zero;
        rests(&plan, &[&positions], axes, Some(1e-6))
    };
    let reported = at(0, 0.0);
    let (drifts, shears) = (
        reported.drift_contributions(),
        reported.shear_contributions(),
    );
    for axis in 0..3 {
        let (up, down) = (at(axis, 0.5), at(axis, -0.5));
        for (storey, stiffness) in [4e6, 2e6, 1e6].into_iter().enumerate() {
            let entry = |parts: &[Contribution]| -> Vec<Contribution> {
                parts
                    .iter()
                    .filter(|part| part.entry == storey)
                    .copied()
                    .collect()
            };
            let source = Source::ForceZero(axis);
            let by_hand = if axis >= storey {
                -0.5 / stiffness
            } else {
                0.0
            };
            let found = 0.5 * (up.drift()[storey] - down.drift()[storey]);
            let predicted = of(&entry(&drifts), source);
            close(&[found, predicted], &[by_hand; 2], 1e-6 * 0.5 / 1e6);
            close(
                &[of(&entry(&shears), source)],
                &[if axis >= storey { 0.5 } else { 0.0 }],
                1e-12,
            );
        }
    }
    // The transducer of a floor affects the drifts of its storey and of the storey above, with opposite signs.
    for axis in 0..3 {
        let of_entry = |entry: usize| {
            let parts: Vec<Contribution> = drifts
                .iter()
                .filter(|part| part.entry == entry)
                .copied()
                .collect();
            of(&parts, Source::DisplacementScale(axis))
        };
        let displacement = 0.004 * reported.displacement[axis];
        close(&[of_entry(axis)], &[displacement], 1e-15);
        if axis < 2 {
            close(&[of_entry(axis + 1)], &[-displacement], 1e-15);
        }
    }
}

/// Standard deviation of numbers about their mean.
fn scatter(values: &[f64]) -> f64 {
    let count = f64::from(u32::try_from(values.len()).unwrap());
    let mean = values.iter().sum::<f64>() / count;
    (values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / (count - 1.0))
        .sqrt()
}

/// Noise of the cells: runs that differ only in the seed. The relative standard deviation of a standard deviation of n normal numbers is
/// 1/√(2(n − 1)); the limit is three times this.
#[test]
fn unloaded_positions_scatter_as_predicted() {
    const RUNS: u32 = 200;
    let mut plan = three(0.05);
    let mut at = |seed: u64| {
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 20.0,
            seed,
            ..VirtualLink::default()
        });
        rests(&plan, &[&[0.02, 0.04, 0.06]], vec![RIGHT; 3], None)
    };
    let reported = at(0);
    let runs: Vec<Rest> = (1..=u64::from(RUNS)).map(&mut at).collect();
    let within = 3.0 / f64::from(2 * (RUNS - 1)).sqrt();
    for floor in 0..3 {
        let [of_displacement, of_force] = reported.contributions_at_floor(floor);
        let u = combined(&of_displacement).unwrap();
        let found = scatter(
            &runs
                .iter()
                .map(|rest| rest.displacement[floor])
                .collect::<Vec<f64>>(),
        );
        assert!(
            (u / found - 1.0).abs() < within,
            "floor {floor}: {found} m of runs, {u} m predicted"
        );
        assert!((combined(&of_force).unwrap() / 20.0 - 1.0).abs() < 1e-9);
    }
}

/// Without uncertain inputs, no uncertainty is reported. If a measurable load is left, the distance to the unloaded position is also
/// uncertain.
#[test]
fn what_was_left_counts_where_anything_is_uncertain() {
    let plan = three(0.5);
    let rest = rests(&plan, &[&[0.05, 0.1, 0.112]], vec![RIGHT; 3], Some(12e3));
    assert!(
        rest.of_displacement
            .iter()
            .chain(&rest.of_force)
            .all(Vec::is_empty)
    );
    let plan = calibrated(plan);
    let rough = rests(&plan, &[&[0.05, 0.1, 0.112]], vec![RIGHT; 3], Some(12e3));
    let fine = rests(&plan, &[&[0.05, 0.1, 0.112]], vec![RIGHT; 3], Some(1e-3));
    let source = Source::RestLoad {
        procedure: ProcedureId(0),
        impact: 0,
    };
    assert!(
        rough.largest().1.abs() > 1.0 && fine.largest().1.abs() <= 1e-3,
        "{rough:?}"
    );
    let mut compared = 0;
    for floor in 0..3 {
        let (left, off) = (
            of(&rough.contributions_at_floor(floor)[0], source),
            rough.displacement[floor] - fine.displacement[floor],
        );
        // Along hk it is farther than along the secant stiffness of the whole last move.
        assert!(
            off.abs() < 4.0 * left.abs() + 1e-9 && left.abs() < 4.0 * off.abs() + 1e-9,
            "floor {floor}: {off} m, {left} m"
        );
        compared += usize::from(left != 0.0);
    }
    assert!(compared > 0);
}
