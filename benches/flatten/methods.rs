//! Every method on one mesh, each in a separate process: `freebound compare MESH --methods METHOD`.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use freebound_io::{MeshFile, Texture, write_atomically, write_obj};
use serde_json::Value;

use crate::common::Times;
use crate::common::machine::{PeakWatch, processor_seconds_of_children};
use crate::common::table::{Table, megabytes, seconds, target};
use freebound_testkit::sheet_of_faces;

/// Mesh size that the literature quotes for angle-based and stretch-minimising methods.
const FACES: usize = 40_000;

/// Runs of each method.
const ROUNDS: usize = 3;

/// Methods, and their time targets for solving in seconds if they have one.
const METHODS: [(&str, Option<f64>); 8] = [
    ("natural", None),
    ("spectral", None),
    ("abf", None),
    ("abf++", Some(20.0)),
    ("stretch", Some(10.0)),
    ("slim", None),
    ("lee", None),
    ("convex", None),
];

/// Prints seconds of solving, processor seconds and peak memory of the whole process, and the outcome of each
/// method.
pub(crate) fn side_by_side() {
    let heads =
        ["method", "solve s", "target s", "wall s", "cpu s", "peak MB", "steps", "end", "planar", "L²", "energy"];
    let mut table = Table::new("methods: freebound compare SHEET --methods METHOD", &heads);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mesh = sheet_of_faces(FACES);
    let source = folder.path().join("sheet.obj");
    write_atomically(&source, |out| write_obj(out, &MeshFile::from(&mesh), &Texture::default()))
        .expect("room in the folder");
    println!("a sheet of {} faces\n", mesh.face_count());
    for (method, most_seconds) in METHODS {
        let [mut solve, mut wall, mut processor] = [(); 3].map(|()| Times::default());
        let mut last = None;
        let mut peak = 0;
        for _ in 0..ROUNDS {
            let run = Run::new(folder.path(), &source, method);
            solve.add(run.number("/seconds/solve").unwrap_or(f64::NAN));
            wall.add(run.wall);
            processor.add(run.processor);
            peak = peak.max(run.peak_bytes);
            last = Some(run);
        }
        let run = last.expect("there are rounds");
        let number = |path: &str| run.number(path).map_or_else(|| "-".to_owned(), |number| format!("{number:.3}"));
        table.row([
            method.to_owned(),
            seconds(solve.median()),
            most_seconds.map(|most| target(solve.median(), most)).unwrap_or_default(),
            seconds(wall.median()),
            format!("{:.2}", processor.median()),
            megabytes(peak),
            run.method["steps"].as_array().map_or(0, Vec::len).to_string(),
            run.method["ending"].as_str().unwrap_or_default().to_owned(),
            run.method.pointer("/result/verdict/planar").map(Value::to_string).unwrap_or_default(),
            number("/result/distortion/stretch_l2"),
            number("/result/distortion/symmetric_dirichlet/mean"),
        ]);
    }
    table.print();
}

/// Measurements of one run of the program with one method.
struct Run {
    wall: f64,
    processor: f64,
    peak_bytes: usize,
    method: Value,
}

impl Run {
    fn new(folder: &Path, source: &Path, method: &str) -> Self {
        let report_path = folder.join("report.json");
        let (start, processor) = (Instant::now(), processor_seconds_of_children());
        let mut child = Command::new(env!("CARGO_BIN_EXE_freebound"))
            .arg("compare")
            .arg(source)
            .args(["--methods", method, "--report"])
            .arg(&report_path)
            .stdout(Stdio::null())
            .spawn()
            .expect("the program was built beside this benchmark");
        let watch = PeakWatch::new(child.id());
        let status = child.wait().expect("the child can be waited for");
        let wall = start.elapsed().as_secs_f64();
        let processor = processor_seconds_of_children() - processor;
        let watched = usize::try_from(watch.finish()).expect("it fits into memory");
        assert_eq!(status.code(), Some(0), "compare ended with {status}");
        let text = std::fs::read_to_string(&report_path).expect("a report was written");
        let mut report: Value = serde_json::from_str(&text).expect("the report is JSON");
        // The watcher may miss the last rise, and the report every rise after it was made.
        let told = report["peak_memory_bytes"].as_u64().and_then(|bytes| usize::try_from(bytes).ok());
        let peak_bytes = watched.max(told.unwrap_or(0));
        Self { wall, processor, peak_bytes, method: report["methods"][0].take() }
    }

    fn number(&self, path: &str) -> Option<f64> {
        self.method.pointer(path)?.as_f64()
    }
}
