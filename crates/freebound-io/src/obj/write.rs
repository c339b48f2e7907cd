//! Writer of OBJ files that read back bit for bit.

use std::collections::HashMap;
use std::io::{self, Write};

use glam::{DVec3, DVec4};

use super::carried::{Edits, Written, write_carried};
use super::digits::{push_index, write_numbers};
use crate::corner_data::{CornerData, at_vertices};
use crate::finite::check_finite;
use crate::mesh_file::{MeshFile, NO_TEXTURE, SourceFormat, Texture};
use freebound_core::mesh::VertexId;

/// Writes a mesh with these texture coordinates, or with none if they are empty.
///
/// A mesh that was read from OBJ text is written as that text, byte for byte. Only its texture coordinates, the
/// corners' indices into them, and split faces change. Any other mesh is written with its vertices, polygons and
/// statements in order. Numbers have the fewest digits that read back exactly. A face with a [`NO_TEXTURE`] corner is
/// written without texture coordinates.
///
/// # Errors
///
/// If `out` cannot be written, or a texture coordinate is infinite or not a number.
///
/// # Panics
///
/// If the number of texture corners is neither 0 nor that of the mesh's corners, or one names a missing coordinate.
pub fn write_obj(out: &mut impl Write, mesh: &MeshFile, texture: &Texture) -> io::Result<()> {
    write_obj_with(out, mesh, &Edits::default(), texture)
}

/// Writes a mesh like [`write_obj`], with changes to the mesh's statements.
pub(crate) fn write_obj_with(
    out: &mut impl Write,
    mesh: &MeshFile,
    edits: &Edits,
    texture: &Texture,
) -> io::Result<()> {
    let (corners, coordinates) = (&texture.corners, texture.coordinates.len());
    assert!(corners.is_empty() || corners.len() == mesh.polygons.corners.len(), "one index per corner");
    assert!(corners.iter().all(|&at| at == NO_TEXTURE || (at as usize) < coordinates), "coordinates that there are");
    check_finite(&texture.coordinates)?;
    match &mesh.source {
        Some(source) if source.format == SourceFormat::Obj => {
            write_carried(out, mesh, source, Written { edits, texture })
        }
        _ => write_new(out, mesh, edits, texture),
    }
}

/// Writes a mesh that was not read from OBJ text.
fn write_new(out: &mut impl Write, mesh: &MeshFile, edits: &Edits, texture: &Texture) -> io::Result<()> {
    let polygons = &mesh.polygons;
    let data = CornerData::of(mesh);
    let colours = data.colours.map(|colours| at_vertices(polygons, &colours, DVec4::ONE));
    write_lines(out, &edits.first)?;
    for (vertex, position) in polygons.positions.iter().enumerate() {
        let colour = colours.as_ref().map(|colours| colours[vertex].truncate().to_array());
        let numbers: Vec<f64> = position.to_array().into_iter().chain(colour.into_iter().flatten()).collect();
        write_numbers(out, b"v", &numbers)?;
        out.write_all(b"\n")?;
    }
    for coordinate in &texture.coordinates {
        write_numbers(out, b"vt", &coordinate.to_array())?;
        out.write_all(b"\n")?;
    }
    let (normals, normal_of) = data.normals.map(numbered).unzip();
    for normal in normals.iter().flatten() {
        write_numbers(out, b"vn", normal)?;
        out.write_all(b"\n")?;
    }
    let mut line = Vec::new();
    let mut statements = mesh.statements.iter().enumerate().peekable();
    for face in 0..polygons.face_count() {
        while let Some((place, statement)) = statements.next_if(|(_, next)| next.before_face as usize <= face) {
            write_lines(out, edits.statements.get(&place).unwrap_or(&vec![statement.text.clone()]))?;
        }
        if face == 0 {
            write_lines(out, &edits.before_faces)?;
        }
        let range = polygons.corner_range(face);
        let begin = range.start;
        let coordinates = texture.corners.get(range).filter(|of_face| !of_face.contains(&NO_TEXTURE));
        line.clear();
        line.push(b'f');
        for (place, vertex) in polygons.face(face).iter().enumerate() {
            line.push(b' ');
            push_index(&mut line, u64::from(vertex.number()) + 1);
            if let Some(coordinates) = coordinates {
                line.push(b'/');
                push_index(&mut line, u64::from(coordinates[place]) + 1);
            }
            if let Some(numbers) = &normal_of {
                line.extend_from_slice(if coordinates.is_some() { b"/" } else { b"//" });
                push_index(&mut line, u64::from(numbers[begin + place]) + 1);
            }
        }
        line.push(b'\n');
        out.write_all(&line)?;
    }
    for (place, statement) in statements {
        write_lines(out, edits.statements.get(&place).unwrap_or(&vec![statement.text.clone()]))?;
    }
    Ok(())
}

/// Distinct normals in 32 bits, in the order of their first corners, and the number of the normal at each corner.
fn numbered(at_corners: Vec<DVec3>) -> (Vec<[f64; 3]>, Vec<u32>) {
    let mut number_of: HashMap<[u32; 3], u32> = HashMap::new();
    let mut normals = Vec::new();
    let number = |normal: DVec3| {
        let normal = normal.as_vec3();
        *number_of.entry(normal.to_array().map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
            normals.push(normal.as_dvec3().to_array());
            VertexId::from_index(normals.len() - 1).number()
        })
    };
    let numbers = at_corners.into_iter().map(number).collect();
    (normals, numbers)
}

fn write_lines<'a>(out: &mut impl Write, lines: impl IntoIterator<Item = &'a Vec<u8>>) -> io::Result<()> {
    for line in lines {
        out.write_all(line)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}
