//! Protocols in which a coordinator drives a rig: their messages as bytes. In: bytes. Out: what is asked, and the bytes of the answer. They
//! drive nothing.

pub mod generic_header;
pub mod nees_message;
