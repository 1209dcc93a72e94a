//! Elements of a frame of matrices: restoring forces between two of its degrees of freedom, beside the stiffness of the files. In: ends,
//! stiffnesses, displacements. Out: deformations, forces, matrices. It knows no model and no rig.
//!
//! R = K x + Σ b f(bᵀx), where b is +1 at the second end of an element, −1 at the first, and 0 elsewhere. The ground has no entry.

use super::SymmetricBand;
use super::shear_building::drifts;

/// The degrees of freedom, from 0, that a storey or an element joins: from the first to the second. None is the ground.
pub type ElementEnds = [Option<usize>; 2];

/// Displacement of the second end relative to the first, bᵀx \[m\].
#[must_use]
pub fn deformation([from, to]: ElementEnds, displacement: &[f64]) -> f64 {
    let at = |end: Option<usize>| end.map_or(0.0, |end| displacement[end]);
    at(to) - at(from)
}

/// Adds b f, the force of an element \[N\] at its ends.
pub fn add_force([from, to]: ElementEnds, element: f64, force: &mut [f64]) {
    if let Some(to) = to {
        force[to] += element;
    }
    if let Some(from) = from {
        force[from] -= element;
    }
}

/// Calls with the row, the column and the value of each entry of k b bᵀ, for these springs \[N/m\].
pub(super) fn add_springs(
    springs: impl Iterator<Item = (ElementEnds, f64)>,
    mut add: impl FnMut(usize, usize, f64),
) {
    for (ends, stiffness) in springs {
        for end in ends.into_iter().flatten() {
            add(end, end, stiffness);
        }
        if let [Some(from), Some(to)] = ends {
            add(from, to, -stiffness);
            add(to, from, -stiffness);
        }
    }
}

impl SymmetricBand {
    /// Adds k b bᵀ of these springs \[N/m\].
    pub fn add_springs(&mut self, springs: impl Iterator<Item = (ElementEnds, f64)>) {
        add_springs(springs, |row, column, more| {
            if row >= column {
                self.include(row - column);
                self.set(row, column, self.entry(row, column) + more);
            }
        });
    }
}

/// One element at one instant, in numbers of the prototype.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementReading {
    /// Imposed deformation \[m\].
    pub target: f64,
    /// Measured deformation \[m\]: the imposed one, if a model computes the element.
    pub deformation: f64,
    /// \[N\]
    pub force: f64,
    /// Computed bᵀX \[m\]: the imposed one, except under α-OS.
    pub computed: f64,
    /// Computed bᵀẊ \[m/s\].
    pub velocity: f64,
    /// Force of the recursion at bᵀX \[N\]: the reading, as corrected by the I-modification and α-OS.
    pub force_at_computed: f64,
}

impl ElementReading {
    /// A reading without a recursion: computed is as measured, at rest.
    #[must_use]
    pub const fn at_rest(target: f64, [deformation, force]: [f64; 2]) -> Self {
        Self {
            target,
            deformation,
            force,
            computed: deformation,
            velocity: 0.0,
            force_at_computed: force,
        }
    }
}

/// Drift of each storey \[m\] at these displacements of the floors; of a frame of matrices with elements, the deformation of each.
pub fn member_drifts(displacement: &[f64], elements: &[ElementReading], drift: &mut [f64]) {
    if elements.is_empty() {
        drifts(displacement, drift);
    }
    for (drift, element) in drift.iter_mut().zip(elements) {
        *drift = element.computed;
    }
}

/// The elements of a frame and the stiffness beside them.
#[derive(Clone, Debug, PartialEq)]
pub struct Elements {
    pub ends: Vec<ElementEnds>,
    /// The stated one of each element \[N/m\].
    pub stiffness: Vec<f64>,
    /// That of each element in the operator of an integrator \[N/m\].
    pub operator_stiffness: Vec<f64>,
    /// K of the files \[N/m\].
    pub matrix: SymmetricBand,
}

impl Elements {
    /// K + Σ k b bᵀ with these stiffnesses of the elements \[N/m\] into `operator`.
    pub(crate) fn compose(&self, stiffness: &[f64], operator: &mut SymmetricBand) {
        operator.copy_from(&self.matrix);
        let ends = self.ends.iter().copied();
        operator.add_springs(ends.zip(stiffness.iter().copied()));
    }

    /// The motion of each element at the end of a step, from the displacements \[m\] and velocities \[m/s\] of the degrees of freedom. With
    /// the I-modification its force changes from its measured deformation to bᵀX, without it from the imposed one, as that of the floors.
    pub(crate) fn complete(
        &self,
        [displacement, velocity]: [&[f64]; 2],
        is_modified: bool,
        readings: &mut [ElementReading],
    ) {
        let each = self.ends.iter().zip(&self.operator_stiffness);
        for ((ends, stiffness), read) in each.zip(readings) {
            let from = if is_modified {
                read.deformation
            } else {
                read.target
            };
            read.computed = deformation(*ends, displacement);
            read.velocity = deformation(*ends, velocity);
            read.force_at_computed = read.force + stiffness * (read.computed - from);
        }
    }

    /// Takes from the forces \[N\] those by which an element differs at its measured deformation from its target: r* = r − k (u − ũ).
    pub(crate) fn correct(&self, readings: &[ElementReading], force: &mut [f64]) {
        for ((ends, stiffness), read) in self.ends.iter().zip(&self.stiffness).zip(readings) {
            add_force(*ends, -stiffness * (read.deformation - read.target), force);
        }
    }
}
