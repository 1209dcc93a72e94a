//! One stand-in controller a file, each with its dialect written from the manuals and from nothing of the drivers.

mod native;

#[cfg(test)]
pub use native::sealed;
pub use native::{Native, NativeSettings};
