//! Position of texture coordinates in a PLY file, and the header for it.

use std::io::{self, Write};

use super::header::{Header, Scalar};
use super::{CORNER_NAMES, FACE_TEXTURE, TEXTURE_NAMES};
use crate::Precision;
use crate::mesh_file::{NO_TEXTURE, Texture};
use crate::obj::Lines;
use freebound_core::mesh::PolygonMesh;

/// Names of texture coordinates for vertices that had none.
const NEW_NAMES: [&str; 2] = ["s", "t"];

/// Layout of the written texture coordinates.
pub(super) struct Plan {
    /// Property names for texture coordinates of vertices; `has_names` is true if the file has them already.
    pub(super) names: [&'static str; 2],
    pub(super) has_names: bool,
    /// Coordinate of each vertex; `None` if vertices get none.
    pub(super) at_vertices: Option<Vec<u32>>,
    /// Type of the list length if corners get coordinates; `has_lists` is true if the file has the lists already.
    pub(super) at_corners: Option<Scalar>,
    pub(super) has_lists: bool,
    /// Type of the vertex indices.
    pub(super) index: Scalar,
    /// Type of the texture coordinates.
    pub(super) scalar: Scalar,
}

impl Plan {
    /// True if the faces of a file have lists of texture coordinates.
    pub(super) fn has_lists(header: &Header) -> bool {
        let face = header.elements.iter().find(|element| element.name == "face");
        face.is_some_and(|element| element.property(&[FACE_TEXTURE]).is_some())
    }

    pub(super) fn of(header: &Header, mesh: &PolygonMesh, texture: &Texture, precision: Precision) -> Self {
        let vertex = header.elements.iter().find(|element| element.name == "vertex");
        let face = header.elements.iter().find(|element| element.name == "face");
        let has = |name: &str| vertex.is_some_and(|element| element.property(&[name]).is_some());
        let own = TEXTURE_NAMES.into_iter().find(|[u, v]| has(u) && has(v));
        let has_lists = Self::has_lists(header);
        let at_vertices = one_per_vertex(mesh, texture);
        let has_texture = !texture.coordinates.is_empty();
        let most = (0..mesh.face_count()).map(|face| mesh.corner_range(face).len()).max().unwrap_or(0);
        let count = if u8::try_from(2 * most).is_ok() { Scalar::U8 } else { Scalar::I32 };
        let at_corners = (has_texture && (has_lists || at_vertices.is_none())).then_some(count);
        let own_index = face.and_then(|element| Some(element.properties[element.property(&CORNER_NAMES)?].item));
        let index = own_index.filter(|kind| kind.holds(mesh.positions.len())).unwrap_or(Scalar::U32);
        let names = own.unwrap_or(NEW_NAMES);
        let scalar = match precision {
            Precision::F32 => Scalar::F32,
            Precision::F64 => Scalar::F64,
        };
        Self { names, has_names: own.is_some(), at_vertices, at_corners, has_lists, index, scalar }
    }

    /// Writes the header of the file with the new properties and the numbers of vertices and faces.
    pub(super) fn write_header(&self, out: &mut impl Write, head: &[u8], counts: [usize; 2]) -> io::Result<()> {
        let mut element = String::new();
        for line in Lines::of(head) {
            let text = String::from_utf8_lossy(line.whole).into_owned();
            let words: Vec<&str> = text.split_whitespace().collect();
            let end = String::from_utf8_lossy(line.end()).into_owned();
            if matches!(words.first(), Some(&("element" | "end_header"))) {
                out.write_all(self.added(&element, &end).as_bytes())?;
            }
            let changed = match words.as_slice() {
                ["element", name, _] => {
                    (*name).clone_into(&mut element);
                    match *name {
                        "vertex" => Some(format!("element vertex {}{end}", counts[0])),
                        "face" => Some(format!("element face {}{end}", counts[1])),
                        _ => None,
                    }
                }
                ["property", _, name] if element == "vertex" && self.is_texture(name) => {
                    let line = |_: &Vec<u32>| format!("property {} {name}{end}", self.scalar.name());
                    Some(self.at_vertices.as_ref().map_or(String::new(), line))
                }
                ["property", "list", _, _, name] if element == "face" && *name == FACE_TEXTURE => Some(self.list(&end)),
                ["property", "list", count, _, name] if element == "face" && CORNER_NAMES.contains(name) => {
                    Some(format!("property list {count} {} {name}{end}", self.index.name()))
                }
                _ => None,
            };
            out.write_all(changed.as_ref().map_or(line.whole, |text| text.as_bytes()))?;
        }
        Ok(())
    }

    /// True if a property of vertices is one of the file's own texture coordinates.
    pub(super) fn is_texture(&self, name: &str) -> bool {
        self.has_names && self.names.contains(&name)
    }

    /// Properties that an element gets after its own.
    fn added(&self, element: &str, end: &str) -> String {
        let [u, v] = self.names;
        match element {
            "vertex" if self.at_vertices.is_some() && !self.has_names => {
                let scalar = self.scalar.name();
                format!("property {scalar} {u}{end}property {scalar} {v}{end}")
            }
            "face" if !self.has_lists => self.list(end),
            _ => String::new(),
        }
    }

    fn list(&self, end: &str) -> String {
        let line = |count: Scalar| format!("property list {} {} {FACE_TEXTURE}{end}", count.name(), self.scalar.name());
        self.at_corners.map_or(String::new(), line)
    }
}

/// Coordinate of each vertex; `None` if a vertex has different ones at its corners, or a corner has none.
fn one_per_vertex(mesh: &PolygonMesh, texture: &Texture) -> Option<Vec<u32>> {
    if texture.coordinates.is_empty() || texture.corners.contains(&NO_TEXTURE) {
        return None;
    }
    let mut found = vec![NO_TEXTURE; mesh.positions.len()];
    for (corner, &coordinate) in mesh.corners.iter().zip(&texture.corners) {
        let own = &mut found[corner.index()];
        if *own == NO_TEXTURE {
            *own = coordinate;
        } else if texture.coordinates[*own as usize] != texture.coordinates[coordinate as usize] {
            return None;
        }
    }
    Some(found)
}
