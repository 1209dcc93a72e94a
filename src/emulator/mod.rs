//! Rig emulators: what a controller answers to the bytes that it receives, with a virtual specimen
//! behind it. In: bytes and time. Out: bytes. It shares no parsing code with the drivers in `rig`,
//! so that neither hides an error of the other.

mod bench;
mod faulty;
pub mod firmware;
pub mod lines;
mod log;
mod of_plan;
mod of_ram;
pub mod script;
mod stand;
#[cfg(test)]
pub(crate) mod testing;

pub use bench::fault::BenchFault;
pub use bench::glide::{NoWay, WayEnd};
pub use bench::ram::RamSettings;
pub use bench::{Bench, BenchSettings, SentMove};
pub use faulty::Faulty;
pub use lines::in_process::{InProcess, SimulatedClock, SimulatedPort};
pub use lines::pseudo_terminal::PseudoTerminal;
pub use lines::tcp::TcpLine;
pub use log::Log;
pub use of_plan::{NoStandIn, of_plan};
pub use script::Script;
pub use stand::Stand;

/// What a controller's firmware does. It owns its dialect; the [`Bench`] owns motion, specimen and sensors.
pub trait Firmware: Send {
    /// Bytes came from the host, in pieces of any size. The bench's time has been brought up to now.
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8>;

    /// Time has passed: what the controller says or does by itself (streams, watchdogs).
    fn tick(&mut self, bench: &mut Bench) -> Vec<u8>;

    /// Power was cycled: everything it remembered is gone.
    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8>;
}
