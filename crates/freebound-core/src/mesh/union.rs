//! Disjoint sets, with and without a parity between members.

/// Disjoint sets of `0..len` (the lower root wins, path halving).
#[derive(Clone, Debug)]
pub(crate) struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    pub(crate) fn new(len: usize) -> Self {
        Self { parent: (0..u32::try_from(len).expect("fewer than 2^32 members")).collect() }
    }

    pub(crate) fn find(&mut self, member: u32) -> u32 {
        let mut at = member as usize;
        loop {
            let up = self.parent[at];
            if up as usize == at {
                return up;
            }
            let above = self.parent[up as usize];
            self.parent[at] = above;
            at = above as usize;
        }
    }

    /// Roots of the sets, one per set, ascending.
    pub(crate) fn roots(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&self.parent).filter(|&(member, &up)| member == up).map(|(member, _)| member)
    }

    /// Joins two sets; the lower root represents both. Returns true if the sets were different.
    pub(crate) fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }
}

/// Disjoint sets in which every member also has a parity relative to the root of its set.
#[derive(Debug)]
pub(crate) struct ParitySets {
    parent: Vec<u32>,
    /// Parity relative to the parent.
    odd: Vec<bool>,
}

impl ParitySets {
    pub(crate) fn new(len: usize) -> Self {
        Self { parent: (0..u32::try_from(len).expect("fewer than 2^32 members")).collect(), odd: vec![false; len] }
    }

    /// Root of a member's set, and the member's parity relative to it.
    pub(crate) fn find(&mut self, member: u32) -> (u32, bool) {
        let mut at = member as usize;
        let mut odd = false;
        while self.parent[at] as usize != at {
            let up = self.parent[at] as usize;
            odd ^= self.odd[at];
            self.odd[at] ^= self.odd[up];
            self.parent[at] = self.parent[up];
            // The new parent is the grandparent. The walk continues from the old parent, whose parity is unchanged.
            at = up;
        }
        (self.parent[at], odd)
    }

    /// Records that two members differ (`odd`) or agree. Returns true if this contradicts earlier records.
    pub(crate) fn relate(&mut self, a: u32, b: u32, odd: bool) -> bool {
        let ((root_a, odd_a), (root_b, odd_b)) = (self.find(a), self.find(b));
        if root_a == root_b {
            return odd_a ^ odd_b != odd;
        }
        let (low, high) = (root_a.min(root_b), root_a.max(root_b));
        self.parent[high as usize] = low;
        self.odd[high as usize] = odd_a ^ odd_b ^ odd;
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_join_once() {
        let mut sets = DisjointSets::new(5);
        assert!(sets.join(3, 4) && sets.join(1, 3) && !sets.join(1, 4));
        assert_eq!((0..5).map(|m| sets.find(m)).collect::<Vec<_>>(), [0, 1, 2, 1, 1]);
    }

    #[test]
    fn parities_add_up_along_a_chain() {
        let mut sets = ParitySets::new(64);
        for m in (0..63).rev() {
            assert!(!sets.relate(m, m + 1, m % 3 == 0));
        }
        let parity = |m: u32| (0..m).filter(|k| k % 3 == 0).count() % 2 == 1;
        for m in 0..64 {
            assert_eq!(sets.find(m).1, parity(m), "{m}");
        }
        assert!(sets.relate(0, 63, !parity(63)));
        assert!(!sets.relate(0, 63, parity(63)));
    }
}
