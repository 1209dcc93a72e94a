//! psd's own line protocol: `codec` turns bytes into meaning, `driver` leads the conversation,
//! `sent` reads logged commands back.

pub mod codec;
pub(crate) mod driver;
pub mod sent;
