//! Rig emulators: the answers of a controller to the bytes that it receives, with an emulated specimen. In: bytes and time.
//! Out: bytes. It shares no parsing code with the drivers in `rig`, so that neither hides an error of the other.

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

/// The firmware of a controller. It owns its protocol; the [`Bench`] owns motion, specimen and sensors.
pub trait Firmware: Send {
    /// Handles bytes from the host, in parts of any size. The bench is already at the present time.
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8>;

    /// Handles elapsed time: unsolicited output and actions of the controller (streams, watchdogs).
    fn tick(&mut self, bench: &mut Bench) -> Vec<u8>;

    /// Handles a power cycle: the controller loses its whole state.
    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8>;
}
