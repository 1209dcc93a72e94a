//! Ways of several moves: what the plan asks for as one, a limited increment makes several. In: where the rig stands, where it
//! is to go. Out: targets, none farther from the one before than the limit. It moves nothing.

use super::{Guard, increment};

/// Moves of one way, at most.
const MOST: f64 = 1e5;

impl Guard<'_> {
    /// The targets on the way to `targets`, in equal increments none of which is longer than the limit; the last is
    /// `targets` itself.
    #[must_use]
    pub fn way_to(&self, targets: &[f64]) -> Vec<Vec<f64>> {
        let longest = targets
            .iter()
            .zip(&self.commanded)
            .map(|(to, from)| (to - from).abs())
            .fold(0.0, f64::max);
        let parts = (longest / self.limits.increment.high * (1.0 - 4.0 * f64::EPSILON))
            .ceil()
            .max(1.0);
        // A limit of nothing allows no way at all: the one move is then refused as it should be.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and 1e5"
        )]
        let parts = if parts <= MOST { parts as u32 } else { 1 };
        let way = self.way_in(parts, targets);
        // Places far from 0 are rounded more coarsely than a short increment near 0 allows for: in one more they fit.
        if parts == 1 || self.fits(&way) {
            way
        } else {
            self.way_in(parts + 1, targets)
        }
    }

    fn way_in(&self, parts: u32, targets: &[f64]) -> Vec<Vec<f64>> {
        let between = (1..parts).map(|part| {
            let fraction = f64::from(part) / f64::from(parts);
            self.commanded
                .iter()
                .zip(targets)
                .map(|(from, to)| from + (to - from) * fraction)
                .collect()
        });
        between.chain(std::iter::once(targets.to_vec())).collect()
    }

    /// Whether no step of a way is longer than the limit.
    fn fits(&self, way: &[Vec<f64>]) -> bool {
        let limit = self.limits.increment;
        let steps = std::iter::once(&self.commanded).chain(way).zip(way);
        steps
            .flat_map(|(from, to)| from.iter().zip(to))
            .all(|(from, to)| limit.contains(increment(*from, *to)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Interval, Limits};
    use crate::rig::{VirtualRig, virtual_rig};
    use crate::tests::testing::elastic_plan;

    /// Home from 10 mm by 0.1 mm, where the places before 1 mm were rounded by more than their increments.
    #[test]
    fn every_way_out_and_back_fits_its_own_limit() {
        let plan = elastic_plan(300.0, Vec::new());
        assert!(VirtualRig::specimen_of(&plan).is_some());
        for parts in 1..200_u32 {
            let high = 0.01 / f64::from(parts);
            let mut rig = virtual_rig(&plan);
            let limits = Limits {
                increment: Interval { low: 0.0, high },
                ..Limits::NONE
            };
            let mut guard = Guard::new(rig.as_mut(), limits).unwrap();
            for end in [0.01, 0.0, -0.01, 0.01] {
                let way = guard.way_to(&[end]);
                let straight = (end - guard.commanded()[0]).abs() / high;
                #[expect(clippy::cast_precision_loss, reason = "some hundred")]
                let moves = way.len() as f64;
                assert!(
                    straight.floor() <= moves && moves <= straight.ceil() + 1.0,
                    "{parts}: {moves} moves for {straight}"
                );
                for target in &way {
                    guard
                        .move_to(target, None)
                        .unwrap_or_else(|fault| panic!("{parts}: {fault}"));
                }
                assert_eq!(guard.commanded(), [end]);
            }
        }
    }
}
