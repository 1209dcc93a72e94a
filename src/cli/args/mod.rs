//! Flags that several commands have, and the form of their values. In: words of the command line. Out: values, or an error. It does not
//! open files and knows no command.

use clap::{Args, ValueEnum};

use psd_text::diagnostic::excerpt::{escape, one_line};

/// The longest reason, characters.
const REASON: usize = 1000;

/// Settings of the plan on the command line.
#[derive(Clone, Debug, Default, Args)]
pub struct PlanSettings {
    /// The rig to use; a real rig moves only when named
    #[arg(long, value_name = "NAME")]
    pub rig: Option<String>,
    /// Set a `param` or a number of a block: `--set speed="1 m/s"`
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub set: Vec<(String, String)>,
    /// Date on the report [default: the day of the run]
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
    pub date: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Color {
    Auto,
    Always,
    Never,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Human,
    Json,
}

/// The run log of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RunLog {
    Compact,
    Full,
}

fn setting(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write it as NAME=VALUE")?;
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() || value.is_empty() {
        return Err("write it as NAME=VALUE".to_owned());
    }
    Ok((name.to_owned(), value.to_owned()))
}

/// A person's name: one short line.
pub(super) fn name(text: &str) -> Result<String, String> {
    let name = text.trim();
    if name.is_empty() || name.chars().count() > 200 || name != escape(name) || name.contains('\n')
    {
        return Err("a name must be one line of at most 200 characters".to_owned());
    }
    Ok(name.to_owned())
}

/// A day of the calendar, in the form that a report shows.
pub(super) fn date(text: &str) -> Result<String, String> {
    let day: jiff::civil::Date = text
        .parse()
        .map_err(|_| "not a date; write it as 2026-05-31".to_owned())?;
    // The calendar's reader also takes times and other forms.
    if day.to_string() == text {
        Ok(text.to_owned())
    } else {
        Err(format!("write it as {day}"))
    }
}

/// A particular and its text: `customer=Other Ltd`.
pub(super) fn particular(text: &str) -> Result<(String, String), String> {
    let (field, text) = text.split_once('=').ok_or("write it as FIELD=TEXT")?;
    Ok((field.trim().to_owned(), text.trim().to_owned()))
}

/// One line.
pub(super) fn reason(text: &str) -> Result<String, String> {
    let reason = text.trim();
    if reason.is_empty() || reason.chars().count() > REASON || reason != one_line(reason) {
        return Err(format!(
            "a reason must be one line of at most {REASON} characters"
        ));
    }
    Ok(reason.to_owned())
}

#[cfg(test)]
mod tests;
