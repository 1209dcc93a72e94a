//! Actuator tracking: how an actuator follows its commands, and the effect on energy and stability.
//! In: commands and measured displacements. Out: tracking errors and indicators. It knows no rig.

pub mod monitor;
pub mod trajectory;
