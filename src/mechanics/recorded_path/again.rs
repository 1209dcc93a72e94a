//! The recorded way as it is taken again. In: the record, how the way differs, targets one by one. Out: what is read there.
//! It turns where its own targets turn. Each of its turns is the recorded one of that direction nearest in time; where the
//! record turned and it does not, it goes on with the curve that it is on; where it turns and the record did not, it goes
//! back as stiffly as the specimen first was, and says that it went where nothing is recorded.

use super::map::Map;
use super::under_way::Speed;
use super::{Distortion, RecordedPath, Rule, SETTLED};

/// The step of the record nearest to a step of a way that takes `finer` of them for each.
pub const fn nearest(step: usize, finer: u8) -> usize {
    let finer = if finer == 0 { 1 } else { finer as usize };
    (step + finer / 2) / finer
}

/// The way as it is taken again.
#[derive(Clone, Debug)]
pub struct Again<'a> {
    path: &'a RecordedPath,
    distortion: Distortion,
    /// Of its own steps.
    own_step: usize,
    /// The step of the record that is nearest.
    step: usize,
    piece: usize,
    /// Of the curve that begins with each branch; those to come as they were.
    maps: Vec<Map>,
    /// Of those that go back to where the record went.
    fading: Vec<Option<Fading>>,
    /// Where it turned at the end of each branch, m; those to come as they were.
    turns: Vec<f64>,
    /// The last place, in metres of the record.
    place: f64,
    /// With which it passed there, in metres of the record.
    speed: Speed,
    aside: Option<Aside>,
    /// m
    unseen: f64,
}

/// Gone back where the record did not.
#[derive(Clone, Copy, Debug)]
struct Aside {
    /// m
    from: f64,
    /// Displacement (m) and force (N) there, of the record.
    displacement: f64,
    force: f64,
    /// 1 or −1
    direction: f64,
}

/// A curve goes to where the record went, as it would lie in `frame`.
#[derive(Clone, Copy, Debug)]
struct Fading {
    frame: Map,
    /// From where (m), and what place of the record that is.
    from: f64,
    recorded: f64,
    /// Where the record ended, and where that is, m.
    end: f64,
    ended: f64,
}

impl<'a> Again<'a> {
    pub(super) fn new(path: &'a RecordedPath, distortion: Distortion) -> Self {
        let turns = path.branches.iter().map(|branch| branch.turn.target).collect();
        let place = path.readings[0].target;
        let maps = vec![Map::NONE; path.branches.len()];
        let fading = vec![None; path.branches.len()];
        Self {
            path,
            distortion,
            own_step: 0,
            step: 0,
            piece: 0,
            maps,
            fading,
            turns,
            place,
            speed: Speed::default(),
            aside: None,
            unseen: 0.0,
        }
    }

    /// Where it begins (m), and what is read there: displacement (m) and force (N).
    #[must_use]
    pub fn start(&self) -> (f64, f64, f64) {
        let (displacement, force) = self.read();
        (self.place * self.distortion.displacement_scale, displacement, force)
    }

    /// Displacement (m) and force (N) read at the target of the next step, m.
    pub fn move_to(&mut self, target: f64) -> (f64, f64) {
        self.pass(target, 0.0)
    }

    /// The same of a target that is passed with a velocity, m/s.
    pub fn pass(&mut self, target: f64, velocity: f64) -> (f64, f64) {
        let (target, velocity) = (target / self.distortion.displacement_scale, velocity / self.distortion.displacement_scale);
        let speed =
            self.path.under_way.as_ref().map(|it| it.speed(self.speed, velocity, self.distortion.finer)).unwrap_or_default();
        let place = self.path.under_way.as_ref().map_or(target, |under_way| under_way.place(target, speed.felt));
        let before = self.step;
        self.own_step += 1;
        self.step = nearest(self.own_step, self.distortion.finer);
        self.go(place, speed.felt, before);
        (self.place, self.speed) = (place, speed);
        self.read()
    }

    /// The farthest it went back where the record did not, m.
    #[must_use]
    pub const fn unseen(&self) -> f64 {
        self.unseen
    }

    fn branch(&self) -> usize {
        self.path.pieces[self.piece].branch
    }

    /// Goes on to a place (m), to be there with a velocity (m/s), from where it was at the step `before` of the record.
    fn go(&mut self, place: f64, velocity: f64, before: usize) {
        let path = self.path;
        if let Some(aside) = self.aside {
            let branch = self.branch();
            if (place - aside.from) * aside.direction <= 0.0 {
                self.aside = None;
            } else if branch + 1 < path.branches.len() && path.branches[branch].end < self.step {
                // The record has turned by now: it was that turn.
                self.aside = None;
                self.turn(aside.from);
            } else {
                self.unseen = self.unseen.max((place - aside.from).abs());
                return;
            }
        } else {
            let under_way = path.under_way.as_ref();
            let moved = if under_way.is_some() { velocity } else { place - self.place };
            let against = moved * path.branches[self.branch()].direction < 0.0;
            if against {
                let between = under_way
                    .and_then(|it| it.turn_between((self.place, self.speed.felt), (place, velocity), self.distortion.finer));
                let from = between.unwrap_or(self.place);
                if self.matched(before) {
                    self.turn(from);
                } else {
                    let (displacement, force) = self.at(from);
                    self.aside = Some(Aside { from, displacement, force, direction: moved.signum() });
                    self.unseen = self.unseen.max((place - from).abs());
                    return;
                }
            } else if self.missed() {
                self.skip();
            }
        }
        self.rejoin(place);
    }

    /// Goes on to the piece on which a turn's place is passed.
    fn rejoin(&mut self, place: f64) {
        let path = self.path;
        let branch = path.branches[self.branch()];
        while self.piece < branch.last_piece
            && let Some(left) = path.pieces[self.piece + 1].rejoins
            && (place - self.turns[left]) * branch.direction > 0.0
        {
            self.piece += 1;
        }
    }

    /// Whether the turn after `step` is one of the record, nearer than the last one of either direction. Loops of the record
    /// that were not made by then are skipped.
    fn matched(&mut self, step: usize) -> bool {
        let path = self.path;
        let turned = |branch: usize| branch + 1 < path.branches.len();
        let off = |branch: usize| path.branches[branch].end.abs_diff(step);
        let branch = self.branch();
        if !turned(branch) {
            return false;
        }
        // Nearer to the turn that it came from, it only slowed down there in the record.
        let ended = |back: usize| branch.checked_sub(back).map_or(0, |before| path.branches[before].end);
        if [1, 2].into_iter().any(|back| ended(back).abs_diff(step) < off(branch)) {
            return false;
        }
        while turned(self.branch() + 2) && off(self.branch() + 2) < off(self.branch()) {
            self.skip();
        }
        true
    }

    /// Whether the record has gone there and back again for longer than this way may be late.
    fn missed(&self) -> bool {
        let path = self.path;
        let branch = self.branch();
        let ended = |branch: usize| path.branches[branch].end;
        // The next turn that way is nearer than the one not made.
        branch + 2 < path.branches.len()
            && ended(branch + 1) < self.step
            && self.step.saturating_sub(ended(branch)) > ended(branch + 2).saturating_sub(self.step)
    }

    /// Goes on where the record had turned and come back.
    fn skip(&mut self) {
        let path = self.path;
        let left = self.branch();
        let curve = path.pieces[self.piece].curve;
        let back = path.branches[left + 2];
        let same = (back.first_piece..=back.last_piece).find(|piece| path.pieces[*piece].rejoins == Some(left));
        self.piece = same.unwrap_or(back.first_piece);
        for branch in [left + 1, left + 2] {
            self.maps[branch] = self.maps[curve];
        }
    }

    /// Turns at `place` (m) onto the next branch.
    fn turn(&mut self, place: f64) {
        let path = self.path;
        let branch = self.branch();
        let next = branch + 1;
        let turn = path.branches[branch].turn;
        let (frame, at) = self.stand(place);
        let moved = frame.back(place) - turn.target;
        // Readings so near each other tell noise.
        let off = at - turn.target;
        let rise = if off.abs() <= path.least {
            path.pieces[path.branches[branch].last_piece].end_tangent * off
        } else {
            path.at(self.piece, self.looked_from(), at).1 - path.branches[branch].led_to
        };
        let retraces = path.branches[next].retraces;
        let own = if retraces { Map::shifted(moved - off, 0.0) } else { self.moved(next, moved, rise) };
        self.maps[next] = frame.after(own);
        self.fading[next] = self.fade(next, frame, rise).filter(|_| path.rule == Rule::Anchored && !retraces);
        self.turns[branch] = place;
        self.piece = path.branches[next].first_piece;
    }

    /// Turns onto a branch `moved` (m) and `rise` (N) from where the record did, whatever was before.
    pub(super) fn turn_elsewhere(&mut self, branch: usize, moved: f64, rise: f64) {
        self.piece = self.path.branches[branch].first_piece;
        self.maps[branch] = self.moved(branch, moved, rise);
        self.fading[branch] = self.fade(branch, Map::NONE, rise).filter(|_| self.path.rule == Rule::Anchored);
    }

    /// Force at a place (m) on the curve that it turned onto, as far as the record of that reaches, N.
    pub(super) fn foretold(&self, place: f64) -> Option<f64> {
        let (map, at) = self.stand(place);
        self.path.recorded_at(self.piece, at).map(|force| map.force(force))
    }

    /// What becomes of the curve of a branch that begins `moved` (m) and `rise` (N) from where it began in the record.
    fn moved(&self, branch: usize, moved: f64, rise: f64) -> Map {
        let path = self.path;
        let piece = path.pieces[path.branches[branch].first_piece];
        let turn = piece.begin;
        let shifted = Map::shifted(moved, rise);
        // Along a slope, on which it so comes to lie as it did, to where it begins on the new turn.
        let slid = |slope: f64| {
            let first = piece.start_tangent;
            let along = (first * moved - rise) / (first - slope);
            if slope.abs() < SETTLED * first.abs() { Map::shifted(along, slope * along) } else { shifted }
        };
        match path.rule {
            Rule::Pivoted => {
                let stretched = |pivot| Map::about(pivot, [turn.target, turn.force], [turn.target + moved, turn.force + rise]);
                path.pivot(branch).and_then(stretched).unwrap_or(shifted)
            }
            Rule::Shifted | Rule::Anchored if path.branches[branch].drifts => slid(piece.end_tangent),
            Rule::Flowing => slid(path.softest),
            Rule::Shifted | Rule::Anchored | Rule::Kept => shifted,
        }
    }

    /// From where the force is gone to where the record went on the branch.
    fn fade(&self, branch: usize, frame: Map, rise: f64) -> Option<Fading> {
        let path = self.path;
        let [recorded, slope] = path.branches[branch].gone?;
        let piece = path.pieces[path.branches[branch].first_piece];
        let from = self.maps[branch].place(recorded) - rise / slope;
        let end = path.readings[piece.last].target;
        let ended = frame.place(end);
        let some_way = (ended - from) * path.branches[branch].direction > path.least && end != recorded;
        some_way.then_some(Fading { frame, from, recorded, end, ended })
    }

    /// How the curve that it is on lies at a place (m), and what place of the record that is.
    fn stand(&self, place: f64) -> (Map, f64) {
        let curve = self.path.pieces[self.piece].curve;
        let map = self.maps[curve];
        match self.fading[curve] {
            Some(fading) if (place - fading.from) * self.path.branches[curve].direction > 0.0 => {
                let share = (place - fading.from) / (fading.ended - fading.from);
                let between = fading.recorded + share * (fading.end - fading.recorded);
                (fading.frame, if share < 1.0 { between } else { fading.frame.back(place) })
            }
            _ => (map, map.back(place)),
        }
    }

    /// The step of the record that is looked from: past its end, its last.
    fn looked_from(&self) -> usize {
        self.step.min(self.path.readings.len() - 1)
    }

    /// Displacement and force of the specimen at the place where it is, in those of the record.
    fn recorded(&self) -> (f64, f64) {
        let path = self.path;
        if let Some(aside) = self.aside {
            let back = self.place - aside.from;
            return (aside.displacement + back, aside.force + path.pieces[0].start_tangent * back);
        }
        self.at(self.place)
    }

    /// The same at a place (m) on the curve that it is on.
    fn at(&self, place: f64) -> (f64, f64) {
        let (map, at) = self.stand(place);
        let (displacement, force) = self.path.at(self.piece, self.looked_from(), at);
        (displacement + (place - at), map.force(force))
    }

    fn read(&self) -> (f64, f64) {
        let Distortion { force_scale, displacement_scale, zero, noise, .. } = self.distortion;
        let (displacement, force) = self.recorded();
        let step = self.looked_from();
        let recorded = self.path.readings[step].force;
        let felt = self.path.under_way.as_ref().map(|under_way| under_way.force(step, (force, recorded), self.speed.felt));
        let force = felt.unwrap_or(force);
        let (mut displacement, mut force) = (displacement_scale * displacement, force_scale * force + zero);
        if let Some(noise) = noise {
            let [of_force, of_displacement] = noise.errors(self.own_step as u64, 0);
            force += of_force;
            displacement += of_displacement;
        }
        (displacement, force)
    }
}
