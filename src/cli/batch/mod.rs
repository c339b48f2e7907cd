//! `freebound batch`: one command on many meshes, side by side within a budget of memory.
//!
//! Each mesh is run by a process of its own, so that no mesh can harm another. Results are written whole or not at all,
//! each before its record. A batch that was killed goes on with `--resume`.
//!
//! | file     | contents                                       |
//! |----------|------------------------------------------------|
//! | `mod`    | the batch: schedule, progress, summary         |
//! | `files`  | meshes of a batch, and places of their results |
//! | `record` | record of one mesh                             |

mod files;
mod record;

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use self::files::{BatchFile, files};
use self::record::{BatchOptions, Record, Status};
use clap::Parser as _;

use super::args::{Arguments, BatchArguments, Subcommands};
use super::error::{CommandError, CommandOutcome, WRONG_USE};
use super::progress::{ProgressLine, go_on, is_interrupted};
use super::say::{say, warn};
use freebound_core::problem::SolveError;
use freebound_io::{FileStamp, WriteError, machine_memory_bytes};

/// Interval of checks for an interrupt while a mesh runs.
const TICK: Duration = Duration::from_millis(5);

/// Memory of the machine if the system does not tell, bytes.
const USUAL_MEMORY: u64 = 4 << 30;

pub(super) fn run(arguments: &BatchArguments) -> Result<CommandOutcome, CommandError> {
    let start = Instant::now();
    let files = files(arguments)?;
    let cores = available_parallelism().map_or(1, Into::into);
    let jobs = arguments.jobs.map_or(cores, Into::into).min(files.len());
    let options = options_of(arguments);
    check_options(&options)?;
    let has_threads = options.iter().any(|option| option.to_string_lossy().starts_with("--threads"));
    let threads = (!has_threads).then(|| format!("--threads={}", (cores / jobs).max(1)));
    let program = std::env::current_exe().map_err(|error| CommandError::Usage(format!("the program: {error}")))?;
    let memory = arguments.memory.unwrap_or_else(|| machine_memory_bytes().unwrap_or(USUAL_MEMORY) / 2);
    let batch = Batch {
        program: &program,
        options: &options,
        recorded: BatchOptions::of(&options),
        threads,
        files: &files,
        resume: arguments.resume,
        memory,
        state: Mutex::default(),
        freed: Condvar::new(),
    };
    let progress = ProgressLine::default();
    progress.follow(|| {
        progress.enter("running");
        std::thread::scope(|scope| {
            let worker = || batch.work(&progress);
            let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(worker)).collect();
            for worker in workers {
                drop(worker.join());
            }
        });
    });
    let state = batch.state.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(failure) = state.failure {
        return Err(failure);
    }
    go_on()?;
    warn(summary(&state.records, start.elapsed()));
    Ok(CommandOutcome::Batch(match state.records.iter().map(|record| record.status).max() {
        None | Some(Status::Proved) => 0,
        Some(Status::NotProved) => super::error::FALLS_SHORT,
        Some(Status::Refused) => super::error::UNUSABLE_INPUT,
        Some(Status::Failed) => super::error::INTERNAL,
    }))
}

/// Command with its options, as each mesh gets them.
fn options_of(arguments: &BatchArguments) -> Vec<OsString> {
    let command = OsString::from(arguments.command.name());
    std::iter::once(command).chain(arguments.options.iter().cloned()).collect()
}

/// Rejects options that are wrong for every mesh.
fn check_options(options: &[OsString]) -> Result<(), CommandError> {
    let words = [OsString::from("freebound")].into_iter().chain(options.iter().cloned());
    let own = ["-o", "result.obj", "--report", "report.json", "--", "mesh.obj"].map(OsString::from);
    let refused = |error: clap::Error| {
        let text = error.to_string();
        CommandError::Usage(text.trim().trim_start_matches("error: ").to_owned())
    };
    let parsed = Arguments::try_parse_from(words.chain(own)).map_err(refused)?;
    let flatten = match &parsed.command {
        Some(Subcommands::Flatten(arguments)) => arguments.as_ref(),
        Some(Subcommands::Unwrap(arguments)) => &arguments.flatten,
        _ => return Ok(()),
    };
    // All meshes would write one file.
    let files = [
        ("--svg", flatten.svg.is_some()),
        ("--png", flatten.png.is_some()),
        ("--steps", flatten.steps.is_some()),
        ("--flat-mesh", flatten.flat_mesh.is_some()),
        ("--pattern", flatten.cutting.pattern.is_some()),
        ("--copy-materials", flatten.copy_materials),
        ("--picture", flatten.picture.is_some()),
    ];
    match files.into_iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(CommandError::Usage(format!("{option} writes files of its own: run flatten for it"))),
        None => Ok(()),
    }
}

/// Sentence on all meshes.
fn summary(records: &[Record], elapsed: Duration) -> String {
    let count = |status: Status| records.iter().filter(|record| record.status == status).count();
    let ends = [
        (Status::Proved, "proved"),
        (Status::NotProved, "not proved"),
        (Status::Refused, "refused"),
        (Status::Failed, "failed"),
    ];
    let ends = ends.into_iter().map(|(status, word)| (count(status), word));
    let ends: Vec<String> =
        ends.filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}")).collect();
    let resumed = records.iter().filter(|record| record.resumed).count();
    let resumed = if resumed > 0 { format!(", {resumed} of them before") } else { String::new() };
    let meshes = if records.len() == 1 { "mesh" } else { "meshes" };
    format!("{} {meshes}: {}{resumed}; {:.1} s", records.len(), ends.join(", "), elapsed.as_secs_f64())
}

/// Batch that is running.
struct Batch<'a> {
    program: &'a Path,
    options: &'a [OsString],
    /// Options as records have them.
    recorded: BatchOptions,
    /// Option for the threads of each mesh. Results do not depend on it.
    threads: Option<String>,
    files: &'a [BatchFile],
    resume: bool,
    /// Memory for all meshes at once, bytes.
    memory: u64,
    state: Mutex<State>,
    /// Signal that memory was freed.
    freed: Condvar,
}

/// State of a batch.
#[derive(Default)]
struct State {
    /// Number of meshes that were started.
    next: usize,
    /// Estimated memory of the running meshes, bytes.
    in_use: u64,
    records: Vec<Record>,
    /// Failure that ends the batch.
    failure: Option<CommandError>,
}

impl Batch<'_> {
    /// Runs meshes until none is left.
    fn work(&self, progress: &ProgressLine) {
        while let Some(file) = self.take() {
            // A panic must not keep memory from other meshes.
            let done = catch_unwind(AssertUnwindSafe(|| self.record(file)));
            let done =
                done.unwrap_or_else(|_| Err(CommandError::StandardOutput(std::io::Error::other("internal error"))));
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            state.in_use -= file.memory;
            self.freed.notify_all();
            match done.and_then(|record| put(&record, file).map(|()| record)) {
                Ok(record) => state.records.push(record),
                Err(failure) => state.failure = state.failure.take().or(Some(failure)),
            }
            progress.reach_items(state.records.len() as u64, self.files.len() as u64, "meshes");
        }
    }

    /// Next mesh, as soon as there is memory for it. A mesh that needs more than all memory waits until it is alone.
    fn take(&self) -> Option<&BatchFile> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            let file = self.files.get(state.next).filter(|_| state.failure.is_none() && !is_interrupted())?;
            if state.in_use == 0 || state.in_use.saturating_add(file.memory) <= self.memory {
                state.next += 1;
                state.in_use += file.memory;
                return Some(file);
            }
            // An interrupt does not wake the thread.
            let waited = self.freed.wait_timeout(state, TICK);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Runs a mesh, unless the result of an earlier run can be kept.
    fn record(&self, file: &BatchFile) -> Result<Record, CommandError> {
        let start = Instant::now();
        let input_sha256 = FileStamp::read(&file.input).ok().map(|stamp| stamp.sha256);
        if self.resume
            && let Some(kept) = Record::kept(file, &self.recorded, input_sha256.as_deref())
        {
            return Ok(kept);
        }
        let folder = file.output.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(folder).map_err(|error| WriteError::writing(folder, error))?;
        // A result of an earlier run must not stay beside the record of this one.
        for path in [&Record::path(file), &file.output] {
            match std::fs::remove_file(path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(WriteError::writing(path, error).into());
                }
                _ => {}
            }
        }
        let scratch = tempfile::tempdir().map_err(|error| WriteError::writing(std::env::temp_dir(), error))?;
        let report = scratch.path().join("report.json");
        let end = self.run(file, &report)?;
        let mut record = Record {
            input: file.input.clone(),
            output: None,
            status: end.status(),
            exit_status: end.code,
            message: end.message(),
            seconds: start.elapsed().as_secs_f64(),
            faces: None,
            charts: None,
            energy: None,
            peak_memory_bytes: None,
            input_sha256,
            output_sha256: None,
            options: self.recorded.words.clone(),
            option_files: self.recorded.files.clone(),
            freebound: env!("CARGO_PKG_VERSION").to_owned(),
            resumed: false,
        };
        record.read_report(&report);
        if let Ok(stamp) = FileStamp::read(&file.output) {
            (record.output, record.output_sha256) = (Some(file.output.clone()), Some(stamp.sha256));
        }
        Ok(record)
    }

    /// Runs the command on a mesh. An interrupt ends it.
    fn run(&self, file: &BatchFile, report: &Path) -> Result<End, CommandError> {
        let mut command = Command::new(self.program);
        command
            .args(self.options)
            .args(&self.threads)
            .arg("-o")
            .arg(&file.output)
            .arg("--report")
            .arg(report)
            .arg("--")
            .arg(&file.input);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let failed = |error: std::io::Error| CommandError::StandardOutput(error);
        let mut child = command.spawn().map_err(failed)?;
        let streams = (child.stdout.take(), child.stderr.take());
        std::thread::scope(|scope| {
            // Both streams are read at once, because a full pipe stops the child.
            let words = scope.spawn(|| text_of(streams.0));
            let errors = scope.spawn(|| text_of(streams.1));
            let status = loop {
                if is_interrupted() {
                    child.kill().ok();
                }
                match child.try_wait().map_err(failed)? {
                    Some(status) => break status,
                    None => std::thread::sleep(TICK),
                }
            };
            if is_interrupted() {
                return Err(SolveError::Cancelled.into());
            }
            let (words, errors) = (words.join().unwrap_or_default(), errors.join().unwrap_or_default());
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            Ok(End { code, words, errors })
        })
    }
}

fn text_of(stream: Option<impl std::io::Read>) -> String {
    let mut bytes = Vec::new();
    if let Some(mut stream) = stream {
        stream.read_to_end(&mut bytes).ok();
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// End of a command.
struct End {
    code: Option<u8>,
    words: String,
    errors: String,
}

impl End {
    fn status(&self) -> Status {
        match self.code {
            Some(0) => Status::Proved,
            Some(super::error::FALLS_SHORT) => Status::NotProved,
            // Options that fit other meshes.
            Some(super::error::UNUSABLE_INPUT | WRONG_USE) => Status::Refused,
            _ => Status::Failed,
        }
    }

    /// Verdict, or the last message.
    fn message(&self) -> String {
        let verdict = self.words.lines().find(|line| line.contains("planar"));
        let error = self.errors.lines().rev().find(|line| !line.trim().is_empty());
        match (self.code, verdict, error) {
            (None, ..) => "ended by a signal, perhaps for lack of memory".to_owned(),
            (Some(0 | super::error::FALLS_SHORT), Some(verdict), _) => verdict.to_owned(),
            (_, _, error) => error.unwrap_or_default().trim_start_matches("freebound: ").to_owned(),
        }
    }
}

/// Writes the record of a mesh beside its result, and as a line to standard output.
fn put(record: &Record, file: &BatchFile) -> Result<(), CommandError> {
    if !record.resumed {
        record.write(file)?;
    }
    let line = serde_json::to_string(record).map_err(|error| CommandError::StandardOutput(error.into()))?;
    say(line)
}
