//! The source of the axis forces of a virtual rig: a specimen, the storeys of a frame, or a matrix. In: positions of the
//! pistons and their motion. Out: forces, and the remaining settling. It knows no actuator and no load cell.

use psd_physics::relaxation::maxwell::Motion;
use psd_physics::relaxation::relaxation_state::{Deformed, RelaxationState};
use psd_physics::specimen::{RestoringForce as _, SpecimenModel};
use psd_physics::structure::SymmetricBand;
use psd_physics::structure::assemblies::on_the_rig;
use psd_physics::structure::cell_damping::{CellDamping, StrengthRate};
use psd_plan::{Behaviour, Frame, Member, Specimen};

/// Springs between the axes and the ground.
pub(super) enum Springs {
    /// `R_i = V_i − V_{i+1}` in every assembly, V is the shear of each storey at its drift; one degree of freedom is one storey.
    Storeys(Vec<Storey>),
    /// R = K X.
    Matrix {
        stiffness: SymmetricBand,
        rows: Vec<f64>,
    },
}

/// One spring, and the elements in parallel with it.
pub(super) struct Storey {
    /// Whether it stands on the strong floor, as the lowest storey of an assembly.
    stands: bool,
    model: SpecimenModel,
    /// The cells measure its rate-dependent force, which is zero at rest; its friction remains.
    damper: CellDamping,
    relaxing: RelaxationState,
    /// Initial stiffness \[N/m\].
    stiffness: f64,
    /// \[m\]
    drift: f64,
    /// Without the P-Δ of an axial load \[N\].
    shear: f64,
    /// φ N/h of an axial load \[N/m\]: the cells measure its P-Δ.
    leaning: f64,
}

impl Storey {
    /// Shear with the P-Δ of the axial load \[N\].
    fn leaning(&self, shear: f64) -> f64 {
        if self.leaning == 0.0 {
            shear
        } else {
            shear - self.leaning * self.drift
        }
    }

    fn new(behaviour: &Behaviour, stiffness: f64, damper: CellDamping, stands: bool) -> Self {
        let mut model = SpecimenModel::new(behaviour);
        Self {
            stands,
            shear: model.move_to(0.0),
            model,
            damper: damper.with_rate_of(behaviour),
            relaxing: RelaxationState::new(behaviour),
            stiffness,
            drift: 0.0,
            leaning: 0.0,
        }
    }
}

impl Springs {
    /// One degree of freedom.
    pub(super) fn of_specimen(specimen: Option<&Specimen>) -> Self {
        let nothing = Behaviour::Elastic { stiffness: 0.0 };
        let behaviour = specimen
            .and_then(|specimen| specimen.behaviour.as_ref())
            .unwrap_or(&nothing);
        let damper = specimen.map_or(CellDamping::new(0.0, 0.0), |specimen| {
            CellDamping::new(specimen.damping, specimen.coulomb)
        });
        let stiffness = SpecimenModel::new(behaviour).initial_stiffness();
        Self::Storeys(vec![Storey::new(behaviour, stiffness, damper, true)])
    }

    pub(super) fn of_frame(frame: &Frame) -> Self {
        if frame.is_matrix_on_the_rig() {
            let order = frame.degrees_of_freedom();
            let stiffness = SymmetricBand::from_dense(&frame.stiffness)
                .unwrap_or_else(|_| SymmetricBand::zero(order, 0));
            let rows = frame
                .stiffness
                .iter()
                .map(|row| row.iter().map(|entry| entry.abs()).sum())
                .collect();
            return Self::Matrix { stiffness, rows };
        }
        let storey = |(storey, stands): (Member<'_>, bool)| {
            let damper = CellDamping::new(storey.damping, storey.coulomb);
            let stiffness = storey.part.scale().stiffness_on_the_rig(storey.stiffness);
            Storey::new(storey.behaviour, stiffness, damper, stands)
        };
        Self::Storeys(on_the_rig(frame).map(storey).collect())
    }

    /// Degrees of freedom.
    pub(super) const fn order(&self) -> usize {
        match self {
            Self::Storeys(storeys) => storeys.len(),
            Self::Matrix { rows, .. } => rows.len(),
        }
    }

    /// The axes move to these displacements \[m\], each by its travel.
    pub(super) fn bend(
        &mut self,
        travels: &[Motion],
        displacement: &[f64],
        restoring_force: &mut [f64],
    ) {
        match self {
            Self::Storeys(storeys) => {
                let (mut below, mut displaced) = (None, 0.0);
                for ((storey, axis), position) in storeys.iter_mut().zip(travels).zip(displacement)
                {
                    let under = std::mem::replace(&mut displaced, *position);
                    let drift = position - if storey.stands { 0.0 } else { under };
                    let below_it = below.filter(|_| !storey.stands);
                    let travel = below_it.map_or(*axis, |below| axis.relative_to(below));
                    storey.shear = storey.relaxing.advance(
                        &mut storey.model,
                        &travel,
                        Deformed {
                            displacement: storey.drift,
                            force: storey.shear,
                        },
                        drift,
                    );
                    storey.drift = drift;
                    below = Some(axis);
                }
                set_forces(
                    storeys
                        .iter()
                        .map(|storey| (storey.leaning(storey.shear), storey.stands)),
                    restoring_force,
                );
            }
            Self::Matrix { stiffness, .. } => stiffness.mul_into(displacement, restoring_force),
        }
    }

    /// The same without relaxation, for which the travel does not matter.
    #[inline]
    pub(super) fn bend_at_once(&mut self, displacement: &[f64], restoring_force: &mut [f64]) {
        match self {
            Self::Storeys(storeys) => {
                each_drift(storeys, displacement.iter().copied(), |storey, drift| {
                    if drift != storey.drift {
                        storey.shear = storey.model.move_to(drift);
                        storey.drift = drift;
                    }
                });
                let shears = storeys.iter().map(|storey| (storey.shear, storey.stands));
                set_forces(shears, restoring_force);
            }
            Self::Matrix { stiffness, .. } => stiffness.mul_into(displacement, restoring_force),
        }
    }

    /// Whether the cells measure more than the restoring forces with the axes at rest, where friction stays and a damper has no force.
    pub(super) fn have_feedback_at_rest(&self) -> bool {
        match self {
            Self::Storeys(storeys) => storeys
                .iter()
                .any(|storey| storey.damper.coulomb != 0.0 || !storey.relaxing.is_none()),
            Self::Matrix { .. } => false,
        }
    }

    /// The axial load on a storey has this P-Δ per drift \[N/m\] from here on.
    pub(super) fn lean(&mut self, storey: usize, per_drift: f64) {
        if let Self::Storeys(storeys) = self
            && let Some(storey) = storeys.get_mut(storey)
        {
            storey.leaning = per_drift;
        }
    }

    /// Drift of a storey \[m\].
    pub(super) fn drift(&self, storey: usize) -> f64 {
        match self {
            Self::Storeys(storeys) => storeys.get(storey).map_or(0.0, |storey| storey.drift),
            Self::Matrix { .. } => 0.0,
        }
    }

    /// The axes continue at these velocities \[m/s\]: the friction of each storey follows their direction.
    pub(super) fn slide(&mut self, velocities: impl Iterator<Item = f64>) {
        if let Self::Storeys(storeys) = self {
            each_drift(storeys, velocities, |storey, velocity| {
                storey.damper.force(velocity);
            });
        }
    }

    /// Restoring forces become the forces that the cells measure at these velocities \[m/s\], \[N\].
    pub(super) fn add_feedback(
        &mut self,
        velocities: impl Iterator<Item = f64>,
        force: &mut [f64],
    ) {
        if let Self::Storeys(storeys) = self
            && storeys
                .iter()
                .any(|storey| !storey.damper.is_none() || !storey.relaxing.is_none())
        {
            let mut shears = Vec::with_capacity(storeys.len());
            each_drift(storeys, velocities, |storey, velocity| {
                let shear = storey.damper.measured_force(storey.shear, velocity);
                let shear = storey.leaning(shear + storey.relaxing.force());
                shears.push((shear, storey.stands));
            });
            set_forces(shears.into_iter(), force);
        }
    }

    /// The storey under an axis and the one above it in the same assembly.
    fn beside(&self, axis: usize) -> impl Iterator<Item = &Storey> {
        let storeys: &[Storey] = match self {
            Self::Storeys(storeys) => storeys,
            Self::Matrix { .. } => &[],
        };
        let own = storeys.iter().skip(axis).take(1);
        own.chain(
            storeys
                .iter()
                .skip(axis + 1)
                .take(1)
                .filter(|above| !above.stands),
        )
    }

    /// The relaxing parts of the force of an axis: those of its own storey and of the storey above. The force of an axis is the
    /// difference of two shears, and would be constant if both relaxed equally. The parts are added in absolute value, so that each shear
    /// has settled too.
    pub(super) fn relaxing_at(&self, axis: usize) -> Vec<&RelaxationState> {
        self.beside(axis)
            .map(|storey| &storey.relaxing)
            .filter(|relaxing| !relaxing.is_none())
            .collect()
    }

    /// Bound of the rate of an axis force during motion of the axes: the sums of absolute values of a row of K \[N/m\] and
    /// of the damping of the storeys \[N·s/m\].
    pub(super) fn rows(&self, axis: usize) -> (f64, f64) {
        if let Self::Matrix { rows, .. } = self {
            return (rows[axis], 0.0);
        }
        let sum = |of: fn(&Storey) -> f64| {
            let mut beside = self.beside(axis).map(of);
            let (own, above) = (beside.next().unwrap_or(0.0), beside.next().unwrap_or(0.0));
            if self
                .beside(axis)
                .next()
                .is_some_and(|storey| !storey.stands)
            {
                2.0 * own + 2.0 * above
            } else {
                own + 2.0 * above
            }
        };
        (
            sum(|storey| storey.stiffness),
            sum(|storey| storey.damper.viscous),
        )
    }

    /// Force \[N\] and law of a specimen with a rate-dependent force. None for a frame, whose storeys are not read
    /// separately.
    pub(super) fn rate(&self) -> Option<(f64, StrengthRate)> {
        match self {
            Self::Storeys(storeys) if storeys.len() == 1 => {
                storeys[0].damper.rate.map(|rate| (storeys[0].shear, rate))
            }
            Self::Storeys(_) | Self::Matrix { .. } => None,
        }
    }
}

/// Calls with the drift of each storey \[m\] from the displacements of the axes, or with its velocity \[m/s\] from theirs.
#[inline]
fn each_drift(
    storeys: &mut [Storey],
    axes: impl Iterator<Item = f64>,
    mut take: impl FnMut(&mut Storey, f64),
) {
    let mut below = 0.0;
    for (storey, axis) in storeys.iter_mut().zip(axes) {
        let below = std::mem::replace(&mut below, axis);
        let relative = axis - if storey.stands { 0.0 } else { below };
        take(storey, relative);
    }
}

/// The force of each axis \[N\], from the shears of its own storey and of the one above; each shear with whether its storey stands on the
/// strong floor.
fn set_forces(shears: impl Iterator<Item = (f64, bool)>, force: &mut [f64]) {
    let mut below: Option<&mut f64> = None;
    for (force, (shear, stands)) in force.iter_mut().zip(shears) {
        if let Some(below) = below.take().filter(|_| !stands) {
            *below -= shear;
        }
        *force = shear;
        below = Some(force);
    }
}
