//! The journal of a run folder. In: a plan before its run, or a folder. Out: an open journal, or the content of one with the
//! plan checked again from it. It reads no other file of the machine.

use std::path::{Path, PathBuf};

use super::disk_space;
use super::loader::plain;
use crate::cli::args::PlanSettings;
use crate::cli::exit::Failure;
use crate::language::check::{LoadError, Loader, Options, check};
use crate::plan::Plan;
use crate::record::equipment::{Device, Equipment};
use crate::record::journal::{
    Durability, FileStorage, Journal, Line, OLDEST_FORMAT, Recovered, Storage, recover,
};
use crate::report::{Build, Provenance, RealRun};
use crate::rig::Rig;
use crate::run::rehearsal;
use crate::run::replay;
use crate::run::replay::{Header, HeaderFile, LoggedRun, RULES};
use crate::text::digest::sha256;

/// Name of the journal in its run folder.
pub const JOURNAL: &str = "journal.psdj";

/// Operator, machine and times, which only the record of a real rig states.
#[derive(Clone, Debug, Default)]
pub struct Circumstances {
    pub operator: Option<String>,
    pub host: Option<String>,
    /// UTC.
    pub began: Option<String>,
    /// Protocol of the client that controls the rig, real or not.
    pub served: Option<String>,
}

impl Circumstances {
    /// Operator, machine and time, which distinguish a run on a real rig from every other.
    pub const fn told(&self) -> [&Option<String>; 3] {
        [&self.operator, &self.host, &self.began]
    }
}

/// The header of a run on the connected device.
pub fn header(
    plan: &Plan,
    device: Device,
    settings: &PlanSettings,
    provenance: &Provenance,
    circumstances: Circumstances,
) -> Header {
    let file = |file: &crate::plan::PlanFile| HeaderFile {
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
        equipment: Some(Equipment::of(plan, device)),
        rehearsal: rehearsal::rehearsed_plan(plan).is_some(),
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
    plan.files.iter().map(|file| file.text.clone()).collect()
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

/// A record that is not kept. The run is bit-identical with a recorded one.
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

/// A record as it was read.
pub struct ReadRecord {
    pub recovered: Recovered,
    pub played: LoggedRun,
    pub plan: Plan,
    pub provenance: Provenance,
}

/// Reads the journal of a run folder without touching it.
pub fn read(run: &Path) -> Result<ReadRecord, Failure> {
    let path = journal_of(run);
    let bytes = std::fs::read(&path).map_err(|error| Failure::file(&path, plain(&error)))?;
    from_bytes(&path, &bytes)
}

/// A record from the bytes of its journal.
pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<ReadRecord, Failure> {
    let damaged = |reason: String| Failure::file(path, reason);
    let recovered =
        recover(bytes).map_err(|damage| damaged(format!("the record is damaged: {damage}")))?;
    let played = LoggedRun::of(&recovered).map_err(|fault| damaged(fault.to_string()))?;
    for (file, text) in played.header.files.iter().zip(&played.texts) {
        if sha256(text.as_bytes()) != file.sha256 {
            return Err(damaged(format!(
                "the text of `{}` is not the one of its digest",
                file.name
            )));
        }
    }
    let plan = plan_of(&played).map_err(damaged)?;
    replay::well_formed(&recovered, &plan).map_err(|fault| damaged(fault.to_string()))?;
    if played.header.equipment.is_none() && recovered.format() > OLDEST_FORMAT {
        return Err(damaged(
            "its header does not say what was measured with".to_owned(),
        ));
    }
    fits(&played, &plan).map_err(damaged)?;
    let provenance = provenance_of(&played.header, &plan, &recovered);
    Ok(ReadRecord {
        recovered,
        played,
        plan,
        provenance,
    })
}

/// The journal of a run folder.
pub fn journal_of(run: &Path) -> PathBuf {
    run.join(JOURNAL)
}

/// The plan of a record, checked again from the record alone.
pub fn plan_of(played: &LoggedRun) -> Result<Plan, String> {
    let header = &played.header;
    let files = Files {
        header,
        texts: &played.texts,
    };
    let (Some(first), Some(text)) = (header.files.first(), played.texts.first()) else {
        return Err("the record holds no plan".to_owned());
    };
    let (rig, settings, date) = (
        header.rig.clone(),
        header.settings.clone(),
        header.date.clone(),
    );
    let options = Options {
        rig,
        settings,
        date,
        unattended: false,
        recorded: true,
    };
    let checked = check(&first.name, text, &files, &options);
    let plan = checked.plan.ok_or_else(|| {
        let fault = checked.diagnostics.iter().find(|found| found.is_error());
        let fault = fault.map_or_else(String::new, |fault| format!(": {}", fault.message));
        format!("this version of psd finds the recorded plan faulty{fault}")
    })?;
    if header.rehearsal {
        rehearsal::measured_part(&plan).map_err(|fault| fault.to_string())
    } else {
        Ok(plan)
    }
}

/// Whether the equipment of the header is that of plan and rig: a changed calibration is found.
fn fits(played: &LoggedRun, plan: &Plan) -> Result<(), String> {
    let (Some(told), Some(rig)) = (&played.header.equipment, &played.rig) else {
        return Ok(());
    };
    if *told == Equipment::of(plan, Device::of(&rig.identity, rig.noise)) {
        return Ok(());
    }
    Err(
        "what its header says of rig, calibration or limits is not what its plan and its rig say"
            .to_owned(),
    )
}

/// The provenance of the record; the date of the plan where the command line gave none.
fn provenance_of(header: &Header, plan: &Plan, recovered: &Recovered) -> Provenance {
    let number = super::provenance::report_number(
        &header.run_id,
        plan,
        recovered.ended,
        Some(recovered.head()),
    );
    let stated = Provenance {
        run_id: header.run_id.clone(),
        number,
        psd_version: header.psd.clone(),
        build: Build {
            sources: header.build.clone(),
            toolchain: header.toolchain.clone(),
        },
        plan_sha256: header
            .files
            .first()
            .map_or_else(String::new, |file| file.sha256.clone()),
        equipment: header.equipment.clone(),
        ..super::provenance::of(plan, header.date.as_deref())
    };
    if plan.rig.link.as_real().is_none() {
        return stated;
    }
    let date = super::provenance::date_of_real_run(plan, header.began.as_deref());
    Provenance {
        date,
        real: Some(real_run(header, recovered)),
        ..stated
    }
}

/// Operator, machine, times and chain of the record of a real run.
fn real_run(header: &Header, recovered: &Recovered) -> RealRun {
    let wall = |line: &Line| {
        line.body()
            .get("wall")
            .and_then(|wall| wall.as_str())
            .map(str::to_owned)
    };
    RealRun {
        operator: header.operator.clone(),
        host: header.host.clone(),
        began: header.began.clone(),
        ended: recovered.lines.iter().rev().find_map(wall),
        jumps: super::wall_clock::jumps(&recovered.lines),
        sealed: Some((recovered.lines.len() as u64, recovered.head().to_owned())),
    }
}

/// Loads the recorded files by the names under which they were used.
struct Files<'a> {
    header: &'a Header,
    texts: &'a [String],
}

impl Loader for Files<'_> {
    fn load(&self, path: &str) -> Result<String, LoadError> {
        let found = self.header.files.iter().position(|file| file.name == path);
        found
            .and_then(|index| self.texts.get(index))
            .cloned()
            .ok_or(LoadError::NotFound)
    }
}
