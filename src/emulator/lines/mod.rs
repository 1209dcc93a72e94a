//! Lines on which an emulated controller is reached: in the process, over TCP, over a
//! pseudo-terminal. In: bytes and time. Out: bytes. They know no protocol.

pub(crate) mod pseudo_terminal;
pub mod real_time;
pub(crate) mod tcp;
