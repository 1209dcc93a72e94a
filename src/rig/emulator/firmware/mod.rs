//! Emulated controllers, one file or folder per protocol, written from the manuals of the makers. In: bytes
//! from the host. Out: bytes of the controller. They must not know the drivers in `rig`.

mod grbl;
mod hx711;
mod indicator;
mod instron;
mod line_buffer;
mod mark10;
mod modbus;
mod native;
mod nees;
mod scpi;
#[cfg(test)]
pub mod testing;

pub use grbl::Grbl;
pub use hx711::Hx711;
pub use indicator::Indicator;
pub use instron::Instron;
pub use mark10::{Mark10, Mark10Gauge};
pub use modbus::Modbus;
pub use native::{Native, NativeSettings, sealed};
pub use nees::Nees;
pub use scpi::Scpi;
