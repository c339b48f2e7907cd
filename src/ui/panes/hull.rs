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

use eframe::egui;
use glam::DVec2;

use crate::geom::{Orientation, convex_hull, orientation};
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::render::{FillLayer, LineLayer};
use crate::session::{Job, Outcome, Poll};
use crate::solver::{Outline, Outside, VirtualBoundary};
use crate::ui::editor::scene::{Part, PlaneScene};
use crate::ui::theme::{Theme, theme_of};
use crate::ui::{Editor, Request};
use crate::view::{EdgeList, FaceList, FacePaint, PlaneCamera};

/// A stage of the virtual boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// The embedding before, in its hull.
    Before,
    /// The outside triangulated.
    #[default]
    Pockets,
    /// Mesh and outside as solved together.
    Solved,
    /// The result.
    Peeled,
}

impl Stage {
    /// All stages in their order.
    pub const ALL: [Self; 4] = [Self::Before, Self::Pockets, Self::Solved, Self::Peeled];

    /// Its name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Before => "Before",
            Self::Pockets => "Pockets",
            Self::Solved => "Solved",
            Self::Peeled => "Peeled",
        }
    }

    /// What it shows.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Before => "The embedding before, in its hull",
            Self::Pockets => "The outside triangulated up to the hull",
            Self::Solved => "Mesh and outside embedded together, the hull where it was",
            Self::Peeled => "The outside taken away: the result",
        }
    }
}

/// Hull and pockets as the window has them.
#[derive(Default)]
pub struct HullView {
    /// Whether they show.
    pub shown: bool,
    /// The stage that is chosen.
    pub stage: Stage,
    pub(in crate::ui) scene: Option<Arc<HullScene>>,
    job: Option<Job<(), HullScene>>,
    /// The camera from before they showed, and the one that frames them.
    cameras: Option<[PlaneCamera; 2]>,
}

/// A stage, ready to be drawn.
#[derive(Debug)]
pub struct HullScene {
    /// The outcome's revision and the stage.
    key: (u64, Stage),
    /// The mesh at this stage, or with its outside; none where it is the result alone.
    plane: Option<Arc<PlaneScene>>,
    /// The faces' colours, where they are not the result's.
    paint: Option<Arc<FacePaint>>,
    hull: Arc<EdgeList>,
    pocket_edges: Arc<EdgeList>,
    pockets: Arc<FaceList>,
    /// What it shows, in numbers.
    pub caption: String,
    /// Whether the step has stages at all.
    pub has_stages: bool,
}

impl HullScene {
    fn new(disk: &DiskMesh, result: &PlaneScene, stage: Stage) -> Self {
        let (outcome, key) = (&result.outcome, (result.outcome_revision, stage));
        if let Some(outside) = &outcome.step.outside {
            return Self::of_outside(result, outside, key);
        }
        let Some(stages) = &outcome.step.virtual_boundary else { return Self::of_free_boundary(disk, outcome, key) };
        let mut scene = Self {
            key,
            plane: None,
            paint: None,
            hull: Arc::new(EdgeList::closed_loop(&stages.hull)),
            pocket_edges: Arc::new(EdgeList::new(Vec::new())),
            pockets: Arc::new(FaceList::new(Vec::new())),
            caption: caption(key.1, stages),
            has_stages: true,
        };
        let positions = match key.1 {
            Stage::Before | Stage::Pockets => &stages.before,
            Stage::Solved => &stages.solved,
            Stage::Peeled => {
                scene.hull = Arc::new(EdgeList::new(Vec::new()));
                return scene;
            }
        };
        if key.1 != Stage::Before {
            scene.pocket_edges = Arc::new(EdgeList::new(sides_of(&stages.pockets)));
            scene.pockets = Arc::new(FaceList::new(stages.pockets.clone()));
        }
        let moved = Similarity::between(disk, &stages.solved, &outcome.step.solution.embedding).moved(positions);
        let flipped = flipped_faces(disk, positions);
        scene.plane = Some(Arc::new(result.of_part(Part::Stage, moved)));
        scene.paint = Some(Arc::new(FacePaint::plain(disk.face_count(), &flipped)));
        scene
    }

    /// A step that was made with the outside triangulated up to a frame: the result within it.
    fn of_outside(result: &PlaneScene, outside: &Outside, key: (u64, Stage)) -> Self {
        let embedding = result.positions();
        let around: Vec<VertexId> =
            (0..outside.frame.len()).map(|k| VertexId::from_index(embedding.len() + k)).collect();
        let points = embedding.iter().chain(&outside.frame).copied().collect();
        Self {
            key,
            plane: Some(Arc::new(result.of_part(Part::WithOutside, points))),
            paint: None,
            hull: Arc::new(EdgeList::closed_loop(&around)),
            pocket_edges: Arc::new(EdgeList::new(sides_of(&outside.triangles))),
            pockets: Arc::new(FaceList::new(outside.triangles.clone())),
            caption: format!(
                "{} triangles around the mesh, up to a frame: while none turns over, the boundary stays simple",
                outside.triangles.len()
            ),
            has_stages: false,
        }
    }

    /// A step that bent no boundary still has a hull.
    fn of_free_boundary(disk: &DiskMesh, outcome: &Outcome, key: (u64, Stage)) -> Self {
        let boundary = disk.boundary_loop();
        let points: Vec<DVec2> = boundary.iter().map(|v| outcome.step.solution.embedding[v.index()]).collect();
        let corners: Vec<VertexId> = convex_hull(&points).into_iter().map(|place| boundary[place]).collect();
        Self {
            key,
            plane: None,
            paint: None,
            hull: Arc::new(EdgeList::closed_loop(&corners)),
            pocket_edges: Arc::new(EdgeList::new(Vec::new())),
            pockets: Arc::new(FaceList::new(Vec::new())),
            caption: "This step has no virtual boundary; the line is the hull of the free one".to_owned(),
            has_stages: false,
        }
    }

    /// Faces of the mesh that are turned over at a stage before the result.
    pub fn flipped_count(&self) -> usize {
        self.paint.as_ref().map_or(0, |paint| paint.flipped().len())
    }

    /// The faces beside the mesh.
    pub(super) fn fills(&self, theme: &Theme) -> Vec<FillLayer> {
        vec![FillLayer { faces: Arc::clone(&self.pockets), colour: theme.pocket_fill }]
    }

    /// Edges of the pockets, and the hull over them.
    pub(in crate::ui) fn lines(&self, theme: &Theme) -> [LineLayer; 2] {
        let line = |edges: &Arc<EdgeList>, colour, width_in_points| LineLayer {
            edges: Arc::clone(edges),
            colour,
            width_in_points,
        };
        [line(&self.pocket_edges, theme.pocket, 0.75), line(&self.hull, theme.hull, 2.0)]
    }
}

fn caption(stage: Stage, stages: &VirtualBoundary) -> String {
    let outline = match stages.outline {
        Outline::Hull => "hull",
        Outline::Frame => "frame",
    };
    match stage {
        Stage::Before if stages.pinned > 2 => {
            format!("{} boundary vertices on a circle, {outline} of {} corners", stages.pinned, stages.hull.len())
        }
        Stage::Before => format!("The step before, {outline} of {} corners", stages.hull.len()),
        Stage::Pockets => format!("{} triangles up to the {outline}", stages.pockets.len()),
        Stage::Solved => format!("Mesh and outside together, {outline} fixed"),
        Stage::Peeled => "The outside taken away: the result".to_owned(),
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

fn flipped_faces(disk: &DiskMesh, positions: &[DVec2]) -> Vec<FaceId> {
    let is_flipped = |&face: &FaceId| {
        let [a, b, c] = disk.face(face).map(|v| positions[v.index()]);
        orientation(a, b, c) != Some(Orientation::CounterClockwise)
    };
    disk.faces().filter(is_flipped).collect()
}

/// z ↦ `to` + `turn` · (z − `from`), points as complex numbers.
#[derive(Clone, Copy, Debug)]
struct Similarity {
    from: DVec2,
    to: DVec2,
    turn: DVec2,
}

impl Similarity {
    /// The similarity that takes one embedding to another which differs by nothing else: found by the first boundary
    /// vertex and the one farthest from it.
    fn between(disk: &DiskMesh, before: &[DVec2], after: &[DVec2]) -> Self {
        let boundary = disk.boundary_loop();
        let first = boundary[0].index();
        let distance = |v: &VertexId| before[v.index()].distance(before[first]);
        let far = boundary.iter().max_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(first, |v| v.index());
        let (is, wanted) = (before[far] - before[first], after[far] - after[first]);
        let turn = DVec2::new(is.dot(wanted), is.perp_dot(wanted)) / is.length_squared();
        if turn.is_finite() {
            Self { from: before[first], to: after[first], turn }
        } else {
            Self { from: DVec2::ZERO, to: DVec2::ZERO, turn: DVec2::X }
        }
    }

    fn moved(self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|&z| self.to + self.turn.rotate(z - self.from)).collect()
    }
}

impl Editor {
    /// What the embedding's pane draws and picks in: the shown step's embedding, or a stage on the way to it.
    pub fn drawn_plane(&self) -> Option<&Arc<PlaneScene>> {
        self.hull_scene().and_then(|scene| scene.plane.as_ref()).or(self.result_plane())
    }

    /// The faces' colours at a stage that is not the result; there the distortion of the result says nothing.
    pub(super) fn stage_paint(&self) -> Option<&Arc<FacePaint>> {
        self.hull_scene().and_then(|scene| scene.paint.as_ref())
    }

    /// Hull and pockets of the shown step, where they are wanted and made, and nothing follows a drag in its place.
    pub fn hull_scene(&self) -> Option<&Arc<HullScene>> {
        let revision = self.plane_scene.as_ref()?.outcome_revision;
        let is_wanted = self.hull.shown && self.preview_plane().is_none();
        self.hull.scene.as_ref().filter(|scene| is_wanted && scene.key.0 == revision)
    }

    /// Whether hull and pockets are drawn as they were asked for.
    pub fn hull_is_drawn(&self) -> bool {
        let shown = self.hull_scene().map(|scene| scene.key.1);
        !self.hull.shown
            || self.plane_scene.is_none()
            || self.preview_plane().is_some()
            || shown == Some(self.hull.stage)
    }

    /// Makes the chosen stage in the background where it is not there yet.
    pub(in crate::ui) fn poll_hull_scene(&mut self) {
        if let Some(job) = &self.hull.job {
            match job.poll() {
                Poll::Running => return,
                Poll::Lost => self.hull.job = None,
                Poll::Done(scene) => {
                    self.hull.job = None;
                    self.hull.scene = Some(Arc::new(scene));
                    self.frame_hull();
                }
            }
        }
        if !self.hull.shown {
            self.hull.scene = None;
            return;
        }
        let Some(plane) = &self.plane_scene else { return };
        let key = (plane.outcome_revision, self.hull.stage);
        let Some(disk) = plane.mesh.model.disk().filter(|_| self.hull.scene.as_ref().is_none_or(|s| s.key != key))
        else {
            return;
        };
        let (disk, plane) = (Arc::clone(disk), Arc::clone(plane));
        let work = move |_: &_| HullScene::new(plane.outcome.step.mesh(&disk), &plane, key.1);
        self.hull.job = Job::spawn("hull", self.host.waker(), work).ok();
    }

    /// Whether a stage is being made.
    pub(in crate::ui) fn is_making_hull(&self) -> bool {
        self.hull.job.is_some()
    }

    /// Shows or hides hull and pockets. The camera comes back where nobody has moved it since.
    pub(in crate::ui) fn toggle_hull(&mut self) {
        self.hull.shown = !self.hull.shown;
        if let Some([before, framing]) = self.hull.cameras.take()
            && self.plane_camera == Some(framing)
        {
            self.plane_camera = Some(before);
        }
    }

    /// Shows all of the hull, once it is there for the first time.
    fn frame_hull(&mut self) {
        let (Some(plane), Some(camera)) = (self.drawn_plane().cloned(), &mut self.plane_camera) else { return };
        let (bounds, seen) = (plane.arrays.bounds(), camera.visible(self.plane_pane_size));
        let is_seen = seen.min.cmple(bounds.min).all() && seen.max.cmpge(bounds.max).all();
        if self.hull.cameras.is_none() && !is_seen && !plane.is_plain_result() {
            let before = *camera;
            camera.frame(bounds, self.plane_pane_size);
            self.hull.cameras = Some([before, *camera]);
        }
    }
}

/// The stages to choose from, in the upper left corner of the pane, and what the chosen one shows.
pub(super) fn stage_selector(ui: &mut egui::Ui, rect: egui::Rect, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(scene) = editor.hull_scene() else { return };
    let theme = theme_of(ui);
    let place = egui::Rect::from_min_max(rect.min + egui::vec2(8.0, 8.0), rect.max - egui::vec2(8.0, 8.0));
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(place));
    let frame = egui::Frame::new().fill(theme.panel.gamma_multiply(0.92)).corner_radius(4).inner_margin(6);
    frame.show(&mut ui, |ui| {
        ui.spacing_mut().item_spacing = egui::vec2(2.0, 4.0);
        if scene.has_stages {
            ui.horizontal_wrapped(|ui| {
                for stage in Stage::ALL {
                    let label = ui.selectable_label(editor.hull.stage == stage, stage.title());
                    if label.on_hover_text(stage.about()).clicked() {
                        requests.push(Request::SetStage(stage));
                    }
                }
            });
        }
        ui.add(egui::Label::new(egui::RichText::new(&scene.caption).small().color(theme.weak_text)).wrap());
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::examples::Example;

    #[test]
    fn a_similarity_is_found_again() {
        let disk = DiskMesh::try_from(Example::Ell.mesh()).expect("a disk");
        let before: Vec<DVec2> = disk.vertices().map(|v| disk.position(v).truncate()).collect();
        let turn = DVec2::new(-0.3, 2.0);
        let after: Vec<DVec2> = before.iter().map(|&z| turn.rotate(z) + DVec2::new(5.0, -1.0)).collect();
        let moved = Similarity::between(&disk, &before, &after).moved(&before);
        assert!(moved.iter().zip(&after).all(|(a, b)| a.distance(*b) < 1e-12));
    }

    #[test]
    fn an_embedding_at_one_point_stays_where_it_is() {
        let disk = DiskMesh::try_from(Example::Ell.mesh()).expect("a disk");
        let before = vec![DVec2::ONE; disk.vertex_count()];
        assert_eq!(Similarity::between(&disk, &before, &before).moved(&before), before);
    }
}
