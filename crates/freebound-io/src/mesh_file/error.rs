//! Errors of reading a mesh file.

/// Number of parse faults of a file that are kept; further ones are only counted.
pub const MAX_PARSE_FAULTS: usize = 20;

/// Failure to read a mesh. Messages do not name the file; the caller knows its name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// The format of the file is known but not supported.
    #[error("unsupported format: {0}")]
    NotReadYet(&'static str),
    /// The file contains a zero byte, which no text does.
    #[error("neither text nor a supported binary format")]
    NotText,
    /// A line is longer than a reader should hold.
    #[error("line {line}: longer than {} MiB", limit >> 20)]
    LineTooLong {
        /// Line, counted from 1.
        line: u64,
        /// Limit, bytes.
        limit: usize,
    },
    /// Lines that cannot be parsed.
    #[error("{}", listed(faults, *total))]
    Parse {
        /// First faults by line, at most [`MAX_PARSE_FAULTS`].
        faults: Vec<ParseFault>,
        /// Number of all faults.
        total: usize,
    },
    /// Bytes of a binary file that cannot be parsed.
    #[error("byte {byte}: {kind}")]
    Bytes {
        /// Offset of the first faulty byte, counted from 0.
        byte: u64,
        /// Fault of the bytes.
        kind: ParseFaultKind,
    },
    /// A part of a glTF file is invalid.
    #[error("{element}: {kind}")]
    Element {
        /// Name of the part, such as `accessor 3`; counted from 0.
        element: String,
        /// Fault of the part.
        kind: ParseFaultKind,
    },
    /// The JSON of a glTF file does not have the form of glTF.
    #[error("{field}: {reason}")]
    Json {
        /// The field, such as `accessors[3].count`.
        field: String,
        /// Fault of the field.
        reason: String,
    },
    /// The file needs an unsupported extension of glTF.
    #[error("the file needs the unsupported extension {0}")]
    NeedsExtension(String),
    /// A file that belongs to a glTF file cannot be read.
    #[error("buffer {buffer}: {uri} cannot be read: {source}")]
    Beside {
        /// Number of the buffer in that file.
        buffer: usize,
        /// Name of that file, as the glTF file gives it.
        uri: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A few bytes expand to too many triangles.
    #[error("nodes repeat meshes to {shown} corners or parts, many times the content of the file")]
    TooManyCopies {
        /// Number of corners or parts.
        shown: u64,
    },
    /// The file has no face.
    #[error("the file has no faces{}", if *vertices == 0 { String::new() } else { format!(", only {vertices} vertices") })]
    NoFaces {
        /// Number of vertices in the file.
        vertices: usize,
    },
    /// The file has more elements than 32-bit indices can name.
    #[error("the mesh is too large: more than 2^32 corners")]
    TooLarge,
    /// The caller cancelled.
    #[error("reading was cancelled")]
    Cancelled,
}

impl ReadError {
    /// Remedy for the error.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Unreadable(_) => "check the path and the permissions",
            Self::NotReadYet(_) => "export the mesh as OBJ or PLY from the program that wrote it",
            Self::NotText | Self::LineTooLong { .. } => "export the mesh as OBJ or PLY, and choose that file",
            Self::Parse { .. } => "correct these lines, or export the file again",
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

/// Position of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaultPlace {
    /// Line, counted from 1.
    Line(u64),
    /// Byte, counted from 0.
    Byte(u64),
}

/// Error of a file with a single fault.
pub(crate) fn fault_at(place: FaultPlace, kind: ParseFaultKind) -> ReadError {
    match place {
        FaultPlace::Line(line) => ReadError::Parse { faults: vec![ParseFault { line, kind }], total: 1 },
        FaultPlace::Byte(byte) => ReadError::Bytes { byte, kind },
    }
}

/// Error of a glTF file with a single fault, in this element.
pub(crate) fn fault_in(element: &str, index: usize, kind: ParseFaultKind) -> ReadError {
    ReadError::Element { element: format!("{element} {index}"), kind }
}

fn listed(faults: &[ParseFault], total: usize) -> String {
    let mut lines: Vec<String> = faults.iter().map(ParseFault::to_string).collect();
    if total > faults.len() {
        lines.push(format!("and {} more faults", total - faults.len()));
    }
    lines.join("\n")
}

/// Line that cannot be parsed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {kind}")]
pub struct ParseFault {
    /// Line in the file, counted from 1.
    pub line: u64,
    /// Fault of the line.
    pub kind: ParseFaultKind,
}

/// Fault of a line or of bytes. Indices are quoted as the file writes them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParseFaultKind {
    /// A word that should be a number is none.
    #[error("\"{0}\" is not a number")]
    BadNumber(String),
    /// A vertex or texture coordinate has too few numbers.
    #[error("{found} numbers, but {needed} are needed")]
    TooFewNumbers {
        /// Number of numbers found.
        found: usize,
        /// Number of numbers needed.
        needed: usize,
    },
    /// A corner does not have the form `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[error("\"{0}\" is not a corner of a face")]
    BadCorner(String),
    /// An index is 0, which no element has.
    #[error("index 0: OBJ files count from 1")]
    IndexZero,
    /// The file ends too early.
    #[error("the file ends too early")]
    EndsEarly,
    /// The file declares more elements than it has room for.
    #[error("the file declares {count} of \"{element}\", but ends earlier")]
    TooMany {
        /// Name of the elements.
        element: String,
        /// Declared number of elements.
        count: u64,
    },
    /// A position is infinite or not a number.
    #[error("a position that is infinite or not a number")]
    NotFinite,
    /// A header line or a word is not as expected.
    #[error("found \"{found}\", expected {expected}")]
    Unexpected {
        /// Text in the file.
        found: String,
        /// Expected text.
        expected: &'static str,
    },
    /// An index names an element that does not exist.
    #[error("{element} {index} is out of range: there are {count}")]
    IndexOutOfRange {
        /// Kind of the element, such as `"vertex"` or `"texture coordinate"`.
        element: &'static str,
        /// Index as written.
        index: i64,
        /// Number of such elements.
        count: usize,
    },
    /// Data lie beyond the end of their container.
    #[error("the data reach beyond the end of their container")]
    BeyondEnd,
    /// A node has two parents, or is its own child.
    #[error("the node is the child of two nodes, or of itself")]
    SecondParent,
    /// A face has this number of corners, fewer than three.
    #[error("a face has {} {}, but three are needed", .0, if *.0 == 1 { "corner" } else { "corners" })]
    TooFewCorners(usize),
}

/// Elements of a file that were left out. The rest was read.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct ReadWarning {
    /// Kind of the elements.
    pub kind: ReadWarningKind,
    /// Number of elements.
    pub count: usize,
    /// Line of the first one in the file, counted from 1. Absent for binary files and glTF.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
}

/// Kind of elements that were left out, or that share a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ReadWarningKind {
    /// Faces of one or two corners, which have no area.
    FacesOfFewCorners,
    /// Texture coordinates of corners that do not exist.
    MissingTextureCoordinates,
    /// Nodes of a glTF file that show the mesh of an earlier node.
    SharedInstances,
    /// Nodes of a glTF file with `EXT_mesh_gpu_instancing`, which shows their mesh many times.
    RepeatedNodes,
}

impl std::fmt::Display for ReadWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { kind, count, line } = self;
        let [one, several] = match kind {
            ReadWarningKind::FacesOfFewCorners => {
                ["face of fewer than three corners left out", "faces of fewer than three corners left out"]
            }
            ReadWarningKind::MissingTextureCoordinates => {
                ["corner names no existing texture coordinate", "corners name no existing texture coordinate"]
            }
            ReadWarningKind::SharedInstances => [
                "node shows the mesh of another and shares its map",
                "nodes show meshes of others and share their maps",
            ],
            ReadWarningKind::RepeatedNodes => [
                "node is repeated by EXT_mesh_gpu_instancing: all copies share one map",
                "nodes are repeated by EXT_mesh_gpu_instancing: all copies of a node share one map",
            ],
        };
        write!(f, "{count} {}", if *count == 1 { one } else { several })?;
        line.map_or(Ok(()), |line| write!(f, " (first: line {line})"))
    }
}

fn faces_have(count: usize) -> String {
    if count == 1 { "1 face has".to_owned() } else { format!("{count} faces have") }
}

/// Reasons that texture coordinates do not make a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TextureError {
    /// The file has no texture coordinates on its faces.
    #[error("the file has no texture coordinates")]
    None,
    /// These faces, numbered from 0 without faces that were left out, have corners without texture coordinates.
    #[error("{} corners without texture coordinates, the first is face {}", faces_have(.0.len()), .0[0])]
    Missing(Vec<u32>),
}
