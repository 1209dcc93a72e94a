//! Results of identification as inputs of a study. In: a plan. Out: the same plan, in which each such input has a normal distribution with
//! the value and the standard uncertainty that one simulated run gives it. The run does not scatter the inputs of the study.

use thiserror::Error;

use crate::run::{Unwatched, run};
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::Source;
use psd_plan::Plan;
use psd_plan::formula::{ResultValue, Results as _};
use psd_plan::record::Record;
use psd_plan::study::{Measured, Variation};
use psd_rig::virtual_rig;

/// An uncertainty below this fraction of the value is only rounding: nothing of the run is uncertain.
const ROUNDING: f64 = 1e-9;

/// The run gives an input no distribution.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MeasuredError {
    #[error("a run of the plan does not give `{0}`")]
    NoValue(String),
    #[error("a run of the plan gives `{0}` without an uncertainty")]
    NoUncertainty(String),
}

/// Runs the plan once if a study varies one of its results.
///
/// # Errors
/// The run does not give the result, or not its uncertainty.
pub fn known(plan: &mut Plan) -> Result<(), MeasuredError> {
    let studies = &plan.studies;
    let of_studies = studies.studies.iter().map(|study| &study.variation);
    let of_fragilities = studies
        .fragilities
        .iter()
        .filter_map(|it| it.variation.as_ref());
    if of_studies
        .chain(of_fragilities)
        .all(|variation| variation.measured.is_empty())
    {
        return Ok(());
    }
    let mut rig = virtual_rig(plan);
    let record = run(plan, rig.as_mut(), &mut Unwatched);
    let studies = &mut plan.studies;
    for study in &mut studies.studies {
        of_variation(&mut study.variation, &record)?;
    }
    for fragility in &mut studies.fragilities {
        if let Some(variation) = &mut fragility.variation {
            of_variation(variation, &record)?;
        }
    }
    Ok(())
}

fn of_variation(variation: &mut Variation, record: &Record) -> Result<(), MeasuredError> {
    for Measured {
        input,
        source,
        result,
    } in variation.measured.clone()
    {
        let input = &mut variation.inputs[input];
        let Some(ResultValue::Number {
            value: Some(value),
            uncertainty,
        }) = record.result(result)
        else {
            return Err(MeasuredError::NoValue(input.name.clone()));
        };
        let law = uncertainty
            .filter(|uncertainty| *uncertainty > ROUNDING * value.abs())
            .and_then(|uncertainty| Distribution::normal(value, Spread::Sd(uncertainty)).ok());
        let Some(law) = law else {
            return Err(MeasuredError::NoUncertainty(input.name.clone()));
        };
        input.nominal = value;
        variation.sources[source] = Source::Distribution(law);
    }
    Ok(())
}
