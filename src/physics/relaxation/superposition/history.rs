//! Increments of instantaneous force in time, and the sum of their relaxations. In: holds. Out: sums over moves. It knows no law.

use crate::relaxation::hold::Hold;

/// A move to a hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Move {
    /// Duration \[s\].
    pub took: f64,
    /// Instant of its end \[s\].
    pub ended: f64,
    /// Instant of the first reading after it \[s\].
    pub read_from: f64,
}

/// The moves to these holds, in time from the begin of the first.
pub(super) fn moves(holds: &[Hold]) -> Vec<Move> {
    let mut now = 0.0;
    let moves = holds.iter().map(|hold| {
        let took = hold.moved_for.max(0.0);
        let ended = now + hold.waited_for + took;
        let read_from = ended + hold.settled_for;
        now = read_from + hold.duration();
        Move {
            took,
            ended,
            read_from,
        }
    });
    moves.collect()
}

/// Instantaneous forces of holds, in time.
pub(super) struct ForceHistory<'a> {
    /// R̂ of each hold \[N\].
    pub reached: &'a [f64],
    pub moves: &'a [Move],
    /// Force before the first move \[N\].
    pub before: f64,
}

impl ForceHistory<'_> {
    /// Σ ΔR̂ⱼ·`kernel`(time since the end of move j, its duration) over the moves up to `hold`, `seconds` after its first reading.
    pub fn superposed(&self, hold: usize, seconds: f64, kernel: impl Fn(f64, f64) -> f64) -> f64 {
        let now = self.moves[hold].read_from + seconds;
        let increments = self.reached[..=hold]
            .iter()
            .scan(self.before, |last, reached| {
                let increment = reached - *last;
                *last = *reached;
                Some(increment)
            });
        increments
            .zip(self.moves)
            .map(|(increment, moved)| increment * kernel(now - moved.ended, moved.took))
            .sum()
    }
}
