//! What the procedures on a frame share: its floors, storeys and elements in texts, whatever moves them. It knows no striker and no ground
//! motion.

pub(crate) mod predicted;
