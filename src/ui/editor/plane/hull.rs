//! Hull and pockets: the stages of the virtual boundary in the embedding pane (paper §5).
//!
//! ```text
//! before    embedding before the virtual boundary, in its hull
//! pockets   outside triangulated up to the hull
//! solved    mesh and outside embedded together, the hull fixed
//! peeled    outside removed: the result of the step
//! ```
//!
//! The result of a step is moved by a similarity after the solve. All stages are shown moved by that similarity, so
//! that the hull and the solved embedding stay in place on the screen.

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
    /// Scene with its key: revision of the outcome, and stage.
    scene: Option<((u64, HullStage), HullScene)>,
    /// Background job that makes the scene. Key: revision of the outcome, and stage.
    job: AsyncScene<(u64, HullStage), HullScene>,
    /// Camera before hull and pockets showed, and the camera that frames them.
    cameras: Option<[PlaneCamera; 2]>,
}

/// Stage of the virtual boundary, prepared for drawing.
#[derive(Debug)]
pub struct HullScene {
    /// Mesh at this stage, or with its outside; `None` for the result alone.
    plane: Option<Arc<PlaneScene>>,
    /// Face colours, if they differ from those of the result.
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

    /// Hull with pockets, and the mesh as in the result.
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

    /// Scene of a step solved with the outside triangulated up to a frame: the result within the outside.
    fn of_outside(result: &PlaneScene, outside: &Scaffold) -> Self {
        let embedding = result.positions();
        let points: Embedding = embedding.iter().chain(&outside.frame).copied().collect();
        let (count, step) = (outside.triangles.len(), &result.outcome.step);
        let (outermost, caption) = if matches!(step.candidate.stage, Stage::Lee(_)) {
            let ring = result.mesh.disk().map_or(0, |disk| disk.boundary_loop().len());
            (ring, format!("{count} virtual triangles around the mesh, solved with it, then removed"))
        } else {
            let why = "while none of them flips, the boundary stays simple";
            (outside.frame.len(), format!("{count} triangles between mesh and frame: {why}"))
        };
        let around: Vec<VertexId> = (points.len() - outermost..points.len()).map(VertexId::from_index).collect();
        let plane = Some(Arc::new(result.of_part(Part::WithOutside, points)));
        Self { plane, ..Self::of_hull(&around, &outside.triangles, caption) }
    }

    /// Scene of a step without a virtual boundary: the hull of its free boundary.
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
            _ => "This step has no virtual boundary. The line is the hull of the free boundary".to_owned(),
        };
        Self::of_hull(&corners, &[], caption)
    }

    /// Number of faces flipped at a stage before the result.
    pub fn flipped_count(&self) -> usize {
        self.paint.as_ref().map_or(0, |paint| paint.flipped.len())
    }

    pub(super) fn plane(&self) -> Option<&Arc<PlaneScene>> {
        self.plane.as_ref()
    }

    /// Face colours at a stage before the result. The distortion of the outcome does not apply to a stage.
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

/// Caption of a stage. States the number of boundary vertices pinned on a circle if there are more than two, because
/// the user did not ask for these pins.
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
        HullStage::Before => format!("{circle}Previous step; {outline} with {} corners", stages.hull.len()),
        HullStage::Pockets => format!("{circle}{} triangles up to the {outline}", stages.pockets.len()),
        HullStage::Solved => format!("Mesh and outside solved together, {outline} fixed"),
        HullStage::Peeled => stage.words()[1].to_owned(),
    }
}

/// Sides of the faces, each once.
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

/// Moves an embedding by the similarity that maps the boundary of one embedding to another. Returns it unchanged if
/// no similarity fits.
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

    /// Hull and pockets of the step on the screen, if shown and made. A drag preview hides them.
    pub fn hull_scene(&self) -> Option<&HullScene> {
        self.hull_made().map(|(_, scene)| scene)
    }

    fn hull_made(&self) -> Option<&((u64, HullStage), HullScene)> {
        let revision = self.scene.as_ref()?.outcome_revision;
        let is_wanted = self.hull.shown && self.preview.is_none();
        self.hull.scene.as_ref().filter(|(key, _)| is_wanted && key.0 == revision)
    }

    /// True if hull and pockets are drawn as requested.
    pub fn hull_is_drawn(&self) -> bool {
        let shown = self.hull_made().map(|(key, _)| key.1);
        !self.hull.shown || self.scene.is_none() || self.preview.is_some() || shown == Some(self.hull.stage)
    }

    /// Makes the chosen stage in the background if it is missing.
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

    /// Shows or hides hull and pockets. Restores the earlier camera, unless the user has moved the camera since.
    pub(in crate::ui::editor) fn toggle_hull(&mut self) {
        self.hull.shown = !self.hull.shown;
        if let Some([before, framing]) = self.hull.cameras.take()
            && self.pane.camera() == Some(framing)
        {
            self.pane.set_camera(before);
        }
    }

    /// Frames the whole hull when it first appears.
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
    use freebound_testkit::assert_message;

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
        assert!(words(23).starts_with("23 of 410 "), "{}", words(23));
        assert_message("hull-caption-with-pins-on-a-circle", &words(23));
        assert_eq!(words(2), words(0), "two only fix place and size");
    }
}
