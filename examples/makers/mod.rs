//! Makers of meshes and the portrait, for the assets, the tests and the benchmarks.
//!
//! | file | what it makes |
//! |---|---|
//! | `plain.rs` | small meshes with known numbers: grid, tower, fan, tetrahedron, band |
//! | `corpus.rs` | where the corpus lies: meshes of others, beside the project |
//! | `deep.rs` | disks whose inside is far from a small boundary: stacked, tube, hand |
//! | `sheet.rs` | an irregular sheet of any size |
//! | `head.rs` | a closed head of quads |
//! | `quads.rs` | sheets of quads and of hexagons, gentle to rough |
//! | `seamed.rs` | a closed ball with bumps or folds, cut open along long random seams |
//! | `flat.rs`, `caps.rs`, `cube.rs`, `face.rs` | the built-in meshes |
//! | `fill.rs`, `delaunay.rs` | good triangles on a surface, for these |
//! | `sculpt.rs`, `landmarks.rs` | the sculpture of the face, and its landmarks |
//! | `portrait.rs`, `relief.rs`, `paint.rs` | the portrait |
//!
//! No foreign mesh is part of the project. Every mesh is the same at every call.

#![allow(dead_code, unused_imports, reason = "every test and benchmark uses a part of this")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts and cell numbers come from small non-negative floats of our own making"
)]
#![allow(clippy::many_single_char_names, reason = "corners of a triangle are a, b, c and points p, q")]

mod caps;
mod corpus;
mod cube;
mod deep;
mod delaunay;
mod face;
mod fill;
mod flat;
mod head;
mod landmarks;
mod paint;
mod plain;
mod portrait;
mod quads;
mod relief;
mod sculpt;
mod seamed;
mod sheet;

use freebound::examples::Example;
use freebound::mesh::TriMesh;
pub(crate) use freebound::solver::study::Random;

pub(crate) use caps::bumpy_cap_of;
pub(crate) use corpus::corpus;
pub(crate) use deep::{hand, stacked, tube};
pub(crate) use delaunay::{coord, triangulate};
pub(crate) use head::head;
pub(crate) use landmarks::landmarks;
pub(crate) use plain::{band, disk, fan, grid, shaped, sheet, tetrahedron, tower, write_obj};
pub(crate) use portrait::{PORTRAIT_SIZE, picture_from_sculpture, plane, portrait, sculpture_from_plane};
pub(crate) use quads::{honeycomb, quad_sheet};
pub(crate) use seamed::{Relief, seamed_ball};
pub(crate) use sheet::{jittered_sheet, sheet_of_faces};

/// Makes a built-in mesh.
pub(crate) fn example_mesh(example: Example) -> TriMesh {
    match example {
        Example::Face => face::face(),
        Example::Cube => cube::cube(),
        Example::Ell => flat::ell(),
        Example::Dome => caps::dome(),
        Example::BumpyCap => caps::bumpy_cap(),
        Example::Spiral => flat::spiral(),
    }
}
