//! The procedures of the language, one file in the folder of each: its block and its results. The list of them is here.

mod common;
pub(crate) mod tracking;

pub(crate) use crate::procedures::base_excitation::data::block as base_excitation;
pub(crate) use crate::procedures::cycle::data::block as cycle;
pub(crate) use crate::procedures::damping_sweep::data::block as damping_sweep;
pub(crate) use crate::procedures::impact::data::block as impact;
pub(crate) use crate::procedures::impact_series::data::block as impact_series;
pub(crate) use crate::procedures::inspect::data::block as inspect;
pub(crate) use crate::procedures::move_to::data::block as move_to;
pub(crate) use crate::procedures::stiffness_ramp::data::block as stiffness_ramp;
pub(crate) use crate::procedures::unload::data::block as unload;
use crate::schema::types::BlockKind;
pub(crate) use common::{SPECIMEN, SPEED, STIFFNESS};

/// The blocks of the procedures, in the order of the reference.
pub(crate) const BLOCKS: &[&BlockKind] = &[
    &stiffness_ramp::BLOCK,
    &damping_sweep::BLOCK,
    &impact::BLOCK,
    &cycle::BLOCK,
    &base_excitation::BLOCK,
    &impact_series::BLOCK,
    &unload::BLOCK,
    &move_to::BLOCK,
    &inspect::BLOCK,
];
