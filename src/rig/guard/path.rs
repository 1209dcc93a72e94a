//! Motions of several moves: a limit of the increment divides one requested motion into several. In: the position of the
//! rig and its target. Out: targets whose increments are inside the limit. It moves nothing.

use super::{Guard, increment};
use psd_physics::tracking::trajectory::longest_travel;

/// Largest number of moves of one motion.
const MOST: f64 = 1e5;

impl Guard<'_> {
    /// The targets on the path to `targets`, in equal increments that are not longer than the limit. The last is `targets`
    /// itself.
    #[must_use]
    pub fn increments_to(&self, targets: &[f64]) -> Vec<Vec<f64>> {
        let longest = longest_travel(&self.commanded, targets);
        let parts = (longest / self.limits.increment.high * (1.0 - 4.0 * f64::EPSILON))
            .ceil()
            .max(1.0);
        // A limit of zero allows no motion: the single move is then refused as it should be.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and 1e5"
        )]
        let parts = if parts <= MOST { parts as u32 } else { 1 };
        let increments = self.increments_in(parts, targets);
        // Positions far from 0 have a coarser rounding than a short increment near 0. One more increment keeps all increments inside the
        // limit.
        if parts == 1 || self.fits(&increments) {
            increments
        } else {
            self.increments_in(parts + 1, targets)
        }
    }

    fn increments_in(&self, parts: u32, targets: &[f64]) -> Vec<Vec<f64>> {
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

    /// Whether no increment is longer than the limit.
    fn fits(&self, increments: &[Vec<f64>]) -> bool {
        let limit = self.limits.increment;
        let steps = std::iter::once(&self.commanded)
            .chain(increments)
            .zip(increments);
        steps
            .flat_map(|(from, to)| from.iter().zip(to))
            .all(|(from, to)| limit.contains(increment(*from, *to)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::plans::elastic_plan;
    use crate::{VirtualRig, virtual_rig};
    use psd_plan::{Interval, Limits};

    /// Back to 0 from 10 mm in increments of 0.1 mm: rounding of the positions beyond 1 mm exceeds the tolerance of an increment.
    #[test]
    fn every_path_out_and_back_fits_its_own_limit() {
        let plan = elastic_plan(300.0, Vec::new());
        assert!(VirtualRig::specimen_of(&plan).is_some());
        for parts in 1..200_u32 {
            let high = 0.01 / f64::from(parts);
            let mut rig = virtual_rig(&plan);
            let limits = Limits {
                increment: Interval { low: 0.0, high },
                ..Limits::NONE
            };
            let mut guard = Guard::new(rig.as_mut(), limits, Vec::new()).unwrap();
            for end in [0.01, 0.0, -0.01, 0.01] {
                let increments = guard.increments_to(&[end]);
                let straight = (end - guard.commanded()[0]).abs() / high;
                #[expect(clippy::cast_precision_loss, reason = "some hundred")]
                let moves = increments.len() as f64;
                assert!(
                    straight.floor() <= moves && moves <= straight.ceil() + 1.0,
                    "{parts}: {moves} moves for {straight}"
                );
                for target in &increments {
                    guard
                        .move_to(target, None)
                        .unwrap_or_else(|fault| panic!("{parts}: {fault}"));
                }
                assert_eq!(guard.commanded(), [end]);
            }
        }
    }
}
