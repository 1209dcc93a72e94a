//! Whole runs as processes: `psd` against `psd rig simulate` over real pseudo-terminals, killed, starved, frozen and
//! talked at. What needs a program of the system is skipped without it, and fails where `PSD_REQUIRE_SYSTEM=1`, also where
//! the machine forbids what the program does.

mod amended;
mod book;
mod build;
mod certificate;
mod clock;
mod disk;
mod ended;
mod faults;
mod floors;
mod frame;
mod golden;
mod hand;
mod killed;
mod lost;
mod named;
mod needs;
mod opensees;
mod person;
mod released;
mod resumed;
mod served;
mod signals;
mod signed;
mod stage;
mod terminal;
mod twice;
mod unasked;
