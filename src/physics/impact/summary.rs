//! Results of an impact: peaks, times, impulse, energies. In: the ends of its steps.

use super::{ImpactInput, ImpactState, Sink};
use crate::contact::ContactLaw;
use crate::contact::state::StepState;
use crate::integrator::state::State;

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

/// The first contact in progress.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FirstContact {
    /// Closing speed at the last step end without contact \[m/s\].
    ToCome {
        closing: f64,
    },
    UnderWay {
        closing: f64,
    },
    Over {
        restitution: Option<f64>,
    },
}

/// Sums up steps one by one, step 0 first.
#[derive(Clone, Debug)]
pub struct SummaryBuilder {
    input: ImpactInput,
    first_contact: FirstContact,
    last_velocity: f64,
    /// \[N\]
    last_contact_force: f64,
    summary: ImpactSummary,
}

impl SummaryBuilder {
    /// Before step 0.
    #[must_use]
    pub fn new(input: &ImpactInput) -> Self {
        Self {
            input: *input,
            first_contact: FirstContact::ToCome {
                closing: input.striker_velocity,
            },
            last_velocity: 0.0,
            last_contact_force: 0.0,
            summary: ImpactSummary {
                max_displacement: f64::NEG_INFINITY,
                time_of_max_displacement: 0.0,
                stop_time: None,
                final_displacement: 0.0,
                max_velocity: 0.0,
                max_contact_force: 0.0,
                impulse: 0.0,
                contacts: 0,
                restitution: None,
                indentation: 0.0,
                indentation_energy: 0.0,
                absorbed_energy: 0.0,
                striker_energy: input.striker_energy(),
                energy_error: 0.0,
                still_rising: false,
                last_contact_cut: false,
            },
        }
    }

    /// Adds the end of the next step.
    pub fn push(&mut self, state: &ImpactState) {
        let summary = &mut self.summary;
        if state.displacement > summary.max_displacement {
            summary.max_displacement = state.displacement;
            summary.time_of_max_displacement = state.time;
            summary.absorbed_energy = state.energies.restoring;
        }
        summary.final_displacement = state.displacement;
        summary.max_velocity = summary.max_velocity.max(state.velocity.abs());
        summary.max_contact_force = summary.max_contact_force.max(state.contact_force);
        summary.impulse += state.contact_force * self.input.time_step;
        summary.indentation = state.indentation;
        summary.indentation_energy = state.energies.indentation;
        if state.input > 0.0 {
            summary.energy_error = state.energies.error / state.input;
        }
        if summary.stop_time.is_none() && state.step > 0 && state.striker_velocity <= 0.0 {
            summary.stop_time = Some(state.time);
        }
        let touching = state.state != StepState::Free;
        summary.contacts = state.contacts;
        self.follow_first_contact(state, touching);
        self.last_velocity = state.velocity;
        self.last_contact_force = state.contact_force;
    }

    /// The structure was moved to this displacement \[m\] by this time \[s\], in a step that did not end.
    pub fn moved_to(&mut self, displacement: f64, time: f64) {
        if displacement > self.summary.max_displacement {
            self.summary.max_displacement = displacement;
            self.summary.time_of_max_displacement = time;
        }
    }

    /// A contact has ended at the end of the free step that follows it: the tensile step, repeated as a free one.
    fn follow_first_contact(&mut self, state: &ImpactState, touching: bool) {
        let closing_now = state.striker_velocity - state.velocity;
        self.first_contact = match self.first_contact {
            FirstContact::ToCome { closing } if touching => FirstContact::UnderWay { closing },
            FirstContact::ToCome { .. } => FirstContact::ToCome {
                closing: closing_now,
            },
            FirstContact::UnderWay { closing } if !touching => FirstContact::Over {
                restitution: (closing > 0.0).then(|| -closing_now / closing),
            },
            unchanged => unchanged,
        };
    }

    /// The results of all steps so far.
    #[must_use]
    pub fn finish(mut self) -> ImpactSummary {
        self.summary.restitution = match (self.input.law, self.first_contact) {
            // Located inside a step: the coefficient of the law, because the ends of the step include later contacts.
            (ContactLaw::Restitution { coefficient }, _) => {
                (self.summary.contacts > 0).then_some(coefficient)
            }
            (_, FirstContact::Over { restitution }) => restitution,
            _ => None,
        };
        self.summary.still_rising = still_rising(
            self.last_velocity,
            self.summary.final_displacement >= self.summary.max_displacement,
        );
        self.summary.last_contact_cut =
            self.summary.stop_time.is_some() && self.last_contact_force > 0.0;
        if self.summary.max_displacement == f64::NEG_INFINITY {
            self.summary.max_displacement = 0.0;
        }
        self.summary
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
