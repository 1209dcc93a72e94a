//! A plan for every procedure that moves the rig.

use crate::tests::procedures::frame::preload::preloaded;
use crate::tests::testing::{elastic_plan, every, impact, ramp, struck_frame};
use psd_plan::formula::Formula::Constant;
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference};
use psd_plan::{
    Behaviour, Between, Comparison, Condition, Cycle, DampingSweep, DriftCheck, Element, Escalate,
    Frame, Ground, Impact, InspectTrigger, Integrator, Level, Member, Mode, Move, Part, Plan,
    Procedure, ProcedureKind, Scale, Shake, ShakeDamping, Sides, Stepping, StiffnessRamp, Storey,
    Test, Unload, Until, WatchedHold, WatchedModel, ZeroAfter,
};
use psd_text::units::Dimension;

pub(super) const CONTINUOUS: Mode = Mode::Continuous { time_scale: 100.0 };

pub(super) fn to(displacement: f64) -> ProcedureKind {
    ProcedureKind::Move(Move {
        to: Constant(displacement),
        speed: None,
    })
}

/// K 300 N/m; yields at 3 N, 10 mm.
pub(super) fn yielding(procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(300.0, procedures);
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: 300.0,
        yield_force: 3.0,
        post_yield_ratio: 0.1,
    });
    plan
}

/// Five steps.
pub(super) fn short(mode: Mode) -> Impact {
    let stepping = Stepping {
        mode,
        ..every(0.01)
    };
    Impact {
        stepping,
        duration: Constant(0.05),
        until: Until::Duration,
        ..impact(Constant(300.0))
    }
}

pub(super) fn cycle(rate: Option<f64>) -> Cycle {
    Cycle {
        specimen: 0,
        levels: vec![Level {
            amplitude: Constant(0.02),
            cycles: 1,
        }],
        sides: Sides::Both,
        about: Constant(0.001),
        points: 3,
        samples: 2,
        pause: Constant(0.1),
        speed: rate.map(|_| Constant(0.01)),
        rate: rate.map(Constant),
        inspect: Vec::new(),
        fit: None,
    }
}

/// Two floors under a ground motion, with an inspection. They yield, so that a path that is travelled twice would be detected.
pub(super) fn shaken(mode: Mode) -> Plan {
    let behaviour = |stiffness| Behaviour::Bilinear {
        stiffness,
        yield_force: stiffness * 0.0002,
        post_yield_ratio: 0.1,
    };
    let storey = |mass, stiffness| Storey::new(mass, stiffness, behaviour(stiffness));
    let mut plan = elastic_plan(300.0, Vec::new());
    plan.specimens[0].behaviour = None;
    plan.specimens[0].frame = Some(Frame::of_storeys(vec![
        storey(2000.0, 3e6),
        storey(1500.0, 2e6),
    ]));
    plan.grounds = vec![Ground {
        name: "quake".to_owned(),
        file: "quake.csv".to_owned(),
        unit: 1.0,
        scale: 1.0,
        scale_uncertainty: 0.0,
        times: vec![0.0, 0.02, 0.04, 0.06],
        accelerations: vec![0.0, 8.0, -6.0, 0.0],
    }];
    let shake = Shake {
        specimen: 0,
        ground: 0,
        damping: ShakeDamping::Rayleigh(Constant(0.02)),
        damping_uncertainty: 0.0,
        stepping: Stepping {
            integrator: Integrator::Explicit,
            mode,
            inspect: if mode == Mode::RampAndHold {
                vec![InspectTrigger::Every(4)]
            } else {
                Vec::new()
            },
            ..every(0.01)
        },
        scale: Constant(1.0),
        duration: None,
        until: None,
    };
    plan.procedures = elastic_plan(300.0, vec![ProcedureKind::Shake(shake)]).procedures;
    plan
}

/// The same with weights on the floors, the lower storey computed, and the upper one at half scale.
pub(super) fn shaken_hybrid(mode: Mode) -> Plan {
    let mut plan = shaken(mode);
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    let scale = Scale {
        displacement: 0.5,
        force: 0.25,
        represents: 2.0,
    };
    let hybrid = |storeys: &mut [Storey]| {
        for storey in storeys.iter_mut() {
            (storey.height, storey.gravity) = (Some(3.0), 4e5);
        }
        storeys[0].part = Part::Computed;
        storeys[1].part = Part::Tested {
            apart: false,
            scale,
        };
        storeys[1].behaviour = Behaviour::Bilinear {
            stiffness: scale.stiffness_on_the_rig(2e6),
            yield_force: 0.0002 * 2e6 / scale.forces(),
            post_yield_ratio: 0.1,
        };
    };
    plan.specimens[0].frame = Some(frame.with(hybrid));
    plan
}

/// The same with its storeys as elements of a frame of matrices.
pub(super) fn shaken_elements(mode: Mode) -> Plan {
    let mut plan = shaken_hybrid(mode);
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    let element = |member: Member<'_>| Element {
        ends: member.ends,
        stiffness: member.stiffness,
        stiffness_uncertainty: 0.0,
        behaviour: member.behaviour.clone(),
        damping: member.damping,
        coulomb: member.coulomb,
        part: member.part,
    };
    let order = frame.degrees_of_freedom();
    let elements = frame.members().map(element).collect();
    let matrices = Frame::of_matrices(frame.mass.clone(), vec![vec![0.0; order]; order]);
    plan.specimens[0].frame = Some(matrices.with_elements(elements));
    plan.procedures.push(rest());
    plan
}

/// The unloading of a frame.
fn rest() -> Procedure {
    Procedure {
        name: "rest".to_owned(),
        kind: ProcedureKind::Unload(Unload {
            specimen: 0,
            stiffness: None,
            within: None,
            speed: None,
            keep_axial_load: false,
        }),
    }
}

/// The lower storey under an axial load, of which `unload` takes the load off.
pub(super) fn shaken_under_a_load() -> Plan {
    let mut plan = shaken(Mode::RampAndHold);
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    let lower = |storeys: &mut [Storey]| storeys[0].height = Some(3.0);
    plan.specimens[0].frame = Some(frame.with(lower));
    plan.procedures.push(rest());
    preloaded(&plan, 0, 1e5, 1.0)
}

pub(super) fn escalating() -> Plan {
    let value = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "max_velocity",
        part: ResultPart::Value,
    });
    // The impacts end before their peak, so the condition would not be conclusive.
    let below = Condition {
        text: String::new(),
        value,
        test: Test::Compare {
            comparison: Comparison::Less,
            limit: Constant(0.8),
        },
        dimension: Dimension::VELOCITY,
    };
    yielding(vec![ProcedureKind::Escalate(Escalate {
        own: ProcedureId(0),
        impact: Impact {
            duration: Constant(0.03),
            ..short(Mode::RampAndHold)
        },
        velocities: [0.2, 0.4, 0.6].map(Constant).to_vec(),
        energies: None,
        condition: vec![below],
        between: Between::Unload,
        inspect_between: true,
    })])
}

pub(super) fn unloading() -> Plan {
    let unload = Unload {
        specimen: 0,
        stiffness: Some(Constant(500.0)),
        within: None,
        speed: None,
        keep_axial_load: false,
    };
    yielding(vec![to(0.03), ProcedureKind::Unload(unload)])
}

/// The upper floor is struck, and the actuators never stop.
pub(super) fn struck_without_a_stop() -> Plan {
    let mut plan = struck_frame();
    if let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind {
        (impact.stepping.mode, impact.duration) = (CONTINUOUS, Constant(0.05));
    }
    plan
}

/// Loads past yield and back, with readings in each dwell; then repeats it.
pub(super) fn watched() -> Plan {
    let watched = StiffnessRamp {
        displacements: [0.005, 0.02].map(Constant).to_vec(),
        pause: Constant(0.2),
        samples: 2,
        repeats: 2,
        return_path: true,
        relaxation: Some(WatchedHold {
            model: WatchedModel::Reached {
                law: None,
                rate: 1.0,
            },
            readings: 3,
        }),
        ..ramp(1e-4)
    };
    yielding(vec![ProcedureKind::StiffnessRamp(watched), to(0.0)])
}

/// Zeros are read, also during an inspection, and the rig returns to its start for the last one.
pub(super) fn drifting() -> Plan {
    let ramped = StiffnessRamp {
        pause: Constant(0.5),
        displacements: vec![Constant(1e-3), Constant(2e-3)],
        ..ramp(1e-4)
    };
    let looked = ProcedureKind::Inspect {
        note: "look".to_owned(),
    };
    let mut plan = elastic_plan(300.0, vec![ProcedureKind::StiffnessRamp(ramped), looked]);
    plan.rig.zero_drift = Some(DriftCheck {
        force: 1.0,
        displacement: Some(1e-6),
        over: 0.4,
        after: ZeroAfter::Start,
    });
    plan
}

/// Two impacts on the upper of two floors, each followed by unloading of both floors; then the same again.
pub(super) fn frame_row() -> Plan {
    let mut plan = crate::tests::procedures::frame::escalate::rising(&[0.4, 0.8], Between::Unload);
    let ProcedureKind::Escalate(escalate) = &mut plan.procedures[0].kind else {
        panic!()
    };
    escalate.inspect_between = true;
    let impact = &mut escalate.impact;
    impact.duration = Constant(0.03);
    let unload = ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: None,
        within: Some(Constant(1e-6)),
        speed: None,
        keep_axial_load: false,
    });
    plan.procedures.push(Procedure {
        name: "rest".to_owned(),
        kind: unload,
    });
    plan
}

/// A sweep about a position past yield: one pass without readings causes the plastic deformation before the passes with readings.
pub(super) fn swept_past_yield() -> Plan {
    let sweep = DampingSweep {
        specimen: 0,
        velocities: vec![Constant(0.01), Constant(0.02)],
        stroke: Constant(5e-3),
        about: Some(Constant(0.03)),
        stiffness: Constant(300.0),
        rate: Some(Constant(24.0)),
    };
    yielding(vec![ProcedureKind::DampingSweep(sweep), to(0.0)])
}

/// Every plan of this file, with its purpose.
pub(super) fn plans() -> Vec<(&'static str, Plan)> {
    vec![
        (
            "continuous",
            yielding(vec![ProcedureKind::Impact(short(CONTINUOUS))]),
        ),
        ("cycle", yielding(vec![ProcedureKind::Cycle(cycle(None))])),
        (
            "cycle without a stop",
            yielding(vec![ProcedureKind::Cycle(cycle(Some(2.0)))]),
        ),
        ("escalate", escalating()),
        ("drift", drifting()),
        ("shake", shaken(Mode::RampAndHold)),
        (
            "shake with a computed storey, a scale and weights",
            shaken_hybrid(Mode::RampAndHold),
        ),
        ("shake with elements", shaken_elements(Mode::RampAndHold)),
        ("shake under an axial load", shaken_under_a_load()),
        ("shake without a stop", shaken(CONTINUOUS)),
        ("storey without a stop", struck_without_a_stop()),
        ("unload", unloading()),
        ("escalate on a storey", frame_row()),
        ("watched", watched()),
        ("sweep past yield", swept_past_yield()),
    ]
}
