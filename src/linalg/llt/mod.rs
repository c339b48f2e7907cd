//! Multifrontal Cholesky factorization of a Hermitian definite matrix.
//!
//! ```text
//! P (σ A) Pᵀ = L Lᴴ,   σ = ±1 the sign of the diagonal
//! ```
//!
//! Of a front (see the module `fronts`) the L panel is kept, and only lower triangles of diagonal blocks and updates are
//! computed: half the work of an LU. Unknowns that come in pairs, such as the two coordinates of a point, are ordered
//! and analysed as pairs.
//!
//! Measured beside faer's supernodal Cholesky, which goes through the supernodes one after another with threads inside
//! each: see "linalg" in docs/benchmarks.md.
//!
//! | file | what |
//! |---|---|
//! | `factor.rs`, `front.rs` | numbers: all fronts, one front |
//! | `solve.rs` | forward and backward substitution |

mod factor;
mod front;
mod solve;

pub(super) use factor::Llt;
