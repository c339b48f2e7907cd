//! Energies of an embedding, and Newton's method on them.
//!
//! | file | contents |
//! |---|---|
//! | `foldover_energy`, `rest_shape` | the energy of an element and its rest shape |
//! | `energy_problem/` | elements, springs and unknowns; descent |
//! | `scaffold` | the outside of an embedding, triangulated up to a frame |
//! | `slim` | scalable locally injective mappings |
//! | `unfolding` | maps without folds that may overlap themselves |
//! | `angles/` | angle based flattening |

pub(crate) mod angles;
pub(crate) mod energy_problem;
pub mod foldover_energy;
pub(crate) mod rest_shape;
pub(crate) mod scaffold;
pub mod slim;
mod unfolding;

pub use angles::{AngleMap, AngleSystem, angle_based};
pub use scaffold::Scaffold;
