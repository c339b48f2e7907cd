//! Errors of a command: their words and their exit status.

use std::fmt::{self, Display, Formatter};
use std::path::Path;

use crate::session::{Model, MorphShortage};
use freebound_core::mesh::{Diagnosis, Done, Repairs};
use freebound_core::problem::{Cause, Method, NamedOption as _, SolveError};
use freebound_io::{ConstraintsError, EdgesError, MemoryShortage, PictureError, ReadError, TextureError, WriteError};

/// Our fault, or the system's.
const INTERNAL: u8 = 1;

/// Options that do not go together; clap's number too.
pub(super) const WRONG_USE: u8 = 2;

/// A file that cannot be used.
pub(super) const UNUSABLE_INPUT: u8 = 3;

/// [`CommandOutcome::FallsShort`], and no embedding at all.
pub(super) const FALLS_SHORT: u8 = 4;

/// What to do where only some corners have texture coordinates.
pub(super) const TEXTURE_REMEDY: &str = "give every corner texture coordinates, or none";

/// What to do where a file may take too much memory.
pub(super) const MEMORY_REMEDY: &str = "--large reads it all the same";

/// What to do where a single method gives no embedding.
pub(super) const METHOD_REMEDY: &str = "try --method auto";

/// What to do where there is no morph through the maps of the methods.
pub(super) const MORPH_REMEDY: &str =
    "choose with --methods those with planar maps that lie alike, such as convex,schnyder,auto";

/// What to do where the frames of a morph take too much memory.
pub(super) const FRAMES_REMEDY: &str = "ask for fewer --frames, or name fewer --methods";

/// Ended by Ctrl-C.
pub(super) const INTERRUPTED: u8 = 130;

/// A command that ran to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandOutcome {
    /// Planar and proved, or nothing to object to.
    Fine,
    /// Finished and written, but not planar, or a constraint is not met.
    FallsShort,
}

/// A command that could not do its work.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// The file cannot be read.
    #[error("{}; {}", on_each_line(path, error), error.remedy())]
    Read {
        /// The file.
        path: String,
        /// What is wrong with it.
        error: ReadError,
    },
    /// The file may take more than half of the machine's memory.
    #[error("{path}: {shortage}; {MEMORY_REMEDY}")]
    Memory {
        /// The file.
        path: String,
        /// What it may take, and what there is.
        shortage: MemoryShortage,
    },
    /// The constraint file cannot be used.
    #[error("{0}")]
    Constraints(#[from] ConstraintsError),
    /// The file of edges cannot be used.
    #[error("{0}")]
    Edges(#[from] EdgesError),
    /// The picture cannot be read.
    #[error("{0}")]
    Picture(#[from] PictureError),
    /// The texture coordinates make no mesh.
    #[error("{path}: {error}; {TEXTURE_REMEDY}")]
    Texture {
        /// The file.
        path: String,
        /// What is wrong with them.
        error: TextureError,
    },
    /// The mesh is not a disk.
    #[error("{path}: cannot be flattened as it is\n{diagnosis}{}", remedy.as_ref().map(Remedy::to_string).unwrap_or_default())]
    NotADisk {
        /// The file.
        path: String,
        /// Everything that is wrong with it.
        diagnosis: Box<Diagnosis>,
        /// What would make a disk of it, where that can be.
        remedy: Option<Remedy>,
    },
    /// The solver gave no embedding. The name of the mesh is said before it.
    #[error("{0}")]
    Solve(#[from] SolveError),
    /// A single method gave none.
    #[error("{method}: {error}; {METHOD_REMEDY}")]
    Method {
        /// The method's name.
        method: &'static str,
        /// Why it gave none.
        error: SolveError,
    },
    /// There is no planar morph through the maps of the methods.
    #[error("{path}: {what}; {MORPH_REMEDY}")]
    NoMorph {
        /// The file.
        path: String,
        /// Why there is none.
        what: String,
    },
    /// The frames of a morph would take more than half of the machine's memory.
    #[error("{path}: {shortage}; {FRAMES_REMEDY}")]
    MorphMemory {
        /// The file.
        path: String,
        /// What they would take, and what there is.
        shortage: MorphShortage,
    },
    /// A result could not be written, or a file that is copied with it could not be read.
    #[error("{0}")]
    Write(#[from] WriteError),
    /// Standard output takes no more.
    #[error("standard output: cannot be written: {0}")]
    StandardOutput(#[source] std::io::Error),
    /// Asked for something that cannot be.
    #[error("{0}")]
    Usage(String),
}

/// How a mesh can be mended.
#[derive(Clone, Debug)]
pub struct Remedy {
    /// What is done then.
    done: Vec<Done>,
    /// Options that go with those that were given.
    options: Vec<&'static str>,
}

impl Remedy {
    /// What would make a disk of a mesh, or several, where that can be.
    pub(super) fn of(model: &Model) -> Option<Self> {
        let form = &model.prepared.form;
        let all = (form.repair.and(Repairs::ALL) != form.repair).then_some("--repair all");
        let auto = (!form.cut).then_some("--cut auto");
        let remedy = model.prepared.remedy.as_ref()?;
        Some(Self { done: remedy.done().to_vec(), options: all.into_iter().chain(auto).collect() })
    }
}

impl Display for Remedy {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.done.is_empty() {
            return f.write_str("\nnone of this does harm: it can be flattened without --repair none");
        }
        let done: Vec<String> = self.done.iter().map(ToString::to_string).collect();
        write!(f, "\nit can be mended by adding {}: {}", self.options.join(" "), done.join(", "))
    }
}

impl CommandError {
    /// A method's failure: where another may do better, with that hint.
    pub fn of_method(method: &Method, error: SolveError) -> Self {
        if error.is_failure_of_method() && *method != Method::Auto {
            return Self::Method { method: method.name(), error };
        }
        Self::Solve(error)
    }

    /// The exit status: 1 internal, 2 wrong use, 3 unusable input, 4 no embedding by this method or no morph, 130 interrupted. Every
    /// error is named, so that a new one has to choose.
    pub fn code(&self) -> u8 {
        match self {
            Self::Read { error: ReadError::Cancelled, .. } => INTERRUPTED,
            Self::Read { .. }
            | Self::Memory { .. }
            | Self::Constraints(_)
            | Self::Edges(_)
            | Self::Picture(_)
            | Self::Texture { .. }
            | Self::NotADisk { .. } => UNUSABLE_INPUT,
            Self::NoMorph { .. } | Self::MorphMemory { .. } => FALLS_SHORT,
            Self::Write(error) if error.is_not_finite() => FALLS_SHORT,
            Self::Write(error) if error.is_of_input() => UNUSABLE_INPUT,
            Self::Write(_) | Self::StandardOutput(_) => INTERNAL,
            Self::Usage(_) => WRONG_USE,
            Self::Solve(error) | Self::Method { error, .. } => code_of_solve(error),
        }
    }
}

const fn code_of_solve(error: &SolveError) -> u8 {
    match error.cause() {
        Cause::Cancelled => INTERRUPTED,
        Cause::Targets => UNUSABLE_INPUT,
        Cause::Method => FALLS_SHORT,
        Cause::Request => WRONG_USE,
    }
}

/// A message with the name of its file before each line.
fn on_each_line(path: &str, message: &impl Display) -> String {
    let lines: Vec<String> = message.to_string().lines().map(|line| format!("{path}: {line}")).collect();
    lines.join("\n")
}

/// The message of an error, the name of the run's mesh first if there is one.
pub(super) fn message_of(error: &CommandError, mesh: Option<&Path>) -> String {
    match (error, mesh) {
        (CommandError::Solve(_) | CommandError::Method { .. }, Some(mesh)) => {
            format!("{}: {error}", name_of_input(mesh))
        }
        _ => error.to_string(),
    }
}

/// Name of standard input in messages.
pub(super) const STANDARD_INPUT: &str = "standard input";

/// True if a path stands for standard input or output.
pub(super) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// Name of an input in messages.
pub(super) fn name_of_input(path: &Path) -> String {
    if is_standard(path) { STANDARD_INPUT.to_owned() } else { path.display().to_string() }
}
