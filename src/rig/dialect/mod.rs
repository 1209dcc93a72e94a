//! The dialects, pure: bytes to messages and messages to bytes, without port, clock or state of a device.

pub mod decimal;
pub mod instron;
pub mod modbus;
