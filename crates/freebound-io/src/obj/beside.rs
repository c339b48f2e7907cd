//! Files that belong to a mesh, in the mesh's folder. Unrelated files are never overwritten.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use crate::{WriteError, write_atomically};

/// Folder of a mesh, as the target for copies of other files.
pub(super) struct Beside<'a> {
    pub(super) mesh: &'a Path,
    /// Contents of the planned copies; `None` if copies are written at once.
    planned: Option<BTreeMap<PathBuf, Vec<u8>>>,
    /// Copies that were written.
    written: Vec<PathBuf>,
}

impl<'a> Beside<'a> {
    /// Target that writes the copies.
    pub(super) fn writing(mesh: &'a Path) -> Self {
        Self { mesh, planned: None, written: Vec::new() }
    }

    /// Target that writes nothing: [`planned`](Self::planned) returns the files that would be written.
    pub(super) fn planning(mesh: &'a Path) -> Self {
        Self { mesh, planned: Some(BTreeMap::new()), written: Vec::new() }
    }

    /// Files that would be in the mesh's folder.
    pub(super) fn planned(self) -> Vec<PathBuf> {
        self.planned.unwrap_or_default().into_keys().collect()
    }

    /// Files that were written, in order.
    pub(super) fn written(self) -> Vec<PathBuf> {
        self.written
    }

    /// Puts a file into the mesh's folder, unless it is there already, and returns its name. Blanks in names are
    /// replaced, because some readers do not accept them. An unrelated file of that name stays: the copy then gets
    /// the mesh's name as a prefix.
    pub(super) fn put(&mut self, name: &str, bytes: &[u8]) -> Result<String, WriteError> {
        let name = without_blanks(name);
        let second = format!("{}-{name}", stem_of(self.mesh));
        self.put_under(&[name, second], bytes)
    }

    /// Puts a file under the first usable of these names, unless it is there already, and returns that name.
    pub(super) fn put_under(&mut self, names: &[String], bytes: &[u8]) -> Result<String, WriteError> {
        let place = place_for(self.mesh, names, |place| self.may_take(place, bytes));
        if let Some(planned) = &mut self.planned {
            planned.insert(place.clone(), bytes.to_vec());
        } else if !holds(&place, bytes) {
            write_atomically(&place, |out| out.write_all(bytes))?;
            self.written.push(place.clone());
        }
        Ok(name_of(&place))
    }

    fn may_take(&self, place: &Path, bytes: &[u8]) -> bool {
        match self.planned.as_ref().and_then(|planned| planned.get(place)) {
            Some(contents) => contents == bytes,
            None => is_free(place) || holds(place, bytes),
        }
    }
}

/// Path in the mesh's folder that does not overwrite an unrelated file: the first of these names that may be taken.
/// If none may be, the last name with a number, from 2 on.
pub(super) fn place_for(mesh: &Path, names: &[String], may_take: impl Fn(&Path) -> bool) -> PathBuf {
    let last = names.last().map_or("", String::as_str);
    let further = (2_u64..).map(|number| numbered(last, number));
    let mut places = names.iter().cloned().chain(further).map(|name| mesh.with_file_name(name));
    places.find(|place| place != mesh && may_take(place)).expect("a folder has fewer files than there are numbers")
}

/// True if no file is visible there. Without permission to look, the later write fails and reports it.
pub(super) fn is_free(place: &Path) -> bool {
    fs::symlink_metadata(place).is_err()
}

/// True if a file begins with `head`. Only regular files are opened: reading a pipe could block for ever.
pub(super) fn begins_with(place: &Path, head: &[u8]) -> bool {
    if !place.is_file() {
        return false;
    }
    let Ok(file) = fs::File::open(place) else { return false };
    let mut found = Vec::new();
    file.take(head.len() as u64).read_to_end(&mut found).is_ok() && found == head
}

/// True if a file has exactly these contents. It is read only if the lengths are equal.
fn holds(place: &Path, bytes: &[u8]) -> bool {
    fs::metadata(place).is_ok_and(|data| data.len() == bytes.len() as u64) && begins_with(place, bytes)
}

/// File name with a number before its extension.
fn numbered(name: &str, number: u64) -> String {
    match name.rsplit_once('.') {
        Some((stem, extension)) => format!("{stem}-{number}.{extension}"),
        None => format!("{name}-{number}"),
    }
}

/// File name of a mesh without its extension, for the names of the files beside it.
pub(super) fn stem_of(mesh: &Path) -> String {
    without_blanks(&mesh.file_stem().unwrap_or_default().to_string_lossy())
}

pub(super) fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

pub(super) fn without_blanks(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}
