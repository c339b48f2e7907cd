//! Files of a run that must not be one another: no input is written over, and no two results go to one place.

use std::path::{Path, PathBuf};

use super::Failure;
use super::args::{CheckArguments, FlattenArguments};
use super::standard::is_standard;
use crate::io::{ObjMesh, PictureFile, StepsFolder, is_same_file, material_files};

/// A file that is written.
struct Place {
    /// The option that asks for it.
    option: &'static str,
    path: PathBuf,
}

/// Where a run writes.
pub(super) struct Places {
    files: Vec<Place>,
    steps: Option<PathBuf>,
}

impl Places {
    pub(super) fn of_flatten(arguments: &FlattenArguments) -> Self {
        let FlattenArguments { output, svg, png, report, .. } = arguments;
        let library = output.as_deref().filter(|path| arguments.picture.is_some() && !is_standard(path));
        let library = library.map(PictureFile::library_beside);
        let asked = [("-o", output), ("--svg", svg), ("--png", png), ("--report", report), ("--picture", &library)];
        let place = |(option, path): (_, &Option<PathBuf>)| Some(Place { option, path: path.clone()? });
        Self { files: asked.into_iter().filter_map(place).collect(), steps: arguments.steps.clone() }
    }

    pub(super) fn of_check(arguments: &CheckArguments) -> Self {
        let files = arguments.report.iter().map(|path| Place { option: "--report", path: path.clone() });
        Self { files: files.collect(), steps: None }
    }

    /// Refuses two results in one place.
    pub(super) fn keep_apart(&self) -> Result<(), Failure> {
        for (count, second) in self.files.iter().enumerate() {
            let Some(first) = self.files[..count].iter().find(|first| clash(&first.path, &second.path)) else {
                continue;
            };
            let options = format!("{} and {}", first.option, second.option);
            return Err(Failure::Usage(if is_standard(&second.path) {
                format!("standard output: {options} cannot both go there: name a file for one of them")
            } else {
                format!("{}: {options} would both write it: give one of them another name", second.path.display())
            }));
        }
        Ok(())
    }

    /// Refuses to write over files that the mesh's materials name.
    pub(super) fn spare_materials(&self, source: &ObjMesh, mesh: &Path) -> Result<(), Failure> {
        material_files(source, mesh)
            .iter()
            .try_for_each(|file| self.spare(file, "a file that the mesh's materials name"))
    }

    /// Refuses to write over a file that is read. `what` it is, in words.
    pub(super) fn spare(&self, input: &Path, what: &str) -> Result<(), Failure> {
        let over = |option: &str| {
            let input = input.display();
            Err(Failure::Usage(format!("{input}: {option} would write over {what}: choose another place for it")))
        };
        if is_standard(input) {
            return Ok(());
        }
        if let Some(place) = self.files.iter().find(|place| clash(&place.path, input)) {
            return over(place.option);
        }
        match &self.steps {
            Some(folder) if StepsFolder::would_replace(folder, input) => over("--steps"),
            _ => Ok(()),
        }
    }
}

/// Whether one file would be written over by the other. A device such as `/dev/null` takes any number of them.
fn clash(a: &Path, b: &Path) -> bool {
    if is_standard(a) || is_standard(b) {
        return a == b;
    }
    let is_device = b.exists() && !b.is_file();
    !is_device && is_same_file(a, b)
}
