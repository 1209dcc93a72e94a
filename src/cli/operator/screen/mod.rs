//! The live screen of a run. In: reports of the run, and keys. Out: frames, stop requests and answers. The run only stores its reports; a
//! separate thread draws them, at most twenty times per second.

pub mod curve;
mod draw;
pub mod model;
mod terminal;

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::dialogue::Dialogue;
use super::dialogue::keys::Key;
use crate::commands::explain_plan::dry_rig::Reach;
use draw::View;
use model::{Ended, Model};
use psd::run::{Next, Observer, StepReport};
use psd_plan::Plan;
use psd_plan::record::Event;
use psd_rig::{Live, StopRequest};
use terminal::{Page, TerminalLost};

pub use terminal::is_large_enough;

/// Minimum time between two frames.
const FRAME: Duration = Duration::from_millis(50);

/// A simulated run shorter than this shows no screen.
const PATIENCE: Duration = Duration::from_millis(500);

/// Time that the end of a run waits until the terminal is restored.
const FAREWELL: Duration = Duration::from_secs(1);

/// The part of the screen that the run uses.
pub struct Screen {
    shared: Arc<Shared>,
    finished: bool,
}

struct Shared {
    state: Mutex<State>,
    /// New data are to be shown, or an answer is available.
    changed: Condvar,
}

struct State {
    model: Model,
    dialogue: Dialogue,
    /// The live readings of the rig, also during a move.
    live: Option<Live>,
    /// The screen is requested, however short the run.
    wanted: bool,
    /// The run has ended.
    over: bool,
    /// The terminal has been restored, or the screen never used it.
    closed: bool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Screen {
    /// A screen for a run of `plan`. If it is `wanted`, it appears immediately, otherwise only if the run takes long enough.
    pub fn new(
        plan: &Plan,
        simulated: bool,
        wanted: bool,
        operator: Option<String>,
        stop_request: StopRequest,
        color: bool,
    ) -> Self {
        Self::start(
            Model::new(plan, simulated),
            Dialogue::new(operator),
            wanted,
            stop_request,
            color,
        )
    }

    /// A screen for observation only, with this title.
    pub fn monitor(
        plan: &Plan,
        simulated: bool,
        word: &'static str,
        stop_request: StopRequest,
        color: bool,
    ) -> Self {
        let model = Model {
            by_hand: Some(word),
            ..Model::new(plan, simulated)
        };
        Self::start(model, Dialogue::of_monitor(), true, stop_request, color)
    }

    fn start(
        model: Model,
        dialogue: Dialogue,
        wanted: bool,
        stop_request: StopRequest,
        color: bool,
    ) -> Self {
        let state = State {
            model,
            dialogue,
            live: None,
            wanted,
            over: false,
            closed: false,
        };
        let shared = Arc::new(Shared {
            state: Mutex::new(state),
            changed: Condvar::new(),
        });
        let theirs = Arc::clone(&shared);
        std::thread::spawn(move || show(&theirs, &stop_request, color));
        Self {
            shared,
            finished: false,
        }
    }

    /// Shows the readings of this rig.
    pub fn watch(&self, live: Live) {
        self.shared.lock().live = Some(live);
    }

    /// Shows the predicted curves of these procedures.
    pub fn predict(&self, procedures: Vec<Reach>) {
        self.shared.lock().model.predicted = procedures.into();
    }

    /// Sets the time left.
    pub fn set_left(&self, left: Option<Duration>) {
        self.shared.lock().model.left = left;
    }

    /// Whether the operator has stopped the run at its keys.
    pub fn is_attended(&self) -> bool {
        self.shared.lock().dialogue.attended
    }

    /// The result of the dialogue. While there is none, it waits a moment for an answer, or until the next poll of the rig.
    pub fn wait_for<T: PartialEq>(&self, none_yet: &T, ask: impl Fn(&mut Dialogue) -> T) -> T {
        let mut state = self.shared.lock();
        state.wanted = true;
        self.shared.changed.notify_all();
        let answer = ask(&mut state.dialogue);
        if answer == *none_yet {
            drop(self.shared.changed.wait_timeout(state, FRAME));
        }
        answer
    }

    /// Restores the terminal.
    pub fn finish(&mut self) {
        if std::mem::replace(&mut self.finished, true) {
            return;
        }
        let mut state = self.shared.lock();
        state.over = true;
        self.shared.changed.notify_all();
        // A closed terminal may block its thread forever; it must not block the results of the run.
        let closed = self
            .shared
            .changed
            .wait_timeout_while(state, FAREWELL, |state| !state.closed);
        drop(closed);
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Observer for Screen {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        self.shared
            .lock()
            .model
            .procedure_started(name, keyword, steps);
    }

    fn step_done(&mut self, report: &StepReport) {
        self.shared.lock().model.step_done(report);
    }

    fn studying(&mut self, done: usize, of: usize) {
        self.shared.lock().model.study = Some((done, of));
    }

    fn next(&mut self) -> Next {
        let mut state = self.shared.lock();
        let next = state.dialogue.next();
        if next == Next::Wait {
            drop(self.shared.changed.wait_timeout(state, FRAME));
        }
        next
    }

    fn event(&mut self, event: &Event) {
        self.shared.lock().model.event(event);
    }
}

/// The thread of the screen.
fn show(shared: &Shared, stop_request: &StopRequest, color: bool) {
    let began = Instant::now();
    let mut left = Left {
        shared,
        stop_request,
        gone: true,
    };
    left.gone = is_wanted(shared) && page(shared, stop_request, color, began).is_err();
}

/// Reports that the thread has released the terminal, on every exit path.
struct Left<'a> {
    shared: &'a Shared,
    stop_request: &'a StopRequest,
    /// The terminal is closed, or the drawing failed: no answer will come.
    gone: bool,
}

impl Drop for Left<'_> {
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        if self.gone {
            state.dialogue.lose(self.stop_request);
        }
        state.closed = true;
        self.shared.changed.notify_all();
    }
}

/// Waits until the run has lasted long enough, or requests the screen; false if the run ends earlier.
fn is_wanted(shared: &Shared) -> bool {
    let state = shared.lock();
    let waited = shared
        .changed
        .wait_timeout_while(state, PATIENCE, |state| !state.wanted && !state.over);
    let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
    !state.over
}

/// Draws and reads keys until the run has ended.
fn page(
    shared: &Shared,
    stop_request: &StopRequest,
    color: bool,
    began: Instant,
) -> Result<(), TerminalLost> {
    let mut page = Page::open()?;
    let mut alarmed = false;
    loop {
        let drawn = Instant::now();
        let (model, dialogue) = {
            let state = shared.lock();
            if state.over {
                return Ok(());
            }
            let live = state.live.as_ref().and_then(Live::newest);
            (
                Model {
                    live,
                    ..state.model.clone()
                },
                state.dialogue.clone(),
            )
        };
        page.draw(&View {
            model: &model,
            dialogue: &dialogue,
            stop_request,
            now: began.elapsed(),
            color,
        })?;
        if model.ended == Some(Ended::NotHeld) && !std::mem::replace(&mut alarmed, true) {
            Page::ring();
        }
        if dialogue.is_new() {
            // Input typed before the screen was visible is not an answer.
            loop {
                let pressed = page.keys(Duration::ZERO)?;
                if pressed.is_empty() {
                    break;
                }
                press(shared, pressed, began, stop_request);
            }
            shared
                .lock()
                .dialogue
                .drawn(dialogue.appeared, began.elapsed());
        }
        // Keys are processed immediately; the next frame is drawn at its time.
        while let Some(left) = FRAME
            .checked_sub(drawn.elapsed())
            .filter(|left| !left.is_zero())
        {
            let pressed = page.keys(left)?;
            if !pressed.is_empty() {
                press(shared, pressed, began, stop_request);
            }
        }
    }
}

fn press(shared: &Shared, keys: Vec<Key>, began: Instant, stop_request: &StopRequest) {
    let mut state = shared.lock();
    for key in keys {
        state.dialogue.press(key, began.elapsed(), stop_request);
    }
    shared.changed.notify_all();
}
