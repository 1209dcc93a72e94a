//! Frames of many degrees of freedom: modes, integrators, loads and impacts, compared with independent solutions.

mod field;
mod gravity;
mod ground;
mod impact;
mod modes;
mod order;
mod storey_impact;
mod support;
