//! Hull and pockets: each stage of the virtual boundary in the embedding's pane (paper §5).
//!
//! ```text
//! before    the embedding before, in its hull
//! pockets   the outside triangulated up to the hull
//! solved    mesh and outside embedded together, the hull where it was
//! peeled    the outside taken away: the step's result
//! ```
//!
//! The result of a step is moved by a similarity after the solve. All stages are shown moved by the same one, so that
//! the hull and what is solved stay at their places on the screen.

use std::sync::Arc;

use glam::DVec2;

use super::PlaneView;

use crate::render::{FillLayer, LineLayer};
use crate::session::{JobFailure, Wake};
use crate::ui::editor::async_scene::AsyncScene;
use crate::ui::editor::scene::{Part, PlaneScene};
use crate::ui::state::HullStage;
use crate::ui::theme::Theme;
use crate::view::{DrawnFaces, EdgeList, FacePaint, PlaneCamera};
use freebound_core::bijective::{Outline, VirtualBoundary};
use freebound_core::geom::{Orientation, Similarity, convex_hull, orientation};
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::nonlinear::Scaffold;
use freebound_core::problem::{Embedding, NamedOption, Stage};

#[derive(Debug)]
pub(super) struct HullView {
    shown: bool,
    stage: HullStage,
    /// With the outcome's revision and the stage.
    scene: Option<((u64, HullStage), HullScene)>,
    /// The stage that is being made, with the outcome's revision.
    job: AsyncScene<(u64, HullStage), HullScene>,
    /// The camera from before they showed, and the one that frames them.
    cameras: Option<[PlaneCamera; 2]>,
}

/// A stage, ready to be drawn.
#[derive(Debug)]
pub struct HullScene {
    /// The mesh at this stage, or with its outside; none where it is the result alone.
    plane: Option<Arc<PlaneScene>>,
    /// The faces' colours, where they are not the result's.
    paint: Option<Arc<FacePaint>>,
    hull: Arc<EdgeList>,
    pocket_edges: Arc<EdgeList>,
    pockets: Arc<DrawnFaces>,
    pub caption: String,
    pub has_stages: bool,
}

impl HullScene {
    fn new(result: &PlaneScene, stage: HullStage) -> Self {
        match (&result.outcome.step.candidate.outside, &result.outcome.step.candidate.virtual_boundary) {
            (Some(outside), _) => Self::of_outside(result, outside),
            (None, Some(stages)) => Self::of_stage(result, stage, stages),
            (None, None) => Self::of_free_boundary(result),
        }
    }

    /// A hull with pockets, and the mesh as in the result.
    fn of_hull(corners: &[VertexId], pockets: &[[VertexId; 3]], caption: String) -> Self {
        Self {
            plane: None,
            paint: None,
            hull: Arc::new(EdgeList::closed_loop(corners)),
            pocket_edges: Arc::new(EdgeList::new(sides_of(pockets))),
            pockets: Arc::new(DrawnFaces::new(pockets.to_vec())),
            caption,
            has_stages: false,
        }
    }

    fn of_stage(result: &PlaneScene, stage: HullStage, stages: &VirtualBoundary) -> Self {
        let (hull, pockets): (&[_], &[_]) = match stage {
            HullStage::Before => (&stages.hull, &[]),
            HullStage::Pockets | HullStage::Solved => (&stages.hull, &stages.pockets),
            HullStage::Peeled => (&[], &[]),
        };
        let disk = result.mesh.disk().expect("only a disk is solved");
        let boundary = disk.boundary_loop().len();
        let scene = Self { has_stages: true, ..Self::of_hull(hull, pockets, caption(stage, stages, boundary)) };
        let positions = match stage {
            HullStage::Before | HullStage::Pockets => &stages.before,
            HullStage::Solved => &stages.solved,
            HullStage::Peeled => return scene,
        };
        let moved = moved_along(positions, disk, [&stages.solved, &result.outcome.step.candidate.solution.embedding]);
        let paint = FacePaint::plain(disk.mesh().real_face_count(), &flipped_faces(disk, positions));
        Self { plane: Some(Arc::new(result.of_part(Part::Stage, moved))), paint: Some(Arc::new(paint)), ..scene }
    }

    /// A step that was made with the outside triangulated up to a frame: the result within it.
    fn of_outside(result: &PlaneScene, outside: &Scaffold) -> Self {
        let embedding = result.positions();
        let points: Embedding = embedding.iter().chain(&outside.frame).copied().collect();
        let (count, step) = (outside.triangles.len(), &result.outcome.step);
        let (outermost, caption) = if matches!(step.candidate.stage, Stage::Lee(_)) {
            let ring = result.mesh.disk().map_or(0, |disk| disk.boundary_loop().len());
            (ring, format!("{count} virtual triangles around the mesh, embedded with it and peeled off"))
        } else {
            let why = "while none turns over, the boundary stays simple";
            (outside.frame.len(), format!("{count} triangles around the mesh, up to a frame: {why}"))
        };
        let around: Vec<VertexId> = (points.len() - outermost..points.len()).map(VertexId::from_index).collect();
        let plane = Some(Arc::new(result.of_part(Part::WithOutside, points)));
        Self { plane, ..Self::of_hull(&around, &outside.triangles, caption) }
    }

    /// A step that bent no boundary still has a hull.
    fn of_free_boundary(result: &PlaneScene) -> Self {
        let disk = result.mesh.disk().expect("only a disk is solved");
        let boundary = disk.boundary_loop();
        let points = result.outcome.step.candidate.solution.embedding.boundary(disk);
        let corners: Vec<VertexId> = convex_hull(&points).into_iter().map(|place| boundary[place]).collect();
        let caption = match &result.outcome.step.candidate.stage {
            Stage::Convex(shape) | Stage::Stretch(shape) => {
                let count = boundary.len();
                format!("{count} of {count} boundary vertices pinned on {}", shape.labels().about)
            }
            _ => "This step has no virtual boundary; the line is the hull of the free one".to_owned(),
        };
        Self::of_hull(&corners, &[], caption)
    }

    /// Faces of the mesh that are turned over at a stage before the result.
    pub fn flipped_count(&self) -> usize {
        self.paint.as_ref().map_or(0, |paint| paint.flipped.len())
    }

    pub(super) fn plane(&self) -> Option<&Arc<PlaneScene>> {
        self.plane.as_ref()
    }

    /// The faces' colours at a stage before the result, whose distortion says nothing there.
    pub(in crate::ui) fn paint(&self) -> Option<&Arc<FacePaint>> {
        self.paint.as_ref()
    }

    pub(in crate::ui) fn fill(&self, theme: &Theme) -> FillLayer {
        FillLayer { faces: Arc::clone(&self.pockets), colour: theme.pocket_fill }
    }

    /// Edges of the pockets, and the hull over them.
    pub(in crate::ui) fn lines(&self, theme: &Theme) -> [LineLayer; 2] {
        [(&self.pocket_edges, theme.pocket, 0.75), (&self.hull, theme.hull, 2.0)]
            .map(|(edges, colour, width_in_points)| LineLayer { edges: Arc::clone(edges), colour, width_in_points })
    }
}

/// What a stage shows. Where vertices of the boundary were pinned on a circle, which nobody asked for, it says so.
fn caption(stage: HullStage, stages: &VirtualBoundary, boundary: usize) -> String {
    let outline = match stages.outline {
        Outline::Hull => "hull",
        Outline::Frame => "frame",
    };
    let circle = match stages.pinned {
        pinned if pinned > 2 => format!("{pinned} of {boundary} boundary vertices pinned on a circle. "),
        _ => String::new(),
    };
    match stage {
        HullStage::Before => format!("{circle}The step before, {outline} of {} corners", stages.hull.len()),
        HullStage::Pockets => format!("{circle}{} triangles up to the {outline}", stages.pockets.len()),
        HullStage::Solved => format!("Mesh and outside together, {outline} fixed"),
        HullStage::Peeled => stage.words()[1].to_owned(),
    }
}

/// Each side of the faces once.
fn sides_of(faces: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let sides = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut sides: Vec<[VertexId; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    sides.sort_unstable();
    sides.dedup();
    sides
}

fn flipped_faces(disk: &DiskMesh, embedding: &Embedding) -> Vec<FaceId> {
    let is_flipped = |&face: &FaceId| {
        let [a, b, c] = embedding.corners(disk, face);
        orientation(a, b, c) != Some(Orientation::CounterClockwise)
    };
    disk.real_faces().filter(is_flipped).collect()
}

/// An embedding moved as the boundary is from one embedding to another that differs from it by a similarity; where there is
/// none, it stays.
fn moved_along(embedding: &Embedding, disk: &DiskMesh, [before, after]: [&Embedding; 2]) -> Embedding {
    let pairs: Vec<[DVec2; 2]> = disk.boundary_loop().iter().map(|v| [before[v], after[v]]).collect();
    match Similarity::fitting(&pairs) {
        Some(similarity) => embedding.iter().map(|&z| similarity.apply(z)).collect(),
        None => embedding.clone(),
    }
}

impl HullView {
    pub(super) fn new(wake: &Wake) -> Self {
        let (stage, job) = (HullStage::default(), AsyncScene::new("hull", wake));
        Self { shown: false, stage, scene: None, job, cameras: None }
    }

    pub(super) fn is_making_scene(&self) -> bool {
        self.job.is_busy()
    }

    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }
}

impl PlaneView {
    pub fn hull_shown(&self) -> bool {
        self.hull.shown
    }

    pub fn stage(&self) -> HullStage {
        self.hull.stage
    }

    pub(in crate::ui::editor) fn set_stage(&mut self, stage: HullStage) {
        self.hull.stage = stage;
    }

    /// Hull and pockets of the shown step, where they are wanted and made, and nothing follows a drag in its place.
    pub fn hull_scene(&self) -> Option<&HullScene> {
        self.hull_made().map(|(_, scene)| scene)
    }

    fn hull_made(&self) -> Option<&((u64, HullStage), HullScene)> {
        let revision = self.scene.as_ref()?.outcome_revision;
        let is_wanted = self.hull.shown && self.preview.is_none();
        self.hull.scene.as_ref().filter(|(key, _)| is_wanted && key.0 == revision)
    }

    /// Whether hull and pockets are drawn as they were asked for.
    pub fn hull_is_drawn(&self) -> bool {
        let shown = self.hull_made().map(|(key, _)| key.1);
        !self.hull.shown || self.scene.is_none() || self.preview.is_some() || shown == Some(self.hull.stage)
    }

    /// Makes the chosen stage in the background where it is not there yet.
    pub(super) fn poll_hull(&mut self) {
        if let Some((key, scene)) = self.hull.job.poll() {
            self.hull.scene = Some((key, scene));
            self.frame_hull();
        }
        if self.hull.job.is_busy() {
            return;
        }
        if !self.hull.shown {
            self.hull.scene = None;
            return;
        }
        let Some(plane) = self.scene.clone() else { return };
        let key = (plane.outcome_revision, self.hull.stage);
        if self.hull.scene.as_ref().is_none_or(|(made, _)| *made != key) {
            self.hull.job.make(key, move |_| HullScene::new(&plane, key.1));
        }
    }

    /// Shows or hides hull and pockets. The camera comes back where nobody has moved it since.
    pub(in crate::ui::editor) fn toggle_hull(&mut self) {
        self.hull.shown = !self.hull.shown;
        if let Some([before, framing]) = self.hull.cameras.take()
            && self.pane.camera() == Some(framing)
        {
            self.pane.set_camera(before);
        }
    }

    /// Shows all of the hull, once it is there for the first time.
    fn frame_hull(&mut self) {
        let (Some(plane), Some(before)) = (self.drawn(), self.pane.camera()) else { return };
        let bounds = plane.arrays.bounds;
        if self.hull.cameras.is_none() && !self.shows(before, bounds) && !plane.is_plain_result() {
            let mut framing = before;
            framing.frame(bounds, self.pane.size());
            self.pane.set_camera(framing);
            self.hull.cameras = Some([before, framing]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_says_how_many_vertices_were_pinned_on_a_circle() {
        let empty = || Embedding::from(Vec::new());
        let stages = |pinned| VirtualBoundary {
            pinned,
            outline: Outline::Hull,
            before: empty(),
            weights_of_before: true,
            hull: Vec::new(),
            pockets: Vec::new(),
            solved: empty(),
        };
        let words = |pinned| caption(HullStage::Pockets, &stages(pinned), 410);
        assert_eq!(words(23), "23 of 410 boundary vertices pinned on a circle. 0 triangles up to the hull");
        assert_eq!(words(2), "0 triangles up to the hull", "two only fix place and size");
    }
}
