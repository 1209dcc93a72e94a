//! Restoring-force models of simulated specimens, one file each. In: the parameters of a model, then displacements. Out: restoring
//! forces, from a [`SpecimenModel`]. A model has its own path and is independent of time.

mod behaviour;
mod bilinear;
mod bolted;
mod bouc_wen;
mod degrading;
mod deterioration;
mod fracture;
mod multilinear;
pub mod numbers;
mod series;
mod table;
#[cfg(test)]
mod tests;

pub(crate) use bilinear::BilinearLines;
pub use bilinear::{Bilinear, BilinearCurve};
pub use bolted::{Bolted, BoltedJoint};
pub use bouc_wen::BoucWen;
pub use degrading::{Degrading, DegradingCurve};
pub use deterioration::Deterioration;
pub use deterioration::bilinear::DeterioratingBilinear;
pub use deterioration::pinching::{Capping, PinchedHysteresis, Pinching};
pub use fracture::{Breaks, Fracture};
pub use multilinear::Multilinear;
pub use series::Series;
pub use table::{AlongTheCurve, PlasticCurve, Table, Unloading};

use crate::structure::beam::Beam;
use crate::structure::portal::Portal;

/// Restoring force of a simulated specimen against displacement.
#[derive(Clone, Debug, PartialEq)]
pub enum Behaviour {
    /// R = K X, K \[N/m\].
    Elastic { stiffness: f64 },
    /// Elastic–plastic with kinematic hardening; `post_yield_ratio` is the post-yield stiffness ratio.
    Bilinear {
        stiffness: f64,
        yield_force: f64,
        post_yield_ratio: f64,
    },
    /// The same, with cyclic deterioration by absorbed energy.
    DeterioratingBilinear {
        stiffness: f64,
        yield_force: f64,
        post_yield_ratio: f64,
        deterioration: Deterioration,
    },
    /// A beam by geometry.
    Beam(Beam),
    /// Piecewise linear, with kinematic hardening: backbone points, displacement \[m\] and force \[N\], both rising, each segment softer
    /// than the one before; the last one continues.
    Multilinear { corners: Vec<[f64; 2]> },
    /// Smooth hysteresis after Bouc and Wen. `sharpness` is n; γ = 1 − `beta`.
    BoucWen {
        stiffness: f64,
        yield_force: f64,
        post_yield_ratio: f64,
        sharpness: f64,
        beta: f64,
    },
    /// Pinched hysteresis, peak-oriented, after Ibarra, Medina & Krawinkler.
    Pinching(Pinching),
    /// R = K(x) X with K(x) = K (r + (1 − r)/(1 + x/h)), x the peak displacement so far; half of the loss occurs at h.
    Degrading {
        stiffness: f64,
        half_displacement: f64,
        residual: f64,
    },
    /// A bolted joint: friction, clearance, bearing, holes that grow.
    Bolted(Bolted),
    /// Measured points.
    Table(Table),
    /// Intact until fracture, zero force after.
    Fracture { of: Box<Behaviour>, at: Breaks },
    /// One force, displacements add.
    Series(Vec<Behaviour>),
    /// One displacement, forces add.
    Parallel(Vec<Behaviour>),
    /// Rate-dependent: the load cell measures R (1 + (|v|/`reference_velocity`)^`exponent`) at the velocity v.
    Rate {
        of: Box<Behaviour>,
        reference_velocity: f64,
        exponent: f64,
    },
    /// A Maxwell branch (spring and dashpot in series) in parallel with the rest. `stiffness` \[N/m\], `time_constant` \[s\].
    Maxwell {
        of: Box<Behaviour>,
        stiffness: f64,
        time_constant: f64,
    },
    /// The force relaxes with the logarithm of time: every newton loses `share`·ln(1 + t/`reference_time`), until `longest` \[s\].
    Logarithmic {
        of: Box<Behaviour>,
        share: f64,
        reference_time: f64,
        longest: f64,
    },
    /// A portal frame by plastic hinges.
    Portal(Portal),
}

/// A restoring-force (hysteretic) model.
pub trait RestoringForce {
    /// Moves to `displacement` \[m\] and returns the force there \[N\].
    fn move_to(&mut self, displacement: f64) -> f64;
    /// Initial stiffness \[N/m\].
    fn initial_stiffness(&self) -> f64;
}

/// R = K X.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    pub stiffness: f64,
}

impl RestoringForce for Elastic {
    fn move_to(&mut self, displacement: f64) -> f64 {
        self.stiffness * displacement
    }

    fn initial_stiffness(&self) -> f64 {
        self.stiffness
    }
}

/// Any model. The two smallest are stored inline, the larger ones boxed.
#[derive(Clone, Debug, PartialEq)]
pub enum SpecimenModel {
    Elastic(Elastic),
    Bilinear(Bilinear),
    DeterioratingBilinear(Box<DeterioratingBilinear>),
    Multilinear(Multilinear),
    BoucWen(Box<BoucWen>),
    Pinched(Box<PinchedHysteresis>),
    Degrading(Box<Degrading>),
    Bolted(Box<BoltedJoint>),
    Plastic(Box<PlasticCurve>),
    AlongTheCurve(Box<AlongTheCurve>),
    Fracture(Box<Fracture>),
    Series(Box<Series>),
    Parallel(Vec<SpecimenModel>),
}

impl SpecimenModel {
    /// A model of `behaviour`, undamaged at zero displacement. Rate dependence and relaxation are not part of it.
    #[must_use]
    pub fn new(behaviour: &Behaviour) -> Self {
        match behaviour {
            Behaviour::Elastic { stiffness } => Self::Elastic(Elastic {
                stiffness: *stiffness,
            }),
            Behaviour::Beam(beam) => Self::Elastic(Elastic {
                stiffness: beam.stiffness,
            }),
            Behaviour::Bilinear {
                stiffness,
                yield_force,
                post_yield_ratio,
            } => Self::Bilinear(Bilinear::new(BilinearCurve {
                stiffness: *stiffness,
                yield_force: *yield_force,
                post_yield_ratio: *post_yield_ratio,
            })),
            Behaviour::DeterioratingBilinear {
                stiffness,
                yield_force,
                post_yield_ratio,
                deterioration,
            } => Self::DeterioratingBilinear(Box::new(DeterioratingBilinear::new(
                BilinearCurve {
                    stiffness: *stiffness,
                    yield_force: *yield_force,
                    post_yield_ratio: *post_yield_ratio,
                },
                *deterioration,
            ))),
            Behaviour::Portal(portal) => Self::Bilinear(Bilinear::new(BilinearCurve {
                stiffness: portal.stiffness,
                yield_force: portal.capacity(),
                post_yield_ratio: 0.0,
            })),
            Behaviour::Multilinear { corners } => Self::Multilinear(Multilinear::new(corners)),
            Behaviour::BoucWen {
                stiffness,
                yield_force,
                post_yield_ratio,
                sharpness,
                beta,
            } => Self::BoucWen(Box::new(BoucWen::new(
                BilinearCurve {
                    stiffness: *stiffness,
                    yield_force: *yield_force,
                    post_yield_ratio: *post_yield_ratio,
                },
                *sharpness,
                *beta,
            ))),
            Behaviour::Pinching(pinching) => {
                Self::Pinched(Box::new(PinchedHysteresis::new(*pinching)))
            }
            Behaviour::Degrading {
                stiffness,
                half_displacement,
                residual,
            } => Self::Degrading(Box::new(Degrading::new(DegradingCurve {
                stiffness: *stiffness,
                half_displacement: *half_displacement,
                residual: *residual,
            }))),
            Behaviour::Bolted(bolted) => Self::Bolted(Box::new(BoltedJoint::new(*bolted))),
            Behaviour::Table(table) => table::model(table),
            Behaviour::Fracture { of, at } => {
                Self::Fracture(Box::new(Fracture::new(Self::new(of), *at)))
            }
            Behaviour::Series(parts) => Series::of(parts.iter().map(Self::new)),
            Behaviour::Parallel(parts) => Self::Parallel(parts.iter().map(Self::new).collect()),
            Behaviour::Rate { of, .. }
            | Behaviour::Maxwell { of, .. }
            | Behaviour::Logarithmic { of, .. } => Self::new(of),
        }
    }
}

impl RestoringForce for SpecimenModel {
    fn move_to(&mut self, displacement: f64) -> f64 {
        match self {
            Self::Elastic(model) => model.move_to(displacement),
            Self::Bilinear(model) => model.move_to(displacement),
            Self::DeterioratingBilinear(model) => model.move_to(displacement),
            Self::Multilinear(model) => model.move_to(displacement),
            Self::BoucWen(model) => model.move_to(displacement),
            Self::Pinched(model) => model.move_to(displacement),
            Self::Degrading(model) => model.move_to(displacement),
            Self::Bolted(model) => model.move_to(displacement),
            Self::Plastic(model) => model.move_to(displacement),
            Self::AlongTheCurve(model) => model.move_to(displacement),
            Self::Fracture(model) => model.move_to(displacement),
            Self::Series(model) => model.move_to(displacement),
            Self::Parallel(models) => models
                .iter_mut()
                .map(|model| model.move_to(displacement))
                .sum(),
        }
    }

    fn initial_stiffness(&self) -> f64 {
        match self {
            Self::Elastic(model) => model.initial_stiffness(),
            Self::Bilinear(model) => model.initial_stiffness(),
            Self::DeterioratingBilinear(model) => model.initial_stiffness(),
            Self::Multilinear(model) => model.initial_stiffness(),
            Self::BoucWen(model) => model.initial_stiffness(),
            Self::Pinched(model) => model.initial_stiffness(),
            Self::Degrading(model) => model.initial_stiffness(),
            Self::Bolted(model) => model.initial_stiffness(),
            Self::Plastic(model) => model.initial_stiffness(),
            Self::AlongTheCurve(model) => model.initial_stiffness(),
            Self::Fracture(model) => model.initial_stiffness(),
            Self::Series(model) => model.initial_stiffness(),
            Self::Parallel(models) => models.iter().map(RestoringForce::initial_stiffness).sum(),
        }
    }
}
