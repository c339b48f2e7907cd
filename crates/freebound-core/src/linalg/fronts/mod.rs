//! The tree of fronts that every multifrontal factorization of this layer goes up.
//!
//! The supernodes, columns of L that share one pattern, form a tree. Each gathers its entries of A and its children's
//! updates into a dense front, eliminates its own columns and hands the Schur complement to its parent (Duff and Reid
//! 1983, "The multifrontal solution of indefinite sparse symmetric linear equations"). Subtrees are independent of each
//! other, so that threads share them out.
//!
//! | file | what |
//! |---|---|
//! | `supernodes.rs` | columns → relaxed supernodes, their order |
//! | `symbolic.rs` | patterns of the fronts, where every entry goes |
//! | `places.rs` | which fronts are real, and where their numbers are kept |
//! | `units.rs` | what runs one after another, what side by side |
//! | `tree.rs` | the way up the tree, on all threads |
//! | `substitution.rs` | the way of right-hand sides up the tree and down again |
//! | `dense.rs` | slices as matrices, and adding rows of one front to another's |

mod dense;
mod places;
mod substitution;
mod supernodes;
mod symbolic;
mod tree;
mod units;

pub(super) use dense::{mat, mat_mut, scatter_add};
pub(super) use places::{FrontNumbers, Gather, Kept, Numbers, Places, Room, append_zeros, gather_in_full, gather_real};
pub(super) use substitution::{
    LARGE_PANEL, Part, Substitution, TOGETHER, dot, split_panel, substitute, subtract_product,
};
pub(super) use symbolic::{FrontAnalysis, Shape, Sides, threads_for};
pub(super) use tree::{Kernel, Tree, Update};
