//! The paper: weights, systems, methods, verdict and distortion. Knows no screen and no file.

mod control;
mod error;
mod method;
mod solution;
mod verdict;

pub use control::{Control, Phase};
pub use error::SolveError;
pub use method::{BoundaryShape, Family, Method, Settings};
pub use solution::{PhaseSeconds, Solution};
pub use verdict::{Verdict, verdict};
