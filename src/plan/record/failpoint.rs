//! Failpoints: only a test switches off a guard, and each guard has such a test. The test shows that this guard alone detects its
//! fault. In the program a guard is always on: nothing but tests calls [`without`].

use std::cell::Cell;

/// A guard of a real rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guarding {
    TargetLimits,
    ReadingLimits,
    EnergyError,
    /// The energy error that tracking errors cause, and the size of the tracking errors.
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
    /// A force that does not follow from the dwell before it.
    ForceJump,
    Reboot,
    /// The speed of a rig that was amended: that of its own resumption, not that of the start.
    NewestRig,
    /// The force of a rig that is found when a run is resumed.
    ForceFound,
    /// The word order of a drive that no reading has confirmed.
    WordOrder,
    /// Power cycle of a rig that cannot report whether it was switched off.
    PowerUp,
    Sequence,
    Checksum,
    Resend,
    Away,
    /// An impossible reading of a rig that has not moved.
    AtRest,
    /// The position of a rig when a run begins.
    PretestStart,
    PretestZero,
    PretestPolarity,
    PretestStiffness,
    /// The zero drift beyond which no statement of conformity depends on the forces.
    ZeroDrift,
    IntentDurable,
    SampleDurable,
    FailedSync,
    /// A run log that another program moved, replaced, lengthened or shortened.
    SameFile,
    Lock,
    /// A panic in any thread holds the rig.
    PanicHook,
    /// A program that stops responding holds the rig.
    HostWatchdog,
    /// The least free space of the disk before a run.
    DiskSpace,
}

thread_local! {
    static OFF: Cell<Option<Guarding>> = const { Cell::new(None) };
}

/// Whether the guard is on in this thread: in the program always.
#[must_use]
#[inline]
pub fn on(guard: Guarding) -> bool {
    OFF.get() != Some(guard)
}

/// For tests only (`tests/suite/house.rs` holds it): runs `what` with one guard off in this thread.
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
