//! The inputs of an impact, its state at the end of a step, and an impact on an ideal rig from start to end. In: masses,
//! stiffnesses, a striker, a contact law. Out: numbers. The steps are those of [`ImpactSolver`].

pub mod batch;
pub mod energy;
mod in_one_go;
pub mod peaks;
mod solver;
mod step;
pub mod summary;
mod until;

pub(crate) use in_one_go::from_start;
pub use in_one_go::{Caller, simulate, steps_in_one_go};
pub use solver::{FrameImpactSolver, ImpactSolver};
pub use until::Until;

use thiserror::Error;

use crate::contact::ContactLaw;
use crate::statistics::DeclaredNoise;

use crate::contact::state::StepState;
use crate::contact::{Approaching, ImpulseContact, NeedsTangent};
use crate::integrator::Integrator;
use crate::integrator::input::FrameError;
use crate::integrator::state::State;
use crate::integrator::substep::Striker;
use crate::structure::Matrices;
use crate::structure::matrix::one_degree::Body;
use energy::{Energies, kinetic_energy};
use step::{StepInputs, StrikerInput, Structure};
use summary::StepEnd;

/// Initial state and parameters of an impact on one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactInput {
    /// M \[kg\]
    pub mass: f64,
    /// C \[N·s/m\]
    pub damping: f64,
    /// K0 \[N/m\]
    pub stiffness: f64,
    /// Ms \[kg\]
    pub striker_mass: f64,
    /// V0 \[m/s\]
    pub striker_velocity: f64,
    /// Initial distance \[m\], at least 0.
    pub gap: f64,
    /// Acceleration of the striker along its path \[m/s²\]: gn of a falling weight.
    pub gravity: f64,
    /// Δt \[s\]
    pub time_step: f64,
    /// c of `K_t within [0, c·K0]`
    pub max_tangent_ratio: f64,
    pub law: ContactLaw,
    pub integrator: Integrator,
    /// `K_I` of α-OS and of the I-modification \[N/m\].
    pub operator_stiffness: f64,
    /// Whether the recursion uses r* = `r_m` − `K_I`(`d_m` − d̃) instead of the reading: the force at the commanded displacement, as long
    /// as the specimen is nearly elastic.
    pub i_modification: bool,
    pub noise: DeclaredNoise,
}

impl ImpactInput {
    /// A rigid impact on an undamped structure of `stiffness` \[N/m\] at rest, by the tangent form; the striker touches it at the start.
    #[must_use]
    pub const fn rigid(stiffness: f64, impact: Approaching) -> Self {
        let Approaching {
            mass,
            striker_mass,
            velocity: striker_velocity,
            time_step,
        } = impact;
        Self {
            mass,
            damping: 0.0,
            stiffness,
            striker_mass,
            striker_velocity,
            gap: 0.0,
            gravity: 0.0,
            time_step,
            max_tangent_ratio: 2.0,
            law: ContactLaw::Rigid,
            integrator: Integrator::Tangent,
            operator_stiffness: stiffness,
            i_modification: false,
            noise: DeclaredNoise::NONE,
        }
    }

    /// ½ Ms V0² \[J\].
    #[must_use]
    pub fn striker_energy(&self) -> f64 {
        kinetic_energy(self.striker_mass, self.striker_velocity)
    }

    /// M, C and K of the structure.
    #[must_use]
    pub const fn matrices(&self) -> Matrices<f64> {
        Matrices {
            mass: self.mass,
            damping: self.damping,
            stiffness: self.stiffness,
            gravity: None,
        }
    }

    /// The parts of a step in tangent form under a law of impulses.
    fn step_inputs(&self) -> StepInputs {
        let force_limit = match self.law {
            ContactLaw::Limit { force } => force,
            _ => f64::INFINITY,
        };
        let striker = Striker {
            struck: 0,
            mass: self.striker_mass,
            gravity: self.gravity,
            time_step: self.time_step,
        };
        StepInputs {
            body: Body::new([self.mass, self.damping], self.time_step),
            structure: Structure {
                time_step: self.time_step,
                largest_tangent: self.max_tangent_ratio * self.stiffness,
            },
            contact: ImpulseContact::new(force_limit, &striker),
            striker: StrikerInput {
                weight: self.striker_mass * self.gravity,
                energy: self.striker_energy(),
            },
        }
    }

    /// The striker and its contact.
    #[must_use]
    pub const fn setup(&self) -> ImpactSetup {
        ImpactSetup {
            struck: 0,
            mass: self.striker_mass,
            velocity: self.striker_velocity,
            gap: self.gap,
            gravity: self.gravity,
            law: self.law,
        }
    }
}

/// The struck degree of freedom and the striker at the end of a step; step 0 is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactState {
    pub step: u64,
    /// \[s\]
    pub time: f64,
    /// Computed X \[m\].
    pub displacement: f64,
    /// Imposed on the specimen \[m\]: X itself, under α-OS the predicted displacement d̃.
    pub target: f64,
    /// \[m\]
    pub measured_displacement: f64,
    /// \[m/s\]
    pub velocity: f64,
    /// \[m/s²\]
    pub acceleration: f64,
    /// Measured R \[N\].
    pub restoring_force: f64,
    /// Force of the recursion at X \[N\]: the reading, as corrected by the I-modification and α-OS.
    pub force_at_computed: f64,
    /// F, mean over the step \[N\].
    pub contact_force: f64,
    /// \[m\]
    pub striker_displacement: f64,
    /// \[m/s\]
    pub striker_velocity: f64,
    /// K_t for the next step \[N/m\].
    pub tangent_stiffness: f64,
    /// δp, permanent \[m\].
    pub indentation: f64,
    pub state: StepState,
    /// Those of the whole structure. Under `hertz` the contact loss also contains the energy stored in the contact, which is released as
    /// it opens.
    pub energies: Energies,
    /// Input energy so far \[J\], the reference of relative errors. At the start ½ Ms V0², and for a loaded structure its elastic energy
    /// ½RᵀK⁻¹R; a falling weight adds its work.
    pub input: f64,
    /// Contacts that began so far.
    pub contacts: u64,
}

impl ImpactState {
    /// As far as the results follow it.
    #[inline]
    pub(crate) const fn step_end(&self) -> StepEnd {
        StepEnd {
            instant: self.time,
            displacement: self.displacement,
            velocity: self.velocity,
            restoring_force: self.restoring_force,
            contact_force: self.contact_force,
            restoring_energy: self.energies.restoring,
        }
    }
}

/// The setup of an impact: a striker, its contact law and the struck degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactSetup {
    /// The struck degree of freedom, from 0.
    pub struck: usize,
    /// Ms \[kg\]
    pub mass: f64,
    /// V0 \[m/s\]
    pub velocity: f64,
    /// Initial distance \[m\], at least 0.
    pub gap: f64,
    /// Acceleration of the striker along its path \[m/s²\]: gn of a falling weight.
    pub gravity: f64,
    pub law: ContactLaw,
}

/// The reason why an impact cannot be integrated.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ImpactError {
    #[error(transparent)]
    Structure(#[from] FrameError),
    #[error("degree of freedom {} is struck, but there are {order}", struck + 1)]
    NoSuchDegreeOfFreedom { struck: usize, order: usize },
    #[error(transparent)]
    Contact(#[from] NeedsTangent),
}

/// Receives the steps of an impact that is integrated to its end.
pub trait Sink<V = f64> {
    /// The end of a step; `over`: the run ends with it before its duration.
    fn push(&mut self, structure: &State<V>, state: &ImpactState, over: bool);
}

/// Stores nothing.
impl<V> Sink<V> for () {
    fn push(&mut self, _: &State<V>, _: &ImpactState, _: bool) {}
}

/// The end of a step in a table \[SI\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRow {
    pub time: f64,
    pub displacement: f64,
    pub velocity: f64,
    pub restoring_force: f64,
    pub contact_force: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub tangent_stiffness: f64,
}

/// Memory that was touched before costs a quarter: a vector is to be reused.
impl Sink for Vec<StepRow> {
    #[inline]
    fn push(&mut self, _: &State<f64>, state: &ImpactState, _: bool) {
        self.push(StepRow {
            time: state.time,
            displacement: state.displacement,
            velocity: state.velocity,
            restoring_force: state.restoring_force,
            contact_force: state.contact_force,
            striker_displacement: state.striker_displacement,
            striker_velocity: state.striker_velocity,
            tangent_stiffness: state.tangent_stiffness,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::specimen::{Bilinear, BilinearCurve, RestoringForce as _};

    const STIFFNESS: f64 = 327.65;
    const RIGID: ContactLaw = ContactLaw::Rigid;
    const LIMIT: ContactLaw = ContactLaw::Limit { force: 60.0 };
    const BOUNCE: ContactLaw = ContactLaw::Restitution { coefficient: 0.5 };
    const HERTZ: ContactLaw = ContactLaw::Hertz {
        stiffness: 1e6,
        loss: 0.1,
        force_limit: Some(900.0),
    };
    const INTEGRATORS: [Integrator; 4] = [
        Integrator::Tangent,
        Integrator::Explicit,
        Integrator::AlphaOs { alpha: 0.0 },
        Integrator::AlphaOs { alpha: -0.1 },
    ];

    fn input(law: ContactLaw, integrator: Integrator) -> ImpactInput {
        ImpactInput {
            mass: 1.0,
            damping: 2.0,
            stiffness: STIFFNESS,
            striker_mass: 10.0,
            striker_velocity: 1.0,
            gap: 1e-3,
            gravity: 9.81,
            time_step: 1e-3,
            max_tangent_ratio: 2.0,
            law,
            integrator,
            operator_stiffness: STIFFNESS,
            i_modification: true,
            noise: DeclaredNoise::NONE,
        }
    }

    /// The ends of steps.
    struct Ends(Vec<ImpactState>);

    impl Sink for Ends {
        fn push(&mut self, _: &State<f64>, state: &ImpactState, _: bool) {
            self.0.push(*state);
        }
    }

    /// Every number of every step is bit-identical, for every valid pair of contact law and integrator; an invalid pair is refused.
    #[test]
    fn an_impact_in_one_go_is_the_impact_step_by_step() {
        for integrator in INTEGRATORS {
            for law in [RIGID, LIMIT, BOUNCE, HERTZ] {
                let input = input(law, integrator);
                let mut specimen = Bilinear::new(BilinearCurve {
                    stiffness: STIFFNESS,
                    yield_force: 20.0,
                    post_yield_ratio: 0.1,
                });
                let mut solver = match (ImpactSolver::new(&input, 0.0, 0.0), integrator, law) {
                    (Ok(solver), Integrator::Tangent, _) | (Ok(solver), _, RIGID | LIMIT) => solver,
                    (
                        Err(ImpactError::Contact(_)),
                        Integrator::Explicit | Integrator::AlphaOs { .. },
                        BOUNCE | HERTZ,
                    ) => continue,
                    (found, ..) => panic!("{integrator:?} with {law:?}: {found:?}"),
                };
                let mut interactive = Vec::new();
                for _ in 0..400 {
                    let target = solver.predict();
                    let reading = (target * 0.999, specimen.move_to(target * 0.999));
                    interactive.push(*solver.complete(reading.0, reading.1));
                    if solver.over(Until::StrikerStop) {
                        break;
                    }
                }
                let (mut ends, mut specimen) = (
                    Ends(Vec::new()),
                    Bilinear::new(BilinearCurve {
                        stiffness: STIFFNESS,
                        yield_force: 20.0,
                        post_yield_ratio: 0.1,
                    }),
                );
                let mut solver = ImpactSolver::new(&input, 0.0, 0.0).unwrap();
                let read = |solver: &mut ImpactSolver| {
                    let measured = solver.predict() * 0.999;
                    [measured, specimen.move_to(measured)]
                };
                solver.run(Some(Until::StrikerStop), 400, read, &mut ends);
                assert!(interactive.len() > 50, "{integrator:?} with {law:?}");
                assert_eq!(ends.0, interactive, "{integrator:?} with {law:?}");
            }
        }
    }
}
