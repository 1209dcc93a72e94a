//! Signals → the stop request. In: SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGPWR. Out: one Ctrl-C stops the run at the end of its step, a second one
//! puts the rig on hold now. Each other signal puts it on hold now, and so does Ctrl-C in a manual move, which has no steps. Without a
//! screen, a line reports it immediately. Signals that other programs use for counting or waking are caught and have no effect. The same
//! applies to the signals of timers, of limits and of files that are too large. Their senders do not intend to leave a rig uncontrolled.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use rustix::process::Signal;
use signal_hook::consts::{
    SIGALRM, SIGHUP, SIGINT, SIGIO, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGUSR1, SIGUSR2, SIGVTALRM,
    SIGXCPU, SIGXFSZ,
};
use signal_hook::iterator;

use crate::output::print_message;
use psd_rig::StopRequest;

/// Signals that end the motion. The last one is the power failure that an uninterruptible power supply reports.
const WISHES: [i32; 5] = [SIGINT, SIGQUIT, SIGTERM, SIGHUP, Signal::POWER.as_raw()];

/// Signals without an effect.
const IGNORED: [i32; 9] = [
    SIGUSR1,
    SIGUSR2,
    SIGALRM,
    SIGVTALRM,
    SIGPROF,
    SIGXCPU,
    SIGIO,
    SIGSYS,
    Signal::STKFLT.as_raw(),
];

/// Signals are caught as long as this exists. Afterwards they have no effect, because the results are still being written. There is one
/// for the whole run: a signal between two of them would be lost.
pub struct Signals {
    handle: iterator::Handle,
    stop_request: StopRequest,
    output: Arc<AtomicU8>,
}

impl Signals {
    /// A Ctrl-C comes from an operator who waits for the end of the step. The sender of another signal does not wait.
    pub fn caught(stop_request: &StopRequest) -> std::io::Result<Self> {
        Self::become_wishes(stop_request, |stop_request, signal| {
            if signal == SIGINT {
                interrupt(stop_request);
            } else {
                stop_request.hold_now();
            }
        })
    }

    /// The first signal already puts the rig on hold.
    pub fn holding(stop_request: &StopRequest) -> std::io::Result<Self> {
        Self::become_wishes(stop_request, |stop_request, _| stop_request.hold_now())
    }

    /// Nothing moves, and an observed rig receives no command: the first signal ends the observation.
    pub fn ending(stop_request: &StopRequest) -> std::io::Result<Self> {
        Self::become_wishes(stop_request, |stop_request, _| interrupt(stop_request))
    }

    fn become_wishes(
        stop_request: &StopRequest,
        forward: fn(&StopRequest, i32),
    ) -> std::io::Result<Self> {
        let mut signals = iterator::Signals::new(WISHES.iter().chain(&IGNORED))?;
        let handle = signals.handle();
        let (stop_request, theirs) = (stop_request.clone(), stop_request.clone());
        let output = Arc::new(AtomicU8::new(SILENT));
        let their_output = Arc::clone(&output);
        std::thread::spawn(move || {
            for signal in signals.forever() {
                match signal {
                    ignored if IGNORED.contains(&ignored) => continue,
                    // These two come from the keyboard.
                    SIGINT | SIGQUIT => {}
                    _ => theirs.suppress_prompts(),
                }
                forward(&theirs, signal);
                match their_output.load(Ordering::SeqCst) {
                    SILENT => {}
                    ON_A_TERMINAL => print_message(&format!("{CLEARED}  {}\n", effect(&theirs))),
                    _ => print_message(&format!("  {}\n", effect(&theirs))),
                }
            }
        });
        Ok(Self {
            handle,
            stop_request,
            output,
        })
    }

    /// From here on a line reports each signal: there is no screen that would show it.
    pub fn print_signals(&self, terminal: bool) {
        self.output.store(
            if terminal { ON_A_TERMINAL } else { IN_A_PIPE },
            Ordering::SeqCst,
        );
    }

    /// The stop request that they set.
    pub const fn stop_request(&self) -> &StopRequest {
        &self.stop_request
    }
}

/// Whether a line reports signals, and on which kind of output.
const SILENT: u8 = 0;
const IN_A_PIPE: u8 = 1;
const ON_A_TERMINAL: u8 = 2;

/// Removes the text of the present line: a bar, or the `^C` of the terminal.
const CLEARED: &str = "\r\u{1b}[K";

/// The effect of a signal, as a message to its sender.
fn effect(stop_request: &StopRequest) -> &'static str {
    if stop_request.hold_requested() {
        "holding now"
    } else {
        "stopping at the end of this step; Ctrl-C once more: hold now"
    }
}

/// From here on a file at its size limit gives a write error. The error puts the rig on hold and does not end the program.
pub fn catch_full_files() -> std::io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}

/// One Ctrl-C: the first stops the run at the end of its step, the second puts the rig on hold now.
pub fn interrupt(stop_request: &StopRequest) {
    if stop_request.end_requested() {
        stop_request.hold_now();
    } else {
        stop_request.stop_after_step();
    }
}

impl Drop for Signals {
    fn drop(&mut self) {
        self.handle.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_interrupt_stops_and_the_second_holds() {
        let stop_request = StopRequest::default();
        interrupt(&stop_request);
        assert!(stop_request.end_requested() && !stop_request.hold_requested());
        assert_eq!(
            effect(&stop_request),
            "stopping at the end of this step; Ctrl-C once more: hold now"
        );
        interrupt(&stop_request);
        assert_eq!(effect(&stop_request), "holding now");
        assert!(stop_request.hold_requested());
    }
}
