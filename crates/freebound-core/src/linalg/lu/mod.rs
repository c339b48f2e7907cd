//! Multifrontal LU on a symmetric pattern, pivoting only inside the diagonal block of a supernode.
//!
//! ```text
//! Q (R⁻¹ A) Qᵀ = L U      R diagonal, powers of two near |aᵢᵢ|;  Q a fill-reducing order
//! ```
//!
//! With `c` columns and `p` rows below them, a front (see the module `fronts`) is
//!
//! ```text
//!         c        p
//!   c  | L₁₁\U₁₁   U₁₂ |     kept: c + p by c (column-major), then c by p
//!   p  | L₂₁        S  |     S, p by p, goes to the parent and is freed there
//! ```
//!
//! Panels are real unless an entry below them is complex (see `fronts/places.rs`).
//!
//! There is no pivoting between fronts. A pivot that is too small relative to its row is replaced and counted.
//! Refinement against the original A repairs the effect, or the solve fails.
//!
//! | file | contents |
//! |---|---|
//! | `factor.rs`, `front.rs`, `pivot.rs` | numbers: all fronts, one front, its diagonal block |
//! | `solve.rs` | forward and backward substitution |

mod factor;
mod front;
mod pivot;
mod solve;

pub(super) use factor::Lu;
