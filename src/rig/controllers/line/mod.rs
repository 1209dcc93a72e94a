//! The line to one device: whole lines from bytes in pieces, requests sent again after silence, and numbers as text. It
//! knows no protocol.

pub mod client;
pub mod number;
pub mod request_reply;
pub mod stream;
pub mod unsequenced;
