//! Everything that can keep an OBJ file from being read.

/// How many parse faults of a file are kept; the others are only counted.
pub const MAX_PARSE_FAULTS: usize = 20;

/// Why a file did not become a mesh. Its name is for the caller to say, who has it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be opened, or reading it broke off.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// The file has a format that is known but not read.
    #[error("format not read yet: {0}")]
    NotReadYet(&'static str),
    /// The file holds a zero byte, which no text does.
    #[error("this is no text, so no OBJ file")]
    NotText,
    /// One line is longer than any reader should hold.
    #[error("line {line}: longer than {} MiB", limit >> 20)]
    LineTooLong {
        /// Where it begins, counted from 1.
        line: u64,
        /// The limit, bytes.
        limit: usize,
    },
    /// Lines that cannot be understood.
    #[error("{}", listed(faults, *total))]
    Parse {
        /// The first of them, at most [`MAX_PARSE_FAULTS`], by line.
        faults: Vec<ParseFault>,
        /// How many there are in all.
        total: usize,
    },
    /// The file has no face.
    #[error("the file has no faces{}", if *vertices == 0 { String::new() } else { format!(", only {vertices} vertices") })]
    NoFaces {
        /// How many vertices it has.
        vertices: usize,
    },
    /// More elements than 32-bit indices can name.
    #[error("the mesh is too large: more than 2^32 corners")]
    TooLarge,
    /// The caller asked to stop.
    #[error("reading was cancelled")]
    Cancelled,
}

impl ReadError {
    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Unreadable(_) => "check the path and the permissions",
            // Its triangles share no vertices, so that nothing hangs together.
            Self::NotReadYet("STL") => {
                "merge coincident vertices in the program that wrote it, and export the mesh as OBJ (Wavefront)"
            }
            Self::NotReadYet(_) => "export the mesh as OBJ (Wavefront) from the program that wrote it",
            Self::NotText | Self::LineTooLong { .. } => "export the mesh as OBJ (Wavefront), and choose that file",
            Self::Parse { .. } => "mend these lines, or export the file again",
            Self::NoFaces { .. } => "export the surface with its faces",
            Self::TooLarge => "simplify the mesh",
            Self::Cancelled => "open the file again",
        }
    }
}

fn listed(faults: &[ParseFault], total: usize) -> String {
    let mut lines: Vec<String> = faults.iter().map(ParseFault::to_string).collect();
    if total > faults.len() {
        lines.push(format!("and {} more faults like these", total - faults.len()));
    }
    lines.join("\n")
}

/// A line that cannot be understood.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {kind}")]
pub struct ParseFault {
    /// Line in the file, counted from 1, as editors do.
    pub line: u64,
    /// What is wrong with it.
    pub kind: ParseFaultKind,
}

/// What is wrong with a line. Indices are quoted as the file writes them, counted from 1 or backwards from −1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParseFaultKind {
    /// A word in the place of a number.
    #[error("\"{0}\" is not a number")]
    BadNumber(String),
    /// A vertex or texture coordinate with too few numbers.
    #[error("{found} numbers where {needed} are needed")]
    TooFewNumbers {
        /// How many there are.
        found: usize,
        /// How many it needs.
        needed: usize,
    },
    /// A corner that is not of the form `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[error("\"{0}\" is not a corner of a face")]
    BadCorner(String),
    /// An index that no element can have.
    #[error("index 0: OBJ files count from 1")]
    IndexZero,
    /// An index that names an element which the file does not have.
    #[error("{element} {index} is out of range: there are {count}")]
    IndexOutOfRange {
        /// `"vertex"` or `"texture coordinate"`.
        element: &'static str,
        /// The index as written.
        index: i64,
        /// How many such elements there are.
        count: usize,
    },
    /// A face with so many corners, fewer than three.
    #[error("a face with {} {}, three are needed", .0, if *.0 == 1 { "corner" } else { "corners" })]
    TooFewCorners(usize),
}

/// Why texture coordinates do not make a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// The file has no texture coordinates on its faces.
    #[error("the file has no texture coordinates")]
    None,
    /// These faces, by the file's numbers from 0, have corners without texture coordinates.
    #[error("{} faces have corners without texture coordinates, the first is face {}", .0.len(), .0[0])]
    Missing(Vec<u32>),
}
