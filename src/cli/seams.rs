//! Requested preparation of a mesh, with its seams.

use super::args::{Cut, MeshArguments};
use super::error::CommandError;
use super::progress::{INTERRUPTED, ProgressLine};
use freebound_core::mesh::{Preparation, VertexId};
use freebound_core::problem::Control;
use freebound_io::{LabelError, TextureError, read_edge_costs, read_edges};
use freebound_run::{Model, SeamKind};

/// Mesh in the requested preparation. `model` is read, but not prepared.
///
/// # Errors
///
/// [`CommandError`] if seams need data that the file lacks, or a file of edges cannot be used.
pub(super) fn formed(model: &Model, arguments: &MeshArguments, progress: &ProgressLine) -> Result<Model, CommandError> {
    let mut form = arguments.form();
    if form.seams.of_texture {
        check_texture(model)?;
    }
    // Vertices that a repair joins count as joined.
    let uncut = model.asking_for(Preparation { repair: form.repair, ..Preparation::default() });
    if let Cut::Along(path) = &arguments.cut {
        form.seams = form.seams.with(read_edges(path, &model.source.polygons)?);
    }
    if let Some(path) = &arguments.cut_weights {
        form.seams = form.seams.with_costs(read_edge_costs(path, &model.source.polygons)?);
    }
    for kind in &arguments.seams {
        form.seams = form.seams.with(edges_of(&uncut, *kind)?);
    }
    cut(model.in_form(form), arguments, progress)
}

/// Model cut along automatic seams, if they are requested. `model` is cut along the shortest paths, if it is cut.
fn cut(model: Model, arguments: &MeshArguments, progress: &ProgressLine) -> Result<Model, CommandError> {
    if matches!(arguments.cut, Cut::None | Cut::Shortest) {
        let idle = [
            ("--distortion", arguments.distortion.is_some()),
            ("--cut-weights", arguments.cut_weights.is_some()),
            ("--max-charts", arguments.max_charts.is_some()),
            ("--seam-visibility", arguments.seam_visibility.is_some()),
        ];
        return match idle.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(CommandError::Usage(format!("{option} needs automatic seams: add --cut auto"))),
            None => Ok(model),
        };
    }
    progress.enter("cutting");
    let control = Control::new(&INTERRUPTED, &|_| {});
    Ok(model.cut_automatically(arguments.automatic_cut(), control, &|_| {})?)
}

fn edges_of(model: &Model, kind: SeamKind) -> Result<Vec<[VertexId; 2]>, CommandError> {
    let refused = |error: LabelError| {
        CommandError::Usage(format!("{}: {error}: remove --seams {}", model.path_words(), kind.name()))
    };
    model.edges_of(kind).map_err(refused)
}

/// Rejects a cut along texture coordinates if some corners have none.
fn check_texture(model: &Model) -> Result<(), CommandError> {
    let path = model.path_words();
    model.source.texture_labels().map(drop).map_err(|error| match error {
        TextureError::None => CommandError::Usage(format!("{path}: {error}: remove --charts uv")),
        TextureError::Missing(_) => CommandError::Texture { path, error },
    })
}
