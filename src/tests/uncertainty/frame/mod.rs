//! Uncertainty of the results of frames, under ground motion and impact.

mod closed_form;
mod hybrid;
mod repeated_runs;

use crate::tests::testing::{elastic_plan, every};
use psd_plan::formula::{Formula, ResultValue};
use psd_plan::record::Record;
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{
    Behaviour, Frame, Ground, Plan, ProcedureKind, Shake, ShakeDamping, Stepping, Storey,
};

pub(crate) fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

pub(crate) fn storey(mass: f64, stiffness: f64) -> Storey {
    Storey::new(mass, stiffness, Behaviour::Elastic { stiffness })
}

/// A frame on ground that moves from the start, with these accelerations 10 ms apart.
pub(crate) fn base_excited_plan(
    storeys: Vec<Storey>,
    accelerations: Vec<f64>,
    time_step: f64,
) -> Plan {
    let shake = Shake {
        specimen: 0,
        ground: 0,
        damping: ShakeDamping::Rayleigh(constant(0.0)),
        damping_uncertainty: 0.0,
        stepping: Stepping {
            max_tangent_ratio: constant(2.0),
            ..every(time_step)
        },
        scale: constant(1.0),
        duration: None,
        until: None,
    };
    let mut plan = elastic_plan(1.0, vec![ProcedureKind::Shake(shake)]);
    let times = (0..accelerations.len())
        .map(|sample| 0.01 * f64::from(u32::try_from(sample).unwrap()))
        .collect();
    let ground = Ground {
        name: "quake".to_owned(),
        file: "quake.csv".to_owned(),
        unit: 1.0,
        scale: 1.0,
        scale_uncertainty: 0.0,
        times,
        accelerations,
    };
    plan.grounds = vec![ground];
    plan.specimens[0].frame = Some(Frame::of_storeys(storeys));
    plan.specimens[0].behaviour = None;
    plan
}

pub(super) fn storeys(plan: &mut Plan) -> &mut Vec<Storey> {
    &mut plan.specimens[0].frame.as_mut().unwrap().storeys
}

pub(super) fn rebuilt(mut plan: Plan) -> Plan {
    let storeys = std::mem::take(storeys(&mut plan));
    plan.specimens[0].frame = Some(Frame::of_storeys(storeys));
    plan
}

pub(super) fn shake(plan: &mut Plan) -> &mut Shake {
    match &mut plan.procedures[0].kind {
        ProcedureKind::Shake(shake) => shake,
        other => panic!("{other:?}"),
    }
}

/// A number of a result with its contributions.
pub(crate) fn entry(record: &Record, name: &str, entry: usize) -> (f64, Vec<Contribution>) {
    let result = record.procedures[0].result(name).unwrap();
    let value = match &result.value {
        ResultValue::List(values) => values[entry],
        ResultValue::Number { value, .. } => value.unwrap(),
    };
    (
        value,
        result
            .contributions
            .iter()
            .filter(|part| part.entry == entry)
            .copied()
            .collect(),
    )
}

pub(crate) fn from(parts: &[Contribution], source: Source) -> f64 {
    parts
        .iter()
        .filter(|part| part.source == source)
        .map(|part| part.amount)
        .sum()
}
