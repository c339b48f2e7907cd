//! The command line: the same library without a screen.
//!
//! | file          | what it holds                                                          |
//! |---------------|------------------------------------------------------------------------|
//! | `mod`         | runs a command; list of methods and families                           |
//! | `args/`       | what can be typed                                                      |
//! | `typed`       | what is typed for an option, read                                      |
//! | `flatten`     | reads, solves, proves and writes; the example where no window opens    |
//! | `job`         | a flattening of one chart or several, written and summed up            |
//! | `check`       | diagnosis of a mesh, verdict on its texture coordinates                |
//! | `compare`     | several methods on one mesh, side by side                              |
//! | `morph`       | the planar morph through maps that were compared                       |
//! | `figures`     | the paper's figures, computed again                                    |
//! | `study`       | the iteration on many random trials                                    |
//! | `progress`    | the line that follows the work, and Ctrl-C                             |
//! | `summary`     | the lines that sum a run up, and where its report goes                 |
//! | `failed`      | the report of a run that came to nothing                               |
//! | `opened`      | the mesh of a run in its form, with its pins and its picture           |
//! | `parts`       | the parts of a mesh that are flattened                                 |
//! | `pins`        | the pins that are asked for                                            |
//! | `places`      | files of a run that must not be one another                            |
//! | `seams`       | the form that a mesh is asked for in, with its seams                   |
//! | `standard`    | `-` as a file: standard input and output                               |
//! | `say`         | words on standard output and standard error                            |
//! | `error`       | errors of a command: their words and their exit status                 |
//! | `exit`        | the end of a command: last words, report, exit status                  |
//! | `report_file` | the report as a file                                                   |
//! | `awaited`     | the report file of a run under way                                     |
//! | `threads`     | the threads of a run                                                   |

mod args;
mod awaited;
mod check;
mod compare;
mod error;
mod exit;
mod failed;
mod figures;
mod flatten;
mod job;
mod morph;
mod opened;
mod parts;
mod pins;
mod places;
mod progress;
mod report_file;
mod say;
mod seams;
mod standard;
mod study;
mod summary;
mod threads;
mod typed;

use std::process::ExitCode;

use self::failed::ReportTarget;
use freebound_core::problem::{Family, Labels, Method, NamedOption};

pub use args::{
    Arguments, CompareArguments, ComparisonFile, Cut, FlattenArguments, MeshArguments, SeamKind, SolveArguments,
    StartOf, StudyArguments, Subcommands, ThreadArguments, TypedShape,
};
pub use error::{CommandError, CommandOutcome, Remedy};
pub use figures::pairs;
pub use flatten::run_example;
pub use say::warn;

/// Runs a command and says how it ended.
pub fn run(command: &Subcommands) -> ExitCode {
    progress::stop_on_interrupt();
    let (outcome, subject) = match command {
        Subcommands::Flatten(arguments) => (flatten::run(arguments), Some((&arguments.input.mesh, &arguments.report))),
        Subcommands::Compare(arguments) => (compare::run(arguments), Some((&arguments.input.mesh, &arguments.report))),
        Subcommands::Check(arguments) => (check::run(arguments), Some((&arguments.mesh, &arguments.report))),
        Subcommands::Figures(arguments) => (figures::run(&arguments.folder), None),
        Subcommands::Study(arguments) => (study::run(arguments), None),
        Subcommands::Methods => {
            let lists = [list::<Method>("Methods (--method)"), list::<Family>("Families of weights (--family)")];
            (say::say(lists.join("\n\n")).map(|()| CommandOutcome::Fine), None)
        }
    };
    exit::conclude(outcome, subject.map(|(mesh, report)| ReportTarget { mesh, report: report.as_deref() }))
}

/// Names on the left; beside each what it does, and below that where it comes from.
fn list<C: NamedOption>(title: &str) -> String {
    let entry = |Labels { name, about, source, .. }| format!("  {name:<17} {about}\n  {:<17} {source}", "");
    let entries = C::ALL.iter().map(|choice| entry(choice.labels()));
    std::iter::once(title.to_owned()).chain(entries).collect::<Vec<_>>().join("\n")
}
