//! What can befall a test, as data, and the names under which it is counted.

use psd_rig::emulator::MechanicalFault;
use psd_rig::emulator::script::{LineFault, ReplyFault};

/// The part of a rig that a fault befalls: the controller or the load cell of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) axis: usize,
    pub(super) on_load_cell: bool,
}

/// A fault within a session. Calls of the disk and commands to the rig are counted from the start of the session, replies and moves from
/// the power-up of the rig.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Fault {
    Reply {
        after: u64,
        on: Part,
        count: u64,
        what: ReplyFault,
    },
    Controller {
        after: u64,
        axis: usize,
        what: LineFault,
    },
    Mechanical {
        /// Number of moves.
        after: u64,
        axis: usize,
        what: MechanicalFault,
    },
    Command {
        at: u32,
        what: CommandFault,
    },
    Disk {
        at: u32,
        what: DiskFault,
    },
    Killed(Kill),
    HoldNow {
        at: u32,
    },
    StopAfterStep {
        at: u32,
    },
}

/// A fault of a command on its way to the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommandFault {
    Lost,
    Twice,
    /// Only the first half arrives.
    Torn,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DiskFault {
    /// The disk is full from then on; the reserve has space for the final entries.
    Full {
        reserve: bool,
    },
    /// One write fails half-way.
    TornWrite,
    FailedFlush,
    /// This many flushes report success and do nothing.
    LostFlushes(u32),
}

/// psd ends without a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kill {
    /// At a call of the disk, else at a command to the rig.
    pub(super) at_the_disk: bool,
    pub(super) at: u32,
    /// The call is executed first.
    pub(super) after: bool,
    /// The power fails: at most this many unflushed bytes remain, and of those the sectors in this bit pattern.
    pub(super) power: Option<(usize, u64)>,
}

/// What happens to the rig between two sessions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// \[s\]
    Waits(f64),
    /// Another rig is at the same place, perhaps with a specimen that carries the same load.
    OtherRig { loaded: bool },
    /// Its controller was switched off and on.
    Restarted,
    /// An axis was moved by hand, by this \[m\].
    OtherPlace { axis: usize, by: f64 },
    /// The specimen carries nothing any more at an axis.
    ForceGone { axis: usize },
}

impl Fault {
    pub(super) const fn name(&self) -> &'static str {
        match self {
            Self::Reply { what, .. } => match what {
                ReplyFault::Drop => "reply lost",
                ReplyFault::Delay(_) => "reply late",
                ReplyFault::Repeat => "reply twice",
                ReplyFault::CutAt(_) => "reply torn",
                ReplyFault::Replay => "replies swapped",
                ReplyFault::FlipBit(_) => "bit flipped",
                ReplyFault::SplitAt(_) | ReplyFault::SplitEvery(_) => "reply in pieces",
                ReplyFault::Garbage { .. } => "garbage",
                ReplyFault::HangUpBefore | ReplyFault::HangUpAfter => "hang-up",
            },
            Self::Controller { what, .. } => match what {
                LineFault::HangUp => "hang-up",
                LineFault::Reboot => "controller restarts",
                LineFault::StopReading => "controller stops reading",
                LineFault::FreezeFirmware(_) => "controller freezes",
            },
            Self::Mechanical { what, .. } => match what {
                MechanicalFault::Reach(_) => "actuator sticks",
                MechanicalFault::Lag(_) => "actuator lags",
                MechanicalFault::FreezeForce => "force frozen",
                MechanicalFault::Spike(_) => "force spike",
                MechanicalFault::ScaleForce(_) => "force scaled",
                _ => "specimen breaks",
            },
            Self::Command { what, .. } => match what {
                CommandFault::Lost => "command lost",
                CommandFault::Twice => "command twice",
                CommandFault::Torn => "command torn",
            },
            Self::Disk { what, .. } => match what {
                DiskFault::Full { .. } => "disk full",
                DiskFault::TornWrite => "torn write",
                DiskFault::FailedFlush => "failed flush",
                DiskFault::LostFlushes(_) => "lost flush",
            },
            Self::Killed(Kill { power: Some(_), .. }) => "power lost",
            Self::Killed(Kill {
                at_the_disk: true, ..
            }) => "killed at the disk",
            Self::Killed(_) => "killed at a command",
            Self::HoldNow { .. } => "signal to hold",
            Self::StopAfterStep { .. } => "signal to stop",
        }
    }

    /// Every name above.
    pub(super) const NAMES: [&'static str; 30] = [
        "reply lost",
        "reply late",
        "reply twice",
        "reply torn",
        "replies swapped",
        "bit flipped",
        "reply in pieces",
        "garbage",
        "hang-up",
        "controller restarts",
        "controller stops reading",
        "controller freezes",
        "actuator sticks",
        "actuator lags",
        "force frozen",
        "force spike",
        "force scaled",
        "specimen breaks",
        "command lost",
        "command twice",
        "command torn",
        "disk full",
        "torn write",
        "failed flush",
        "lost flush",
        "power lost",
        "killed at the disk",
        "killed at a command",
        "signal to hold",
        "signal to stop",
    ];
}

impl Change {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Waits(_) => "time passes",
            Self::OtherRig { .. } => "another rig",
            Self::Restarted => "rig restarted",
            Self::OtherPlace { .. } => "another place",
            Self::ForceGone { .. } => "force gone",
        }
    }

    /// Every name above.
    pub(super) const NAMES: [&'static str; 5] = [
        "time passes",
        "another rig",
        "rig restarted",
        "another place",
        "force gone",
    ];
}
