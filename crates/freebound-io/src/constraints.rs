//! Constraint files: one pinned vertex per line, "vertex u v [weight]"; a # starts a comment.
//!
//! A comment behind a constraint is the name of its pin, for example `384 0.63 0.56 # left eye, outer corner`. A comment
//! that is too long for a name is a comment only. Versions without names read these files, too.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::finite::check_finite;
use super::{PictureLandmark, PinName, PinNote, PinNotes};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use freebound_core::problem::{PinKind, TakenTargets};

/// Contents of a constraint file, with the line of each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraints {
    /// Targets. Targets without a weight are hard.
    pub targets: Targets,
    /// Line of each target, counted from 1.
    pub lines: BTreeMap<VertexId, u64>,
    /// Names of pins.
    pub notes: PinNotes,
}

impl Constraints {
    /// Moves targets to the landmarks of their names. v points up. Returns the number of targets with such a name.
    pub fn move_to(&mut self, landmarks: &[PictureLandmark]) -> usize {
        let at_landmarks =
            targets_at_landmarks(&self.targets, &self.notes, landmarks, |place| DVec2::new(place.x, 1.0 - place.y));
        let count = at_landmarks.len();
        self.targets.extend(at_landmarks);
        count
    }
}

/// Targets with the names of landmarks, at those landmarks. `uv_of` gives the texture coordinates of a place of the
/// picture: distances from its left and upper side, as shares of its size.
pub fn targets_at_landmarks(
    targets: &Targets,
    notes: &PinNotes,
    landmarks: &[PictureLandmark],
    uv_of: impl Fn(DVec2) -> DVec2,
) -> Targets {
    let places: BTreeMap<String, DVec2> = landmarks.iter().map(|it| (it.name.key(), it.place)).collect();
    let at_landmark = |(&vertex, note): (&VertexId, &PinNote)| {
        let place = *places.get(&note.name.as_ref()?.key())?;
        Some((vertex, Target { uv: uv_of(place), ..*targets.get(&vertex)? }))
    };
    notes.iter().filter_map(at_landmark).collect()
}

/// Failure to read a constraint file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintsError {
    /// The file cannot be read.
    #[error("{}: the constraints cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A line is invalid.
    #[error("{}: line {line}: {kind}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// Fault of the line.
        kind: ConstraintFault,
    },
}

/// Fault of a line in a constraint file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintFault {
    /// The line has the wrong form.
    #[error("write \"vertex u v\" or \"vertex u v weight\", not \"{0}\"")]
    Form(String),
    /// A word that should be a number is none.
    #[error("\"{0}\" is not a number")]
    BadNumber(String),
    /// The vertex number is negative, malformed, or beyond 32 bits.
    #[error("\"{0}\" is not a vertex number; vertices are numbered from 0")]
    BadVertex(String),
    /// The target of the vertex is infinite or not a number.
    #[error("the target of vertex {0} is not finite")]
    NotFinite(VertexId),
    /// The weight is not a positive number.
    #[error("the weight {weight} of vertex {vertex} is not a positive number")]
    WeightNotPositive {
        /// The vertex.
        vertex: VertexId,
        /// Its weight.
        weight: f64,
    },
    /// The vertex already has a target.
    #[error("vertex {vertex} already has a target on line {first}: remove one of them")]
    Twice {
        /// The vertex.
        vertex: VertexId,
        /// Line of the first target.
        first: u64,
    },
    /// Another hard constraint already has this target.
    #[error("vertices {vertex} and {other} (line {first}) have one target: move one, or add a weight")]
    OnePlace {
        /// The vertex.
        vertex: VertexId,
        /// The vertex that already has this target.
        other: VertexId,
        /// Line of the other vertex.
        first: u64,
    },
    /// The mesh has no such vertex.
    #[error("there is no vertex {vertex}: the mesh has {count}, numbered from 0")]
    NoSuchVertex {
        /// The vertex.
        vertex: VertexId,
        /// Number of vertices of the mesh.
        count: usize,
    },
}

impl ConstraintsError {
    /// Vertices that the faulty line is about.
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
    /// Reads a file for a mesh with `vertex_count` vertices.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or for the first faulty line.
    pub fn read(path: &Path, vertex_count: usize) -> Result<Self, ConstraintsError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| ConstraintsError::File { path: path.to_owned(), source })?;
        Self::parse(&text, vertex_count).map_err(|(line, kind)| ConstraintsError::Line {
            path: path.to_owned(),
            line,
            kind,
        })
    }

    /// Parses the text of a constraint file.
    ///
    /// # Errors
    ///
    /// The first faulty line, counted from 1.
    pub fn parse(text: &str, vertex_count: usize) -> Result<Self, (u64, ConstraintFault)> {
        let mut found = Self::default();
        let mut taken = TakenTargets::default();
        // Some editors put a byte-order mark at the start of a text.
        for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
            let (text, comment) = text.split_once('#').unwrap_or((text, ""));
            let text = text.trim();
            if text.is_empty() {
                continue;
            }
            let (vertex, target) = parse_line(text).map_err(|kind| (line, kind))?;
            found.check(vertex, &target, vertex_count, &mut taken).map_err(|kind| (line, kind))?;
            found.targets.insert(vertex, target);
            found.lines.insert(vertex, line);
            if let Ok(name) = PinName::new(comment) {
                found.notes.insert(vertex, PinNote::named(name));
            }
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

/// Writes targets with the names of their pins as a constraint file; the numbers read back bit for bit.
///
/// # Errors
///
/// If `out` cannot be written, or a target is infinite or not a number.
pub fn write_constraints(out: &mut impl Write, targets: &Targets, notes: &PinNotes) -> io::Result<()> {
    check_finite(targets.values().map(|target| &target.uv))?;
    writeln!(out, "# vertex u v [weight]; vertices are numbered from 0; without a weight a pin is hard")?;
    for (vertex, Target { uv, kind }) in targets {
        write!(out, "{} {:?} {:?}", vertex.number(), uv.x, uv.y)?;
        match kind {
            PinKind::Soft(weight) => write!(out, " {weight:?}")?,
            PinKind::Fixed | PinKind::Hard => {}
        }
        match notes.get(vertex).and_then(|note| note.name.as_ref()) {
            Some(name) => writeln!(out, " # {name}")?,
            None => writeln!(out)?,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(constraints: &Constraints) -> String {
        let mut out = Vec::new();
        write_constraints(&mut out, &constraints.targets, &constraints.notes).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn names_come_back_and_a_file_without_names_keeps_its_bytes() {
        let head = "# vertex u v [weight]; vertices are numbered from 0; without a weight a pin is hard\n";
        let plain = format!("{head}3 0.25 0.5\n8 0.5 0.75 2.0\n");
        assert_eq!(written(&Constraints::parse(&plain, 9).unwrap()), plain);
        let with_names = format!("{head}3 0.25 0.5 # left eye, outer # corner\n8 0.5 0.75 2.0 # #2\n");
        let read = Constraints::parse(&with_names, 9).unwrap();
        let name = |vertex: u32| read.notes[&VertexId::new(vertex)].name.as_ref().unwrap().as_str();
        assert_eq!([name(3), name(8)], ["left eye, outer # corner", "#2"]);
        assert_eq!(written(&read), with_names);
    }

    #[test]
    fn a_comment_that_is_no_name_names_nothing() {
        let long = "x".repeat(PinName::LONGEST + 1);
        let text = format!("# 3 1 1\n3 0.25 0.5 #\n4 0.25 0.75 # {long}\n");
        let read = Constraints::parse(&text, 9).unwrap();
        assert!(read.targets.len() == 2 && read.notes.is_empty(), "{:?}", read.notes);
    }
}
