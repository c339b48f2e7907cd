//! Normals and colours of an OBJ file, for writers of other formats.

use glam::DVec4;

use super::line::{has_few_corners, normal_of_corner, numbers, words};
use super::lines::{Lines, split_mark};
use crate::file_values::{CornerValues, FileValues};

/// Number of words of a vertex with a colour: keyword, position, colour.
const COLOURED: usize = 7;

/// Largest component of colours that count from 0 to 1. Some programs write 0 to 255.
const LARGEST: f64 = 2.0;

/// Normals at corners and colours at vertices; `None` without any. A face may name elements that come later in the file.
pub(crate) fn corner_values(bytes: &[u8]) -> (Option<FileValues>, Option<FileValues>) {
    let (mut normals, mut colours): (Vec<DVec4>, Vec<Option<DVec4>>) = (Vec::new(), Vec::new());
    let mut corners = CornerValues { starts: vec![0], ..CornerValues::default() };
    let mut normal_of: Vec<Option<usize>> = Vec::new();
    let (_, text) = split_mark(bytes);
    let mut joined = Vec::new();
    for line in Lines::of(text) {
        let line = line.as_one(&mut joined);
        let mut rest = words(line);
        match rest.next() {
            Some(b"v") => {
                let is_coloured = words(line).count() >= COLOURED;
                let colour = is_coloured.then(|| numbers::<3>(rest.skip(3)).ok()).flatten();
                colours.push(colour.map(|[r, g, b]| DVec4::new(r, g, b, 1.0)));
            }
            Some(b"vn") => {
                let [x, y, z] = numbers(rest).unwrap_or_default();
                normals.push(DVec4::new(x, y, z, 0.0));
            }
            Some(b"f") if !has_few_corners(rest.clone()) => {
                for word in rest {
                    let (vertex, normal) = normal_of_corner(word).unwrap_or_default();
                    let vertex = place_in_list(vertex, colours.len()).and_then(|vertex| u32::try_from(vertex).ok());
                    corners.vertices.push(vertex.unwrap_or(u32::MAX));
                    normal_of.push(normal.and_then(|normal| place_in_list(normal, normals.len())));
                }
                corners.starts.push(corners.vertices.len());
            }
            _ => {}
        }
    }
    let normal = |place: Option<usize>| normals.get(place?).copied();
    corners.values = normal_of.into_iter().map(normal).collect();
    let has_normals = corners.values.iter().any(Option::is_some);
    (has_normals.then_some(FileValues::AtCorners(corners)), shares(&colours).map(FileValues::AtVertices))
}

/// Colours as shares from 0 to 1; vertices without a colour are white. `None` without any colour.
fn shares(colours: &[Option<DVec4>]) -> Option<Vec<DVec4>> {
    let largest = colours.iter().flatten().map(|colour| colour.truncate().max_element()).reduce(f64::max)?;
    let whole = if largest > LARGEST { 255.0 } else { 1.0 };
    let share = |colour: DVec4| (colour.truncate() / whole).extend(1.0);
    Some(colours.iter().map(|colour| colour.map_or(DVec4::ONE, share)).collect())
}

/// Place in a list that has `count` elements so far, from an index of the file: from 1 on, or negative from the end.
fn place_in_list(index: i64, count: usize) -> Option<usize> {
    let count = i64::try_from(count).ok()?;
    usize::try_from(if index < 0 { count + index } else { index - 1 }).ok()
}
