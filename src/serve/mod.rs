//! psd as a rig for others.

pub mod nees_message;
