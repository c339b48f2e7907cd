//! Runs of Freebound: from a mesh in memory or in a file to a proved layout with its report.
//!
//! The command line, the window and the Python package share this crate. It knows no screen and no arguments.
//!
//! | file            | contents                                                              |
//! |-----------------|-----------------------------------------------------------------------|
//! | `model`         | a mesh with its preparation                                           |
//! | `choices`       | choices by name: kinds of seams, and parts of a mesh                  |
//! | `automatic_cut` | cutting of a mesh along automatic seams                               |
//! | `chart_targets` | pins of a mesh with several charts                                    |
//! | `seam_edges`    | edges of a mesh that seams usually follow                             |
//! | `run`           | all charts of a mesh from their problems to a finished output         |
//! | `idle`          | options that do not apply to a method                                 |
//! | `request`       | the entry point: everything that a run needs, and its [`MeshLayout`]      |
//! | `layout`        | a finished run as arrays                                              |
//!
//! ```
//! use std::sync::Arc;
//!
//! use freebound_core::mesh::PolygonMesh;
//! use freebound_run::{Model, RunRequest};
//!
//! // A closed tetrahedron.
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let faces: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
//! let mesh = PolygonMesh::from_arrays(&positions, &faces);
//! let mesh = Model::in_memory("tetrahedron", Arc::new(mesh.into()));
//! let layout = RunRequest::unwrap().run(&mesh)?;
//! assert!(layout.is_planar());
//! assert_eq!(layout.texture.corners.len(), 12);
//! # Ok::<(), freebound_run::RunError>(())
//! ```

mod automatic_cut;
mod chart_targets;
mod choices;
mod idle;
mod layout;
mod model;
mod request;
mod run;
mod seam_edges;

pub use automatic_cut::AutomaticCut;
pub use choices::{NoSuchPart, PartChoice, SeamKind, picture_of_aspect};
pub use idle::MethodOption;
pub use layout::{MeshLayout, NO_CHART, TriangleOfFace, WrittenLayout};
pub use model::{LayoutFile, Model, SolvedModel, finished_atlas};
pub use request::{RequestFault, RunRequest};
pub use run::{ChartProblem, ChartRun, Run, RunError, SolvedRun};
