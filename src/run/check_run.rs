//! A check run (low-level check run): the part of a plan that is measured first, and the prediction of the rest. In: a plan, and the
//! record of its pre-test check and leading stiffness ramps. Out: the plan of those alone, and the whole plan on a virtual specimen with
//! the measured stiffness. It moves nothing.

use psd_plan::procedures::stiffness_ramp::block::STIFFNESS;
use psd_plan::record::{History, Record, StiffnessRampHistory};
use psd_plan::{Behaviour, CHECK_RUN, Link, Plan, ProcedureKind, Specimen, VirtualLink};

/// What distinguishes the identifier of a check run from that of the whole plan.
pub const RUN_ID_MARK: &str = "check run";

/// Why a plan cannot be checked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoCheckRun {
    #[error(
        "specimen `{0}` has no `behaviour`, and the plan does not start with its stiffness ramp: its stiffness is not known"
    )]
    NothingMeasured(String),
    #[error("`{0}` gave no stiffness above 0")]
    NoStiffness(String),
}

/// Number of leading procedures of the plan that a check run runs on the rig: stiffness ramps, with the inspections before and between
/// them.
fn leading(plan: &Plan) -> usize {
    let quiet = |kind: &ProcedureKind| {
        matches!(
            kind,
            ProcedureKind::StiffnessRamp(_) | ProcedureKind::Inspect { .. }
        )
    };
    let quiet = plan
        .procedures
        .iter()
        .take_while(|procedure| quiet(&procedure.kind));
    let ramps = quiet
        .enumerate()
        .filter(|(_, procedure)| matches!(procedure.kind, ProcedureKind::StiffnessRamp(_)));
    ramps.map(|(index, _)| index + 1).last().unwrap_or(0)
}

/// The part of the plan that a check run runs on the rig: the pre-test check and the leading stiffness ramps. It is marked as a
/// check run. It has no requirements, because it makes no statement of conformity.
///
/// # Errors
/// Nothing would be measured from which to predict the rest.
pub fn measured_part(plan: &Plan) -> Result<Plan, NoCheckRun> {
    let ramps = leading(plan);
    if let Some(specimen) = plan.unknown_specimen().filter(|_| ramps == 0) {
        return Err(NoCheckRun::NothingMeasured(specimen.name.clone()));
    }
    let mut part = plan.clone();
    let left = part.procedures.split_off(ramps);
    let names = |procedures: &[psd_plan::Procedure]| {
        procedures
            .iter()
            .map(|procedure| procedure.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let pretest_check = plan.rig.link.as_real().map(|_| "the pre-test check");
    let ran: Vec<String> = pretest_check
        .into_iter()
        .map(str::to_owned)
        .chain((ramps > 0).then(|| names(&part.procedures)))
        .collect();
    let ran = if ran.is_empty() {
        "nothing".to_owned()
    } else {
        ran.join(" and ")
    };
    let predicted = if left.is_empty() {
        "nothing".to_owned()
    } else {
        names(&left)
    };
    let text = format!(
        "{ran} ran on the rig; {predicted} did not run and was predicted on a virtual specimen"
    );
    part.particulars.push((CHECK_RUN, text));
    part.check_run_of = Some(Box::new(plan.clone()));
    part.requirements.clear();
    part.reproductions.clear();
    // The zeros belong to a test: a check run does not move for them.
    part.rig.zero_drift = None;
    part.report
        .figures
        .retain(|figure| figure.procedures().all(|procedure| procedure.0 < ramps));
    Ok(part)
}

/// The whole plan on a virtual specimen with the stiffness of `measured`, and with the noise and resolution of the rig. The noise is the
/// larger of the declared noise and the noise of the ramps.
///
/// # Errors
/// A ramp gave no stiffness.
pub fn prediction(plan: &Plan, measured: &Record) -> Result<Plan, NoCheckRun> {
    let mut model = plan.clone();
    let mut link = match &plan.rig.link {
        Link::Virtual(link) => *link,
        Link::Real(link) => VirtualLink {
            noise: link.readings.noise,
            resolution: link.readings.resolution,
            ..VirtualLink::default()
        },
    };
    link.noise = link.noise.max(scatter(measured));
    model.rig.link = Link::Virtual(link);
    for (procedure, record) in plan.procedures.iter().zip(&measured.procedures) {
        let ProcedureKind::StiffnessRamp(ramp) = &procedure.kind else {
            continue;
        };
        let Some(stiffness) = record.number(STIFFNESS.name).filter(|value| *value > 0.0) else {
            return Err(NoCheckRun::NoStiffness(procedure.name.clone()));
        };
        if let Some(specimen) = model.specimens.get_mut(ramp.specimen) {
            specimen.behaviour =
                Some(curve_of(&record.history).unwrap_or_else(|| as_stiff_as(stiffness, specimen)));
        }
    }
    Ok(model)
}

/// The specimen that a ramp beyond yield measured, if its fitted curve is a valid model. It has the measured yield point, not the
/// expected one.
fn curve_of(history: &History) -> Option<Behaviour> {
    let History::StiffnessRamp(StiffnessRampHistory {
        steps,
        multilinear: Some(fit),
        ..
    }) = history
    else {
        return None;
    };
    let reach = steps
        .iter()
        .map(|step| step.displacement)
        .fold(0.0, |most, x| {
            if fit.direction * x > fit.direction * most {
                x
            } else {
                most
            }
        });
    let corners = fit
        .backbone_points(reach)
        .filter(|corners| corners.len() > 1)?;
    Some(Behaviour::Multilinear { corners })
}

/// A specimen of the measured stiffness \[N/m\]: the expected one with every force scaled in proportion. It yields and breaks at the
/// displacements of the plan.
fn as_stiff_as(stiffness: f64, specimen: &Specimen) -> Behaviour {
    // During a dwell the relaxing part of the force decreases before the reading.
    let expected = specimen
        .behaviour
        .as_ref()
        .map(|behaviour| (behaviour, behaviour.relaxed_stiffness()));
    match expected {
        // Exactly as measured; a quotient would be rounded.
        None | Some((Behaviour::Elastic { .. } | Behaviour::Beam(_), _)) => {
            Behaviour::Elastic { stiffness }
        }
        Some((behaviour, expected)) if expected > 0.0 => behaviour.scaled(stiffness / expected),
        Some(_) => Behaviour::Elastic { stiffness },
    }
}

/// Standard deviation of a force reading over all dwells of the ramps \[N\]; 0 if each dwell had one reading.
fn scatter(measured: &Record) -> f64 {
    let steps = measured
        .procedures
        .iter()
        .flat_map(|procedure| match &procedure.history {
            History::StiffnessRamp(history) => history.steps.as_slice(),
            _ => &[],
        });
    let (count, sum) = steps.fold((0.0, 0.0), |(count, sum), step| {
        (count + 1.0, sum + step.force_scatter.powi(2))
    });
    if count > 0.0 {
        f64::sqrt(sum / count)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::testing::{
        elastic_plan, impact, ramp, result_of, run_unwatched, struck_frame,
    };
    use psd_plan::formula::Formula::Constant;
    use psd_plan::{BreakCount, InspectTrigger, Move, RampFit};

    /// A frame has the models of its storeys: none is measured first, and the impact is predicted with them.
    #[test]
    fn an_impact_on_a_storey_is_predicted_on_the_storeys_of_the_plan() {
        let plan = struck_frame();
        let part = measured_part(&plan).unwrap();
        assert!(part.procedures.is_empty());
        assert_eq!(
            part.performed_part(),
            Some("nothing ran on the rig; p0 did not run and was predicted on a virtual specimen")
        );
        let model = prediction(&plan, &run_unwatched(&part)).unwrap();
        assert_eq!(
            format!("{:?}", run_unwatched(&model).procedures),
            format!("{:?}", run_unwatched(&plan).procedures)
        );
    }

    fn plan() -> Plan {
        let mut struck = impact(result_of(1, "stiffness"));
        struck.stepping.inspect = vec![InspectTrigger::Every(1000)];
        elastic_plan(
            320.0,
            vec![
                ProcedureKind::Inspect {
                    note: "look".to_owned(),
                },
                ProcedureKind::StiffnessRamp(ramp(1e-3)),
                ProcedureKind::Inspect {
                    note: "again".to_owned(),
                },
                ProcedureKind::Move(Move {
                    to: Constant(0.001),
                    speed: None,
                }),
                ProcedureKind::StiffnessRamp(ramp(2e-3)),
                ProcedureKind::Impact(struck),
            ],
        )
    }

    #[test]
    fn only_the_leading_ramps_touch_the_rig() {
        let part = measured_part(&plan()).unwrap();
        assert_eq!(part.procedures.len(), 2, "not what comes after the move");
        assert_eq!(
            part.performed_part(),
            Some(
                "p0, p1 ran on the rig; p2, p3, p4, p5 did not run and was predicted on a virtual specimen"
            )
        );
        assert_eq!(plan().performed_part(), None);
        let mut blind = plan();
        blind.procedures.remove(1);
        assert_eq!(leading(&blind), 0);
        assert!(measured_part(&blind).is_ok(), "the plan says how it bends");
        blind.specimens[0].behaviour = None;
        assert_eq!(
            measured_part(&blind).err(),
            Some(NoCheckRun::NothingMeasured("beam".to_owned()))
        );
    }

    #[test]
    fn the_virtual_specimen_has_the_measured_stiffness_and_the_yield_point_of_the_plan() {
        let mut expected = plan();
        expected.specimens[0].behaviour = Some(Behaviour::Bilinear {
            stiffness: 400.0,
            yield_force: 40.0,
            post_yield_ratio: 0.1,
        });
        // The rig has 320 N/m; the plan expects 400 N/m.
        let record = run_unwatched(&measured_part(&plan()).unwrap());
        let model = prediction(&expected, &record).unwrap();
        let Some(Behaviour::Bilinear {
            stiffness,
            yield_force,
            post_yield_ratio,
        }) = model.specimens[0].behaviour
        else {
            panic!()
        };
        assert!(
            (stiffness - 320.0).abs() < 1e-9
                && (yield_force / stiffness - 0.1).abs() < 1e-12
                && post_yield_ratio == 0.1
        );
        // A ramp past yield measures the yielding, whatever the plan expects: here 250 N/m, 30 N and a post-yield stiffness ratio of
        // 1/20.
        let mut yielding = measured_part(&plan()).unwrap();
        yielding.specimens[0].behaviour = Some(Behaviour::Bilinear {
            stiffness: 250.0,
            yield_force: 30.0,
            post_yield_ratio: 0.05,
        });
        let mut curve = ramp(2.5e-2);
        curve.fit = RampFit::Multilinear(BreakCount::ByCriterion { most: 4 });
        yielding.procedures[1].kind = ProcedureKind::StiffnessRamp(curve);
        let model = prediction(&expected, &run_unwatched(&yielding)).unwrap();
        let Some(Behaviour::Multilinear { corners }) = &model.specimens[0].behaviour else {
            panic!()
        };
        assert!(
            (corners[0][0] - 0.12).abs() < 1e-9 && (corners[0][1] - 30.0).abs() < 1e-6,
            "{corners:?}"
        );
        assert!(
            (corners[1][1] - 30.0 - 12.5 * 0.13).abs() < 1e-6,
            "{corners:?}"
        );
        expected.specimens[0].behaviour = None;
        let model = prediction(&expected, &record).unwrap();
        assert!(
            matches!(model.specimens[0].behaviour, Some(Behaviour::Elastic { stiffness }) if (stiffness - 320.0).abs() < 1e-9)
        );
        assert_eq!(model.procedures.len(), 6);
    }
}
