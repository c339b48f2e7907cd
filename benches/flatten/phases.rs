//! Every phase at growing sizes; verification; readers and writers.

use std::path::Path;

use freebound_core::flatten::Prepared;
use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::{Control, Embedding, PhaseSeconds, Pins, Settings};
use freebound_core::verify::{distortion, verdict};
use freebound_io::{MeshFile, Precision, Texture, read_mesh, write_atomically, write_obj, write_ply};
use glam::DVec3;

use crate::common::table::{Table, megabytes, seconds, target};
use crate::common::{Times, time};
use crate::{COMMON_FACES, LARGE_FACES, disk_of_faces};
use freebound_testkit::{jittered_sheet, sheet_of_faces};

/// Mesh sizes, in thousands of vertices.
const THOUSANDS: [usize; 5] = [25, 50, 100, 250, 500];

/// Time target of the verdict at the common size, seconds.
const VERDICT_TARGET: f64 = 0.15;

/// Time targets for reading the large mesh, seconds.
const OBJ_SECONDS: f64 = 0.4;
const PLY_SECONDS: f64 = 0.15;

/// Number of rounds at a size: more for short ones.
fn rounds(vertex_count: usize) -> usize {
    if vertex_count < 200_000 { 5 } else { 3 }
}

/// Times of the phases over repeated flattenings.
#[derive(Default)]
struct PhaseTimes {
    read: Times,
    diagnose: Times,
    assemble: Times,
    analyze: Times,
    factor: Times,
    solve: Times,
    verify: Times,
    write: Times,
}

impl PhaseTimes {
    /// Flattens the file at `source` once and writes `result`. Returns the bytes of the factors, and the residual.
    fn run(&mut self, source: &Path, result: &Path) -> (usize, f64) {
        let file = self.read.run(|| read_mesh(source).expect("written by this benchmark"));
        let mesh = self.diagnose.run(|| DiskMesh::try_from(file.polygons.triangulate()).expect("a sheet is a disk"));
        let (settings, pins, control) = (Settings::default(), Pins::new(), Control::unattended());
        let prepared = Prepared::new(&mesh, &settings, &pins, control).expect("a regular system");
        let solution = prepared.solve(&mesh, &pins, control).expect("a good answer");
        let PhaseSeconds { assemble, analyze, factor, solve } = solution.seconds;
        self.assemble.add(assemble);
        self.analyze.add(analyze);
        self.factor.add(factor);
        self.solve.add(solve);
        self.verify.run(|| (verdict(&mesh, &solution.embedding), distortion(&mesh, &solution.embedding)));
        self.write.run(|| write(result, &file, &solution.embedding));
        let linear = solution.linear.expect("a linear method");
        (linear.factor_bytes, linear.residual)
    }

    fn in_order(&self) -> [&Times; 8] {
        let Self { read, diagnose, assemble, analyze, factor, solve, verify, write } = self;
        [read, diagnose, assemble, analyze, factor, solve, verify, write]
    }
}

fn write(path: &Path, mesh: &MeshFile, texture: &Embedding) {
    write_atomically(path, |out| write_obj(out, mesh, &Texture::per_vertex(&mesh.polygons, texture)))
        .expect("the temporary folder has room");
}

/// Prints the seconds of every phase by size.
pub(crate) fn growth() {
    let heads = [
        "vertices",
        "faces",
        "read",
        "diagnose",
        "assemble",
        "analyze",
        "factor",
        "solve",
        "verify",
        "write",
        "sum",
        "factors MB",
        "residual",
    ];
    let mut table = Table::new("phases of conformal natural boundary, in one process (seconds)", &heads);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (source, result) = (folder.path().join("sheet.obj"), folder.path().join("flat.obj"));
    for thousand in THOUSANDS {
        let cells = (1000 * thousand).isqrt() - 1;
        let mesh = jittered_sheet(u32::try_from(cells).expect("few cells"));
        write(&source, &MeshFile::from(&mesh), &Embedding::default());
        let mut times = PhaseTimes::default();
        let mut last = (0, 0.0);
        for _ in 0..rounds(mesh.vertex_count()) {
            last = times.run(&source, &result);
        }
        let medians = times.in_order().map(Times::median);
        let [read, diagnose, assemble, analyze, factor, solve, verify, write] = medians.map(seconds);
        table.row([
            mesh.vertex_count().to_string(),
            mesh.face_count().to_string(),
            read,
            diagnose,
            assemble,
            analyze,
            factor,
            solve,
            verify,
            write,
            seconds(medians.iter().sum()),
            megabytes(last.0),
            format!("{:.1e}", last.1),
        ]);
    }
    table.print();
}

/// Prints the seconds of verdict and distortion.
pub(crate) fn proof() {
    let mut table = Table::new("proof (seconds)", &["faces", "verdict", "distortion", "planar", "verdict's target"]);
    for faces in [COMMON_FACES, LARGE_FACES] {
        let mesh = disk_of_faces(faces);
        let (settings, pins, control) = (Settings::default(), Pins::new(), Control::unattended());
        let prepared = Prepared::new(&mesh, &settings, &pins, control).expect("a regular system");
        let embedding = prepared.solve(&mesh, &pins, control).expect("a good answer").embedding;
        let [mut to_prove, mut to_measure] = <[Times; 2]>::default();
        let mut planar = false;
        for _ in 0..2 * rounds(mesh.vertex_count()) {
            planar = to_prove.run(|| verdict(&mesh, &embedding)).planar;
            to_measure.run(|| distortion(&mesh, &embedding));
        }
        table.row([
            mesh.face_count().to_string(),
            seconds(to_prove.median()),
            seconds(to_measure.median()),
            if planar { "yes" } else { "no" }.to_owned(),
            if faces == COMMON_FACES { target(to_prove.median(), VERDICT_TARGET) } else { String::new() },
        ]);
    }
    table.print();
}

/// Prints the seconds, and millions of bytes per second, of readers and writers.
pub(crate) fn reader() {
    let heads = ["file", "faces", "MB", "read s", "target s", "read MB/s", "write s", "write MB/s"];
    let mut table = Table::new("mesh files, from and to the file system's cache", &heads);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let exact = sheet_of_faces(LARGE_FACES);
    let rounded = TriMesh { positions: exact.positions.iter().map(|&p| six_decimals(p)).collect(), ..exact.clone() };
    let [exact, rounded] = [exact, rounded].map(|mesh| MeshFile::from(&mesh));
    let cases = [
        ("OBJ, all digits", "a.obj", &exact),
        ("OBJ, 6 decimals", "b.obj", &rounded),
        ("PLY, binary", "c.ply", &exact),
    ];
    for (words, name, mesh) in cases {
        let path = folder.path().join(name);
        let is_obj = name.ends_with("obj");
        let [mut to_read, mut to_write] = <[Times; 2]>::default();
        for _ in 0..5 {
            to_write.run(|| {
                let texture = Texture::default();
                let written = write_atomically(&path, |out| {
                    if is_obj { write_obj(out, mesh, &texture) } else { write_ply(out, mesh, &texture, Precision::F64) }
                });
                written.expect("room in the folder");
            });
            let (taken, read) = time(|| read_mesh(&path).expect("written by this benchmark"));
            assert!(read.polygons == mesh.polygons, "what was written reads back");
            to_read.add(taken);
        }
        let megabytes = std::fs::metadata(&path).expect("just written").len() as f64 / 1e6;
        table.row([
            words.to_owned(),
            mesh.polygons.face_count().to_string(),
            format!("{megabytes:.1}"),
            seconds(to_read.median()),
            target(to_read.median(), if is_obj { OBJ_SECONDS } else { PLY_SECONDS }),
            format!("{:.0}", megabytes / to_read.median()),
            seconds(to_write.median()),
            format!("{:.0}", megabytes / to_write.median()),
        ]);
    }
    table.print();
}

fn six_decimals(point: DVec3) -> DVec3 {
    const STEPS: f64 = 1e6;
    (point * STEPS).round() / STEPS
}
