//! Dry runs of example 1 of Melo et al. 2006: its numbers, its stop at a limit, its specimen without a restoring-force model.

use super::*;
use crate::plan::{Interval, Limits, Link, VirtualLink};
use crate::tests::testing::empty_plan;

/// Example 1 of Melo et al. 2006, with the actuator allowed to go to `farthest`.
fn example(farthest: f64) -> Plan {
    use crate::plan::formula::Formula::Constant;
    use crate::plan::{
        Behaviour, Contact, Impact, ImpactTarget, PointTarget, Procedure, ProcedureKind, RigPlan,
        Settle, Specimen, Stepping, Striker, Until,
    };
    use crate::tests::testing::every;
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
