//! Everything that can keep a mesh file from being read.

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
    #[error("this is no text, and no binary format that is read")]
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
    /// Bytes of a binary file that cannot be understood.
    #[error("byte {byte}: {kind}")]
    Bytes {
        /// Where they begin, counted from 0.
        byte: u64,
        /// What is wrong with them.
        kind: ParseFaultKind,
    },
    /// A part of a glTF file that cannot be understood.
    #[error("{element}: {kind}")]
    Element {
        /// Which one, such as `accessor 3`; all are counted from 0.
        element: String,
        /// What is wrong with it.
        kind: ParseFaultKind,
    },
    /// The JSON of a glTF file does not have the form of glTF.
    #[error("{field}: {reason}")]
    Json {
        /// The field, such as `accessors[3].count`.
        field: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The file needs an extension of glTF that is not read.
    #[error("the file needs the extension {0}, which is not read")]
    NeedsExtension(String),
    /// A file that belongs to a glTF file.
    #[error("buffer {buffer}: {uri} cannot be read: {source}")]
    Beside {
        /// Which buffer it holds.
        buffer: usize,
        /// Its name, as the file gives it.
        uri: String,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// Few bytes that are shown as many triangles.
    #[error("its nodes and meshes show {shown} corners of triangles, or parts, many times what the file holds")]
    TooManyCopies {
        /// How many corners or parts.
        shown: u64,
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
            Self::NotReadYet(_) => "export the mesh as OBJ or PLY from the program that wrote it",
            Self::NotText | Self::LineTooLong { .. } => "export the mesh as OBJ or PLY, and choose that file",
            Self::Parse { .. } => "mend these lines, or export the file again",
            Self::Bytes { .. } => "export the file again, or copy it again if it was cut short",
            Self::Element { .. } | Self::Json { .. } => "export the file again",
            Self::NeedsExtension(_) => "export it again without compression",
            Self::Beside { .. } => "put that file beside this one, or export as GLB, which is one file",
            Self::TooManyCopies { .. } => "export each mesh once",
            Self::NoFaces { .. } => "export the surface with its faces",
            Self::TooLarge => "simplify the mesh",
            Self::Cancelled => "open the file again",
        }
    }
}

/// Where a fault is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaultPlace {
    /// Counted from 1.
    Line(u64),
    /// Counted from 0.
    Byte(u64),
}

/// The only fault of a file.
pub(crate) fn fault_at(place: FaultPlace, kind: ParseFaultKind) -> ReadError {
    match place {
        FaultPlace::Line(line) => ReadError::Parse { faults: vec![ParseFault { line, kind }], total: 1 },
        FaultPlace::Byte(byte) => ReadError::Bytes { byte, kind },
    }
}

/// The only fault of a glTF file, in this element.
pub(crate) fn fault_in(element: &str, index: usize, kind: ParseFaultKind) -> ReadError {
    ReadError::Element { element: format!("{element} {index}"), kind }
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

/// What is wrong with a line or with bytes. Indices are quoted as the file writes them.
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
    /// The file ends where more is to come.
    #[error("the file ends here, and more is to come")]
    EndsEarly,
    /// The file says that it has more elements than it has room for.
    #[error("the file says that it has {count} of \"{element}\", and ends before")]
    TooMany {
        /// What the elements are.
        element: String,
        /// How many there should be.
        count: u64,
    },
    /// A position that is infinite or not a number.
    #[error("a position that is infinite or not a number")]
    NotFinite,
    /// A line of a header, or a word in the place of another.
    #[error("\"{found}\" where {expected} should stand")]
    Unexpected {
        /// What the file has.
        found: String,
        /// What it should have.
        expected: &'static str,
    },
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
    /// Bytes beyond the end of what holds them.
    #[error("it reaches beyond the end of what holds it")]
    BeyondEnd,
    /// A node that more than one node holds, or itself.
    #[error("it is the child of two nodes, or of itself")]
    SecondParent,
    /// A face with so many corners, fewer than three.
    #[error("a face with {} {}, three are needed", .0, if *.0 == 1 { "corner" } else { "corners" })]
    TooFewCorners(usize),
}

/// Why texture coordinates do not make a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TextureError {
    /// The file has no texture coordinates on its faces.
    #[error("the file has no texture coordinates")]
    None,
    /// These faces, by the file's numbers from 0, have corners without texture coordinates.
    #[error("{} faces have corners without texture coordinates, the first is face {}", .0.len(), .0[0])]
    Missing(Vec<u32>),
}
