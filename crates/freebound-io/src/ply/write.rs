//! Writer of PLY files: the file that a mesh was read from with other texture coordinates, or a new one.
//!
//! Texture coordinates are properties of vertices, under the names in the file or as `s` and `t`, or lists of corners,
//! `texcoord`:
//!
//! | | 32 bits | 64 bits |
//! |---|---|---|
//! | type | `float` | `double` |
//! | seams | each vertex on a seam is written once for each of its coordinates | lists of corners |
//! | file with lists | lists of corners | lists of corners |
//!
//! The first form is the one that most programs read. The second keeps the vertices of the mesh. Copies of a vertex
//! follow all others, so that these keep their numbers.
//!
//! Everything else in a file is kept: comments, elements and properties in their order. The properties of a new vertex
//! are interpolated between the ends of its edge; lists are copied from its first end.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec4};

use super::header::{Element, Encoding, Header, Property, Scalar};
use super::numbers::Numbers;
use super::plan::Plan;
use super::row::Row;
use super::{CORNER_NAMES, FACE_TEXTURE};
use crate::Precision;
use crate::corner_data::{CornerData, at_vertices, normals_of_vertices};
use crate::finite::check_finite;
use crate::mesh_file::{MeshFile, NO_TEXTURE, ReadError, Source, SourceFormat, Texture, coordinate_key};
use freebound_core::mesh::{NewVertex, PolygonMesh, VertexId};

/// Writes a mesh with these texture coordinates, or with none if they are empty, as a PLY file. A mesh read from PLY
/// keeps its encoding; others are written as binary.
///
/// # Errors
///
/// If `out` cannot be written, or a texture coordinate is infinite or not a number.
pub fn write_ply(out: &mut impl Write, mesh: &MeshFile, texture: &Texture, precision: Precision) -> io::Result<()> {
    let rounded = |uv: &DVec2| uv.as_vec2().as_dvec2();
    let rounded = (precision == Precision::F32).then(|| Texture {
        coordinates: texture.coordinates.iter().map(rounded).collect(),
        corners: texture.corners.clone(),
    });
    let texture = rounded.as_ref().unwrap_or(texture);
    check_finite(&texture.coordinates)?;
    let of_ply = mesh.source.as_ref().filter(|source| matches!(source.format, SourceFormat::Ply(_)));
    let plain = || plain(mesh).map_err(broken);
    let source = of_ply.map_or_else(|| plain().map(Cow::Owned), |source| Ok(Cow::Borrowed(source)))?;
    let SourceFormat::Ply(header) = &source.format else { return Ok(()) };
    let is_split = precision == Precision::F32 && !Plan::has_lists(header) && !texture.corners.contains(&NO_TEXTURE);
    let split = is_split.then(|| split_at_seams(&mesh.polygons, &source, texture)).flatten();
    match split {
        Some((mesh, source)) => write_carried(out, &mesh, &source, texture, precision),
        None => write_carried(out, &mesh.polygons, &source, texture, precision),
    }
}

/// Mesh with a copy of a vertex for each further coordinate at its corners. `None` if each vertex has only one.
fn split_at_seams(mesh: &PolygonMesh, source: &Source, texture: &Texture) -> Option<(PolygonMesh, Source)> {
    let key = |coordinate: u32| coordinate_key(texture.coordinates[coordinate as usize]);
    let mut first: Vec<Option<[u64; 2]>> = vec![None; mesh.positions.len()];
    let mut copies: BTreeMap<(VertexId, [u64; 2]), VertexId> = BTreeMap::new();
    let mut split = mesh.clone();
    let mut new_vertices = Vec::new();
    for (corner, &coordinate) in split.corners.iter_mut().zip(&texture.corners) {
        let vertex = *corner;
        let key = key(coordinate);
        if *first[vertex.index()].get_or_insert(key) == key {
            continue;
        }
        *corner = *copies.entry((vertex, key)).or_insert_with(|| {
            split.positions.push(mesh.positions[vertex.index()]);
            new_vertices.push(match vertex.index().checked_sub(source.vertex_count) {
                Some(new) => source.new_vertices[new],
                None => NewVertex { edge: [vertex; 2], at: 0.0 },
            });
            VertexId::from_index(split.positions.len() - 1)
        });
    }
    (!copies.is_empty()).then(|| (split, source.with_vertices(&new_vertices)))
}

/// File with positions and faces, and the normals and colours of the file that the mesh was read from. Normals are left
/// out if a vertex has several.
fn plain(file: &MeshFile) -> Result<Source, ReadError> {
    let mesh = &file.polygons;
    let data = CornerData::of(file);
    let normals = data.normals.and_then(|normals| normals_of_vertices(mesh, &normals));
    let colours = data.colours.map(|colours| at_vertices(mesh, &colours, DVec4::ONE));
    let most = (0..mesh.face_count()).map(|face| mesh.corner_range(face).len()).max().unwrap_or(0);
    let count = if u8::try_from(most).is_ok() { Scalar::U8 } else { Scalar::I32 };
    let properties = |kind: &str, names: &[&str]| {
        let lines: Vec<String> = names.iter().map(|name| format!("property {kind} {name}\n")).collect();
        lines.concat()
    };
    let head = [
        format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len()),
        properties("double", &["x", "y", "z"]),
        normals.as_ref().map(|_| properties("float", &["nx", "ny", "nz"])).unwrap_or_default(),
        colours.as_ref().map(|_| properties("uchar", &["red", "green", "blue", "alpha"])).unwrap_or_default(),
        format!("element face {}\n", mesh.face_count()),
        format!("property list {} uint {}\nend_header\n", count.name(), CORNER_NAMES[0]),
    ];
    let mut row = Row::of(Encoding::LittleEndian);
    row.bytes = head.concat().into_bytes();
    for (vertex, position) in mesh.positions.iter().enumerate() {
        for x in position.to_array() {
            row.number(Scalar::F64, x);
        }
        if let Some(normals) = &normals {
            for x in normals[vertex].to_array() {
                row.number(Scalar::F32, x);
            }
        }
        if let Some(colours) = &colours {
            for share in colours[vertex].clamp(DVec4::ZERO, DVec4::ONE).to_array() {
                row.number(Scalar::U8, (255.0 * share).round());
            }
        }
    }
    for face in 0..mesh.face_count() {
        row.indices([count, Scalar::U32], mesh.face(face));
    }
    let header = Header::of(&row.bytes)?;
    Ok(Source::of(SourceFormat::Ply(Arc::new(header)), row.bytes, mesh.positions.len()))
}

fn write_carried(
    out: &mut impl Write,
    mesh: &PolygonMesh,
    source: &Source,
    texture: &Texture,
    precision: Precision,
) -> io::Result<()> {
    let SourceFormat::Ply(header) = &source.format else { return Ok(()) };
    let plan = Plan::of(header, mesh, texture, precision);
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
                } else if let Some(original) = ends.get(&new.edge[0]).filter(|_| new.edge[0] == new.edge[1]) {
                    self.row.raw(&self.source.bytes[original[at].clone()]);
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
            self.row.number(self.plan.scalar, if name == self.plan.names[0] { u } else { v });
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
                self.row.number(self.plan.scalar, x);
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
            for x in self.texture.coordinates[corner as usize].to_array() {
                self.row.number(self.plan.scalar, x);
            }
        }
    }
}
