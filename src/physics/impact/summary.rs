//! Results of an impact: peaks, times, impulse, energies. In: the ends of its steps, of one impact or of several side by side.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use super::{ImpactInput, ImpactState, Sink};
use crate::contact::ContactLaw;
use crate::contact::state::StepState;
use crate::integrator::state::State;
use crate::number::{Number, numbers};

/// Results of an impact. Peaks are over step ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactSummary {
    /// \[m\]
    pub max_displacement: f64,
    /// \[s\]
    pub time_of_max_displacement: f64,
    /// End of the first step with Ẋs ≤ 0 \[s\].
    pub stop_time: Option<f64>,
    /// Computed X at the end of the run \[m\].
    pub final_displacement: f64,
    /// Largest |Ẋ| \[m/s\].
    pub max_velocity: f64,
    /// \[N\]
    pub max_contact_force: f64,
    /// ∫F dt \[N·s\]
    pub impulse: f64,
    /// Number of contacts that began ([`crate::contact::Advance::contacts`]).
    pub contacts: u64,
    /// Coefficient of restitution of the first contact, separation over closing speed; None before it has ended.
    pub restitution: Option<f64>,
    /// \[m\]
    pub indentation: f64,
    /// \[J\]
    pub indentation_energy: f64,
    /// ∫R dX up to the largest X \[J\].
    pub absorbed_energy: f64,
    /// ½ Ms V0² \[J\]
    pub striker_energy: f64,
    /// Over the energy put into the test ([`ImpactState::input`]).
    pub energy_error: f64,
    /// The structure was still moving outwards at the largest X: it is not a peak.
    pub still_rising: bool,
    /// The striker has stopped, and the contact was still active at the last step.
    pub last_contact_cut: bool,
}

/// The end of a step, as far as the results follow it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepEnd<N = f64> {
    /// Time \[s\], or the number of the step.
    pub instant: N,
    pub displacement: N,
    pub velocity: N,
    pub restoring_force: N,
    pub contact_force: N,
    /// ∫R dX so far \[J\].
    pub restoring_energy: N,
}

numbers! {
    /// The results that every step changes, so far.
    pub(crate) struct RunningResults {
        max_displacement,
        /// Of the largest displacement.
        instant,
        absorbed_energy,
        max_velocity,
        max_contact_force,
        impulse,
    }
}

impl RunningResults {
    /// Before step 0.
    pub const START: Self = Self {
        max_displacement: f64::NEG_INFINITY,
        instant: 0.0,
        absorbed_energy: 0.0,
        max_velocity: 0.0,
        max_contact_force: 0.0,
        impulse: 0.0,
    };
}

/// How an impact ended, as far as its largest values depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "independent facts")]
pub struct ImpactEnding {
    /// The striker has moved forward in every step.
    pub still_striking: bool,
    /// A contact force has acted.
    pub touched: bool,
    /// The structure was still moving outwards at its largest X.
    pub still_rising: bool,
    /// |Ẋ| was larger at the last step than ever before.
    pub speeding_up: bool,
    /// F was larger in the last step than ever before.
    pub pushing_harder: bool,
}

/// The results that are asked of many impacts: a running result costs as much as a part of the step. The largest displacement, the contacts,
/// the end of the run and its energy error are always found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "independent results")]
pub struct Wanted {
    pub time_of_max_displacement: bool,
    pub absorbed_energy: bool,
    pub max_velocity: bool,
    pub max_contact_force: bool,
    pub impulse: bool,
    /// The ranges that limits of a rig bound ([`super::batch::Reach`]).
    pub reach: bool,
}

impl Wanted {
    pub const ALL: Self = Self {
        time_of_max_displacement: true,
        absorbed_energy: true,
        max_velocity: true,
        max_contact_force: true,
        impulse: true,
        reach: true,
    };
}

/// The next step, and the results that are wanted of it.
pub(crate) struct Next<'a, N> {
    pub wanted: Wanted,
    pub time_step: N,
    pub end: &'a StepEnd<N>,
}

impl<R> RunningResults<R> {
    /// Adds the end of the next step to those of `before` that are wanted. `get` and `set` read and write a result of one impact, or of
    /// several side by side.
    #[inline(always)]
    pub fn add<N: Number>(
        &mut self,
        before: &Self,
        next: &Next<N>,
        get: impl Fn(&R) -> N,
        mut set: impl FnMut(&mut R, N),
    ) {
        let Next {
            wanted,
            time_step,
            end,
        } = *next;
        let largest = get(&before.max_displacement);
        let farther = end.displacement.gt(largest);
        let chosen = |now: N, before: &R| N::choose(farther, || now, || get(before));
        set(&mut self.max_displacement, largest.larger(end.displacement));
        if wanted.time_of_max_displacement {
            set(&mut self.instant, chosen(end.instant, &before.instant));
        }
        if wanted.absorbed_energy {
            let absorbed = chosen(end.restoring_energy, &before.absorbed_energy);
            set(&mut self.absorbed_energy, absorbed);
        }
        if wanted.max_velocity {
            let fastest = get(&before.max_velocity).larger(end.velocity.abs());
            set(&mut self.max_velocity, fastest);
        }
        if wanted.max_contact_force {
            let most = get(&before.max_contact_force).larger(end.contact_force);
            set(&mut self.max_contact_force, most);
        }
        if wanted.impulse {
            let impulse = get(&before.impulse) + end.contact_force * time_step;
            set(&mut self.impulse, impulse);
        }
    }
}

impl RunningResults {
    /// Adds the end of the next step.
    #[inline(always)]
    pub fn push(&mut self, time_step: f64, end: &StepEnd) {
        let next = Next {
            wanted: Wanted::ALL,
            time_step,
            end,
        };
        let before = *self;
        self.add(
            &before,
            &next,
            |number| *number,
            |number, found| *number = found,
        );
    }
}

/// What happens in few steps: contacts that begin and end, the stop of the striker.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Events {
    /// End of the first step with Ẋs ≤ 0 \[s\], or the number of the step.
    pub stop: Option<f64>,
    pub contacts: u64,
    /// Closing speed at the last step end before the first contact \[m/s\].
    closing: Option<f64>,
    /// The same when the first contact has ended.
    separating: Option<f64>,
}

impl Events {
    /// A contact begins, after a step end with this closing speed \[m/s\].
    pub fn contact_begins(&mut self, closing: f64) {
        self.closing.get_or_insert(closing);
    }

    /// A contact has ended at the end of the free step that follows it, with this closing speed \[m/s\]: the tensile step, repeated as a
    /// free one.
    pub fn contact_ends(&mut self, closing: f64) {
        self.separating.get_or_insert(closing);
    }

    /// Coefficient of restitution of the first contact; None before it has ended.
    fn restitution(&self) -> Option<f64> {
        let (closing, separating) = (self.closing?, self.separating?);
        (closing > 0.0).then(|| -separating / closing)
    }
}

/// The last step end.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LastEnd {
    pub displacement: f64,
    pub velocity: f64,
    pub contact_force: f64,
    pub indentation: f64,
    pub indentation_energy: f64,
    /// \[J\]
    pub energy_error: f64,
    /// The energy put into the test \[J\].
    pub input: f64,
}

impl ImpactSummary {
    /// The results of all steps so far.
    pub(crate) fn new(
        input: &ImpactInput,
        results: &RunningResults,
        events: &Events,
        last: &LastEnd,
    ) -> Self {
        let restitution = match input.law {
            // Located inside a step: the coefficient of the law, because the ends of the step include later contacts.
            ContactLaw::Restitution { coefficient } => (events.contacts > 0).then_some(coefficient),
            _ => events.restitution(),
        };
        let farthest = results.max_displacement;
        Self {
            max_displacement: if farthest == f64::NEG_INFINITY {
                0.0
            } else {
                farthest
            },
            time_of_max_displacement: results.instant,
            stop_time: events.stop,
            final_displacement: last.displacement,
            max_velocity: results.max_velocity,
            max_contact_force: results.max_contact_force,
            impulse: results.impulse,
            contacts: events.contacts,
            restitution,
            indentation: last.indentation,
            indentation_energy: last.indentation_energy,
            absorbed_energy: results.absorbed_energy,
            striker_energy: input.striker_energy(),
            energy_error: if last.input > 0.0 {
                last.energy_error / last.input
            } else {
                0.0
            },
            still_rising: still_rising(last.velocity, last.displacement >= farthest),
            last_contact_cut: events.stop.is_some() && last.contact_force > 0.0,
        }
    }
}

/// Sums up steps one by one, step 0 first.
#[derive(Clone, Debug)]
pub struct SummaryBuilder {
    input: ImpactInput,
    pub(super) results: RunningResults,
    events: Events,
    pub(super) last: LastEnd,
    /// Closing speed at the last step end \[m/s\], and whether the step was one in contact.
    closing: f64,
    touching: bool,
}

impl SummaryBuilder {
    /// Before step 0.
    #[must_use]
    pub fn new(input: &ImpactInput) -> Self {
        Self {
            input: *input,
            results: RunningResults::START,
            events: Events::default(),
            last: LastEnd::default(),
            closing: input.striker_velocity,
            touching: false,
        }
    }

    /// Adds the end of the next step.
    #[inline(always)]
    pub fn push(&mut self, state: &ImpactState) {
        self.results.push(self.input.time_step, &state.step_end());
        self.events.contacts = state.contacts;
        if self.events.stop.is_none() && state.step > 0 && state.striker_velocity <= 0.0 {
            self.events.stop = Some(state.time);
        }
        let touching = state.state != StepState::Free;
        let closing = state.striker_velocity - state.velocity;
        match (self.touching, touching) {
            (false, true) => self.events.contact_begins(self.closing),
            (true, false) => self.events.contact_ends(closing),
            _ => {}
        }
        (self.touching, self.closing) = (touching, closing);
        self.last = LastEnd {
            displacement: state.displacement,
            velocity: state.velocity,
            contact_force: state.contact_force,
            indentation: state.indentation,
            indentation_energy: state.energies.indentation,
            energy_error: state.energies.error,
            input: state.input,
        };
    }

    /// The structure was moved to this displacement \[m\] by this time \[s\], in a step that did not end.
    pub fn moved_to(&mut self, displacement: f64, time: f64) {
        if displacement > self.results.max_displacement {
            self.results.max_displacement = displacement;
            self.results.instant = time;
        }
    }

    /// The results of all steps so far.
    #[must_use]
    pub fn finish(self) -> ImpactSummary {
        ImpactSummary::new(&self.input, &self.results, &self.events, &self.last)
    }
}

impl<V> Sink<V> for SummaryBuilder {
    fn push(&mut self, _: &State<V>, state: &ImpactState, _: bool) {
        self.push(state);
    }
}

/// Whether a structure that ends with `velocity` Ẋ \[m/s\] was still moving outwards; `at_largest`: it ends at its largest X.
/// A run that continues past that has a peak, whatever its direction at the end.
pub fn still_rising(velocity: f64, at_largest: bool) -> bool {
    velocity > 0.0 && at_largest
}
