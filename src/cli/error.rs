//! Errors of a command: their messages and their exit statuses.

use std::fmt::{self, Display, Formatter};
use std::path::Path;

use crate::session::MorphShortage;
use freebound_core::mesh::{Diagnosis, Done, Repair, Repairs};
use freebound_core::problem::{Cause, Method, NamedOption as _, SolveError};
use freebound_io::{
    ConstraintsError, EdgesError, LayoutError, LayoutToPackError, MemoryShortage, PatternError, PictureError, PtsError,
    ReadError, TextureError, TransferError, WriteError,
};
use freebound_run::{Model, RunError};

/// Exit status of an internal or system error.
pub(super) const INTERNAL: u8 = 1;

/// Exit status of invalid usage. clap uses this number, too.
pub(super) const WRONG_USE: u8 = 2;

/// Exit status of an input that cannot be used.
pub(super) const UNUSABLE_INPUT: u8 = 3;

/// Exit status of [`CommandOutcome::FallsShort`], and of a run without an embedding.
pub(super) const FALLS_SHORT: u8 = 4;

/// Remedy if only some corners have texture coordinates.
pub(super) const TEXTURE_REMEDY: &str = "give every corner texture coordinates, or none";

/// Remedy if there is no layout to pack.
pub(super) const LAYOUT_REMEDY: &str = "make texture coordinates with freebound unwrap";

/// Remedy if a file may take too much memory.
pub(super) const MEMORY_REMEDY: &str = "add --large to read it anyway";

/// Remedy if a single method finds no embedding.
pub(super) const METHOD_REMEDY: &str = "try --method auto";

/// Remedy if there is no morph through the maps of the methods.
pub(super) const MORPH_REMEDY: &str =
    "use --methods to choose planar maps of one orientation, such as convex,schnyder,auto";

/// Remedy if the frames of a morph take too much memory.
pub(super) const FRAMES_REMEDY: &str = "use fewer --frames or fewer --methods";

/// Exit status after Ctrl-C.
pub(super) const INTERRUPTED: u8 = 130;

/// Outcome of a command that ran to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandOutcome {
    /// The result is planar and proved, or there is nothing to object to.
    Fine,
    /// The result is written, but is not planar or misses a constraint.
    FallsShort,
    /// A batch has ended. The number is the worst exit status of its meshes.
    Batch(u8),
}

impl CommandOutcome {
    /// Outcome of a command whose result has to be planar and to meet its constraints.
    pub fn of(is_fine: bool) -> Self {
        if is_fine { Self::Fine } else { Self::FallsShort }
    }
}

/// Error of a command that failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// The file cannot be read.
    #[error("{}; {}", on_each_line(path, error), error.remedy())]
    Read {
        /// Name of the file.
        path: String,
        /// Reason of the failure.
        error: ReadError,
    },
    /// The file may take more than half of the machine's memory.
    #[error("{path}: {shortage}; {MEMORY_REMEDY}")]
    Memory {
        /// Name of the file.
        path: String,
        /// Memory that the file may take, and memory of the machine.
        shortage: MemoryShortage,
    },
    /// The constraint file cannot be used.
    #[error("{0}")]
    Constraints(#[from] ConstraintsError),
    /// The file of landmarks cannot be used.
    #[error("{0}")]
    Landmarks(#[from] PtsError),
    /// The file of edges cannot be used.
    #[error("{0}")]
    Edges(#[from] EdgesError),
    /// The picture cannot be read.
    #[error("{0}")]
    Picture(#[from] PictureError),
    /// The texture coordinates are incomplete.
    #[error("{path}: {error}; {TEXTURE_REMEDY}")]
    Texture {
        /// Name of the file.
        path: String,
        /// Fault of the texture coordinates.
        error: TextureError,
    },
    /// The texture coordinates cannot be packed.
    #[error("{path}: {error}; {LAYOUT_REMEDY}")]
    LayoutToPack {
        /// Name of the file.
        path: String,
        /// Fault of the texture coordinates.
        error: LayoutToPackError,
    },
    /// The texture coordinates cannot be copied, or their picture cannot be drawn anew.
    #[error("{path}: {error}; {}", transfer_remedy(error))]
    Transfer {
        /// Name of the file.
        path: String,
        /// Fault of the texture coordinates or of the mesh.
        error: TransferError,
    },
    /// The mesh is not a disk.
    #[error("{path}: the mesh cannot be flattened\n{diagnosis}{}", remedy.as_ref().map(Remedy::to_string).unwrap_or_default())]
    NotADisk {
        /// Name of the file.
        path: String,
        /// All faults of the mesh.
        diagnosis: Box<Diagnosis>,
        /// Repair that makes the mesh a disk, if there is one.
        remedy: Option<Remedy>,
    },
    /// The solver found no embedding. The name of the mesh is printed before the message.
    #[error("{0}")]
    Solve(#[from] SolveError),
    /// A single method found no embedding.
    #[error("{method}: {error}; {METHOD_REMEDY}")]
    Method {
        /// Name of the method.
        method: &'static str,
        /// Reason of the failure.
        error: SolveError,
    },
    /// There is no planar morph through the maps of the methods.
    #[error("{path}: {what}; {MORPH_REMEDY}")]
    NoMorph {
        /// Name of the file.
        path: String,
        /// Reason of the failure.
        what: String,
    },
    /// The frames of a morph would take more than half of the machine's memory.
    #[error("{path}: {shortage}; {FRAMES_REMEDY}")]
    MorphMemory {
        /// Name of the file.
        path: String,
        /// Memory that the frames would take, and memory of the machine.
        shortage: MorphShortage,
    },
    /// The charts have no cutting pattern.
    #[error("--pattern: {0}")]
    Pattern(#[from] PatternError),
    /// A result cannot be written, or a file to be copied with it cannot be read.
    #[error("{0}")]
    Write(#[from] WriteError),
    /// Standard output cannot be written.
    #[error("standard output: cannot be written: {0}")]
    StandardOutput(#[source] std::io::Error),
    /// The options or their combination are invalid.
    #[error("{0}")]
    Usage(String),
}

/// Repair of a mesh that makes it a disk or several disks.
#[derive(Clone, Debug)]
pub struct Remedy {
    /// Repairs that are applied.
    done: Vec<Done>,
    /// Options to add to the given ones, or to use instead.
    options: Vec<String>,
}

impl Remedy {
    /// Repair that makes a mesh a disk or several disks, if there is one.
    pub(super) fn of(model: &Model) -> Option<Self> {
        let form = &model.prepared.form;
        let done = model.prepared.remedy.as_ref()?.done();
        let wanted = done.iter().map(|done| done.repair).filter(|repair| Repair::CHOSEN.contains(repair));
        let repairs = wanted.fold(form.repair, Repairs::with);
        let repair = (repairs != form.repair).then(|| format!("--repair {repairs}"));
        let cuts = done.iter().any(|done| done.repair == Repair::Cut) && !form.cut;
        let options = repair.into_iter().chain(cuts.then(|| "--cut auto".to_owned()));
        Some(Self { done: done.to_vec(), options: options.collect() })
    }
}

impl Display for Remedy {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.done.is_empty() {
            return f.write_str("\nthese faults are harmless: drop --repair none to flatten the mesh");
        }
        // The number of edges depends on the seams, which are not found yet.
        let words = |done: &Done| match done.repair {
            Repair::Cut => "surface cut open along seams".to_owned(),
            _ => done.to_string(),
        };
        let done: Vec<String> = self.done.iter().map(words).collect();
        write!(f, "\nto repair the mesh, add {}: {}", self.options.join(" "), done.join(", "))
    }
}

impl CommandError {
    /// Creates the error of a method. The message suggests another method if that can help.
    pub fn of_method(method: &Method, error: SolveError) -> Self {
        if error.is_failure_of_method() && *method != Method::Auto {
            return Self::Method { method: method.name(), error };
        }
        Self::Solve(error)
    }

    /// Error of an option that names a chart by a number that no chart has.
    pub(super) fn no_such_chart(option: &str, chart: usize, count: usize) -> Self {
        Self::Usage(match count {
            1 => format!("{option} {chart}: the mesh has only chart 0"),
            _ => format!("{option} {chart}: the mesh has charts 0 to {}", count.saturating_sub(1)),
        })
    }

    /// Error of a run of a mesh. Its message has the remedy.
    pub(super) fn of_run(model: &Model, error: RunError<Self>) -> Self {
        let path = model.path_words();
        match error {
            RunError::NotADisk(diagnosis) => Self::NotADisk { path, diagnosis, remedy: Remedy::of(model) },
            RunError::Layout(error) => Self::of_layout(model, error),
            RunError::Solve(error) => Self::Solve(error),
            RunError::TrueSize(error) => Self::Usage(format!("--fit true: {error}")),
            RunError::Observer(error) => error,
            // Options that the mesh lacks data for.
            error => Self::Usage(format!("{path}: {error}")),
        }
    }

    /// Error of a mesh or chart that cannot start from its layout, with the remedy.
    pub(super) fn of_layout(model: &Model, error: LayoutError) -> Self {
        if let Some(file) = &model.layout_file {
            return Self::of_other_layout(file.path.clone(), error);
        }
        let path = model.path_words();
        match error {
            LayoutError::Texture(error @ TextureError::Missing(_)) => Self::Texture { path, error },
            LayoutError::Torn { .. } => {
                let remedy = "add --charts uv to cut the surface along its texture seams, or remove --start uv";
                Self::Usage(format!("{path}: {error}: {remedy}"))
            }
            LayoutError::Texture(_) | LayoutError::NoVertex { .. } => {
                Self::Usage(format!("{path}: {error}: remove --start uv"))
            }
        }
    }

    /// Error of a mesh that cannot start from the layout of another file, with the remedy.
    pub(super) fn of_other_layout(path: String, error: LayoutError) -> Self {
        let remedy = match error {
            LayoutError::Texture(error @ TextureError::Missing(_)) => return Self::Texture { path, error },
            LayoutError::Texture(_) => "choose a file that has them, or remove --start",
            LayoutError::Torn { .. } => "flatten this file itself with --charts uv --start uv",
            LayoutError::NoVertex { .. } => "choose a layout of this mesh with equal vertex numbers",
        };
        Self::Usage(format!("{path}: {error}: {remedy}"))
    }

    /// Exit status: 1 internal, 2 invalid usage, 3 unusable input, 4 no embedding by this method or no morph, 130
    /// interrupted. The match lists every error, so that a new variant needs a decision.
    pub fn code(&self) -> u8 {
        match self {
            Self::Read { error: ReadError::Cancelled, .. } => INTERRUPTED,
            Self::Read { .. }
            | Self::Memory { .. }
            | Self::Constraints(_)
            | Self::Landmarks(_)
            | Self::Edges(_)
            | Self::Picture(_)
            | Self::Texture { .. }
            | Self::LayoutToPack { .. }
            | Self::Transfer { .. }
            | Self::NotADisk { .. } => UNUSABLE_INPUT,
            Self::Usage(_) | Self::Pattern(PatternError::TooWide { .. } | PatternError::TooManyPages { .. }) => {
                WRONG_USE
            }
            Self::NoMorph { .. } | Self::MorphMemory { .. } | Self::Pattern(_) => FALLS_SHORT,
            Self::Write(error) if error.is_not_finite() => FALLS_SHORT,
            Self::Write(error) if error.is_of_input() => UNUSABLE_INPUT,
            Self::Write(_) | Self::StandardOutput(_) => INTERNAL,
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

/// Remedy if a layout cannot be copied.
pub(super) const fn transfer_remedy(error: &TransferError) -> &'static str {
    match error {
        TransferError::Texture(TextureError::Missing(_)) => TEXTURE_REMEDY,
        TransferError::NoFaces => "choose a mesh with faces",
        _ => LAYOUT_REMEDY,
    }
}

/// Message with the name of its file before each line.
fn on_each_line(path: &str, message: &impl Display) -> String {
    let lines: Vec<String> = message.to_string().lines().map(|line| format!("{path}: {line}")).collect();
    lines.join("\n")
}

/// Message of an error, preceded by the name of the run's mesh if the error does not name it.
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
