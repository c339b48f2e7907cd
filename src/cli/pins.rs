//! Requested pins.

use std::path::Path;

use super::args::SolveArguments;
use super::error::CommandError;
use super::error::name_of_input;
use crate::session::Model;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use freebound_core::problem::SolveError;
use freebound_io::Constraints;

/// Targets of all pins, by the vertices of the mesh, also with several charts. `input` is the mesh file.
///
/// # Errors
///
/// [`CommandError`] if a file cannot be used, pins clash, or a vertex cannot be pinned.
pub(super) fn targets_on(model: &Model, input: &Path, arguments: &SolveArguments) -> Result<Targets, CommandError> {
    let targets = gather(input, arguments, model.vertex_count_in_file())?;
    refuse_pins_of_joined_vertices(model, &targets)?;
    refuse_pins_of_no_face(model, &targets)?;
    Ok(targets)
}

/// Targets of all pins, for a mesh with `vertex_count` vertices.
///
/// # Errors
///
/// [`CommandError`] if a file cannot be used or pins clash. The message names the line of a clash with the file.
fn gather(input: &Path, arguments: &SolveArguments, vertex_count: usize) -> Result<Targets, CommandError> {
    let file = match &arguments.constraints {
        Some(path) => Constraints::read(path, vertex_count)?,
        None => Constraints::default(),
    };
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

/// Rejects pins of vertices that were joined with others. The vertex that they were joined with can be pinned instead.
fn refuse_pins_of_joined_vertices(model: &Model, targets: &Targets) -> Result<(), CommandError> {
    let Some(repaired) = model.whole_repaired() else { return Ok(()) };
    match targets.keys().find_map(|&vertex| Some((vertex, repaired.stands_for(vertex)?))) {
        Some((vertex, other)) => {
            let text = format!("vertex {vertex} is pinned, but was joined with vertex {other}: pin {other}");
            Err(CommandError::Usage(format!("{}: {text}", model.path_words())))
        }
        None => Ok(()),
    }
}

/// Rejects pins of vertices without a chart, if the mesh has several charts.
fn refuse_pins_of_no_face(model: &Model, targets: &Targets) -> Result<(), CommandError> {
    let Some(of) = &model.prepared.chart else { return Ok(()) };
    let count = model.vertex_count_in_file();
    match targets.keys().find(|&&vertex| of.charts.chart_of_vertex(vertex).is_none()) {
        Some(&vertex) if vertex.index() >= count => Err(SolveError::NoSuchVertex { vertex, count }.into()),
        Some(&vertex) => Err(SolveError::UnusedVertex { vertex }.into()),
        None => Ok(()),
    }
}

/// Hard pin with the target of another hard pin.
fn in_the_way(targets: &Targets, target: &Target) -> Option<VertexId> {
    let clashes = |other: &Target| target.kind.is_hard() && other.kind.is_hard() && other.uv == target.uv;
    targets.iter().find(|(_, other)| clashes(other)).map(|(&vertex, _)| vertex)
}
