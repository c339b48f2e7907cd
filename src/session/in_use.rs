//! Open files, which must not be overwritten by other outputs.

use std::path::{Path, PathBuf};

use super::Session;
use freebound_io::{material_files, would_replace};

/// Role of an open file in the session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Mesh,
    Material,
    Picture,
    Constraints,
    Project,
}

impl Role {
    const fn words(self) -> &'static str {
        match self {
            Self::Mesh => "the mesh",
            Self::Material => "a file that belongs to the mesh",
            Self::Picture => "the picture",
            Self::Constraints => "the constraints",
            Self::Project => "the project",
        }
    }
}

impl Session {
    /// True if writing a file would replace an open file; reports this. A file of the same role `own` may be replaced.
    pub(super) fn refuses_to_replace(&mut self, path: &Path, own: Option<Role>) -> bool {
        let Some(role) = self.role_of(path).filter(|&role| Some(role) != own) else { return false };
        let text = format!("{}: this would overwrite {}, which is open", path.display(), role.words());
        self.complain(text, Some("choose another name"));
        true
    }

    /// Role of a file, if it is open.
    fn role_of(&self, path: &Path) -> Option<Role> {
        let model = self.model()?;
        let is = |file: Option<&PathBuf>| file.is_some_and(|file| would_replace(path, file));
        let is_material = |mesh: &PathBuf| material_files(&model.source, mesh).iter().any(|file| is(Some(file)));
        let picture = self.document.picture.as_ref().and_then(|picture| picture.path.as_ref());
        let roles = [
            (is(model.path.as_ref()), Role::Mesh),
            (is(picture), Role::Picture),
            (is(self.files.constraints()), Role::Constraints),
            (is(self.project_path()), Role::Project),
            (model.path.as_ref().is_some_and(is_material), Role::Material),
        ];
        roles.into_iter().find_map(|(is, role)| is.then_some(role))
    }
}
