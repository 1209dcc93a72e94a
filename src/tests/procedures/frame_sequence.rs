//! Several blows on a frame, and the load taken off all its floors, against closed forms and against one degree of freedom.

use crate::plan::formula::Formula::Constant;
use crate::plan::formula::{Formula, Part, ProcedureId, ResultReference};
use crate::plan::{
    Behaviour, Between, Comparison, Condition, Escalate, Frame, FrameUnload, Impact, Interval,
    Link, Plan, Procedure, ProcedureKind, Storey, Striker, Test, Unload, VirtualLink,
};
use crate::procedures::unload::run::{of_frame, to_rest};
use crate::record::{EscalateHistory, History, Outcome, Record, Rest, UnloadStep};
use crate::rig::virtual_rig;
use crate::run::Unwatched;
use crate::run::session::Session;
use crate::tests::testing::{as_of, elastic_plan, list, number, run_unwatched, struck_frame};
use crate::units::Dimension;

const STIFFNESS: [f64; 3] = [4e6, 2e6, 1e6];
const YIELD: [f64; 3] = [40e3, 20e3, 10e3];

fn storey(index: usize, hardening: f64) -> Storey {
    let (stiffness, yield_force) = (STIFFNESS[index], YIELD[index]);
    Storey {
        mass: 1000.0,
        mass_uncertainty: 0.0,
        stiffness_uncertainty: 0.0,
        stiffness,
        height: None,
        behaviour: Behaviour::Bilinear {
            stiffness,
            yield_force,
            hardening,
        },
        damping: 0.0,
        coulomb: 0.0,
    }
}

/// Three storeys that each yield at a drift of 10 mm.
pub(crate) fn three(hardening: f64) -> Plan {
    let mut plan = elastic_plan(1.0, vec![rest(None)]);
    plan.specimens[0].frame = Some(Frame::of_storeys(
        (0..3).map(|index| storey(index, hardening)).collect(),
    ));
    plan.specimens[0].behaviour = None;
    plan
}

fn rest(within: Option<f64>) -> ProcedureKind {
    ProcedureKind::FrameUnload(FrameUnload {
        specimen: 0,
        within: within.map(Constant),
        speed: None,
    })
}

/// The floors pushed to these drifts (m) one after the other, then unloaded.
fn unloaded(plan: &Plan, drifts: [f64; 3], within: Option<f64>) -> (Rest, Vec<UnloadStep>) {
    let mut rig = virtual_rig(plan);
    let mut watched = Unwatched;
    let mut session = Session::begin(plan, rig.as_mut(), &mut watched)
        .unwrap_or_else(|_| panic!("the rig is refused"));
    let mut place = 0.0;
    let places: Vec<f64> = drifts
        .iter()
        .map(|drift| {
            place += drift;
            place
        })
        .collect();
    session.go_to_all(&places, None).unwrap();
    let unloading = of_frame(plan.specimens[0].frame.as_ref().unwrap()).unwrap();
    let mut steps = Vec::new();
    let rest = to_rest(unloading, within, None, 0, &mut session, &mut steps).unwrap();
    (rest, steps)
}

pub(crate) fn close(found: &[f64], wanted: &[f64], within: f64) {
    assert!(
        found
            .iter()
            .zip(wanted)
            .all(|(found, wanted)| (found - wanted).abs() <= within),
        "{found:?}, not {wanted:?}"
    );
}

/// A bilinear storey beyond its yield drift δy has the shear Fy + hk(δ − δy), and comes back along k: what stays is its
/// plastic drift, (1 − h)(δ − δy), whatever the other storeys do. Three moves are enough: a short one, most of the way, the rest.
#[test]
fn what_stays_of_a_bilinear_storey_is_its_plastic_drift() {
    for hardening in [0.0, 0.05, 0.2] {
        let (rest, steps) = unloaded(&three(hardening), [0.025, -0.03, 0.004], None);
        let stays = [(1.0 - hardening) * 0.015, -(1.0 - hardening) * 0.02, 0.0];
        close(&rest.drift(), &stays, 1e-15);
        close(&rest.shear(), &[0.0; 3], 1e-9);
        assert_eq!(steps.len(), 4);
        close(
            &[
                steps[1].tangent_stiffness[0].unwrap(),
                steps[1].tangent_stiffness[2].unwrap(),
            ],
            &[4e6, 1e6],
            1e-4,
        );
        assert_eq!(rest.largest().0, rest.displacement[0]);
    }
}

/// Beyond a shear of 2Fy a storey yields backwards on its way home, by 2δy along k and the rest along hk: no one move finds
/// that place, but each is nearer.
#[test]
fn a_storey_that_yields_on_its_way_back_is_followed() {
    let hardening = 0.5;
    // V = Fy + hk(δ − δy) at δ = 5δy is 3Fy; back by 2δy to Fy, and by Fy/(hk) = 2δy more to none.
    let (rest, steps) = unloaded(&three(hardening), [0.05, 0.05, 0.012], Some(1e-3));
    close(
        &rest.drift(),
        &[0.01, 0.01, (1.0 - hardening) * 0.002],
        1e-9,
    );
    assert!(steps.len() > 2 && steps.len() < 10, "{}", steps.len());
    let left: Vec<f64> = steps
        .iter()
        .map(|step| {
            step.restoring_force
                .iter()
                .fold(0.0, |most: f64, r| most.max(r.abs()))
        })
        .collect();
    assert!(
        left.windows(2).all(|pair| pair[1] < pair[0]) && left[left.len() - 1] <= 1e-3,
        "{left:?}"
    );
}

/// Where increments are limited the way is gone in equal parts of all axes, and the frame rests at the same place; a limit on
/// the way ends it.
#[test]
fn all_floors_move_together_inside_the_limits() {
    let mut plan = three(0.1);
    let wanted = unloaded(&plan, [0.025, 0.03, 0.015], None).0;
    plan.limits.increment = Interval {
        low: 0.0,
        high: 1e-3,
    };
    let (found, steps) = unloaded(&plan, [0.025, 0.03, 0.015], None);
    close(&found.displacement, &wanted.displacement, 1e-15);
    assert_eq!(steps.len(), 4);
    // Pushed beyond yield and half the way back, it springs out again: beyond a limit it is not let.
    let mut rig = virtual_rig(&plan);
    plan.limits.increment = Interval::ALL;
    let unloading = of_frame(plan.specimens[0].frame.as_ref().unwrap()).unwrap();
    {
        let mut watched = Unwatched;
        let mut session = Session::begin(&plan, rig.as_mut(), &mut watched)
            .unwrap_or_else(|_| panic!("the rig is refused"));
        for place in [0.05, 0.03] {
            session.go_to_all(&[place; 3], None).unwrap();
        }
    }
    plan.limits.displacement = Interval {
        low: 0.0,
        high: 0.033,
    };
    let mut watched = Unwatched;
    let mut session = Session::begin(&plan, rig.as_mut(), &mut watched)
        .unwrap_or_else(|_| panic!("the rig is refused"));
    let mut steps = Vec::new();
    let stop = to_rest(unloading, None, None, 0, &mut session, &mut steps).unwrap_err();
    assert!(matches!(stop.outcome(), Outcome::Aborted { .. }), "{stop}");
    assert!(
        steps.len() == 2
            && session
                .guard
                .commanded()
                .iter()
                .all(|place| (0.03..0.033).contains(place))
    );
}

/// With noise the frame rests within what its cells can tell, and is not chased any further.
#[test]
fn noise_is_not_mistaken_for_load() {
    let mut plan = three(0.05);
    let ideal = unloaded(&plan, [0.02, 0.02, 0.02], None).0;
    for seed in 1..20 {
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 20.0,
            resolution: 1e-6,
            seed,
            ..VirtualLink::default()
        });
        let (found, steps) = unloaded(&plan, [0.02, 0.02, 0.02], None);
        // Rows of |K| are 8, 6 and 2 MN/m at most: a quantum of 1 µm is 9 N at the second floor, 3σ are 60 N.
        assert!(
            found.force.iter().all(|force| force.abs() <= 60.0),
            "{found:?}"
        );
        // Three moves, and one more where noise is in the slope of the last.
        assert!(steps.len() <= 5, "{}", steps.len());
        let off = found
            .drift()
            .iter()
            .zip(ideal.drift())
            .map(|(found, ideal)| (found - ideal).abs())
            .fold(0.0, f64::max);
        assert!(off < 3.0 * 3.0 * 20.0 / 1e6 + 2e-6, "{off} m");
    }
}

/// A frame given by its matrices is no shear building: K⁻¹ takes it home, all floors together.
#[test]
fn a_frame_of_matrices_is_unloaded_as_a_whole() {
    let mut plan = three(0.05);
    let frame = plan.specimens[0].frame.as_mut().unwrap();
    frame.storeys.clear();
    frame.stiffness = vec![
        vec![6e6, -2e6, 1e5],
        vec![-2e6, 3e6, -1e6],
        vec![1e5, -1e6, 1.2e6],
    ];
    let (rest, steps) = unloaded(&plan, [0.01, 0.02, -0.01], None);
    close(&rest.displacement, &[0.0; 3], 1e-16);
    assert!(steps.len() == 4 && steps[1].tangent_stiffness == [None; 3]);
}

/// Of one storey it is the unloading of one degree of freedom, to the last bit.
#[test]
fn one_storey_is_unloaded_as_one_degree_of_freedom() {
    let behaviour = Behaviour::Bilinear {
        stiffness: 500.0,
        yield_force: 5.0,
        hardening: 0.3,
    };
    let mut frame = elastic_plan(1.0, vec![rest(None)]);
    let floor = Storey {
        mass: 1.0,
        mass_uncertainty: 0.0,
        stiffness_uncertainty: 0.0,
        stiffness: 500.0,
        height: None,
        behaviour: behaviour.clone(),
        damping: 0.0,
        coulomb: 0.2,
    };
    frame.specimens[0].frame = Some(Frame::of_storeys(vec![floor]));
    let unload = Unload {
        specimen: 0,
        stiffness: Constant(500.0),
        within: None,
        speed: None,
    };
    let mut single = elastic_plan(1.0, vec![ProcedureKind::Unload(unload)]);
    single.specimens[0].coulomb = 0.2;
    single.specimens[0].behaviour = Some(behaviour.clone());
    frame.specimens[0].behaviour = Some(behaviour);
    let away = crate::plan::Move {
        to: Constant(0.08),
        speed: None,
    };
    for plan in [&mut frame, &mut single] {
        plan.procedures.insert(
            0,
            Procedure {
                name: "away".to_owned(),
                kind: ProcedureKind::Move(away.clone()),
            },
        );
    }
    let (frame, single) = (run_unwatched(&frame), run_unwatched(&single));
    let (History::FrameUnload(floors), History::Move(moves)) =
        (&frame.procedures[1].history, &single.procedures[1].history)
    else {
        panic!()
    };
    assert!(moves.len() > 2 && floors.len() == moves.len() + 1);
    for (floor, step) in floors[1..].iter().zip(moves) {
        assert_eq!(
            (floor.command[0], floor.displacement[0]),
            (step.command, step.displacement)
        );
        assert_eq!(
            (floor.restoring_force[0], floor.tangent_stiffness[0]),
            (step.restoring_force, step.tangent_stiffness)
        );
    }
    for name in ["residual_displacement", "residual_force"] {
        assert_eq!(number(&frame, 1, name), number(&single, 1, name));
    }
}

fn drifts_below(limit: f64) -> Condition {
    let all = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "max_drift",
        part: Part::Value,
    });
    let value = Formula::Call(crate::plan::formula::Function::Max, vec![all]);
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

fn blow() -> Impact {
    match struck_frame().procedures.swap_remove(0).kind {
        ProcedureKind::Impact(blow) => blow,
        other => panic!("{other:?}"),
    }
}

/// Blows that are over before the frame turns back, each followed by the next.
pub(crate) fn rising(velocities: &[f64], between: Between) -> Plan {
    let steps = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "steps",
        part: Part::Value,
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
    row(blow(), velocities, goes_on, between)
}

/// Blows that go on until the frame has turned back, until a storey drifts too far.
fn within(velocities: &[f64], limit: f64) -> Plan {
    let whole = Impact {
        duration: Constant(4.0),
        ..blow()
    };
    row(whole, velocities, drifts_below(limit), Between::Unload)
}

fn row(blow: Impact, velocities: &[f64], condition: Condition, between: Between) -> Plan {
    let escalate = Escalate {
        own: ProcedureId(0),
        impact: blow,
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

fn blows(record: &Record) -> &EscalateHistory {
    match &record.procedures[0].history {
        History::Escalate(history) => history,
        other => panic!("{other:?}"),
    }
}

/// A row of blows is blow, unloading, blow, … written out, to the last bit: every storey carries its damage on.
#[test]
fn a_row_of_blows_on_a_storey_is_the_blows_written_out() {
    let velocities = [0.9, 1.2, 1.5];
    let row = run_unwatched(&rising(&velocities, Between::Unload));
    assert_eq!(row.outcome, Outcome::Completed);
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
            ProcedureKind::Impact(Impact { striker, ..blow() }),
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
    for (index, blow) in blows(&row).blows.iter().enumerate() {
        assert_eq!(
            blow.results,
            as_of(0, &apart.procedures[2 * index].results),
            "blow {index}"
        );
        let rest = blow.rest.as_ref().unwrap();
        assert_eq!(rest.drift(), list(&apart, 2 * index + 1, "residual_drift"));
        // The next blow begins there, with nothing to spring back.
        if let Some(next) = blows(&row).blows.get(index + 1) {
            let start = &next.storey().unwrap().floors[0];
            close(&start.computed, &rest.displacement, 1e-15);
            assert!(
                start
                    .restoring_force
                    .iter()
                    .all(|force| force.abs() < 1e-10),
                "{start:?}"
            );
            assert!(rest.displacement.iter().any(|place| place.abs() > 1e-3));
        }
    }
    // Largest over the blows, where it was brought to last, and all that each storey took.
    let last = blows(&row).blows.last().unwrap();
    assert_eq!(
        list(&row, 0, "residual_drift"),
        last.rest.as_ref().unwrap().drift()
    );
    for storey in 0..2 {
        let of = |name: &str| {
            blows(&row)
                .blows
                .iter()
                .map(|blow| blow.list(name).unwrap()[storey])
                .collect::<Vec<f64>>()
        };
        assert_eq!(
            list(&row, 0, "max_drift")[storey],
            of("max_drift").into_iter().fold(0.0, f64::max)
        );
        assert_eq!(
            list(&row, 0, "storey_energy")[storey],
            of("storey_energy").iter().sum::<f64>()
        );
    }
}

/// After a row of blows each cell's zero z leaves the drift of a storey off by −z/k for each floor above it, and Σ of the squares is
/// u(`residual_drift`): of the last blow's rest, as its own results tell.
#[test]
fn what_stays_after_a_row_is_as_uncertain_as_the_zeros_above() {
    let mut plan = rising(&[0.9, 1.2], Between::Unload);
    plan.rig.calibration.zero_uncertainty = 0.05;
    let record = run_unwatched(&plan);
    let result = record.procedures[0].result("residual_drift").unwrap();
    let told = result.entry_uncertainties();
    for (storey, stiffness) in [500.0, 300.0].into_iter().enumerate() {
        let floors: f64 = if storey == 0 { 2.0 } else { 1.0 };
        let by_hand = 0.05 * floors.sqrt() / stiffness;
        assert!(
            (told[storey].unwrap() / by_hand - 1.0).abs() < 1e-6,
            "storey {storey}: {told:?}, by hand {by_hand}"
        );
    }
    assert_eq!(
        result.contributions,
        blows(&record)
            .blows
            .last()
            .unwrap()
            .rest
            .as_ref()
            .unwrap()
            .drift_contributions()
    );
}

/// It ends with the first blow after which a storey has drifted too far, and after the last of the list.
#[test]
fn a_row_on_a_storey_ends_with_the_first_blow_that_fails() {
    let velocities = [0.2, 0.4, 0.6, 0.8];
    let all = run_unwatched(&within(&velocities, 10.0));
    assert!(
        blows(&all).blows.iter().all(|blow| blow.held == Some(true)),
        "each has its peak"
    );
    let peaks: Vec<f64> = blows(&all)
        .blows
        .iter()
        .map(|blow| {
            blow.list("max_drift")
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
        blows(&some)
            .blows
            .iter()
            .map(|blow| blow.held)
            .collect::<Vec<_>>(),
        [Some(true), Some(true), Some(false)]
    );
    assert_eq!(number(&some, 0, "blows").0, Some(3.0));
    assert_eq!(
        number(&some, 0, "first_failed_energy").0,
        Some(0.5 * 10.0 * 0.6 * 0.6)
    );
    // Home is where the first began; to stay is to begin under the load of the last.
    let home = run_unwatched(&rising(&velocities, Between::Home));
    assert!(
        blows(&home)
            .blows
            .iter()
            .all(|blow| blow.rest.as_ref().unwrap().displacement == [0.0, 0.0])
    );
    let stay = run_unwatched(&rising(&velocities, Between::Stay));
    let (first, next) = (&blows(&stay).blows[0], &blows(&stay).blows[1]);
    assert_eq!(
        first.rest.as_ref().unwrap().force,
        next.storey().unwrap().floors[0].restoring_force
    );
}
