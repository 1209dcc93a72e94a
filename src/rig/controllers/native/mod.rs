//! psd's own line protocol: `codec` turns bytes into meaning, `driver` leads the conversation.

pub mod codec;
pub mod driver;
