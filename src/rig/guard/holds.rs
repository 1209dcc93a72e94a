//! Dwells: settled readings at one position, with time between them. In: readings that passed the guard. Out: rates of force and
//! displacement during the dwells. It reads nothing itself and assesses nothing.
//!
//! In a dwell a force changes by zero drift and by relaxation. The sign of the relaxation is known in one case. Let a specimen be a
//! spring in parallel with Maxwell branches, f = k·d + Σ bᵢ with bᵢ = kᵢ·(d(t) − ∫ e^(−(t−s)/τᵢ)·d(s) ds/τᵢ). Each branch force is its
//! stiffness times the difference of d and a weighted mean of the displacement since the specimen rested at 0. At a displacement beyond
//! all earlier ones, that mean is not larger than d, and every bᵢ ≥ 0. At rest all bᵢ decay to 0: the force can only decrease. A force
//! that increases there is zero drift. After an unloading the force may increase by relaxation, so those dwells are reported and not
//! assessed. The same applies to frames, because their storey drifts are not largest when their floor displacements are.

use super::Guard;
use crate::{Held, Reading};

/// The dwells so far.
#[derive(Debug)]
pub(super) struct Holds {
    /// Shorter dwells are not evaluated \[s\].
    least: f64,
    /// The unloaded position, and the farthest positions on either side of it \[m\].
    home: f64,
    low: f64,
    high: f64,
    /// The first and the last reading of this dwell.
    now: Option<(Reading, Reading)>,
    /// +1 or −1 if the specimen is farther from its unloaded position than ever before, else 0.
    outward: f64,
    completed: Held,
}

impl Holds {
    fn from(home: &[f64], least: f64) -> Self {
        let start = home.first().copied().unwrap_or(0.0);
        let completed = Held {
            slopes: vec![(0.0, 0.0); home.len()],
            ..Held::default()
        };
        Self {
            least,
            home: start,
            low: start,
            high: start,
            now: None,
            outward: 0.0,
            completed,
        }
    }

    /// A settled reading at this target \[m\].
    pub(super) fn see(&mut self, commanded: &[f64], reading: &Reading) {
        if let Some((_, last)) = &mut self.now {
            last.clone_from(reading);
            return;
        }
        self.outward = match commanded {
            [position] if *position > self.home && *position >= self.high => 1.0,
            [position] if *position < self.home && *position <= self.low => -1.0,
            _ => 0.0,
        };
        self.now = Some((reading.clone(), reading.clone()));
    }

    /// The rig leaves this target \[m\].
    pub(super) fn leave(&mut self, commanded: &[f64]) {
        self.completed = self.so_far();
        self.now = None;
        if let Some(position) = commanded.first() {
            (self.low, self.high) = (self.low.min(*position), self.high.max(*position));
        }
    }

    /// Includes the dwell that is still in progress.
    fn so_far(&self) -> Held {
        let mut completed = self.completed.clone();
        let Some((first, last)) = &self.now else {
            return completed;
        };
        let seconds = last.time - first.time;
        if seconds.is_nan() || seconds <= 0.0 || seconds < self.least {
            return completed;
        }
        completed.count += 1;
        completed.longest = completed.longest.max(seconds);
        let of = |one: &[f64], other: &[f64], axis: usize| other[axis] - one[axis];
        for (axis, (force, displacement)) in completed.slopes.iter_mut().enumerate() {
            faster(force, of(&first.force, &last.force, axis) / seconds);
            faster(
                displacement,
                of(&first.displacement, &last.displacement, axis) / seconds,
            );
        }
        if self.outward != 0.0 {
            let grown = self.outward * of(&first.force, &last.force, 0);
            completed.grown = Some(completed.grown.map_or(grown, |most| most.max(grown)));
        }
        completed
    }
}

fn faster(fastest: &mut f64, slope: f64) {
    if slope.abs() > fastest.abs() {
        *fastest = slope;
    }
}

impl Guard<'_> {
    /// Evaluates dwells of at least this length \[s\] from here on; the present position is unloaded.
    pub fn watch_holds(&mut self, least: f64) {
        self.holds = Some(Holds::from(&self.commanded, least));
    }

    /// Whether dwells are evaluated.
    #[must_use]
    pub const fn watches_holds(&self) -> bool {
        self.holds.is_some()
    }

    /// The results of the dwells. No dwell is evaluated after this call.
    pub fn take_held(&mut self) -> Held {
        self.holds
            .take()
            .map_or_else(Held::default, |holds| holds.so_far())
    }

    /// The rig leaves its present position.
    pub(super) fn leave(&mut self) {
        self.settled = false;
        if let Some(holds) = &mut self.holds {
            holds.leave(&self.commanded);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reading(time: f64, force: f64) -> Reading {
        Reading {
            time,
            displacement: vec![1e-6 * time],
            force: vec![force],
            raw: Vec::new(),
        }
    }

    /// Dwells at these positions \[m\], each of two seconds in which the force changes by this amount \[N\].
    fn held(holds: &[(f64, f64)]) -> Held {
        let mut dwells = Holds::from(&[0.0], 1.0);
        for (number, (position, change)) in (0_u32..).zip(holds) {
            let time = 10.0 * f64::from(number);
            for (later, force) in [(0.0, 100.0), (1.0, 500.0), (2.0, 100.0 + change)] {
                dwells.see(&[*position], &reading(time + later, force));
            }
            dwells.leave(&[*position]);
        }
        dwells.so_far()
    }

    #[test]
    fn slopes_are_reported_of_every_dwell_and_growth_only_at_the_largest_displacement() {
        let dwells = held(&[
            (0.001, -4.0),
            (0.003, -1.0),
            (0.002, 7.0),
            (-0.001, 0.5),
            (0.003, 0.25),
        ]);
        assert_eq!((dwells.count, dwells.longest), (5, 2.0));
        assert!(
            (dwells.slopes[0].0 - 3.5).abs() < 1e-12 && (dwells.slopes[0].1 - 1e-6).abs() < 1e-18
        );
        // On the other side, a force whose absolute value increases has a negative rate.
        assert_eq!(
            dwells.grown,
            Some(0.25),
            "only the one after the unloading is reported"
        );
        assert_eq!(held(&[(-0.001, -0.5)]).grown, Some(0.5));
        assert_eq!(
            held(&[(0.0, 3.0)]).grown,
            None,
            "where it began nothing relaxes and nothing loads"
        );
    }

    #[test]
    fn a_short_dwell_shows_nothing_and_a_longer_one_does() {
        let mut dwells = Holds::from(&[0.0], 1.5);
        dwells.see(&[0.001], &reading(0.0, 1.0));
        dwells.see(&[0.001], &reading(1.0, 2.0));
        assert_eq!(
            dwells.so_far(),
            Held {
                slopes: vec![(0.0, 0.0)],
                ..Held::default()
            }
        );
        dwells.see(&[0.001], &reading(2.0, 3.0));
        assert_eq!(
            (dwells.so_far().count, dwells.so_far().grown),
            (1, Some(2.0))
        );
        assert_eq!(dwells.so_far().count, 1, "asking changes nothing");
    }
}
