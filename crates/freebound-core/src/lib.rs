//! Flattens triangle meshes into the plane and proves every result.
//!
//! The mathematics is due to Karni, Gotsman and Gortler, "Free-Boundary Linear Parameterization of 3D Meshes in the
//! Presence of Constraints" (2005), called *the paper* in these pages.
//!
//! # Entry points
//!
//! | call | purpose |
//! |---|---|
//! | [`flatten()`] | flattens a disk and proves the map |
//! | [`unwrap()`] | computes proved texture coordinates of any mesh |
//! | [`Flattener`] | runs a method step by step, to watch, pause or cancel it |
//! | [`verify()`] | proves a given layout |
//!
//! ```
//! use freebound_core::mesh::{DiskMesh, TriMesh};
//! use freebound_core::{Options, flatten};
//!
//! // A square pyramid without its base.
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.7]];
//! let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
//! let mesh = DiskMesh::try_from(TriMesh::from_arrays(&positions, &triangles)).expect("a disk");
//! let step = flatten(&mesh, &Options::default().pinned(0, [0.0, 0.0]).pinned(2, [1.0, 1.0])).expect("auto ends planar");
//! assert!(step.verdict.planar);
//! ```

pub mod bijective;
pub mod cutting;
pub mod flatten;
pub mod geom;
pub mod linalg;
pub mod linear;
pub mod mesh;
pub mod nonlinear;
mod parallel;
pub mod pipeline;
pub mod problem;
pub mod verify;
pub mod weights;

pub use flatten::{FlattenError, Flattener, Options, flatten};
pub use pipeline::{PipelineOptions, UnwrapError, Unwrapped, unwrap, verify};

/// Examples of the book, compiled as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../../book/src/rust.md")]
struct Book;
