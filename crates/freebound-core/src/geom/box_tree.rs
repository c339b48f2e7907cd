//! Tree of bounding boxes over items in a given order, such as the edges of a polygon; and an order along a
//! space-filling curve for items that have none.

use glam::DVec2;

use super::Bounds;

/// Bounding boxes of ranges of items: node 1 is the root, node k has the children 2k and 2k + 1, the leaves come
/// last. Boxes are small if consecutive items lie close together.
pub struct BoxTree {
    boxes: Vec<Bounds>,
    leaf_count: usize,
}

impl BoxTree {
    /// Tree over the bounding boxes of all items.
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

    /// Items after `thing` whose boxes meet the box of `thing`, in ascending order.
    pub fn later(&self, thing: usize) -> impl Iterator<Item = usize> + '_ {
        let bounds = self.boxes[self.leaf_count + thing];
        // Nodes to visit, each with the end of its range of items; the left child is visited first.
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

/// Position of a point of a box along a space-filling curve that keeps neighbours close: the interleaved bits of
/// both coordinates (G. M. Morton 1966).
pub fn place_along_curve(bounds: Bounds, point: DVec2) -> u64 {
    const CELLS: f64 = 4_294_967_295.0;
    let share = (point - bounds.low) / bounds.size();
    // Coordinates that are not a number become 0.
    let [x, y] = (share * CELLS).as_uvec2().to_array().map(spread_bits);
    x | (y << 1)
}

/// Bits of a number with a zero inserted after each.
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
