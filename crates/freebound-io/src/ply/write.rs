//! Writer of PLY files: the file that a mesh was read from with other texture coordinates, or a new one.
//!
//! Texture coordinates are 64-bit numbers, so that the file holds exactly the map that was proved. They are
//! properties of vertices if each vertex has only one: under the names in the file, or as `s` and `t`. If seams
//! divide a vertex, or the file has such lists, they are lists of corners, `texcoord`. Everything else in a file is
//! kept: comments, elements and properties in their order. The properties of a new vertex are interpolated between
//! the ends of its edge; lists are copied from its first end.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::ops::Range;
use std::sync::Arc;

use super::header::{Element, Encoding, Header, Property, Scalar};
use super::numbers::Numbers;
use super::plan::Plan;
use super::row::Row;
use super::{CORNER_NAMES, FACE_TEXTURE};
use crate::finite::check_finite;
use crate::mesh_file::{MeshFile, NO_TEXTURE, ReadError, Source, SourceFormat, Texture};
use freebound_core::mesh::{PolygonMesh, VertexId};

/// Writes a mesh with these texture coordinates, or with none if they are empty, as a PLY file. A mesh read from PLY
/// keeps its encoding; others are written as binary.
///
/// # Errors
///
/// If `out` cannot be written, or a texture coordinate is infinite or not a number.
pub fn write_ply(out: &mut impl Write, mesh: &MeshFile, texture: &Texture) -> io::Result<()> {
    check_finite(&texture.coordinates)?;
    let of_ply = mesh.source.as_ref().filter(|source| matches!(source.format, SourceFormat::Ply(_)));
    match of_ply {
        Some(source) => write_carried(out, &mesh.polygons, source, texture),
        None => write_carried(out, &mesh.polygons, &plain(&mesh.polygons).map_err(broken)?, texture),
    }
}

/// File with positions and faces only.
fn plain(mesh: &PolygonMesh) -> Result<Source, ReadError> {
    let most = (0..mesh.face_count()).map(|face| mesh.corner_range(face).len()).max().unwrap_or(0);
    let count = if u8::try_from(most).is_ok() { Scalar::U8 } else { Scalar::I32 };
    let head = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nelement face {}\nproperty list {} uint {}\nend_header\n",
        mesh.positions.len(),
        mesh.face_count(),
        count.name(),
        CORNER_NAMES[0]
    );
    let mut row = Row::of(Encoding::LittleEndian);
    row.bytes = head.into_bytes();
    for position in &mesh.positions {
        position.to_array().iter().for_each(|&x| row.number(Scalar::F64, x));
    }
    for face in 0..mesh.face_count() {
        row.indices([count, Scalar::U32], mesh.face(face));
    }
    let header = Header::of(&row.bytes)?;
    Ok(Source::of(SourceFormat::Ply(Arc::new(header)), row.bytes, mesh.positions.len()))
}

fn write_carried(out: &mut impl Write, mesh: &PolygonMesh, source: &Source, texture: &Texture) -> io::Result<()> {
    let SourceFormat::Ply(header) = &source.format else { return Ok(()) };
    let plan = Plan::of(header, mesh, texture);
    plan.write_header(out, &source.bytes[..header.length], [mesh.positions.len(), mesh.face_count()])?;
    let numbers = Numbers::of(&source.bytes, header);
    let mut writer =
        Writer { out, mesh, source, texture, plan, numbers, row: Row::of(header.encoding), spans: Vec::new() };
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => writer.vertices(element)?,
            "face" => writer.faces(element)?,
            _ if element.properties.is_empty() => {}
            _ => {
                for _ in 0..element.count {
                    writer.scan(element)?;
                    (0..element.properties.len()).for_each(|at| writer.copy(at));
                    writer.row.end(writer.out)?;
                }
            }
        }
    }
    Ok(())
}

/// Error for a file that cannot be parsed, although it was parsed before.
fn broken(error: ReadError) -> io::Error {
    io::Error::other(error)
}

struct Writer<'a, W> {
    out: &'a mut W,
    mesh: &'a PolygonMesh,
    source: &'a Source,
    texture: &'a Texture,
    plan: Plan,
    numbers: Numbers<'a>,
    row: Row,
    /// Byte ranges of the properties of the current item in the file.
    spans: Vec<Range<usize>>,
}

impl<W: Write> Writer<'_, W> {
    fn scan(&mut self, element: &Element) -> io::Result<()> {
        self.spans.clear();
        for property in &element.properties {
            self.spans.push(self.numbers.span(property).map_err(broken)?);
        }
        Ok(())
    }

    fn copy(&mut self, at: usize) {
        self.row.raw(&self.source.bytes[self.spans[at].clone()]);
    }

    fn vertices(&mut self, element: &Element) -> io::Result<()> {
        let are_ends: BTreeSet<VertexId> = self.source.new_vertices.iter().flat_map(|new| new.edge).collect();
        let mut ends: BTreeMap<VertexId, Vec<Range<usize>>> = BTreeMap::new();
        for vertex in (0..self.source.vertex_count).map(VertexId::from_index) {
            self.scan(element)?;
            for (at, property) in element.properties.iter().enumerate() {
                if self.plan.is_texture(&property.name) {
                    self.own_texture(vertex, &property.name);
                } else {
                    self.copy(at);
                }
            }
            self.end_vertex(vertex)?;
            if are_ends.contains(&vertex) {
                ends.insert(vertex, self.spans.clone());
            }
        }
        for (number, new) in (self.source.vertex_count..).zip(&self.source.new_vertices) {
            let vertex = VertexId::from_index(number);
            for (at, property) in element.properties.iter().enumerate() {
                if self.plan.is_texture(&property.name) {
                    self.own_texture(vertex, &property.name);
                } else if let Some(axis) = ["x", "y", "z"].iter().position(|name| *name == property.name) {
                    self.row.number(property.item, self.mesh.positions[vertex.index()][axis]);
                } else {
                    let spans = new.edge.map(|end| ends.get(&end).map(|spans| spans[at].clone()));
                    self.between(property, spans, new.at)?;
                }
            }
            self.end_vertex(vertex)?;
        }
        Ok(())
    }

    /// Property of a new vertex: the value at `share` between the ends of its edge, whose values are at `spans`.
    fn between(&mut self, property: &Property, spans: [Option<Range<usize>>; 2], share: f64) -> io::Result<()> {
        let [Some(a), Some(b)] = spans else {
            self.row.number(property.count.unwrap_or(property.item), 0.0);
            return Ok(());
        };
        if property.count.is_some() {
            self.row.raw(&self.source.bytes[a]);
            return Ok(());
        }
        let value = |span: Range<usize>| self.numbers.at(&self.source.bytes[span], property.item).map_err(broken);
        let (a, b) = (value(a)?, value(b)?);
        let between = a + share * (b - a);
        self.row.number(property.item, if property.item.is_integer() { between.round() } else { between });
        Ok(())
    }

    /// Texture coordinate under the file's own name.
    fn own_texture(&mut self, vertex: VertexId, name: &str) {
        let [u, v] = self.coordinate(vertex);
        if self.plan.at_vertices.is_some() {
            self.row.number(Scalar::F64, if name == self.plan.names[0] { u } else { v });
        }
    }

    fn coordinate(&self, vertex: VertexId) -> [f64; 2] {
        let index = self.plan.at_vertices.as_ref().map_or(NO_TEXTURE, |all| all[vertex.index()]);
        self.texture.coordinates.get(index as usize).copied().unwrap_or_default().to_array()
    }

    fn end_vertex(&mut self, vertex: VertexId) -> io::Result<()> {
        if self.plan.at_vertices.is_some() && !self.plan.has_names {
            let coordinate = self.coordinate(vertex);
            for x in coordinate {
                self.row.number(Scalar::F64, x);
            }
        }
        self.row.end(self.out)
    }

    fn faces(&mut self, element: &Element) -> io::Result<()> {
        let mut own = 0;
        for number in 0..element.count {
            self.scan(element)?;
            while own < self.mesh.face_count() && u64::from(self.source.face_of(own)) == number {
                self.face(element, own)?;
                own += 1;
            }
        }
        Ok(())
    }

    fn face(&mut self, element: &Element, face: usize) -> io::Result<()> {
        let corners = self.mesh.face(face);
        for (at, property) in element.properties.iter().enumerate() {
            match property.count {
                Some(count) if CORNER_NAMES.contains(&property.name.as_str()) => {
                    self.row.indices([count, self.plan.index], corners);
                }
                Some(_) if property.name == FACE_TEXTURE => self.corner_texture(face),
                _ => self.copy(at),
            }
        }
        if !self.plan.has_lists {
            self.corner_texture(face);
        }
        self.row.end(self.out)
    }

    /// Texture coordinates of a face's corners; an empty list if a corner has none.
    fn corner_texture(&mut self, face: usize) {
        let Some(count) = self.plan.at_corners else { return };
        let corners = &self.texture.corners[self.mesh.corner_range(face)];
        let corners = if corners.contains(&NO_TEXTURE) { &[] } else { corners };
        self.row.number(count, 2.0 * corners.len() as f64);
        for &corner in corners {
            self.texture.coordinates[corner as usize].to_array().iter().for_each(|&x| self.row.number(Scalar::F64, x));
        }
    }
}
