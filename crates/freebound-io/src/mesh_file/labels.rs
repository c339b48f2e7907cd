//! Labels of the faces of a file: by material, and by group.

use std::collections::HashMap;

use super::{MeshFile, SourceFormat};

/// Reasons that a file has no labels of its faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LabelError {
    /// The file names no material.
    #[error("the file assigns no materials to its faces")]
    NoMaterials,
    /// The file names no group and no object.
    #[error("the file has neither groups nor objects")]
    NoGroups,
}

impl MeshFile {
    /// Label for each face, equal for faces of one material: `usemtl` in an OBJ file, the material of a primitive in
    /// glTF.
    ///
    /// # Errors
    ///
    /// If no face has a material.
    pub fn material_labels(&self) -> Result<Vec<u32>, LabelError> {
        let labels = match self.source.as_ref().map(|source| &source.format) {
            Some(SourceFormat::Gltf(scene)) => scene.material_labels(self.polygons.face_count()),
            _ => self.labels_by(&[b"usemtl"]),
        };
        labels.ok_or(LabelError::NoMaterials)
    }

    /// Label for each face, equal for faces with one group and object: `g` and `o` in an OBJ file, the node in a glTF
    /// file.
    ///
    /// # Errors
    ///
    /// If there are no groups and no objects.
    pub fn group_labels(&self) -> Result<Vec<u32>, LabelError> {
        let labels = match self.source.as_ref().map(|source| &source.format) {
            Some(SourceFormat::Gltf(scene)) => Some(scene.node_labels(self.polygons.face_count())),
            _ => self.labels_by(&[b"g", b"o"]),
        };
        labels.ok_or(LabelError::NoGroups)
    }

    /// Label for each face, equal for faces with equal arguments in these statements before them. `None` without such
    /// statements.
    fn labels_by(&self, keywords: &[&[u8]]) -> Option<Vec<u32>> {
        let mut state: Vec<&[u8]> = vec![b""; keywords.len()];
        let mut numbers: HashMap<Vec<&[u8]>, u32> = HashMap::from([(state.clone(), 0)]);
        let mut labels = Vec::with_capacity(self.polygons.face_count());
        let mut label = 0;
        let mut is_any = false;
        for statement in &self.statements {
            let (keyword, argument) = statement.split();
            let Some(place) = keywords.iter().position(|own| *own == keyword) else { continue };
            is_any = true;
            labels.resize(statement.before_face as usize, label);
            state[place] = argument.trim_ascii();
            let next = u32::try_from(numbers.len()).expect("fewer statements than 2^32");
            label = *numbers.entry(state.clone()).or_insert(next);
        }
        labels.resize(self.polygons.face_count(), label);
        is_any.then_some(labels)
    }
}
