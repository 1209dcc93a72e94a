//! The specimen as a run recorded it: force over displacement along the way it went, so that the run can be taken again
//! with an input moved a little and no model of the specimen. In: targets and what was read at them, in order. Out: what
//! would be read at targets near those, step by step.
//!
//! The way is cut at its turning points into branches, each monotone. At step i the branch that the record was on at its
//! step i holds; inside it the force is interpolated between the recorded points, beyond its ends it goes on along the
//! tangent there. A specimen that was turned elsewhere comes back on another line: where the record turns at `X_m` and the
//! way taken now at `X_m` + δ, the next branch is moved along by ρδ and raised so that it begins where the way turned, ρ the
//! share of δ that was plastic: (`K_start` − `K_end`)/(`K_start` − `K_low`) of the tangents before and after the turn and of
//! the least tangent of the whole way. That is exact of elastic specimens, for which it is nothing, and of those that yield
//! with kinematic hardening, forth and back: their loop goes along with the point that was turned at. At the recorded targets
//! the recorded readings come back as they were, to the bit.

use super::tangent::NOISE_MULTIPLE;

/// One step of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Commanded, m.
    pub target: f64,
    /// m
    pub displacement: f64,
    /// N
    pub force: f64,
}

/// How the way differs from the recorded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    /// Newtons in one newton of the record.
    pub force_scale: f64,
    /// Metres in one metre of the record.
    pub displacement_scale: f64,
    /// Added to every force, N.
    pub zero: f64,
    /// Added to every reading with a sign drawn for each: N and m.
    pub noise: Option<Noise>,
}

impl Distortion {
    pub const NONE: Self = Self { force_scale: 1.0, displacement_scale: 1.0, zero: 0.0, noise: None };
}

/// One draw of the errors of all readings: each has its standard deviation, and the sign that the draw gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// N
    pub force: f64,
    /// m
    pub displacement: f64,
    pub draw: u16,
}

impl Noise {
    /// Errors of force (N) and displacement (m) of the reading at `step` of the axis at this place.
    #[must_use]
    pub fn errors(&self, step: u64, axis: u32) -> [f64; 2] {
        // Two bits an axis; past the last of a word, another word.
        let bits = drawn(self.draw, step ^ u64::from(axis / 32) << 40) >> (2 * (axis % 32));
        let signed = |bit: u64, size: f64| if bits & bit == 0 { size } else { -size };
        [signed(1, self.force), signed(2, self.displacement)]
    }
}

#[derive(Clone, Copy, Debug)]
struct Branch {
    /// Steps at its ends.
    first: usize,
    last: usize,
    /// N/m; of a branch too short to tell, that of the one before it.
    start_tangent: f64,
    end_tangent: f64,
}

/// Readings along the way, in branches.
#[derive(Clone, Debug)]
pub struct RecordedPath {
    readings: Vec<Reading>,
    branches: Vec<Branch>,
    /// The branch that ends in, or goes through, each reading.
    branch_of: Vec<usize>,
    /// The least tangent at an end of a branch, N/m.
    least_tangent: f64,
}

impl RecordedPath {
    /// `stiffness` (N/m) where no branch tells one; `force_noise` (N) and `resolution` (m) say how long a piece must be to
    /// tell. None of no reading.
    #[must_use]
    pub fn new(readings: Vec<Reading>, stiffness: f64, force_noise: f64, resolution: f64) -> Option<Self> {
        let mut branch_of = vec![0; readings.len()];
        let mut bounds = vec![0];
        let mut direction = 0.0;
        for step in 1..readings.len() {
            let moved = readings[step].target - readings[step - 1].target;
            if moved * direction < 0.0 {
                bounds.push(step - 1);
            }
            if moved != 0.0 {
                direction = moved;
            }
            branch_of[step] = bounds.len() - 1;
        }
        bounds.push(readings.len().checked_sub(1)?);
        let least = resolution.max(NOISE_MULTIPLE * force_noise / stiffness);
        let mut known = stiffness;
        let branches = bounds.windows(2).map(|ends| {
            let steps = &readings[ends[0]..=ends[1]];
            let start = tangent(steps.iter(), least);
            let end = tangent(steps.iter().rev(), least);
            let start_tangent = start.unwrap_or(known);
            known = end.unwrap_or(start_tangent);
            Branch { first: ends[0], last: ends[1], start_tangent, end_tangent: known }
        });
        let branches: Vec<Branch> = branches.collect();
        let tangents = branches.iter().flat_map(|branch| [branch.start_tangent, branch.end_tangent]);
        let least_tangent = tangents.fold(stiffness, f64::min);
        Some(Self { readings, branches, branch_of, least_tangent })
    }

    /// Follows the way from its beginning.
    #[must_use]
    pub fn walk(&self) -> Walk<'_> {
        Walk { path: self, step: 0, branch: 0, along: 0.0, raised: 0.0, place: self.readings[0].target }
    }

    /// Takes the way again from its beginning.
    #[must_use]
    pub fn again(&self, distortion: Distortion) -> Again<'_> {
        Again { walk: self.walk(), distortion }
    }

    /// Displacement and force read at `place` (m) on `branch`, looked for from the reading of `step`.
    fn at(&self, branch: usize, step: usize, place: f64) -> (f64, f64) {
        let Branch { first, last, start_tangent, end_tangent } = self.branches[branch];
        let here = self.readings[step];
        if place == here.target {
            return (here.displacement, here.force);
        }
        let onwards = (self.readings[last].target - self.readings[first].target) * (place - here.target) > 0.0;
        let mut from = step;
        loop {
            let next = if onwards && from < last {
                from + 1
            } else if !onwards && from > first {
                from - 1
            } else {
                break;
            };
            let (near, far) = (self.readings[from], self.readings[next]);
            // Between the two, or at one of them.
            if (place - near.target) * (place - far.target) <= 0.0 && near.target != far.target {
                let share = (place - near.target) / (far.target - near.target);
                let between = |near: f64, far: f64| near + share * (far - near);
                return (between(near.displacement, far.displacement), between(near.force, far.force));
            }
            from = next;
        }
        let end = self.readings[from];
        let tangent = if from == last { end_tangent } else { start_tangent };
        let beyond = place - end.target;
        (end.displacement + beyond, end.force + tangent * beyond)
    }
}

/// Slope of the least squares over the fewest readings that span more than `least` (m), two at least; None where all of
/// them do not.
fn tangent<'a>(readings: impl Iterator<Item = &'a Reading>, least: f64) -> Option<f64> {
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for reading in readings {
        taken.push((reading.target, reading.force));
        if (reading.target - taken[0].0).abs() > least && taken.len() > 1 {
            #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
            let count = taken.len() as f64;
            let (x, r) = taken.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
            let (both, own) = taken.iter().fold((0.0, 0.0), |(both, own), point| {
                (both + (point.0 - x) * (point.1 - r), own + (point.0 - x) * (point.0 - x))
            });
            return (own > 0.0).then(|| both / own);
        }
    }
    None
}

/// A way near the recorded one, as the record's own metres and newtons tell it.
#[derive(Clone, Copy, Debug)]
pub struct Walk<'a> {
    path: &'a RecordedPath,
    step: usize,
    branch: usize,
    /// Of the branch it is on, against where it was recorded: m and N.
    along: f64,
    raised: f64,
    /// The last place, m.
    place: f64,
}

impl Walk<'_> {
    /// The recorded reading of this step; past the end of the record, of its last.
    #[must_use]
    pub fn recorded(&self) -> &Reading {
        &self.path.readings[self.nearest()]
    }

    /// Displacement (m) and force (N) where it is.
    #[must_use]
    pub fn here(&self) -> (f64, f64) {
        let (displacement, force) = self.path.at(self.branch, self.nearest(), self.place - self.along);
        (displacement + self.along, force + self.raised)
    }

    /// Goes to the place of the next step, m: displacement (m) and force (N) there.
    pub fn move_to(&mut self, place: f64) -> (f64, f64) {
        self.step += 1;
        let branch = self.path.branch_of[self.nearest()];
        while self.branch < branch {
            let (before, after) = (self.path.branches[self.branch], self.path.branches[self.branch + 1]);
            let turned_off = self.place - self.along - self.path.readings[before.last].target;
            let (ends, starts) = (before.end_tangent, after.start_tangent);
            let (fallen, most) = (starts - ends, starts - self.path.least_tangent);
            let plastic = if fallen > 0.0 && most > 0.0 { (fallen / most).min(1.0) } else { 0.0 };
            self.raised += (plastic * starts - fallen) * turned_off;
            self.along += plastic * turned_off;
            self.branch += 1;
        }
        self.place = place;
        self.here()
    }

    /// The step of the record that is looked from: past its end, its last.
    fn nearest(&self) -> usize {
        self.step.min(self.path.readings.len() - 1)
    }
}

/// The way as it is taken again.
#[derive(Clone, Debug)]
pub struct Again<'a> {
    walk: Walk<'a>,
    distortion: Distortion,
}

impl Again<'_> {
    /// Where it begins (m), and what is read there: displacement (m) and force (N).
    #[must_use]
    pub fn start(&self) -> (f64, f64, f64) {
        let (displacement, force) = self.told(self.walk.here());
        (self.walk.place * self.distortion.displacement_scale, displacement, force)
    }

    /// Displacement (m) and force (N) read at the target of the next step, m.
    pub fn move_to(&mut self, target: f64) -> (f64, f64) {
        let there = self.walk.move_to(target / self.distortion.displacement_scale);
        self.told(there)
    }

    fn told(&self, (displacement, force): (f64, f64)) -> (f64, f64) {
        let Distortion { force_scale, displacement_scale, zero, noise } = self.distortion;
        let (mut displacement, mut force) = (displacement_scale * displacement, force_scale * force + zero);
        if let Some(noise) = noise {
            let [of_force, of_displacement] = noise.errors(self.walk.step as u64, 0);
            force += of_force;
            displacement += of_displacement;
        }
        (displacement, force)
    }
}

/// Bits of a step in a draw, the same in every run: the finaliser of `SplitMix64` (Steele, Lea and Flood 2014).
fn drawn(draw: u16, step: u64) -> u64 {
    let mut bits = (u64::from(draw) << 48 ^ step).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(force: impl Fn(f64) -> f64, targets: &[f64]) -> RecordedPath {
        let reading = |target: &f64| Reading { target: *target, displacement: target + 1e-4, force: force(*target) };
        RecordedPath::new(targets.iter().map(reading).collect(), 1000.0, 0.0, 0.0).unwrap()
    }

    /// Out, back and out again, with a pause at the start.
    const TARGETS: [f64; 9] = [0.0, 0.0, 0.1, 0.3, 0.35, 0.2, 0.05, 0.1, 0.4];

    #[test]
    fn at_the_recorded_targets_the_recorded_readings_come_back_to_the_bit() {
        let path = path(|x| 1000.0 * x + 5.0 * (1e3 * x).sin(), &TARGETS);
        let mut again = path.again(Distortion::NONE);
        assert_eq!(again.start(), (TARGETS[0], path.readings[0].displacement, path.readings[0].force));
        for (target, reading) in TARGETS.iter().zip(&path.readings).skip(1) {
            assert_eq!(again.move_to(*target), (reading.displacement, reading.force));
        }
    }

    /// Forth past yield, back past yield, forth again, and turned elsewhere each time: kinematic hardening, whose loop lies
    /// between two lines of 100 N/m, 40 N off the middle, and yields where it meets them.
    #[test]
    fn turned_elsewhere_it_yields_backwards_where_its_loop_went() {
        const STEP: f64 = 1e-3;
        let drive = |turns: [f64; 3]| {
            let mut place: f64 = 0.0;
            let mut places = vec![0.0];
            for turn in turns {
                for _ in 0..2000 {
                    if (turn - place).abs() < 0.5 * STEP {
                        break;
                    }
                    place += STEP * (turn - place).signum();
                    places.push(place);
                }
                place = turn;
                places.pop();
                places.push(place);
            }
            places
        };
        let bend = |places: &[f64]| {
            let (mut force, mut last) = (0.0_f64, 0.0);
            let bent = |place: &f64| {
                force = (force + 1000.0 * (place - last)).clamp(100.0 * place - 40.0, 100.0 * place + 40.0);
                last = *place;
                force
            };
            places.iter().map(bent).collect::<Vec<f64>>()
        };
        let places = drive([0.3, -0.2, 0.25]);
        let readings = places.iter().zip(bend(&places));
        let readings = readings.map(|(target, force)| Reading { target: *target, displacement: *target, force }).collect();
        let path = RecordedPath::new(readings, 1000.0, 0.0, 0.0).unwrap();
        // As many steps, each way a little longer or shorter.
        let other: Vec<f64> = places.iter().map(|place| place * 1.02 + 1e-3 * (7.0 * place).cos() - 1e-3).collect();
        let mut walk = path.walk();
        for (step, (place, by_hand)) in other.iter().zip(bend(&other)).enumerate().skip(1) {
            let (_, force) = walk.move_to(*place);
            // Within the step in which it yields, a recorded line is cut short.
            assert!((force - by_hand).abs() < 1000.0 * STEP, "step {step} at {place}: {force}, by hand {by_hand}");
        }
        let (_, end) = walk.here();
        assert!((end - bend(&other).last().unwrap()).abs() < 1e-9, "{end}");
    }

    /// Wherever it is taken, and past its end, an elastic specimen stays elastic.
    #[test]
    fn an_elastic_way_taken_off_its_targets_is_elastic() {
        let path = path(|x| 1000.0 * x, &TARGETS);
        let mut again = path.again(Distortion { displacement_scale: 1.25, force_scale: 2.0, zero: 3.0, noise: None });
        for (step, target) in (0..).zip(TARGETS.iter().chain(&[0.5, 0.6, -0.2])).skip(1) {
            let off = target + 0.02 * f64::from(step).cos();
            let (displacement, force) = again.move_to(off);
            assert!((force - (1600.0 * off + 3.0)).abs() < 1e-9, "step {step}: {force}");
            assert!((displacement - off - 1.25e-4).abs() < 1e-12);
        }
    }

    /// Yield at 0.2 m, 100 N/m past it, back with 1000 N/m: turned elsewhere, it comes back along R = `R_m` − K(`X_m` − X) of
    /// the new turning point.
    #[test]
    fn turned_elsewhere_a_yielding_specimen_comes_back_on_its_own_line() {
        let loading = |x: f64| if x < 0.2 { 1000.0 * x } else { 200.0 + 100.0 * (x - 0.2) };
        let back = |x: f64| loading(0.5) - 1000.0 * (0.5 - x);
        let readings = [
            (0.0, loading(0.0)),
            (0.2, loading(0.2)),
            (0.4, loading(0.4)),
            (0.5, loading(0.5)),
            (0.45, back(0.45)),
            (0.4, back(0.4)),
        ];
        let readings = readings.map(|(target, force)| Reading { target, displacement: target, force }).to_vec();
        let path = RecordedPath::new(readings, 1000.0, 0.0, 0.0).unwrap();
        for turned in [0.49, 0.5, 0.51, 0.53] {
            let mut again = path.again(Distortion::NONE);
            for target in [0.21, 0.41, turned] {
                assert!((again.move_to(target).1 - loading(target)).abs() < 1e-9, "{turned}");
            }
            for target in [0.46, 0.39] {
                let by_hand = loading(turned) - 1000.0 * (turned - target);
                let (_, force) = again.move_to(target);
                assert!((force - by_hand).abs() < 1e-9, "{turned}: {force} {by_hand}");
            }
        }
    }

    /// Noise on short pieces makes no stiffness: past the end it goes on with the slope of what spans enough.
    #[test]
    fn noise_makes_no_tangent() {
        let readings = |step: u32| {
            let target = 1e-3 * f64::from(step);
            let noise = if step.is_multiple_of(2) { 1.0 } else { -1.0 };
            Reading { target, displacement: target, force: 1000.0 * target + noise }
        };
        let path = RecordedPath::new((0..200).map(readings).collect(), 1000.0, 1.0, 0.0).unwrap();
        let mut again = path.again(Distortion::NONE);
        for step in 1..200 {
            again.move_to(1e-3 * f64::from(step));
        }
        let (_, force) = again.move_to(0.3);
        assert!((force - 300.0).abs() < 12.0, "{force}");
    }

    #[test]
    fn draws_differ_and_have_both_signs_alike() {
        let sum = |draw: u16| (0..1000).map(|step| if drawn(draw, step) & 1 == 0 { 1 } else { -1 }).sum::<i32>();
        for draw in 0..8 {
            assert!(sum(draw).abs() < 110, "draw {draw}: {}", sum(draw));
        }
        let both: i32 = (0..1000).map(|step| if (drawn(3, step) ^ drawn(4, step)) & 1 == 0 { 1 } else { -1 }).sum();
        assert!(both.abs() < 110, "{both}");
    }
}
