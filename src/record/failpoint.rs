//! Failpoints: every guard can be switched off by a test of its own, and only by a test, so that each is shown to be
//! the one that catches its fault. In the program a guard is always on: [`on`] is then the constant true.

/// A guard of a real rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guarding {
    TargetLimits,
    ReadingLimits,
    EnergyError,
    /// The energy error that tracking errors cause, and their size.
    Tracking,
    WireNumber,
    Following,
    /// An axis that deviates from its commanded path.
    PathDeviation,
    Settling,
    Invalid,
    /// Status flags of a device: emergency stop, watchdog, no reference.
    Flags,
    Saturation,
    Frozen,
    Median,
    /// A force that nothing leads to from the dwell before it.
    ForceJump,
    Reboot,
    /// Power-up of a rig that cannot report whether it was switched off.
    PowerUp,
    Sequence,
    Checksum,
    Resend,
    Away,
    /// A reading that cannot be, of a rig that has not moved.
    AtRest,
    /// The position of a rig when a run begins.
    PretestStart,
    PretestZero,
    PretestPolarity,
    PretestStiffness,
    /// How far a zero may drift before nothing is decided by the forces.
    ZeroDrift,
    IntentDurable,
    SampleDurable,
    FailedSync,
    Lock,
    /// A panic in any thread holds the rig.
    PanicHook,
    /// So does a program that hangs.
    HostWatchdog,
    /// The least free space of the disk before a run.
    DiskSpace,
}

/// Whether the guard is on.
#[cfg(not(test))]
#[must_use]
pub const fn on(_: Guarding) -> bool {
    true
}

#[cfg(test)]
pub use switch::{on, without};

#[cfg(test)]
mod switch {
    use std::cell::Cell;

    use super::Guarding;

    thread_local! {
        static OFF: Cell<Option<Guarding>> = const { Cell::new(None) };
    }

    /// Whether the guard is on in this thread.
    #[must_use]
    pub fn on(guard: Guarding) -> bool {
        OFF.get() != Some(guard)
    }

    /// Runs `what` with one guard off in this thread.
    pub fn without<T>(guard: Guarding, what: impl FnOnce() -> T) -> T {
        struct Restore(Option<Guarding>);
        impl Drop for Restore {
            fn drop(&mut self) {
                OFF.set(self.0);
            }
        }
        let _restore = Restore(OFF.replace(Some(guard)));
        what()
    }
}
