//! Requested pins.

use std::path::Path;

use super::args::SolveArguments;
use super::error::CommandError;
use super::error::name_of_input;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use freebound_io::{Constraints, PictureFile, read_pts};
use freebound_run::Model;

/// Targets of all pins, by the vertices of the mesh, also with several charts. `input` is the mesh file.
///
/// # Errors
///
/// [`CommandError`] if a file cannot be used, pins clash, or a vertex cannot be pinned.
pub(super) fn targets_on(
    model: &Model,
    input: &Path,
    arguments: &SolveArguments,
    picture: Option<&PictureFile>,
) -> Result<Targets, CommandError> {
    let file = constraints(arguments, model.vertex_count_in_file(), picture)?;
    let targets = gather(input, arguments, &file)?;
    model.check_targets(&targets).map_err(|error| CommandError::of_run(model, error.with_observer()))?;
    Ok(targets)
}

/// Constraints of the file, at the landmarks of their names if there are any.
fn constraints(
    arguments: &SolveArguments,
    vertex_count: usize,
    picture: Option<&PictureFile>,
) -> Result<Constraints, CommandError> {
    let Some(path) = &arguments.constraints else { return Ok(Constraints::default()) };
    let mut constraints = Constraints::read(path, vertex_count)?;
    let Some(landmarks) = &arguments.landmarks else { return Ok(constraints) };
    let Some(picture) = picture else {
        let text = format!("{}: its points are pixels of a picture: add --picture", landmarks.display());
        return Err(CommandError::Usage(text));
    };
    let landmarks = read_pts(landmarks, [picture.pixels.width, picture.pixels.height])?;
    if constraints.move_to(&landmarks) == 0 {
        let text =
            format!("{}: no constraint has the name of a landmark: add \"# name\" to their lines", path.display());
        return Err(CommandError::Usage(text));
    }
    Ok(constraints)
}

/// Targets of all pins.
///
/// # Errors
///
/// [`CommandError`] if pins clash. The message names the line of a clash with the file.
fn gather(input: &Path, arguments: &SolveArguments, file: &Constraints) -> Result<Targets, CommandError> {
    let place = arguments.constraints.as_deref().unwrap_or(Path::new(""));
    let mut targets = file.targets.clone();
    for (vertex, target) in &arguments.pins {
        if let Some(line) = file.lines.get(vertex) {
            let text = format!("line {line}: vertex {vertex} is also pinned by --pin: remove one of them");
            return Err(CommandError::Usage(format!("{}: {text}", place.display())));
        }
        if let Some(first) = in_the_way(&file.targets, target) {
            let line = file.lines[&first];
            let text = format!("line {line}: vertex {first} has the same target as vertex {vertex} of --pin");
            return Err(CommandError::Usage(format!("{}: {text}: move one of them, or add a weight", place.display())));
        }
        if targets.insert(*vertex, *target).is_some() {
            let mesh = name_of_input(input);
            return Err(CommandError::Usage(format!("{mesh}: vertex {vertex} is pinned twice: remove one --pin")));
        }
    }
    Ok(targets)
}

/// Hard pin with the target of another hard pin.
fn in_the_way(targets: &Targets, target: &Target) -> Option<VertexId> {
    let clashes = |other: &Target| target.kind.is_hard() && other.kind.is_hard() && other.uv == target.uv;
    targets.iter().find(|(_, other)| clashes(other)).map(|(&vertex, _)| vertex)
}
