//! Jumps of the wall clock during a run. In: run log entries with both clocks. Out: time and size of each jump. Durations never use the
//! wall clock. A jump explains to a reader why the dates of a run log are inconsistent.

use jiff::Timestamp;

use psd::report::ClockJump;
use psd_rig::journal::{EntryKind, Line};

/// A smaller difference is the slow correction of a clock, or the time between the two time stamps of an entry \[s\].
const SMALL: f64 = 10.0;

/// Every jump between two readings of one part of the run. The time before a resumption is not a jump.
pub fn jumps(lines: &[Line]) -> Vec<ClockJump> {
    let mut before: Option<(f64, Timestamp)> = None;
    let mut found = Vec::new();
    for line in lines {
        match line.kind {
            EntryKind::Resume => before = None,
            EntryKind::Sample => {
                let Some((time, wall)) = stamps(line) else {
                    continue;
                };
                if let Some((time_before, wall_before)) = before {
                    let seconds =
                        wall.duration_since(wall_before).as_secs_f64() - (time - time_before);
                    if seconds.abs() > SMALL {
                        found.push(ClockJump { time, seconds });
                    }
                }
                before = Some((time, wall));
            }
            _ => {}
        }
    }
    found
}

/// Rig time \[s\] and wall clock of a reading.
fn stamps(line: &Line) -> Option<(f64, Timestamp)> {
    Some((
        line.time()?,
        line.body().get("wall")?.as_str()?.parse().ok()?,
    ))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn line(kind: EntryKind, time: f64, wall: &str) -> Line {
        Line::new(1, kind, &json!({"t": time, "wall": wall}))
    }

    #[test]
    fn a_jump_of_a_year_is_reported_and_a_slow_run_is_not() {
        let sample = |time, wall| line(EntryKind::Sample, time, wall);
        let steady = [
            sample(1.0, "2026-10-25T00:59:59.000Z"),
            sample(3601.0, "2026-10-25T01:59:59.500Z"),
            sample(3602.0, "2026-10-25T02:00:09.000Z"),
        ];
        assert_eq!(jumps(&steady), []);
        let jumping = [
            sample(1.0, "2026-03-01T10:00:00.000Z"),
            sample(2.0, "2027-03-01T10:00:01.000Z"),
            sample(3.0, "2026-03-01T10:00:02.000Z"),
            // Resumed on the next day.
            line(EntryKind::Resume, 3.0, "2026-03-02T10:00:00.000Z"),
            sample(4.0, "2026-03-02T10:00:01.000Z"),
        ];
        let year = 365.0 * 86400.0;
        assert_eq!(
            jumps(&jumping),
            [
                ClockJump {
                    time: 2.0,
                    seconds: year
                },
                ClockJump {
                    time: 3.0,
                    seconds: -year
                }
            ]
        );
    }
}
