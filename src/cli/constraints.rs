//! The pins that a command line gives: one by one, and in a constraint file.

use std::path::Path;

use super::Failure;
use super::args::FlattenArguments;
use crate::io::{Constraints, Target, Targets};
use crate::mesh::VertexId;

/// The targets of all pins, for a mesh with so many vertices.
///
/// # Errors
///
/// A file that cannot be used, or a pin that clashes with another one; where that stands in the file, with its line.
pub(super) fn gather(arguments: &FlattenArguments, vertex_count: usize) -> Result<Targets, Failure> {
    let file = match &arguments.constraints {
        Some(path) => Constraints::read(path, vertex_count)?,
        None => Constraints::default(),
    };
    let place = arguments.constraints.as_deref().unwrap_or(Path::new(""));
    let mut targets = file.targets.clone();
    for (vertex, target) in &arguments.pins {
        if let Some(line) = file.lines.get(vertex) {
            let text = format!("vertex {vertex} is pinned twice: by --pin and on line {line} of {}", place.display());
            return Err(Failure::Usage(text));
        }
        if let Some(first) = in_the_way(&file.targets, target) {
            let line = file.lines[&first];
            let text = format!("--pin puts vertex {vertex} on the same place as line {line} of {}", place.display());
            return Err(Failure::Usage(format!("{text} does vertex {first}: move one of them, or give a weight")));
        }
        if targets.insert(*vertex, *target).is_some() {
            return Err(Failure::Usage(format!("vertex {vertex} is pinned twice: leave out one of the --pin")));
        }
    }
    Ok(targets)
}

/// The exact pin that has the target of another exact one.
fn in_the_way(targets: &Targets, target: &Target) -> Option<VertexId> {
    let clashes = |other: &Target| target.hold.is_exact() && other.hold.is_exact() && other.uv == target.uv;
    targets.iter().find(|(_, other)| clashes(other)).map(|(&vertex, _)| vertex)
}
