//! Barycentric weights and the equations of vertices (paper §3.1 and §3.2).
//!
//! | file | contents |
//! |---|---|
//! | `corner_weights` | weights of one triangle corner |
//! | `pieces` | triangles of polygons, each with its share |
//! | `equations`, `plane_weights` | equations of all vertices, from the surface and from the plane |
//! | `shape_preserving` | Floater's weights of 1997 |
//! | `vertex_equation` | the equation of one vertex, term by term |

pub mod corner_weights;
pub mod equations;
mod pieces;
pub mod plane_weights;
pub(crate) mod shape_preserving;
pub(crate) mod vertex_equation;

pub use shape_preserving::shape_preserving;
pub use vertex_equation::{EquationTerm, VertexEquation};
