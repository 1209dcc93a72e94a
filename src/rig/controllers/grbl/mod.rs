//! Grbl 1.1 stepper frames: `codec` turns bytes into meaning, `driver` leads the conversation.

pub mod codec;
pub mod driver;
