//! Load cells on a weighing indicator: `codec` reads its lines, `driver` samples them. It commands
//! no motion.

pub mod codec;
pub mod driver;
