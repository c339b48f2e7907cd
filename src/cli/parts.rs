//! Parts of a mesh that are flattened.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::error::CommandError;
use super::typed::Parts;
use crate::session::Model;
use freebound_core::mesh::{PartFaces, Preparation};

/// Mesh without the parts that are not requested.
pub(super) fn with_parts(model: Model, wanted: Option<&Parts>) -> Result<Model, CommandError> {
    let Some(wanted) = wanted else { return Ok(model) };
    let parts = model.parts();
    let kept = match wanted {
        // The first of the largest parts.
        Parts::Largest => (0..parts.len()).rev().max_by_key(|&part| parts[part].count).into_iter().collect(),
        Parts::Numbered(numbers) => numbers.clone(),
    };
    if let Some(missing) = kept.iter().find(|&&number| number >= parts.len()) {
        let count = parts.len();
        let text = format!("--parts: there is no part {missing}: the mesh has {count}, numbered from 0");
        return Err(CommandError::Usage(format!("{}: {text}", model.path_words())));
    }
    let unwanted = parts.iter().enumerate().filter(|(part, _)| !kept.contains(part));
    let left_out: BTreeSet<u32> = unwanted.map(|(_, PartFaces { first_face, .. })| *first_face).collect();
    if left_out.is_empty() {
        return Ok(model);
    }
    let form = Preparation { left_out: Arc::new(left_out), ..model.prepared.form.clone() };
    Ok(model.in_form(form))
}
