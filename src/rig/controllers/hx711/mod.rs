//! Load cells on an HX711 converter: `codec` reads its lines, `driver` samples them. It commands no
//! motion.

pub mod codec;
pub mod driver;
