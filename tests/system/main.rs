//! Whole runs as processes: `psd` with `psd rig simulate` over real pseudo-terminals, killed, without resources, frozen and
//! with invalid input. A test that requires a program of the system is skipped without it. It fails with
//! `PSD_REQUIRE_SYSTEM=1`, also if the machine does not permit the program's action.
//!
//! The tests begin in the order of their names. The longest ones, in `book`, `by_signal` and `frame`, are among the first, so that the
//! others run beside them.

mod amended;
mod book;
mod build;
mod by_signal;
mod clock;
mod disk;
mod document;
mod editor;
mod editors;
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
mod report;
mod resumed;
mod served;
mod signed;
mod slurm;
mod stage;
mod study;
mod terminal;
mod twice;
mod unasked;
