//! Edges files: an edge of a seam a line, "a b", the numbers of its two vertices; what follows a # is a comment.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read as _, Write};
use std::path::{Path, PathBuf};

use freebound_core::mesh::{PolygonMesh, Seams, VertexId};

/// Bytes that a file may take for each corner of its mesh, which has no more edges than corners: two numbers of ten digits, and a
/// comment.
const BYTES_PER_CORNER: u64 = 64;

/// Bytes that any file may take.
const FEW_BYTES: u64 = 1 << 20;

/// Why an edges file is not used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EdgesError {
    /// The file cannot be read.
    #[error("{}: the edges cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// More than the edges of the mesh can be.
    #[error("{}: the file is longer than {most} bytes, which the edges of this mesh do not take: choose an edges file", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// The most bytes that are read.
        most: u64,
    },
    /// A line that cannot be.
    #[error("{}: line {line}: {kind}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong with it.
        kind: EdgeFault,
    },
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EdgeFault {
    /// Not of the form that lines have.
    #[error("write \"a b\", the numbers of an edge's two vertices, not \"{0}\"")]
    Form(String),
    /// A vertex number that is negative, broken, or beyond 32 bits.
    #[error("\"{0}\" is not the number of a vertex; vertices count from 0")]
    BadVertex(String),
    /// Both ends are one vertex.
    #[error("vertex {0} stands at both ends: name the two vertices of an edge")]
    OneVertex(VertexId),
    /// A vertex that the mesh does not have.
    #[error("there is no vertex {vertex}: the mesh has {count}, numbered from 0")]
    NoSuchVertex {
        /// The vertex.
        vertex: VertexId,
        /// How many there are.
        count: usize,
    },
    /// No face has this edge.
    #[error("no face has a side from vertex {} to vertex {}: name the sides of a way between them", .0[0], .0[1])]
    NoSuchEdge([VertexId; 2]),
}

impl EdgesError {
    /// The vertices that the line at fault is about.
    pub fn vertices(&self) -> Vec<VertexId> {
        match self {
            Self::Line { kind: EdgeFault::NoSuchEdge(ends), .. } => ends.to_vec(),
            Self::Line { kind: EdgeFault::OneVertex(vertex), .. } => vec![*vertex],
            _ => Vec::new(),
        }
    }
}

/// Reads the edges of a mesh from a file.
///
/// # Errors
///
/// A file that cannot be read, or the first line at fault.
pub fn read_edges(path: &Path, mesh: &PolygonMesh) -> Result<Vec<[VertexId; 2]>, EdgesError> {
    let most = FEW_BYTES + BYTES_PER_CORNER * mesh.corners.len() as u64;
    let failed = |source| EdgesError::File { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(EdgesError::TooLong { path: path.to_owned(), most });
    }
    let text = String::from_utf8(bytes).map_err(|error| failed(io::Error::new(io::ErrorKind::InvalidData, error)))?;
    parse_edges(&text, mesh).map_err(|(line, kind)| EdgesError::Line { path: path.to_owned(), line, kind })
}

/// Understands the text of an edges file. An edge may be listed more than once.
///
/// # Errors
///
/// The first line at fault, counted from 1.
pub fn parse_edges(text: &str, mesh: &PolygonMesh) -> Result<Vec<[VertexId; 2]>, (u64, EdgeFault)> {
    let mut edges = Vec::new();
    let mut lines: HashMap<[VertexId; 2], u64> = HashMap::new();
    let mut fault = None;
    // Some editors begin a text with a byte-order mark.
    for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let text = text.split('#').next().unwrap_or_default().trim();
        if text.is_empty() {
            continue;
        }
        match parse_line(text, mesh.positions.len()) {
            Ok([a, b]) => {
                edges.push([a, b]);
                lines.entry([a.min(b), a.max(b)]).or_insert(line);
            }
            Err(kind) => {
                fault = Some((line, kind));
                break;
            }
        }
    }
    // An edge without a side stands before any other fault.
    let missing = Seams::default().with(edges.iter().copied()).missing_in(mesh);
    let missing = missing.into_iter().map(|ends| (ends, lines[&ends])).min_by_key(|&(_, line)| line);
    match missing.map(|(ends, line)| (line, EdgeFault::NoSuchEdge(ends))).or(fault) {
        Some(fault) => Err(fault),
        None => Ok(edges),
    }
}

fn parse_line(text: &str, vertex_count: usize) -> Result<[VertexId; 2], EdgeFault> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let &[a, b] = words.as_slice() else { return Err(EdgeFault::Form(text.to_owned())) };
    let vertex = |word: &str| -> Result<VertexId, EdgeFault> {
        let vertex = VertexId::new(word.parse().map_err(|_| EdgeFault::BadVertex(word.to_owned()))?);
        let is_there = vertex.index() < vertex_count;
        if is_there { Ok(vertex) } else { Err(EdgeFault::NoSuchVertex { vertex, count: vertex_count }) }
    };
    let ends = [vertex(a)?, vertex(b)?];
    if ends[0] == ends[1] { Err(EdgeFault::OneVertex(ends[0])) } else { Ok(ends) }
}

/// Writes edges as an edges file.
///
/// # Errors
///
/// What `out` says.
pub fn write_edges(out: &mut impl Write, edges: impl IntoIterator<Item = [VertexId; 2]>) -> io::Result<()> {
    writeln!(out, "# a b: an edge between two vertices, which count from 0")?;
    edges.into_iter().try_for_each(|[a, b]| writeln!(out, "{} {}", a.number(), b.number()))
}
