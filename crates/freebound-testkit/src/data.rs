//! Meshes and constraints of `tests/data`, generated for tests that need files or realistic disks without the corpus.
//!
//! `cargo run -p freebound-testkit --example data` writes the files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use freebound_core::mesh::{PolygonMesh, TriMesh};
use freebound_io::{MeshFile, Texture, write_obj};
use glam::DVec3;

use crate::manifest::Entry;
use crate::surfaces::irregular_cube;
use crate::{Random, Relief, bumpy_cap_of, honeycomb, many_parts, quad_sheet, seamed_ball, shaped, tube};

/// Names of the meshes that are disks.
const DISKS: [&str; 7] = ["honeycomb", "open-cube", "quads", "seamed-ball", "small-cap", "spring", "tube"];

/// Constraint files: mesh, number of constraints, and number of the first constrained vertex.
const CONSTRAINTS: [(&str, u32, u32); 3] = [("small-cap", 4, 11), ("open-cube", 6, 5), ("quads", 8, 0)];

/// Folder of the files.
pub fn data_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data")
}

/// Meshes of `tests/data` that are disks, in the order of their names.
pub fn data_disks() -> Vec<Entry> {
    DISKS.iter().map(|name| data_entry(name)).collect()
}

/// Meshes of `tests/data` that are disks of triangles: theorems about triangulations do not cover polygons.
pub fn data_triangle_disks() -> Vec<Entry> {
    data_disks().into_iter().filter(|entry| entry.mesh().polygon_of.is_none()).collect()
}

/// Mesh of `tests/data` by its name, such as `small-cap`.
pub fn data_entry(name: &str) -> Entry {
    Entry::in_folder(&data_folder(), &format!("{name}.obj"))
}

/// Names and contents of all files.
pub fn data_files() -> Vec<(String, Vec<u8>)> {
    let meshes = DISKS.into_iter().chain(["parts"]).map(|name| (format!("{name}.obj"), obj(mesh(name))));
    let constraints = CONSTRAINTS.map(|(name, count, first)| {
        let text = constraints(mesh(name).positions.len(), count, first);
        (format!("{name}_k{count}.txt"), text.into_bytes())
    });
    meshes.chain(constraints).collect()
}

fn obj(polygons: PolygonMesh) -> Vec<u8> {
    let mut text = Vec::new();
    write_obj(&mut text, &MeshFile { polygons, ..MeshFile::default() }, &Texture::default()).expect("memory takes it");
    text
}

fn mesh(name: &str) -> PolygonMesh {
    match name {
        "small-cap" => (&bumpy_cap_of(300, 5)).into(),
        "honeycomb" => honeycomb(10, 8, 0.05, &mut Random(3)),
        "open-cube" => irregular_cube(6, &mut Random(7)).mesh().into(),
        "parts" => many_parts::interleaved(&many_parts::surfaces(&mut Random(9)), &mut Random(10)),
        "quads" => quad_sheet(15, 12, 0.15, &mut Random(4)),
        "seamed-ball" => (&seamed_ball(7, 50, Relief::Bumps, 6)).into(),
        "spring" => (&spring()).into(),
        "tube" => (&tube(12, 14)).into(),
        _ => unreachable!("{name} is not a mesh of tests/data"),
    }
}

/// Strip that is rolled up like a clock spring, three turns.
fn spring() -> TriMesh {
    let columns = 80;
    shaped(columns, 4, |x, y| {
        let turn = 3.0 * std::f64::consts::TAU * x / f64::from(columns);
        let radius = 1.0 + 0.12 * turn;
        DVec3::new(radius * turn.cos(), radius * turn.sin(), 0.3 * y)
    })
}

/// Constraints for vertices at even distances in the file, at random positions of the unit square.
fn constraints(vertices: usize, count: u32, first: u32) -> String {
    let mut random = Random(u64::from(count));
    let mut text = "# vertex u v; vertices count from 0\n".to_owned();
    let mut place = || (random.between(0.05, 0.95) * 100.0).round() / 100.0;
    for k in 0..count {
        let vertex = first as usize + k as usize * (vertices - first as usize) / count as usize;
        writeln!(text, "{vertex} {:?} {:?}", place(), place()).expect("memory takes it");
    }
    text
}
