//! The measured force–displacement path of a specimen, used as its model. In: targets and the
//! forces read there, in order. Out: the force at targets near them, so that a run can be
//! re-integrated with a perturbed input. At the recorded targets it returns the recorded readings
//! bit for bit.
//!
//! `branches` cuts the path into branches, and compares it with Masing's rule: a branch that begins elsewhere keeps its shape. That is
//! exact for elastic specimens and for elastic–plastic elements in parallel (Iwan's model). Beyond the end of a branch the force follows
//! its tangent. `rate_correction` removes lag and damping of a moving actuator from the readings.
//!
//! The re-run reverses where its own targets reverse. Each reversal is matched to the recorded one of that direction nearest in time. If
//! the record reversed and the re-run does not, the re-run continues on its present curve. If the re-run reverses and the record did not,
//! it unloads with the initial stiffness of the specimen. It reports a departure from the record in two cases: it unloads where nothing
//! is recorded, or, if the record does not keep Masing's rule, it follows a curve that begins at a different point.

mod branches;
mod rate_correction;

pub(crate) use rate_correction::lag;

use branches::{Branch, Piece, Slopes};
use rate_correction::{ContinuousReadings, Passage, Speed};

use crate::integrator::tangent::NOISE_MULTIPLE;
use crate::statistics::DeclaredNoise;

/// One step of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Commanded displacement \[m\].
    pub target: f64,
    /// Measured \[m\].
    pub displacement: f64,
    /// Measured \[N\].
    pub force: f64,
}

/// The motion of a run whose actuators do not stop at their targets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContinuousMotion<V> {
    /// Predicted for the targets \[m/s\].
    pub velocities: V,
    /// From one reading to the next, in the same time \[s\].
    pub time_step: f64,
}

/// Readings at the ends of each segment without a reversal, and its direction, from the move to each reading: a displacement change, or a
/// velocity.
fn branches_of(travel: impl Iterator<Item = f64>) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    let (mut begin, mut last, mut direction) = (0, 0, 0.0);
    for (step, moved) in travel.enumerate() {
        last = step;
        if moved * direction < 0.0 {
            found.push((begin, step - 1, direction));
            begin = step - 1;
        }
        if moved != 0.0 {
            direction = moved.signum();
        }
    }
    found.push((begin, last, direction));
    found
}

/// A re-run that reverses where nothing is recorded departs from the record beyond this fraction of the farthest recorded position.
const UNSEEN: f64 = 1e-3;
/// Curves nearer to their record than this fraction of it lie on it.
const ROUNDING: f64 = 1e-9;
/// A curve whose last slope is less than this fraction of its first has settled on that.
const SETTLED: f64 = 0.9;

/// Readings along the path, in branches and curves.
#[derive(Clone, Debug)]
pub struct RecordedPath {
    readings: Vec<Reading>,
    branches: Vec<Branch>,
    pieces: Vec<Piece>,
    /// Positions closer than this determine no slope \[m\].
    least: f64,
    /// Farthest target from zero \[m\].
    farthest: f64,
    /// Whether its curves satisfy Masing's rule.
    keeps_masing: bool,
    /// Readings of a continuous motion; `readings` are then those of the specimen at rest.
    continuous: Option<ContinuousReadings>,
}

impl RecordedPath {
    /// `motion` is that of a continuous run; without it the specimen rested at each reading. `stiffness` \[N/m\] applies where no branch
    /// determines one. None without readings.
    #[must_use]
    pub fn new(
        readings: Vec<Reading>,
        motion: Option<ContinuousMotion<&[f64]>>,
        stiffness: f64,
        noise: DeclaredNoise,
    ) -> Option<Self> {
        readings.first()?;
        let continuous =
            motion.map(|motion| ContinuousReadings::of(&readings, motion, noise.resolution));
        let readings = continuous
            .as_ref()
            .map_or(readings, ContinuousReadings::at_rest);
        let least = noise
            .resolution
            .max(NOISE_MULTIPLE * noise.force / stiffness);
        let force_uncertainty = continuous.as_ref().map_or(0.0, |continuous| {
            continuous.force_uncertainty(stiffness, noise.resolution)
        });
        let slopes = Slopes {
            stiffness,
            force_noise: noise.force.hypot(force_uncertainty),
            least,
        };
        let (branches, pieces) = branches::cut(&readings, slopes, continuous.as_ref());
        let keeps_masing = branches::keeps_masing_rule(
            &readings,
            &branches,
            &pieces,
            noise.force,
            continuous.is_some(),
        );
        let farthest = readings.iter().fold(0.0, |farthest: f64, reading| {
            farthest.max(reading.target.abs())
        });
        Some(Self {
            readings,
            branches,
            pieces,
            least,
            farthest,
            keeps_masing,
            continuous,
        })
    }

    /// The recorded reading of a step; past the end of the record, of its last.
    #[must_use]
    pub fn recorded(&self, step: usize) -> &Reading {
        let step = step.min(self.readings.len() - 1);
        self.continuous
            .as_ref()
            .map_or(&self.readings[step], |continuous| continuous.reading(step))
    }

    /// Retraces it from its begin, in `finer` steps for each of the record.
    #[must_use]
    pub fn retrace(&self, finer: u8) -> Retrace<'_> {
        Retrace::new(self, finer)
    }

    /// Displacement and force at `position` \[m\] on the curve of `piece`, searched from the reading of `step`.
    fn at(&self, piece: usize, step: usize, position: f64, searched: &mut Searched) -> (f64, f64) {
        let mut index = piece;
        // On either side of the point at which the curve was left and later continued.
        let (piece, direction) = loop {
            let piece = &self.pieces[index];
            let direction = self.branches[piece.branch].direction;
            let beyond = |reading: &Reading| (position - reading.target) * direction;
            index = match (piece.before, piece.after) {
                (Some(before), _) if beyond(&piece.begin) < 0.0 => before,
                (_, Some(after)) if beyond(&self.pieces[after].begin) > 0.0 => after,
                _ => break (piece, direction),
            };
        };
        self.on(piece, direction, step, position, searched)
    }

    /// Reading number `index` of a piece; 0 is its begin.
    #[inline]
    fn point<'a>(&'a self, piece: &'a Piece, index: usize) -> &'a Reading {
        if index == 0 {
            &piece.begin
        } else {
            &self.readings[piece.first + index - 1]
        }
    }

    /// The stretch of a piece at `position` \[m\]. None if the readings have noise, because neighbours then determine no slope; for a
    /// continuous motion, whose positions may go back; and for a record without motion.
    fn stretch_at(&self, piece: &Piece, direction: f64, position: f64) -> Option<Stretch> {
        if self.least > 0.0 || self.continuous.is_some() || direction == 0.0 {
            return None;
        }
        // Its readings go in one direction.
        let passed = |reading: &Reading| (reading.target - position) * direction <= 0.0;
        let ends = if passed(&piece.begin) {
            1 + self.readings[piece.first..=piece.last].partition_point(passed)
        } else {
            0
        };
        Some(self.stretch(piece, direction, ends))
    }

    /// The stretch of a piece that ends at reading number `ends`.
    fn stretch(&self, piece: &Piece, direction: f64, ends: usize) -> Stretch {
        let last = piece.last + 1 - piece.first;
        let end = (ends <= last).then(|| *self.point(piece, ends));
        let begin = ends.checked_sub(1).map(|begins| *self.point(piece, begins));
        let [displacement_slope, force_slope] = match (begin, end) {
            (Some(begin), Some(end)) => [
                end.displacement - begin.displacement,
                end.force - begin.force,
            ]
            .map(|rise| rise / (end.target - begin.target)),
            (None, _) => [1.0, piece.start_tangent],
            (_, None) => [1.0, piece.end_tangent],
        };
        Stretch {
            ends,
            end: end.map_or(f64::INFINITY, |end| end.target * direction),
            on_it: begin.unwrap_or(piece.begin),
            displacement_slope,
            force_slope,
        }
    }

    /// Displacement and force at `position` \[m\] on one piece or beyond its ends, searched from the reading of `step`.
    #[inline]
    fn on(
        &self,
        piece: &Piece,
        direction: f64,
        step: usize,
        position: f64,
        searched: &mut Searched,
    ) -> (f64, f64) {
        let point = |index: usize| self.point(piece, index);
        let last = piece.last + 1 - piece.first;
        let present = (step + 1).saturating_sub(piece.first).min(last);
        let here = point(present);
        let off = position - here.target;
        if off == 0.0 {
            return (here.displacement, here.force);
        }
        let onwards = off * direction > 0.0;
        let away = |count: usize| {
            point(if onwards {
                present + count
            } else {
                present - count
            })
        };
        // Nearby, the noise of this reading applies and not that of its neighbours: the force continues from here to the first reading
        // that is far enough to determine a slope.
        let apart = |reading: &Reading| (reading.target - here.target).abs();
        let reach = off.abs().max(self.least);
        let reaches = |count: usize| apart(away(count)) >= reach;
        let outermost = if onwards { last - present } else { present };
        let found = if self.continuous.is_some() {
            // Its branches are cut by velocities: near a reversal its positions may go back.
            (1..=outermost).find(|count| reaches(*count))
        } else if outermost == 0 || !reaches(outermost) {
            None
        } else {
            // Its readings go in one direction.
            let mut count = searched.0.clamp(1, outermost);
            while count > 1 && reaches(count - 1) {
                count -= 1;
            }
            while !reaches(count) {
                count += 1;
            }
            searched.0 = count;
            Some(count)
        };
        let Some(count) = found else {
            let (end, tangent) = if onwards {
                (point(last), piece.end_tangent)
            } else {
                (&piece.begin, piece.start_tangent)
            };
            let end = if apart(end) < self.least { here } else { end };
            let beyond = position - end.target;
            return (end.displacement + beyond, end.force + tangent * beyond);
        };
        let (near, far) = (away(count - 1), away(count));
        let near = if apart(near) < self.least { here } else { near };
        let share = (position - near.target) / (far.target - near.target);
        let between = |near: f64, far: f64| near + share * (far - near);
        (
            between(near.displacement, far.displacement),
            between(near.force, far.force),
        )
    }
}

/// A piece between two neighbouring readings without noise, or beyond its ends: displacement and force are linear there.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Number of the reading at its end, the last plus one beyond the end of the piece.
    ends: usize,
    /// Its position, times the direction of the motion \[m\].
    end: f64,
    /// The reading at its begin; beyond the begin of the piece, the one there.
    on_it: Reading,
    /// Metres measured per metre of target.
    displacement_slope: f64,
    /// \[N/m\]
    force_slope: f64,
}

/// How many readings the last search went away from the present one: the next search begins there.
#[derive(Clone, Copy, Debug, Default)]
struct Searched(usize);

/// The step of the record nearest to `step` of a path with `finer` steps for each recorded step.
pub(crate) const fn nearest(step: usize, finer: u8) -> usize {
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
    /// The nearest step of the record ([`nearest`]), and the step of its own with which the next one begins.
    step: usize,
    next_begins: usize,
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
    searched: Searched,
    /// The present piece, if the next step may stay on it.
    along: Option<Along>,
}

/// What a step along one piece needs to know of it.
#[derive(Clone, Copy, Debug)]
struct Along {
    /// 1 or −1; 0 for a record without motion.
    direction: f64,
    shift: Shift,
    /// Positions at which other pieces of its curve begin, in those of the record, times the direction \[m\].
    from: f64,
    to: f64,
    /// Where its branch continues an earlier curve, times the direction \[m\].
    rejoins: f64,
    /// The last step of the record at which the motion may still be on it, without having missed a loop.
    matches_until: usize,
    /// The stretch at the last position, if the readings have no noise.
    stretch: Option<Stretch>,
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
    fn new(path: &'a RecordedPath, finer: u8) -> Self {
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
            next_begins: usize::from(finer.max(1)).div_ceil(2),
            piece: 0,
            shifts,
            turns,
            position,
            speed: Speed::default(),
            aside: None,
            departed: false,
            searched: Searched::default(),
            along: None,
        }
    }

    /// The reading at the first position.
    #[must_use]
    pub fn start(&mut self) -> Reading {
        let (displacement, force) = self.read();
        Reading {
            target: self.position,
            displacement,
            force,
        }
    }

    /// Displacement \[m\] and force \[N\] read at the target \[m\] of the next step, which is passed with a velocity \[m/s\].
    #[inline]
    pub fn pass(&mut self, target: f64, velocity: f64) -> (f64, f64) {
        let before = self.step;
        self.own_step += 1;
        if self.own_step == self.next_begins {
            self.step += 1;
            self.next_begins += usize::from(self.finer.max(1));
        }
        if let Some(read) = self.read_along(target) {
            self.position = target;
            return read;
        }
        self.pass_anywhere(target, velocity, before)
    }

    fn pass_anywhere(&mut self, target: f64, velocity: f64, before: usize) -> (f64, f64) {
        let speed = self
            .path
            .continuous
            .as_ref()
            .map(|it| it.speed(self.speed, velocity, self.finer))
            .unwrap_or_default();
        let position = self.path.continuous.as_ref().map_or(target, |continuous| {
            continuous.position(target, speed.actual)
        });
        self.go(position, speed.actual, before);
        (self.position, self.speed) = (position, speed);
        self.along = self.along();
        self.read()
    }

    /// Displacement and force at a target \[m\] on the present piece; None: it is not there, or the actuator does not stop at it.
    #[inline]
    fn read_along(&mut self, target: f64) -> Option<(f64, f64)> {
        let along = self.along.as_mut()?;
        let Along {
            direction, shift, ..
        } = *along;
        let at = target - shift.position;
        let (onwards, at_onwards) = (target * direction, at * direction);
        let leaves = onwards < self.position * direction
            || onwards > along.rejoins
            || at_onwards < along.from
            || at_onwards > along.to;
        if leaves || self.step > along.matches_until {
            return None;
        }
        let piece = &self.path.pieces[self.piece];
        if let Some(stretch) = &mut along.stretch {
            while at_onwards >= stretch.end {
                *stretch = self.path.stretch(piece, direction, stretch.ends + 1);
            }
            let Stretch {
                on_it,
                displacement_slope,
                force_slope,
                ..
            } = *stretch;
            let further = at - on_it.target;
            // At several readings with one target, the present one counts.
            if further != 0.0 {
                return Some((
                    on_it.displacement + displacement_slope * further + (target - at),
                    on_it.force + force_slope * further + shift.force,
                ));
            }
        }
        let step = self.looked_from();
        let (displacement, force) = self.path.on(piece, direction, step, at, &mut self.searched);
        Some((displacement + (target - at), force + shift.force))
    }

    fn along(&self) -> Option<Along> {
        if self.aside.is_some() || self.path.continuous.is_some() {
            return None;
        }
        let (path, number) = (self.path, self.piece);
        let piece = &path.pieces[number];
        let branch = &path.branches[piece.branch];
        let direction = branch.direction;
        let next = path
            .pieces
            .get(number + 1)
            .filter(|_| number < branch.last_piece);
        let rejoins = next
            .and_then(|next| next.rejoins)
            .map(|left| self.turns[left]);
        let onwards = |position: f64| position * direction;
        let shift = self.shift();
        Some(Along {
            direction,
            stretch: path.stretch_at(piece, direction, self.position - shift.position),
            shift,
            from: piece
                .before
                .map_or(f64::NEG_INFINITY, |_| onwards(piece.begin.target)),
            to: piece.after.map_or(f64::INFINITY, |after| {
                onwards(path.pieces[after].begin.target)
            }),
            rejoins: rejoins.map_or(f64::INFINITY, onwards),
            matches_until: if piece.branch + 2 < path.branches.len() {
                path.branches[piece.branch + 1].end
            } else {
                usize::MAX
            },
        })
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
        let branch = &path.branches[self.branch()];
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
                let from = self.looked_from();
                let (_, force) = path.at(self.piece, from, at, &mut self.searched);
                force - path.branches[branch].led_to
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
    fn recorded(&mut self) -> (f64, f64) {
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
    fn at(&mut self, position: f64) -> (f64, f64) {
        let shift = self.shift();
        let at = position - shift.position;
        let from = self.looked_from();
        let (displacement, force) = self.path.at(self.piece, from, at, &mut self.searched);
        (displacement + (position - at), force + shift.force)
    }

    fn read(&mut self) -> (f64, f64) {
        let (displacement, force) = self.recorded();
        let actual = self.path.continuous.as_ref().map(|continuous| {
            let step = self.looked_from();
            let recorded = self.path.readings[step].force;
            continuous.force(step, force - recorded, self.speed.actual)
        });
        (displacement, actual.unwrap_or(force))
    }
}

#[cfg(test)]
mod tests;
