//! Tests of the check on whole plans: the plan that results, and the diagnostics with their
//! positions.

mod binding;
mod bounds;
mod diagnostics;
mod plan;
mod real_rig;
mod recorded;
mod renamed;
mod studies;

use super::{Checked, LoadError, Loader, Options, check};

/// Files by path.
struct Files<'f>(&'f [(&'f str, &'f str)]);

impl Loader for Files<'_> {
    fn load(&self, path: &str) -> Result<String, LoadError> {
        self.0
            .iter()
            .find(|(name, _)| *name == path)
            .map(|(_, text)| (*text).to_owned())
            .ok_or(LoadError::NotFound)
    }
}

/// The outcome, and a line for each diagnostic: its code and the text under its first label.
fn checked(text: &str, files: &Files, settings: &[(&str, &str)]) -> (Checked, String) {
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
    let line = |diagnostic: &crate::text::diagnostic::Diagnostic| {
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
