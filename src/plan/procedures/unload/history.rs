//! The history of an unloading: the floors after every move; one degree of freedom is one floor. In: numbers of a run, SI. It moves nothing.

use crate::record::floors::{Floors, FloorsAt, drift_of, shear_of};
use crate::uncertainty::{Contribution, share};
use psd_physics::structure::elements::ElementReading;

/// All floors after one move, from the ground up, or the elements of a frame of matrices; step 0 is the start of the unloading of a frame.
/// Of an element, displacements are deformations, and the force is its own.
#[derive(Clone, Debug, PartialEq)]
pub struct UnloadStep {
    pub step: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// Targets \[m\].
    pub command: Vec<f64>,
    /// Measured \[m\].
    pub displacement: Vec<f64>,
    /// Measured, of each floor or element \[N\].
    pub restoring_force: Vec<f64>,
    /// Secant of each storey or element from the previous step \[N/m\]; None without a change of storey drift, or for a frame without storeys.
    pub tangent_stiffness: Vec<Option<f64>>,
}

impl UnloadStep {
    /// Its readings, if they are those of elements.
    #[must_use]
    pub fn elements(&self) -> Vec<ElementReading> {
        element_readings(&self.command, &self.displacement, &self.restoring_force)
    }
}

fn element_readings(target: &[f64], deformation: &[f64], force: &[f64]) -> Vec<ElementReading> {
    let read = target.iter().zip(deformation).zip(force);
    read.map(|((target, deformation), force)| {
        ElementReading::at_rest(*target, [*deformation, *force])
    })
    .collect()
}

/// Nothing is computed here: positions are measured, times are rig times, and no recursion contains a tracking error.
impl Floors for UnloadStep {
    fn at(&self) -> FloorsAt<'_> {
        FloorsAt {
            time: self.wall_time,
            command: &self.command,
            measured: &self.displacement,
            computed: &self.displacement,
            velocity: &[],
            acceleration: &[],
            restoring_force: &self.restoring_force,
            gravity_force: &[],
            elements: &[],
            tracking: &[],
        }
    }
}

/// The moves of an unloading.
#[derive(Clone, Debug)]
pub struct UnloadHistory {
    pub of: Unloaded,
    pub steps: Vec<UnloadStep>,
}

/// The part of a specimen that an unloading moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unloaded {
    /// One degree of freedom. The start is not among the steps.
    OneAxis,
    /// All floors of a frame.
    Floors,
    /// All elements of a frame of matrices.
    Elements,
}

/// The rest position of a specimen, floor by floor or element by element; one degree of freedom is one floor.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Rest {
    /// Measured \[m\].
    pub displacement: Vec<f64>,
    /// The remaining force \[N\].
    pub force: Vec<f64>,
    /// The contribution of each source of uncertainty to the position of each floor \[m\]; empty without uncertain inputs.
    pub of_displacement: Vec<Vec<Contribution>>,
    /// The same for the remaining force \[N\].
    pub of_force: Vec<Vec<Contribution>>,
    /// The floors that stand on a computed storey: the uncertainty of their positions is not known.
    pub on_computed: Vec<usize>,
    /// The storeys that models compute: the uncertainty of their drifts is not known.
    pub computed: Vec<usize>,
    /// Why it is not the position of zero force; the uncertainty of the position is then withheld.
    pub incomplete: Option<String>,
}

impl Rest {
    /// Position \[m\] and force \[N\] of one floor.
    #[must_use]
    pub fn of(&self, floor: usize) -> (f64, f64) {
        (self.displacement[floor], self.force[floor])
    }

    /// Its readings, if they are those of elements.
    #[must_use]
    pub fn elements(&self) -> Vec<ElementReading> {
        element_readings(&self.displacement, &self.displacement, &self.force)
    }

    /// Drift of each storey \[m\].
    #[must_use]
    pub fn drift(&self) -> Vec<f64> {
        drift_of(&self.displacement)
    }

    /// Shear of each storey \[N\].
    #[must_use]
    pub fn shear(&self) -> Vec<f64> {
        shear_of(&self.force)
    }

    /// The largest position \[m\] and the largest remaining force \[N\] in absolute value, each with its sign.
    #[must_use]
    pub fn largest(&self) -> (f64, f64) {
        let [of_displacement, of_force] = self.floors_of_largest();
        (
            self.displacement
                .get(of_displacement)
                .copied()
                .unwrap_or(0.0),
            self.force.get(of_force).copied().unwrap_or(0.0),
        )
    }

    /// The floor with the largest displacement, and the one with the largest force, from 0.
    #[must_use]
    pub fn floors_of_largest(&self) -> [usize; 2] {
        let most = |values: &[f64]| {
            let sizes = values.iter().map(|value| value.abs()).enumerate();
            sizes
                .reduce(|most, next| if next.1 > most.1 { next } else { most })
                .map_or(0, |(floor, _)| floor)
        };
        [most(&self.displacement), most(&self.force)]
    }

    /// The uncertainty contributions of position \[m\] and force \[N\] of one floor.
    #[must_use]
    pub fn contributions_at_floor(&self, floor: usize) -> [Vec<Contribution>; 2] {
        let position = if self.on_computed.contains(&floor) {
            None
        } else {
            self.of_displacement.get(floor)
        };
        [position, self.of_force.get(floor)].map(|parts| parts.cloned().unwrap_or_default())
    }

    /// The uncertainty contributions of the positions \[m\]: an entry per floor.
    #[must_use]
    pub fn position_contributions(&self) -> Vec<Contribution> {
        let floors = 0..self.of_displacement.len();
        entries(floors.map(|floor| {
            let [position, _] = self.contributions_at_floor(floor);
            position
        }))
    }

    /// The uncertainty contributions of the remaining forces \[N\]: an entry per floor.
    #[must_use]
    pub fn force_contributions(&self) -> Vec<Contribution> {
        entries(self.of_force.iter().cloned())
    }

    /// The uncertainty contributions of the storey drifts \[m\]: the contribution to a floor minus that to the floor below.
    #[must_use]
    pub fn drift_contributions(&self) -> Vec<Contribution> {
        let floors = &self.of_displacement;
        entries((0..floors.len()).map(|floor| {
            if self.computed.contains(&floor) {
                return Vec::new();
            }
            let mut parts = floors[floor].clone();
            for part in floor.checked_sub(1).map_or(&[][..], |below| &floors[below]) {
                share(
                    &mut parts,
                    Contribution {
                        amount: -part.amount,
                        ..*part
                    },
                );
            }
            parts
        }))
    }

    /// The uncertainty contributions of the shears \[N\]: the sum of the contributions to all floors above a storey.
    #[must_use]
    pub fn shear_contributions(&self) -> Vec<Contribution> {
        entries((0..self.of_force.len()).map(|storey| {
            let mut parts = Vec::new();
            self.of_force[storey..]
                .iter()
                .flatten()
                .for_each(|part| share(&mut parts, *part));
            parts
        }))
    }
}

/// The contributions to the entries of a list, without zero contributions.
fn entries(lists: impl Iterator<Item = Vec<Contribution>>) -> Vec<Contribution> {
    let of_entry = |(entry, parts): (usize, Vec<Contribution>)| {
        parts
            .into_iter()
            .map(move |part| Contribution { entry, ..part })
    };
    lists
        .enumerate()
        .flat_map(of_entry)
        .filter(|part| part.amount != 0.0)
        .collect()
}
