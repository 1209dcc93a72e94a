//! One stand-in controller a file, each with its dialect written from the manuals and from nothing of the drivers.

mod native;

pub use native::{Native, NativeSettings};
