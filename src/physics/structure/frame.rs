//! Frames of storeys: many degrees of freedom, one for each floor, counted from the ground up. A frame has a matrix of mass and one of
//! stiffness. A frame that is given by its matrices can have elements beside them. It computes no motion.

use super::elements::{ElementEnds, Elements, add_springs};
use super::shear_building::{shears, storey_stiffness};
use super::{RowsError, SymmetricBand};
use crate::specimen::Behaviour;
use crate::statistics::DeclaredNoise;

/// A structure of several floors.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// From the ground up; empty if the plan gives the matrices.
    pub storeys: Vec<Storey>,
    /// Beside the matrices. With them the stiffness of the files is computed; without any, the rig carries the whole frame.
    pub elements: Vec<Element>,
    /// The stiffness of the files, N/m, row by row: symmetric; empty without elements.
    pub computed_stiffness: Vec<Vec<f64>>,
    /// M, kg, row by row: symmetric, positive definite.
    pub mass: Vec<Vec<f64>>,
    /// K at no displacement, N/m, row by row: symmetric, positive definite.
    pub stiffness: Vec<Vec<f64>>,
    /// The files of mass and stiffness, if the matrices were read.
    pub files: Option<[String; 2]>,
    /// Relative standard uncertainty of the matrices of mass and stiffness, each as a whole; 0 if none is stated.
    pub matrix_uncertainty: [f64; 2],
}

/// One storey: a floor on its columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Storey {
    /// kg, of the floor
    pub mass: f64,
    /// Standard uncertainty \[kg\]; 0 if none is stated.
    pub mass_uncertainty: f64,
    /// N/m, of all its columns together
    pub stiffness: f64,
    /// Standard uncertainty \[N/m\]; 0 if none is stated.
    pub stiffness_uncertainty: f64,
    /// \[m\]
    pub height: Option<f64>,
    /// Weight of its floor \[N\]; 0 if none is stated.
    pub gravity: f64,
    /// Restoring-force model: storey shear against storey drift, on the rig if it is tested.
    pub behaviour: Behaviour,
    /// Damping on the load cells of a simulated rig, per drift velocity there \[N·s/m\].
    pub damping: f64,
    /// The same, N: friction against the drift.
    pub coulomb: f64,
    pub part: Part,
    /// n φ N/λ_f \[N\]: the axial load of the specimen on the rig, as far as its P-Δ is in the reading; 0 without an axial axis.
    pub axial_load: f64,
}

/// A restoring force between two degrees of freedom of a frame of matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    pub ends: ElementEnds,
    /// \[N/m\]
    pub stiffness: f64,
    /// Standard uncertainty \[N/m\]; 0 if none is stated.
    pub stiffness_uncertainty: f64,
    /// Restoring-force model: force against elongation, on the rig if it is tested.
    pub behaviour: Behaviour,
    /// Damping on the load cell of a simulated rig \[N·s/m\].
    pub damping: f64,
    /// The same, N: friction against the motion.
    pub coulomb: f64,
    pub part: Part,
}

/// A storey or an element: a restoring force between two degrees of freedom, against the difference of their displacements.
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    pub ends: ElementEnds,
    /// \[N/m\]
    pub stiffness: f64,
    /// On the rig if it is tested.
    pub behaviour: &'a Behaviour,
    /// \[N·s/m\]
    pub damping: f64,
    /// \[N\]
    pub coulomb: f64,
    pub part: Part,
}

/// The substructure that gives the shear of a storey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// The rig. With the storey below, if that is tested too, it is one specimen, unless it stands `apart` on the strong floor.
    Tested { apart: bool, scale: Scale },
    /// Its model.
    Computed,
}

impl Part {
    /// On the rig at full scale, in one specimen with the storeys beside it.
    pub const TESTED: Self = Self::Tested {
        apart: false,
        scale: Scale::FULL,
    };

    /// The scale of the specimen on the rig; full for a computed storey.
    #[must_use]
    pub const fn scale(&self) -> Scale {
        match *self {
            Self::Tested { scale, .. } => scale,
            Self::Computed => Scale::FULL,
        }
    }
}

/// The specimen on the rig beside the storey of the prototype that it represents. If stresses are those of the prototype, lengths λ mean
/// forces λ². All numbers of a rig follow: those of its actuators, load cells and models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// λ_x: displacement on the rig over that of the prototype.
    pub displacement: f64,
    /// λ_f: force on the rig over that of the part of the prototype that it represents.
    pub force: f64,
    /// n: equal parts of the storey, of which one is on the rig. All move alike.
    pub represents: f64,
}

impl Scale {
    /// The storey itself.
    pub const FULL: Self = Self {
        displacement: 1.0,
        force: 1.0,
        represents: 1.0,
    };

    /// n/λ_f: shear of the storey over the force on the rig.
    #[must_use]
    pub fn forces(&self) -> f64 {
        self.represents / self.force
    }

    /// 1/λ_x: drift of the storey over that on the rig.
    #[must_use]
    pub fn displacements(&self) -> f64 {
        1.0 / self.displacement
    }

    /// K = n λ_x/λ_f times the stiffness on the rig \[N/m\].
    #[must_use]
    pub fn stiffness_of_storey(&self, on_the_rig: f64) -> f64 {
        on_the_rig * self.forces() * self.displacement
    }

    /// The stiffness on the rig \[N/m\] of a storey of this stiffness.
    #[must_use]
    pub fn stiffness_on_the_rig(&self, storey: f64) -> f64 {
        storey / (self.forces() * self.displacement)
    }

    /// The noise of the prototype where this one is of the rig: n σ/λ_f, and the resolution r/λ_x.
    #[must_use]
    pub fn noise_of_prototype(&self, on_the_rig: DeclaredNoise) -> DeclaredNoise {
        DeclaredNoise {
            force: on_the_rig.force * self.forces(),
            resolution: on_the_rig.resolution / self.displacement,
        }
    }

    /// The noise of the rig where this one is of the prototype.
    #[must_use]
    pub fn noise_on_the_rig(&self, prototype: DeclaredNoise) -> DeclaredNoise {
        DeclaredNoise {
            force: prototype.force / self.forces(),
            resolution: prototype.resolution * self.displacement,
        }
    }
}

impl Storey {
    /// A storey of this mass \[kg\], stiffness \[N/m\] and behaviour, without other properties.
    #[must_use]
    pub const fn new(mass: f64, stiffness: f64, behaviour: Behaviour) -> Self {
        let (mass_uncertainty, stiffness_uncertainty) = (0.0, 0.0);
        Self {
            mass,
            mass_uncertainty,
            stiffness,
            stiffness_uncertainty,
            height: None,
            gravity: 0.0,
            behaviour,
            damping: 0.0,
            coulomb: 0.0,
            part: Part::TESTED,
            axial_load: 0.0,
        }
    }

    /// n φ N/(λ_f h) \[N/m\]: the geometric stiffness that is in the reading of the rig.
    #[must_use]
    pub fn axial_stiffness(&self) -> f64 {
        self.per_height(self.axial_load)
    }

    /// A load \[N\] over the height \[N/m\].
    fn per_height(&self, load: f64) -> f64 {
        self.height.map_or(0.0, |height| load / height)
    }
}

impl Member<'_> {
    /// Largest tangent of its model \[N/m\], in numbers of the prototype; None if no bound is known.
    #[must_use]
    pub fn largest_stiffness(&self) -> Option<f64> {
        let largest = self.behaviour.largest_stiffness()?;
        Some(self.part.scale().stiffness_of_storey(largest))
    }

    /// Stiffness that the operator of an integrator assumes \[N/m\]: the stated one of a tested storey, the largest tangent of a model.
    #[must_use]
    pub fn operator_stiffness(&self) -> f64 {
        match self.part {
            Part::Tested { .. } => self.stiffness,
            Part::Computed => self
                .largest_stiffness()
                .unwrap_or(self.stiffness)
                .max(self.stiffness),
        }
    }
}

impl Frame {
    /// The storey with the largest part of the strain energy Σ k Δφ²/2 of a mode, from 0, and that fraction. None without storeys.
    #[must_use]
    pub fn most_strained(&self, shape: &[f64]) -> Option<(usize, f64)> {
        let mut below = 0.0;
        let energies = self.storeys.iter().zip(shape).map(|(storey, floor)| {
            let drift = floor - std::mem::replace(&mut below, *floor);
            storey.stiffness * drift * drift
        });
        let energies: Vec<f64> = energies.collect();
        let all: f64 = energies.iter().sum();
        let largest = energies.into_iter().enumerate();
        let (storey, energy) = largest.max_by(|one, other| one.1.total_cmp(&other.1))?;
        Some((storey, energy / all))
    }

    /// A frame of storeys: M diagonal, K tridiagonal with `k_i + k_{i+1}` on its diagonal.
    #[must_use]
    pub fn of_storeys(storeys: Vec<Storey>) -> Self {
        let count = storeys.len();
        let mut mass = vec![vec![0.0; count]; count];
        let mut stiffness = vec![vec![0.0; count]; count];
        for (floor, storey) in storeys.iter().enumerate() {
            mass[floor][floor] = storey.mass;
            stiffness[floor][floor] += storey.stiffness;
            if floor > 0 {
                stiffness[floor - 1][floor - 1] += storey.stiffness;
                stiffness[floor - 1][floor] = -storey.stiffness;
                stiffness[floor][floor - 1] = -storey.stiffness;
            }
        }
        Self {
            storeys,
            ..Self::of_matrices(mass, stiffness)
        }
    }

    /// A frame of M and K without files.
    #[must_use]
    pub const fn of_matrices(mass: Vec<Vec<f64>>, stiffness: Vec<Vec<f64>>) -> Self {
        Self {
            storeys: Vec::new(),
            elements: Vec::new(),
            computed_stiffness: Vec::new(),
            mass,
            stiffness,
            files: None,
            matrix_uncertainty: [0.0; 2],
        }
    }

    /// The same frame of matrices with these elements beside its stiffness, which is then computed.
    #[must_use]
    pub fn with_elements(mut self, elements: Vec<Element>) -> Self {
        if self.has_elements() {
            self.stiffness = std::mem::take(&mut self.computed_stiffness);
        }
        if !elements.is_empty() {
            self.computed_stiffness.clone_from(&self.stiffness);
            let springs = elements
                .iter()
                .map(|element| (element.ends, element.stiffness));
            let stiffness = &mut self.stiffness;
            add_springs(springs, |row, column, more| stiffness[row][column] += more);
        }
        self.elements = elements;
        self
    }

    /// Its storeys or elements; none for a frame that is on the rig as a whole, by its matrices.
    pub fn members(&self) -> impl Iterator<Item = Member<'_>> {
        let storeys = self.storeys.iter().enumerate();
        let storeys = storeys.map(|(floor, storey)| Member {
            ends: [floor.checked_sub(1), Some(floor)],
            stiffness: storey.stiffness,
            behaviour: &storey.behaviour,
            damping: storey.damping,
            coulomb: storey.coulomb,
            part: storey.part,
        });
        storeys.chain(self.elements.iter().map(|element| Member {
            ends: element.ends,
            stiffness: element.stiffness,
            behaviour: &element.behaviour,
            damping: element.damping,
            coulomb: element.coulomb,
            part: element.part,
        }))
    }

    /// The layout of its elements; None without any.
    ///
    /// # Errors
    /// The stiffness of the files is not square or not symmetric.
    pub fn elements(&self) -> Result<Option<Elements>, RowsError> {
        if !self.has_elements() {
            return Ok(None);
        }
        let members = || self.members();
        Ok(Some(Elements {
            ends: members().map(|member| member.ends).collect(),
            stiffness: members().map(|member| member.stiffness).collect(),
            operator_stiffness: members()
                .map(|member| member.operator_stiffness())
                .collect(),
            matrix: SymmetricBand::from_dense(&self.computed_stiffness)?,
        }))
    }

    /// The stiffness of the frame with these stiffnesses of its members \[N/m\], beside the one that is computed from the files.
    ///
    /// # Errors
    /// The stiffness of the files is not square or not symmetric.
    pub fn assembled(&self, members: &[f64]) -> Result<SymmetricBand, RowsError> {
        if !self.has_elements() {
            return Ok(storey_stiffness(members));
        }
        let mut stiffness = SymmetricBand::from_dense(&self.computed_stiffness)?;
        let ends = self.elements.iter().map(|element| element.ends);
        stiffness.add_springs(ends.zip(members.iter().copied()));
        Ok(stiffness)
    }

    /// P of each storey \[N\]: the weight of its floor and of all floors above. Without any weight it is the axial load on the rig; empty
    /// if there is none.
    #[must_use]
    pub fn axial_loads(&self) -> Vec<f64> {
        if self.storeys.iter().all(|storey| storey.gravity == 0.0) {
            let on_the_rig = self.storeys.iter().map(|storey| storey.axial_load);
            return on_the_rig.filter(|_| self.has_axial_load()).collect();
        }
        let weights: Vec<f64> = self.storeys.iter().map(|storey| storey.gravity).collect();
        let mut loads = vec![0.0; weights.len()];
        shears(&weights, &mut loads);
        loads
    }

    /// Whether the P-Δ of an axial load is in a reading of the rig.
    #[must_use]
    pub fn has_axial_load(&self) -> bool {
        self.storeys.iter().any(|storey| storey.axial_load != 0.0)
    }

    /// Whether some of the P-Δ is computed: that of an axial load on the rig is in its reading.
    #[must_use]
    pub fn computes_p_delta(&self) -> bool {
        let loads = self.axial_loads();
        let mut storeys = loads.iter().zip(&self.storeys);
        storeys.any(|(load, storey)| (load - storey.axial_load).abs() > 1e-9 * load.abs())
    }

    /// P/h of each storey \[N/m\]: its shear by P-Δ per drift, against its restoring force; empty without P.
    #[must_use]
    pub fn gravity_stiffness(&self) -> Vec<f64> {
        let storeys = self.axial_loads().into_iter().zip(&self.storeys);
        storeys
            .map(|(load, storey)| storey.per_height(load))
            .collect()
    }

    /// Floors.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.mass.len()
    }

    /// `storey` or `element`, for messages and reports.
    #[must_use]
    pub const fn word_for_a_member(&self) -> &'static str {
        if self.has_elements() {
            "element"
        } else {
            "storey"
        }
    }

    /// Whether it is a frame of matrices with elements beside its stiffness.
    #[must_use]
    pub const fn has_elements(&self) -> bool {
        !self.elements.is_empty()
    }

    /// Whether the rig carries it as a whole, by its matrices.
    #[must_use]
    pub const fn is_matrix_on_the_rig(&self) -> bool {
        self.storeys.is_empty() && !self.has_elements()
    }

    /// Actuators that it needs, each with a load cell: one at every floor, or at every tested storey or element.
    #[must_use]
    pub fn axes(&self) -> usize {
        if self.is_matrix_on_the_rig() {
            return self.degrees_of_freedom();
        }
        let tested = self
            .members()
            .filter(|member| member.part != Part::Computed);
        tested.count()
    }

    /// ιᵀMι \[kg\]: the mass that moves with the ground.
    #[must_use]
    pub fn total_mass(&self) -> f64 {
        self.mass.iter().flatten().sum()
    }

    /// Standard, of the mass of all floors together, kg: each is independent of the others, a matrix is one.
    #[must_use]
    pub fn total_mass_uncertainty(&self) -> f64 {
        let of_floors = self
            .storeys
            .iter()
            .map(|storey| storey.mass_uncertainty.powi(2))
            .sum::<f64>()
            .sqrt();
        of_floors.hypot(self.matrix_uncertainty[0] * self.total_mass())
    }

    /// The same frame with other matrices of the files: each times its factor.
    #[must_use]
    pub fn scaled(&self, [mass, stiffness]: [f64; 2]) -> Self {
        if self.has_elements() {
            let alone = self.clone().with_elements(Vec::new());
            return alone
                .scaled([mass, stiffness])
                .with_elements(self.elements.clone());
        }
        let times = |matrix: &[Vec<f64>], factor: f64| -> Vec<Vec<f64>> {
            matrix
                .iter()
                .map(|row| row.iter().map(|entry| factor * entry).collect())
                .collect()
        };
        Self {
            mass: times(&self.mass, mass),
            stiffness: times(&self.stiffness, stiffness),
            ..self.clone()
        }
    }

    /// The same frame with other storeys: its matrices follow.
    #[must_use]
    pub fn with(&self, change: impl FnOnce(&mut [Storey])) -> Self {
        let mut storeys = self.storeys.clone();
        change(&mut storeys);
        if storeys.is_empty() {
            self.clone()
        } else {
            Self::of_storeys(storeys)
        }
    }
}
