//! A tree of boxes over things in a given order, such as the edges of a polygon; and an order for things that have none.

use glam::DVec2;

use super::Bounds;

/// Boxes over ranges of things: node 1 is the root, node k has the children 2k and 2k + 1, the leaves come last. Where
/// things that follow each other lie together, the boxes are small.
pub struct BoxTree {
    boxes: Vec<Bounds>,
    leaf_count: usize,
}

impl BoxTree {
    /// A tree over the boxes of all things.
    pub fn new(leaves: impl ExactSizeIterator<Item = Bounds>) -> Self {
        let leaf_count = leaves.len().next_power_of_two();
        let mut boxes = vec![Bounds::EMPTY; leaf_count];
        boxes.extend(leaves);
        boxes.resize(2 * leaf_count, Bounds::EMPTY);
        for node in (1..leaf_count).rev() {
            boxes[node] = boxes[2 * node].union(boxes[2 * node + 1]);
        }
        Self { boxes, leaf_count }
    }

    /// The things behind one whose boxes its own box meets, in their order.
    pub fn later(&self, thing: usize) -> impl Iterator<Item = usize> + '_ {
        let bounds = self.boxes[self.leaf_count + thing];
        // Nodes to look at with the end of the range of things below them; the left child is taken first.
        let mut pending = Vec::with_capacity(64);
        pending.push((1, self.leaf_count));
        std::iter::from_fn(move || {
            while let Some((node, end)) = pending.pop() {
                if end <= thing + 1 || !bounds.meets(self.boxes[node]) {
                    continue;
                }
                if node >= self.leaf_count {
                    return Some(end - 1);
                }
                let half = self.leaf_count >> (node.ilog2() + 1);
                pending.extend([(2 * node + 1, end), (2 * node, end - half)]);
            }
            None
        })
    }
}

/// The place of a point of a box along a curve that keeps near what lies near (G. M. Morton 1966, the bits of both
/// coordinates in turn).
pub fn place_along_curve(bounds: Bounds, point: DVec2) -> u64 {
    const CELLS: f64 = 4_294_967_295.0;
    let share = (point - bounds.low) / bounds.size();
    // What is not a number counts as 0.
    let [x, y] = (share * CELLS).as_uvec2().to_array().map(spread_bits);
    x | (y << 1)
}

/// The bits of a number, a zero after each.
fn spread_bits(number: u32) -> u64 {
    let mut bits = u64::from(number);
    for (shift, mask) in [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ] {
        bits = (bits | (bits << shift)) & mask;
    }
    bits
}
