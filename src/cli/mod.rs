//! The command line: the same library without a screen.

mod args;
mod check;
mod constraints;
mod example;
mod exit;
mod figures;
mod flatten;
mod methods;
mod progress;
mod summary;

use std::process::ExitCode;

pub use args::{Arguments, Command, FlattenArguments};
pub use example::run_example;
pub use exit::{Failure, Status};
pub use figures::pairs;

/// Runs a command and says how it ended.
pub fn run(command: &Command) -> ExitCode {
    progress::stop_on_interrupt();
    let outcome = match command {
        Command::Flatten(arguments) => flatten::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Figures(arguments) => figures::run(&arguments.folder),
        Command::Methods => Ok(methods::run()),
    };
    exit::conclude(outcome)
}
