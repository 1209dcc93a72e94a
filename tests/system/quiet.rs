//! A quiet machine for tests in real time: a rig that does not stop waits a quarter of a second for its next path. In: nothing. Out: a
//! guard. While a test has [`alone`], no other thread has a stage; the other tests go first.

use std::cell::Cell;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Number of stages of other tests, and whether a test is alone.
struct Stages {
    open: usize,
    alone: bool,
}

static STAGES: Mutex<Stages> = Mutex::new(Stages {
    open: 0,
    alone: false,
});
static CHANGED: Condvar = Condvar::new();

thread_local! {
    static IS_ALONE: Cell<bool> = const { Cell::new(false) };
}

/// The stages, once `free` holds. A failed test must not stop the others.
fn once(free: impl Fn(&Stages) -> bool) -> MutexGuard<'static, Stages> {
    let stages = STAGES.lock().unwrap_or_else(PoisonError::into_inner);
    CHANGED
        .wait_while(stages, |stages| !free(stages))
        .unwrap_or_else(PoisonError::into_inner)
}

/// No other thread has a stage while it exists. The stages of this thread must not outlive it.
pub struct Alone(());

/// Waits until no test has a stage.
pub fn alone() -> Alone {
    once(|stages| stages.open == 0 && !stages.alone).alone = true;
    IS_ALONE.set(true);
    Alone(())
}

impl Drop for Alone {
    fn drop(&mut self) {
        IS_ALONE.set(false);
        once(|_| true).alone = false;
        CHANGED.notify_all();
    }
}

/// One open stage beside those of other tests.
pub struct Beside {
    counted: bool,
}

/// Waits while a test of another thread is alone.
pub fn beside() -> Beside {
    let counted = !IS_ALONE.get();
    if counted {
        once(|stages| !stages.alone).open += 1;
    }
    Beside { counted }
}

impl Drop for Beside {
    fn drop(&mut self) {
        if self.counted {
            once(|_| true).open -= 1;
            CHANGED.notify_all();
        }
    }
}
