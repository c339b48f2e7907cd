//! Effect of a click of the seam tool. It is computed once for a click and its inputs; preview and status bar read it
//! in each frame.

use super::seam_tool::{SeamGround, SeamTool, TreeKey};
use crate::ui::state::{Edge, SeamClick};
use crate::view::OrbitCamera;
use freebound_core::mesh::{Seams, VertexId};

/// Greatest number of edges of a path whose visibility is tested. The others count as visible.
const LOOKED_AT: usize = 2000;

/// Effect of a click.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::ui) enum SeamIntent {
    /// Begin a seam.
    Begin,
    /// Cut along these edges, from the last vertex of the seam.
    Add(Vec<Edge>),
    /// Close these edges.
    TakeAway(Vec<Edge>),
    /// End the seam.
    End,
    /// Nothing: no seam is there, or no path leads there.
    #[default]
    Nothing,
    /// Unknown until the paths are found.
    Wait,
}

impl SeamIntent {
    /// Edges that the click cuts or closes.
    pub(in crate::ui) fn edges(&self) -> &[Edge] {
        match self {
            Self::Add(edges) | Self::TakeAway(edges) => edges,
            _ => &[],
        }
    }
}

/// Inputs that the effect of a click depends on.
#[derive(Clone, Debug, PartialEq)]
struct IntentKey {
    click: SeamClick,
    last: Option<VertexId>,
    creases: f64,
    tree: Option<TreeKey>,
    seams: Seams,
}

/// Effect of the click under the pointer, precomputed.
#[derive(Debug)]
pub(super) struct Foreseen {
    key: IntentKey,
    intent: SeamIntent,
    /// Camera, and true for each edge that the mesh does not hide from it.
    seen: Option<(OrbitCamera, Vec<bool>)>,
}

impl SeamTool {
    /// Effect of a click with the current seams.
    pub(super) fn intent(&self, click: SeamClick, seams: &Seams) -> SeamIntent {
        let vertex = click.vertex;
        let taken = |edges: Vec<Edge>| if edges.is_empty() { SeamIntent::Nothing } else { SeamIntent::TakeAway(edges) };
        match self.last() {
            None if click.erases => taken(seams.stretches_through(vertex)),
            None => SeamIntent::Begin,
            Some(last) if last == vertex => SeamIntent::End,
            Some(last) if click.erases => taken(seams.way(last, vertex).unwrap_or_default()),
            Some(last) => match self.tree_from(last) {
                Some(tree) => tree.path_to(vertex).map_or(SeamIntent::Nothing, SeamIntent::Add),
                None => SeamIntent::Wait,
            },
        }
    }

    /// Computes the effect of a click, unless it is known.
    pub(super) fn foresee(&mut self, click: Option<SeamClick>, seams: &Seams) {
        let key = click.map(|click| IntentKey {
            click,
            last: self.last(),
            creases: self.creases(),
            tree: self.tree_key(),
            seams: seams.clone(),
        });
        if self.foreseen.as_ref().map(|foreseen| &foreseen.key) != key.as_ref() {
            self.foreseen = key.map(|key| Foreseen { intent: self.intent(key.click, seams), key, seen: None });
        }
    }

    /// Effect of the click under the pointer.
    pub(in crate::ui) fn foreseen(&self) -> Option<&SeamIntent> {
        self.foreseen.as_ref().map(|foreseen| &foreseen.intent)
    }

    /// Tests the visibility of the edges that a click would change, unless it is known for this camera.
    pub(in crate::ui) fn update_visibility(&mut self, camera: &OrbitCamera) {
        let Some((ground, foreseen)) = self.ground().cloned().zip(self.foreseen.as_mut()) else { return };
        if foreseen.seen.as_ref().is_none_or(|(from, _)| from != camera) {
            foreseen.seen = Some((*camera, seen(&ground, foreseen.intent.edges(), camera)));
        }
    }

    /// True if the mesh does not hide an edge that a click would change, by its place among these edges.
    pub(in crate::ui) fn is_seen(&self, place: usize) -> bool {
        let seen = self.foreseen.as_ref().and_then(|foreseen| foreseen.seen.as_ref());
        seen.and_then(|(_, seen)| seen.get(place)).copied().unwrap_or(true)
    }
}

/// For each edge: true if at least one end is visible.
fn seen(ground: &SeamGround, edges: &[Edge], camera: &OrbitCamera) -> Vec<bool> {
    let shows = |edge: &Edge| edge.iter().any(|&end| ground.shows(end, camera));
    edges.iter().take(LOOKED_AT).map(shows).collect()
}
