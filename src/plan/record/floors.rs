//! The floors of a frame: the storeys of a step, whatever moved them, and the impact on one of them. In: numbers of a run,
//! SI. It computes no motion.

use crate::record::Modes;
use psd_physics::integrator::state::State;
use psd_physics::integrator::tangents::HasTangents;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::{drifts, shears};
use psd_physics::tracking::monitor::Tracking;

/// The state of a frame at a step, one entry per floor from the ground up; empty for quantities that were not computed.
#[derive(Clone, Copy, Debug)]
pub struct FloorsAt<'a> {
    /// Simulated time \[s\].
    pub time: f64,
    /// Targets \[m\].
    pub command: &'a [f64],
    /// Measured \[m\].
    pub measured: &'a [f64],
    /// Computed X, m.
    pub computed: &'a [f64],
    /// \[m/s\]
    pub velocity: &'a [f64],
    /// \[m/s²\]
    pub acceleration: &'a [f64],
    /// Measured \[N\].
    pub restoring_force: &'a [f64],
    /// G X at the targets \[N\]; empty without weights.
    pub gravity_force: &'a [f64],
    /// The elements of a frame of matrices; none for any other frame.
    pub elements: &'a [ElementReading],
    /// The tracking error of each floor, or of each element.
    pub tracking: &'a [Tracking],
}

/// A step of a frame.
pub trait Floors {
    /// Its floors.
    fn at(&self) -> FloorsAt<'_>;

    /// Simulated time \[s\].
    fn time(&self) -> f64 {
        self.at().time
    }

    /// Computed displacement of each floor \[m\].
    fn computed(&self) -> &[f64] {
        self.at().computed
    }

    /// Measured restoring force of each floor \[N\].
    fn restoring_force(&self) -> &[f64] {
        self.at().restoring_force
    }

    /// Target of each floor \[m\].
    fn command(&self) -> &[f64] {
        self.at().command
    }

    /// Measured displacement of each floor \[m\].
    fn measured(&self) -> &[f64] {
        self.at().measured
    }

    /// The elements of a frame of matrices.
    fn elements(&self) -> &[ElementReading] {
        self.at().elements
    }

    /// Whether it is a step of a frame of matrices with elements.
    fn has_elements(&self) -> bool {
        !self.elements().is_empty()
    }

    /// The tracking error of each floor, or of each element.
    fn tracking(&self) -> &[Tracking] {
        self.at().tracking
    }

    /// Drift of each storey, or deformation of each element \[m\], from the computed displacements.
    #[must_use]
    fn drift(&self) -> Vec<f64> {
        if self.has_elements() {
            return self.elements().iter().map(|read| read.computed).collect();
        }
        drift_of(self.computed())
    }

    /// The rate of each \[m/s\].
    #[must_use]
    fn drift_velocity(&self) -> Vec<f64> {
        if self.has_elements() {
            return self.elements().iter().map(|read| read.velocity).collect();
        }
        drift_of(self.at().velocity)
    }

    /// Shear of each storey \[N\]: the forces of the floors it carries; the first is the base shear. Of a frame of matrices, the force of
    /// each element.
    #[must_use]
    fn shear(&self) -> Vec<f64> {
        if self.has_elements() {
            return self.elements().iter().map(|read| read.force).collect();
        }
        shear_of(self.restoring_force())
    }

    /// Base shear net of P-Δ \[N\]: Σ(R − G X).
    #[must_use]
    fn base_shear(&self) -> f64 {
        let floors = self.at();
        let shear = floors.restoring_force.iter().sum::<f64>();
        if floors.gravity_force.is_empty() {
            shear
        } else {
            shear - floors.gravity_force.iter().sum::<f64>()
        }
    }

    /// Whether P-Δ is computed.
    #[must_use]
    fn weighs(&self) -> bool {
        !self.at().gravity_force.is_empty()
    }

    /// Shear of each storey net of P-Δ \[N\]: of R − G X.
    #[must_use]
    fn net_shear(&self) -> Vec<f64> {
        let floors = self.at();
        if floors.gravity_force.is_empty() {
            return self.shear();
        }
        let forces = floors.restoring_force.iter().zip(floors.gravity_force);
        let net: Vec<f64> = forces.map(|(force, gravity)| force - gravity).collect();
        shear_of(&net)
    }
}

impl<F: Floors> Floors for &F {
    fn at(&self) -> FloorsAt<'_> {
        F::at(self)
    }
}

/// Drift of each storey \[m\], from the displacement of each floor \[m\].
pub fn drift_of(floors: &[f64]) -> Vec<f64> {
    let mut drift = vec![0.0; floors.len()];
    drifts(floors, &mut drift);
    drift
}

/// Shear of each storey \[N\], from the force of each floor \[N\].
pub fn shear_of(floors: &[f64]) -> Vec<f64> {
    let mut shear = vec![0.0; floors.len()];
    shears(floors, &mut shear);
    shear
}

/// All floors of one step of a procedure that integrates.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorMotion {
    /// Simulated time \[s\].
    pub time: f64,
    /// Targets \[m\].
    pub command: Vec<f64>,
    /// Measured \[m\].
    pub displacement: Vec<f64>,
    /// Computed X \[m\]: the target, except under α-OS.
    pub computed: Vec<f64>,
    /// \[m/s\]
    pub velocity: Vec<f64>,
    /// \[m/s²\]
    pub acceleration: Vec<f64>,
    /// Measured, of each floor \[N\].
    pub restoring_force: Vec<f64>,
    /// G X at the targets, of each floor \[N\]; empty without weights.
    pub gravity_force: Vec<f64>,
    /// The elements of a frame of matrices.
    pub elements: Vec<ElementReading>,
    /// For each axis.
    pub tracking: Vec<Tracking>,
}

impl FloorMotion {
    /// The floors at the end of a step, with the tracking of each axis.
    pub fn of_state<V: HasTangents>(state: &State<V>, tracking: &[Tracking]) -> Self {
        let of = |vector: &V| vector.as_slice().to_vec();
        Self {
            time: state.time,
            command: of(&state.target),
            displacement: of(&state.measured_displacement),
            computed: of(&state.displacement),
            velocity: of(&state.velocity),
            acceleration: of(&state.acceleration),
            restoring_force: of(&state.restoring_force),
            gravity_force: of(&state.gravity_force),
            elements: state.elements.clone(),
            tracking: tracking.to_vec(),
        }
    }

    /// The floors where a limit ended the motion to these targets \[m\], after this step, by this time \[s\]: displacement \[m\] and
    /// force \[N\] as measured, G X there \[N\], and the elements.
    pub fn cut_off(
        &self,
        time: f64,
        command: &[f64],
        displacement: &[f64],
        restoring_force: &[f64],
        gravity_force: Vec<f64>,
        elements: &[ElementReading],
    ) -> Self {
        Self {
            time,
            command: command.to_vec(),
            displacement: displacement.to_vec(),
            computed: displacement.to_vec(),
            restoring_force: restoring_force.to_vec(),
            gravity_force,
            elements: elements.to_vec(),
            ..self.clone()
        }
    }
}

impl Floors for FloorMotion {
    fn at(&self) -> FloorsAt<'_> {
        FloorsAt {
            time: self.time,
            command: &self.command,
            measured: &self.displacement,
            computed: &self.computed,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            restoring_force: &self.restoring_force,
            gravity_force: &self.gravity_force,
            elements: &self.elements,
            tracking: &self.tracking,
        }
    }
}

/// All floors of one step of an impact on a storey. The impact step contains the step, the striker and the contact.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorStep {
    pub floors: FloorMotion,
    /// ∫ shear d(storey drift) of each storey up to this step \[J\]; their sum is the energy of the restoring forces. Of a frame of matrices,
    /// ∫ force d(deformation) of each element.
    pub storey_energy: Vec<f64>,
}

impl Floors for FloorStep {
    fn at(&self) -> FloorsAt<'_> {
        self.floors.at()
    }
}

/// A frame with one floor struck.
#[derive(Clone, Debug)]
pub struct StruckFrame {
    /// The struck floor, from 0.
    pub struck: usize,
    /// Every floor, a row for each step of the impact.
    pub floors: Vec<FloorStep>,
    /// None if the procedure did not begin.
    pub modes: Option<Modes>,
    /// Fraction of critical damping of each mode.
    pub damping_ratios: Vec<f64>,
    pub growing: StillGrowing,
}

/// The quantities of a frame that were still growing when an impact ended: the largest value of each is not its peak.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StillGrowing {
    pub base_shear: bool,
    /// The floors, from 0, and the storeys or elements that were moving beyond their largest displacement and drift.
    pub floors: Vec<usize>,
    pub storeys: Vec<usize>,
}
