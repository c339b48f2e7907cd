//! The form that a mesh is asked for in, with its seams.

use super::Failure;
use super::args::{Cut, MeshArguments, SeamKind};
use crate::io::{LabelError, TextureError, read_edges};
use crate::mesh::{Form, VertexId};
use crate::session::Model;

/// The mesh, read and without a form, in the form that is asked for.
///
/// # Errors
///
/// Seams along what the file does not have, or a file of edges that cannot be used.
pub(super) fn formed(model: &Model, arguments: &MeshArguments) -> Result<Model, Failure> {
    let mut form = arguments.form();
    if form.seams.of_texture {
        check_texture(model)?;
    }
    // What a repair joins counts as joined.
    let uncut = Model { form: Form { repair: form.repair, ..Form::default() }, ..model.clone() };
    if let Cut::Along(path) = &arguments.cut {
        form.seams = form.seams.with(read_edges(path, &model.source.polygons)?);
    }
    for kind in &arguments.seams {
        form.seams = form.seams.with(edges_of(&uncut, *kind)?);
    }
    Ok(model.in_form(form))
}

fn edges_of(model: &Model, kind: SeamKind) -> Result<Vec<[VertexId; 2]>, Failure> {
    let (option, edges) = match kind {
        SeamKind::Sharp(degrees) => return Ok(model.crease_edges(degrees)),
        SeamKind::Materials => ("materials", model.material_borders()),
        SeamKind::Groups => ("groups", model.group_borders()),
    };
    let path = model.path_words();
    edges.map_err(|error: LabelError| Failure::Usage(format!("{path}: {error}: leave out --seams {option}")))
}

/// Refuses to cut along texture coordinates that not all corners have.
fn check_texture(model: &Model) -> Result<(), Failure> {
    let path = model.path_words();
    model.source.texture_labels().map(drop).map_err(|error| match error {
        TextureError::None => Failure::Usage(format!("{path}: {error}: leave out --charts uv")),
        TextureError::Missing(_) => Failure::Texture { path, error },
    })
}
