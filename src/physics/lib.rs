//! Numerics of pseudo-dynamic structural tests: integrators, contact laws, specimen models, identification. The crate reads no file, no
//! clock and no instrument.
//!
//! In a pseudo-dynamic test the inertia, the damping and the striker are computed, and only the restoring force is measured. Each step
//! predicts a displacement, reads the force R there and ends with the motion that follows (F. J. Q. Melo et al., *A simplified method
//! for the impact test of beams using a pseudo-dynamic (PSD) process*, Mech. Res. Comm. 33 (2006) 190–205; "eq." in these pages is an
//! equation of that paper).
//!
//! # Units and signs
//! All numbers are in SI: \[m\], \[m/s\], \[N\], \[kg\], \[s\], \[J\]. Displacements and forces are positive in the direction of the
//! striker. The contact force F ≥ 0 pushes the structure forwards and the striker backwards.
//!
//! # Modules
//! | module | content |
//! |---|---|
//! | [`structure`] | matrices, beams, portals, frames, modes, damping, energies, unloading |
//! | [`integrator`] | the tangent form, explicit Newmark, α-operator splitting, their stability limits |
//! | [`contact`] | rigid, limit force, restitution, Hertz |
//! | [`impact`] | a striker on one degree of freedom or on a floor: steps, peaks, summary; many impacts at once |
//! | [`specimen`] | restoring-force (hysteretic) models |
//! | [`relaxation`] | Maxwell branches, logarithmic relaxation, their fits |
//! | [`number`] | one number, or several side by side: the arithmetic of a step |
//! | [`identification`] | fits of stiffness, yield point and damping; loops of cycles |
//! | [`tracking`] | trajectories of an actuator, monitors of its tracking error |
//! | [`reintegration`] | a recorded test integrated again with one input perturbed |
//! | [`statistics`] | least squares, Student's t |
//! | [`study`] | many runs with scattered inputs: samples, probabilities, sensitivities, fragilities, with intervals |
//! | [`self_test`] | cases with derived answers |
//!
//! # Equation of motion
//! X is the displacement of the structure and Xs that of the striker, F the force between them, f the load and g the acceleration
//! along the striker's path:
//!
//! ```text
//! M Ẍ + C Ẋ + R(X) = f(t) + F e_s        Ms Ẍs = Ms g − F                  (1), (2a), (2b)
//! ```
//!
//! M, C and K are numbers, or bands of a frame ([`structure::matrix`]); e_s is 1 at the struck degree of freedom. On ground of acceleration
//! ü_g the load is f = −M ι ü_g.
//!
//! # Tangent form of Newmark's method
//! The acceleration of a step is constant, its average. The force at its end follows the measured tangent K_t
//! ([`integrator::tangent`]), R₁ = R + K_t (X₁ − X):
//!
//! ```text
//! (M + ½Δt C + ¼Δt² K_t) Ẍ₁ = f₁ − R − C (Ẋ + ½Δt Ẍ) − K_t (Δt Ẋ + ¼Δt² Ẍ) + F e_s      (4), (5)
//! Ẋ₁ = Ẋ + ½Δt (Ẍ + Ẍ₁)        X₁ = X + ½Δt (Ẋ + Ẋ₁)                                  (2c), (2d)
//! ```
//!
//! # Operator splitting
//! The specimen is moved to a prediction d̃ that needs no stiffness. A constant operator K_I corrects the force that was read there
//! ([`integrator::step_form`]); explicit Newmark is the case without a correction:
//!
//! ```text
//! d̃₁ = d + Δt v + Δt² (½ − β) a        d₁ = d̃₁ + Δt² β a₁        r₁ = r̃₁ + K_I (d₁ − d̃₁)
//! M a₁ + (1 + α) (C v₁ + r₁) − α (C v + r) = (1 + α) f₁ − α f
//! ```
//!
//! # Contact
//! Every end velocity of the struck point is linear in the force, Ẋ₁ = v_free + w F. In the tangent form
//! w = ½Δt e_sᵀ(M + ½Δt C + ¼Δt² K_t)⁻¹e_s. Under the rigid law striker and structure end the step with one velocity:
//!
//! ```text
//! F = (V_s − v_free) / (Δt/M_s + w),        V_s = Ẋs + g Δt
//! ```
//!
//! A tensile force is dropped, and one beyond a limit force is cut to it. A contact of finite stiffness follows Hunt and Crossley,
//! with δ the overlap of the two surfaces, and divides the step where the contact is shorter than it:
//!
//! ```text
//! F = k δ^1.5 (1 + λ δ̇) ≥ 0
//! ```
//!
//! # Example
//! ```no_run
#![doc = include_str!("examples/strike_a_beam.rs")]
//! ```

pub mod contact;
pub mod identification;
pub mod impact;
pub mod integrator;
pub mod number;
pub mod reintegration;
pub mod relaxation;
pub mod self_test;
pub mod specimen;
pub mod statistics;
pub mod structure;
pub mod study;
pub mod tracking;

pub use integrator::newmark::critical_time_step;
