//! The command line: the same library without a screen.
//!
//! | file          | what it holds                                                          |
//! |---------------|------------------------------------------------------------------------|
//! | `mod`         | runs a command; list of methods and families                           |
//! | `args`        | what can be typed                                                      |
//! | `flatten`     | reads, solves, proves and writes; the example where no window opens    |
//! | `check`       | diagnosis of a mesh, verdict on its texture coordinates                |
//! | `figures`     | the paper's figures, computed again                                    |
//! | `progress`    | the line that follows the work, and Ctrl-C                             |
//! | `summary`     | the lines that sum a run up, and where its report goes                 |
//! | `exit`        | exit status and last words                                             |

mod args;
mod check;
mod exit;
mod figures;
mod flatten;
mod progress;
mod summary;

use std::process::ExitCode;

use crate::solver::{Choice, Family, Method};

pub use args::{Arguments, Command, FlattenArguments};
pub use exit::{Failure, Status};
pub use figures::pairs;
pub use flatten::run_example;

/// Runs a command and says how it ended.
pub fn run(command: &Command) -> ExitCode {
    progress::stop_on_interrupt();
    let outcome = match command {
        Command::Flatten(arguments) => flatten::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Figures(arguments) => figures::run(&arguments.folder),
        Command::Methods => {
            println!("Methods (--method)");
            print_list::<Method>();
            println!("\nFamilies of weights (--family)");
            print_list::<Family>();
            Ok(Status::Fine)
        }
    };
    exit::conclude(outcome)
}

/// Names on the left; beside each what it does, and below that where it comes from.
fn print_list<C: Choice>() {
    for words in C::ALL.iter().map(|choice| choice.words()) {
        println!("  {:<17} {}\n  {:<17} {}", words.name, words.about, "", words.source);
    }
}
