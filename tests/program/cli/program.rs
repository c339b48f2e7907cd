//! Runs of the compiled program in a temporary folder.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use freebound::examples::Example;
use freebound_core::mesh::{DiskMesh, PolygonMesh};
use freebound_core::problem::Embedding;
use freebound_io::MeshFile;
use glam::DVec2;
use serde_json::Value;
use tempfile::TempDir;

/// Length of a file too large for any memory, bytes.
pub(crate) const HUGE: u64 = 1 << 42;

/// Temporary folder to run the program in.
pub(crate) struct Program {
    folder: TempDir,
}

/// Result of a run.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Program {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder can be made") }
    }

    /// A path in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file into the folder.
    pub(crate) fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).expect("the folder can be written to");
        path
    }

    /// Creates a sparse file of zeros that is too large for any memory.
    pub(crate) fn write_huge(&self, name: &str) {
        let file = fs::File::create(self.path(name)).expect("the folder can be written to");
        file.set_len(HUGE).expect("a file can have a hole");
    }

    /// Command, not yet started, without a display and with the folder as current directory.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_freebound"));
        command.args(arguments).current_dir(self.folder.path());
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Runs the program to its end.
    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        let run = Run::from(self.command(arguments).output().expect("the program starts"));
        assert!(!run.stderr.contains("panicked"), "{arguments:?}: {}", run.stderr);
        run
    }

    /// Names of all files and folders in the folder.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder is there");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program writes UTF-8");
        Self { status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

impl Run {
    /// Asserts the exit status, and shows the outputs otherwise.
    #[track_caller]
    pub(crate) fn expect(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{self:#?}");
        self
    }

    /// Standard output as a single JSON value.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.stdout))
    }
}

/// Path as an argument.
pub(crate) fn argument(path: &Path) -> &str {
    path.to_str().expect("the test's paths are UTF-8")
}

/// OBJ text of polygons without texture coordinates.
pub(crate) fn obj_text(polygons: &PolygonMesh) -> String {
    let mut text = positions_text(polygons);
    for face in 0..polygons.face_count() {
        text.push('f');
        for v in polygons.face(face) {
            write!(text, " {}", v.number() + 1).expect("memory");
        }
        text.push('\n');
    }
    text
}

/// OBJ text of triangles whose corners have these vertices and texture coordinates.
pub(crate) fn textured_text(
    polygons: &PolygonMesh,
    coordinates: &[DVec2],
    corners: impl Fn(usize, usize) -> [usize; 2],
) -> String {
    let mut text = positions_text(polygons);
    for z in coordinates {
        writeln!(text, "vt {:?} {:?}", z.x, z.y).expect("memory");
    }
    for face in 0..polygons.face_count() {
        text.push('f');
        for k in 0..polygons.face(face).len() {
            let [v, vt] = corners(face, k);
            write!(text, " {}/{}", v + 1, vt + 1).expect("memory");
        }
        text.push('\n');
    }
    text
}

fn positions_text(polygons: &PolygonMesh) -> String {
    let mut text = String::new();
    for p in &polygons.positions {
        writeln!(text, "v {:?} {:?} {:?}", p.x, p.y, p.z).expect("memory");
    }
    text
}

/// Faces of a disk as polygons.
pub(crate) fn polygons_of(mesh: &DiskMesh) -> PolygonMesh {
    PolygonMesh::from(mesh.mesh())
}

/// Writes a built-in mesh to a file in the program's folder.
pub(crate) fn example_file(program: &Program, example: Example) -> DiskMesh {
    let mesh = DiskMesh::try_from(example.mesh()).expect("well-formed by construction");
    program.write("in.obj", &obj_text(&PolygonMesh::from(mesh.mesh())));
    mesh
}

/// Texture coordinates by vertex, from a file that gives every vertex one.
pub(crate) fn coordinates_by_vertex(file: &MeshFile) -> Embedding {
    let texture = file.texture.as_ref().expect("the file has texture coordinates");
    let mut found = Embedding::from(vec![DVec2::NAN; file.polygons.positions.len()]);
    for (vertex, &place) in file.polygons.corners.iter().zip(&texture.corners) {
        found[vertex.index()] = texture.coordinates[place as usize];
    }
    found
}
