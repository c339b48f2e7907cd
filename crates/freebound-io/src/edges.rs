//! Edges files: one edge of a seam per line, "a b", the numbers of its two vertices; a # starts a comment. A file of
//! costs has lines "a b cost".

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read as _, Write};
use std::path::{Path, PathBuf};

use freebound_core::mesh::{PolygonMesh, Seams, VertexId};

/// Size limit of a file, in bytes per corner of its mesh. A mesh has at most as many edges as corners; an edge takes
/// two numbers of ten digits, and a comment.
const BYTES_PER_CORNER: u64 = 64;

/// Bytes allowed for any file, whatever its mesh.
const FEW_BYTES: u64 = 1 << 20;

/// Failure to read an edges file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EdgesError {
    /// The file cannot be read.
    #[error("{}: the edges cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is longer than all edges of the mesh could need.
    #[error("{}: longer than {most} bytes, more than all edges of the mesh need: choose an edges file", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// Size limit, bytes.
        most: u64,
    },
    /// A line is invalid.
    #[error("{}: line {line}: {kind}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// Fault of the line.
        kind: EdgeFault,
    },
}

/// Fault of a line in an edges file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EdgeFault {
    /// The line has the wrong form.
    #[error("write \"a b\", the two vertex numbers of an edge, not \"{0}\"")]
    Form(String),
    /// The line of a file of costs has the wrong form.
    #[error("write \"a b cost\", the two vertex numbers of an edge and its cost, not \"{0}\"")]
    CostForm(String),
    /// The cost is no number in its range.
    #[error("\"{0}\" is not a cost: write a number from 0.001 to 1000000; 1 is the usual cost")]
    BadCost(String),
    /// The vertex number is negative, malformed, or beyond 32 bits.
    #[error("\"{0}\" is not a vertex number; vertices are numbered from 0")]
    BadVertex(String),
    /// Both ends are one vertex.
    #[error("vertex {0} is at both ends: write two different vertices")]
    OneVertex(VertexId),
    /// The mesh has no such vertex.
    #[error("there is no vertex {vertex}: the mesh has {count}, numbered from 0")]
    NoSuchVertex {
        /// The vertex.
        vertex: VertexId,
        /// Number of vertices of the mesh.
        count: usize,
    },
    /// No face has this edge.
    #[error("no edge joins vertices {} and {}: write the edges of a path between them", .0[0], .0[1])]
    NoSuchEdge([VertexId; 2]),
}

impl EdgesError {
    /// Vertices that the faulty line is about.
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
/// If the file cannot be read, or for the first faulty line.
pub fn read_edges(path: &Path, mesh: &PolygonMesh) -> Result<Vec<[VertexId; 2]>, EdgesError> {
    let text = read_text(path, mesh)?;
    parse_edges(&text, mesh).map_err(|(line, kind)| EdgesError::Line { path: path.to_owned(), line, kind })
}

/// Reads the costs of edges of a mesh from a file. A seam costs its length times the cost of its edges. Default of an
/// edge that is not listed: 1.
///
/// # Errors
///
/// If the file cannot be read, or for the first faulty line.
pub fn read_edge_costs(path: &Path, mesh: &PolygonMesh) -> Result<Vec<([VertexId; 2], f64)>, EdgesError> {
    let text = read_text(path, mesh)?;
    let cost = |rest: &str| {
        let cost = rest.parse().ok().filter(|cost| Seams::COSTS.contains(cost));
        cost.ok_or_else(|| EdgeFault::BadCost(rest.to_owned()))
    };
    let line = |text: &str| {
        let (ends, rest) = text.rsplit_once(char::is_whitespace).ok_or_else(|| EdgeFault::CostForm(text.to_owned()))?;
        let edge = parse_line(ends, mesh.positions.len()).map_err(|fault| match fault {
            EdgeFault::Form(_) => EdgeFault::CostForm(text.to_owned()),
            other => other,
        })?;
        Ok((edge, cost(rest)?))
    };
    let parsed = parse_lines(&text, mesh, line, |(edge, _)| *edge);
    parsed.map_err(|(line, kind)| EdgesError::Line { path: path.to_owned(), line, kind })
}

fn read_text(path: &Path, mesh: &PolygonMesh) -> Result<String, EdgesError> {
    let most = FEW_BYTES + BYTES_PER_CORNER * mesh.corners.len() as u64;
    let failed = |source| EdgesError::File { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(EdgesError::TooLong { path: path.to_owned(), most });
    }
    String::from_utf8(bytes).map_err(|error| failed(io::Error::new(io::ErrorKind::InvalidData, error)))
}

/// Parses the text of an edges file. An edge may be listed more than once.
///
/// # Errors
///
/// The first faulty line, counted from 1.
pub fn parse_edges(text: &str, mesh: &PolygonMesh) -> Result<Vec<[VertexId; 2]>, (u64, EdgeFault)> {
    parse_lines(text, mesh, |line| parse_line(line, mesh.positions.len()), |edge| *edge)
}

/// Parses all lines by `parse`, and checks that the mesh has the edge of each, by `edge_of`.
fn parse_lines<T>(
    text: &str,
    mesh: &PolygonMesh,
    parse: impl Fn(&str) -> Result<T, EdgeFault>,
    edge_of: impl Fn(&T) -> [VertexId; 2],
) -> Result<Vec<T>, (u64, EdgeFault)> {
    let mut found = Vec::new();
    let mut lines: HashMap<[VertexId; 2], u64> = HashMap::new();
    let mut fault = None;
    // Some editors put a byte-order mark at the start of a text.
    for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let text = text.split('#').next().unwrap_or_default().trim();
        if text.is_empty() {
            continue;
        }
        match parse(text) {
            Ok(parsed) => {
                let [a, b] = edge_of(&parsed);
                found.push(parsed);
                lines.entry([a.min(b), a.max(b)]).or_insert(line);
            }
            Err(kind) => {
                fault = Some((line, kind));
                break;
            }
        }
    }
    // The missing edges are on lines before any other fault, so they are reported first.
    let missing = Seams::default().with(found.iter().map(&edge_of)).missing_in(mesh);
    let missing = missing.into_iter().map(|ends| (ends, lines[&ends])).min_by_key(|&(_, line)| line);
    match missing.map(|(ends, line)| (line, EdgeFault::NoSuchEdge(ends))).or(fault) {
        Some(fault) => Err(fault),
        None => Ok(found),
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
/// If `out` cannot be written.
pub fn write_edges(out: &mut impl Write, edges: impl IntoIterator<Item = [VertexId; 2]>) -> io::Result<()> {
    writeln!(out, "# a b: an edge between two vertices, numbered from 0")?;
    edges.into_iter().try_for_each(|[a, b]| writeln!(out, "{} {}", a.number(), b.number()))
}
