//! Tree of fronts, shared by all multifrontal factorizations of this layer.
//!
//! The supernodes, columns of L that share a pattern, form a tree. Each gathers its entries of A and its children's
//! updates into a dense front. It eliminates its own columns and passes the Schur complement to its parent (Duff and
//! Reid 1983, "The multifrontal solution of indefinite sparse symmetric linear equations"). Subtrees are independent
//! of each other, so that threads process them in parallel.
//!
//! | file | contents |
//! |---|---|
//! | `supernodes.rs` | columns → relaxed supernodes, their order |
//! | `symbolic.rs` | patterns of the fronts, position of every entry |
//! | `places.rs` | real and complex fronts, storage of their numbers |
//! | `units.rs` | units of work: sequential inside, parallel to each other |
//! | `tree.rs` | traversal of the tree from the leaves to the root, on all threads |
//! | `substitution.rs` | substitution of right-hand sides, up the tree and down |
//! | `dense.rs` | slices as matrices, addition of a front's rows to another front |

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
