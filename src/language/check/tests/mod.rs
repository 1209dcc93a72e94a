//! Tests of the check on whole plans: the plan that results, and the diagnostics with their
//! positions.

mod binding;
mod bounds;
mod faults;
mod plan;
mod real_rig;
mod recorded;

use super::{Checked, LoadFault, Loader, Options, check};

/// Files by path.
struct Files<'f>(&'f [(&'f str, &'f str)]);

impl Loader for Files<'_> {
    fn load(&self, path: &str) -> Result<String, LoadFault> {
        self.0
            .iter()
            .find(|(name, _)| *name == path)
            .map(|(_, text)| (*text).to_owned())
            .ok_or(LoadFault::NotFound)
    }
}

/// The outcome, and what was said: a line for each diagnostic, its code and the text it points at.
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
    let line = |fault: &crate::text::diagnostic::Diagnostic| {
        format!(
            "{} {}",
            fault.code,
            fault.span().map_or("", |span| checked.sources.text(span))
        )
    };
    let said = checked
        .diagnostics
        .iter()
        .map(line)
        .collect::<Vec<_>>()
        .join("\n");
    (checked, said)
}
