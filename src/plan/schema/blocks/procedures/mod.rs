//! The list of the procedures of the language. The block and the results of each are in its folder of `plan::procedures`.

mod common;
pub mod tracking;

use crate::procedures::{
    cycle, damping_sweep, escalate, impact, inspect, move_to, preload, shake, stiffness_ramp,
    unload,
};
use crate::schema::types::BlockKind;
pub use common::{SPECIMEN, SPEED, STIFFNESS};

/// The blocks of the procedures, in the order of the reference.
pub const BLOCKS: &[&BlockKind] = &[
    &stiffness_ramp::block::BLOCK,
    &damping_sweep::block::BLOCK,
    &impact::block::BLOCK,
    &cycle::block::BLOCK,
    &shake::block::BLOCK,
    &escalate::block::BLOCK,
    &unload::block::BLOCK,
    &move_to::block::BLOCK,
    &preload::block::BLOCK,
    &inspect::block::BLOCK,
];
