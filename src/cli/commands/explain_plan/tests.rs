//! Dry runs of example 1 of Melo et al. 2006: its numbers, its stop at a limit, its specimen without a restoring-force model.

use super::*;
use psd::run::Unwatched;
use psd_plan::{Interval, Limits, Link, ProcedureKind, VirtualLink};
use psd_rig::virtual_rig;
use psd_testing::plans::{empty_plan, every};

/// Example 1 of Melo et al. 2006, with the actuator allowed to go to `farthest`.
fn example(farthest: f64) -> Plan {
    use psd_plan::formula::Formula::Constant;
    use psd_plan::{
        Behaviour, Contact, Impact, ImpactTarget, PointTarget, Procedure, RigPlan, Settle,
        Specimen, Stepping, Striker, Until,
    };
    let specimen = Specimen::new("beam", 1.0, Some(Behaviour::Elastic { stiffness: 327.65 }));
    let impact = Impact {
        specimen: 0,
        striker: 0,
        target: ImpactTarget::Point(PointTarget {
            mass: Constant(1.0),
            mass_uncertainty: 0.0,
            stiffness: Constant(327.65),
            damping: Constant(0.0),
        }),
        contact: Contact::Rigid,
        stepping: Stepping {
            max_tangent_ratio: Constant(2.0),
            ..every(0.01)
        },
        duration: Constant(1.0),
        until: Until::StrikerStop,
    };
    Plan {
        title: "Example 1".to_owned(),
        specimens: vec![specimen],
        strikers: vec![Striker::new("hammer", 10.0, 1.0)],
        rig: RigPlan {
            name: "noisy".to_owned(),
            link: Link::Virtual(VirtualLink {
                noise: 5.0,
                lag: 0.1,
                ..VirtualLink::default()
            }),
            settle: Settle {
                band: 0.0,
                force_rate: 0.0,
                dwell: 0.0,
                timeout: 10.0,
            },
            ..empty_plan().rig
        },
        limits: Limits {
            displacement: Interval {
                low: -0.1,
                high: farthest,
            },
            ..Limits::NONE
        },
        procedures: vec![Procedure {
            name: "hit".to_owned(),
            kind: ProcedureKind::Impact(impact),
        }],
        ..empty_plan()
    }
}

#[test]
fn the_papers_first_example_is_predicted_without_the_rigs_noise() {
    let plan = example(0.2);
    let dry = DryRun::of(&plan);
    let text = dry.text(Settings::PLAIN);
    // Critical step (2π/10)√(M/K), the paper's largest displacement, and the remaining margin to the limit.
    for expected in [
        "34.71 ms",
        "10.00 ms, 0.288 of it",
        "0.1579 m",
        "42.14 mm",
        "`noisy`",
    ] {
        assert!(text.contains(expected), "{expected} in\n{text}");
    }
    assert_eq!(dry.exit(), Exit::Met);
}

#[test]
fn a_specimen_without_behaviour_is_not_run_dry() {
    let mut plan = example(0.2);
    assert!(
        Explained::of(&plan)
            .text(Settings::PLAIN)
            .contains("peak displacement")
    );
    plan.specimens[0].behaviour = None;
    let explained = Explained::of(&plan);
    assert!(
        explained
            .text(Settings::PLAIN)
            .starts_with("no dry run: specimen `beam`"),
        "{}",
        explained.text(Settings::PLAIN)
    );
    assert_eq!(explained.exit(), Exit::Met);
}

#[test]
fn a_limit_that_would_stop_the_run_is_reported() {
    let plan = example(0.1);
    let dry = DryRun::of(&plan);
    assert!(
        dry.text(Settings::PLAIN)
            .contains("The run would be stopped in hit"),
        "{}",
        dry.text(Settings::PLAIN)
    );
    assert_eq!(dry.exit(), Exit::Stopped);
}

/// The verdict and the last column of the only requirement, as predicted.
fn predicted(plan: &Plan) -> (String, String) {
    let rows = DryRun::of(plan).requirements();
    (rows[0][0].clone(), rows[0].last().unwrap().clone())
}

/// Example 1 with a requirement that is met by far.
fn required(rule: DecisionRule) -> Plan {
    use psd_plan::formula::Formula::Constant;
    use psd_plan::{Comparison, Requirement, Test};
    use psd_testing::plans::result_of;
    let condition = Condition {
        text: "hit.max_displacement < 1 m".to_owned(),
        value: result_of(0, "max_displacement"),
        test: Test::Compare {
            comparison: Comparison::Less,
            limit: Constant(1.0),
        },
        dimension: Dimension::LENGTH,
    };
    Plan {
        decision_rule: rule,
        requirements: vec![Requirement {
            label: "stays".to_owned(),
            conditions: vec![condition],
        }],
        ..example(0.2)
    }
}

/// On a real rig without declared calibrations no verdict is possible under the guarded rule, and none is predicted. Simple acceptance
/// decides, without U.
#[test]
fn a_rig_without_declared_calibrations_is_predicted_inconclusive() {
    let on_a_real_rig = |rule| {
        let mut plan = required(rule);
        plan.rig = psd_testing::plans::real_plan(1e5, Vec::new()).rig;
        plan
    };
    let mut plan = on_a_real_rig(DecisionRule::Guarded);
    let (verdict, why) = predicted(&plan);
    assert_eq!(verdict, "inconclusive");
    assert!(
        why.starts_with("INCONCLUSIVE: the budget of `max_displacement` is partial"),
        "{why}"
    );
    let (verdict, why) = predicted(&on_a_real_rig(DecisionRule::Simple));
    assert_eq!((verdict.as_str(), why.as_str()), ("pass", "no U"));
    plan.rig.calibration.force_uncertainty = 0.005;
    plan.rig.calibration.displacement_uncertainty = 0.002;
    let (verdict, why) = predicted(&plan);
    assert_eq!(verdict, "pass");
    assert!(why.ends_with("conclusive"), "{why}");
}

/// A long free vibration: its exact readings determine a path, those with the noise of the rig do not. The run withholds U, and so does
/// the prediction.
#[test]
fn an_uncertainty_that_the_noise_of_the_rig_lets_grow_is_predicted_withheld() {
    use psd_plan::formula::Formula::Constant;
    use psd_plan::{Contact, Until};
    let with_duration = |seconds: f64, until: Until| {
        let mut plan = required(DecisionRule::Guarded);
        plan.limits = Limits::NONE;
        let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
            panic!()
        };
        impact.duration = Constant(seconds);
        impact.until = until;
        // Its contacts do not follow the time step.
        impact.contact = Contact::Restitution {
            coefficient: Constant(0.5),
        };
        impact.stepping = every(0.001);
        let Link::Virtual(link) = &mut plan.rig.link else {
            panic!()
        };
        (link.noise, link.lag, link.seed) = (4.0, 0.0, 3);
        let predicted = predicted(&plan);
        let record = psd::run::run(&plan, &mut *virtual_rig(&plan), &mut Unwatched);
        (predicted, verdict::assess(&plan, &record).verdict)
    };
    let ((verdict, why), run) = with_duration(1.0, Until::StrikerStop);
    assert_eq!((verdict.as_str(), run), ("pass", Verdict::Pass), "{why}");
    let ((verdict, why), run) = with_duration(60.0, Until::Duration);
    assert_eq!(
        (verdict.as_str(), run),
        ("inconclusive", Verdict::Inconclusive)
    );
    // The ideal readings of the prediction are withheld for their contacts already, which the rigid law lets follow the time step.
    assert!(why.contains("is withheld"), "{why}");
}
