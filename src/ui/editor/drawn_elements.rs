//! Selected elements, with their edges for drawing.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::view::{EdgeList, ElementMesh, ElementSet, Revision};

/// Selected elements, with their edges for drawing.
#[derive(Clone, Debug, Default)]
pub(super) struct DrawnElements {
    elements: ElementSet,
    /// Mesh that the elements were found on, by its arrays. Faces have other numbers on other meshes.
    found_on: Option<Revision>,
    /// Number of changes of the elements.
    revision: u64,
    /// Edges on the mesh with these arrays, after a number of changes.
    lines: Option<(u64, Revision, Arc<EdgeList>)>,
}

impl DrawnElements {
    pub(super) fn get(&self) -> &ElementSet {
        &self.elements
    }

    /// Sets elements that were found on the mesh with these arrays. Vertices and edges need none.
    pub(super) fn set(&mut self, elements: ElementSet, found_on: Option<Revision>) {
        (self.elements, self.found_on) = (elements, found_on);
        self.revision += 1;
    }

    /// True if the elements have their numbers on the mesh with these arrays.
    pub(super) fn are_of(&self, arrays: Revision) -> bool {
        self.elements.faces().is_empty() || self.found_on == Some(arrays)
    }

    /// Keeps the elements on a mesh with the same numbers, which has these arrays.
    pub(super) fn stay_on(&mut self, arrays: Revision) {
        self.found_on = self.found_on.map(|_| arrays);
    }

    pub(super) fn change(&mut self, change: impl FnOnce(&mut ElementSet)) {
        change(&mut self.elements);
        self.revision += 1;
    }

    /// Edges of the elements, to be drawn over the mesh with these arrays.
    pub(super) fn lines(&self, arrays: Revision) -> Option<&Arc<EdgeList>> {
        let (revision, of, lines) = self.lines.as_ref()?;
        (*revision == self.revision && *of == arrays).then_some(lines)
    }

    /// Finds the edges of the elements on a mesh, unless they are known.
    pub(super) fn refresh<'a>(&mut self, arrays: Revision, mesh: impl FnOnce() -> ElementMesh<'a>) {
        if self.lines(arrays).is_none() {
            let has_edges = self.elements.vertices().len() > 1 && self.are_of(arrays);
            let edges = if has_edges { mesh().edges_in(&self.elements) } else { BTreeSet::new() };
            self.lines = Some((self.revision, arrays, Arc::new(EdgeList::new(edges.into_iter().collect()))));
        }
    }
}
