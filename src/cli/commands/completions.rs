//! `psd completions` and `psd man`: what a shell and `man` need to know of the command line. In: its definition. Out: text or files.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;

use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::output::print_result;

#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// Shell
    #[arg(value_enum)]
    pub shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArguments {
    /// Write the pages of all commands into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Prints the completions of a shell.
pub fn completions(
    arguments: &CompletionsArguments,
    mut definition: Command,
) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    let name = definition.get_name().to_owned();
    clap_complete::generate(arguments.shell, &mut definition, name, &mut script);
    print_result(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Met)
}

/// Prints the manual page of the program, or writes that of every command.
pub fn man(arguments: &ManArguments, definition: Command) -> Result<Exit, Failure> {
    let Some(folder) = &arguments.out else {
        let mut page = Vec::new();
        clap_mangen::Man::new(definition)
            .render(&mut page)
            .map_err(Failure::Stdout)?;
        print_result(&String::from_utf8_lossy(&page))?;
        return Ok(Exit::Met);
    };
    std::fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(definition, folder))
        .map_err(|error| Failure::file(folder, plain(&error)))?;
    print_result(&format!("{}\n", folder.display()))?;
    Ok(Exit::Met)
}
