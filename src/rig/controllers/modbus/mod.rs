//! Modbus RTU drives: `codec` turns bytes into registers, `driver` leads the conversation, `word_order` allows a
//! target.

pub mod codec;
pub mod driver;
mod word_order;
