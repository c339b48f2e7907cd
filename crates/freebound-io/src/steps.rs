//! Steps of a run as files: a drawing of each, and a table of their numbers.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::WriteError;
use super::paths::{is_same_file, whole};
use super::step_report::StepReport;
use super::svg::write_step_svg;
use super::unfinished::{Unfinished, before_clean_up};
use freebound_core::flatten::Step;
use freebound_core::mesh::DiskMesh;

/// Name of the table.
const TABLE: &str = "steps.csv";

/// Folder of steps, filled as a temporary folder. [`finish`](Self::finish) moves its files into place.
#[derive(Debug)]
pub struct StepsFolder {
    target: PathBuf,
    aside: TempDir,
    _unfinished: Unfinished,
    names: Vec<String>,
    table: csv::Writer<Vec<u8>>,
}

impl StepsFolder {
    /// Creates the temporary folder near `target`, so that its files can be renamed.
    ///
    /// # Errors
    ///
    /// If `target` is not a folder, or cannot be written.
    pub fn begin(target: &Path) -> Result<Self, WriteError> {
        let named = |source: io::Error| WriteError::writing(target, source);
        if fs::metadata(target).is_ok_and(|data| !data.is_dir()) {
            return Err(named(io::Error::from(io::ErrorKind::NotADirectory)));
        }
        let here = Path::new(".");
        let near = target.ancestors().find(|folder| folder.is_dir()).unwrap_or(here);
        // The error names the temporary folder, which means nothing to the user.
        let plain = |error: io::Error| named(error.kind().into());
        let (unfinished, aside) = Unfinished::new(|names| names.tempdir_in(near)).map_err(plain)?;
        let table = csv::Writer::from_writer(Vec::new());
        Ok(Self { target: target.to_owned(), aside, _unfinished: unfinished, names: Vec::new(), table })
    }

    /// True if filling a folder would replace this file in it, even if the file does not exist yet.
    pub fn would_replace(folder: &Path, file: &Path) -> bool {
        let whole = whole(file);
        let (Some(parent), Some(name)) = (whole.parent(), whole.file_name()) else { return false };
        let name = name.to_string_lossy();
        (name == TABLE || is_drawing_of_a_step(&name)) && is_same_file(parent, folder)
    }

    /// Draws a step and records its numbers.
    ///
    /// # Errors
    ///
    /// If the drawing cannot be written.
    pub fn add(&mut self, mesh: &DiskMesh, step: &Step) -> Result<(), WriteError> {
        let name = format!("step-{:03}-{}.svg", step.index, step.candidate.stage.name());
        let write = || {
            let mut out = BufWriter::new(before_clean_up(|| File::create(self.aside.path().join(&name)))?);
            write_step_svg(&mut out, mesh, step)?;
            out.flush()
        };
        write().map_err(|source: io::Error| WriteError::writing(self.target.join(&name), source))?;
        let (heads, cells): (Vec<_>, Vec<_>) = StepReport::of(step).row().into_iter().unzip();
        let of_table = |error: csv::Error| WriteError::writing(self.target.join(TABLE), error);
        if self.names.is_empty() {
            self.table.write_record(heads).map_err(of_table)?;
        }
        self.table.write_record(cells).map_err(of_table)?;
        self.names.push(name);
        Ok(())
    }

    /// Moves the files into place: removes the steps of an earlier run, then renames those of this run, the table
    /// last. The clean-up at a sudden end of the program runs before all of this or after it.
    ///
    /// # Errors
    ///
    /// If a file cannot be removed or renamed.
    pub fn finish(self) -> Result<(), WriteError> {
        let put = || {
            let table = self.table.into_inner().map_err(csv::IntoInnerError::into_error)?;
            fs::write(self.aside.path().join(TABLE), table)?;
            fs::create_dir_all(&self.target)?;
            for entry in fs::read_dir(&self.target)? {
                let entry = entry?;
                if is_drawing_of_a_step(&entry.file_name().to_string_lossy()) {
                    fs::remove_file(entry.path())?;
                }
            }
            for name in self.names.iter().map(String::as_str).chain([TABLE]) {
                fs::rename(self.aside.path().join(name), self.target.join(name))?;
            }
            Ok(())
        };
        before_clean_up(put).map_err(|source: io::Error| WriteError::writing(&self.target, source))
    }
}

/// True if [`StepsFolder::add`] could have given a file this name.
fn is_drawing_of_a_step(name: &str) -> bool {
    let Some(rest) = name.strip_prefix("step-").and_then(|rest| rest.strip_suffix(".svg")) else { return false };
    let Some((number, stage)) = rest.split_once('-') else { return false };
    let is_number = number.len() >= 3 && number.bytes().all(|b| b.is_ascii_digit());
    is_number && stage.bytes().all(|b| b.is_ascii_lowercase() || b == b'-')
}
