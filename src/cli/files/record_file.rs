//! The run log of a run that is about to begin. In: a plan, the connected rig. Out: an open run log.

use std::path::Path;

use super::disk_space;
use crate::args::PlanSettings;
use crate::files::failure::Failure;
use psd::report::Provenance;
use psd::run::replay;
use psd::run::replay::{Header, HeaderFile, LogForm, RULES};
use psd_plan::Plan;
use psd_plan::record::equipment::{Device, Equipment};
use psd_rig::Rig;
use psd_rig::journal::{Durability, FileStorage, Journal, Storage};
use psd_text::digest::sha256;

pub use crate::files::circumstances::Circumstances;
pub use crate::files::recorded_run::{JOURNAL, ReadRecord, journal_of, of_text, read};

/// The header of a run on the connected device, with a full run log.
pub fn header(
    plan: &Plan,
    device: Device,
    settings: &PlanSettings,
    provenance: &Provenance,
    circumstances: Circumstances,
) -> Header {
    let file = |file: &psd_plan::PlanFile| HeaderFile {
        name: file.name.clone(),
        sha256: sha256(file.text.as_bytes()),
    };
    let Circumstances {
        operator,
        host,
        began,
        served,
    } = circumstances;
    Header {
        run_id: provenance.run_id.clone(),
        psd: provenance.psd_version.clone(),
        build: provenance.build.sources.clone(),
        rules: RULES,
        toolchain: provenance.build.toolchain.clone(),
        files: plan.files.iter().map(file).collect(),
        settings: settings.set.clone(),
        rig: settings.rig.clone(),
        equipment: Equipment::of(plan, device),
        log: LogForm::Full,
        check_run: plan.performed_part().is_some(),
        served,
        date: settings.date.clone(),
        operator,
        host,
        began,
    }
}

/// Identity and declared errors of a rig.
pub fn device(rig: &dyn Rig) -> Device {
    Device::of(&rig.identity(), rig.declared_noise())
}

/// Texts of the plan's files, in the header's order.
pub fn texts(plan: &Plan) -> Vec<String> {
    plan.files
        .iter()
        .map(|file| file.text.to_string())
        .collect()
}

/// Checks the disk of a run log that is about to be written.
///
/// # Errors
/// Its free space is too small, or the file system does not report it.
pub fn check_disk_space(folder: &Path, storage: &FileStorage) -> Result<(), Failure> {
    Ok(disk_space::compare(folder, storage.free_space()?)?)
}

/// Opens the run log of a run that is about to begin, if its disk has enough free space.
pub fn begin(folder: &Path, plan: &Plan, header: &Header) -> Result<Journal, Failure> {
    let path = journal_of(folder);
    // A run that did not begin leaves no file, and its empty folder is removed.
    let storage = FileStorage::create(&path).inspect_err(|_| drop(std::fs::remove_dir(folder)))?;
    if let Err(failure) = check_disk_space(folder, &storage) {
        drop(storage);
        let _ = std::fs::remove_file(&path).and_then(|()| std::fs::remove_dir(folder));
        return Err(failure);
    }
    begin_in(Box::new(storage), plan, header)
}

/// A run log that is not kept. The run is bit-identical with a recorded one.
pub fn begin_nowhere(plan: &Plan, header: &Header) -> Result<Journal, Failure> {
    begin_in(Box::new(Nowhere), plan, header)
}

fn begin_in(storage: Box<dyn Storage>, plan: &Plan, header: &Header) -> Result<Journal, Failure> {
    let durability = if plan.rig.link.as_real().is_some() {
        Durability::EverySyncPoint
    } else {
        Durability::Buffered
    };
    let mut journal = Journal::create(storage, durability);
    replay::begin(&mut journal, header, &texts(plan))?;
    Ok(journal)
}

/// Accepts every byte and keeps none.
struct Nowhere;

impl Storage for Nowhere {
    fn append(&mut self, _: &[u8]) -> std::io::Result<()> {
        Ok(())
    }

    fn sync(&mut self) -> std::io::Result<()> {
        Ok(())
    }

    fn cut(&mut self, _: u64) -> std::io::Result<()> {
        Ok(())
    }
}
