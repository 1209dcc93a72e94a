//! No target beyond a limit is sent on the line, for any plan. In: random plans, with targets and limits of any kind. Out: the targets
//! that the simulator read from the bytes.

use proptest::prelude::*;

use super::stage::{device_link, link, plan_of, run, run_without, to};
use psd_plan::record::Outcome;
use psd_plan::{Dialect, Interval, Plan};
use psd_rig::safety::failpoint::Guarding;

/// A plan that moves to these positions within these limits \[m\].
fn going(positions: &[f64], displacement: Interval, increment: f64) -> Plan {
    let mut plan = plan_of(positions.iter().map(|position| to(*position)).collect());
    plan.limits.displacement = displacement;
    plan.limits.increment = Interval {
        low: 0.0,
        high: increment,
    };
    plan.limits.force = Interval::ALL;
    link(&mut plan).readings.force_range = Interval::ALL;
    plan
}

fn positions() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -0.003..0.004_f64,
        1 => Just(0.002),
        1 => Just(0.002 + 1e-9),
        1 => Just(-0.001 - 4e-10),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e300), Just(-0.0), Just(5e-324)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn nothing_beyond_a_limit_is_ever_on_the_wire(
        asked in prop::collection::vec(positions(), 1..4),
        high in prop_oneof![Just(0.002), Just(0.000_1), Just(f64::NAN)],
        increment in prop_oneof![Just(f64::INFINITY), Just(0.001)],
    ) {
        let limit = Interval { low: -0.001, high };
        // A rig that reports no limits of its own.
        let plan = going(&asked, limit, increment);
        let Ok(ended) = super::stage::run_watched(&plan, "", &mut crate::run::Unwatched) else { return Ok(()) };
        let targets: Vec<f64> = ended.log.lines().filter_map(|line| line.split_once(">MOVE ")).map(|(_, frame)| {
            frame.split(' ').nth(2).unwrap().parse::<f64>().unwrap() / 1e3
        }).collect();
        for target in &targets {
            prop_assert!(limit.low - 1e-12 <= *target && *target <= limit.high + 1e-12, "{} of {:?}", target, asked);
        }
        for pair in targets.windows(2) {
            prop_assert!((pair[1] - pair[0]).abs() <= increment + 2e-9);
        }
        let fits = asked.iter().all(|position| limit.contains(*position));
        prop_assert_eq!(ended.record.outcome == Outcome::Completed, fits && high > 5e-5, "{:?}", ended.record.outcome);
        if !fits {
            prop_assert!(ended.log.contains("actuator > !"), "held");
        }
    }
}

#[test]
fn without_the_guard_a_target_beyond_the_limits_leaves() {
    // Grbl has no limits that a run could send to it.
    let mut plan = going(
        &[0.001, 0.003],
        Interval {
            low: -0.001,
            high: 0.002,
        },
        f64::INFINITY,
    );
    link(&mut plan).actuator = device_link(Dialect::Grbl);
    link(&mut plan).load_cell = Some(device_link(Dialect::Indicator));
    link(&mut plan).pretest_check.stiffness = Interval::ALL;
    crate::tests::fault_table::line::unnumbered::as_homed(&mut plan);
    let outside = |guarded: bool| {
        let ended = if guarded {
            run(&plan, "")
        } else {
            run_without(Guarding::TargetLimits, &plan, "")
        };
        let emulator = ended.emulator.lock();
        (
            emulator.rig().violations().to_vec(),
            ended.record.outcome.clone(),
        )
    };
    let (violations, outcome) = outside(true);
    assert!(
        violations.is_empty() && matches!(outcome, Outcome::Aborted { .. }),
        "{outcome:?}"
    );
    assert_eq!(outside(false).0, [-0.004], "3 mm from its position");
}
