//! Tests of the check on whole plans: the plan that results, and the diagnostics with their
//! positions.

mod binding;
mod bounds;
mod diagnostics;
mod plan;
mod real_rig;
mod studies;

use super::{Checked, LoadError, Loader, Options, check, no_files};

/// Files by path.
fn files<'f>(files: &'f [(&str, &str)]) -> impl Fn(&str) -> Result<String, LoadError> + 'f {
    |path| {
        files
            .iter()
            .find(|(name, _)| *name == path)
            .map(|(_, text)| (*text).to_owned())
            .ok_or(LoadError::NotFound)
    }
}

/// The outcome, and a line for each diagnostic: its code and the text under its first label.
fn checked(text: &str, files: &Loader<'_>, settings: &[(&str, &str)]) -> (Checked, String) {
    let settings = settings
        .iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    let checked = check(
        "plan.psd",
        text,
        files,
        &Options {
            settings,
            ..Options::default()
        },
    );
    let line = |diagnostic: &psd_text::diagnostic::Diagnostic| {
        format!(
            "{} {}",
            diagnostic.code,
            diagnostic
                .span()
                .map_or("", |span| checked.sources.text(span))
        )
    };
    let reported = checked
        .diagnostics
        .iter()
        .map(line)
        .collect::<Vec<_>>()
        .join("\n");
    (checked, reported)
}
