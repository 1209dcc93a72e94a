//! Instron 8800-style consoles: `codec` turns bytes into meaning, `driver` leads the conversation.

pub mod codec;
pub mod driver;
