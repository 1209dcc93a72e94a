//! `psd study report FOLDER`: summary, figures and report of a study. In: its data set alone. Out: files beside it, which replace older
//! ones: equal data sets give equal files. It reads no plan and simulates nothing.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{answers, failure};
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::files::run_folder::FolderSink;
use crate::files::writing::ProgressSink;
use crate::output::print_result;
use crate::settings::Settings;
use psd::study::answers::Answers;
use psd::study::collection::folder::DataSetFiles;
use psd::study::data_set::Reader;
use psd::study::report;

#[derive(Debug, Args)]
pub struct ReportStudyArguments {
    /// The folder of the study, or a data set in it
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Write into this folder [default: that of the data set]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Makes the files of a study.
pub fn report(arguments: &ReportStudyArguments, settings: Settings) -> Result<Exit, Failure> {
    let given = &arguments.folder;
    let path = if given.is_dir() {
        DataSetFiles::of(given, None).path()
    } else {
        given.clone()
    };
    if !path.exists() {
        let failure = Failure::file(&path, "no such data set");
        return Err(failure
            .help("name the folder of a finished study; `psd study merge` puts shards together"));
    }
    let folder = match &arguments.out {
        Some(out) => out.as_path(),
        None => path.parent().unwrap_or_else(|| Path::new("")),
    };
    let exit = written(&path, folder, settings)?;
    print_result(&format!("{}\n", folder.display()))?;
    Ok(exit)
}

/// Reads the data set and writes every file of its report into the folder; the exit code is that of its requirements.
fn written(path: &Path, folder: &Path, settings: Settings) -> Result<Exit, Failure> {
    let read = || {
        let reader = Reader::open(path)?;
        let answers = Answers::of(&reader)?;
        Ok((reader, answers))
    };
    let (reader, found) = read().map_err(|fault| failure::of_data_set(&fault))?;
    std::fs::create_dir_all(folder).map_err(|error| Failure::file(folder, plain(&error)))?;
    let mut sink = FolderSink::replacing(folder);
    let made = {
        let mut progress = ProgressSink::new(&mut sink, settings);
        report::put(reader.metadata(), &found, &mut progress)
    };
    if let Err(error) = made {
        return Err(sink.failed(error));
    }
    Ok(answers::exit(&found))
}
