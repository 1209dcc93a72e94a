//! The dialects, pure: bytes to messages and messages to bytes, without port, clock or state of a device.

pub mod instron;
pub mod modbus;
pub mod number;
