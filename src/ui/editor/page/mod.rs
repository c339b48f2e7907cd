//! State of the page: all charts as they lie on it, in both panes, and the selected charts.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | camera, scene, colours, selection |
//! | `scene.rs` | data for drawing and picking all charts |
//! | `actions.rs` | handling of requests to the page |
//! | `gestures.rs` | gestures that move charts |
//! | `numbered.rs` | numbers in the file of the elements |
//! | `pins.rs` | pins of the charts |

mod actions;
mod gestures;
mod numbered;
mod pins;
mod scene;

use std::collections::BTreeSet;
use std::sync::Arc;

use eframe::egui;
use glam::DVec2;

pub(super) use self::numbered::NumberedPage;
pub(in crate::ui) use self::scene::PageScene;

use self::scene::{PageKey, PageSpace};
use super::async_scene::AsyncScene;
use super::checker::ALONG_PAGE;
use super::colour_table::ShownColumn;
use super::drawn_elements::DrawnElements;
use super::file_elements::FileElements;
use super::paint::Legend;
use super::scene::MeshScene;
use crate::session::{ChartMove, JobFailure, Session, Wake};
use crate::ui::state::{PageGesture, Pane, PaneView, ShadingMode, Snap};
use crate::view::{EdgeList, ElementSet, FacePaint, PlaneArrays, PlaneCamera, Revision};
use freebound_core::geom::Bounds;
use freebound_core::mesh::VertexId;
use freebound_core::problem::Embedding;

/// Least half of a framed part of the page or of the mesh, relative to the whole.
pub(super) const LEAST_SHARE: f64 = 0.05;

/// Page in the window.
#[derive(Debug)]
pub struct PageView {
    /// Place and camera of the page in the embedding pane.
    pub pane: PaneView<PlaneCamera>,
    /// Last camera that the window chose, not the user.
    framed: Option<PlaneCamera>,
    /// True unless the user has chosen to see the chart on the screen alone.
    is_wanted: bool,
    scene: Option<Arc<PageScene>>,
    job: AsyncScene<PageKey, PageScene>,
    selection: PageSelection,
    gesture: Option<PageGesture>,
    /// Movements of the last frame of a gesture, and true if charts may overlap there.
    asked: Option<(Vec<ChartMove>, bool)>,
    moved: Option<MovedPlane>,
    snap: Snap,
    paints: [Option<PagePaint>; 2],
}

/// Selection on the page.
#[derive(Debug, Default)]
struct PageSelection {
    charts: Outlined,
    /// Chart under the pointer, in either pane.
    hovered: Outlined,
    /// Vertices, edges or faces, by their numbers on a scene.
    elements: DrawnElements,
    /// Elements by their numbers in the file, from a cut until the user selects others.
    of_file: Option<FileElements>,
    /// Last scene. The page has none for a while if a chart is solved again.
    scene: Option<Arc<PageScene>>,
}

impl PageSelection {
    /// Keeps the charts that a scene has, and the elements. If the mesh is cut in another way, the elements are found by
    /// their numbers in the file. Elements of steps with other new vertices become their vertices.
    fn keep_on(&mut self, scene: &Arc<PageScene>) {
        let before = self.scene.replace(Arc::clone(scene));
        let count = scene.spans.len();
        for outlined in [&mut self.charts, &mut self.hovered] {
            outlined.charts.retain(|&chart| chart < count);
        }
        let Some(before) = before.filter(|before| before.is_of_file_of(scene)) else {
            return self.select(ElementSet::default(), None);
        };
        if !before.is_cut_like(scene) {
            let of_file = self.of_file.take();
            let of_file =
                of_file.unwrap_or_else(|| FileElements::new(self.elements.get(), &NumberedPage::new(&before)));
            self.elements.set(of_file.on(&NumberedPage::new(scene)), Some(scene.mesh.revision));
            self.of_file = Some(of_file);
        } else if before.has_numbers_of(scene) {
            self.elements.stay_on(scene.mesh.revision);
        } else {
            let places = self.elements.get().vertices().iter().filter_map(|&vertex| before.on_chart(vertex));
            let kept: Vec<VertexId> = places.filter_map(|(chart, vertex)| scene.of_chart(chart, vertex)).collect();
            self.elements.set(ElementSet::of_vertices(kept), None);
        }
    }

    /// Selects exactly these elements, which were found on the mesh with these arrays.
    fn select(&mut self, elements: ElementSet, found_on: Option<Revision>) {
        self.elements.set(elements, found_on);
        self.of_file = None;
    }
}

/// Set of charts, with their outlines on a scene.
#[derive(Debug, Default)]
struct Outlined {
    charts: BTreeSet<usize>,
    outlines: Option<(PageKey, Arc<EdgeList>)>,
}

impl Outlined {
    fn of(charts: impl IntoIterator<Item = usize>, count: usize) -> Self {
        Self { charts: charts.into_iter().filter(|&chart| chart < count).collect(), outlines: None }
    }

    /// Finds the outlines on a scene.
    fn refresh(&mut self, scene: Option<&PageScene>) {
        let Some(scene) = scene.filter(|_| !self.charts.is_empty()) else {
            self.outlines = None;
            return;
        };
        if self.outlines.as_ref().is_none_or(|(key, _)| *key != scene.key) {
            self.outlines = Some((scene.key, Arc::new(scene.edges_of(&self.charts))));
        }
    }
}

/// Arrays of the plane while charts move or a brush shapes a chart, with the coordinates that they show.
#[derive(Debug)]
struct MovedPlane {
    key: PageKey,
    coordinates: MovedCharts,
    plane: Arc<PlaneArrays>,
}

impl MovedPlane {
    fn new(scene: &PageScene, coordinates: MovedCharts) -> Self {
        Self { key: scene.key, plane: Arc::new(scene.moved(&coordinates)), coordinates }
    }
}

/// Charts at other texture coordinates.
type MovedCharts = Vec<(usize, Arc<Embedding>)>;

/// Colours of all faces.
#[derive(Debug)]
struct PagePaint {
    key: PageKey,
    shading: ShadingMode,
    /// Number of changes of the shown column.
    column: u64,
    faces: Arc<FacePaint>,
    legend: Option<Legend>,
}

/// Queries of the page.
impl PageView {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            pane: PaneView::default(),
            framed: None,
            is_wanted: true,
            scene: None,
            job: AsyncScene::new("page scene", wake),
            selection: PageSelection::default(),
            gesture: None,
            asked: None,
            moved: None,
            snap: Snap::default(),
            paints: [None, None],
        }
    }

    /// Scene of all charts.
    pub(in crate::ui) fn scene(&self) -> Option<&Arc<PageScene>> {
        self.scene.as_ref()
    }

    /// Selected charts.
    pub fn selected(&self) -> &BTreeSet<usize> {
        &self.selection.charts.charts
    }

    /// Selected vertices, edges or faces of the page, by their numbers on the scene.
    pub fn elements(&self) -> &ElementSet {
        self.selection.elements.get()
    }

    /// Edges of the selected elements.
    pub(in crate::ui) fn element_lines(&self) -> Option<&Arc<EdgeList>> {
        self.selection.elements.lines(self.scene.as_ref()?.mesh.revision)
    }

    /// Chart under the pointer.
    pub fn hovered(&self) -> Option<usize> {
        self.selection.hovered.charts.first().copied()
    }

    pub(in crate::ui) fn set_hovered(&mut self, chart: Option<usize>) {
        if self.hovered() != chart {
            self.selection.hovered = Outlined::of(chart, self.count());
        }
    }

    fn count(&self) -> usize {
        self.scene.as_ref().map_or(0, |scene| scene.spans.len())
    }

    /// Places that moved charts snap to.
    pub fn snap(&self) -> Snap {
        self.snap
    }

    /// Gesture in progress.
    pub(in crate::ui) fn gesture(&self) -> Option<&PageGesture> {
        self.gesture.as_ref()
    }

    /// Arrays of the plane, with charts where they are moved.
    pub fn plane(&self) -> Option<&Arc<PlaneArrays>> {
        let scene = self.scene.as_ref()?;
        let moved = self.moved.as_ref().filter(|moved| moved.key == scene.key);
        Some(moved.map_or(&scene.plane, |moved| &moved.plane))
    }

    /// Colours of the faces in a pane.
    pub(in crate::ui) fn paint(&self, pane: Pane) -> Option<&Arc<FacePaint>> {
        self.paints[pane as usize].as_ref().map(|paint| &paint.faces)
    }

    /// Legend of the shading of a pane.
    pub(in crate::ui) fn legend(&self, pane: Pane) -> Option<&Legend> {
        self.paints[pane as usize].as_ref()?.legend.as_ref()
    }

    /// Outlines of the selected charts.
    pub(in crate::ui) fn selected_outlines(&self) -> Option<&Arc<EdgeList>> {
        self.selection.charts.outlines.as_ref().map(|(_, outlines)| outlines)
    }

    /// Outlines of the chart under the pointer.
    pub(in crate::ui) fn hovered_outlines(&self) -> Option<&Arc<EdgeList>> {
        self.selection.hovered.outlines.as_ref().map(|(_, outlines)| outlines)
    }

    /// Side length of a check: the height of the page divided by the chosen number, or a power of two of the height
    /// of all charts.
    pub(in crate::ui) fn check_size(&self, squares: Option<u32>) -> f64 {
        if let Some(squares) = squares {
            return 1.0 / f64::from(squares);
        }
        let extent = self.scene.as_ref().map_or(1.0, |scene| scene.plane.bounds.extent());
        extent.log2().round().exp2() / f64::from(ALONG_PAGE)
    }

    /// True if the drawn page is the page of the session.
    pub fn is_drawn(&self, session: &Session) -> bool {
        let key = key_of(session);
        key.is_none()
            || self.scene.as_ref().map(|scene| scene.key) == key
            || key.is_some_and(|key| self.job.has_failed(&key))
    }
}

fn key_of(session: &Session) -> Option<PageKey> {
    Some(PageKey { page: session.page()?.revision, model: session.model_revision() })
}

/// Updates of the page.
impl PageView {
    pub(super) fn is_making(&self) -> bool {
        self.job.is_busy()
    }

    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// Drops the page of a document that is no longer open.
    pub(super) fn forget(&mut self) {
        (self.scene, self.moved, self.gesture, self.framed) = (None, None, None, None);
        self.selection = PageSelection::default();
        self.pane.forget_camera();
        self.job.cancel();
        self.is_wanted = true;
    }

    /// Adopts finished scenes, and starts a job if the session has another page. `given` is the mesh on the screen.
    /// Call once per frame.
    pub(super) fn refresh(&mut self, session: &Session, given: Option<&Arc<MeshScene>>) {
        if session.page().is_none() {
            (self.scene, self.moved) = (None, None);
        }
        if let Some((_, scene)) = self.job.poll() {
            self.take(scene);
        }
        let wanted = key_of(session).zip(session.page());
        let given = given.filter(|given| given.model_revision == session.model_revision());
        if let Some(((key, page), given)) = wanted.zip(given)
            && self.scene.as_ref().is_none_or(|scene| scene.key != key)
        {
            let (page, before) = (page.clone(), self.scene.clone());
            let space = PageSpace { unit: given.unit(), sphere: given.sphere };
            self.job.make(key, move |_| PageScene::new(key, &page, space, before.as_deref()));
        }
        self.refresh_moved(session);
        let PageSelection { charts, hovered, elements, .. } = &mut self.selection;
        for outlined in [charts, hovered] {
            outlined.refresh(self.scene.as_deref());
        }
        if let Some(scene) = &self.scene {
            elements.refresh(scene.mesh.revision, || scene.elements());
        }
    }

    fn take(&mut self, scene: PageScene) {
        let scene = Arc::new(scene);
        self.selection.keep_on(&scene);
        let bounds = scene.whole();
        self.scene = Some(scene);
        self.moved = None;
        if self.pane.camera().is_none() {
            self.set_framed(PlaneCamera::framing(bounds, self.pane.size()));
        }
    }

    /// Draws charts where an accepted frame of a move or of a stroke has them. They stay there until the next scene.
    fn refresh_moved(&mut self, session: &Session) {
        let Some(scene) = &self.scene else { return };
        if let Some(stroke) = session.page_stroke() {
            let Some(coordinates) = stroke.coordinates() else {
                self.moved = None;
                return;
            };
            let is_shown = |moved: &MovedPlane| {
                moved.key == scene.key && moved.coordinates.first().is_some_and(|(_, at)| Arc::ptr_eq(at, coordinates))
            };
            if !self.moved.as_ref().is_some_and(is_shown) {
                let stacked = stroke.stacked_coordinates(coordinates).map(|(chart, at)| (chart, Arc::new(at)));
                let all = std::iter::once((stroke.chart(), Arc::clone(coordinates))).chain(stacked);
                self.moved = Some(MovedPlane::new(scene, all.collect()));
            }
            return;
        }
        let Some(state) = session.move_state() else {
            // The page shows the document again: the move or the stroke was dropped, or kept back.
            if self.asked.take().is_none() && !self.job.is_busy() && !session.awaits_stroke() {
                self.moved = None;
            }
            return;
        };
        let Some(coordinates) = state.accepted.as_ref().map(|judged| &judged.coordinates) else { return };
        let is_shown = |moved: &MovedPlane| {
            let mut pairs = moved.coordinates.iter().zip(coordinates);
            moved.key == scene.key
                && moved.coordinates.len() == coordinates.len()
                && pairs.all(|(shown, wanted)| shown.0 == wanted.0 && Arc::ptr_eq(&shown.1, &wanted.1))
        };
        if !self.moved.as_ref().is_some_and(is_shown) {
            self.moved = Some(MovedPlane::new(scene, coordinates.clone()));
        }
    }

    /// Recolours the faces of a pane if the scene or the shading has changed.
    pub(super) fn refresh_paint(&mut self, pane: Pane, shading: ShadingMode, column: Option<ShownColumn<'_>>) {
        let Some(scene) = &self.scene else { return };
        let column = column.filter(|_| shading == ShadingMode::Column);
        let is_by_number = shading.quantity().is_some() || column.is_some();
        let shading = if is_by_number { shading } else { ShadingMode::Plain };
        let revision = column.map_or(0, |column| column.revision);
        let fits = |paint: &PagePaint| paint.key == scene.key && paint.shading == shading && paint.column == revision;
        if !self.paints[pane as usize].as_ref().is_some_and(fits) {
            let (faces, legend) = match column {
                Some(column) => scene.paint_by_column(column),
                None => scene.paint(shading),
            };
            let faces = Arc::new(faces);
            self.paints[pane as usize] = Some(PagePaint { key: scene.key, shading, column: revision, faces, legend });
        }
    }

    /// Selects exactly these charts.
    pub(super) fn select(&mut self, charts: impl IntoIterator<Item = usize>) {
        self.selection.charts = Outlined::of(charts, self.count());
    }

    /// Selects exactly these elements.
    pub(super) fn select_elements(&mut self, elements: ElementSet) {
        let found_on = self.scene.as_ref().map(|scene| scene.mesh.revision);
        self.selection.select(elements, found_on);
    }

    /// Sets a camera that the window chose.
    fn set_framed(&mut self, camera: PlaneCamera) {
        self.pane.set_camera(camera);
        self.framed = Some(camera);
    }

    /// Frames the selected charts or elements, or the whole page if nothing is selected.
    pub(super) fn frame_selection(&mut self) {
        let Some(scene) = &self.scene else { return };
        let all = scene.whole();
        let vertices = self.elements().vertices();
        let bounds = if !self.selected().is_empty() {
            Some(widened(scene.bounds_of(self.selected().iter().copied())))
        } else if !vertices.is_empty() {
            let tight = Bounds::of(vertices.iter().filter_map(|&vertex| scene.place_of(vertex)));
            let half = DVec2::splat(LEAST_SHARE * all.extent());
            let around = Bounds { low: tight.middle() - half, high: tight.middle() + half };
            Some(widened(tight).union(around))
        } else {
            None
        };
        let (Some(mut camera), size) = (self.pane.camera(), self.pane.size()) else { return };
        camera.frame(bounds.unwrap_or(all), size);
        if bounds.is_none() { self.set_framed(camera) } else { self.pane.set_camera(camera) }
    }

    /// Sets the place of the page. Keeps the whole page in view, unless the user has moved the camera.
    pub(in crate::ui) fn set_rect(&mut self, rect: egui::Rect) {
        let was_framed = self.framed.is_some() && self.pane.camera() == self.framed;
        if self.pane.set_rect(rect)
            && was_framed
            && let (Some(scene), Some(mut camera)) = (&self.scene, self.pane.camera())
        {
            camera.frame(scene.whole(), self.pane.size());
            self.set_framed(camera);
        }
    }
}

/// Box with some room around charts.
fn widened(bounds: Bounds) -> Bounds {
    let by = 0.15 * bounds.size();
    Bounds { low: bounds.low - by, high: bounds.high + by }
}
