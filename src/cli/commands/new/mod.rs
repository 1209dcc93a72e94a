//! `psd new KIND`: a commented plan to start from. In: its kind, and the file to create. Out: the file. It replaces no file.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::files::loader::is_stdin;
use crate::output::{print_message, print_result};
use psd_text::diagnostic::excerpt::one_line;

#[derive(Debug, Args)]
pub struct NewArguments {
    /// Kind of test
    #[arg(value_enum)]
    pub kind: Kind,
    /// File to create, or `-` for standard output [default: KIND.psd]
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
}

/// The tests of which there is a plan to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// A striker hits a beam
    Impact,
    /// A striker hits a storey of a frame
    Frame,
    /// Growing displacement cycles
    Cycle,
    /// A stiffness ramp
    Ramp,
    /// Many simulated impacts with scattered inputs
    Study,
}

impl Kind {
    const fn plan(self) -> &'static str {
        match self {
            Self::Impact => include_str!("impact.psd"),
            Self::Frame => include_str!("frame.psd"),
            Self::Cycle => include_str!("cycle.psd"),
            Self::Ramp => include_str!("ramp.psd"),
            Self::Study => include_str!("study.psd"),
        }
    }

    /// The command that runs the plan, without its file.
    const fn runs(self) -> &'static str {
        match self {
            Self::Impact | Self::Frame | Self::Cycle | Self::Ramp => "psd run",
            Self::Study => "psd study run",
        }
    }
}

/// Creates the plan.
pub fn new(arguments: &NewArguments) -> Result<Exit, Failure> {
    let kind = arguments.kind;
    let named = kind.to_possible_value();
    let name = named.as_ref().map_or("plan", |value| value.get_name());
    let file = arguments.file.clone();
    let file = file.unwrap_or_else(|| PathBuf::from(format!("{name}.psd")));
    if is_stdin(&file) {
        print_result(&kind.plan().replace("FILE", &format!("{name}.psd")))?;
        return Ok(Exit::Met);
    }
    let shown = one_line(&file.display().to_string());
    create(&file, &kind.plan().replace("FILE", &shown))?;
    print_message(&format!(
        "  edit {shown}, then\n  psd check {shown}\n  {} {shown}\n",
        kind.runs()
    ));
    print_result(&format!("{shown}\n"))?;
    Ok(Exit::Met)
}

fn create(file: &Path, text: &str) -> Result<(), Failure> {
    let created = OpenOptions::new().write(true).create_new(true).open(file);
    created
        .and_then(|mut created| created.write_all(text.as_bytes()))
        .map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => {
                Failure::command_line(format!("{} exists already", file.display()))
                    .help("name another file")
            }
            _ => Failure::file(file, plain(&error)),
        })
}
