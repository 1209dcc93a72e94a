//! Tests of every controller at once: opening its line, and meeting its emulator.

mod meeting;
mod open;
