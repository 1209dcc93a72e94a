//! The rig in a whole run: faults, remote control, settled dwells, storage.

pub(crate) mod faults;
pub(crate) mod relaxing_specimen;
pub(crate) mod remote_control;
pub(crate) mod settled_hold;
pub(crate) mod slow_line;

use crate::check::{Options, check, no_files};
use crate::run::{Unwatched, run};
use crate::tests::fault_table::stage;
use psd_plan::formula::ResultValue;
use psd_plan::record::{ProcedureRecord, Record};
use psd_rig::emulator::Log;

/// The plan, run on the emulator of its rig `bench` over lines of `baud`.
fn over_a_line(text: &str, baud: f64, seed: u64) -> Record {
    let options = Options {
        rig: Some("bench".to_owned()),
        ..Options::default()
    };
    let checked = check("bench.psd", text, &no_files, &options);
    let plan = checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
    let emulator = stage::emulator(&plan, "", Log::none(), seed).at_baud(baud);
    let mut rig = stage::open(&plan, &emulator).expect("it answers");
    run(&plan, &mut rig, &mut Unwatched)
}

/// A result and its standard uncertainty.
fn uncertain(procedure: &ProcedureRecord, name: &str) -> (f64, f64) {
    match procedure.result(name).map(|result| &result.value) {
        Some(ResultValue::Number {
            value: Some(value),
            uncertainty: Some(uncertainty),
        }) => (*value, *uncertainty),
        other => panic!("{name} is {other:?}"),
    }
}
