//! The main job without a screen: the built-in example, flattened into a folder.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use super::exit::conclude;
use super::flatten::HeadlessJob;
use super::progress::Progress;
use super::{Failure, Status};
use crate::examples::{Example, portrait};
use crate::io::{OutputKind, WriteError, write_atomically};
use crate::session::{Model, OutputFit};
use crate::solver::{Pins, Settings};

/// Folder that the example is written into, in the current one.
const FOLDER: &str = "freebound-example";

/// Width and height of the portrait, pixels.
const PORTRAIT_SIZE: u32 = 768;

/// Flattens the built-in face and writes mesh, report and picture into a folder that it names.
pub fn run_example() -> ExitCode {
    super::progress::stop_on_interrupt();
    conclude(flatten_example())
}

/// The painted portrait that the face's texture is to come from.
fn write_portrait(path: &Path) -> Result<(), WriteError> {
    let picture = portrait(PORTRAIT_SIZE);
    write_atomically(path, |out| picture.write_png(out).map_err(std::io::Error::other))
}

fn flatten_example() -> Result<Status, Failure> {
    let folder = Path::new(FOLDER);
    std::fs::create_dir_all(folder).map_err(|error| WriteError { path: folder.to_owned(), source: error })?;
    let [mesh, picture, report] = ["face.obj", "face.png", "face.json"].map(|name| folder.join(name));
    let job = HeadlessJob {
        settings: Settings::default(),
        pins: Pins::new(),
        fit: OutputFit::Unit,
        outputs: vec![(OutputKind::Obj, &mesh), (OutputKind::Png, &picture)],
        report: Some(&report),
        steps: None,
    };
    let progress = Progress::default();
    write_portrait(&folder.join("portrait.png"))?;
    let status = progress.follow(|| job.run(&Model::example(Example::Face), Instant::now(), &progress))?;
    println!("wrote face.obj, face.json, face.png (before and after) and portrait.png into {FOLDER}/");
    Ok(status)
}
