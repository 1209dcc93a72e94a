//! The structure on an emulated rig: a specimen of one degree of freedom, or a frame with an actuator at every tested storey or element. In: positions and
//! moves of the actuators. Out: the restoring force at each. It knows no rig and no sensor.

use psd_physics::relaxation::maxwell::Motion;
use psd_physics::relaxation::relaxation_state::{Deformed, RelaxationState};
use psd_physics::specimen::SpecimenModel;
use psd_physics::structure::assemblies::{assembly_drifts, on_the_rig};
use psd_physics::structure::cell_damping::CellDamping;
use psd_plan::{Behaviour, Frame};

#[derive(Debug)]
pub enum Structure {
    /// One degree of freedom is one storey.
    Storeys(Vec<Storey>),
    /// R = K X, row by row.
    Matrix(Vec<Vec<f64>>),
}

/// A restoring-force model and the damping beside it.
#[derive(Debug)]
pub struct Storey {
    /// Whether it stands on the strong floor, as the lowest storey of an assembly.
    stands: bool,
    model: SpecimenModel,
    damping: CellDamping,
    relaxing: RelaxationState,
    /// \[N\]
    shear: f64,
    /// \[m\]
    drift: f64,
    /// φ N/h of an axial load \[N/m\]: the cells measure its P-Δ.
    leaning: f64,
}

impl Storey {
    fn new(behaviour: &Behaviour, damping: CellDamping, stands: bool) -> Self {
        Self {
            stands,
            model: SpecimenModel::new(behaviour),
            damping: damping.with_rate_of(behaviour),
            relaxing: RelaxationState::new(behaviour),
            shear: 0.0,
            drift: 0.0,
            leaning: 0.0,
        }
    }

    /// Shear with the P-Δ of the axial load \[N\].
    fn measured_shear(&self) -> f64 {
        self.shear - self.leaning * self.drift
    }

    /// It comes to this drift, the last `moved` of it in the first of the durations, and rests for the second.
    fn bend(&mut self, drift: f64, moved: f64, durations: [f64; 2]) {
        self.drift = drift;
        let [going, resting] = durations;
        let velocity = if moved == 0.0 { 0.0 } else { moved / going };
        let motions = [
            (drift - moved, Motion::even(velocity, going)),
            (drift, Motion::rest(resting)),
        ];
        for (displacement, motion) in motions {
            let from = Deformed {
                displacement,
                force: self.shear,
            };
            self.shear = self.relaxing.advance(&mut self.model, &motion, from, drift);
        }
    }
}

impl Structure {
    /// `damping`: c of c·v \[N·s/m\].
    pub fn of_one(behaviour: &Behaviour, damping: f64) -> Self {
        let damping = CellDamping::new(damping, 0.0);
        Self::Storeys(vec![Storey::new(behaviour, damping, true)])
    }

    pub fn of_frame(frame: &Frame) -> Self {
        if frame.is_matrix_on_the_rig() {
            return Self::Matrix(frame.stiffness.clone());
        }
        let storeys = on_the_rig(frame).map(|(storey, stands)| {
            let damping = CellDamping::new(storey.damping, storey.coulomb);
            Storey::new(storey.behaviour, damping, stands)
        });
        Self::Storeys(storeys.collect())
    }

    /// Calculates the restoring forces \[N\] at these positions of the actuators \[m\]. The last increments \[m\] took the time
    /// `going` at constant velocity. The actuators were at rest for the other `seconds`.
    pub fn bend(&mut self, positions: &[f64], moved: &[f64], going: f64, seconds: f64) -> Vec<f64> {
        match self {
            Self::Storeys(storeys) => {
                let drifts = of_drifts(storeys, positions);
                let apart = drifts.into_iter().zip(of_drifts(storeys, moved));
                for (storey, (drift, moved)) in storeys.iter_mut().zip(apart) {
                    storey.bend(drift, moved, [going, seconds - going]);
                }
                let shears = storeys.iter().map(Storey::measured_shear).collect();
                of_axes(storeys, shears)
            }
            Self::Matrix(rows) => rows
                .iter()
                .map(|row| row.iter().zip(positions).map(|(k, x)| k * x).sum())
                .collect(),
        }
    }

    /// Calculates the forces on the load cells from `forces` \[N\] at these velocities of the actuators \[m/s\].
    pub fn actuator_forces(&mut self, forces: &[f64], velocities: &[f64]) -> Vec<f64> {
        let storeys = match self {
            Self::Storeys(storeys) => storeys,
            Self::Matrix(_) => return forces.to_vec(),
        };
        if let [storey] = storeys.as_mut_slice() {
            let force = storey.damping.measured_force(forces[0], velocities[0]);
            return vec![force + storey.relaxing.force()];
        }
        // A fault can reduce the force of a floor. Only the forces in parallel with the storeys are added here.
        let drifts = of_drifts(storeys, velocities);
        let beside = storeys.iter_mut().zip(drifts).map(|(storey, velocity)| {
            storey.damping.measured_force(storey.shear, velocity) - storey.shear
                + storey.relaxing.force()
        });
        let beside = beside.collect();
        forces
            .iter()
            .zip(of_axes(storeys, beside))
            .map(|(f, more)| f + more)
            .collect()
    }

    /// The axial load on a storey has this P-Δ per drift \[N/m\] from now on.
    pub fn lean(&mut self, storey: usize, per_drift: f64) {
        if let Self::Storeys(storeys) = self
            && let Some(storey) = storeys.get_mut(storey)
        {
            storey.leaning = per_drift;
        }
    }

    /// Drift of a storey \[m\].
    pub fn drift(&self, storey: usize) -> f64 {
        match self {
            Self::Storeys(storeys) => storeys.get(storey).map_or(0.0, |storey| storey.drift),
            Self::Matrix(_) => 0.0,
        }
    }

    /// Sets the friction on the load cell of a specimen of one degree of freedom \[N\].
    pub fn set_friction(&mut self, friction: f64) {
        if let Self::Storeys(storeys) = self
            && let [storey] = storeys.as_mut_slice()
        {
            storey.damping.coulomb = friction;
        }
    }

    /// Sets the present velocities of the actuators \[m/s\]: friction acts against the last motion.
    pub fn goes(&mut self, velocities: &[f64]) {
        if let Self::Storeys(storeys) = self {
            let drifts = of_drifts(storeys, velocities);
            for (storey, velocity) in storeys.iter_mut().zip(drifts) {
                storey.damping.force(velocity);
            }
        }
    }
}

/// The drift of each storey, of displacements or of velocities of the actuators.
fn of_drifts(storeys: &[Storey], axes: &[f64]) -> Vec<f64> {
    let stands = storeys.iter().map(|storey| storey.stands);
    assembly_drifts(axes.iter().copied().zip(stands)).collect()
}

/// The force at each actuator \[N\] from the shears of the storeys \[N\].
fn of_axes(storeys: &[Storey], mut shears: Vec<f64>) -> Vec<f64> {
    for axis in 1..shears.len() {
        if !storeys[axis].stands {
            shears[axis - 1] -= shears[axis];
        }
    }
    shears
}
