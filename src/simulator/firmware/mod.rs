//! Firmware of the controllers that can be stood in for, one dialect a file.

mod instron;
mod line_buffer;
mod mark10;
mod mark10_gauge;
mod modbus;
mod modbus_frame;
mod modbus_registers;
mod nees;
#[cfg(test)]
mod testing;

pub use instron::Instron;
pub use mark10::Mark10;
pub use mark10_gauge::Mark10Gauge;
pub use modbus::Modbus;
pub use nees::Nees;
