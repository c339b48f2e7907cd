//! The command line: the same library without a screen.
//!
//! | file          | what it holds                                                          |
//! |---------------|------------------------------------------------------------------------|
//! | `args`        | what can be typed                                                      |
//! | `flatten`     | reads, solves, proves and writes                                       |
//! | `check`       | diagnosis of a mesh, verdict on its texture coordinates                |
//! | `methods`     | list of methods and families                                           |
//! | `figures`     | the paper's figures, computed again                                    |
//! | `example`     | the built-in example, where no window can be opened                    |
//! | `constraints` | pins from options and from a file                                      |
//! | `progress`    | the line that follows the work, and Ctrl-C                             |
//! | `summary`     | the lines that sum a run up, and where its report goes                 |
//! | `exit`        | exit status and last words                                             |

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
