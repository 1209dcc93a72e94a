//! Mark-10 test frames and force gauges: `codec` turns bytes into meaning, `driver` and `load_cell` lead the conversation.

pub mod codec;
pub mod driver;
pub mod load_cell;
