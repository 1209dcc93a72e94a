//! Stand-ins for rigs: what a controller does with the bytes it gets, and a specimen that answers. In: bytes and time.
//! Out: bytes. It shares no parsing code with the drivers in `rig`, so that one cannot hide a mistake of the other.

mod bench;
mod bench_fault;
mod bench_glide;
mod faulty;
pub mod firmware;
mod in_process;
mod log;
mod of_plan;
mod of_ram;
mod pseudo_terminal;
mod ram;
pub mod script;
pub mod serve;
mod stand;
mod structure;
mod tcp;
#[cfg(test)]
pub(crate) mod testing;

pub use bench::{Bench, BenchSettings, SentMove};
pub use bench_fault::BenchFault;
pub use bench_glide::{NoWay, WayEnd};
pub use faulty::Faulty;
pub use in_process::{InProcess, SimulatedClock, SimulatedPort};
pub use log::Log;
pub use of_plan::{NoStandIn, of_plan};
pub use pseudo_terminal::PseudoTerminal;
pub use ram::RamSettings;
pub use script::Script;
pub use stand::Stand;
pub use tcp::TcpLine;

/// What a controller's firmware does. It owns its dialect; the [`Bench`] owns motion, specimen and sensors.
pub trait Firmware: Send {
    /// Bytes came from the host, in pieces of any size. The bench's time has been brought up to now.
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8>;

    /// Time has passed: what the controller says or does by itself (streams, watchdogs).
    fn tick(&mut self, bench: &mut Bench) -> Vec<u8>;

    /// Power was cycled: everything it remembered is gone.
    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8>;
}
