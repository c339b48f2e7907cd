//! Meshes of a batch, and the places of their results.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::super::args::{BatchArguments, BatchFormat};
use super::super::error::CommandError;
use freebound_io::memory_to_read;

/// Extensions of meshes.
const EXTENSIONS: [&str; 6] = ["obj", "ply", "glb", "gltf", "stl", "off"];

/// Memory of a run beyond that of its mesh, bytes.
const BASE_MEMORY: u64 = 32 << 20;

/// Memory of a run relative to that of reading its mesh. The largest ratio of 157 public meshes above 500 kB was 13.3.
const MEMORY_RATIO: u64 = 14;

/// Mesh of a batch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BatchFile {
    /// Path of the mesh.
    pub(super) input: PathBuf,
    /// Path of the result.
    pub(super) output: PathBuf,
    /// Estimated memory of its run, bytes.
    pub(super) memory: u64,
}

/// Meshes of a batch in the order of the arguments, those of a folder by their names.
///
/// # Errors
///
/// [`CommandError::Usage`] if a folder or a list cannot be read, an argument is no mesh, there are no meshes, or a result
/// would replace a mesh.
pub(super) fn files(arguments: &BatchArguments) -> Result<Vec<BatchFile>, CommandError> {
    let mut found = Vec::new();
    for input in &arguments.inputs {
        gather(input, &arguments.output_dir, &mut found)?;
    }
    if found.is_empty() {
        let endings = EXTENSIONS.map(|extension| format!(".{extension}")).join(", ");
        return Err(CommandError::Usage(format!("there are no meshes: name files that end in {endings}")));
    }
    let inputs: BTreeSet<PathBuf> = found.iter().map(|found| whole_path(&found.input)).collect();
    let mut taken = BTreeSet::new();
    let mut seen = BTreeSet::new();
    let mut files = Vec::new();
    for Found { input, place } in found {
        if !seen.insert(input.clone()) {
            continue;
        }
        let output = arguments.output_dir.join(name_of_result(&place, arguments.format, &mut taken));
        if inputs.contains(&whole_path(&output)) {
            let text = "the result would replace a mesh: choose another --output-dir";
            return Err(CommandError::Usage(format!("{}: {text}", output.display())));
        }
        let to_read = memory_to_read(&input).unwrap_or(0);
        let memory = BASE_MEMORY.saturating_add(to_read.saturating_mul(MEMORY_RATIO));
        files.push(BatchFile { input, output, memory });
    }
    Ok(files)
}

/// Mesh with the place of its result, relative to the folder of results.
struct Found {
    input: PathBuf,
    place: PathBuf,
}

fn is_mesh(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    EXTENSIONS.contains(&extension.as_str())
}

/// Path without links, as far as it exists.
fn whole_path(path: &Path) -> PathBuf {
    if let Ok(path) = path.canonicalize() {
        return path;
    }
    match (path.parent().filter(|parent| !parent.as_os_str().is_empty()), path.file_name()) {
        (Some(parent), Some(name)) => whole_path(parent).join(name),
        _ => std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
    }
}

/// Collects the meshes of an argument. The folder of results is passed over.
fn gather(input: &Path, results: &Path, found: &mut Vec<Found>) -> Result<(), CommandError> {
    let unreadable = |error: std::io::Error| CommandError::Usage(format!("{}: {error}", input.display()));
    if input.is_dir() {
        return gather_folder(input, input, &whole_path(results), found).map_err(unreadable);
    }
    let is_list = input.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("txt"));
    if !is_list {
        let name = input.file_name().map(PathBuf::from);
        let Some(place) = name.filter(|_| is_mesh(input)) else {
            let text = "this is no mesh, no folder and no list (.txt)";
            return Err(CommandError::Usage(format!("{}: {text}", input.display())));
        };
        found.push(Found { input: input.to_owned(), place });
        return Ok(());
    }
    let text = fs::read_to_string(input).map_err(unreadable)?;
    let folder = input.parent().unwrap_or(Path::new(""));
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    // Paths of a list are relative to the list.
    lines.map(|line| folder.join(line)).try_for_each(|path| {
        let place = path.file_name().map(PathBuf::from).unwrap_or_default();
        if path.is_dir() {
            return gather(&path, results, found);
        }
        found.push(Found { input: path, place });
        Ok(())
    })
}

fn gather_folder(root: &Path, folder: &Path, results: &Path, found: &mut Vec<Found>) -> std::io::Result<()> {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    entries.sort();
    for path in entries {
        // Links to folders are not followed: they may form a circle.
        if path.is_dir() && !path.is_symlink() {
            if whole_path(&path) != results {
                gather_folder(root, &path, results, found)?;
            }
        } else if path.is_file() && is_mesh(&path) {
            let place = path.strip_prefix(root).unwrap_or(&path).to_owned();
            found.push(Found { input: path, place });
        }
    }
    Ok(())
}

/// Name of a result. Results with the name of an earlier one get a number.
fn name_of_result(place: &Path, format: Option<BatchFormat>, taken: &mut BTreeSet<PathBuf>) -> PathBuf {
    let own = place.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let is_written = ["obj", "ply", "glb"].contains(&own.as_str());
    let extension = match format {
        Some(format) => format.extension(),
        None if is_written => own.as_str(),
        None => "obj",
    };
    let stem = place.file_stem().unwrap_or_default().to_string_lossy();
    let numbered = (2..).map(|count: usize| place.with_file_name(format!("{stem}-{count}.{extension}")));
    let mut names = std::iter::once(place.with_extension(extension)).chain(numbered);
    let name = names.find(|name| !taken.contains(name)).expect("one of endless names is free");
    taken.insert(name.clone());
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_with_equal_names_get_numbers_and_formats_that_are_not_written_become_obj() {
        let mut taken = BTreeSet::new();
        let mut name = |place: &str, format| name_of_result(Path::new(place), format, &mut taken);
        assert_eq!(name("a/box.stl", None), Path::new("a/box.obj"));
        assert_eq!(name("a/box.OBJ", None), Path::new("a/box-2.obj"));
        assert_eq!(name("b/box.ply", None), Path::new("b/box.ply"));
        assert_eq!(name("b/box.off", Some(BatchFormat::Ply)), Path::new("b/box-2.ply"));
        assert_eq!(name("a/box-2.obj", None), Path::new("a/box-2-2.obj"));
    }
}
