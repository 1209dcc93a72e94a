//! The cases of the self-test. In: nothing. Out: results with their derived answers.

use super::runs::{
    displacement_on_moving_ground, free_vibration, impact, impact_of, input, struck_storey,
};
use super::{Quantity, SelfTest, SelfTestPart};
use crate::contact::ContactLaw;
use crate::critical_time_step;
use crate::identification::fit_line;
use crate::impact::ImpactInput;
use crate::integrator::Integrator;

fn number(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}

/// Melo et al. 2006.
pub(super) fn papers() -> Vec<SelfTest> {
    const RIGID: &[SelfTestPart] = &[SelfTestPart::Tangent, SelfTestPart::Rigid];
    const LIMIT: &[SelfTestPart] = &[SelfTestPart::Tangent, SelfTestPart::Limit];
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

/// k of Hertz's law \[N/m^1.5\].
const HERTZ: f64 = 1e7;

/// One degree of freedom with the other integrators and laws.
pub(super) fn one_degree() -> Vec<SelfTest> {
    let free = |integrator| SelfTest {
        case: "free vibration from 1 m, ω Δt = 1",
        result: "displacement after 4 steps",
        quantity: Quantity::Length,
        computed: free_vibration(integrator),
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
            parts: &[SelfTestPart::Explicit],
            ..free(Integrator::Explicit)
        },
        SelfTest {
            expected: -0.852_814_186_383,
            parts: &[SelfTestPart::AlphaOs],
            ..free(Integrator::AlphaOs { alpha: -0.1 })
        },
        rigid(
            Integrator::Explicit,
            0.157_185,
            &[SelfTestPart::Explicit, SelfTestPart::Rigid],
        ),
        limited(
            Integrator::Explicit,
            0.165_285,
            &[SelfTestPart::Explicit, SelfTestPart::Limit],
        ),
        rigid(
            Integrator::AlphaOs { alpha: -0.1 },
            0.157_791,
            &[SelfTestPart::AlphaOs, SelfTestPart::Rigid],
        ),
        limited(
            Integrator::AlphaOs { alpha: -0.1 },
            0.165_524,
            &[SelfTestPart::AlphaOs, SelfTestPart::Limit],
        ),
        collisions(
            "example 1, hard collisions",
            exact.max_displacement,
            &[SelfTestPart::Tangent, SelfTestPart::Restitution],
        ),
        hertz(
            "free masses of 1 kg and 10 kg",
            soft.max_contact_force,
            &[SelfTestPart::Tangent, SelfTestPart::Hertz],
        ),
    ]
}

fn displacement(
    case: &'static str,
    computed: f64,
    expected: f64,
    parts: &'static [SelfTestPart],
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

fn collisions(case: &'static str, computed: f64, parts: &'static [SelfTestPart]) -> SelfTest {
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

fn hertz(case: &'static str, computed: f64, parts: &'static [SelfTestPart]) -> SelfTest {
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

/// Two storeys on moving ground, and one that is struck.
pub(super) fn frames() -> Vec<SelfTest> {
    let on_moving_ground = |integrator, expected, parts| SelfTest {
        case: "two storeys on ground of 1 m/s², Δt = 20 ms",
        result: "top displacement after 6 steps",
        quantity: Quantity::Length,
        computed: displacement_on_moving_ground(integrator),
        expected,
        tolerance: 1e-13,
        parts,
    };
    let rigid = |integrator, expected, parts| {
        let (computed, _) = struck_storey(integrator, 327.65, ContactLaw::Rigid, 0.01);
        displacement("example 1 on a storey, rigid", computed, expected, parts)
    };
    let limited = |integrator, expected, parts| {
        let (computed, _) =
            struck_storey(integrator, 300.0, ContactLaw::Limit { force: 1500.0 }, 1e-3);
        displacement(
            "figure 11 on a storey, limit 1500 N",
            computed,
            expected,
            parts,
        )
    };
    let alpha = Integrator::AlphaOs { alpha: -0.1 };
    let (hard, _) = struck_storey(
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
    let (_, soft) = struck_storey(Integrator::Tangent, 1e-3, free, 2e-6);
    vec![
        on_moving_ground(
            Integrator::Tangent,
            -5.132_347_348_85e-3,
            &[SelfTestPart::FrameTangent],
        ),
        on_moving_ground(
            Integrator::Explicit,
            -5.241_088e-3,
            &[SelfTestPart::FrameExplicit],
        ),
        on_moving_ground(alpha, -5.110_555_718_17e-3, &[SelfTestPart::FrameAlphaOs]),
        rigid(
            Integrator::Tangent,
            0.157_864,
            &[SelfTestPart::FrameTangent, SelfTestPart::FrameRigid],
        ),
        rigid(
            Integrator::Explicit,
            0.157_185,
            &[SelfTestPart::FrameExplicit, SelfTestPart::FrameRigid],
        ),
        rigid(
            alpha,
            0.157_791,
            &[SelfTestPart::FrameAlphaOs, SelfTestPart::FrameRigid],
        ),
        limited(
            Integrator::Tangent,
            0.165_524,
            &[SelfTestPart::FrameTangent, SelfTestPart::FrameLimit],
        ),
        limited(
            Integrator::Explicit,
            0.165_285,
            &[SelfTestPart::FrameExplicit, SelfTestPart::FrameLimit],
        ),
        limited(
            alpha,
            0.165_524,
            &[SelfTestPart::FrameAlphaOs, SelfTestPart::FrameLimit],
        ),
        collisions(
            "example 1 on a storey, hard collisions",
            hard,
            &[SelfTestPart::FrameTangent, SelfTestPart::FrameRestitution],
        ),
        hertz(
            "free masses, one a storey",
            soft,
            &[SelfTestPart::FrameTangent, SelfTestPart::FrameHertz],
        ),
    ]
}

/// A line through (0, 1), (1, 3), (2, 4), (3, 4): slope 1 with the standard error √0.1.
pub(super) fn fits() -> Vec<SelfTest> {
    let fit = fit_line(&[0.0, 1.0, 2.0, 3.0], &[1.0, 3.0, 4.0, 4.0]);
    let line = |result, computed, expected| SelfTest {
        case: "line through four points",
        result,
        quantity: Quantity::Number,
        computed: number(computed),
        expected,
        tolerance: 1e-12,
        parts: &[SelfTestPart::LineFit],
    };
    vec![
        line("slope", fit.map(|fit| fit.slope), 1.0),
        line(
            "standard error of the slope",
            fit.map(|fit| fit.slope_error),
            0.316_227_766_017,
        ),
    ]
}
