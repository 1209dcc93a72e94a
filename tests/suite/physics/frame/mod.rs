//! Frames of many degrees of freedom: modes, integrators, loads, blows, each against what is known of it otherwise.

mod blow;
mod field;
mod ground;
mod impact;
mod modes;
mod order;
mod support;
