//! The end of the program: the exit codes of the language reference, and failures that are not errors of the plan.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use super::files::disk_space::DiskSpaceFault;
use super::settings::Settings;
use crate::rig::RigFault;
use crate::text::diagnostic::excerpt::escape;
use crate::text::source::Position;
use crate::verdict::Verdict;

/// An exit code, worst last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// 0: all requirements are met, or there is none.
    Met,
    /// 1: a requirement failed or is inconclusive; a file is not formatted.
    Missed,
    /// 2: the plan or the command line is wrong.
    Wrong,
    /// 3: the rig or a file failed.
    Fault,
    /// 4: stopped by a limit or by the operator.
    Stopped,
    /// 5: results differ from the accepted ones.
    Differs,
}

impl Exit {
    /// The exit code of the process.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Met => 0,
            Self::Missed => 1,
            Self::Wrong => 2,
            Self::Fault => 3,
            Self::Stopped => 4,
            Self::Differs => 5,
        }
    }
}

impl From<Verdict> for Exit {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Completed | Verdict::Pass => Self::Met,
            Verdict::Inconclusive | Verdict::Fail => Self::Missed,
            Verdict::Aborted => Self::Stopped,
            Verdict::Error => Self::Fault,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}

/// The reason why a command failed. Errors of a plan are diagnostics instead.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    #[error("{message}")]
    CommandLine {
        message: String,
        help: Option<String>,
    },
    #[error("{}: {reason}", path.display())]
    File {
        path: PathBuf,
        reason: String,
        help: Option<String>,
    },
    #[error("{}: not a plan: {reason}", path.display())]
    NotAPlan {
        path: PathBuf,
        reason: String,
        at: Option<Position>,
    },
    #[error("the results could not be made: {0}")]
    Output(#[from] crate::report::OutputError),
    #[error("standard output: {0}")]
    Stdout(std::io::Error),
    #[error(transparent)]
    Record(#[from] crate::record::journal::FileFault),
    #[error(transparent)]
    Journal(#[from] crate::record::journal::JournalFault),
    #[error("{0}")]
    Rig(#[from] crate::rig::RigFault),
    #[error(transparent)]
    DiskSpaceFault(#[from] super::files::disk_space::DiskSpaceFault),
    #[error("{fault}")]
    NotOpened {
        fault: crate::rig::RigFault,
        place: String,
    },
    #[error("no rehearsal: {0}")]
    Unrehearsed(#[from] crate::run::rehearsal::Unrehearsed),
    #[error("the run cannot go on: {0}")]
    Refused(#[from] crate::run::replay::ResumeRefusal),
    #[error("not resumed, and nothing moved: {reason}")]
    NotReleased { reason: String },
    #[error("signals cannot be caught, so that a run could not be stopped: {0}")]
    Signals(std::io::Error),
}

/// Part of the message of a device that does not answer.
const SILENT: &str = "no usable answer";
/// Possible causes of a silent device.
const LOOK_FOR: &str = "the baud rate, the dialect, crossed wires, or a device that still starts; `psd rig simulate` in its place shows\n       \
    whether the plan is right";

impl Failure {
    pub fn command_line(message: impl Into<String>) -> Self {
        Self::CommandLine {
            message: message.into(),
            help: None,
        }
    }

    pub fn file(path: impl Into<PathBuf>, reason: impl Into<String>) -> Self {
        Self::File {
            path: path.into(),
            reason: reason.into(),
            help: None,
        }
    }

    /// The position in a file at which its text could not be read.
    pub const fn place(&self) -> Option<Position> {
        match self {
            Self::NotAPlan { at, .. } => *at,
            _ => None,
        }
    }

    /// The same failure with advice.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        if let Self::CommandLine { help, .. } | Self::File { help, .. } = &mut self {
            *help = Some(text.into());
        }
        self
    }

    /// A rig that cannot be opened, with the position in the plan that specifies it.
    #[must_use]
    pub fn in_the_plan(self, place: impl FnOnce(&str) -> Option<String>) -> Self {
        match self {
            Self::Rig(fault) => match place(&fault.to_string()) {
                Some(place) => Self::NotOpened { fault, place },
                None => Self::Rig(fault),
            },
            other => other,
        }
    }

    pub const fn exit(&self) -> Exit {
        match self {
            Self::CommandLine { .. } | Self::NotAPlan { .. } | Self::Unrehearsed(_) => Exit::Wrong,
            Self::Rig(fault) | Self::NotOpened { fault, .. } => match fault {
                RigFault::LimitBreached { .. }
                | RigFault::NotSettled { .. }
                | RigFault::Interrupted => Exit::Stopped,
                RigFault::Device(_) | RigFault::Following { .. } => Exit::Fault,
            },
            Self::NotReleased { .. } => Exit::Stopped,
            Self::File { .. }
            | Self::Output(_)
            | Self::Stdout(_)
            | Self::Record(_)
            | Self::Journal(_)
            | Self::DiskSpaceFault(_)
            | Self::Refused(_)
            | Self::Signals(_) => Exit::Fault,
        }
    }

    /// The message for the operator.
    pub fn report(&self, settings: Settings) -> String {
        let (head, help) = match self {
            Self::CommandLine { help, .. } | Self::File { help, .. } => {
                ("error:".to_owned(), help.clone())
            }
            Self::DiskSpaceFault(fault) => (
                format!("error[{}]", DiskSpaceFault::CODE),
                Some(fault.help()),
            ),
            Self::NotOpened {
                fault: RigFault::Device(message),
                ..
            } if message.contains(SILENT) => ("error:".to_owned(), Some(LOOK_FOR.to_owned())),
            _ => ("error:".to_owned(), None),
        };
        let mut text = format!(
            "{} {}\n",
            settings.paint_error(&head),
            escape(&self.to_string())
        );
        if let Self::NotOpened { place, .. } = self {
            let _ = writeln!(text, "{} {}", settings.paint_note("  at:"), escape(place));
        }
        if let Some(help) = help {
            let _ = writeln!(text, "{} {}", settings.paint_note(" help:"), escape(&help));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_end_as_the_reference_says() {
        let verdicts = [
            Verdict::Completed,
            Verdict::Pass,
            Verdict::Fail,
            Verdict::Inconclusive,
            Verdict::Error,
            Verdict::Aborted,
        ];
        assert_eq!(
            verdicts.map(|verdict| Exit::from(verdict).code()),
            [0, 0, 1, 1, 3, 4]
        );
    }
}
