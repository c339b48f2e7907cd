//! Chain of clicks that draw a seam: its last vertex, and its undo.

use freebound_core::mesh::{Seams, VertexId};

#[derive(Debug, Default)]
pub(super) struct Chain {
    /// Last vertex of the seam.
    last: Option<VertexId>,
    /// Seams before each click, and the last vertex of the chain at that time.
    trail: Vec<(Seams, VertexId)>,
    /// Seams at the last update of the chain.
    seams: Seams,
}

impl Chain {
    pub(super) fn last(&self) -> Option<VertexId> {
        self.last
    }

    pub(super) fn begin(&mut self, at: VertexId, seams: &Seams) {
        *self = Self { last: Some(at), trail: Vec::new(), seams: seams.clone() };
    }

    /// Ends the chain. Returns true if there was one.
    pub(super) fn end(&mut self) -> bool {
        self.trail.clear();
        self.last.take().is_some()
    }

    /// Extends the chain to a vertex after a click. Records the click if it changed the seams. Does nothing without a
    /// chain.
    pub(super) fn go_on(&mut self, to: VertexId, before: &Seams, now: &Seams) {
        let Some(from) = self.last else { return };
        if now != before {
            self.trail.push((before.clone(), from));
        }
        (self.last, self.seams) = (Some(to), now.clone());
    }

    /// Shortens the chain after an undo: returns to its last vertex at the time of these seams. One undo may revert
    /// several clicks that were cut at once.
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

    /// Chain from vertex 0 over vertex 1 to vertex 2, with the seams before, between and after the two clicks.
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
