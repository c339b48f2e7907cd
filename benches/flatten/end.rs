//! End-to-end runs of the program.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use freebound_io::{MeshFile, Texture, write_atomically, write_obj};

use crate::common::Times;
use crate::common::machine::PeakWatch;
use crate::common::table::{Table, seconds, target};
use crate::{COMMON_FACES, LARGE_FACES};
use freebound_testkit::sheet_of_faces;

/// Faces, runs, time target in seconds, and memory target in millions of bytes if there is one.
const CASES: [(usize, usize, f64, Option<f64>); 2] =
    [(COMMON_FACES, 7, 0.6, None), (LARGE_FACES, 3, 8.0, Some(2000.0))];

/// Measures `freebound flatten IN --output OUT --report REPORT`: wall clock from start to exit, seconds of each part
/// from the report, and peak memory of the process.
pub(crate) fn end_to_end() {
    let heads = ["faces", "wall s", "read", "solve", "verify", "write", "target s", "peak MB", "target MB"];
    let mut table = Table::new("end to end: freebound flatten IN --output OUT --report REPORT", &heads);
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (faces, runs, most_seconds, most_megabytes) in CASES {
        let mesh = sheet_of_faces(faces);
        let source = folder.path().join("sheet.obj");
        write_atomically(&source, |out| write_obj(out, &MeshFile::from(&mesh), &Texture::default()))
            .expect("room in the folder");
        let mut wall = Times::default();
        let mut parts: [Times; 4] = Default::default();
        let mut peak = 0.0_f64;
        for _ in 0..runs {
            let run = Run::new(folder.path(), &source);
            wall.add(run.wall);
            parts.iter_mut().zip(run.parts).for_each(|(times, part)| times.add(part));
            peak = peak.max(run.peak_bytes / 1e6);
        }
        let [read, solve, verify, write] = parts.each_ref().map(|times| seconds(times.median()));
        table.row([
            mesh.face_count().to_string(),
            seconds(wall.median()),
            read,
            solve,
            verify,
            write,
            target(wall.median(), most_seconds),
            format!("{peak:.0}"),
            most_megabytes.map(|most| target(peak, most)).unwrap_or_default(),
        ]);
    }
    table.print();
}

/// Measurements of one run of the program.
struct Run {
    wall: f64,
    /// Seconds of reading with diagnosis, of solving, of verifying, and of writing.
    parts: [f64; 4],
    peak_bytes: f64,
}

impl Run {
    fn new(folder: &Path, source: &Path) -> Self {
        let report_path = folder.join("report.json");
        let start = Instant::now();
        let mut child = Command::new(env!("CARGO_BIN_EXE_freebound"))
            .arg("flatten")
            .arg(source)
            .arg("--output")
            .arg(folder.join("flat.obj"))
            .arg("--report")
            .arg(&report_path)
            .stdout(Stdio::null())
            .spawn()
            .expect("the program was built beside this benchmark");
        let watch = PeakWatch::new(child.id());
        let status = child.wait().expect("the child can be waited for");
        let wall = start.elapsed().as_secs_f64();
        let watched = watch.finish() as f64;
        assert!(matches!(status.code(), Some(0 | 4)), "flatten ended with {status}");
        let text = std::fs::read_to_string(&report_path).expect("a report was written");
        let report: serde_json::Value = serde_json::from_str(&text).expect("the report is JSON");
        let part = |name: &str| report["seconds"][name].as_f64().expect("the report has the phase");
        // The report is made before the mesh is written, so it may miss a later peak.
        let told = report["peak_memory_bytes"].as_f64().unwrap_or(0.0);
        Self { wall, parts: ["read", "solve", "verify", "write"].map(part), peak_bytes: told.max(watched) }
    }
}
