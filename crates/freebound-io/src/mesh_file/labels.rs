//! Labels of the faces of a file: by material, and by group; names of groups.

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

/// Groups of the faces of a file, with their names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedGroups {
    /// Name of each group. Empty for faces without a name.
    pub names: Vec<String>,
    /// Group of each face.
    pub of_face: Vec<u32>,
}

/// Labels of the faces, and the arguments that each label stands for.
type LabelsWithArguments<'a> = (Vec<u32>, Vec<Vec<&'a [u8]>>);

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
            _ => self.labels_by(&[b"usemtl"]).map(|(labels, _)| labels),
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
            _ => self.labels_by(&[b"g", b"o"]).map(|(labels, _)| labels),
        };
        labels.ok_or(LabelError::NoGroups)
    }

    /// Groups with their names: the group of an OBJ file, or the object if the group has no name; the node of a glTF
    /// file, or its mesh. `None` if the file names none.
    pub fn named_groups(&self) -> Option<NamedGroups> {
        let format = self.source.as_ref().map(|source| &source.format);
        let (names, of_face) = if let Some(SourceFormat::Gltf(scene)) = format {
            (scene.node_names(), scene.node_labels(self.polygons.face_count()))
        } else {
            let (labels, arguments) = self.labels_by(&[b"g", b"o"])?;
            (arguments.iter().map(|names| first_name(names)).collect(), labels)
        };
        names.iter().any(|name| !name.is_empty()).then_some(NamedGroups { names, of_face })
    }

    /// Label for each face, equal for faces with equal arguments in these statements before them. `None` without such
    /// statements.
    fn labels_by(&self, keywords: &[&[u8]]) -> Option<LabelsWithArguments<'_>> {
        let mut state: Vec<&[u8]> = vec![b""; keywords.len()];
        let mut arguments = vec![state.clone()];
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
            if label == next {
                arguments.push(state.clone());
            }
        }
        labels.resize(self.polygons.face_count(), label);
        is_any.then_some((labels, arguments))
    }
}

/// First of these names that says something.
fn first_name(names: &[&[u8]]) -> String {
    let names = names.iter().map(|name| String::from_utf8_lossy(name).into_owned());
    names.into_iter().find(|name| !matches!(name.as_str(), "" | "default" | "off")).unwrap_or_default()
}
