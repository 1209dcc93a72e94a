//! The machine's clocks. In: nothing. Out: monotonic seconds, and the wall clock for the run log. A jump of the wall clock
//! changes no duration.

use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

use super::Clock;

/// Seconds since its creation, by the clock that continues while the machine is suspended: a rig does not wait for the machine.
#[derive(Clone, Copy, Debug)]
pub struct MonotonicClock(Duration);

/// Since the machine started.
fn elapsed() -> Duration {
    let time = clock_gettime(ClockId::Boottime);
    Duration::try_from(time).unwrap_or_default()
}

impl MonotonicClock {
    #[must_use]
    pub fn start() -> Self {
        Self(elapsed())
    }
}

impl Clock for MonotonicClock {
    fn now(&self) -> f64 {
        elapsed().saturating_sub(self.0).as_secs_f64()
    }

    fn sleep(&mut self, seconds: f64) {
        if seconds > 0.0
            && let Ok(duration) = Duration::try_from_secs_f64(seconds)
        {
            std::thread::sleep(duration);
        }
    }

    fn wall(&self) -> Option<String> {
        Some(format!("{:.3}", jiff::Timestamp::now()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_forward_and_the_wall_clock_reads_as_the_record_wants_it() {
        let mut clock = MonotonicClock::start();
        let before = clock.now();
        clock.sleep(0.002);
        clock.sleep(f64::NAN);
        clock.sleep(-1.0);
        assert!(clock.now() >= before + 0.002);
        let wall = clock.wall().unwrap();
        assert!(
            wall.len() == "2026-05-31T12:00:00.000Z".len() && wall.ends_with('Z'),
            "{wall}"
        );
    }
}
