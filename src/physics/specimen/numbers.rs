//! The models whose parameters are numbers, from these numbers and back. In: the word of a model and its numbers, by their names in a plan.
//! Out: a [`Behaviour`]. It knows no unit, no range and no default.

use super::{Behaviour, Bolted, Capping, Deterioration, Pinching};

pub const STIFFNESS: &str = "stiffness";
pub const YIELD_FORCE: &str = "yield_force";
pub const POST_YIELD_RATIO: &str = "post_yield_ratio";
pub const ENERGY_CAPACITY: &str = "energy_capacity";
pub const UNLOADING_CAPACITY: &str = "unloading_capacity";
pub const RELOADING_CAPACITY: &str = "reloading_capacity";
pub const DETERIORATION_EXPONENT: &str = "deterioration_exponent";
pub const RESIDUAL_STRENGTH: &str = "residual_strength";
/// n of Bouc and Wen.
pub const SHARPNESS: &str = "n";
pub const BETA: &str = "beta";
pub const FORCE_FACTOR: &str = "force_factor";
pub const DISPLACEMENT_FACTOR: &str = "displacement_factor";
pub const UNLOADING_EXPONENT: &str = "unloading_exponent";
pub const CAPPING_DISPLACEMENT: &str = "capping_displacement";
pub const CAPPING_SLOPE: &str = "capping_slope";
pub const CAPPING_CAPACITY: &str = "capping_capacity";
pub const HALF_DISPLACEMENT: &str = "half_displacement";
pub const RESIDUAL: &str = "residual";
pub const BEARING_FORCE: &str = "bearing_force";
pub const CLEARANCE: &str = "clearance";
pub const SLIP_FORCE: &str = "slip_force";

impl Behaviour {
    /// The model with this word in a plan, if its parameters are numbers. `number` gives a parameter by its name, None where it is left
    /// out and has no default. None for the word of another model, or without a number that it requires.
    pub fn of_numbers(word: &str, number: impl Fn(&str) -> Option<f64>) -> Option<Self> {
        Some(match word {
            "elastic" => Self::Elastic {
                stiffness: number(STIFFNESS)?,
            },
            "bilinear" => {
                let stiffness = number(STIFFNESS)?;
                let yield_force = number(YIELD_FORCE)?;
                let post_yield_ratio = number(POST_YIELD_RATIO)?;
                match deterioration(&number)? {
                    None => Self::Bilinear {
                        stiffness,
                        yield_force,
                        post_yield_ratio,
                    },
                    Some(deterioration) => Self::DeterioratingBilinear {
                        stiffness,
                        yield_force,
                        post_yield_ratio,
                        deterioration,
                    },
                }
            }
            "bouc_wen" => Self::BoucWen {
                stiffness: number(STIFFNESS)?,
                yield_force: number(YIELD_FORCE)?,
                post_yield_ratio: number(POST_YIELD_RATIO)?,
                sharpness: number(SHARPNESS)?,
                beta: number(BETA)?,
            },
            "pinching" => {
                let (slope, residual) = (number(CAPPING_SLOPE)?, number(RESIDUAL_STRENGTH)?);
                Self::Pinching(Pinching {
                    stiffness: number(STIFFNESS)?,
                    yield_force: number(YIELD_FORCE)?,
                    post_yield_ratio: number(POST_YIELD_RATIO)?,
                    force_factor: number(FORCE_FACTOR)?,
                    displacement_factor: number(DISPLACEMENT_FACTOR)?,
                    unloading_exponent: number(UNLOADING_EXPONENT)?,
                    capping: number(CAPPING_DISPLACEMENT).map(|displacement| Capping {
                        displacement,
                        slope,
                        residual,
                    }),
                    deterioration: deterioration(&number)?,
                })
            }
            "degrading" => Self::Degrading {
                stiffness: number(STIFFNESS)?,
                half_displacement: number(HALF_DISPLACEMENT)?,
                residual: number(RESIDUAL)?,
            },
            "bolted" => Self::Bolted(Bolted {
                stiffness: number(STIFFNESS)?,
                bearing_force: number(BEARING_FORCE)?,
                clearance: number(CLEARANCE)?,
                slip_force: number(SLIP_FORCE)?,
            }),
            _ => return None,
        })
    }

    /// Its word in a plan and its numbers by their names, as [`Self::of_numbers`] takes them; None for a model with other parameters, and
    /// for one that has a description of its own.
    #[must_use]
    pub fn numbers(&self) -> Option<(&'static str, Vec<(&'static str, f64)>)> {
        Some(match *self {
            Self::Elastic { stiffness } => ("elastic", vec![(STIFFNESS, stiffness)]),
            Self::BoucWen {
                stiffness,
                yield_force,
                post_yield_ratio,
                sharpness,
                beta,
            } => (
                "bouc_wen",
                vec![
                    (STIFFNESS, stiffness),
                    (YIELD_FORCE, yield_force),
                    (POST_YIELD_RATIO, post_yield_ratio),
                    (SHARPNESS, sharpness),
                    (BETA, beta),
                ],
            ),
            Self::Degrading {
                stiffness,
                half_displacement,
                residual,
            } => (
                "degrading",
                vec![
                    (STIFFNESS, stiffness),
                    (HALF_DISPLACEMENT, half_displacement),
                    (RESIDUAL, residual),
                ],
            ),
            Self::Bolted(joint) => (
                "bolted",
                vec![
                    (STIFFNESS, joint.stiffness),
                    (BEARING_FORCE, joint.bearing_force),
                    (CLEARANCE, joint.clearance),
                    (SLIP_FORCE, joint.slip_force),
                ],
            ),
            _ => return None,
        })
    }
}

/// The rule of these numbers: Some(None) if no capacity is stated, None without a number that a rule requires.
#[expect(
    clippy::option_option,
    reason = "no deterioration and a number that is missing are different things here"
)]
fn deterioration(number: impl Fn(&str) -> Option<f64>) -> Option<Option<Deterioration>> {
    let all = [
        ENERGY_CAPACITY,
        CAPPING_CAPACITY,
        UNLOADING_CAPACITY,
        RELOADING_CAPACITY,
    ]
    .map(&number);
    let [strength, capping, unloading, reloading] =
        all.map(|capacity| capacity.unwrap_or(f64::INFINITY));
    let rule = Deterioration {
        strength,
        capping,
        unloading,
        reloading,
        exponent: number(DETERIORATION_EXPONENT)?,
        residual: number(RESIDUAL_STRENGTH)?,
    };
    Some(all.iter().any(Option::is_some).then_some(rule))
}
