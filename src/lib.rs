//! Flattens 3D triangle meshes into the plane, and proves, shows and repairs what happens on the way.
//!
//! The mathematics is that of Karni, Gotsman and Gortler, "Free-Boundary Linear Parameterization of
//! 3D Meshes in the Presence of Constraints" (2005), called *the paper* in these pages.
//!
//! The easy call reads a mesh, flattens it, and gives a proved result or the reason why there is none:
//!
//! ```
//! use freebound::mesh::DiskMesh;
//! use freebound::{Options, examples::Example, flatten};
//!
//! let mesh = DiskMesh::try_from(Example::Dome.mesh()).expect("a disk");
//! let step = flatten(&mesh, &Options::default()).expect("method auto always ends planar");
//! assert!(step.verdict.planar && step.verdict.holds_in_f32);
//! println!("vertex 0 lies at {}", step.solution.embedding[0]);
//! ```
//!
//! Layers, each importing only from those above it:
//!
//! ```text
//! geom   mesh         the plane · connectivity and 3D positions
//!    \   /
//!   linalg            sparse LLT and LU
//!      |
//!    solver           the paper: weights, systems, methods, verdict, distortion
//!      |   \
//!      |    io        files in and out
//!      |   /  \
//!      |  |  examples built-in meshes
//!      |  |  /
//!    session          one open document: commands, undo, background job
//!      |
//!     view            pure maths between document and pixels
//!  ____|____          feature "gui" below this line
//!  render  |          wgpu pipelines and buffers
//!       \  |
//!        ui           egui panels
//!        |
//!       app · cli     the window · the command line
//! ```

#[cfg(feature = "gui")]
pub mod app;
pub mod cli;
pub mod examples;
pub mod geom;
pub mod io;
pub mod linalg;
pub mod mesh;
#[cfg(feature = "gui")]
pub mod render;
pub mod session;
pub mod solver;
#[cfg(feature = "gui")]
pub mod ui;
pub mod view;

pub use solver::{FlattenError, Options, flatten};
