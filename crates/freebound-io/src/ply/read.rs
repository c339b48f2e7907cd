//! Mesh from a PLY file: positions, faces, and texture coordinates of vertices (`u` and `v`, or `s` and `t`) or of
//! corners (`texcoord`). Everything else is skipped.
//!
//! Faces are the items of `face`. Without any, they are triangle strips: the lists of `tristrips`, in which every index after the second
//! makes a triangle with the two before it, and −1 begins a new strip.

use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};

use super::header::{Element, Header, Property};
use super::numbers::Numbers;
use super::{CORNER_NAMES, FACE_TEXTURE, STRIPS, TEXTURE_NAMES};
use crate::file_values::FileValues;
use crate::mesh_file::{
    FaultPlace, MeshFile, NO_TEXTURE, ParseFaultKind, ReadError, Source, SourceFormat, Texture, fault_at,
};
use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::problem::Embedding;

/// Parses a mesh from a PLY file, and keeps the file.
pub(crate) fn parse_ply(bytes: Vec<u8>) -> Result<MeshFile, ReadError> {
    let header = Header::of(&bytes)?;
    header.check_faces()?;
    let has_strips = header.count_of("face") == 0 && header.count_of(STRIPS) > 0;
    let mut reader = Reader { vertex_count: header.count_of("vertex"), ..Reader::of(Numbers::of(&bytes, &header)) };
    for element in &header.elements {
        reader.numbers.check_room(element, header.encoding)?;
        match element.name.as_str() {
            "vertex" => reader.vertices(element, header.lines)?,
            "face" => reader.faces(element, header.lines)?,
            STRIPS if has_strips => reader.strips(element, header.lines)?,
            // Items without properties take no bytes, whatever their number.
            _ if element.properties.is_empty() => {}
            _ => (0..element.count).try_for_each(|_| reader.skip_all(&element.properties))?,
        }
    }
    let mut mesh = reader.finish()?;
    let vertex_count = mesh.polygons.positions.len();
    // A writer cannot put faces in the place of strips: it makes a new file.
    if !has_strips {
        mesh.source = Some(Source::of(SourceFormat::Ply(Arc::new(header)), bytes, vertex_count));
    }
    Ok(mesh)
}

impl Header {
    /// Fails if vertices have the list of corners, because the header lacks `element face`.
    fn check_faces(&self) -> Result<(), ReadError> {
        let is_list = |property: &Property| property.count.is_some() && CORNER_NAMES.contains(&&property.name[..]);
        let has_lists = |element: &Element| element.name == "vertex" && element.properties.iter().any(is_list);
        if !self.elements.iter().any(has_lists) || self.elements.iter().any(|element| element.name == "face") {
            return Ok(());
        }
        let kind = ParseFaultKind::Unexpected {
            found: "property list under element vertex".to_owned(),
            expected: "element face before it",
        };
        Err(fault_at(FaultPlace::Line(self.lines), kind))
    }

    /// Number of items of this name.
    fn count_of(&self, name: &str) -> u64 {
        self.elements.iter().filter(|element| element.name == name).map(|element| element.count).sum()
    }
}

/// Names of the properties of a colour.
const COLOURS: [[&str; 4]; 3] = [
    ["red", "green", "blue", "alpha"],
    ["r", "g", "b", "a"],
    ["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"],
];

impl Header {
    /// Normals and colours of the vertices; `None` without any.
    pub(crate) fn vertex_values(&self, bytes: &[u8]) -> (Option<FileValues>, Option<FileValues>) {
        let mut reader = Reader::of(Numbers::of(bytes, self));
        for element in &self.elements {
            if element.name == "vertex" {
                return reader.vertex_values(element).unwrap_or_default();
            }
            if (0..element.count).try_for_each(|_| reader.skip_all(&element.properties)).is_err() {
                break;
            }
        }
        (None, None)
    }
}

/// Mesh as far as it is read.
struct Reader<'a> {
    numbers: Numbers<'a>,
    vertex_count: u64,
    mesh: PolygonMesh,
    /// Texture coordinates of vertices; empty if they have none.
    at_vertices: Vec<DVec2>,
    /// Texture coordinates of corners, if faces have them.
    at_corners: Texture,
}

impl<'a> Reader<'a> {
    fn of(numbers: Numbers<'a>) -> Self {
        let mesh = PolygonMesh { starts: Some(vec![0]), ..PolygonMesh::default() };
        Self { numbers, vertex_count: 0, mesh, at_vertices: Vec::new(), at_corners: Texture::default() }
    }

    fn vertices(&mut self, element: &Element, header_lines: u64) -> Result<(), ReadError> {
        let single = |names: &[&str]| element.property(names).filter(|&at| element.properties[at].count.is_none());
        let [Some(x), Some(y), Some(z)] = ["x", "y", "z"].map(|name| single(&[name])) else {
            let kind = ParseFaultKind::Unexpected {
                found: "element vertex".to_owned(),
                expected: "its properties x, y and z",
            };
            return Err(fault_at(FaultPlace::Line(header_lines), kind));
        };
        let texture = TEXTURE_NAMES.iter().find_map(|[u, v]| Some([single(&[u])?, single(&[v])?]));
        let mut row = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            let place = self.numbers.place();
            self.row(element, &mut row)?;
            let position = DVec3::new(row[x], row[y], row[z]);
            if !position.is_finite() {
                let place = if matches!(place, FaultPlace::Line(_)) { self.numbers.place() } else { place };
                return Err(fault_at(place, ParseFaultKind::NotFinite));
            }
            self.mesh.positions.push(position);
            self.at_vertices.extend(texture.map(|[u, v]| DVec2::new(row[u], row[v])));
        }
        Ok(())
    }

    /// Reads the single numbers of an item, and skips its lists.
    fn row(&mut self, element: &Element, row: &mut [f64]) -> Result<(), ReadError> {
        for (property, value) in element.properties.iter().zip(row) {
            match property.count {
                None => *value = self.numbers.next(property.item)?,
                Some(_) => self.skip(property)?,
            }
        }
        Ok(())
    }

    fn vertex_values(&mut self, element: &Element) -> Result<(Option<FileValues>, Option<FileValues>), ReadError> {
        let single = |name: &str| element.property(&[name]).filter(|&at| element.properties[at].count.is_none());
        let all = |names: &[&str]| names.iter().map(|name| single(name)).collect::<Option<Vec<usize>>>();
        let normal = all(&["nx", "ny", "nz"]);
        let colour = COLOURS.iter().find_map(|names| Some((all(&names[..3])?, single(names[3]))));
        let (mut normals, mut colours) = (Vec::new(), Vec::new());
        let mut row = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            self.row(element, &mut row)?;
            normals.extend(normal.as_ref().map(|at| DVec4::new(row[at[0]], row[at[1]], row[at[2]], 0.0)));
            let share = |at: usize| row[at] / element.properties[at].item.largest_colour();
            colours.extend(
                colour
                    .as_ref()
                    .map(|(at, alpha)| DVec4::new(share(at[0]), share(at[1]), share(at[2]), alpha.map_or(1.0, share))),
            );
        }
        Ok((normal.map(|_| FileValues::AtVertices(normals)), colour.map(|_| FileValues::AtVertices(colours))))
    }

    fn faces(&mut self, element: &Element, header_lines: u64) -> Result<(), ReadError> {
        let corners = corner_list(element, header_lines)?;
        let is_list = |&at: &usize| element.properties[at].count.is_some();
        let texture = element.property(&[FACE_TEXTURE]).filter(is_list);
        let mut coordinates = Vec::new();
        for _ in 0..element.count {
            coordinates.clear();
            for (at, property) in element.properties.iter().enumerate() {
                match property.count {
                    Some(count) if at == corners => {
                        let count = self.numbers.count(count, property.item)?;
                        self.corners(count, property)?;
                    }
                    Some(count) if Some(at) == texture => {
                        for _ in 0..self.numbers.count(count, property.item)? {
                            coordinates.push(self.numbers.next(property.item)?);
                        }
                    }
                    _ => self.skip(property)?,
                }
            }
            self.end_face(&coordinates)?;
        }
        Ok(())
    }

    /// Reads triangle strips.
    fn strips(&mut self, element: &Element, header_lines: u64) -> Result<(), ReadError> {
        let corners = corner_list(element, header_lines)?;
        for _ in 0..element.count {
            for (at, property) in element.properties.iter().enumerate() {
                match property.count {
                    Some(count) if at == corners => {
                        let count = self.numbers.count(count, property.item)?;
                        self.strip(count, property)?;
                    }
                    _ => self.skip(property)?,
                }
            }
        }
        Ok(())
    }

    /// Reads a list of strips. A triangle with two equal corners, which joins two strips, is left out.
    fn strip(&mut self, count: usize, property: &Property) -> Result<(), ReadError> {
        let mut strip: Vec<VertexId> = Vec::new();
        for _ in 0..count {
            let Some(vertex) = self.vertex(property, true)? else {
                strip.clear();
                continue;
            };
            strip.push(vertex);
            if let [.., first, second, third] = strip[..]
                && first != second
                && second != third
                && third != first
            {
                // Every other triangle runs the other way around.
                let [first, second] = if strip.len() % 2 == 1 { [first, second] } else { [second, first] };
                self.mesh.corners.extend([first, second, third]);
                self.end_face(&[])?;
            }
        }
        Ok(())
    }

    /// Reads the index of a vertex. `None` for −1, if that may stand for the end of a strip.
    fn vertex(&mut self, property: &Property, may_end: bool) -> Result<Option<VertexId>, ReadError> {
        let place = self.numbers.place();
        let index = self.numbers.integer(property.item)?;
        if may_end && index == -1 {
            return Ok(None);
        }
        let vertex = u32::try_from(index).ok().filter(|&vertex| u64::from(vertex) < self.vertex_count);
        let Some(vertex) = vertex else {
            let place = if matches!(place, FaultPlace::Line(_)) { self.numbers.place() } else { place };
            let count = usize::try_from(self.vertex_count).unwrap_or(usize::MAX);
            return Err(fault_at(place, ParseFaultKind::IndexOutOfRange { element: "vertex", index, count }));
        };
        Ok(Some(VertexId::new(vertex)))
    }

    fn corners(&mut self, count: usize, property: &Property) -> Result<(), ReadError> {
        for _ in 0..count {
            let vertex = self.vertex(property, false)?;
            self.mesh.corners.extend(vertex);
        }
        if count < 3 {
            return Err(fault_at(self.numbers.place(), ParseFaultKind::TooFewCorners(count)));
        }
        Ok(())
    }

    /// Ends a face, with the texture coordinates of its corners.
    fn end_face(&mut self, coordinates: &[f64]) -> Result<(), ReadError> {
        let end = u32::try_from(self.mesh.corners.len()).map_err(|_| ReadError::TooLarge)?;
        let starts = self.mesh.starts.as_mut().expect("it is made with them");
        let begin = starts.last().copied().unwrap_or_default();
        starts.push(end);
        let texture = &mut self.at_corners;
        let first = u32::try_from(texture.coordinates.len()).map_err(|_| ReadError::TooLarge)?;
        if coordinates.len() == 2 * (end - begin) as usize {
            texture.coordinates.extend(coordinates.chunks_exact(2).map(|uv| DVec2::new(uv[0], uv[1])));
            texture.corners.extend(first..first + (end - begin));
        } else {
            texture.corners.extend((begin..end).map(|_| NO_TEXTURE));
        }
        Ok(())
    }

    fn skip(&mut self, property: &Property) -> Result<(), ReadError> {
        let count = match property.count {
            Some(count) => self.numbers.count(count, property.item)?,
            None => 1,
        };
        self.numbers.skip(property.item, count)
    }

    fn skip_all(&mut self, properties: &[Property]) -> Result<(), ReadError> {
        properties.iter().try_for_each(|property| self.skip(property))
    }

    fn finish(mut self) -> Result<MeshFile, ReadError> {
        if self.mesh.corners.is_empty() {
            return Err(ReadError::NoFaces { vertices: self.mesh.positions.len() });
        }
        if (0..self.mesh.face_count()).all(|face| self.mesh.corner_range(face).len() == 3) {
            self.mesh.starts = None;
        }
        let texture = if !self.at_corners.coordinates.is_empty() {
            Some(self.at_corners)
        } else if !self.at_vertices.is_empty() {
            Some(Texture::per_vertex(&self.mesh, &self.at_vertices.into_iter().collect::<Embedding>()))
        } else {
            None
        };
        Ok(MeshFile { polygons: self.mesh, texture, ..MeshFile::default() })
    }
}

/// Property of an element that lists the vertices of a face or strip.
fn corner_list(element: &Element, header_lines: u64) -> Result<usize, ReadError> {
    let is_list = |&at: &usize| element.properties[at].count.is_some() && element.properties[at].item.is_integer();
    element.property(&CORNER_NAMES).filter(is_list).ok_or_else(|| {
        let found = format!("element {}", element.name);
        let kind = ParseFaultKind::Unexpected { found, expected: "its list vertex_indices" };
        fault_at(FaultPlace::Line(header_lines), kind)
    })
}
