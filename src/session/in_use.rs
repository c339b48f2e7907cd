//! Files that are open, which nothing else is written over.

use std::path::{Path, PathBuf};

use super::Session;
use freebound_io::{material_files, would_replace};

/// What a file is to the session.
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
    /// Whether writing a file would replace one that is open; then says so. A file of the kind that is written may be
    /// brought up to date.
    pub(super) fn refuses_to_replace(&mut self, path: &Path, own: Option<Role>) -> bool {
        let Some(role) = self.role_of(path).filter(|&role| Some(role) != own) else { return false };
        let text = format!("{}: this would write over {}, which is open", path.display(), role.words());
        self.complain(text, Some("choose another name"));
        true
    }

    /// What a file is that is open.
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
