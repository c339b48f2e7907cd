//! Writes OBJ files that read back bit for bit.

use std::io::{self, Write};

use super::{ObjMesh, Statement};
use crate::io::door::check_finite;
use crate::solver::Embedding;

/// Writes a mesh with one texture coordinate per vertex, or with none if `texture` is empty.
///
/// Vertices, polygons and statements keep their order; numbers have the fewest digits that read back as the same number.
///
/// # Errors
///
/// What `out` says, and texture coordinates that are infinite or not numbers.
///
/// # Panics
///
/// If `texture` is neither empty nor as long as the list of vertices.
pub fn write_obj(out: &mut impl Write, mesh: &ObjMesh, texture: &Embedding) -> io::Result<()> {
    write_obj_with(out, mesh, &mesh.statements, texture)
}

/// As [`write_obj`], with other statements than the mesh's own.
pub(in crate::io) fn write_obj_with(
    out: &mut impl Write,
    mesh: &ObjMesh,
    statements: &[Statement],
    texture: &Embedding,
) -> io::Result<()> {
    let polygons = &mesh.polygons;
    assert!(texture.is_empty() || texture.len() == polygons.positions.len(), "one texture coordinate per vertex");
    check_finite(texture)?;
    for position in &polygons.positions {
        write_numbers(out, b"v", &position.to_array())?;
    }
    for coordinate in texture {
        write_numbers(out, b"vt", &coordinate.to_array())?;
    }
    let mut line = Vec::new();
    let mut statements = statements.iter().peekable();
    for face in 0..polygons.face_count() {
        while let Some(statement) = statements.next_if(|statement| statement.before_face as usize <= face) {
            out.write_all(&statement.text)?;
            out.write_all(b"\n")?;
        }
        line.clear();
        line.push(b'f');
        for vertex in polygons.face(face) {
            line.push(b' ');
            push_index(&mut line, u64::from(vertex.number()) + 1);
            if !texture.is_empty() {
                line.push(b'/');
                push_index(&mut line, u64::from(vertex.number()) + 1);
            }
        }
        line.push(b'\n');
        out.write_all(&line)?;
    }
    for statement in statements {
        out.write_all(&statement.text)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn write_numbers(out: &mut impl Write, keyword: &[u8], numbers: &[f64]) -> io::Result<()> {
    out.write_all(keyword)?;
    for &number in numbers {
        write!(out, " {number:?}")?;
    }
    out.write_all(b"\n")
}

/// Appends decimal digits: several times faster than `write!`, and most of a file is indices.
fn push_index(line: &mut Vec<u8>, index: u64) {
    let begin = line.len();
    let mut rest = index;
    loop {
        line.push(b'0' + u8::try_from(rest % 10).expect("a digit"));
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    line[begin..].reverse();
}
