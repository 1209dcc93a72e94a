//! Rig emulators: the answers of a controller to the bytes that it receives, with an emulated specimen. In: bytes and time.
//! Out: bytes. It shares no parsing code with the drivers in `rig`, so that neither hides an error of the other.

mod emulated_rig;
mod faulty;
pub mod firmware;
pub mod lines;
mod log;
mod of_plan;
mod one_actuator;
mod rig_emulator;
pub mod script;

pub use emulated_rig::actuator::ActuatorSettings;
pub use emulated_rig::axial::{ForceControl, LeftForceControl};
pub use emulated_rig::fault::MechanicalFault;
pub use emulated_rig::smooth_paths::{PathEnd, PathRefusal};
pub use emulated_rig::{EmulatedRig, EmulatedRigSettings, SentMove};
pub use faulty::Faulty;
pub use lines::pseudo_terminal::PseudoTerminal;
pub use lines::tcp::TcpLine;
pub use log::Log;
pub use of_plan::{NoStandIn, of_plan};
pub use rig_emulator::RigEmulator;
pub use script::Script;

/// The firmware of a controller. It owns its protocol; the [`EmulatedRig`] owns motion, specimen and sensors.
pub trait Firmware: Send {
    /// Handles bytes from the host, in parts of any size. The emulated rig is already at the present time.
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8>;

    /// Handles elapsed time: unsolicited output and actions of the controller (streams, watchdogs).
    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8>;

    /// Handles a power cycle: the controller loses its whole state.
    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8>;
}
