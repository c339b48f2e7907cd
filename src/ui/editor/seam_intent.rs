//! What a click of the seam tool would do. It is found once for a click and what it depends on; the preview and the words in
//! the status bar ask for it in each frame.

use super::seam_tool::{SeamGround, SeamTool, TreeKey};
use crate::ui::state::{Edge, SeamClick};
use crate::view::OrbitCamera;
use freebound_core::mesh::{Seams, VertexId};

/// Edges of a path of which it is looked whether the mesh hides them; the others show.
const LOOKED_AT: usize = 2000;

/// What a click would do.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::ui) enum SeamIntent {
    /// Begin a seam.
    Begin,
    /// Cut along these edges, from where the seam has got to.
    Add(Vec<Edge>),
    /// Close these edges.
    TakeAway(Vec<Edge>),
    /// End the seam.
    End,
    /// Nothing: no seam is there, or no edges lead there.
    #[default]
    Nothing,
    /// What the paths are is still being found.
    Wait,
}

impl SeamIntent {
    /// The edges that it cuts or closes.
    pub(in crate::ui) fn edges(&self) -> &[Edge] {
        match self {
            Self::Add(edges) | Self::TakeAway(edges) => edges,
            _ => &[],
        }
    }
}

/// What a click would do depends on this.
#[derive(Clone, Debug, PartialEq)]
struct IntentKey {
    click: SeamClick,
    last: Option<VertexId>,
    creases: f64,
    tree: Option<TreeKey>,
    seams: Seams,
}

/// What the click under the pointer would do.
#[derive(Debug)]
pub(super) struct Foreseen {
    key: IntentKey,
    intent: SeamIntent,
    /// Which of its edges the mesh does not hide from a camera.
    seen: Option<(OrbitCamera, Vec<bool>)>,
}

impl SeamTool {
    /// What a click would do now.
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

    /// Finds what a click would do, unless that is known.
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

    /// What the click under the pointer would do.
    pub(in crate::ui) fn foreseen(&self) -> Option<&SeamIntent> {
        self.foreseen.as_ref().map(|foreseen| &foreseen.intent)
    }

    /// Looks which edges that a click would change the mesh does not hide, unless that is known.
    pub(in crate::ui) fn update_visibility(&mut self, camera: &OrbitCamera) {
        let Some((ground, foreseen)) = self.ground().cloned().zip(self.foreseen.as_mut()) else { return };
        if foreseen.seen.as_ref().is_none_or(|(from, _)| from != camera) {
            foreseen.seen = Some((*camera, seen(&ground, foreseen.intent.edges(), camera)));
        }
    }

    /// Whether an edge that a click would change shows, by its place among them.
    pub(in crate::ui) fn is_seen(&self, place: usize) -> bool {
        let seen = self.foreseen.as_ref().and_then(|foreseen| foreseen.seen.as_ref());
        seen.and_then(|(_, seen)| seen.get(place)).copied().unwrap_or(true)
    }
}

/// Whether an end of each edge shows.
fn seen(ground: &SeamGround, edges: &[Edge], camera: &OrbitCamera) -> Vec<bool> {
    let shows = |edge: &Edge| edge.iter().any(|&end| ground.shows(end, camera));
    edges.iter().take(LOOKED_AT).map(shows).collect()
}
