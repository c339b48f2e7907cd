//! Options of a flattener, collected before it is built.

use std::sync::Arc;

use super::cache::SolverCache;
use crate::mesh::VertexId;
use crate::problem::{Embedding, Pin, Pins, Settings};
use crate::verify::UvFrame;

/// Options of [`flatten`](crate::flatten()) and of a [`Flattener`](super::Flattener).
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Method and weights. Default: `auto`.
    pub settings: Settings,
    /// Pinned vertices and their targets in the plane. Default: none.
    pub pins: Pins,
    /// Frame of the numbers in which every step is proved and written. Default: the coordinates of the plane.
    pub output_frame: UvFrame,
    /// Existing embedding to start from instead of solving from scratch: one position per vertex, in the plane.
    /// Positions of unreferenced vertices are ignored. Default: none.
    ///
    /// The embedding becomes step 0. If it is planar, constraints and relaxation start from it; otherwise the
    /// iteration and the virtual boundary do, and other methods solve from scratch. If it meets every constraint, it
    /// is returned unchanged. If it meets two constraints, it is not moved to fit the others. It is relaxed only if
    /// rounds are given.
    pub layout: Option<Arc<Embedding>>,
    /// True if the layout leaves position, rotation and size open: its map is placed and relaxed like one that is
    /// computed from the surface alone. Default: false.
    pub layout_is_free: bool,
    /// Results of earlier flatteners on the same mesh, for reuse. With a cache, steps keep the factors of linear
    /// solves for further flatteners; without a cache, factors are dropped after use. Default: none.
    pub cache: Option<SolverCache>,
}

impl Options {
    /// Adds a hard pin: vertex `vertex` of the mesh must lie at this point of the plane. Two pins fix position,
    /// rotation and scale; more are constraints.
    #[must_use]
    pub fn pinned(mut self, vertex: u32, target: [f64; 2]) -> Self {
        self.pins.insert(VertexId::new(vertex), Pin::hard(target.into()));
        self
    }
}
