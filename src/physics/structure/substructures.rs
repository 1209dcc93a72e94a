//! The substructures of a frame: tested on a rig, or computed from a model. In: a frame, the displacements of its floors, the readings of
//! the rig. Out: the restoring forces of the floors. It knows no rig and no equation of motion. Which storeys are on the rig, and how, is
//! in `assemblies`.

use super::assemblies::{Assemblies, Support};
use super::cell_damping::CellDamping;
use super::elements::{ElementReading, add_force, deformation};
use super::frame::{Frame, Part};
use crate::relaxation::maxwell::Motion;
use crate::relaxation::relaxation_state::{Deformed, RelaxationState};
use crate::specimen::{Behaviour, RestoringForce as _, SpecimenModel};
use crate::statistics::samples::peak;

/// Doublings of a move in the search for zero shear: from the elastic move to more than 10⁹ times as far.
const MOST_DOUBLINGS: u32 = 30;

/// Relative size of a singular value that counts as zero: positions that are held twice differ by rounding alone.
const SINGULAR: f64 = 1e-12;

/// A frame of which the rig carries a part: the layout of its assemblies, and the models of its computed storeys with their states.
#[derive(Clone, Debug)]
pub struct Substructures {
    assemblies: Assemblies,
    /// From the ground up, or in the order of the elements; None for a tested one.
    computed: Vec<Option<ComputedStorey>>,
    /// Imposed displacements of the degrees of freedom of a frame of matrices \[m\]; empty for storeys.
    imposed: Vec<f64>,
    /// On the stiffness of the files.
    matrix_factor: f64,
}

impl Substructures {
    /// Every storey is new. None if the whole frame is one specimen on the rig.
    #[must_use]
    pub fn of(frame: &Frame) -> Option<Self> {
        let assemblies = Assemblies::of(frame)?;
        let computed = frame.members().map(|member| {
            (member.part == Part::Computed).then(|| ComputedStorey::new(member.behaviour))
        });
        let matrix = assemblies.elements().map(|elements| &elements.matrix);
        Some(Self {
            computed: computed.collect(),
            imposed: matrix.map_or_else(Vec::new, |matrix| vec![0.0; matrix.order()]),
            matrix_factor: 1.0,
            assemblies,
        })
    }

    #[must_use]
    pub const fn assemblies(&self) -> &Assemblies {
        &self.assemblies
    }

    /// Every computed storey comes to rest at zero shear. The axes hold these displacements \[m\].
    pub fn rest(&mut self, axes: &[f64]) {
        self.unload();
        self.settle(axes);
    }

    /// Every computed storey comes to rest at zero shear, and every computed element at zero force.
    pub fn unload(&mut self) {
        self.computed
            .iter_mut()
            .flatten()
            .for_each(ComputedStorey::rest);
    }

    /// A frame of matrices comes to the displacements at which K and its computed elements balance, where the axes hold the tested ones
    /// \[m\]: ½xᵀKx + ½Σ k (bᵀx − u)² is least, with u of a computed element that without force, and a tested one held.
    fn settle(&mut self, axes: &[f64]) {
        let Some(elements) = &self.assemblies.elements else {
            return;
        };
        if self.imposed.iter().chain(axes).all(|at| *at == 0.0) {
            return;
        }
        let order = self.imposed.len();
        let scales = self.assemblies.scales();
        let mut axes = axes.iter().zip(scales);
        let (mut held, mut free) = (Vec::new(), Vec::new());
        for (member, ends) in elements.ends.iter().enumerate() {
            match &self.computed[member] {
                Some(computed) => free.push((*ends, elements.stiffness[member], computed.drift)),
                None => held.extend(
                    axes.next()
                        .map(|(axis, scale)| (*ends, axis * scale.displacements())),
                ),
            }
        }
        // The unit of a held deformation, so that all rows have one size.
        let unit = peak(elements.matrix.band(0).iter().chain(&elements.stiffness));
        let size = order + held.len();
        let mut rows = nalgebra::DMatrix::zeros(size, size);
        let mut right = nalgebra::DVector::zeros(size);
        for row in 0..order {
            for column in 0..order {
                rows[(row, column)] = self.matrix_factor * elements.matrix.entry(row, column);
            }
        }
        for (ends, stiffness, unloaded) in free {
            super::elements::add_springs(
                std::iter::once((ends, stiffness)),
                |row, column, more| {
                    rows[(row, column)] += more;
                },
            );
            let mut force = vec![0.0; order];
            add_force(ends, stiffness * unloaded, &mut force);
            for (right, force) in right.iter_mut().zip(force) {
                *right += force;
            }
        }
        for (constraint, (ends, deformation)) in held.into_iter().enumerate() {
            let mut sides = vec![0.0; order];
            add_force(ends, unit, &mut sides);
            for (column, side) in sides.into_iter().enumerate() {
                rows[(order + constraint, column)] = side;
                rows[(column, order + constraint)] = side;
            }
            right[order + constraint] = unit * deformation;
        }
        // Elements that close a circle hold the same displacement twice: the least squares of a singular system.
        let settled = rows.svd(true, true).solve(&right, SINGULAR * unit);
        if let Ok(settled) = settled {
            self.imposed.copy_from_slice(&settled.as_slice()[..order]);
        }
        for (element, ends) in self.computed.iter_mut().zip(&elements.ends) {
            if let Some(element) = element {
                element.settle(deformation(*ends, &self.imposed));
            }
        }
    }

    /// The computed storeys follow the floors to these displacements \[m\] within `seconds` of simulated time.
    pub fn advance(&mut self, floors: &[f64], seconds: f64) {
        if let Some(elements) = &self.assemblies.elements {
            for (element, ends) in self.computed.iter_mut().zip(&elements.ends) {
                if let Some(element) = element {
                    element.advance(deformation(*ends, floors), seconds);
                }
            }
            self.imposed.copy_from_slice(floors);
            return;
        }
        let mut below = 0.0;
        for (storey, floor) in self.computed.iter_mut().zip(floors) {
            let drift = floor - std::mem::replace(&mut below, *floor);
            if let Some(storey) = storey {
                storey.advance(drift, seconds);
            }
        }
    }

    /// The elements of a frame of matrices, from displacements \[m\] and forces \[N\] of the axes; none for storeys.
    pub fn elements_read(&self, axes: (&[f64], &[f64])) -> Vec<ElementReading> {
        let Some(elements) = &self.assemblies.elements else {
            return Vec::new();
        };
        let mut axes = axes.0.iter().zip(axes.1);
        let members = elements.ends.iter().zip(&self.computed);
        let read = members.zip(&self.assemblies.scales);
        read.map(|((ends, computed), scale)| {
            if let Some(element) = computed {
                return ElementReading::at_rest(element.drift, [element.drift, element.shear]);
            }
            let target = deformation(*ends, &self.imposed);
            let (displacement, force) = axes.next().unwrap_or((&0.0, &0.0));
            let deformation = displacement / scale.displacement;
            ElementReading::at_rest(target, [deformation, force * scale.forces()])
        })
        .collect()
    }

    /// Displacement \[m\] and restoring force \[N\] of every floor, from those of the axes and the present computed storeys.
    pub fn floors(
        &self,
        axes: (&[f64], &[f64]),
        displacement: &mut Vec<f64>,
        force: &mut Vec<f64>,
    ) {
        displacement.clear();
        force.clear();
        if let Some(elements) = &self.assemblies.elements {
            displacement.extend_from_slice(&self.imposed);
            force.resize(self.imposed.len(), 0.0);
            elements
                .matrix
                .mul_add(self.matrix_factor, &self.imposed, force);
            for (ends, read) in elements.ends.iter().zip(self.elements_read(axes)) {
                add_force(*ends, read.force, force);
            }
            return;
        }
        force.resize(self.computed.len(), 0.0);
        let mut axes = axes.0.iter().zip(axes.1);
        let (mut below, mut base, mut base_floor) = (0.0, 0.0, None);
        for (floor, (support, computed)) in self
            .assemblies
            .supports
            .iter()
            .zip(&self.computed)
            .enumerate()
        {
            if *support == Support::StrongFloor {
                (base, base_floor) = (below, floor.checked_sub(1));
            }
            let (position, shear, carrier) = if let Some(storey) = computed {
                (below + storey.drift, storey.shear, floor.checked_sub(1))
            } else {
                let (displacement, force) = axes.next().unwrap_or((&0.0, &0.0));
                let scale = &self.assemblies.scales[floor];
                let displacement = displacement / scale.displacement;
                (base + displacement, force * scale.forces(), base_floor)
            };
            displacement.push(position);
            force[floor] += shear;
            if let Some(carrier) = carrier {
                force[carrier] -= shear;
            }
            below = position;
        }
    }

    /// The same with the stiffnesses of all computed storeys multiplied by `factors`, one per storey. For a frame of matrices, the last
    /// factor is that of the stiffness of the files.
    #[must_use]
    pub fn stiffer(mut self, factors: &[f64]) -> Self {
        if let (Some(_), Some(matrix)) = (self.assemblies.elements(), factors.last()) {
            self.matrix_factor = *matrix;
        }
        for (storey, factor) in self.computed.iter_mut().zip(factors) {
            if let Some(storey) = storey
                && *factor != 1.0
            {
                (storey.stiffer, storey.stiffer_from) = (*factor, storey.drift);
            }
        }
        self
    }
}

/// A storey that a model computes.
#[derive(Clone, Debug)]
struct ComputedStorey {
    model: SpecimenModel,
    relaxing: RelaxationState,
    /// A storey that has not moved.
    relaxed: RelaxationState,
    /// The rate dependence of its strength.
    rate: CellDamping,
    /// \[m\]
    drift: f64,
    /// Force of the model at the drift \[N\].
    instantaneous: f64,
    /// With its relaxation and its rate dependence \[N\].
    shear: f64,
    /// The factor on its stiffness: it reaches the same forces at drifts that are smaller by this factor, from `stiffer_from` \[m\] on. Its
    /// strength is then that of its model.
    stiffer: f64,
    stiffer_from: f64,
}

impl ComputedStorey {
    fn new(behaviour: &Behaviour) -> Self {
        let relaxed = RelaxationState::new(behaviour);
        let mut model = SpecimenModel::new(behaviour);
        let instantaneous = model.move_to(0.0);
        Self {
            model,
            relaxing: relaxed.clone(),
            relaxed,
            rate: CellDamping::new(0.0, 0.0).with_rate_of(behaviour),
            drift: 0.0,
            instantaneous,
            shear: instantaneous,
            stiffer: 1.0,
            stiffer_from: 0.0,
        }
    }

    /// The drift at which its model has the force of the storey at this drift \[m\].
    fn of_model(&self, drift: f64) -> f64 {
        self.stiffer_from + self.stiffer * (drift - self.stiffer_from)
    }

    /// It moves to this drift \[m\] at constant velocity.
    fn advance(&mut self, drift: f64, seconds: f64) {
        let to = self.of_model(drift);
        let from = Deformed {
            displacement: self.of_model(self.drift),
            force: self.instantaneous,
        };
        let velocity = (to - from.displacement) / seconds;
        let motion = Motion::even(velocity, seconds);
        self.instantaneous = self.relaxing.advance(&mut self.model, &motion, from, to);
        self.shear = self.rate.measured_force(self.instantaneous, velocity) + self.relaxing.force();
        self.drift = drift;
    }

    /// It moves slowly to this drift \[m\].
    fn settle(&mut self, drift: f64) {
        self.instantaneous = self.model.move_to(drift);
        self.drift = drift;
        self.shear = self.instantaneous;
    }

    /// It unloads slowly to zero shear. Its model keeps its path: a copy of it searches the drift, so that it passes that drift once.
    fn rest(&mut self) {
        let loaded = self.instantaneous;
        self.relaxing = self.relaxed.clone();
        let stiffness = self.model.initial_stiffness();
        if loaded != 0.0 && stiffness > 0.0 {
            let force_at = |drift: f64| self.model.clone().move_to(drift);
            let beyond = |drift: f64| force_at(drift) * loaded <= 0.0;
            let elastic = -loaded / stiffness;
            let far = (0..=MOST_DOUBLINGS)
                .map(|doublings| self.drift + elastic * f64::from(1_u32 << doublings))
                .find(|drift| beyond(*drift));
            if let Some(mut far) = far {
                let mut near = self.drift;
                loop {
                    let middle = 0.5 * (near + far);
                    if middle == near || middle == far {
                        break;
                    }
                    if beyond(middle) {
                        far = middle;
                    } else {
                        near = middle;
                    }
                }
                self.drift = if force_at(near).abs() < force_at(far).abs() {
                    near
                } else {
                    far
                };
                self.instantaneous = self.model.move_to(self.drift);
            }
        }
        self.shear = self.instantaneous;
    }
}
