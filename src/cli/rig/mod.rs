//! `psd rig …`: one file a command.

mod list;

use super::args::RigCommand;
use super::exit::{Exit, Failure};
use super::settings::Settings;

/// Does one of the commands.
pub fn rig(command: &RigCommand, _settings: Settings) -> Result<Exit, Failure> {
    match command {
        RigCommand::List => list::list(),
    }
}
