//! `psd rig …`: one file a command.

mod list;
mod serve;
mod simulate;

use super::args::RigCommand;
use super::exit::{Exit, Failure};
use super::settings::Settings;

/// Does one of the commands.
pub fn rig(command: &RigCommand, settings: Settings) -> Result<Exit, Failure> {
    match command {
        RigCommand::List => list::list(),
        RigCommand::Simulate(arguments) => simulate::simulate(arguments, settings),
        RigCommand::Serve(arguments) => serve::serve(arguments, settings),
    }
}
