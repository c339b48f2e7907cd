//! Starts the editor or the command line.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser as _;
use freebound::cli::{Arguments, run, run_example, warn};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match arguments.command {
        Some(command) => run(&command, arguments.progress),
        None => open(arguments.file.as_deref()),
    }
}

#[cfg(feature = "gui")]
fn open(file: Option<&Path>) -> ExitCode {
    let has_file = file.is_some();
    match freebound::app::run(file.map(Path::to_owned)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) if has_file => {
            warn(format_args!("{reason}. Without a screen use: freebound flatten MESH -o OUT.obj"));
            ExitCode::FAILURE
        }
        Err(reason) => {
            warn(format_args!("{reason}; flattening the built-in example without a screen instead"));
            run_example()
        }
    }
}

#[cfg(not(feature = "gui"))]
fn open(file: Option<&Path>) -> ExitCode {
    if file.is_some() {
        warn("this build has no editor. Use: freebound flatten MESH -o OUT.obj");
        return ExitCode::from(2);
    }
    warn("this build has no editor; flattening the built-in example instead");
    run_example()
}
