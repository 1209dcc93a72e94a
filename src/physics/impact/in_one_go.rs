//! An impact from start to end, on an ideal rig or along a recorded path. In: the inputs, a specimen or readings. Out: the ends of its
//! steps, bit for bit those of [`ImpactSolver`]. Where it can, it keeps all numbers between two steps in registers.

#![allow(
    clippy::inline_always,
    reason = "a part of the loop over the steps, which computes what its parts read"
)]

use super::energy::{Energies, kinetic_energy};
use super::solver::impact_state;
use super::step::{Also, BetweenSteps, end_step};
use super::{ImpactError, ImpactInput, ImpactSolver, ImpactState, Sink, Until};
use crate::contact::state::StepState;
use crate::contact::{Advance, ContactLaw};
use crate::integrator::Integrator;
use crate::integrator::state::State;
use crate::specimen::RestoringForce;
use crate::statistics::DeclaredNoise;
use crate::structure::energies::FrameEnergies;
use crate::structure::matrix::one_degree::Secant;

/// An impact on one degree of freedom of an ideal rig from rest at X = 0.
///
/// # Errors
/// As [`ImpactSolver::new`].
pub fn simulate<S: RestoringForce, K: Sink>(
    input: &ImpactInput,
    specimen: &mut S,
    until: Option<Until>,
    steps: u64,
    sink: &mut K,
) -> Result<ImpactState, ImpactError> {
    let solver = ImpactSolver::new(input, 0.0, specimen.move_to(0.0))?;
    let read = |[target, _]: [f64; 2]| [target, specimen.move_to(target)];
    Ok(from_start(input, solver, until, steps, read, sink))
}

/// An impact on one degree of freedom from its start, of which `solver` is at the start, `steps` steps at most. For a target \[m\] and the
/// predicted velocity there \[m/s\], `read` gives displacement \[m\] and force \[N\].
pub(crate) fn from_start<K: Sink>(
    input: &ImpactInput,
    mut solver: ImpactSolver,
    until: Option<Until>,
    steps: u64,
    read: impl FnMut([f64; 2]) -> [f64; 2],
    sink: &mut K,
) -> ImpactState {
    let mut caller = Uninterrupted { read, sink };
    if let Some((_, last)) = steps_in_one_go(input, &solver, until, steps, &mut caller) {
        return last;
    }
    let Uninterrupted { mut read, sink } = caller;
    let read = |solver: &mut ImpactSolver| {
        let mut velocity = [0.0];
        solver.predicted_velocity(&mut velocity);
        read([solver.predict(), velocity[0]])
    };
    solver.run(until, steps, read, sink);
    *solver.state()
}

/// Reads at the targets of an impact, receives the ends of its steps, and may end it.
pub trait Caller {
    /// Displacement \[m\] and force \[N\] at a target \[m\] that has a predicted velocity \[m/s\]. None: the impact ends before this step.
    fn read(&mut self, target: [f64; 2]) -> Option<[f64; 2]>;

    /// Takes the end of a step; `over`: the run ends with it before its duration. False: the impact ends with it.
    fn end(&mut self, structure: &State<f64>, state: &ImpactState, over: bool) -> bool;
}

/// A caller that ends no impact.
struct Uninterrupted<'a, R, K> {
    read: R,
    sink: &'a mut K,
}

impl<R: FnMut([f64; 2]) -> [f64; 2], K: Sink> Caller for Uninterrupted<'_, R, K> {
    #[inline(always)]
    fn read(&mut self, target: [f64; 2]) -> Option<[f64; 2]> {
        Some((self.read)(target))
    }

    #[inline(always)]
    fn end(&mut self, structure: &State<f64>, state: &ImpactState, over: bool) -> bool {
        self.sink.push(structure, state, over);
        true
    }
}

/// All steps of an impact with exact readings from its start, where `solver` is and stays, `steps` steps at most. The numbers between two
/// steps are in registers, and their bits are those of the solver. Gives the end of the last step. None, with no reading, if the
/// integrator, the contact law or the end of the run needs the solver.
pub fn steps_in_one_go<C: Caller>(
    input: &ImpactInput,
    solver: &ImpactSolver,
    until: Option<Until>,
    steps: u64,
    caller: &mut C,
) -> Option<(State<f64>, ImpactState)> {
    let ends_at_stop = match until {
        None | Some(Until::Duration) => false,
        Some(Until::StrikerStop) => true,
        Some(Until::Rebound | Until::Drift(_)) => return None,
    };
    let exact = input.integrator == Integrator::Tangent
        && input.noise == DeclaredNoise::NONE
        && !input.i_modification;
    if !exact {
        return None;
    }
    let start = solver.state();
    let last = match input.law {
        ContactLaw::Rigid => run::<_, false>(input, start, ends_at_stop, steps, caller),
        ContactLaw::Limit { .. } => run::<_, true>(input, start, ends_at_stop, steps, caller),
        _ => return None,
    };
    Some(last.unwrap_or_else(|| (solver.structure().clone(), *start)))
}

/// In tangent form with exact readings, under the rigid law or one that is `LIMITED`. None without a step.
fn run<C: Caller, const LIMITED: bool>(
    input: &ImpactInput,
    start: &ImpactState,
    ends_at_stop: bool,
    steps: u64,
    caller: &mut C,
) -> Option<(State<f64>, ImpactState)> {
    let mut inputs = input.step_inputs();
    inputs.striker.energy = start.input;
    let also = Also {
        // A branch costs more than the sums of a damper of zero.
        damped: true,
        falls: input.gravity != 0.0,
    };
    let mut now = BetweenSteps::at_rest(
        [
            start.displacement,
            start.restoring_force,
            start.acceleration,
        ],
        [start.striker_displacement, start.striker_velocity],
        Secant::of(start.tangent_stiffness),
        start.input,
    );
    let mut end = End {
        step: 0,
        state: StepState::Free,
        contacts: 0,
        measured: start.target,
    };
    for step in 1..=steps {
        let mut read = None;
        let (after, marks) = end_step::<f64, LIMITED>(&inputs, &now, also, |_, target| {
            read = caller.read(target);
            let [displacement, force] = read.unwrap_or(target);
            [force, displacement - end.measured]
        });
        let Some([measured, _]) = read else {
            break;
        };
        now = after;
        let begins = end.state == StepState::Free && marks.state != StepState::Free;
        end = End {
            step,
            state: marks.state,
            contacts: end.contacts + u32::from(begins),
            measured,
        };
        let over = ends_at_stop && marks.over;
        let (structure, state) = end.states(input, &now);
        if !caller.end(&structure, &state, over) || over {
            break;
        }
    }
    (end.step > 0).then(|| end.states(input, &now))
}

/// The last step.
#[derive(Clone, Copy)]
struct End {
    step: u64,
    state: StepState,
    contacts: u32,
    /// \[m\]
    measured: f64,
}

impl End {
    /// The structure, and the struck degree of freedom with the striker. Numbers that the caller does not read are not computed.
    #[inline]
    fn states(self, input: &ImpactInput, now: &BetweenSteps) -> (State<f64>, ImpactState) {
        let BetweenSteps {
            motion,
            secant,
            work,
            indented,
            damped,
            fallen,
        } = now;
        // A signed number is converted in one instruction.
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = self.step.cast_signed() as f64 * input.time_step;
        let stiffness = secant.stiffness();
        let kinetic = 0.5 * (input.mass * motion.velocity * motion.velocity);
        let structure = State {
            step: self.step,
            time,
            displacement: motion.displacement,
            target: motion.displacement,
            measured_displacement: self.measured,
            velocity: motion.velocity,
            acceleration: motion.acceleration,
            restoring_force: motion.force,
            gravity_force: 0.0,
            force_at_computed: motion.force,
            load: 0.0,
            storey_stiffness: stiffness,
            elements: Vec::new(),
            energies: FrameEnergies {
                kinetic,
                restoring: work.restoring,
                damping: damped.work,
                input: 0.0,
                gravity: 0.0,
                error: 0.0 - (kinetic + work.restoring + damped.work),
            },
        };
        let advance = Advance {
            striker_displacement: motion.striker_displacement,
            striker_velocity: motion.striker_velocity,
            state: self.state,
            contact_force: motion.contact_force,
            indentation: indented.depth,
            contact_loss: 0.0,
            damping_work: 0.0,
            indentation_work: 0.0,
            contacts: self.contacts,
        };
        let mut energies = Energies {
            striker: kinetic_energy(input.striker_mass, motion.striker_velocity),
            structure: kinetic,
            restoring: work.restoring,
            damping: damped.work,
            contact_loss: work.contact_loss,
            indentation: indented.work,
            weight: fallen.work,
            gravity: 0.0,
            error: 0.0,
        };
        energies.error = energies.missing(input.striker_energy(), 0.0);
        let state = impact_state(&structure, 0, &advance, stiffness, energies, fallen.input);
        (structure, state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Approaching;
    use crate::specimen::{Bilinear, BilinearCurve};

    const STIFFNESS: f64 = 327.65;

    struct Ends(Vec<(State<f64>, ImpactState, bool)>);

    impl Sink for Ends {
        fn push(&mut self, structure: &State<f64>, state: &ImpactState, over: bool) {
            self.0.push((structure.clone(), *state, over));
        }
    }

    /// With and without damper, fall and gap, under every law and end condition: all numbers of structure and striker are those of the
    /// solver, to the last bit.
    #[test]
    fn in_one_go_and_step_by_step_are_the_same_bits() {
        let laws = [
            ContactLaw::Rigid,
            ContactLaw::Limit { force: 60.0 },
            ContactLaw::Restitution { coefficient: 0.5 },
        ];
        let specimen = || {
            Bilinear::new(BilinearCurve {
                stiffness: STIFFNESS,
                yield_force: 20.0,
                post_yield_ratio: 0.1,
            })
        };
        for (law, damping, gravity, gap) in laws
            .into_iter()
            .flat_map(|law| [(law, 0.0, 0.0, 0.0), (law, 2.0, 9.81, 1e-3)])
        {
            let input = ImpactInput {
                damping,
                gap,
                gravity,
                law,
                ..ImpactInput::rigid(
                    STIFFNESS,
                    Approaching {
                        mass: 1.0,
                        striker_mass: 10.0,
                        velocity: 1.0,
                        time_step: 1e-3,
                    },
                )
            };
            for until in [None, Some(Until::StrikerStop), Some(Until::Rebound)] {
                let mut ends = Ends(Vec::new());
                let last = simulate(&input, &mut specimen(), until, 700, &mut ends).unwrap();
                let mut solver = ImpactSolver::new(&input, 0.0, 0.0).unwrap();
                let (mut specimen, mut own) = (specimen(), Vec::new());
                while own.len() < 700 {
                    let target = solver.predict();
                    solver.complete(target, specimen.move_to(target));
                    let over = until.is_some_and(|until| solver.over(until));
                    own.push((solver.structure().clone(), *solver.state(), over));
                    if over {
                        break;
                    }
                }
                assert!(own.len() > 20 && ends.0 == own, "{law:?} until {until:?}");
                assert_eq!(last, *solver.state());
            }
        }
    }

    /// From a loaded start, with readings beside their targets: the same bits.
    #[test]
    fn readings_beside_their_targets_give_the_same_bits() {
        let read = |target: f64| [1.001 * target + 1e-6, STIFFNESS * target + 0.1];
        for law in [ContactLaw::Rigid, ContactLaw::Limit { force: 60.0 }] {
            let input = ImpactInput {
                law,
                gap: 1e-3,
                ..ImpactInput::rigid(
                    STIFFNESS,
                    Approaching {
                        mass: 1.0,
                        striker_mass: 10.0,
                        velocity: 1.0,
                        time_step: 1e-3,
                    },
                )
            };
            let solver = || ImpactSolver::new(&input, 0.01, STIFFNESS * 0.01).unwrap();
            let (mut ends, mut velocities) = (Ends(Vec::new()), Vec::new());
            let reads = |[target, velocity]: [f64; 2]| {
                velocities.push(velocity);
                read(target)
            };
            from_start(&input, solver(), None, 700, reads, &mut ends);
            let (mut solver, mut own, mut predicted) = (solver(), Vec::new(), Vec::new());
            for _ in 0..700 {
                let mut velocity = [0.0];
                solver.predicted_velocity(&mut velocity);
                predicted.extend(velocity);
                let [displacement, force] = read(solver.predict());
                solver.complete(displacement, force);
                own.push((solver.structure().clone(), *solver.state(), false));
            }
            assert!(ends.0 == own && velocities == predicted, "{law:?}");
        }
    }
}
