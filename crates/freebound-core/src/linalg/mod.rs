//! Sparse linear systems: multifrontal Cholesky and faer's `LDLᴴ` for Hermitian matrices, a multifrontal LU for
//! unsymmetric values on a symmetric pattern, refinement and residuals. Knows no mesh.
//!
//! ```text
//! Analysis::new(kind, pattern)     ordering and symbolic factorization, once per pattern
//!     .factor(matrix, cancel)      numeric factorization, once per matrix
//!         .solve(matrix, rhs)      solve, refine, measure the residual
//! ```
//!
//! | file | contents |
//! |---|---|
//! | `analysis.rs`, `factor.rs`, `stats.rs` | interface |
//! | `pattern.rs` | sparsity patterns and orders of elimination |
//! | `order.rs`, `elimination.rs` | fill-reducing order (dissection, AMD); elimination tree, column counts, postorder |
//! | `degree.rs` | minimum degree |
//! | `detached.rs` | work that cannot be stopped, on detached threads |
//! | `dissection/` | separators of large patterns |
//! | `fronts/` | tree of dense fronts, shared by both multifrontal factorizations |
//! | `llt/` | Hermitian definite: our multifrontal Cholesky |
//! | `ldlt.rs` | Hermitian augmented, for least squares: faer's supernodal `LDLᴴ` |
//! | `lu/` | unsymmetric: our multifrontal LU |
//! | `lanczos.rs` | greatest eigenvalue of an operator, such as the inverse of a factored matrix |
//! | `rough.rs` | definite systems solved to a few digits: Cholesky in `f32`, conjugate gradients |
//! | `refine.rs`, `gmres.rs` | iterative refinement and acceptance of solutions |
//! | `sparse.rs`, `scalar.rs`, `error.rs` | products, norms and inner products; real and complex numbers; errors |

mod analysis;
mod degree;
mod detached;
mod dissection;
mod elimination;
mod error;
mod factor;
mod fronts;
mod gmres;
mod lanczos;
mod ldlt;
mod llt;
mod lu;
mod order;
mod pattern;
mod refine;
mod rough;
mod scalar;
mod sparse;
mod stats;

pub use analysis::{Analysis, EliminationOrder, Kind};
pub(crate) use detached::run_apart;
pub use error::LinalgError;
pub use factor::{Factor, SolveFunction};
pub use lanczos::{EigenLimits, Eigenpair, greatest_eigenpair};
pub(crate) use pattern::Pattern;
pub use refine::Solved;
pub use rough::{FactorPrecision, RoughFactor};
pub use scalar::{Number, Scalar};
pub use sparse::gram;
pub use stats::FactorStats;
