//! Completions for shells, and manual pages. Both are generated from the arguments.

use std::path::Path;

use clap::CommandFactory as _;
use clap_complete::Shell;
use clap_mangen::Man;

use super::args::Arguments;
use super::error::{CommandError, CommandOutcome};
use super::say::say;
use freebound_io::{WriteError, write_atomically};

/// Prints completions for a shell.
pub(super) fn completions(shell: Shell) -> Result<CommandOutcome, CommandError> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "freebound", &mut text);
    say(String::from_utf8_lossy(&text).trim_end()).map(|()| CommandOutcome::Fine)
}

/// Writes manual pages of all commands into a folder.
pub(super) fn man(folder: &Path) -> Result<CommandOutcome, CommandError> {
    std::fs::create_dir_all(folder).map_err(|error| WriteError::writing(folder, error))?;
    let mut program = Arguments::command();
    program.build();
    let commands: Vec<clap::Command> = program.get_subcommands().cloned().collect();
    let pages =
        std::iter::once((String::from("freebound"), program.clone())).chain(commands.into_iter().map(|command| {
            let name = format!("freebound-{}", command.get_name());
            (name.clone(), command.display_name(name))
        }));
    for (name, command) in pages {
        write_atomically(&folder.join(format!("{name}.1")), |out| Man::new(command.clone()).render(out))?;
    }
    Ok(CommandOutcome::Fine)
}
