//! The main job without a screen: the built-in example, flattened into a folder.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use super::exit::conclude;
use super::flatten::HeadlessJob;
use super::progress::Progress;
use super::{Failure, Status};
use crate::examples::Example;
use crate::io::{OutputKind, WriteError};
use crate::session::{Document, Model, OutputFit};

/// Folder that the example is written into, in the current one.
const FOLDER: &str = "freebound-example";

/// Flattens the built-in face and writes mesh, report and picture into a folder that it names.
pub fn run_example() -> ExitCode {
    super::progress::stop_on_interrupt();
    conclude(flatten_example())
}

fn flatten_example() -> Result<Status, Failure> {
    let folder = Path::new(FOLDER);
    std::fs::create_dir_all(folder).map_err(|error| WriteError { path: folder.to_owned(), source: error })?;
    let [mesh, picture, report] = ["face.obj", "face.png", "face.json"].map(|name| folder.join(name));
    let job = HeadlessJob {
        document: Document::of_example(Example::Face),
        fit: OutputFit::Unit,
        svg_fit: OutputFit::Unit,
        outputs: vec![(OutputKind::Obj, &mesh), (OutputKind::Png, &picture)],
        report: Some(&report),
        steps: None,
    };
    let progress = Progress::default();
    let status = progress.follow(|| job.run(&Model::example(Example::Face), Instant::now(), &progress))?;
    println!("wrote face.obj with its material and picture, face.json and face.png (before and after) into {FOLDER}/");
    Ok(status)
}
