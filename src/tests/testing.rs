//! Plans built without text, and their runs.

pub(crate) use psd_testing::plans::*;

use crate::run::replay::{Header, HeaderFile, LogForm, RULES};
use psd_plan::Plan;
use psd_plan::record::Record;
use psd_plan::record::equipment::{Device, Equipment};
use psd_rig::virtual_rig;

pub(crate) fn run_unwatched(plan: &Plan) -> Record {
    crate::run::run(plan, &mut *virtual_rig(plan), &mut crate::run::Unwatched)
}

/// Start of a record that the test does not check.
pub(crate) fn header(plan: &Plan) -> Header {
    let rig = virtual_rig(plan);
    Header {
        run_id: "0123456789abcdef".to_owned(),
        psd: "0".to_owned(),
        build: "0".to_owned(),
        rules: RULES,
        toolchain: String::new(),
        files: vec![HeaderFile {
            name: "a.psd".to_owned(),
            sha256: String::new(),
        }],
        settings: Vec::new(),
        rig: None,
        equipment: Equipment::of(plan, Device::of(&rig.identity(), rig.declared_noise())),
        check_run: false,
        log: LogForm::Full,
        served: None,
        date: None,
        operator: None,
        host: None,
        began: None,
    }
}
