//! Signals → the wish. In: SIGINT, SIGQUIT, SIGTERM, SIGHUP. Out: one Ctrl-C stops the run at the end of its step, a second one holds the
//! rig now; each of the others holds it now, and so does Ctrl-C by hand, where there are no steps. Where there is no screen that shows it,
//! a line says so at once. Signals that other programs use to count or to wake, and that of a file that is too large, are caught and do
//! nothing: nobody sends them to have a rig left alone.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use signal_hook::consts::{SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXFSZ};
use signal_hook::iterator;

use crate::cli::output::print_message;
use crate::rig::StopRequest;

/// Signals are caught as long as this lives. Afterwards they do nothing: what a run leaves is still being written. One for all
/// of a run: what came while one was given up for another would be lost.
pub struct Signals {
    handle: iterator::Handle,
    stop_request: StopRequest,
    told: Arc<AtomicU8>,
}

impl Signals {
    /// Ctrl-C is a person's who waits for the end of the step; whoever sends another signal waits for nothing.
    pub fn caught(stop_request: &StopRequest) -> std::io::Result<Self> {
        Self::become_wishes(stop_request, |stop_request, signal| {
            if signal == SIGINT {
                interrupt(stop_request);
            } else {
                stop_request.hold_now();
            }
        })
    }

    /// The first signal holds the rig already.
    pub fn holding(stop_request: &StopRequest) -> std::io::Result<Self> {
        Self::become_wishes(stop_request, |stop_request, _| stop_request.hold_now())
    }

    /// Nothing moves, and a rig that is only looked at is told nothing: the first signal ends the looking.
    pub fn ending(stop_request: &StopRequest) -> std::io::Result<Self> {
        Self::become_wishes(stop_request, |stop_request, _| interrupt(stop_request))
    }

    fn become_wishes(
        stop_request: &StopRequest,
        become_wish: fn(&StopRequest, i32),
    ) -> std::io::Result<Self> {
        let mut signals =
            iterator::Signals::new([SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGALRM])?;
        let handle = signals.handle();
        let (stop_request, theirs) = (stop_request.clone(), stop_request.clone());
        let told = Arc::new(AtomicU8::new(SILENT));
        let tells = Arc::clone(&told);
        std::thread::spawn(move || {
            for signal in signals.forever() {
                match signal {
                    SIGUSR1 | SIGUSR2 | SIGALRM => continue,
                    // These two come from the keys.
                    SIGINT | SIGQUIT => {}
                    _ => theirs.suppress_prompts(),
                }
                become_wish(&theirs, signal);
                match tells.load(Ordering::SeqCst) {
                    SILENT => {}
                    ON_A_TERMINAL => print_message(&format!("{CLEARED}  {}\n", said(&theirs))),
                    _ => print_message(&format!("  {}\n", said(&theirs))),
                }
            }
        });
        Ok(Self {
            handle,
            stop_request,
            told,
        })
    }

    /// From here on each is answered by a line: there is no screen that would show it.
    pub fn told_in_lines(&self, terminal: bool) {
        self.told.store(
            if terminal { ON_A_TERMINAL } else { IN_A_PIPE },
            Ordering::SeqCst,
        );
    }

    /// What they become.
    pub const fn stop_request(&self) -> &StopRequest {
        &self.stop_request
    }
}

/// Whether and where signals are answered by a line.
const SILENT: u8 = 0;
const IN_A_PIPE: u8 = 1;
const ON_A_TERMINAL: u8 = 2;

/// Takes what stands in the line off it: a bar, or the terminal's own `^C`.
const CLEARED: &str = "\r\u{1b}[K";

/// What a signal comes to, for who sent it.
fn said(stop_request: &StopRequest) -> &'static str {
    if stop_request.hold_requested() {
        "holding now"
    } else {
        "stopping at the end of this step; Ctrl-C once more: hold now"
    }
}

/// From here on a file that may not grow any further is a write that fails, and holds the rig, not the program's end.
pub fn catch_full_files() -> std::io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}

/// One Ctrl-C: the first stops the run at the end of its step, the second holds the rig now.
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
            said(&stop_request),
            "stopping at the end of this step; Ctrl-C once more: hold now"
        );
        interrupt(&stop_request);
        assert_eq!(said(&stop_request), "holding now");
        assert!(stop_request.hold_requested());
    }
}
