//! A surface cut along edges whose two sides differ: the seams of its texture coordinates.

use super::sides::Sides;
use super::{Repair, Repaired};

impl Repaired {
    /// Cuts each edge at whose ends the faces there have different labels. `labels` has one for each corner of the mesh as
    /// given.
    pub(super) fn cut_along(&mut self, labels: &[u32]) {
        if !self.is_sound() {
            return;
        }
        let label = |corner: u32| labels[self.corner_of[corner as usize] as usize];
        let sides = Sides::new(&self.polygons);
        let is_alike = |pair: &[u32]| sides.across(pair[0], pair[1]).iter().all(|[a, b]| label(*a) == label(*b));
        let is_whole = |on: &[u32]| on.windows(2).all(is_alike);
        let count = sides.table.edges().filter(|on| !is_whole(on)).count();
        if count > 0 {
            let fans = sides.fans(is_whole);
            self.split_into(fans);
            self.note(Repair::Cut, count);
        }
    }
}
