//! Every file of the results of a run. In: the record and its assessment. Out: files.

use psd::report;
use psd::report::{FileDigest, OutputError, OutputSink, Provenance, Run};
use psd::verdict::Assessment;
use psd_plan::Plan;
use psd_plan::record::remote::DrivenStep;
use psd_plan::record::{Outcome, Record};

/// Puts every result of a run into a sink, without the manifest, which also lists the other files. A run that a client controlled has
/// only the table of its steps.
pub fn put_results(
    plan: &Plan,
    record: &Record,
    assessment: &Assessment,
    provenance: &Provenance,
    driven: Option<&[DrivenStep]>,
    sink: &mut dyn OutputSink,
) -> Result<Vec<FileDigest>, OutputError> {
    if matches!(record.outcome, Outcome::NotReleased { .. }) {
        // Nothing moved: there is a run log and no result.
        return Ok(Vec::new());
    }
    if let Some(steps) = driven {
        return report::put_driven(steps, record.drift.as_ref(), sink);
    }
    report::put_everything(
        &Run {
            plan,
            record,
            assessment,
            provenance,
        },
        sink,
    )
}
