//! The end of the program: the exit codes of the language reference, and failures that are not errors of the plan.

use std::fmt::Write as _;
use std::process::ExitCode;

use super::settings::Settings;
use crate::files::failure::DiskSpaceFault;
pub use crate::files::failure::Failure;
use psd::verdict::{Assessment, ReproductionOutcome, Verdict};
use psd_rig::RigFault;
use psd_text::diagnostic::excerpt::escape;

/// An exit code, worst last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// 0: all requirements are met, or there is none.
    Met,
    /// 1: a requirement failed or is inconclusive; a published number is not reproduced; a file is not formatted.
    Missed,
    /// 2: the plan or the command line is wrong.
    Wrong,
    /// 3: the rig or a file failed.
    Fault,
    /// 4: stopped by a limit or by the operator.
    Stopped,
    /// 5: results differ from the accepted ones.
    Differs,
    /// 75: a study was stopped before all of its runs were done; the same command continues it (`EX_TEMPFAIL` of sysexits.h).
    Unfinished,
}

impl Exit {
    /// Every exit.
    pub fn all() -> impl Iterator<Item = Self> {
        [
            Self::Met,
            Self::Missed,
            Self::Wrong,
            Self::Fault,
            Self::Stopped,
            Self::Differs,
            Self::Unfinished,
        ]
        .into_iter()
    }

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
            Self::Unfinished => 75,
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

impl From<&Assessment> for Exit {
    fn from(assessment: &Assessment) -> Self {
        let mut reproductions = assessment.reproductions.iter();
        let compared = if reproductions.all(ReproductionOutcome::reproduces) {
            Self::Met
        } else {
            Self::Missed
        };
        Self::from(assessment.verdict).max(compared)
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}

/// Part of the message of a device that does not answer.
const SILENT: &str = "no usable answer";
/// Possible causes of a silent device.
const LOOK_FOR: &str = "the baud rate, the `dialect`, crossed wires, or a device that is still starting; check the plan\n       with `psd rig simulate`, which emulates the rig";

impl Failure {
    pub const fn exit(&self) -> Exit {
        match self {
            Self::CommandLine { .. } | Self::NotAPlan { .. } | Self::NoCheckRun(_) => Exit::Wrong,
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
            | Self::DiskSpace(_)
            | Self::Refused(_)
            | Self::Signals(_)
            | Self::NotVerifiable { .. } => Exit::Fault,
        }
    }

    /// The message for the operator.
    pub fn report(&self, settings: Settings) -> String {
        let (head, help) = match self {
            Self::CommandLine { help, .. } | Self::File { help, .. } => {
                ("error:".to_owned(), help.clone())
            }
            Self::DiskSpace(fault) => (
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
        if let Self::NotOpened { location, .. } = self {
            let _ = writeln!(
                text,
                "{} {}",
                settings.paint_note("  at:"),
                escape(location)
            );
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
    fn verdicts_end_as_the_reference_specifies() {
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
