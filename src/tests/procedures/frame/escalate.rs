//! Impact series on a storey.

use super::{close, rest};
use crate::tests::testing::{as_of, list, number, run_unwatched, struck_frame};
use psd_plan::formula::Formula::Constant;
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference};
use psd_plan::record::{EscalateHistory, History, Outcome, Record};
use psd_plan::{
    Between, Comparison, Condition, Escalate, Impact, Plan, Procedure, ProcedureKind, Striker, Test,
};
use psd_text::units::Dimension;

fn drifts_below(limit: f64) -> Condition {
    let all = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "max_drift",
        part: ResultPart::Value,
    });
    let value = Formula::Call(psd_plan::formula::Function::Max, vec![all]);
    let test = Test::Compare {
        comparison: Comparison::Less,
        limit: Constant(limit),
    };
    Condition {
        text: String::new(),
        value,
        test,
        dimension: Dimension::LENGTH,
    }
}

fn impact() -> Impact {
    match struck_frame().procedures.swap_remove(0).kind {
        ProcedureKind::Impact(impact) => impact,
        other => panic!("{other:?}"),
    }
}

/// Impacts that end before the frame reverses, each followed by the next.
pub(crate) fn rising(velocities: &[f64], between: Between) -> Plan {
    let steps = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "steps",
        part: ResultPart::Value,
    });
    let test = Test::Compare {
        comparison: Comparison::Greater,
        limit: Constant(0.0),
    };
    let goes_on = Condition {
        text: String::new(),
        value: steps,
        test,
        dimension: Dimension::NUMBER,
    };
    series(impact(), velocities, goes_on, between)
}

/// Impacts that continue until the frame has reversed, in a series that ends when a storey drift is too large.
fn within(velocities: &[f64], limit: f64) -> Plan {
    let whole = Impact {
        duration: Constant(4.0),
        ..impact()
    };
    series(whole, velocities, drifts_below(limit), Between::Unload)
}

fn series(impact: Impact, velocities: &[f64], condition: Condition, between: Between) -> Plan {
    let escalate = Escalate {
        own: ProcedureId(0),
        impact,
        velocities: velocities.iter().copied().map(Constant).collect(),
        energies: None,
        condition: vec![condition],
        between,
        inspect_between: false,
    };
    let mut plan = struck_frame();
    plan.procedures[0].kind = ProcedureKind::Escalate(escalate);
    plan
}

fn impacts(record: &Record) -> &EscalateHistory {
    match &record.procedures[0].history {
        History::Escalate(history) => history,
        other => panic!("{other:?}"),
    }
}

/// A series of impacts is bit-identical to impact, unloading, impact, … written out. Every storey keeps its damage.
#[test]
fn an_impact_series_on_a_storey_equals_its_impacts_one_by_one() {
    let velocities = [0.9, 1.2, 1.5];
    let series = run_unwatched(&rising(&velocities, Between::Unload));
    assert_eq!(series.outcome, Outcome::Completed);
    let mut plan = struck_frame();
    let first = plan.strikers[0].clone();
    plan.strikers = velocities
        .iter()
        .map(|velocity| Striker {
            velocity: *velocity,
            ..first.clone()
        })
        .collect();
    let written = (0..3).flat_map(|striker| {
        [
            ProcedureKind::Impact(Impact {
                striker,
                ..impact()
            }),
            rest(None),
        ]
    });
    plan.procedures = written
        .enumerate()
        .map(|(index, kind)| Procedure {
            name: format!("p{index}"),
            kind,
        })
        .collect();
    let apart = run_unwatched(&plan);
    assert_eq!(apart.outcome, Outcome::Completed);
    for (index, impact) in impacts(&series).impacts.iter().enumerate() {
        assert_eq!(
            impact.results,
            as_of(0, &apart.procedures[2 * index].results),
            "impact {index}"
        );
        let rest = impact.rest.as_ref().unwrap();
        assert_eq!(rest.drift(), list(&apart, 2 * index + 1, "residual_drift"));
        // The next impact begins there; no elastic deformation is left.
        if let Some(next) = impacts(&series).impacts.get(index + 1) {
            let start = &next.storey().unwrap().floors[0];
            close(&start.floors.computed, &rest.displacement, 1e-15);
            assert!(
                start
                    .floors
                    .restoring_force
                    .iter()
                    .all(|force| force.abs() < 1e-10),
                "{start:?}"
            );
            assert!(
                rest.displacement
                    .iter()
                    .any(|displacement| displacement.abs() > 1e-3)
            );
        }
    }
    // Maximum over the impacts, the final position, and the energy that each storey absorbed.
    let last = impacts(&series).impacts.last().unwrap();
    assert_eq!(
        list(&series, 0, "residual_drift"),
        last.rest.as_ref().unwrap().drift()
    );
    for storey in 0..2 {
        let of = |name: &str| {
            impacts(&series)
                .impacts
                .iter()
                .map(|impact| impact.list(name).unwrap()[storey])
                .collect::<Vec<f64>>()
        };
        assert_eq!(
            list(&series, 0, "max_drift")[storey],
            of("max_drift").into_iter().fold(0.0, f64::max)
        );
        assert_eq!(
            list(&series, 0, "storey_energy")[storey],
            of("storey_energy").iter().sum::<f64>()
        );
    }
}

/// A zero error z of each cell changes the drift of a storey by −z/k for each floor above it. After a series of impacts, the root of the
/// sum of squares is u(`residual_drift`). It applies to the rest after the last impact, as its own results state.
#[test]
fn the_residual_drift_of_a_series_has_the_uncertainty_of_the_zero_offsets() {
    let mut plan = rising(&[0.9, 1.2], Between::Unload);
    plan.rig.calibration.zero_uncertainty = 0.05;
    let record = run_unwatched(&plan);
    let result = record.procedures[0].result("residual_drift").unwrap();
    let uncertainties = result.entry_uncertainties();
    for (storey, stiffness) in [500.0, 300.0].into_iter().enumerate() {
        let floors: f64 = if storey == 0 { 2.0 } else { 1.0 };
        let by_hand = 0.05 * floors.sqrt() / stiffness;
        assert!(
            (uncertainties[storey].unwrap() / by_hand - 1.0).abs() < 1e-6,
            "storey {storey}: {uncertainties:?}, by hand {by_hand}"
        );
    }
    assert_eq!(
        result.contributions,
        impacts(&record)
            .impacts
            .last()
            .unwrap()
            .rest
            .as_ref()
            .unwrap()
            .drift_contributions()
    );
}

/// It ends with the first impact after which a storey drift is too large. Otherwise it ends with the last impact of the list.
#[test]
fn a_series_on_a_storey_ends_with_the_first_failed_impact() {
    let velocities = [0.2, 0.4, 0.6, 0.8];
    let all = run_unwatched(&within(&velocities, 10.0));
    assert!(
        impacts(&all)
            .impacts
            .iter()
            .all(|impact| impact.held == Some(true)),
        "each has its peak"
    );
    let peaks: Vec<f64> = impacts(&all)
        .impacts
        .iter()
        .map(|impact| {
            impact
                .list("max_drift")
                .unwrap()
                .iter()
                .copied()
                .fold(0.0, f64::max)
        })
        .collect();
    assert!(
        peaks.len() == 4 && peaks.windows(2).all(|pair| pair[0] < pair[1]),
        "{peaks:?}"
    );
    let some = run_unwatched(&within(&velocities, 0.5 * (peaks[1] + peaks[2])));
    assert_eq!(
        impacts(&some)
            .impacts
            .iter()
            .map(|impact| impact.held)
            .collect::<Vec<_>>(),
        [Some(true), Some(true), Some(false)]
    );
    assert_eq!(number(&some, 0, "impacts").0, Some(3.0));
    assert_eq!(
        number(&some, 0, "first_failed_energy").0,
        Some(0.5 * 10.0 * 0.6 * 0.6)
    );
    // `home` is the start of the first impact; `stay` begins the next impact under the load of the last.
    let home = run_unwatched(&rising(&velocities, Between::Home));
    assert!(
        impacts(&home)
            .impacts
            .iter()
            .all(|impact| impact.rest.as_ref().unwrap().displacement == [0.0, 0.0])
    );
    let stay = run_unwatched(&rising(&velocities, Between::Stay));
    let (first, next) = (&impacts(&stay).impacts[0], &impacts(&stay).impacts[1]);
    assert_eq!(
        first.rest.as_ref().unwrap().force,
        next.storey().unwrap().floors[0].floors.restoring_force
    );
}
