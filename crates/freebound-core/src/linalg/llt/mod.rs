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
//! Panels are real where nothing complex is below (see `fronts/places.rs`).
//!
//! faer's supernodal Cholesky goes through the supernodes one after another, with threads inside each; with all panels
//! complex, this one took 0.46 of its time for the conformal system of 99,854 unknowns and 0.6 for that of 499,847, on two
//! cores.
//!
//! | file | what |
//! |---|---|
//! | `factor.rs`, `front.rs` | numbers: all fronts, one front |
//! | `solve.rs` | forward and backward substitution |

mod factor;
mod front;
mod solve;

pub(super) use factor::Llt;
