//! Clashes between the files of a run: no output overwrites an input, and no two outputs have one path.

use std::path::{Path, PathBuf};

use super::args::{
    BakeArguments, CarryArguments, CheckArguments, CompareArguments, Cut, FlattenArguments, MeshArguments,
    MeshOutputArguments, PackArguments, SolveArguments, StartOf, StudyArguments, TransferArguments,
};
use super::error::CommandError;
use super::error::is_standard;
use freebound_io::{
    MeshFile, PictureFile, StepsFolder, copies_of_materials, is_same_file, is_standard_input, material_files,
    would_replace,
};

/// File to write.
struct OutputPath {
    /// Option that requests the file.
    option: &'static str,
    path: PathBuf,
}

/// All outputs of a run.
pub(super) struct OutputPaths {
    files: Vec<OutputPath>,
    steps: Option<PathBuf>,
}

impl OutputPaths {
    pub(super) fn of_flatten(arguments: &FlattenArguments) -> Self {
        let FlattenArguments { output, svg, png, report, .. } = arguments;
        let library = output.as_deref().filter(|path| arguments.picture.is_some() && !is_standard(path));
        let library = library.map(PictureFile::library_beside);
        let asked = [("-o", output), ("--svg", svg), ("--png", png), ("--report", report), ("--picture", &library)];
        let asked =
            asked.into_iter().chain([("--pattern", &arguments.cutting.pattern), ("--flat-mesh", &arguments.flat_mesh)]);
        Self { steps: arguments.steps.clone(), ..Self::of(asked.map(|(option, path)| (option, path.as_deref()))) }
    }

    /// Files that options request.
    fn of<'a>(asked: impl IntoIterator<Item = (&'static str, Option<&'a Path>)>) -> Self {
        let place = |(option, path): (_, Option<&Path>)| Some(OutputPath { option, path: path?.to_owned() });
        Self { files: asked.into_iter().filter_map(place).collect(), steps: None }
    }

    pub(super) fn of_compare(arguments: &CompareArguments) -> Self {
        let outputs = arguments.outputs().into_iter().map(|(_, option, path)| (option, Some(path)));
        Self::of(outputs.chain([("--report", arguments.report.as_deref())]))
    }

    pub(super) fn of_pack(arguments: &PackArguments) -> Self {
        let MeshOutputArguments { output, report, .. } = &arguments.result;
        let asked = [("-o", output), ("--svg", &arguments.svg), ("--report", report)];
        Self::of(asked.map(|(option, path)| (option, path.as_deref())))
    }

    pub(super) fn of_transfer(arguments: &TransferArguments) -> Self {
        let MeshOutputArguments { output, report, .. } = &arguments.result;
        Self::of([("-o", output.as_deref()), ("--report", report.as_deref())])
    }

    pub(super) fn of_bake(arguments: &BakeArguments) -> Self {
        Self::of([("-o", Some(arguments.output.as_path())), ("--report", arguments.report.as_deref())])
    }

    pub(super) fn of_carry(arguments: &CarryArguments) -> Self {
        Self::of([("-o", Some(arguments.output.as_path())), ("--report", arguments.report.as_deref())])
    }

    pub(super) fn of_check(arguments: &CheckArguments) -> Self {
        Self::of([("--report", arguments.report.as_deref())])
    }

    pub(super) fn of_study(arguments: &StudyArguments) -> Self {
        Self::of([("--csv", arguments.csv.as_deref()), ("--svg", arguments.svg.as_deref())])
    }

    /// Rejects two outputs with one path.
    pub(super) fn keep_apart(&self) -> Result<(), CommandError> {
        for (count, second) in self.files.iter().enumerate() {
            let Some(first) = self.files[..count].iter().find(|first| clash(&first.path, &second.path)) else {
                continue;
            };
            return Err(both_write(&second.path, [first.option, second.option]));
        }
        match self.files.iter().find(|place| self.is_of_steps(&place.path)) {
            Some(place) => Err(both_write(&place.path, [place.option, "--steps"])),
            None => Ok(()),
        }
    }

    /// Rejects outputs that clash with copies beside the mesh: of its picture or of its materials.
    ///
    /// # Errors
    ///
    /// [`CommandError`] if outputs clash with copies, or a file to be copied cannot be read.
    pub(super) fn spare_copies(
        &self,
        arguments: &FlattenArguments,
        source: &MeshFile,
        picture: Option<&PictureFile>,
    ) -> Result<(), CommandError> {
        let Some(mesh) = arguments.output.as_deref().filter(|path| !is_standard(path)) else { return Ok(()) };
        let (option, copies) = match picture {
            Some(picture) => ("--picture", picture.copies_beside(mesh)?),
            None if arguments.copy_materials => {
                ("--copy-materials", copies_of_materials(source, &arguments.input.mesh, mesh)?)
            }
            None => return Ok(()),
        };
        self.spare_files(option, &copies)
    }

    /// Rejects outputs that would overwrite files named by the mesh's materials, or clash with copies of them.
    ///
    /// # Errors
    ///
    /// [`CommandError`] if outputs clash, or a file to be copied cannot be read.
    pub(super) fn spare_materials_and_copies(
        &self,
        result: &MeshOutputArguments,
        source: &MeshFile,
        mesh: &Path,
    ) -> Result<(), CommandError> {
        self.spare_materials(source, mesh)?;
        let Some(output) = result.output.as_deref().filter(|_| result.copy_materials) else { return Ok(()) };
        self.spare_files("--copy-materials", &copies_of_materials(source, mesh, output)?)
    }

    /// Rejects other outputs that clash with the files that an option copies.
    fn spare_files(&self, option: &'static str, copies: &[PathBuf]) -> Result<(), CommandError> {
        for copy in copies {
            let others = self.files.iter().filter(|place| place.option != option);
            if let Some(place) = others.into_iter().find(|place| clash(&place.path, copy)) {
                return Err(both_write(copy, [place.option, option]));
            }
            if self.is_of_steps(copy) {
                return Err(both_write(copy, ["--steps", option]));
            }
        }
        Ok(())
    }

    /// True if a file is the folder of steps, or would be overwritten in it.
    fn is_of_steps(&self, path: &Path) -> bool {
        let is_of = |folder: &PathBuf| StepsFolder::would_replace(folder, path) || is_same_file(path, folder);
        !is_standard(path) && self.steps.as_ref().is_some_and(is_of)
    }

    /// Rejects outputs that would overwrite files named by the mesh's materials.
    pub(super) fn spare_materials(&self, source: &MeshFile, mesh: &Path) -> Result<(), CommandError> {
        material_files(source, mesh).iter().try_for_each(|file| self.spare(file, "a file that belongs to the mesh"))
    }

    /// Rejects outputs that would overwrite the input files: mesh, constraints, layout, edges.
    pub(super) fn spare_inputs(&self, input: &MeshArguments, solve: &SolveArguments) -> Result<(), CommandError> {
        self.spare(&input.mesh, "the mesh")?;
        if let Some(constraints) = &solve.constraints {
            self.spare(constraints, "the constraints")?;
        }
        if let Some(landmarks) = &solve.landmarks {
            self.spare(landmarks, "the landmarks")?;
        }
        if let Some(StartOf::File(layout)) = &solve.start {
            self.spare(layout, "the layout to start from")?;
        }
        match &input.cut {
            Cut::Along(edges) => self.spare(edges, "the edges"),
            Cut::None | Cut::Auto | Cut::Shortest => Ok(()),
        }
    }

    /// Rejects outputs that would overwrite an input file. `what` describes the file.
    pub(super) fn spare(&self, input: &Path, what: &str) -> Result<(), CommandError> {
        let over = |option: &str| {
            let input = input.display();
            Err(CommandError::Usage(format!("{input}: {option} would overwrite {what}: choose another path")))
        };
        if is_standard(input) {
            return match self.files.iter().find(|place| !is_standard(&place.path) && is_standard_input(&place.path)) {
                Some(OutputPath { option, path }) => Err(CommandError::Usage(format!(
                    "{}: {option} would overwrite {what}, the source of standard input: choose another path",
                    path.display()
                ))),
                None => Ok(()),
            };
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

/// True if writing one file would overwrite the other.
fn clash(a: &Path, b: &Path) -> bool {
    if is_standard(a) || is_standard(b) { a == b } else { would_replace(a, b) }
}

/// Error for two outputs with one path.
fn both_write(path: &Path, [first, second]: [&str; 2]) -> CommandError {
    CommandError::Usage(if is_standard(path) {
        format!("standard output: {first} and {second} cannot both use it: name a file for one of them")
    } else {
        format!("{}: {first} and {second} would both write this file: rename one of them", path.display())
    })
}
