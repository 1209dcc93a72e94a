//! The relaxation of a specimen: Maxwell branches in parallel with it, and the logarithmic loss of its force. In: a behaviour, then its
//! motion in time and its instantaneous force. Out: the force that a load cell measures beside it. A behaviour itself knows no time.

use super::logarithmic::{Increment, LogarithmicLoss, LogarithmicRelaxation};
use super::maxwell::{MaxwellBranch, Motion};
use crate::specimen::Behaviour;
use crate::specimen::{RestoringForce, SpecimenModel};

/// Within a move, the force is proportional to the displacement if its distance from the straight line is below this fraction.
const STRAIGHT: f64 = 1e-7;
/// Largest number of halvings of a move: the part with a yield point is then a millionth of it.
const MAX_HALVINGS: u32 = 20;

/// Displacement \[m\] of a specimen and its instantaneous (unrelaxed) force there \[N\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformed {
    pub displacement: f64,
    pub force: f64,
}

/// Force of a specimen beside its instantaneous one.
#[derive(Clone, Debug, Default)]
pub struct RelaxationState {
    /// In parallel, the outermost first.
    branches: Vec<MaxwellBranch>,
    loss: Option<LogarithmicLoss>,
}

impl RelaxationState {
    /// The state of a specimen that has not moved yet.
    #[must_use]
    pub fn new(behaviour: &Behaviour) -> Self {
        let mut inner = behaviour;
        let mut branches = Vec::new();
        while let Behaviour::Maxwell {
            of,
            stiffness,
            time_constant,
        } = inner
        {
            branches.push(MaxwellBranch::new(*stiffness, *time_constant));
            inner = of;
        }
        let loss = match inner {
            Behaviour::Logarithmic {
                of,
                share,
                reference_time,
                longest,
            } => {
                let law = LogarithmicRelaxation {
                    share: *share,
                    reference_time: *reference_time,
                    longest: *longest,
                };
                let steepest = of.largest_stiffness().unwrap_or(f64::INFINITY);
                Some(LogarithmicLoss::new(&law, steepest))
            }
            _ => None,
        };
        Self { branches, loss }
    }

    /// Whether nothing relaxes.
    #[must_use]
    pub const fn is_none(&self) -> bool {
        self.branches.is_empty() && self.loss.is_none()
    }

    /// Moves the specimen by `motion` from one displacement to another \[m\], and relaxes with it. Returns the instantaneous force at
    /// the end \[N\]. The logarithmic loss depends on the path of the force: a move on which the specimen yields is followed in parts,
    /// so that the length of the moves does not matter.
    pub fn advance(
        &mut self,
        specimen: &mut SpecimenModel,
        motion: &Motion,
        from: Deformed,
        to: f64,
    ) -> f64 {
        for branch in &mut self.branches {
            branch.follow(motion);
        }
        let at_begin = self.loss.is_some().then(|| specimen.clone());
        let force = if from.displacement == to {
            from.force
        } else {
            specimen.move_to(to)
        };
        if let (Some(loss), Some(specimen)) = (&mut self.loss, at_begin) {
            let begin = End {
                time: 0.0,
                at: from,
            };
            let end = End {
                time: motion.seconds,
                at: Deformed {
                    displacement: to,
                    force,
                },
            };
            let path = Path {
                motion,
                origin: from.displacement,
            };
            path.follow(loss, specimen, [begin, end], MAX_HALVINGS);
        }
        force
    }

    /// Force beside the instantaneous one \[N\].
    #[must_use]
    pub fn force(&self) -> f64 {
        let branches: f64 = self.branches.iter().map(MaxwellBranch::force).sum();
        self.loss
            .as_ref()
            .map_or(branches, |loss| branches + loss.force())
    }

    /// Stiffness that it adds to a fast move \[N/m\].
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.branches.iter().map(MaxwellBranch::stiffness).sum()
    }

    /// All branches whose force decays at rest.
    pub fn decaying(&self) -> impl Iterator<Item = &MaxwellBranch> {
        self.branches
            .iter()
            .chain(self.loss.iter().flat_map(LogarithmicLoss::branches))
    }
}

/// An end of a part of a move.
#[derive(Clone, Copy)]
struct End {
    /// Since the begin of the move \[s\].
    time: f64,
    at: Deformed,
}

/// The path of a move that begins at `origin` \[m\].
struct Path<'a> {
    motion: &'a Motion,
    origin: f64,
}

impl Path<'_> {
    /// Follows the part between two ends, in halves where the force is not proportional to the displacement; `specimen` is in its state
    /// at the first end.
    fn follow(
        &self,
        loss: &mut LogarithmicLoss,
        mut specimen: SpecimenModel,
        [begin, end]: [End; 2],
        halvings: u32,
    ) {
        let moved = end.at.displacement - begin.at.displacement;
        if halvings > 0 && moved != 0.0 && end.time > begin.time {
            let between = |fraction: f64, specimen: &mut SpecimenModel| {
                let time = begin.time + fraction * (end.time - begin.time);
                let displacement = self.origin + self.motion.displacement(time);
                let force = specimen.move_to(displacement);
                End {
                    time,
                    at: Deformed {
                        displacement,
                        force,
                    },
                }
            };
            let quarter = between(0.25, &mut specimen.clone());
            let mut halfway = specimen.clone();
            let half = between(0.5, &mut halfway);
            let allowed = STRAIGHT * begin.at.force.abs().max(end.at.force.abs());
            let bends = |point: Deformed| {
                let on_line = begin.at.force
                    + (end.at.force - begin.at.force)
                        * (point.displacement - begin.at.displacement)
                        / moved;
                (point.force - on_line).abs() > allowed
            };
            if bends(quarter.at) || bends(half.at) {
                self.follow(loss, specimen, [begin, half], halvings - 1);
                self.follow(loss, halfway, [half, end], halvings - 1);
                return;
            }
        }
        specimen.move_to(end.at.displacement);
        loss.follow(
            &self.motion.part(begin.time, end.time),
            Increment {
                moved,
                force: end.at.force,
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loss of a specimen of 2 kN/mm that yields at 6 kN, over `distance` \[m\] in `moves` at constant velocity in `seconds` and a rest
    /// of the same time.
    fn lost(inner: &Behaviour, distance: f64, moves: u32, seconds: f64) -> f64 {
        let behaviour = Behaviour::Logarithmic {
            of: Box::new(inner.clone()),
            share: 0.05,
            reference_time: 0.4,
            longest: 1e12,
        };
        let (mut relaxation, mut specimen) =
            (RelaxationState::new(&behaviour), SpecimenModel::new(inner));
        let position = |index: u32| distance * f64::from(index) / f64::from(moves);
        let motion = Motion::even(distance / seconds, seconds / f64::from(moves));
        let mut force = 0.0;
        for index in 0..moves {
            let from = Deformed {
                displacement: position(index),
                force,
            };
            force = relaxation.advance(&mut specimen, &motion, from, position(index + 1));
        }
        let from = Deformed {
            displacement: distance,
            force,
        };
        relaxation.advance(&mut specimen, &Motion::rest(seconds), from, distance);
        relaxation.force()
    }

    /// One move on which the specimen yields equals many small ones. Closed form of a plastic force: it increases at a constant rate over
    /// the first quarter, is constant for the other three quarters and then for the rest.
    #[test]
    fn the_loss_does_not_depend_on_the_length_of_the_moves() {
        let plastic = Behaviour::Bilinear {
            stiffness: 2e6,
            yield_force: 6e3,
            post_yield_ratio: 0.0,
        };
        let wen = Behaviour::BoucWen {
            stiffness: 2e6,
            yield_force: 6e3,
            post_yield_ratio: 0.1,
            sharpness: 2.0,
            beta: 0.6,
        };
        let by_hand = -6e3
            * 0.05
            * crate::relaxation::law::RelaxationLaw::Logarithmic
                .timed(0.4)
                .lost(90.0 + 120.0, 30.0);
        assert!(
            (lost(&plastic, 0.012, 1, 120.0) - by_hand).abs() < 1e-4,
            "{} N, by hand {by_hand} N",
            lost(&plastic, 0.012, 1, 120.0)
        );
        for behaviour in [plastic, wen] {
            let small = lost(&behaviour, 0.012, 4000, 120.0);
            for moves in [1, 3, 4, 7, 120] {
                let found = lost(&behaviour, 0.012, moves, 120.0);
                assert!(
                    (found - small).abs() < 2e-5 * small.abs(),
                    "{moves} moves: {found} N, of 4000 {small} N"
                );
            }
        }
    }

    /// An actuator that lags and then stops.
    #[test]
    fn the_parts_of_a_motion_add_up_to_the_whole() {
        let start = crate::tracking::trajectory::Rate {
            velocity: 0.01,
            acceleration: -0.04,
            jerk: 0.3,
        };
        let motion = Motion {
            start,
            fading: -0.02,
            lag: 0.05,
            seconds: 0.5,
        };
        let parts = [0.0, 0.1, 0.37, 0.5]
            .windows(2)
            .map(|ends| motion.part(ends[0], ends[1]))
            .collect::<Vec<Motion>>();
        let sum: f64 = parts
            .iter()
            .map(|part| part.displacement(part.seconds))
            .sum();
        assert!((sum - motion.displacement(0.5)).abs() < 1e-15);
        let (mut whole, mut by_parts) =
            (MaxwellBranch::new(1e3, 0.2), MaxwellBranch::new(1e3, 0.2));
        whole.follow(&motion);
        for part in &parts {
            by_parts.follow(part);
        }
        assert!((whole.force() - by_parts.force()).abs() < 1e-12);
    }
}
