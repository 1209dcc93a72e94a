//! Sixteen impacts, one step at a time. In: impacts that begin in a lane. Out: their results when they end. The arithmetic is that of
//! [`super::super::ImpactSolver`], in the same order, and of the summary of its steps.

use super::rows::{Contacts, End, Inputs, Row, States, Structure, YES};
use super::step::step;
use super::{Impact, LaneSpecimen, Reach};
use crate::contact::ContactLaw;
use crate::impact::ImpactInput;
use crate::impact::summary::{ImpactSummary, still_rising};

/// The impacts of all lanes.
#[derive(Clone, Debug)]
pub struct Lanes {
    inputs: Inputs,
    /// A step reads one of them and writes the other, each at its own address. A number that is selected and written where it was read would
    /// become a masked store, which is slow on some processors.
    states: [States; 2],
    contacts: Contacts,
    /// Index of the state after the last step.
    now: usize,
}

impl Lanes {
    /// All at rest.
    pub const fn new() -> Self {
        Self {
            inputs: Inputs::new(),
            states: [States::new(), States::new()],
            contacts: Contacts::new(),
            now: 0,
        }
    }

    fn clear(&mut self, lane: usize) {
        self.inputs.clear(lane);
        self.contacts.clear(lane);
        self.states[self.now].clear(lane);
    }

    /// An impact at its start.
    pub fn begin(&mut self, lane: usize, impact: &Impact) {
        self.clear(lane);
        let input = &impact.input;
        let specimen = impact.lane_specimen(None).expect("batched");
        let set = |row: &mut Row, value: f64| row[lane] = value;
        let structure = Structure {
            mass: input.mass,
            damping: input.damping,
            tangent: input.stiffness,
        };

        let inputs = &mut self.inputs;
        set(&mut inputs.mass, input.mass);
        set(&mut inputs.damping, input.damping);
        set(&mut inputs.time_step, input.time_step);
        set(
            &mut inputs.largest_tangent,
            input.max_tangent_ratio * input.stiffness,
        );
        match specimen {
            LaneSpecimen::Elastic(model) => set(&mut inputs.stiffness, model.stiffness),
            LaneSpecimen::Bilinear(model) => {
                let [stiffness, hardened, half_band] = model.lines();
                set(&mut inputs.stiffness, stiffness);
                set(&mut inputs.hardened, hardened);
                set(&mut inputs.half_band, half_band);
            }
        }
        set(&mut inputs.striker_mass, input.striker_mass);
        set(&mut inputs.gravity, input.gravity);
        set(
            &mut inputs.striker_compliance,
            input.time_step / input.striker_mass,
        );
        let force_limit = match input.law {
            ContactLaw::Limit { force } => force,
            _ => f64::INFINITY,
        };
        set(&mut inputs.force_limit, force_limit);
        set(&mut inputs.striker_energy, input.striker_energy());

        let state = &mut self.states[self.now];
        set(&mut state.tangent, input.stiffness);
        set(
            &mut state.effective,
            structure.effective_mass(input.time_step),
        );
        set(&mut state.input, input.striker_energy());
        set(&mut state.striker_displacement, 0.0 - input.gap);
        set(&mut state.striker_velocity, input.striker_velocity);
        set(&mut state.stop_time, f64::INFINITY);
        set(&mut self.contacts.closing, input.striker_velocity);
    }

    /// A lane without an impact: a mass at rest.
    pub fn rest(&mut self, lane: usize) {
        self.clear(lane);
        self.inputs.mass[lane] = 1.0;
        self.inputs.striker_compliance[lane] = 1.0;
        self.inputs.striker_mass[lane] = 1.0;
        let state = &mut self.states[self.now];
        state.effective[lane] = 1.0;
        // Apart for ever, and moving: it never ends.
        state.striker_displacement[lane] = -1.0;
        state.striker_velocity[lane] = f64::MIN_POSITIVE;
        self.contacts.begun[lane] = YES;
    }

    /// One step of every lane, from state `NOW` to the other one; the first step is from state 0. Whether some lane has ended with it.
    #[allow(clippy::inline_always, reason = "as `select`")]
    #[inline(always)]
    pub fn step<const YIELDS: bool, const LIMITED: bool, const NOW: usize>(
        &mut self,
        end: End,
    ) -> bool {
        let [first, second] = &mut self.states;
        let (from, to) = if NOW == 0 {
            (&*first, second)
        } else {
            (&*second, first)
        };
        self.now = 1 - NOW;
        step::<YIELDS, LIMITED>(&self.inputs, from, to, &mut self.contacts, end)
    }

    /// Whether the impact of a lane has ended.
    pub fn is_over(&self, lane: usize, end: End) -> bool {
        let state = &self.states[self.now];
        let stopped = state.striker_velocity[lane] <= 0.0 && state.velocity[lane] <= 0.0;
        state.step[lane] >= end.last || end.ends_at_stop && stopped
    }

    /// How far the impact of a lane reached.
    pub fn reach(&self, lane: usize) -> Reach {
        let state = &self.states[self.now];
        Reach {
            displacement: [state.least_displacement[lane], state.max_displacement[lane]],
            restoring_force: [state.least_force[lane], state.largest_force[lane]],
            increment: state.largest_increment[lane],
            last_velocity: state.velocity[lane],
            last_contact_force: state.contact_force[lane],
        }
    }

    /// The energy that is missing at the end of the last step \[J\].
    fn energy_error(&self, lane: usize) -> f64 {
        let (state, inputs) = (&self.states[self.now], &self.inputs);
        let (v1, vs1) = (state.velocity[lane], state.striker_velocity[lane]);
        let structure = 0.5 * (inputs.mass[lane] * v1 * v1);
        let striker = 0.5 * inputs.striker_mass[lane] * vs1 * vs1;
        let kept = striker
            + structure
            + state.restoring_energy[lane]
            + state.damping_energy[lane]
            + state.contact_loss[lane];
        inputs.striker_energy[lane] + state.weight[lane] - kept
    }

    /// The results of the impact of a lane.
    pub fn summary(&self, lane: usize, input: &ImpactInput) -> ImpactSummary {
        let state = &self.states[self.now];
        let energy_error = if state.input[lane] > 0.0 {
            self.energy_error(lane) / state.input[lane]
        } else {
            0.0
        };
        let stop_time = Some(state.stop_time[lane]).filter(|time| time.is_finite());
        let closing = self.contacts.closing[lane];
        let rebounded = self.contacts.ended[lane] == YES && closing > 0.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count below 2^53"
        )]
        let contacts = self.contacts.count[lane] as u64;
        ImpactSummary {
            max_displacement: state.max_displacement[lane],
            time_of_max_displacement: state.time_of_max_displacement[lane],
            stop_time,
            final_displacement: state.displacement[lane],
            max_velocity: state.max_velocity[lane],
            max_contact_force: state.max_contact_force[lane],
            impulse: state.impulse[lane],
            contacts,
            restitution: rebounded.then(|| -self.contacts.separating[lane] / closing),
            indentation: state.indentation[lane],
            indentation_energy: state.indentation_energy[lane],
            absorbed_energy: state.absorbed_energy[lane],
            striker_energy: input.striker_energy(),
            energy_error,
            still_rising: still_rising(
                state.velocity[lane],
                state.displacement[lane] >= state.max_displacement[lane],
            ),
            last_contact_cut: stop_time.is_some() && state.contact_force[lane] > 0.0,
        }
    }
}
