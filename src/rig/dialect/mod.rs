//! Dialects: what rigs and load cells say, as bytes and as messages. In: bytes. Out: messages in SI, and the reverse.
//! No dialect reads a port or a clock, and all of them take their numbers from [`number`] alone.

pub mod grbl;
pub mod hx711;
pub mod indicator;
pub mod instron;
pub mod mark10;
pub mod modbus;
pub mod native;
pub mod native_sent;
pub mod nees;
pub mod number;
pub mod scpi;
