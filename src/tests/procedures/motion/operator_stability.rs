//! Runs on specimens that are stiffer than α-OS assumes, and on others. One spring and storeys, ramp-and-hold and continuous, with
//! dampers and friction in the readings.

use crate::run::Unwatched;
use crate::tests::testing::{elastic_plan, impact, struck_frame};
use psd_plan::formula::Formula::Constant;
use psd_plan::{
    Behaviour, Contact, Impact, Integrator, Link, Mode, Plan, ProcedureKind, Stepping, Until,
    VirtualLink,
};
use psd_rig::virtual_rig;

const CONTINUOUS: Mode = Mode::Continuous { time_scale: 50.0 };
const NOISY: VirtualLink = VirtualLink {
    noise: 0.005,
    resolution: 1e-7,
    force_resolution: 0.0,
    lag: 0.05,
    tracking: 0.0,
    drift: 0.0,
    seed: 3,
    predicted: None,
};

fn remarks(mut plan: Plan, link: VirtualLink) -> Vec<String> {
    plan.rig.link = Link::Virtual(link);
    plan.limits.tracking_energy_error.high = 1e6;
    let record = crate::run::run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched);
    record
        .events
        .into_iter()
        .map(|event| event.text)
        .filter(|text| text.starts_with("W718"))
        .collect()
}

fn splitting(stepping: &Stepping, mode: Mode) -> Stepping {
    let integrator = Integrator::AlphaOs { alpha: 0.0 };
    Stepping {
        integrator,
        mode,
        i_modification: true,
        time_step: Constant(0.002),
        ..stepping.clone()
    }
}

/// 300 N/m on 1 kg, assumed as 250 N/m: 2/√50 s = 0.28 s is left.
#[test]
fn a_stiffer_spring_is_reported_in_both_modes() {
    let of = |mode: Mode, operator: f64, link: VirtualLink| {
        let struck = impact(Constant(operator));
        let struck = Impact {
            stepping: splitting(&struck.stepping, mode),
            until: Until::Duration,
            ..struck
        };
        let mut plan = elastic_plan(300.0, vec![ProcedureKind::Impact(struck)]);
        plan.strikers[0].mass = 0.5;
        plan.specimens[0].damping = 10.0;
        plan.specimens[0].coulomb = 0.05;
        remarks(plan, link)
    };
    for link in [VirtualLink::default(), NOISY] {
        for mode in [Mode::RampAndHold, CONTINUOUS] {
            let texts = of(mode, 250.0, link);
            assert_eq!(texts.len(), 1, "{mode:?}, {link:?}: {texts:?}");
            assert!(
                texts[0].contains("the specimen is stiffer")
                    && texts[0].contains("K_I = 250.0 N/m"),
                "{}",
                texts[0]
            );
        }
        // A damper, or friction that reverses, is not mistaken for stiffness.
        for mode in [Mode::RampAndHold, CONTINUOUS] {
            assert_eq!(
                of(mode, 310.0, link),
                Vec::<String>::new(),
                "{mode:?}, {link:?}"
            );
        }
    }
    let measured = of(CONTINUOUS, 250.0, VirtualLink::default());
    assert!(
        measured[0].contains(", 300.0 N/m measured")
            && measured[0].contains("not exceeded here (2.000 ms)"),
        "{measured:?}"
    );
}

/// Two storeys. The upper one has 450 N/m where the frame states 300 N/m, between floors of 1 kg each: 2/√(150·2) s = 0.1155 s.
#[test]
fn a_stiffer_storey_is_reported_by_its_number_in_both_modes() {
    let of = |mode: Mode, upper: f64, link: VirtualLink| {
        let mut plan = struck_frame();
        if let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind {
            impact.stepping = splitting(&impact.stepping, mode);
            impact.contact = Contact::Limit {
                force: Constant(200.0),
            };
            impact.duration = Constant(0.5);
        }
        plan.strikers[0].mass = 0.5;
        let frame = plan.specimens[0].frame.as_mut().unwrap();
        for (storey, stiffness) in frame.storeys.iter_mut().zip([500.0, upper]) {
            storey.behaviour = Behaviour::Elastic { stiffness };
            (storey.damping, storey.coulomb) = (5.0, 0.02);
        }
        remarks(plan, link)
    };
    for link in [VirtualLink::default(), NOISY] {
        for mode in [Mode::RampAndHold, CONTINUOUS] {
            let texts = of(mode, 450.0, link);
            assert_eq!(texts.len(), 1, "{mode:?}, {link:?}: {texts:?}");
            assert!(
                texts[0].contains("storey 2 is stiffer") && texts[0].contains("K_I = 300.0 N/m"),
                "{}",
                texts[0]
            );
        }
        for mode in [Mode::RampAndHold, CONTINUOUS] {
            assert_eq!(
                of(mode, 300.0, link),
                Vec::<String>::new(),
                "{mode:?}, {link:?}"
            );
        }
    }
    let texts = of(CONTINUOUS, 450.0, VirtualLink::default());
    assert!(
        texts[0].contains(", 450.0 N/m measured") && texts[0].contains("up to 0.1155 s"),
        "{texts:?}"
    );
}

/// 300 N/m on 1 kg, assumed as 100 N/m, in steps that are stable for 100 N/m. Explicit Newmark beyond 2/√300 s = 0.1155 s, and α-OS
/// beyond 2/√200 s = 0.1414 s, reverse at every step.
#[test]
fn a_response_that_reverses_at_every_step_is_reported() {
    for (integrator, expected) in [
        (Integrator::Explicit, "stable up to 0.1155 s"),
        (
            Integrator::AlphaOs { alpha: 0.0 },
            "stable up to 0.1414 s only, exceeded here",
        ),
    ] {
        let of = |stated: f64| {
            let struck = impact(Constant(stated));
            let stepping = Stepping {
                integrator,
                time_step: Constant(0.15),
                ..struck.stepping
            };
            let struck = Impact {
                stepping,
                until: Until::Duration,
                duration: Constant(3.0),
                ..struck
            };
            let mut plan = elastic_plan(300.0, vec![ProcedureKind::Impact(struck)]);
            plan.strikers[0].mass = 0.5;
            remarks(plan, VirtualLink::default())
        };
        let texts = of(100.0);
        assert_eq!(texts.len(), 1, "{integrator:?}: {texts:?}");
        assert!(
            texts[0].contains(expected) && texts[0].contains("300.0 N/m"),
            "{}",
            texts[0]
        );
    }
}
