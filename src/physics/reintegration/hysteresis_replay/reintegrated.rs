//! The re-run along the record. In: the record, targets one by one. Out: the readings there. The re-run reverses where its own targets
//! reverse. Each reversal is matched to the recorded one of that direction nearest in time. If the record reversed and the re-run does
//! not, the re-run continues on its present curve. If the re-run reverses and the record did not, it unloads with the initial stiffness
//! of the specimen. It reports a departure from the record in two cases: it unloads where nothing is recorded, or, if the record does not
//! keep Masing's rule, it follows a curve that begins at a different point.

use super::rate_correction::{Passage, Speed};
use super::{ROUNDING, Reading, RecordedPath, SETTLED, UNSEEN};

/// The step of the record nearest to `step` of a path with `finer` steps for each recorded step.
pub const fn nearest(step: usize, finer: u8) -> usize {
    let finer = if finer == 0 { 1 } else { finer as usize };
    (step + finer / 2) / finer
}

/// The recorded path during a re-run.
#[derive(Clone, Debug)]
pub struct Retrace<'a> {
    path: &'a RecordedPath,
    /// Steps of the re-run for each step of the record.
    finer: u8,
    /// Number of its own steps so far.
    own_step: usize,
    /// The nearest step of the record.
    step: usize,
    piece: usize,
    /// The shift of the curve that begins with each branch; later branches keep their initial value.
    shifts: Vec<Shift>,
    /// The reversal point at the end of each branch \[m\]; later branches keep their initial value.
    turns: Vec<f64>,
    /// The last position, in metres of the record.
    position: f64,
    /// The velocity at the last position, in metres of the record.
    speed: Speed,
    aside: Option<Aside>,
    departed: bool,
}

/// The shift of a curve from its recorded position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Shift {
    /// \[m\]
    position: f64,
    /// \[N\]
    force: f64,
}

/// An unloading branch that is not in the record.
#[derive(Clone, Copy, Debug)]
struct Aside {
    /// \[m\]
    from: f64,
    /// Displacement \[m\] and force \[N\] there, in those of the record.
    displacement: f64,
    force: f64,
    /// 1 or −1
    direction: f64,
}

impl<'a> Retrace<'a> {
    pub(super) fn new(path: &'a RecordedPath, finer: u8) -> Self {
        let turns = path
            .branches
            .iter()
            .map(|branch| branch.reversal.target)
            .collect();
        let position = path.readings[0].target;
        let shifts = vec![Shift::default(); path.branches.len()];
        Self {
            path,
            finer,
            own_step: 0,
            step: 0,
            piece: 0,
            shifts,
            turns,
            position,
            speed: Speed::default(),
            aside: None,
            departed: false,
        }
    }

    /// The reading at the first position.
    #[must_use]
    pub fn start(&self) -> Reading {
        let (displacement, force) = self.read();
        Reading {
            target: self.position,
            displacement,
            force,
        }
    }

    /// Displacement \[m\] and force \[N\] read at the target \[m\] of the next step, which is passed with a velocity \[m/s\].
    pub fn pass(&mut self, target: f64, velocity: f64) -> (f64, f64) {
        let speed = self
            .path
            .continuous
            .as_ref()
            .map(|it| it.speed(self.speed, velocity, self.finer))
            .unwrap_or_default();
        let position = self.path.continuous.as_ref().map_or(target, |continuous| {
            continuous.position(target, speed.actual)
        });
        let before = self.step;
        self.own_step += 1;
        self.step = nearest(self.own_step, self.finer);
        self.go(position, speed.actual, before);
        (self.position, self.speed) = (position, speed);
        self.read()
    }

    /// Whether the re-run has departed from the record.
    #[must_use]
    pub const fn departed(&self) -> bool {
        self.departed
    }

    /// Registers that the path is `off` \[m\] away from the record, where nothing is recorded.
    fn leaves_by(&mut self, off: f64) {
        self.departed |= off.abs() > UNSEEN * self.path.farthest;
    }

    /// Registers that the curve is shifted by `off` \[m\] from its recorded position.
    fn shifts_by(&mut self, off: f64) {
        self.departed |= !self.path.keeps_masing && off.abs() > ROUNDING * self.path.farthest;
    }

    fn branch(&self) -> usize {
        self.path.pieces[self.piece].branch
    }

    /// Moves to a position \[m\] with a velocity \[m/s\] there, from the position at the step `before` of the record.
    fn go(&mut self, position: f64, velocity: f64, before: usize) {
        let path = self.path;
        if let Some(aside) = self.aside {
            let branch = self.branch();
            if (position - aside.from) * aside.direction <= 0.0 {
                self.aside = None;
            } else if branch + 1 < path.branches.len() && path.branches[branch].end < self.step {
                // The record has reversed by now: the reversals match.
                self.aside = None;
                self.reversal(aside.from);
            } else {
                self.leaves_by(position - aside.from);
                return;
            }
        } else {
            let continuous = path.continuous.as_ref();
            let moved = if continuous.is_some() {
                velocity
            } else {
                position - self.position
            };
            let against = moved * path.branches[self.branch()].direction < 0.0;
            if against {
                let between = continuous.and_then(|it| {
                    let before = Passage {
                        position: self.position,
                        velocity: self.speed.actual,
                    };
                    it.reversal_between(before, Passage { position, velocity }, self.finer)
                });
                let from = between.unwrap_or(self.position);
                if self.matched(before) {
                    self.reversal(from);
                } else {
                    let (displacement, force) = self.at(from);
                    self.aside = Some(Aside {
                        from,
                        displacement,
                        force,
                        direction: moved.signum(),
                    });
                    self.leaves_by(position - from);
                    return;
                }
            } else if self.missed() {
                self.skip();
            }
        }
        self.rejoin(position);
    }

    /// Changes to the piece of the branch on which the position of an earlier reversal is passed.
    fn rejoin(&mut self, position: f64) {
        let path = self.path;
        let branch = path.branches[self.branch()];
        while self.piece < branch.last_piece
            && let Some(left) = path.pieces[self.piece + 1].rejoins
            && (position - self.turns[left]) * branch.direction > 0.0
        {
            self.piece += 1;
        }
    }

    /// Whether the reversal after `step` matches one of the record, nearer than the last reversal of either direction. Recorded loops
    /// that were not made until then are skipped.
    fn matched(&mut self, step: usize) -> bool {
        let path = self.path;
        let turned = |branch: usize| branch + 1 < path.branches.len();
        let off = |branch: usize| path.branches[branch].end.abs_diff(step);
        let branch = self.branch();
        if !turned(branch) {
            return false;
        }
        // The step is nearer to an earlier reversal: in the record it only slowed down there.
        let ended = |back: usize| {
            branch
                .checked_sub(back)
                .map_or(0, |before| path.branches[before].end)
        };
        if [1, 2]
            .into_iter()
            .any(|back| ended(back).abs_diff(step) < off(branch))
        {
            return false;
        }
        while turned(self.branch() + 2) && off(self.branch() + 2) < off(self.branch()) {
            self.skip();
        }
        true
    }

    /// Whether the record has made its next loop, and the re-run is too late to make the same one.
    fn missed(&self) -> bool {
        let path = self.path;
        let branch = self.branch();
        let ended = |branch: usize| path.branches[branch].end;
        // The next reversal in that direction is nearer than the one not made.
        branch + 2 < path.branches.len()
            && ended(branch + 1) < self.step
            && self.step.saturating_sub(ended(branch)) > ended(branch + 2).saturating_sub(self.step)
    }

    /// Skips the loop that the record made here.
    fn skip(&mut self) {
        let path = self.path;
        let left = self.branch();
        let curve = path.pieces[self.piece].curve;
        let back = path.branches[left + 2];
        let same = (back.first_piece..=back.last_piece)
            .find(|piece| path.pieces[*piece].rejoins == Some(left));
        self.piece = same.unwrap_or(back.first_piece);
        for branch in [left + 1, left + 2] {
            self.shifts[branch] = self.shifts[curve];
        }
        self.shifts_by(
            path.branches[left].reversal.target - path.branches[left + 1].reversal.target,
        );
    }

    /// Reverses at `position` \[m\] onto the next branch. A curve that retraces an earlier one is shifted as that one; any other keeps
    /// its shape. A curve that closed no loop returns to the line on which it settled.
    fn reversal(&mut self, position: f64) {
        let path = self.path;
        let branch = self.branch();
        let next = branch + 1;
        let reversal = path.branches[branch].reversal;
        let before = self.shift();
        let at = position - before.position;
        let mut shift = before;
        if !path.branches[next].retraces {
            // The difference of readings this near each other is noise.
            let off = at - reversal.target;
            let rise = if off.abs() <= path.least {
                path.pieces[path.branches[branch].last_piece].end_tangent * off
            } else {
                path.at(self.piece, self.looked_from(), at).1 - path.branches[branch].led_to
            };
            let piece = path.pieces[path.branches[next].first_piece];
            let (first, settled) = (piece.start_tangent, piece.end_tangent);
            let mut own = Shift {
                position: off,
                force: rise,
            };
            if path.branches[next].drifts.is_some() && settled.abs() < SETTLED * first.abs() {
                let along = (first * off - rise) / (first - settled);
                own = Shift {
                    position: along,
                    force: settled * along,
                };
            }
            shift = Shift {
                position: own.position + before.position,
                force: own.force + before.force,
            };
            self.shifts_by(off);
        }
        self.shifts[next] = shift;
        self.turns[branch] = position;
        self.piece = path.branches[next].first_piece;
    }

    /// The shift of its present curve.
    fn shift(&self) -> Shift {
        self.shifts[self.path.pieces[self.piece].curve]
    }

    /// The step of the record from which the search begins: past the end, the last step.
    fn looked_from(&self) -> usize {
        self.step.min(self.path.readings.len() - 1)
    }

    /// Displacement and force of the specimen at its present position, in those of the record.
    fn recorded(&self) -> (f64, f64) {
        let path = self.path;
        if let Some(aside) = self.aside {
            let back = self.position - aside.from;
            return (
                aside.displacement + back,
                aside.force + path.pieces[0].start_tangent * back,
            );
        }
        self.at(self.position)
    }

    /// Displacement and force at a position \[m\] on the present curve.
    fn at(&self, position: f64) -> (f64, f64) {
        let shift = self.shift();
        let at = position - shift.position;
        let (displacement, force) = self.path.at(self.piece, self.looked_from(), at);
        (displacement + (position - at), force + shift.force)
    }

    fn read(&self) -> (f64, f64) {
        let (displacement, force) = self.recorded();
        let step = self.looked_from();
        let recorded = self.path.readings[step].force;
        let actual = self
            .path
            .continuous
            .as_ref()
            .map(|continuous| continuous.force(step, force - recorded, self.speed.actual));
        (displacement, actual.unwrap_or(force))
    }
}
