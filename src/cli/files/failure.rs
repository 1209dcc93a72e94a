//! Failures of a command that are not errors of its plan: files, disks, rigs, devices.

use std::path::PathBuf;

use psd::codes::E629;
use psd_text::diagnostic::Code;
use psd_text::source::Position;

/// The state of a simulation of another build of psd, if this build does not repeat it.
pub const NOT_VERIFIABLE: &str = "NOT VERIFIABLE BY THIS BUILD";

/// Why a command failed. Errors in a plan are diagnostics, not these.
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
    /// The simulation of another build, which this build does not repeat.
    #[error("{}: {NOT_VERIFIABLE}: {reason}", path.display())]
    NotVerifiable { path: PathBuf, reason: String },
    #[error("{}: not a plan: {reason}", path.display())]
    NotAPlan {
        path: PathBuf,
        reason: String,
        at: Option<Position>,
    },
    #[error("the results could not be created: {0}")]
    Output(#[from] psd::report::OutputError),
    #[error("standard output: {0}")]
    Stdout(std::io::Error),
    #[error(transparent)]
    Record(#[from] psd_rig::journal::FileFault),
    #[error(transparent)]
    Journal(#[from] psd_rig::journal::JournalFault),
    #[error("{0}")]
    Rig(#[from] psd_rig::RigFault),
    #[error(transparent)]
    DiskSpace(#[from] DiskSpaceFault),
    #[error("{fault}")]
    NotOpened {
        fault: psd_rig::RigFault,
        location: String,
    },
    #[error("no check run: {0}")]
    NoCheckRun(#[from] psd::run::check_run::NoCheckRun),
    #[error("the run cannot continue: {0}")]
    Refused(#[from] psd::run::replay::ResumeRefusal),
    #[error("not resumed, and nothing moved: {reason}")]
    NotReleased { reason: String },
    #[error("signals cannot be caught, so a run could not be stopped: {0}")]
    Signals(std::io::Error),
}

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

    /// The position in a file where its text could not be read.
    pub const fn position(&self) -> Option<Position> {
        match self {
            Self::NotAPlan { at, .. } => *at,
            _ => None,
        }
    }

    /// The same failure with a suggested correction.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        if let Self::CommandLine { help, .. } | Self::File { help, .. } = &mut self {
            *help = Some(text.into());
        }
        self
    }

    /// The error of a rig that cannot be opened, with the position of its declaration in the plan.
    #[must_use]
    pub fn in_the_plan(self, location: impl FnOnce(&str) -> Option<String>) -> Self {
        match self {
            Self::Rig(fault) => match location(&fault.to_string()) {
                Some(location) => Self::NotOpened { fault, location },
                None => Self::Rig(fault),
            },
            other => other,
        }
    }
}

/// Free space that a run needs before it begins \[bytes\]. If the disk becomes full later, the rig goes on hold, and the run can be
/// resumed.
pub const LEAST_FREE_BYTES: u64 = 200_000_000;

/// The disk has less free space than a run needs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: its disk has {} of free space (a run requires at least {}); nothing has moved", folder.display(), amount(*free), amount(LEAST_FREE_BYTES))]
pub struct DiskSpaceFault {
    pub folder: PathBuf,
    /// Free space \[bytes\].
    pub free: u64,
}

impl DiskSpaceFault {
    pub const CODE: Code = E629;

    /// The action that corrects it.
    pub fn help(&self) -> String {
        let missing = amount(LEAST_FREE_BYTES - self.free);
        format!("free {missing}, or name a folder on another disk with `--out`")
    }
}

/// Bytes in a readable unit: `12.4 MB`.
pub fn amount(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    #[expect(clippy::cast_precision_loss, reason = "three digits are shown")]
    let (mut size, mut unit) = (bytes as f64 / 1e3, UNITS[0]);
    for larger in &UNITS[1..] {
        if size >= 999.5 {
            (size, unit) = (size / 1e3, larger);
        }
    }
    if size < 9.95 {
        format!("{size:.1} {unit}")
    } else {
        format!("{size:.0} {unit}")
    }
}

/// The system's text for an error, without its number.
pub fn plain(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        std::io::ErrorKind::NotADirectory => "is a file, not a folder".to_owned(),
        _ => {
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_owned()
        }
    }
}
