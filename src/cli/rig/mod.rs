//! `psd rig …`: one file a command.

mod list;
mod serve;

use super::args::RigCommand;
use super::exit::{Exit, Failure};
use super::settings::Settings;

/// Does one of the commands.
pub fn rig(command: &RigCommand, settings: Settings) -> Result<Exit, Failure> {
    match command {
        RigCommand::List => list::list(),
        RigCommand::Serve(arguments) => serve::serve(arguments, settings),
    }
}
