//! Constraint files: one pinned vertex a line, "vertex u v [weight]"; what follows a # is a comment.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::finite::check_finite;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use freebound_core::problem::{PinKind, TakenTargets};

/// What a constraint file says, with the line of each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraints {
    /// The targets: hard where no weight is given.
    pub targets: Targets,
    /// The line of each target, counted from 1.
    pub lines: BTreeMap<VertexId, u64>,
}

/// Why a constraint file is not used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintsError {
    /// The file cannot be read.
    #[error("{}: the constraints cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A line that cannot be.
    #[error("{}: line {line}: {kind}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong with it.
        kind: ConstraintFault,
    },
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintFault {
    /// Not of the form that lines have.
    #[error("write \"vertex u v\" or \"vertex u v weight\", not \"{0}\"")]
    Form(String),
    /// Something that ought to be a number is none.
    #[error("\"{0}\" is not a number")]
    BadNumber(String),
    /// A vertex number that is negative, broken, or beyond 32 bits.
    #[error("\"{0}\" is not the number of a vertex; vertices count from 0")]
    BadVertex(String),
    /// A vertex whose target is infinite or not a number.
    #[error("the target of vertex {0} is not finite")]
    NotFinite(VertexId),
    /// A weight that pulls nowhere.
    #[error("the weight {weight} of vertex {vertex} is not a positive number")]
    WeightNotPositive {
        /// The vertex.
        vertex: VertexId,
        /// Its weight.
        weight: f64,
    },
    /// A vertex that has a target already.
    #[error("vertex {vertex} has a target already, on line {first}: leave one of them out")]
    Twice {
        /// The vertex.
        vertex: VertexId,
        /// The line before.
        first: u64,
    },
    /// A target that another hard constraint has already.
    #[error(
        "vertex {vertex} has the same target as vertex {other} on line {first}: move one of them, or give a weight"
    )]
    OnePlace {
        /// The vertex.
        vertex: VertexId,
        /// The vertex that has it already.
        other: VertexId,
        /// Its line.
        first: u64,
    },
    /// A vertex that the mesh does not have.
    #[error("there is no vertex {vertex}: the mesh has {count}, numbered from 0")]
    NoSuchVertex {
        /// The vertex.
        vertex: VertexId,
        /// How many there are.
        count: usize,
    },
}

impl ConstraintsError {
    /// The vertices that the line at fault is about.
    pub fn vertices(&self) -> Vec<VertexId> {
        let Self::Line { kind, .. } = self else { return Vec::new() };
        match *kind {
            ConstraintFault::Form(_) | ConstraintFault::BadNumber(_) | ConstraintFault::BadVertex(_) => Vec::new(),
            ConstraintFault::NotFinite(vertex)
            | ConstraintFault::WeightNotPositive { vertex, .. }
            | ConstraintFault::Twice { vertex, .. }
            | ConstraintFault::NoSuchVertex { vertex, .. } => vec![vertex],
            ConstraintFault::OnePlace { vertex, other, .. } => vec![vertex, other],
        }
    }
}

impl Constraints {
    /// Reads a file for a mesh with so many vertices.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or the first line at fault.
    pub fn read(path: &Path, vertex_count: usize) -> Result<Self, ConstraintsError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| ConstraintsError::File { path: path.to_owned(), source })?;
        Self::parse(&text, vertex_count).map_err(|(line, kind)| ConstraintsError::Line {
            path: path.to_owned(),
            line,
            kind,
        })
    }

    /// Understands the text of a constraint file.
    ///
    /// # Errors
    ///
    /// The first line at fault, counted from 1.
    pub fn parse(text: &str, vertex_count: usize) -> Result<Self, (u64, ConstraintFault)> {
        let mut found = Self::default();
        let mut taken = TakenTargets::default();
        // Some editors begin a text with a byte-order mark.
        for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
            let text = text.split('#').next().unwrap_or_default().trim();
            if text.is_empty() {
                continue;
            }
            let (vertex, target) = parse_line(text).map_err(|kind| (line, kind))?;
            found.check(vertex, &target, vertex_count, &mut taken).map_err(|kind| (line, kind))?;
            found.targets.insert(vertex, target);
            found.lines.insert(vertex, line);
        }
        Ok(found)
    }

    fn check(
        &self,
        vertex: VertexId,
        target: &Target,
        vertex_count: usize,
        taken: &mut TakenTargets,
    ) -> Result<(), ConstraintFault> {
        if vertex.index() >= vertex_count {
            return Err(ConstraintFault::NoSuchVertex { vertex, count: vertex_count });
        }
        if let Some(&first) = self.lines.get(&vertex) {
            return Err(ConstraintFault::Twice { vertex, first });
        }
        match taken.take(vertex, target.uv, target.kind) {
            Some(other) => Err(ConstraintFault::OnePlace { vertex, other, first: self.lines[&other] }),
            None => Ok(()),
        }
    }
}

fn parse_line(text: &str) -> Result<(VertexId, Target), ConstraintFault> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let (&[vertex, u, v] | &[vertex, u, v, _]) = words.as_slice() else {
        return Err(ConstraintFault::Form(text.to_owned()));
    };
    let vertex: u32 = vertex.parse().map_err(|_| ConstraintFault::BadVertex(vertex.to_owned()))?;
    let vertex = VertexId::new(vertex);
    let number = |word: &str| -> Result<f64, ConstraintFault> {
        word.parse().map_err(|_| ConstraintFault::BadNumber(word.to_owned()))
    };
    let uv = DVec2::new(number(u)?, number(v)?);
    if !uv.is_finite() {
        return Err(ConstraintFault::NotFinite(vertex));
    }
    let kind = match words.get(3) {
        None => PinKind::Hard,
        Some(word) => PinKind::Soft(number(word)?),
    };
    match kind.invalid_weight() {
        Some(weight) => Err(ConstraintFault::WeightNotPositive { vertex, weight }),
        None => Ok((vertex, Target { uv, kind })),
    }
}

/// Writes targets as a constraint file; numbers read back bit for bit.
///
/// # Errors
///
/// What `out` says, and targets that are infinite or not numbers.
pub fn write_constraints(out: &mut impl Write, targets: &Targets) -> io::Result<()> {
    check_finite(targets.values().map(|target| &target.uv))?;
    writeln!(out, "# vertex u v [weight]; vertices count from 0, without a weight a target is met exactly")?;
    for (vertex, Target { uv, kind }) in targets {
        write!(out, "{} {:?} {:?}", vertex.number(), uv.x, uv.y)?;
        match kind {
            PinKind::Soft(weight) => writeln!(out, " {weight:?}")?,
            PinKind::Fixed | PinKind::Hard => writeln!(out)?,
        }
    }
    Ok(())
}
