//! Lines on which an emulated controller is reached: in the process, over TCP, over a
//! pseudo-terminal. In: bytes and time. Out: bytes. They know no protocol.

pub mod pseudo_terminal;
pub mod real_time;
pub mod tcp;
