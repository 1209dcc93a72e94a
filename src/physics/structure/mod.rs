//! Properties of structures before they move: beams, portals, ground motion, damping, energies. In:
//! dimensions and material. Out: stiffness, mass, loads. It integrates nothing.

pub mod beam;
pub mod damping;
pub mod energies;
pub mod frame;
pub mod frame_properties;
pub mod ground;
pub mod portal;
pub mod portal_limit;
pub mod portal_mass;
