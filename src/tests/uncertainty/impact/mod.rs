//! Uncertainty of the results of an impact on one degree of freedom.

mod closed_form;
mod limits;
mod repeated_runs;

use crate::tests::testing::{elastic_plan, every, impact};
use psd_plan::formula::Formula;
use psd_plan::record::Record;
use psd_plan::uncertainty::{Contribution, Source};
use psd_plan::{Calibration, Contact, Impact, Plan, ProcedureKind};
use psd_testing::plans::ChangeTarget as _;

pub(super) const STIFFNESS: f64 = 327.65;
pub(super) const STRIKER: f64 = 10.0;
pub(super) const MASS: f64 = 1.0;

pub(super) fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

/// Perfectly plastic contact, so that the closed form is exact: both bodies continue with V = `Ms·V0/(M + Ms)`.
pub(super) fn sticking(time_step: f64) -> Impact {
    Impact {
        contact: Contact::Restitution {
            coefficient: constant(0.0),
        },
        stepping: every(time_step),
        ..impact(constant(STIFFNESS))
    }
}

pub(super) fn plan(impact: Impact) -> Plan {
    elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(impact)])
}

pub(super) fn contributions<'a>(
    record: &'a Record,
    procedure: usize,
    name: &str,
) -> &'a [Contribution] {
    &record.procedures[procedure]
        .result(name)
        .unwrap_or_else(|| panic!("{name} is missing"))
        .contributions
}

/// All contributions except that of the time step.
pub(super) fn without_the_time_step(parts: &[Contribution]) -> Vec<Contribution> {
    parts
        .iter()
        .filter(|part| part.source.is_of_uncertainty())
        .copied()
        .collect()
}

/// Contribution of a source to a result.
pub(super) fn from(record: &Record, name: &str, source: Source) -> f64 {
    let parts = contributions(record, 0, name);
    parts
        .iter()
        .find(|part| part.source == source)
        .map_or(0.0, |part| part.amount)
}

/// Every source simultaneously, 1 % each except the zero error.
pub(super) fn all_uncertain(mut plan: Plan) -> Plan {
    plan.strikers[0].mass_uncertainty = 0.01 * STRIKER;
    plan.strikers[0].velocity_uncertainty = 0.01;
    if let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind {
        impact.point_mut().mass_uncertainty = 0.01 * MASS;
    }
    plan.rig.calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.01,
        zero_uncertainty: 0.12,
        zero_drift: 0.16,
        ..Calibration::default()
    };
    plan
}
