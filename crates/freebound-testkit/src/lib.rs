//! Generators of meshes and of the portrait, for the assets, the tests and the benchmarks.
//!
//! | file | contents |
//! |---|---|
//! | `plain.rs` | small meshes with known numbers: grid, tower, fan, tetrahedron, band |
//! | `corpus.rs`, `manifest.rs` | the corpus of third-party meshes, beside the project; tests over it |
//! | `data.rs` | the files of `tests/data`: eight meshes and three sets of constraints |
//! | `deep.rs` | disks whose inside is far from a small boundary: stacked, tube, hand |
//! | `message.rs` | the snapshot of all messages |
//! | `sheet.rs` | an irregular sheet of any size |
//! | `head.rs` | a closed head of quads |
//! | `quads.rs` | sheets of quads and of hexagons, gentle to rough |
//! | `seamed.rs` | a closed ball with bumps or folds, cut open along long random seams |
//! | `flat.rs`, `caps.rs`, `cube.rs`, `face.rs` | the built-in meshes |
//! | `fill.rs`, `delaunay.rs` | good triangles on a surface, for the built-in meshes |
//! | `sculpt.rs`, `landmarks.rs` | the sculpture of the face, and its landmarks |
//! | `portrait.rs`, `relief.rs`, `paint.rs` | the portrait |
//!
//! No third-party mesh is part of the project. Every mesh is identical at every call.

#![allow(missing_docs, reason = "helpers of tests: a name says enough if there is no comment")]
#![allow(
    clippy::unwrap_used,
    clippy::missing_panics_doc,
    clippy::missing_errors_doc,
    reason = "a helper that fails fails its test"
)]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts and cell numbers come from small non-negative floats of our own making"
)]
#![allow(clippy::many_single_char_names, reason = "corners of a triangle are a, b, c and points p, q")]

mod caps;
mod corpus;
mod cube;
pub mod cubes;
mod data;
mod deep;
mod delaunay;
mod face;
pub mod files;
mod fill;
mod flat;
pub mod glb;
mod head;
pub mod judge;
mod landmarks;
mod manifest;
pub mod many_parts;
mod message;
pub mod mutation;
pub mod oracle;
mod paint;
mod plain;
pub mod ply;
mod portrait;
mod practice;
mod quads;
mod relief;
mod sculpt;
mod seamed;
mod sheet;
pub mod solids;
pub mod surfaces;

pub use freebound_core::geom::Random;
use freebound_core::mesh::TriMesh;

pub use caps::bumpy_cap_of;
pub use corpus::corpus;
pub use data::{data_disks, data_entry, data_files, data_folder, data_triangle_disks};
pub use deep::{hand, stacked, tube};
pub use delaunay::{coord, triangulate};
pub use head::head;
pub use landmarks::{PlacedLandmark, landmarks};
pub use manifest::{Entry, corpus_disks, corpus_entry, csv_rows, manifest, steps};
pub use message::assert_message;
pub use plain::{band, disk, fan, grid, rolled_strip, shaped, sheet, tetrahedron, tower, write_obj};
pub use portrait::{PORTRAIT_SIZE, picture_from_sculpture, plane, portrait, sculpture_from_plane};
pub use practice::{bumpy_ball, scan, table};
pub use quads::{honeycomb, quad_sheet};
pub use seamed::{Relief, seamed_ball};
pub use sheet::{jittered_sheet, sheet_of_faces};

/// Built-in mesh of the program, generated from its recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BuiltIn {
    /// A mask of a human face.
    Face,
    /// A cube without its bottom.
    Cube,
    /// A flat L.
    Ell,
    /// A cap that ends before the equator.
    Dome,
    /// A bumpy ball that is open at the bottom.
    BumpyCap,
    /// A flat spiral strip.
    Spiral,
}

impl BuiltIn {
    /// All built-in meshes, in the order of the program's menu.
    pub const ALL: [Self; 6] = [Self::Face, Self::Cube, Self::Ell, Self::Dome, Self::BumpyCap, Self::Spiral];

    /// Name in the program.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Cube => "cube",
            Self::Ell => "ell",
            Self::Dome => "dome",
            Self::BumpyCap => "bumpy-cap",
            Self::Spiral => "spiral",
        }
    }

    /// Landmarks of the mesh. Empty except for the face.
    pub fn landmarks(self) -> Vec<PlacedLandmark> {
        if self == Self::Face { landmarks() } else { Vec::new() }
    }

    /// Generates the mesh, at every call.
    pub fn mesh(self) -> TriMesh {
        match self {
            Self::Face => face::face(),
            Self::Cube => cube::cube(),
            Self::Ell => flat::ell(),
            Self::Dome => caps::dome(),
            Self::BumpyCap => caps::bumpy_cap(),
            Self::Spiral => flat::spiral(),
        }
    }
}
