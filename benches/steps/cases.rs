//! What a turn of each case of a step does, psd and the minimal kernel of the same formula.

use std::hint::black_box;

use super::kernel;
use psd_physics::contact::{Approaching, ContactLaw};
use psd_physics::impact::batch::{self, Impact};
use psd_physics::impact::summary::Wanted;
use psd_physics::impact::{ImpactInput, ImpactSolver, StepRow, Until, simulate};
use psd_physics::integrator::Integrator;
use psd_physics::integrator::input::{FrameInput, SolverInput};
use psd_physics::integrator::solver::{FrameSolver, Solver};
use psd_physics::integrator::tangents::Tangents;
use psd_physics::specimen::{Bilinear, BilinearCurve, Elastic, RestoringForce, SpecimenModel};
use psd_physics::structure::{
    FrameMatrices, Matrices, SymmetricBand, drifts, floor_forces, storey_stiffness,
};
use rustix::time::{ClockId, clock_gettime};

const SPECIMEN: Elastic = Elastic { stiffness: 327.65 };
const STEPS: u32 = 3000;
const RUNS: u32 = 10_000;

/// Time of this thread on a processor \[s\].
pub fn own_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    #[expect(clippy::cast_precision_loss, reason = "less than 2^53 ns")]
    let [whole, nanoseconds] = [time.tv_sec, time.tv_nsec].map(|part| part as f64);
    whole + nanoseconds * 1e-9
}

/// Example 1 of the paper in steps of 0.1 ms.
fn example_1() -> ImpactInput {
    black_box(ImpactInput::rigid(
        SPECIMEN.stiffness,
        Approaching {
            mass: 1.0,
            striker_mass: 10.0,
            velocity: 1.0,
            time_step: 1e-4,
        },
    ))
}

fn yielding() -> Bilinear {
    Bilinear::new(BilinearCurve {
        stiffness: SPECIMEN.stiffness,
        yield_force: 20.0,
        post_yield_ratio: 0.1,
    })
}

/// What a turn of a case does, and how many steps it has.
pub struct Case<'a> {
    pub name: String,
    pub steps: f64,
    turn: Box<dyn FnMut() + 'a>,
}

impl Case<'_> {
    /// Processor time of a turn \[s\].
    pub fn turn(&mut self) -> f64 {
        let before = own_time();
        (self.turn)();
        own_time() - before
    }
}

fn case<'a>(name: &str, steps: u32, turn: impl FnMut() + 'a) -> Case<'a> {
    Case {
        name: name.to_owned(),
        steps: f64::from(steps),
        turn: Box::new(turn),
    }
}

/// psd beside the kernel, with rows of eight numbers.
fn recorded<'a, S: RestoringForce + Clone + 'a>(name: &str, specimen: &S) -> [Case<'a>; 2] {
    let input = example_1();
    let (first, second) = (specimen.clone(), specimen.clone());
    let (mut rows, mut kernel_rows) = (Vec::<StepRow>::new(), Vec::<StepRow>::new());
    [
        case(&format!("impact, {name}, recorded"), STEPS, move || {
            rows.clear();
            let end = simulate(
                &input,
                &mut first.clone(),
                None,
                u64::from(STEPS),
                &mut rows,
            );
            black_box(end).expect("an impact");
        }),
        case(
            &format!("impact, {name}, recorded: kernel"),
            STEPS,
            move || {
                kernel_rows.clear();
                black_box(kernel::impact(
                    &input,
                    &mut second.clone(),
                    STEPS,
                    &mut kernel_rows,
                ));
            },
        ),
    ]
}

/// The same without rows.
fn bare<'a>() -> [Case<'a>; 3] {
    let input = example_1();
    [
        case("impact, elastic, bare", STEPS, move || {
            let end = simulate(&input, &mut { SPECIMEN }, None, u64::from(STEPS), &mut ());
            black_box(end).expect("an impact");
        }),
        case("impact, elastic, bare: kernel", STEPS, move || {
            black_box(kernel::impact(&input, &mut { SPECIMEN }, STEPS, &mut ()));
        }),
        case("impact, elastic, step by step", STEPS, move || {
            let mut specimen = SPECIMEN;
            let mut solver = ImpactSolver::new(&input, 0.0, 0.0).expect("an impact");
            for _ in 0..STEPS {
                let displacement = solver.predict();
                solver.complete(displacement, specimen.move_to(displacement));
            }
            black_box(*solver.state());
        }),
    ]
}

/// One degree of freedom under a load, three numbers recorded.
fn linear<'a>() -> [Case<'a>; 2] {
    let [mass, damping, stiffness] = black_box([1.0, 2.0, SPECIMEN.stiffness]);
    let (mut rows, mut kernel_rows) = (Vec::new(), Vec::new());
    [
        case("one degree of freedom, recorded", STEPS, move || {
            let matrices = Matrices {
                mass,
                damping,
                stiffness,
                gravity: None,
            };
            let input = SolverInput {
                elements: None,
                matrices: &matrices,
                operator_stiffness: &stiffness,
                integrator: Integrator::Tangent,
                i_modification: false,
                tangents: Tangents::Initial,
                time_step: 1e-3,
                initial_displacement: 0.1,
                initial_restoring_force: stiffness * 0.1,
                initial_load: 0.0,
                readings: &[],
            };
            let mut solver = Solver::<f64>::new(&input).expect("a mass on a spring");
            rows.clear();
            for _ in 0..STEPS {
                let target = solver.predict(0.0);
                let state = solver.complete(target, stiffness * target);
                rows.push([state.displacement, state.velocity, state.acceleration]);
            }
            black_box(solver.state().energies.error);
        }),
        case(
            "one degree of freedom, recorded: kernel",
            STEPS,
            move || {
                kernel_rows.clear();
                let matrices = [mass, damping, stiffness];
                black_box(kernel::linear(matrices, 1.0, 1e-3, STEPS, &mut kernel_rows));
            },
        ),
    ]
}

/// Scattered impacts, all in lanes.
fn study<'a>(name: &str, law: ContactLaw, specimen: &SpecimenModel, wanted: Wanted) -> Case<'a> {
    let impact = |run: u32| Impact {
        input: ImpactInput {
            striker_velocity: 1.0 + 1e-5 * f64::from(run),
            law,
            ..example_1()
        },
        specimen: specimen.clone(),
    };
    let impacts: Vec<Impact> = (0..RUNS).map(impact).collect();
    case(&format!("study, {name}"), RUNS * STEPS, move || {
        black_box(batch::run(
            &impacts,
            Some(Until::Duration),
            u64::from(STEPS),
            wanted,
        ));
    })
}

/// Storeys of 1500 kg and 2 MN/m, C = 0.5 M + 0.0005 K, under 10 m/s² at 2 Hz in steps of 2 ms: the specimen's storeys included.
fn building<'a, S: RestoringForce + Copy + 'a>(
    name: &str,
    storeys: usize,
    (integrator, tangents): (Integrator, Tangents),
    storey: S,
) -> Case<'a> {
    let mass = SymmetricBand::diagonal(&vec![1500.0; storeys]);
    let stiffness = storey_stiffness(&vec![storey.initial_stiffness(); storeys]);
    let mut damping = SymmetricBand::zero(storeys, 0);
    damping.add(&mass, 0.5);
    damping.add(&stiffness, 5e-4);
    let matrices = black_box(FrameMatrices {
        mass,
        damping,
        stiffness,
        gravity: None,
    });
    let zero = vec![0.0; storeys];
    let mut solver = FrameSolver::new(&FrameInput {
        elements: None,
        matrices: &matrices,
        operator_stiffness: &matrices.stiffness,
        integrator,
        i_modification: false,
        tangents,
        time_step: 2e-3,
        initial_displacement: &zero,
        initial_restoring_force: &zero,
        initial_load: &zero,
        readings: &[],
    })
    .expect("a building");
    let mut specimen = vec![storey; storeys];
    let (mut load, mut drift, mut force) = (zero.clone(), zero.clone(), zero.clone());
    let (mut shear, mut target) = (zero.clone(), zero.clone());
    let count = u32::try_from(30_000 / (storeys + 20)).expect("small");
    let mut done = 0_u32;
    case(&format!("{storeys} storeys, {name}"), count, move || {
        for _ in 0..count {
            done += 1;
            // A triangle: a sine would cost as much as a storey.
            let part = f64::from(done % 250) / 125.0 - 1.0;
            matrices.ground_load(20.0 * part.abs() - 10.0, &mut load);
            target.copy_from_slice(solver.predict(&load));
            drifts(&target, &mut drift);
            for ((shear, drift), storey) in shear.iter_mut().zip(&drift).zip(&mut specimen) {
                *shear = storey.move_to(*drift);
            }
            floor_forces(&shear, &mut force);
            solver.complete(&target, &force);
        }
        black_box(solver.state().displacement[0]);
    })
}

/// All cases.
pub fn all<'a>() -> Vec<Case<'a>> {
    let elastic = SpecimenModel::Elastic(SPECIMEN);
    let bilinear = SpecimenModel::Bilinear(yielding());
    let storey = Elastic { stiffness: 2e6 };
    let yielding_storey = Bilinear::new(BilinearCurve {
        stiffness: 2e6,
        yield_force: 2e4,
        post_yield_ratio: 0.05,
    });
    let initial = (Integrator::Tangent, Tangents::Initial);
    let secants = (
        Integrator::Tangent,
        Tangents::Storeys { largest_ratio: 2.0 },
    );
    let alpha_os = (Integrator::AlphaOs { alpha: -0.05 }, Tangents::Initial);
    let mut cases: Vec<Case> = Vec::new();
    cases.extend(recorded("elastic", &SPECIMEN));
    cases.extend(recorded("bilinear", &yielding()));
    cases.extend(bare());
    cases.extend(linear());
    for storeys in [2, 10, 100, 1000] {
        cases.push(building("elastic", storeys, initial, storey));
        cases.push(building("bilinear", storeys, secants, yielding_storey));
        cases.push(building(
            "bilinear, α-OS",
            storeys,
            alpha_os,
            yielding_storey,
        ));
    }
    let limited = ContactLaw::Limit { force: 100.0 };
    // A study of the largest displacement alone, and one of everything.
    for (wanted, results) in [(Wanted::default(), "peak"), (Wanted::ALL, "all results")] {
        for (name, law, specimen) in [
            ("elastic", ContactLaw::Rigid, &elastic),
            ("bilinear", ContactLaw::Rigid, &bilinear),
            ("elastic, limit force", limited, &elastic),
        ] {
            cases.push(study(&format!("{name}, {results}"), law, specimen, wanted));
        }
    }
    cases
}
