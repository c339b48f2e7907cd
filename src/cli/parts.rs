//! Parts of a mesh that are flattened.

use super::error::CommandError;
use freebound_run::{Model, PartChoice};

/// Mesh without the parts that are not requested.
pub(super) fn with_parts(model: Model, wanted: Option<&PartChoice>) -> Result<Model, CommandError> {
    let Some(wanted) = wanted else { return Ok(model) };
    let path = model.path_words();
    model.with_parts(wanted).map_err(|error| CommandError::Usage(format!("{path}: --parts: {error}")))
}
