//! The program tested by itself: cases whose answers were derived without it, reckoned by the very code of a run. In:
//! nothing. Out: what came out beside what must, and which parts of the program each case goes through. A report prints the
//! cases of the parts that its run went through, so that whoever reads the numbers sees that they still reckon right, and
//! which parts no case goes through.
//!
//! The answers. Melo et al. 2006, examples 1 and 2 and Fig. 11, to the digits of an event-driven solution and of the scheme
//! itself at the printed step; the critical time step is its eq. (7). Free vibration by explicit Newmark is
//! cos nθ with cos θ = 1 − (ωΔt)²/2. By α-OS, with `K_I` = K, it is that of the implicit α-method (Hilber, Hughes and
//! Taylor 1977), reckoned apart. A frame on ground of constant acceleration is the sum of its modes,
//! `u_st`(1 − cos nθ), θ of each as above, by the tangent form with tan ½θ = ½ωΔt. The hard collisions of `restitution` are those of the
//! event-driven solution; the largest force of `hertz` between free masses is k^0.4 (1.25 μ v²)^0.6. Explicit Newmark and α-OS with
//! a contact were stepped apart from the program, by the equations in the head of `split`.

use std::sync::OnceLock;

use super::contact::state::ContactLaw;
use super::critical_time_step;
use super::frame::{
    FrameInput, FrameMatrices, FrameSolver, SymmetricBand, Tangents, storey_stiffness,
};
use super::identification::fit_line;
use super::impact::summary::{ImpactSummary, SummaryBuilder};
use super::impact::{FrameImpactSolver, ImpactInput, ImpactSolver, Striking, simulate};
use super::specimen::Elastic;
use crate::impact::Until;
use crate::integrator::Integrator;

/// A part of the program that a run may go through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// How one degree of freedom is integrated.
    Tangent,
    Explicit,
    AlphaOs,
    /// How it is struck.
    Rigid,
    Limit,
    Restitution,
    Hertz,
    /// How a frame is integrated.
    FrameTangent,
    FrameExplicit,
    FrameAlphaOs,
    /// How one of its storeys is struck.
    FrameRigid,
    FrameLimit,
    FrameRestitution,
    FrameHertz,
    LineFit,
    CurveFit,
    DampingFit,
    Loops,
    Unloading,
    IModification,
    Continuous,
}

impl Part {
    /// As a report names it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tangent => "the tangent form",
            Self::Explicit => "explicit Newmark",
            Self::AlphaOs => "α-operator splitting",
            Self::Rigid => "rigid contact",
            Self::Limit => "contact with a limit force",
            Self::Restitution => "contact by restitution",
            Self::Hertz => "Hertz's contact",
            Self::FrameTangent => "the tangent form of a frame",
            Self::FrameExplicit => "explicit Newmark of a frame",
            Self::FrameAlphaOs => "α-operator splitting of a frame",
            Self::FrameRigid => "rigid contact on a storey",
            Self::FrameLimit => "contact with a limit force on a storey",
            Self::FrameRestitution => "contact by restitution on a storey",
            Self::FrameHertz => "Hertz's contact on a storey",
            Self::LineFit => "the fit of a straight line",
            Self::CurveFit => "the fit of several lines",
            Self::DampingFit => "the fit of a damping sweep",
            Self::Loops => "the loops of a cycle",
            Self::Unloading => "the way to where no load is carried",
            Self::IModification => "the I-modification",
            Self::Continuous => "continuous motion",
        }
    }
}

/// What a number of a case measures; it is in the SI unit of that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Number,
    /// m
    Length,
    /// s
    Time,
    /// N
    Force,
}

/// One number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfTest {
    pub case: &'static str,
    pub result: &'static str,
    pub quantity: Quantity,
    /// SI.
    pub computed: f64,
    /// SI.
    pub expected: f64,
    /// How far the scheme at this step may be from what was derived; else half a unit of the last digit that was. SI.
    pub tolerance: f64,
    /// What it goes through.
    pub parts: &'static [Part],
}

impl SelfTest {
    /// Whether the program gives what was derived.
    #[must_use]
    pub fn passed(&self) -> bool {
        (self.computed - self.expected).abs() <= self.tolerance
    }
}

/// Every case. They take some ten thousand steps, a few milliseconds, once.
#[must_use]
pub fn all() -> &'static [SelfTest] {
    static ALL: OnceLock<Vec<SelfTest>> = OnceLock::new();
    ALL.get_or_init(|| [papers(), one_degree(), frames(), fits()].concat())
}

/// Whether every case gives what was derived.
#[must_use]
pub fn passed() -> bool {
    all().iter().all(SelfTest::passed)
}

/// Whether a case goes through all of these parts together, as an integrator and a contact law work together.
#[must_use]
pub fn covers(parts: &[Part]) -> bool {
    all()
        .iter()
        .any(|test| parts.iter().all(|part| test.parts.contains(part)))
}

fn number(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}

/// Melo et al. 2006.
fn papers() -> Vec<SelfTest> {
    const RIGID: &[Part] = &[Part::Tangent, Part::Rigid];
    const LIMIT: &[Part] = &[Part::Tangent, Part::Limit];
    let case = |case, result, quantity, computed, expected, tolerance, parts| SelfTest {
        case,
        result,
        quantity,
        computed,
        expected,
        tolerance,
        parts,
    };
    let (one, two) = (
        impact(1.0, 327.65, ContactLaw::Rigid, 0.01),
        impact(0.25, 327.65, ContactLaw::Rigid, 0.01),
    );
    let limited = impact(1.0, 300.0, ContactLaw::Limit { force: 1500.0 }, 0.001);
    vec![
        case(
            "example 1, rigid",
            "largest displacement",
            Quantity::Length,
            one.max_displacement,
            0.157_864,
            5e-7,
            RIGID,
        ),
        case(
            "example 1, rigid",
            "the striker stops at",
            Quantity::Time,
            number(one.stop_time),
            0.29,
            1e-9,
            RIGID,
        ),
        case(
            "example 1",
            "critical time step",
            Quantity::Time,
            critical_time_step(1.0, 327.65),
            0.0347,
            5e-5,
            RIGID,
        ),
        case(
            "example 2, rigid",
            "largest displacement",
            Quantity::Length,
            two.max_displacement,
            0.168_965,
            5e-7,
            RIGID,
        ),
        case(
            "figure 11, limit 1500 N",
            "largest displacement",
            Quantity::Length,
            limited.max_displacement,
            0.165_524,
            5e-7,
            LIMIT,
        ),
        case(
            "figure 11, limit 1500 N",
            "the striker stops at",
            Quantity::Time,
            number(limited.stop_time),
            0.3,
            1e-9,
            LIMIT,
        ),
    ]
}

/// k of Hertz's law of the case, N/m^1.5.
const HERTZ: f64 = 1e7;

/// One degree of freedom under the other integrators and laws.
fn one_degree() -> Vec<SelfTest> {
    let free = |integrator| SelfTest {
        case: "free vibration from 1 m, ω Δt = 1",
        result: "displacement after 4 steps",
        quantity: Quantity::Length,
        computed: vibration(integrator),
        expected: 0.0,
        tolerance: 1e-12,
        parts: &[],
    };
    let by = |integrator, stiffness, law, time_step| {
        impact_of(&ImpactInput {
            integrator,
            ..input(1.0, stiffness, law, time_step)
        })
        .max_displacement
    };
    let rigid = |integrator, expected, parts| {
        displacement(
            "example 1, rigid",
            by(integrator, 327.65, ContactLaw::Rigid, 0.01),
            expected,
            parts,
        )
    };
    let limited = |integrator, expected, parts| {
        let computed = by(integrator, 300.0, ContactLaw::Limit { force: 1500.0 }, 1e-3);
        displacement("figure 11, limit 1500 N", computed, expected, parts)
    };
    let exact = impact(
        1.0,
        327.65,
        ContactLaw::Restitution {
            coefficient: 10.0 / 12.0,
        },
        1e-3,
    );
    let soft = impact(
        1.0,
        1e-3,
        ContactLaw::Hertz {
            stiffness: HERTZ,
            loss: 0.0,
            force_limit: None,
        },
        2e-6,
    );
    vec![
        SelfTest {
            expected: -0.5,
            parts: &[Part::Explicit],
            ..free(Integrator::Explicit)
        },
        SelfTest {
            expected: -0.852_814_186_383,
            parts: &[Part::AlphaOs],
            ..free(Integrator::AlphaOs { alpha: -0.1 })
        },
        rigid(
            Integrator::Explicit,
            0.157_185,
            &[Part::Explicit, Part::Rigid],
        ),
        limited(
            Integrator::Explicit,
            0.165_285,
            &[Part::Explicit, Part::Limit],
        ),
        rigid(
            Integrator::AlphaOs { alpha: -0.1 },
            0.157_791,
            &[Part::AlphaOs, Part::Rigid],
        ),
        limited(
            Integrator::AlphaOs { alpha: -0.1 },
            0.165_524,
            &[Part::AlphaOs, Part::Limit],
        ),
        collisions(
            "example 1, hard collisions",
            exact.max_displacement,
            &[Part::Tangent, Part::Restitution],
        ),
        hertz(
            "free masses of 1 kg and 10 kg",
            soft.max_contact_force,
            &[Part::Tangent, Part::Hertz],
        ),
    ]
}

fn displacement(
    case: &'static str,
    computed: f64,
    expected: f64,
    parts: &'static [Part],
) -> SelfTest {
    let (result, quantity) = ("largest displacement", Quantity::Length);
    SelfTest {
        case,
        result,
        quantity,
        computed,
        expected,
        tolerance: 5e-7,
        parts,
    }
}

fn collisions(case: &'static str, computed: f64, parts: &'static [Part]) -> SelfTest {
    let (result, quantity) = ("largest displacement", Quantity::Length);
    SelfTest {
        case,
        result,
        quantity,
        computed,
        expected: 0.157_698,
        tolerance: 2e-6,
        parts,
    }
}

fn hertz(case: &'static str, computed: f64, parts: &'static [Part]) -> SelfTest {
    let (result, quantity) = ("largest contact force", Quantity::Force);
    SelfTest {
        case,
        result,
        quantity,
        computed,
        expected: 681.256,
        tolerance: 0.01,
        parts,
    }
}

/// Two storeys on ground that moves, and one that is struck.
fn frames() -> Vec<SelfTest> {
    let shaken = |integrator, expected, parts| SelfTest {
        case: "two storeys on ground of 1 m/s², Δt = 20 ms",
        result: "top displacement after 6 steps",
        quantity: Quantity::Length,
        computed: shaken(integrator),
        expected,
        tolerance: 1e-13,
        parts,
    };
    let rigid = |integrator, expected, parts| {
        let (computed, _) = struck(integrator, 327.65, ContactLaw::Rigid, 0.01);
        displacement("example 1 on a storey, rigid", computed, expected, parts)
    };
    let limited = |integrator, expected, parts| {
        let (computed, _) = struck(integrator, 300.0, ContactLaw::Limit { force: 1500.0 }, 1e-3);
        displacement(
            "figure 11 on a storey, limit 1500 N",
            computed,
            expected,
            parts,
        )
    };
    let alpha = Integrator::AlphaOs { alpha: -0.1 };
    let (hard, _) = struck(
        Integrator::Tangent,
        327.65,
        ContactLaw::Restitution {
            coefficient: 10.0 / 12.0,
        },
        1e-3,
    );
    let free = ContactLaw::Hertz {
        stiffness: HERTZ,
        loss: 0.0,
        force_limit: None,
    };
    let (_, soft) = struck(Integrator::Tangent, 1e-3, free, 2e-6);
    vec![
        shaken(
            Integrator::Tangent,
            -5.132_347_348_85e-3,
            &[Part::FrameTangent],
        ),
        shaken(Integrator::Explicit, -5.241_088e-3, &[Part::FrameExplicit]),
        shaken(alpha, -5.110_555_718_17e-3, &[Part::FrameAlphaOs]),
        rigid(
            Integrator::Tangent,
            0.157_864,
            &[Part::FrameTangent, Part::FrameRigid],
        ),
        rigid(
            Integrator::Explicit,
            0.157_185,
            &[Part::FrameExplicit, Part::FrameRigid],
        ),
        rigid(alpha, 0.157_791, &[Part::FrameAlphaOs, Part::FrameRigid]),
        limited(
            Integrator::Tangent,
            0.165_524,
            &[Part::FrameTangent, Part::FrameLimit],
        ),
        limited(
            Integrator::Explicit,
            0.165_285,
            &[Part::FrameExplicit, Part::FrameLimit],
        ),
        limited(alpha, 0.165_524, &[Part::FrameAlphaOs, Part::FrameLimit]),
        collisions(
            "example 1 on a storey, hard collisions",
            hard,
            &[Part::FrameTangent, Part::FrameRestitution],
        ),
        hertz(
            "free masses, one a storey",
            soft,
            &[Part::FrameTangent, Part::FrameHertz],
        ),
    ]
}

/// A line through (0, 1), (1, 3), (2, 4), (3, 4): slope 1 with the standard error √0.1.
fn fits() -> Vec<SelfTest> {
    let fit = fit_line(&[0.0, 1.0, 2.0, 3.0], &[1.0, 3.0, 4.0, 4.0]);
    let of = |result, computed, expected| SelfTest {
        case: "line through four points",
        result,
        quantity: Quantity::Number,
        computed: number(computed),
        expected,
        tolerance: 1e-12,
        parts: &[Part::LineFit],
    };
    vec![
        of("slope", fit.map(|fit| fit.slope), 1.0),
        of(
            "standard error of the slope",
            fit.map(|fit| fit.slope_error),
            0.316_227_766_017,
        ),
    ]
}

/// Ten times as many steps as the longest case of the paper takes.
const STEPS: u32 = 4000;

/// A striker of 10 kg at 1 m/s that touches an undamped, linear structure at t = 0.
fn input(mass: f64, stiffness: f64, law: ContactLaw, time_step: f64) -> ImpactInput {
    ImpactInput {
        law,
        ..ImpactInput::rigid(mass, stiffness, 10.0, 1.0, time_step)
    }
}

/// The same by the tangent form, to its end.
fn impact(mass: f64, stiffness: f64, law: ContactLaw, time_step: f64) -> ImpactSummary {
    impact_of(&input(mass, stiffness, law, time_step))
}

fn impact_of(input: &ImpactInput) -> ImpactSummary {
    let mut summary = SummaryBuilder::new(input);
    if let Ok(solver) = ImpactSolver::new(input, 0.0, 0.0) {
        summary.push(solver.state());
    }
    // A case that cannot be stepped fails by what it comes to.
    let _ = simulate(
        input,
        &mut Elastic {
            stiffness: input.stiffness,
        },
        Some(Until::StrikerStop),
        STEPS.into(),
        &mut summary,
    );
    summary.finish()
}

/// 1 kg on 400 N/m, let go at 1 m with the striker out of reach: where it is after 4 steps of 50 ms, m.
fn vibration(integrator: Integrator) -> f64 {
    const STIFFNESS: f64 = 400.0;
    let far = ImpactInput {
        gap: 1e9,
        striker_velocity: 0.0,
        integrator,
        ..input(1.0, STIFFNESS, ContactLaw::Rigid, 0.05)
    };
    let Ok(mut solver) = ImpactSolver::new(&far, 1.0, STIFFNESS) else {
        return f64::NAN;
    };
    for _ in 0..4 {
        let target = solver.predict();
        solver.complete(target, STIFFNESS * target);
    }
    solver.state().displacement
}

fn frame(storeys: usize, mass: f64, stiffness: f64) -> FrameMatrices {
    FrameMatrices {
        mass: SymmetricBand::diagonal(&vec![mass; storeys]),
        damping: SymmetricBand::zero(storeys, 0),
        stiffness: storey_stiffness(&vec![stiffness; storeys]),
    }
}

/// A frame at rest under `load` (N), each storey followed by its own tangent.
fn at_rest<'a>(
    matrices: &'a FrameMatrices,
    integrator: Integrator,
    time_step: f64,
    [zero, load]: [&'a [f64]; 2],
) -> FrameInput<'a> {
    FrameInput {
        matrices,
        operator_stiffness: &matrices.stiffness,
        integrator,
        i_modification: false,
        tangents: Tangents::Storeys { largest_ratio: 2.0 },
        time_step,
        initial_displacement: zero,
        initial_restoring_force: zero,
        initial_load: load,
        force_noise: 0.0,
        resolution: 0.0,
    }
}

/// Two storeys of 1000 kg and 1000 kN/m on ground that accelerates by 1 m/s² from t = 0 on: where the upper floor is after 6
/// steps of 20 ms, m.
fn shaken(integrator: Integrator) -> f64 {
    let matrices = frame(2, 1e3, 1e6);
    let (mut force, mut load) = ([0.0; 2], [0.0; 2]);
    matrices.ground_load(1.0, &mut load);
    let Ok(mut solver) =
        FrameSolver::new(&at_rest(&matrices, integrator, 0.02, [&[0.0; 2], &load]))
    else {
        return f64::NAN;
    };
    for _ in 0..6 {
        let target = solver.predict(&load).to_vec();
        matrices.stiffness.mul_into(&target, &mut force);
        solver.complete(&target, &force);
    }
    solver.state().displacement[1]
}

/// One storey of 1 kg, struck as the structure of [`input`] is: its largest displacement, m, and the largest contact force, N.
fn struck(integrator: Integrator, stiffness: f64, law: ContactLaw, time_step: f64) -> (f64, f64) {
    let matrices = frame(1, 1.0, stiffness);
    let frame = at_rest(&matrices, integrator, time_step, [&[0.0], &[0.0]]);
    let striking = Striking {
        struck: 0,
        mass: 10.0,
        velocity: 1.0,
        gap: 0.0,
        gravity: 0.0,
        law,
    };
    let Ok(mut solver) = FrameImpactSolver::on(&frame, &striking) else {
        return (f64::NAN, f64::NAN);
    };
    let (mut farthest, mut hardest) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS {
        if solver.finished() {
            break;
        }
        let target = solver.predict()[0];
        let state = solver.complete(&[target], &[stiffness * target]);
        farthest = farthest.max(state.displacement);
        hardest = hardest.max(state.contact_force);
    }
    (farthest, hardest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_passes_and_a_wrong_number_does_not() {
        let all = all();
        let failed: Vec<&SelfTest> = all.iter().filter(|case| !case.passed()).collect();
        assert!(all.len() >= 27 && passed(), "{failed:#?}");
        for case in all {
            let beyond = SelfTest {
                computed: case.expected + 1.01 * case.tolerance,
                ..*case
            };
            let nothing = SelfTest {
                computed: f64::NAN,
                ..*case
            };
            assert!(!beyond.passed() && !nothing.passed());
        }
    }

    #[test]
    fn every_integrator_has_its_case_with_every_contact_that_it_takes() {
        use Part::{
            AlphaOs, Explicit, FrameAlphaOs, FrameExplicit, FrameHertz, FrameLimit,
            FrameRestitution, FrameRigid,
        };
        use Part::{FrameTangent, Hertz, Limit, LineFit, Restitution, Rigid, Tangent};
        for integrator in [Tangent, Explicit, AlphaOs] {
            assert!(
                covers(&[integrator, Rigid]) && covers(&[integrator, Limit]),
                "{integrator:?}"
            );
        }
        for integrator in [FrameTangent, FrameExplicit, FrameAlphaOs] {
            assert!(
                covers(&[integrator, FrameRigid]) && covers(&[integrator, FrameLimit]),
                "{integrator:?}"
            );
            assert!(
                all().iter().any(|case| case.parts == [integrator]),
                "{integrator:?} without a blow"
            );
        }
        assert!(covers(&[Tangent, Restitution]) && covers(&[Tangent, Hertz]) && covers(&[LineFit]));
        assert!(covers(&[FrameTangent, FrameRestitution]) && covers(&[FrameTangent, FrameHertz]));
        assert!(!covers(&[Part::DampingFit]) && !covers(&[Tangent, FrameRigid]));
        assert!(all().iter().all(|case| !case.parts.is_empty()));
    }
}
