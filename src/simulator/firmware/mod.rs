//! One stand-in controller a file, each with its dialect written from the manuals and from nothing of the drivers.

mod grbl;
mod hx711;
mod indicator;
mod native;
mod scpi;

pub use grbl::Grbl;
pub use hx711::Hx711;
pub use indicator::Indicator;
#[cfg(test)]
pub use native::sealed;
pub use native::{Native, NativeSettings};
pub use scpi::Scpi;
