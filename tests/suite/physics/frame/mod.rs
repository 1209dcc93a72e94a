//! Frames of many degrees of freedom: modes, integrators, loads, blows, each against what is known of it otherwise.

mod modes;
mod order;
mod support;
