//! What tells the faces of a file apart: their materials, and the groups that they are in.

use std::collections::HashMap;

use super::{MeshFile, SourceFormat};

/// Why faces of a file are not told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LabelError {
    /// No material is named in it.
    #[error("the file gives its faces no materials")]
    NoMaterials,
    /// No group and no object is named in it.
    #[error("the file has no groups and no objects")]
    NoGroups,
}

impl MeshFile {
    /// A label for each face, the same where faces have the same material: of an OBJ file as `usemtl` names it, of a glTF file as
    /// its primitives do.
    ///
    /// # Errors
    ///
    /// Where no face has one.
    pub fn material_labels(&self) -> Result<Vec<u32>, LabelError> {
        let labels = match self.source.as_ref().map(|source| &source.format) {
            Some(SourceFormat::Gltf(scene)) => scene.material_labels(self.polygons.face_count()),
            _ => self.labels_by(&[b"usemtl"]),
        };
        labels.ok_or(LabelError::NoMaterials)
    }

    /// A label for each face, the same where faces are in the same groups of the same object: of an OBJ file by its `g` and `o`, of
    /// a glTF file by the nodes that show its meshes.
    ///
    /// # Errors
    ///
    /// Where there are none.
    pub fn group_labels(&self) -> Result<Vec<u32>, LabelError> {
        let labels = match self.source.as_ref().map(|source| &source.format) {
            Some(SourceFormat::Gltf(scene)) => Some(scene.node_labels(self.polygons.face_count())),
            _ => self.labels_by(&[b"g", b"o"]),
        };
        labels.ok_or(LabelError::NoGroups)
    }

    /// A label for each face: the same where these statements before it say the same. None where there are no such statements.
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
