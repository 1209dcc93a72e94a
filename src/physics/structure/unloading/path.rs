//! The moves that unload a frame, one after the other, without loading it in the opposite direction. In: the expected slopes, then
//! displacements and forces of the floors. Out: the next move of each floor. It moves nothing.
//!
//! A specimen may unload with a stiffness above or below that of loading, or first by the jump of its friction. A first short move shows
//! the slope. Each further move then removes most of the remaining load, with the larger of the measured and the expected slope. Once
//! little load remains and the slope is not stiffer than the one before it, one move removes the rest. If the unloading branch softens,
//! as that of specimens does, no move passes the unloaded position.
//!
//! An unloading branch that is much softer than expected would need hundreds of such moves. Once two moves agree, the moves grow with the
//! length over which the slope is known. A branch that then stiffens to the expected slope is loaded in the opposite direction by less
//! than `LITTLE` of the load at the start.

use super::line::Line;
use super::{BELIEVED, Loaded, Unloading};
use crate::integrator::tangent::NOISE_MULTIPLE;
use crate::statistics::DeclaredNoise;
use crate::statistics::samples::peak;

/// PathPart of the load that the first move removes, by the expected slope: the unloading branch may be this much stiffer.
const FIRST: f64 = 1.0 / BELIEVED;
/// PathPart that every further move removes: the error of a slope by noise then has a ninth of its effect, at most.
const FURTHER: f64 = 0.9;
/// A slope is not stiffer unless it exceeds the one before it by this factor.
const STIFFER: f64 = 1.1;
/// Fraction of the load at the start: one move removes so small a load if the slope is known.
const LITTLE: f64 = 0.3;
/// As `LITTLE`, with the measured slope, even if a stiffer one was expected.
const LEAST: f64 = 0.1;
/// A move is at most this part of the length over which the slope is known, if it is longer than the expected slope allows.
const GROWTH: f64 = 0.25;
/// Standard deviations of a load that are no load.
const NOISE: f64 = 3.0;

/// State of the unloading, storey by storey or element by element; of all floors as one for a frame that is not a shear building.
#[derive(Clone, Debug)]
pub struct UnloadingPath {
    unloading: Unloading,
    parts: Vec<PathPart>,
}

/// A storey or an element. For all floors as one, the load is the largest force and the move is counted in loads: their expected slope is 1.
#[derive(Clone, Debug)]
struct PathPart {
    /// \[N/m\]
    expected: f64,
    /// By the last move that determined it \[N/m\].
    slope: f64,
    /// Whether that slope was no stiffer than the one before.
    falls: bool,
    moved: bool,
    /// Load at the start \[N\].
    start: f64,
    /// Storey drift \[m\] and load \[N\] from which the slope is determined.
    last_significant: (f64, f64),
    line: Line,
    /// Noise of the load \[N\] and of the storey drift \[m\].
    noise: (f64, f64),
}

impl UnloadingPath {
    /// `force` \[N\] and `displacement` \[m\]: standard deviations of a reading of one floor.
    #[must_use]
    pub fn new(unloading: Unloading, noise: DeclaredNoise, at: Loaded<'_>) -> Self {
        let DeclaredNoise {
            force,
            resolution: displacement,
        } = noise;
        let part = |expected: f64, last_significant: (f64, f64), noise: (f64, f64)| PathPart {
            expected,
            slope: expected,
            falls: false,
            moved: false,
            start: last_significant.1,
            last_significant,
            line: Line::new(last_significant),
            noise,
        };
        let parts = match unloading.storeys() {
            Some(expected) => {
                let floors = expected.len();
                let of_storey = |(storey, (expected, read)): (usize, (&f64, (f64, f64)))| {
                    let is_stacked = unloading.is_stacked();
                    #[expect(clippy::cast_precision_loss, reason = "some storeys")]
                    let above = if is_stacked {
                        (floors - storey) as f64
                    } else {
                        1.0
                    };
                    let is_difference = is_stacked && storey > 0;
                    let ends = if is_difference { 2.0_f64 } else { 1.0 };
                    part(
                        *expected,
                        read,
                        (force * above.sqrt(), displacement * ends.sqrt()),
                    )
                };
                expected
                    .iter()
                    .zip(unloading.parts_at(at))
                    .enumerate()
                    .map(of_storey)
                    .collect()
            }
            None => vec![part(
                1.0,
                (0.0, peak(at.force)),
                (force, unloading.force_of(displacement)),
            )],
        };
        Self { unloading, parts }
    }

    /// The next move of each floor \[m\] under these forces \[N\].
    #[must_use]
    pub fn moves(&self, force: &[f64]) -> Vec<f64> {
        if self.unloading.storeys().is_none() {
            let share = self.parts[0].moves(peak(force)).abs() / peak(force);
            return self
                .unloading
                .moves(force)
                .into_iter()
                .map(|moves| share * moves)
                .collect();
        }
        let loads = self.unloading.loads(force).into_iter().zip(&self.parts);
        let moves = loads.map(|(load, part)| part.moves(load));
        self.unloading.positions(moves)
    }

    /// Largest load of a part \[N\]: it falls with every effective move.
    #[must_use]
    pub fn left(&self, force: &[f64]) -> f64 {
        peak(self.loads(force))
    }

    /// Whether a part is loaded in the opposite direction by more than a little: a part held by friction is not moved to and fro.
    #[must_use]
    pub fn passed(&self, force: &[f64]) -> bool {
        let most = LEAST
            * self
                .parts
                .iter()
                .fold(0.0, |most: f64, part| most.max(part.start.abs()));
        let loads = self.loads(force);
        self.parts
            .iter()
            .zip(loads)
            .any(|(part, load)| load * part.start < 0.0 && load.abs() > most)
    }

    /// Whether every part is unloaded as far as readings show, and some part is past its unloaded position: a move back would turn the
    /// friction. A target is as uncertain as the reading before it, so the load there has the noise of two readings.
    #[must_use]
    pub fn passed_by_noise(&self, force: &[f64]) -> bool {
        let loads = self.loads(force);
        let parts = || self.parts.iter().zip(&loads);
        let is_past = |(part, load): (&PathPart, &f64)| load * part.start < 0.0;
        parts().any(is_past)
            && parts().all(|(part, load)| {
                let readings = if is_past((part, load)) { 2.0_f64 } else { 1.0 };
                load.abs() <= NOISE * readings.sqrt() * part.noise.0
            })
    }

    fn loads(&self, force: &[f64]) -> Vec<f64> {
        if self.unloading.storeys().is_none() {
            return vec![peak(force)];
        }
        self.unloading.loads(force)
    }

    /// Learns from a move between two positions. Returns the secant of each storey \[N/m\] with a change of storey drift, and none
    /// without storeys.
    pub fn learn(&mut self, from: Loaded<'_>, to: Loaded<'_>) -> Vec<Option<f64>> {
        if self.unloading.storeys().is_none() {
            let [before, after] = [from, to].map(|at| peak(at.force));
            let travel = self.parts[0].moves(before);
            let part = &mut self.parts[0];
            part.learn(part.line.last().0 + travel, after);
        } else {
            for (part, (drift, shear)) in self.parts.iter_mut().zip(self.unloading.parts_at(to)) {
                part.learn(drift, shear);
            }
        }
        self.unloading.secants(from, to)
    }
}

impl PathPart {
    /// The next move \[m\] under this load \[N\].
    fn moves(&self, load: f64) -> f64 {
        let by_noise = load.abs() <= 2.0 * NOISE_MULTIPLE * self.noise.0;
        let known_to = |part: f64| self.falls && load.abs() <= part * self.start.abs();
        let share = match (by_noise || known_to(LITTLE), self.moved) {
            (true, _) => 1.0,
            (false, true) => FURTHER,
            (false, false) => FIRST,
        };
        let Some(straight) = self.line.slope(self.noise, 0.0) else {
            let slope = if known_to(LEAST) {
                self.slope
            } else {
                self.slope.max(self.expected)
            };
            return -share * load / slope;
        };
        let most = if load.abs() <= LEAST * self.start.abs() {
            f64::INFINITY
        } else {
            (load.abs() + LITTLE * self.start.abs()) / self.expected
        };
        let safe = share * load.abs() / straight.max(self.expected);
        let far = (share * load.abs() / straight)
            .min(GROWTH * self.line.length())
            .min(most);
        -safe.max(far).copysign(load)
    }

    fn learn(&mut self, drift: f64, load: f64) {
        self.moved = true;
        self.line.learn((drift, load), self.noise);
        let (from, loaded) = self.last_significant;
        let travel = drift - from;
        if travel == 0.0
            || travel.abs() <= NOISE_MULTIPLE * self.noise.1.max(self.noise.0 / self.expected)
        {
            return;
        }
        let slope =
            ((load - loaded) / travel).clamp(self.expected / BELIEVED, BELIEVED * self.expected);
        (self.falls, self.slope) = (slope <= STIFFER * self.slope, slope);
        self.last_significant = (drift, load);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::matrix::SymmetricBand;
    use crate::structure::shear_building::storey_stiffness;

    /// Positions and forces of one degree of freedom from `start` \[m\], by its own moves, until less than a thousandth of the load
    /// remains.
    fn followed(expected: f64, start: f64, force: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let mut at = (start, force(start));
        let read = |at: &(f64, f64)| ([at.0], [at.1]);
        let (x, r) = read(&at);
        let mut path = UnloadingPath::new(
            Unloading::of_one(expected),
            DeclaredNoise::NONE,
            Loaded {
                displacement: &x,
                force: &r,
            },
        );
        let mut all = vec![at];
        while at.1.abs() > 1e-3 * all[0].1.abs() && all.len() < 40 {
            let before = at;
            let displacement = at.0 + path.moves(&[at.1])[0];
            at = (displacement, force(displacement));
            let ((x, r), (to_x, to_r)) = (read(&before), read(&at));
            let [from, to] = [(&x, &r), (&to_x, &to_r)].map(|(displacement, force)| Loaded {
                displacement,
                force,
            });
            path.learn(from, to);
            all.push(at);
        }
        all
    }

    #[test]
    fn what_is_as_stiff_as_expected_needs_three_moves() {
        let path = followed(1000.0, 0.02, |x| 1000.0 * (x - 0.005));
        assert_eq!(path.len(), 4, "{path:?}");
        assert!((path[3].0 - 0.005).abs() < 1e-15 && path.iter().all(|(_, force)| *force > -1e-12));
    }

    /// First eight times as stiff as expected, or by the jump of a friction, then softer and softer: the path never passes zero load and
    /// always ends at the same position.
    #[test]
    fn a_softening_unloading_branch_is_never_overshot() {
        let bends = |x: f64| {
            if x > 0.017 {
                40.0 + 8e4 * (x - 0.017)
            } else {
                8e3 * (x - 0.012)
            }
        };
        let jumps = |x: f64| if x >= 0.02 { 200.0 } else { 8e3 * (x - 0.012) };
        for curve in [&bends as &dyn Fn(f64) -> f64, &jumps] {
            for expected in [1e4, 2.5e4, 8e4, 1.2e5] {
                let path = followed(expected, 0.02, curve);
                let (displacement, force) = path[path.len() - 1];
                assert!(
                    path.iter().all(|(_, force)| *force > -1e-9),
                    "by {expected} N/m: {path:?}"
                );
                assert!(
                    force.abs() <= 1e-3 * path[0].1 && (displacement - 0.012).abs() < 4e-5,
                    "by {expected} N/m: {path:?}"
                );
            }
        }
    }

    /// A branch that stiffens as the load falls is not passed either, if its stiffest slope was expected.
    #[test]
    fn a_stiffening_unloading_branch_is_not_overshot_by_its_stiffest_slope() {
        let path = followed(1e6, 5e-3, |x| {
            if x > 1e-3 {
                1000.0 + 2.5e5 * (x - 1e-3)
            } else {
                1e6 * x
            }
        });
        assert!(
            path.iter().all(|(_, force)| *force > -1e-9) && path[path.len() - 1].1 <= 2.0,
            "{path:?}"
        );
    }

    /// A branch twenty times softer than expected, to its end at zero load, and a plateau that ends in the expected stiffness far from zero: that one
    /// is loaded in the opposite direction by less than the stated part of the load at the start.
    #[test]
    fn a_soft_branch_is_gone_to_its_end_and_a_plateau_not_far_beyond() {
        let soft = |x: f64| 2e4 * (x - 6e-3);
        let path = followed(4.1e5, 0.02, soft);
        assert!(
            path.len() < 40 && (path[path.len() - 1].0 - 6e-3).abs() < 2e-5,
            "{path:?}"
        );
        assert!(path.iter().all(|(_, force)| *force > -1e-9), "{path:?}");
        let ends = |x: f64| (4.1e5 * x).min(123.0 + 1e4 * (x - 3e-4));
        for start in [2e-3, 5e-3, 0.02, 0.1] {
            let path = followed(4.1e5, start, ends);
            assert!(
                path.iter().all(|(_, force)| *force > -LITTLE * path[0].1),
                "{path:?}"
            );
        }
    }

    /// Each storey by its own slope; all floors of a different frame by the stiffest one.
    #[test]
    fn floors_come_to_rest_together() {
        let braced = SymmetricBand::from_dense(&[vec![5.0, -6.0], vec![-6.0, 9.0]]).unwrap();
        for (expected, truly) in [
            (storey_stiffness(&[3.0, 2.0]), storey_stiffness(&[6.0, 1.0])),
            (
                braced.clone(),
                SymmetricBand::from_dense(&[vec![15.0, -18.0], vec![-18.0, 27.0]]).unwrap(),
            ),
        ] {
            let force_at = |displacements: &[f64]| {
                let mut force = [0.0; 2];
                truly.mul_into(displacements, &mut force);
                force
            };
            let mut displacements = vec![1.0, 1.5];
            let start = force_at(&displacements);
            let at = Loaded {
                displacement: &displacements,
                force: &start,
            };
            let mut path =
                UnloadingPath::new(Unloading::of(&expected).unwrap(), DeclaredNoise::NONE, at);
            for _ in 0..12 {
                let force = force_at(&displacements);
                if peak(force) < 1e-9 {
                    break;
                }
                let next: Vec<f64> = displacements
                    .iter()
                    .zip(path.moves(&force))
                    .map(|(displacement, moves)| displacement + moves)
                    .collect();
                let force_of = force_at(&next);
                path.learn(
                    Loaded {
                        displacement: &displacements,
                        force: &force,
                    },
                    Loaded {
                        displacement: &next,
                        force: &force_of,
                    },
                );
                displacements = next;
            }
            assert!(peak(&displacements) < 1e-9, "{displacements:?}");
        }
    }

    /// A load that noise nearly hides is removed in one move, by the expected slope.
    #[test]
    fn noise_is_no_slope() {
        let at = Loaded {
            displacement: &[0.02],
            force: &[15.0],
        };
        let path = UnloadingPath::new(
            Unloading::of_one(1000.0),
            DeclaredNoise {
                force: 1.0,
                resolution: 0.0,
            },
            at,
        );
        assert_eq!(path.moves(&[15.0]), [-0.015]);
        let mut loaded = UnloadingPath::new(
            Unloading::of_one(1000.0),
            DeclaredNoise {
                force: 1.0,
                resolution: 0.0,
            },
            Loaded {
                force: &[400.0],
                ..at
            },
        );
        assert_eq!(loaded.moves(&[400.0]), [-0.025]);
        loaded.learn(
            Loaded {
                force: &[400.0],
                ..at
            },
            Loaded {
                displacement: &[0.0195],
                force: &[400.5],
            },
        );
        assert!(
            (loaded.moves(&[400.0])[0] + 0.36).abs() < 1e-12,
            "half a millimetre shows nothing"
        );
    }
}
