//! The time left of a run. In: the share of each procedure in the run, and steps as they are done. Out: an estimate in real time. It takes
//! the pace of the steps so far; prompts, pauses and the time between two procedures do not count.

use std::time::{Duration, Instant};

/// No estimate before this time.
const EARLIEST: Duration = Duration::from_secs(3);

/// The part of a run that one procedure is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Its share, in any unit that all parts have: seconds, or steps.
    pub share: f64,
    /// Number of its steps.
    pub steps: u64,
}

/// The pace of a run.
#[derive(Debug, Default)]
pub struct Pace {
    /// Empty: unknown.
    parts: Vec<Part>,
    /// Number of procedures that have begun.
    begun: usize,
    /// Part of the run that is done, in the unit of the shares.
    done: f64,
    /// Part of it that was done before the elapsed time: by the run that is resumed.
    earlier: f64,
    /// Time of the steps so far.
    elapsed: Duration,
    last: Option<Instant>,
}

impl Pace {
    pub fn of(parts: Vec<Part>) -> Self {
        Self {
            parts,
            ..Self::default()
        }
    }

    pub fn procedure_started(&mut self) {
        self.begun += 1;
        self.done = self
            .parts
            .iter()
            .take(self.begun - 1)
            .map(|part| part.share)
            .sum();
        self.last = None;
    }

    /// The run is resumed: its steps so far took another time.
    pub const fn resumed(&mut self) {
        self.earlier = self.done;
        self.elapsed = Duration::ZERO;
        self.last = None;
    }

    /// A prompt or a pause: the time since the last step does not count.
    pub const fn interrupted(&mut self) {
        self.last = None;
    }

    pub fn step_done(&mut self, step: u64, now: Instant) {
        if let Some(last) = self.last.replace(now) {
            self.elapsed += now.duration_since(last);
        }
        let before = self.begun.saturating_sub(1);
        if let Some(part) = self.parts.get(before) {
            let earlier: f64 = self.parts[..before].iter().map(|part| part.share).sum();
            #[expect(clippy::cast_precision_loss, reason = "a share of steps")]
            let share = (step as f64 / part.steps.max(1) as f64).min(1.0);
            self.done = earlier + share * part.share;
        }
    }

    /// The time left; None: not known, or not yet.
    pub fn left(&self) -> Option<Duration> {
        let total: f64 = self.parts.iter().map(|part| part.share).sum();
        let done = self.done - self.earlier;
        if self.elapsed < EARLIEST || done <= 0.0 {
            return None;
        }
        let left = self.elapsed.as_secs_f64() * ((total - self.done) / done).max(0.0);
        Duration::try_from_secs_f64(left).ok()
    }
}

/// `1:05`, `1:02:09`.
pub fn clock(seconds: u64) -> String {
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pace_of_the_steps_gives_the_time_left() {
        let part = |share, steps| Part { share, steps };
        let mut pace = Pace::of(vec![part(10.0, 10), part(0.0, 0), part(30.0, 100)]);
        let start = Instant::now();
        let after = |seconds| start + Duration::from_secs(seconds);
        pace.procedure_started();
        pace.step_done(1, after(0));
        assert_eq!(pace.left(), None, "too early");
        // Step 5 of 10 after 4 s: 5 of 40 units are done.
        pace.step_done(5, after(4));
        assert_eq!(pace.left(), Some(Duration::from_secs(28)));
        // An inspection of a minute does not count.
        pace.procedure_started();
        pace.procedure_started();
        pace.step_done(1, after(100));
        pace.step_done(100, after(116));
        assert_eq!(pace.left(), Some(Duration::ZERO));
        pace.interrupted();
        pace.step_done(100, after(500));
        assert_eq!(pace.elapsed, Duration::from_secs(20));
        // Half of the run was done before it is resumed.
        let mut resumed = Pace::of(vec![part(40.0, 100)]);
        resumed.procedure_started();
        resumed.step_done(50, after(0));
        resumed.resumed();
        resumed.step_done(51, after(1000));
        assert_eq!(resumed.left(), None);
        resumed.step_done(60, after(1005));
        assert_eq!(resumed.left(), Some(Duration::from_secs(20)));
        let mut unknown = Pace::default();
        unknown.procedure_started();
        unknown.step_done(1, after(0));
        unknown.step_done(2, after(9));
        assert_eq!(unknown.left(), None);
        assert_eq!(
            (clock(65), clock(3729)),
            ("1:05".to_owned(), "1:02:09".to_owned())
        );
    }
}
