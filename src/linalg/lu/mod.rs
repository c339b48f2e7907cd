//! Multifrontal LU on a symmetric pattern, pivoting only inside the diagonal block of a supernode.
//!
//! ```text
//! Q (R⁻¹ A) Qᵀ = L U      R diagonal, powers of two near |aᵢᵢ|;  Q a fill-reducing order
//! ```
//!
//! The supernodes, columns of L that share one pattern, form a tree. Each gathers its entries of A and its children's
//! updates into a dense front, eliminates its own columns and hands the Schur complement to its parent (Duff and Reid
//! 1983, "The multifrontal solution of indefinite sparse symmetric linear equations"). With
//! `c` columns and `p` rows below them, a front is
//!
//! ```text
//!         c        p
//!   c  | L₁₁\U₁₁   U₁₂ |     kept: c + p by c (column-major), then c by p
//!   p  | L₂₁        S  |     S, p by p, goes to the parent and is freed there
//! ```
//!
//! There is no pivoting between fronts. A pivot that is too small against its row is replaced and counted; refinement
//! against the original A repairs what that changed, or the solve is an error.
//!
//! | file | what |
//! |---|---|
//! | `supernodes.rs` | columns → relaxed supernodes, their order |
//! | `symbolic.rs` | patterns of the fronts, where every entry goes |
//! | `units.rs` | what runs one after another, what side by side |
//! | `factor.rs`, `front.rs`, `pivot.rs` | numbers: tree, one front, its diagonal block |
//! | `solve.rs` | forward and backward substitution |

mod factor;
mod front;
mod pivot;
mod solve;
mod supernodes;
mod symbolic;
mod units;

pub(super) use factor::Lu;
pub(super) use symbolic::LuAnalysis;
