//! Command line: the library without a screen.
//!
//! | file          | content                                                                  |
//! |---------------|--------------------------------------------------------------------------|
//! | `mod`         | runs a command; list of methods and families                             |
//! | `args/`       | arguments of the program                                                 |
//! | `typed`       | parsers for values of options                                            |
//! | `flatten`     | commands `flatten` and `unwrap`; the example if no window can be opened                |
//! | `job`         | flattening of one chart or several, with outputs and summary             |
//! | `pack`        | command `pack`: new places for the charts of an existing layout          |
//! | `batch/`      | command `batch`: many meshes side by side                                |
//! | `check`       | command `check`: diagnosis of a mesh, verdict on its texture coordinates |
//! | `compare`     | command `compare`: several methods on one mesh                           |
//! | `morph`       | planar morph through the maps of compared methods                        |
//! | `figures/`    | command `figures`: reproduction of the paper's figures                   |
//! | `study`       | command `study`: the iteration on many random trials                     |
//! | `progress`    | progress line, and Ctrl-C                                                |
//! | `summary`     | summary of a run, and output of its report                               |
//! | `failed`      | report of a failed run                                                   |
//! | `opened`      | loaded mesh of a run in its preparation, with its pins and its picture   |
//! | `parts`       | parts of a mesh that are flattened                                       |
//! | `pattern`     | cutting pattern of a run                                                 |
//! | `pins`        | requested pins                                                           |
//! | `places`      | clashes between the files of a run                                       |
//! | `seams`       | requested preparation of a mesh, with its seams                          |
//! | `shell`       | completions for shells, and manual pages                                 |
//! | `standard`    | `-` as a file: standard input and output                                 |
//! | `say`         | lines on standard output and standard error                              |
//! | `error`       | errors of a command: their messages and exit statuses                    |
//! | `example`     | files of a built-in example                                            |
//! | `exit`        | end of a command: last message, report, exit status                      |
//! | `report_file` | writing of report files                                                  |
//! | `awaited`     | report file of the current run                                           |
//! | `transfer`    | commands `transfer` and `bake`: layouts and pictures of other meshes     |
//! | `carry`       | command `carry`: constraints of another mesh                             |
//! | `threads`     | number of threads of a run                                               |

mod args;
mod awaited;
mod batch;
mod carry;
mod check;
mod compare;
mod error;
mod example;
mod exit;
mod failed;
mod figures;
mod flatten;
mod job;
mod morph;
mod opened;
mod pack;
mod parts;
mod pattern;
mod pins;
mod places;
mod progress;
mod report_file;
mod say;
mod seams;
mod shell;
mod standard;
mod study;
mod summary;
mod threads;
mod tiles;
mod transfer;
mod typed;

use std::process::ExitCode;

use self::failed::ReportTarget;
use freebound_core::problem::{Family, Labels, Method, NamedOption};

pub use args::{
    Arguments, BakeArguments, BatchArguments, BatchCommand, BatchFormat, CarryArguments, CompareArguments,
    ComparisonFile, CompletionsArguments, Cut, ExampleArguments, FlattenArguments, ManArguments, MeshArguments,
    PackArguments, PatternArguments, SolveArguments, StartOf, StudyArguments, Subcommands, ThreadArguments,
    TransferArguments, TypedShape, UnwrapArguments,
};
pub use error::{CommandError, CommandOutcome, Remedy};
pub use figures::pairs;
pub use flatten::run_example;
pub use progress::ProgressForm;
pub use say::warn;

/// Runs a command and returns its exit status.
pub fn run(command: &Subcommands, form: ProgressForm) -> ExitCode {
    progress::set_form(form);
    progress::stop_on_interrupt();
    let (outcome, subject) = match command {
        Subcommands::Flatten(arguments) => (flatten::run(arguments), Some((&arguments.input.mesh, &arguments.report))),
        Subcommands::Unwrap(arguments) => {
            (flatten::unwrap(&arguments.flatten), Some((&arguments.flatten.input.mesh, &arguments.flatten.report)))
        }
        Subcommands::Pack(arguments) => (pack::run(arguments), Some((&arguments.mesh, &arguments.result.report))),
        Subcommands::Transfer(arguments) => {
            (transfer::run(arguments), Some((&arguments.mesh, &arguments.result.report)))
        }
        Subcommands::Bake(arguments) => (transfer::run_bake(arguments), Some((&arguments.new, &arguments.report))),
        Subcommands::Carry(arguments) => (carry::run(arguments), Some((&arguments.new, &arguments.report))),
        Subcommands::Compare(arguments) => (compare::run(arguments), Some((&arguments.input.mesh, &arguments.report))),
        Subcommands::Check(arguments) => (check::run(arguments), Some((&arguments.mesh, &arguments.report))),
        Subcommands::Batch(arguments) => (batch::run(arguments), None),
        Subcommands::Completions(arguments) => (shell::completions(arguments.shell), None),
        Subcommands::Man(arguments) => (shell::man(&arguments.folder), None),
        Subcommands::Figures(arguments) => (figures::run(&arguments.folder), None),
        Subcommands::Study(arguments) => (study::run(arguments), None),
        Subcommands::Example(arguments) => (example::run(arguments), None),
        Subcommands::Methods => {
            let lists = [list::<Method>("Methods (--method)"), list::<Family>("Families of weights (--family)")];
            (say::say(lists.join("\n\n")).map(|()| CommandOutcome::Fine), None)
        }
    };
    exit::conclude(outcome, subject.map(|(mesh, report)| ReportTarget { mesh, report: report.as_deref() }))
}

/// List of names, each with its description and its source.
fn list<C: NamedOption>(title: &str) -> String {
    let entry = |Labels { name, about, source, .. }| format!("  {name:<17} {about}\n  {:<17} {source}", "");
    let entries = C::ALL.iter().map(|choice| entry(choice.labels()));
    std::iter::once(title.to_owned()).chain(entries).collect::<Vec<_>>().join("\n")
}
