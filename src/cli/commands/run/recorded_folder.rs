//! The folder of an interrupted run, before it continues: its files and results. In: a run log, a folder. Out: its
//! changed files. It moves nothing.

use std::path::{Path, PathBuf};

use crate::exit::Failure;
use crate::files::failure::plain;
use psd::run::replay::Header;

/// Files whose digests differ, or that only one of the two has.
pub(super) fn changed_files(recorded: &Header, now: &Header) -> Vec<String> {
    let of = |header: &Header, name: &str| {
        header
            .files
            .iter()
            .find(|file| file.name == name)
            .map(|file| file.sha256.clone())
    };
    let mut names: Vec<&str> = recorded
        .files
        .iter()
        .chain(&now.files)
        .map(|file| file.name.as_str())
        .collect();
    names.sort_unstable();
    names.dedup();
    let digest_text = |digest: Option<String>| digest.unwrap_or_else(|| "nothing".to_owned());
    let changed = names
        .into_iter()
        .filter(|name| of(recorded, name) != of(now, name));
    changed
        .map(|name| {
            format!(
                "{name}: {} became {}",
                digest_text(of(recorded, name)),
                digest_text(of(now, name))
            )
        })
        .collect()
}

/// Keeps the results of the interrupted run, beside the future ones.
pub(super) fn put_results_aside(run: &Path) -> Result<(), Failure> {
    let failed = |path: PathBuf| move |error: std::io::Error| Failure::file(path, plain(&error));
    let entries = std::fs::read_dir(run).map_err(failed(run.to_owned()))?;
    let is_result =
        |name: &str| !name.starts_with("journal.") && !name.starts_with("before-resume-");
    let names: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| is_result(name))
        .collect();
    if names.is_empty() {
        return Ok(());
    }
    let aside = (1..u32::MAX)
        .map(|number| run.join(format!("before-resume-{number}")))
        .find(|path| !path.exists());
    let Some(aside) = aside else { return Ok(()) };
    std::fs::create_dir(&aside).map_err(failed(aside.clone()))?;
    names.into_iter().try_for_each(|name| {
        std::fs::rename(run.join(&name), aside.join(&name)).map_err(failed(run.join(name)))
    })
}
