//! Run logs: their bytes, and run logs of a forger, whose lines are all valid.

use std::cell::RefCell;

use psd::check::{Options, check, no_files};
use psd::run::Unwatched;
use psd::run::replay::{
    Header, HeaderFile, LogForm, LoggedRun, RULES, begin, check_consistency, record, replay,
    well_formed,
};
use psd_plan::Plan;
use psd_plan::record::equipment::{Device, Equipment};
use psd_rig::journal::{Durability, EntryKind, Journal};
use psd_rig::virtual_rig;
use psd_testing::journal::{PowerLoss, records, recover, written};
use serde_json::Value;

use super::attack;

/// A run of some 40 steps.
const PLAN: &str = "specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 300 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = 1 m/s
}

stiffness ramp k0 {
  displacements = 1 mm .. 4 mm step 1 mm
}

impact hit {
  striker   = hammer
  time_step = 5 ms
  duration  = 100 ms
}
";

fn plan() -> Plan {
    check("beam.psd", PLAN, &no_files, &Options::default())
        .plan
        .expect("a right plan")
}

/// The run log of a run with every reading.
fn run_log(plan: &Plan) -> Vec<u8> {
    let mut rig = virtual_rig(plan);
    let header = Header {
        run_id: "0123456789abcdef".to_owned(),
        psd: "0.2.0".to_owned(),
        build: String::new(),
        rules: RULES,
        toolchain: String::new(),
        files: vec![HeaderFile {
            name: "beam.psd".to_owned(),
            sha256: String::new(),
        }],
        settings: Vec::new(),
        rig: None,
        equipment: Equipment::of(plan, Device::of(&rig.identity(), rig.declared_noise())),
        log: LogForm::default(),
        check_run: false,
        served: None,
        date: None,
        operator: None,
        host: None,
        began: None,
    };
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    begin(&mut journal, &header, &[PLAN.to_owned()]).expect("memory");
    record(plan, &mut *rig, &mut Unwatched, journal, Box::new(|| None));
    disk.written()
}

/// Everything that is read from a run log.
fn read(plan: &Plan, bytes: &[u8]) -> bool {
    let Ok(recovered) = recover(bytes) else {
        return false;
    };
    let Ok(logged) = LoggedRun::of(&recovered) else {
        return false;
    };
    let is_sound = well_formed(&recovered, plan, &logged.header).is_ok()
        && check_consistency(&recovered, &logged, plan).is_ok();
    is_sound && replay(plan, logged).mismatch.is_none()
}

#[test]
fn the_bytes_of_a_run_log() {
    let plan = plan();
    let log = run_log(&plan);
    assert!(read(&plan, &log));
    attack("run log", &[log], |bytes| {
        read(&plan, bytes);
    });
}

#[test]
fn the_run_log_of_a_forger() {
    let plan = plan();
    let entries = records(&run_log(&plan));
    let lines = entries
        .iter()
        .map(|(kind, body)| format!("{} {body}\n", kind.word()));
    let deepest = RefCell::new(0_u32);
    attack(
        "forged run log",
        &[lines.collect::<String>().into_bytes()],
        |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let entries = text.lines().filter_map(|line| {
                let (word, body) = line.split_once(' ')?;
                let kind = EntryKind::ALL.iter().find(|kind| kind.word() == word)?;
                let body = serde_json::from_str::<Value>(body).ok()?;
                // The writer of a run log accepts objects alone.
                body.is_object().then_some((*kind, body))
            });
            let is_read = read(&plan, &written(entries));
            *deepest.borrow_mut() += u32::from(is_read);
        },
    );
    assert!(*deepest.borrow() > 0, "no run log was replayed");
}
