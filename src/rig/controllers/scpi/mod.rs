//! SCPI transducers: `codec` turns bytes into meaning, `driver` samples them. It commands no
//! motion.

pub mod codec;
pub mod driver;
