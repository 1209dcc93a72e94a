//! All that relaxes with a specimen: branches beside it, and what it loses of its own force. In: a behaviour, then how it was
//! moved, in time, and its force. Out: what the load cell feels more. The rigs carry it, for a behaviour knows nothing of time.

use super::logarithmic::{LossOfReached, Went};
use super::maxwell::{MaxwellBranch, Travel};
use crate::specimen::Behaviour;
use crate::specimen::{RestoringForce, SpecimenModel};

/// Within a move a force that is off the line between its ends by less than this share of them follows the way.
const STRAIGHT: f64 = 1e-7;
/// A move is halved so often at most: what a corner then takes part in is a millionth of it.
const MOST_HALVES: u32 = 20;

/// What the load cell feels beside the behaviour that was moved.
#[derive(Clone, Debug, Default)]
pub struct Relaxing {
    /// The outermost first.
    beside: Vec<MaxwellBranch>,
    lost: Option<LossOfReached>,
}

impl Relaxing {
    /// Of a specimen that nobody has moved yet.
    #[must_use]
    pub fn of(behaviour: &Behaviour) -> Self {
        let mut left = behaviour;
        let mut beside = Vec::new();
        while let Behaviour::Maxwell {
            of,
            stiffness,
            time_constant,
        } = left
        {
            beside.push(MaxwellBranch::new(*stiffness, *time_constant));
            left = of;
        }
        let lost = match left {
            Behaviour::Logarithmic {
                of,
                share,
                reference_time,
                longest,
            } => Some(LossOfReached::new(
                *share,
                *reference_time,
                *longest,
                of.largest_stiffness(),
            )),
            _ => None,
        };
        Self { beside, lost }
    }

    /// Whether nothing relaxes.
    #[must_use]
    pub const fn is_none(&self) -> bool {
        self.beside.is_empty() && self.lost.is_none()
    }

    /// Moves the specimen as `travel` says, from one place to another (m), and follows it; `force` is what it has there without this, N. Its
    /// force at the end. What a specimen loses of its own force hangs on how that came to be: a move on which it yields is followed in parts,
    /// so that the size of the moves changes nothing.
    pub fn bend(
        &mut self,
        specimen: &mut SpecimenModel,
        travel: &Travel,
        (from, to): (f64, f64),
        force: f64,
    ) -> f64 {
        for branch in &mut self.beside {
            branch.follow(travel);
        }
        let begun = self.lost.is_some().then(|| specimen.clone());
        let reached = if from == to {
            force
        } else {
            specimen.move_to(to)
        };
        if let (Some(lost), Some(begun)) = (&mut self.lost, begun) {
            let ends = [
                End {
                    time: 0.0,
                    place: from,
                    force,
                },
                End {
                    time: travel.seconds,
                    place: to,
                    force: reached,
                },
            ];
            follow(lost, begun, travel, (from, ends), MOST_HALVES);
        }
        reached
    }

    /// N, beside the specimen's own.
    #[must_use]
    pub fn force(&self) -> f64 {
        let beside: f64 = self.beside.iter().map(MaxwellBranch::force).sum();
        self.lost
            .as_ref()
            .map_or(beside, |lost| beside + lost.force())
    }

    /// What it adds to the stiffness of a fast move, N/m.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.beside.iter().map(MaxwellBranch::stiffness).sum()
    }

    /// All that dies away at rest.
    pub fn dying(&self) -> impl Iterator<Item = &MaxwellBranch> {
        self.beside
            .iter()
            .chain(self.lost.iter().flat_map(LossOfReached::branches))
    }
}

/// Where a part of a move begins or ends.
#[derive(Clone, Copy)]
struct End {
    /// s from the begin of the move.
    time: f64,
    /// m
    place: f64,
    /// N
    force: f64,
}

/// Follows the part of a move between two ends, in halves where its force does not follow the way; `specimen` is as it was at the first end,
/// and the move began at `origin`, m.
fn follow(
    lost: &mut LossOfReached,
    mut specimen: SpecimenModel,
    travel: &Travel,
    (origin, [begin, end]): (f64, [End; 2]),
    halves: u32,
) {
    let at = |share: f64, specimen: &mut SpecimenModel| {
        let time = begin.time + share * (end.time - begin.time);
        let place = origin + travel.way(time);
        End {
            time,
            place,
            force: specimen.move_to(place),
        }
    };
    let moved = end.place - begin.place;
    if halves > 0 && moved != 0.0 && end.time > begin.time {
        let quarter = at(0.25, &mut specimen.clone());
        let mut halfway = specimen.clone();
        let half = at(0.5, &mut halfway);
        let allowed = STRAIGHT * begin.force.abs().max(end.force.abs());
        let bent = |at: &End| {
            let on_line =
                begin.force + (end.force - begin.force) * (at.place - begin.place) / moved;
            (at.force - on_line).abs() > allowed
        };
        if bent(&quarter) || bent(&half) {
            follow(lost, specimen, travel, (origin, [begin, half]), halves - 1);
            follow(lost, halfway, travel, (origin, [half, end]), halves - 1);
            return;
        }
    }
    specimen.move_to(end.place);
    lost.follow(
        &travel.part(begin.time, end.time),
        Went {
            moved,
            force: end.force,
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What `way` (m) in `moves` evenly in `seconds`, and a rest as long, lose of 2 kN/mm that yields at 6 kN.
    fn lost(of: &Behaviour, way: f64, moves: u32, seconds: f64) -> f64 {
        let behaviour = Behaviour::Logarithmic {
            of: Box::new(of.clone()),
            share: 0.05,
            reference_time: 0.4,
            longest: 1e12,
        };
        let (mut relaxing, mut specimen, mut force) =
            (Relaxing::of(&behaviour), SpecimenModel::new(of), 0.0);
        let place = |index: u32| way * f64::from(index) / f64::from(moves);
        for index in 0..moves {
            let travel = Travel::even(way / seconds, seconds / f64::from(moves));
            force = relaxing.bend(
                &mut specimen,
                &travel,
                (place(index), place(index + 1)),
                force,
            );
        }
        relaxing.bend(&mut specimen, &Travel::rest(seconds), (way, way), force);
        relaxing.force()
    }

    /// One move on which it yields, or turns round within its loop, is as many small ones; of a plastic force by hand: it comes evenly over
    /// a quarter of the way, and is held for the rest of it and then for as long again.
    #[test]
    fn what_is_lost_does_not_hang_on_the_size_of_the_moves() {
        let plastic = Behaviour::Bilinear {
            stiffness: 2e6,
            yield_force: 6e3,
            hardening: 0.0,
        };
        let wen = Behaviour::BoucWen {
            stiffness: 2e6,
            yield_force: 6e3,
            hardening: 0.1,
            sharpness: 2.0,
            beta: 0.6,
        };
        let by_hand = -6e3
            * 0.05
            * crate::relaxation::law::RelaxationLaw::Logarithmic.lost(90.0 + 120.0, 30.0, 0.4);
        assert!(
            (lost(&plastic, 0.012, 1, 120.0) - by_hand).abs() < 1e-4,
            "{} N, by hand {by_hand} N",
            lost(&plastic, 0.012, 1, 120.0)
        );
        for of in [plastic, wen] {
            let small = lost(&of, 0.012, 4000, 120.0);
            for moves in [1, 3, 4, 7, 120] {
                let found = lost(&of, 0.012, moves, 120.0);
                assert!(
                    (found - small).abs() < 2e-5 * small.abs(),
                    "{moves} moves: {found} N, of 4000 {small} N"
                );
            }
        }
    }

    /// A piston that lags and comes to rest: the parts of its travel are the whole.
    #[test]
    fn the_parts_of_a_travel_are_the_whole() {
        let start = crate::tracking::trajectory::Rate {
            velocity: 0.01,
            acceleration: -0.04,
            jerk: 0.3,
        };
        let travel = Travel {
            start,
            fading: -0.02,
            lag: 0.05,
            seconds: 0.5,
        };
        let parts = [0.0, 0.1, 0.37, 0.5]
            .windows(2)
            .map(|ends| travel.part(ends[0], ends[1]))
            .collect::<Vec<Travel>>();
        let sum: f64 = parts.iter().map(|part| part.way(part.seconds)).sum();
        assert!((sum - travel.way(0.5)).abs() < 1e-15);
        let (mut whole, mut by_parts) =
            (MaxwellBranch::new(1e3, 0.2), MaxwellBranch::new(1e3, 0.2));
        whole.follow(&travel);
        for part in &parts {
            by_parts.follow(part);
        }
        assert!((whole.force() - by_parts.force()).abs() < 1e-12);
    }
}
