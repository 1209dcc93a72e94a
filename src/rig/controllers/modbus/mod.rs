//! Modbus RTU drives: `codec` turns bytes into registers, `driver` leads the conversation.

pub mod codec;
pub(crate) mod driver;
