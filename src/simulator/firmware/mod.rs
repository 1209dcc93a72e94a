//! Firmware of the controllers that can be stood in for, one dialect a file.

mod instron;
mod line_buffer;
#[cfg(test)]
mod testing;

pub use instron::Instron;
