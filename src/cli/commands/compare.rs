//! `psd compare RUN RUN…`: comparison of runs. In: run folders, read from their run logs, or folders of accepted results. Out: tables on
//! standard output; with `--out` also a page, a CSV and the figures. It opens no rig and changes no run.

use std::path::{Path, PathBuf};

use clap::Args;

use super::prediction::prediction;
use crate::evidence::{Folder, IssueFile, ReplayedRun};
use crate::exit::{Exit, Failure};
use crate::files::accepted::truth_in;
use crate::files::record_file;
use crate::files::record_file::journal_of;
use crate::files::run_folder::{RunFolder, write_new};
use crate::output::print_result;
use psd::golden::comparison;
use psd::golden::comparison::page::page;
use psd::golden::comparison::{Comparison, Side};
use psd::golden::{FIGURES, SUMMARY};
use psd::report::summary::Summary;
use psd::report::{Figures, OutputError, OutputFile, figures};

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Run folders, or folders of accepted results; at least two
    #[arg(value_name = "RUN", num_args = 2.., required = true)]
    pub runs: Vec<PathBuf>,
    /// Also write a page, a CSV and figures into this new folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Compares runs.
pub fn compare(arguments: &CompareArguments) -> Result<Exit, Failure> {
    let sides = arguments
        .runs
        .iter()
        .map(|run| side(run))
        .collect::<Result<Vec<Side>, Failure>>()?;
    let folder = arguments
        .out
        .as_deref()
        .map(|out| RunFolder::create(Some(out), out))
        .transpose()?;
    let compared = Comparison::of(&sides);
    print_result(&comparison::comparison_text(&compared))?;
    let Some(folder) = folder else {
        return Ok(Exit::Met);
    };
    let mut drawn = Vec::new();
    for sheet in comparison::sheets(&sides) {
        let failed = |reason| OutputError::Figure {
            figure: "comparison",
            procedure: sheet.name.clone(),
            reason,
        };
        let png = sheet.curves.png().map_err(failed)?;
        write_new(
            folder.path(),
            &OutputFile {
                path: format!("figures/{}.png", sheet.name),
                bytes: png.clone(),
            },
        )?;
        drawn.push((sheet.caption, png));
    }
    let file = |path: &str, text: String| OutputFile {
        path: path.to_owned(),
        bytes: text.into_bytes(),
    };
    write_new(
        folder.path(),
        &file("results.csv", comparison::csv(&compared)),
    )?;
    write_new(
        folder.path(),
        &file("comparison.html", page(&compared, &drawn)),
    )?;
    print_result(&format!("{}\n", folder.path().display()))?;
    Ok(Exit::Met)
}

/// One run, from its run log where it has one.
fn side(run: &Path) -> Result<Side, Failure> {
    let name = run.display().to_string();
    if journal_of(run).exists() {
        from_record(name, run)
    } else {
        from_results(name, run)
    }
}

fn from_record(name: String, run: &Path) -> Result<Side, Failure> {
    let kept = Folder::read(run)?;
    let issues = IssueFile::of(&kept).map_err(|fault| Failure::file(run, fault))?;
    let replayed = ReplayedRun::of(record_file::read(run)?, issues.as_ref(), &prediction)
        .map_err(|fault| Failure::file(run, fault))?;
    replayed.refuse_another_simulation(run)?;
    if replayed.steps.is_some() {
        return Err(Failure::file(
            run,
            "is a run that a client drove: it has no results to compare",
        ));
    }
    let run = replayed.run();
    Ok(Side {
        name,
        summary: serde_json::to_value(Summary::of(&run)).expect("plain numbers and texts"),
        figures: figures::data(&run),
        plan: replayed
            .plan
            .files
            .first()
            .map(|file| file.text.to_string()),
    })
}

/// Accepted results hold the same numbers, without a plan.
fn from_results(name: String, folder: &Path) -> Result<Side, Failure> {
    let truth = truth_in(folder)?;
    let Some(summary) = truth.text(SUMMARY) else {
        return Err(
            Failure::file(folder, "is not a run: it has no run log and no summary")
                .help("name a run folder, such as runs/beam-1, or a folder of accepted results"),
        );
    };
    let summary = serde_json::from_str(summary)
        .map_err(|error| Failure::file(folder.join(SUMMARY), error.to_string()))?;
    let figures = match truth.text(FIGURES) {
        Some(text) => serde_json::from_str(text)
            .map_err(|error| Failure::file(folder.join(FIGURES), error.to_string()))?,
        None => Figures::default(),
    };
    Ok(Side {
        name,
        summary,
        figures,
        plan: None,
    })
}
