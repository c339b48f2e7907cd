//! Normals and colours of an OBJ file, for writers of other formats.

use glam::DVec4;

use super::line::{has_few_corners, normal_of_corner, numbers, words};
use super::lines::{Lines, split_mark};
use crate::file_values::{CornerValues, FileValues};

/// Number of words of a vertex with a colour: keyword, position, colour.
const COLOURED: usize = 7;

/// Largest component of a colour that counts from 0 to 1. Some programs write 0 to 255.
const LARGEST: f64 = 1.0;

/// Normals at corners and colours at vertices; `None` without any.
pub(crate) fn corner_values(bytes: &[u8]) -> (Option<FileValues>, Option<FileValues>) {
    let (mut normals, mut colours): (Vec<DVec4>, Vec<DVec4>) = (Vec::new(), Vec::new());
    let mut corners = CornerValues { starts: vec![0], ..CornerValues::default() };
    let (mut vertex_count, mut has_colours) = (0_usize, false);
    let (_, text) = split_mark(bytes);
    let mut joined = Vec::new();
    for line in Lines::of(text) {
        let line = line.as_one(&mut joined);
        let mut rest = words(line);
        match rest.next() {
            Some(b"v") => {
                vertex_count += 1;
                let is_coloured = words(line).count() >= COLOURED;
                has_colours |= is_coloured;
                let colour = is_coloured.then(|| numbers::<3>(rest.skip(3)).ok()).flatten();
                colours.push(colour.map_or(DVec4::ONE, |[r, g, b]| DVec4::new(r, g, b, 1.0)));
            }
            Some(b"vn") => {
                let [x, y, z] = numbers(rest).unwrap_or_default();
                normals.push(DVec4::new(x, y, z, 0.0));
            }
            Some(b"f") if !has_few_corners(rest.clone()) => {
                for word in rest {
                    let (vertex, normal) = normal_of_corner(word).unwrap_or_default();
                    let vertex = in_list(vertex, vertex_count).and_then(|vertex| u32::try_from(vertex).ok());
                    corners.vertices.push(vertex.unwrap_or(u32::MAX));
                    let normal = normal.and_then(|normal| in_list(normal, normals.len()));
                    corners.values.push(normal.map(|normal| normals[normal]));
                }
                corners.starts.push(corners.vertices.len());
            }
            _ => {}
        }
    }
    let largest = colours.iter().map(|colour| colour.truncate().max_element()).fold(0.0, f64::max);
    if largest > LARGEST {
        for colour in &mut colours {
            *colour = (colour.truncate() / 255.0).extend(1.0);
        }
    }
    let has_normals = corners.values.iter().any(Option::is_some);
    (has_normals.then_some(FileValues::AtCorners(corners)), has_colours.then_some(FileValues::AtVertices(colours)))
}

/// Place in a list of `count` elements so far, from an index of the file: from 1 on, or negative from the end.
fn in_list(index: i64, count: usize) -> Option<usize> {
    let count = i64::try_from(count).ok()?;
    let place = if index < 0 { count + index } else { index - 1 };
    usize::try_from(place).ok().filter(|_| place < count)
}
