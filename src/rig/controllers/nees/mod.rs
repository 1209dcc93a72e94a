//! NEES sites: `codec` turns messages into meaning, `driver` leads the conversation.

pub mod codec;
pub mod driver;
