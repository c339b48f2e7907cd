//! Files of a built-in example, written into a folder.

use std::fs;
use std::io::{ErrorKind, Write as _};

use super::args::ExampleArguments;
use super::error::{CommandError, CommandOutcome};
use super::say::say;
use crate::examples::ExampleFiles;
use freebound_io::{WriteError, write_atomically};

/// Writes the files of an example, or lists all examples if none is named. A file that is there with other contents is an
/// error, and then nothing is written.
pub(super) fn run(arguments: &ExampleArguments) -> Result<CommandOutcome, CommandError> {
    let ExampleArguments { name, folder } = arguments;
    let Some(example) = name.as_deref().and_then(|name| ExampleFiles::ALL.into_iter().find(|e| e.name == name)) else {
        let line = |example: ExampleFiles| format!("{:<10} {}", example.name, example.about);
        say(ExampleFiles::ALL.map(line).join("\n"))?;
        return Ok(CommandOutcome::Fine);
    };
    let differs = |&(file, bytes): &(&str, &[u8])| match fs::read(folder.join(file)) {
        Ok(there) => there != bytes,
        Err(error) => error.kind() != ErrorKind::NotFound,
    };
    if let Some((file, _)) = example.files.iter().copied().find(differs) {
        let path = folder.join(file);
        return Err(CommandError::Usage(format!(
            "{} exists with other contents: name another folder, or remove the file",
            path.display()
        )));
    }
    fs::create_dir_all(folder).map_err(|source| WriteError::writing(folder, source))?;
    for &(file, bytes) in example.files {
        write_atomically(&folder.join(file), |out| out.write_all(bytes))?;
    }
    let names = example.files.iter().map(|(file, _)| *file).collect::<Vec<_>>().join(", ");
    say(format_args!("wrote {names} into {}", folder.display()))?;
    Ok(CommandOutcome::Fine)
}
