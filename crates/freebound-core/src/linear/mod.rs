//! Linear solve with a free or a fixed boundary (paper §3.3 and §6).
//!
//! | file | contents |
//! |---|---|
//! | `system`, `block_pattern` | pattern and matrix |
//! | `free_gauge`, `free_layout`, `free_solve` | free boundary: gauge, layout of unknowns, solve |
//! | `least_squares`, `many_pins`, `left_kernel` | all equations kept, for few or many pins; dependent equations |
//! | `convex`, `hull_corners`, `fixed_solve` | boundary on a convex shape |
//! | `iterate` | mean-value iteration (paper §4) |
//! | `spectral`, `spectral_gauge` | spectral parameterization without pins; from the factors of two gauge pins |
//! | `stretch` | stretch minimisation |

pub(crate) mod block_pattern;
pub(crate) mod convex;
pub(crate) mod fixed_solve;
pub(crate) mod free_gauge;
pub(crate) mod free_layout;
pub(crate) mod free_solve;
mod hull_corners;
mod iterate;
mod least_squares;
mod left_kernel;
mod many_pins;
pub(crate) mod spectral;
pub(crate) mod spectral_gauge;
mod stretch;
pub(crate) mod system;

pub use convex::convex_boundary;
pub use iterate::Iteration;
pub use spectral::{Spectral, spectral};
pub use stretch::{LessStretched, StretchMinimising};
pub use system::FreeSystem;
