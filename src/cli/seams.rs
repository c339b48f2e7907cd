//! The form that a mesh is asked for in, with its seams.

use super::args::{Cut, MeshArguments, SeamKind};
use super::error::CommandError;
use crate::session::Model;
use freebound_core::mesh::{Preparation, VertexId};
use freebound_io::{LabelError, TextureError, read_edges};

/// The mesh, read and without a form, in the form that is asked for.
///
/// # Errors
///
/// Seams along what the file does not have, or a file of edges that cannot be used.
pub(super) fn formed(model: &Model, arguments: &MeshArguments) -> Result<Model, CommandError> {
    let mut form = arguments.form();
    if form.seams.of_texture {
        check_texture(model)?;
    }
    // What a repair joins counts as joined.
    let uncut = model.asking_for(Preparation { repair: form.repair, ..Preparation::default() });
    if let Cut::Along(path) = &arguments.cut {
        form.seams = form.seams.with(read_edges(path, &model.source.polygons)?);
    }
    for kind in &arguments.seams {
        form.seams = form.seams.with(edges_of(&uncut, *kind)?);
    }
    Ok(model.in_form(form))
}

fn edges_of(model: &Model, kind: SeamKind) -> Result<Vec<[VertexId; 2]>, CommandError> {
    let (option, edges) = match kind {
        SeamKind::Sharp(degrees) => return Ok(model.crease_edges(degrees)),
        SeamKind::Materials => ("materials", model.material_borders()),
        SeamKind::Groups => ("groups", model.group_borders()),
    };
    let path = model.path_words();
    edges.map_err(|error: LabelError| CommandError::Usage(format!("{path}: {error}: leave out --seams {option}")))
}

/// Refuses to cut along texture coordinates that not all corners have.
fn check_texture(model: &Model) -> Result<(), CommandError> {
    let path = model.path_words();
    model.source.texture_labels().map(drop).map_err(|error| match error {
        TextureError::None => CommandError::Usage(format!("{path}: {error}: leave out --charts uv")),
        TextureError::Missing(_) => CommandError::Texture { path, error },
    })
}
