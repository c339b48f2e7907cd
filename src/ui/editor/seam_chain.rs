//! The chain of clicks that a seam is drawn by: where it has got to, and the way back when clicks are undone.

use freebound_core::mesh::{Seams, VertexId};

#[derive(Debug, Default)]
pub(super) struct Chain {
    /// Where the seam has got to.
    last: Option<VertexId>,
    /// The seams before each click, and where the chain had got to.
    trail: Vec<(Seams, VertexId)>,
    /// The seams that it was looked at with last.
    seams: Seams,
}

impl Chain {
    pub(super) fn last(&self) -> Option<VertexId> {
        self.last
    }

    pub(super) fn begin(&mut self, at: VertexId, seams: &Seams) {
        *self = Self { last: Some(at), trail: Vec::new(), seams: seams.clone() };
    }

    /// Ends the chain. Returns whether there was one.
    pub(super) fn end(&mut self) -> bool {
        self.trail.clear();
        self.last.take().is_some()
    }

    /// Goes on to a vertex by a click that makes other seams of those that there are, where there is a chain.
    pub(super) fn go_on(&mut self, to: VertexId, before: &Seams, now: &Seams) {
        let Some(from) = self.last else { return };
        if now != before {
            self.trail.push((before.clone(), from));
        }
        (self.last, self.seams) = (Some(to), now.clone());
    }

    /// Goes back to where the chain was when the seams were these, if they are others than before: one undo may take
    /// several clicks back, which were cut at once.
    pub(super) fn follow_undo(&mut self, seams: &Seams) {
        if self.seams == *seams {
            return;
        }
        if let Some(place) = self.trail.iter().rposition(|(before, _)| before == seams) {
            self.last = Some(self.trail[place].1);
            self.trail.truncate(place);
        }
        self.seams = seams.clone();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(number: u32) -> VertexId {
        VertexId::new(number)
    }

    /// A chain from vertex 0 by vertex 1 to vertex 2, with the seams before, between and after the two clicks.
    fn two_clicks() -> (Chain, [Seams; 3]) {
        let before = Seams::default();
        let between = before.with([[v(0), v(1)]]);
        let after = between.with([[v(1), v(2)]]);
        let mut chain = Chain::default();
        chain.begin(v(0), &before);
        chain.go_on(v(1), &before, &between);
        chain.go_on(v(2), &between, &after);
        (chain, [before, between, after])
    }

    #[test]
    fn an_undo_goes_back_by_one_click_or_by_two_that_were_cut_at_once() {
        let (mut chain, [before, between, _]) = two_clicks();
        chain.follow_undo(&between);
        assert_eq!(chain.last(), Some(v(1)));
        chain.follow_undo(&before);
        assert_eq!(chain.last(), Some(v(0)));
        let (mut chain, [before, ..]) = two_clicks();
        chain.follow_undo(&before);
        assert_eq!(chain.last(), Some(v(0)));
    }

    #[test]
    fn a_click_that_brings_back_the_seams_of_before_is_no_undo() {
        let (mut chain, [before, _, after]) = two_clicks();
        chain.go_on(v(3), &after, &before);
        chain.follow_undo(&before);
        assert_eq!(chain.last(), Some(v(3)), "the click led there");
        chain.follow_undo(&after);
        assert_eq!(chain.last(), Some(v(2)), "its undo leads back");
    }
}
