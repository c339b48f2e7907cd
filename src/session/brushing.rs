//! Part: strokes of brushes on the map on the screen, or on a chart of the page. Each frame is proved; a stroke becomes
//! one edit at its end.
//!
//! ```text
//! brush ──▶ job: a frame with the pointer at its newest position ──▶ preview, proved
//!           a newer position replaces one that waits
//! end   ──▶ edit of the document: the map that the user shaped, once no frame is being computed
//! ```
//!
//! A chart of the page is shaped in the plane of its own map, see [`PageStroke`]. Its frames stay on the page.

use std::sync::Arc;

use glam::DVec2;

use super::action::{BrushDab, PageDab};
use super::chart_layout::ChartPlace;
use super::drag_request::Screen;
use super::live::Frame;
use super::page::PageChart;
use super::page_actions::given_place;
use super::page_stroke::{PageStroke, ShapedFrame};
use super::stop::Goal;
use super::{Background, ChartEdits, Command, MessagePlace, Session, Wake};
use freebound_core::bijective::{BrushFrame, BrushKind, BrushSolver, DragFrame};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::{Outcome, Problem, ShapedMap};
use freebound_core::problem::{Control, Embedding};

/// Strokes of brushes.
pub(super) struct Brushing {
    stroke: Option<Stroke>,
    /// Chart that a stroke on the page has shaped, and its problem since then. The page does not have the map yet.
    awaited: Option<(usize, Problem)>,
    frames: Background<(), Option<BrushedFrame>>,
}

/// Frame of a stroke, with the solver for the next one.
struct BrushedFrame {
    solver: BrushSolver,
    frame: BrushFrame,
    /// Frame on the page, judged.
    on_page: Option<ShapedFrame>,
}

/// Stroke in progress.
struct Stroke {
    dab: BrushDab,
    mesh: Arc<DiskMesh>,
    begin: Arc<Embedding>,
    problem: Problem,
    /// Chart of the page. `None` for the map on the screen.
    on_page: Option<PageStroke>,
    /// Solver between frames. `None` before the first frame and while a frame is computed.
    solver: Option<Box<BrushSolver>>,
    /// True if the pointer has moved or presses on since the last frame began.
    is_waiting: bool,
    is_ending: bool,
    /// Newest frame.
    frame: Option<BrushFrame>,
    has_moved: bool,
}

impl Brushing {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { stroke: None, awaited: None, frames: Background::new("brush", wake) }
    }

    /// True while a frame is being computed.
    pub(super) fn is_busy(&self) -> bool {
        self.frames.is_busy()
    }

    /// Drops the stroke. Returns true if there was one.
    pub(super) fn give_up(&mut self) -> bool {
        self.frames.cancel();
        self.stroke.take().is_some()
    }

    /// Computes the next frame, if one is wanted and none is being computed.
    fn start_next(&mut self) {
        let Some(stroke) = self.stroke.as_mut().filter(|stroke| stroke.is_waiting) else { return };
        if self.frames.is_busy() {
            return;
        }
        stroke.is_waiting = false;
        let (mesh, dab, before) = (Arc::clone(&stroke.mesh), stroke.dab, stroke.solver.take());
        let (begin, target) = (Arc::clone(&stroke.begin), stroke.problem.drag_target());
        let among = stroke.on_page.as_ref().map(PageStroke::among);
        self.frames.start((), move |cancel| {
            let solver = before.map(|solver| *solver);
            let first = || BrushSolver::new(&mesh, Embedding::clone(&begin), target, dab.brush, dab.at);
            let mut solver = solver.or_else(first)?;
            let frame = solver.frame(&mesh, dab.at, Control::new(cancel, &|_| {})).ok()?;
            let on_page = among.map(|among| among.judge(solver.embedding(), solver.moved()));
            Some(BrushedFrame { solver, frame, on_page })
        });
    }
}

impl Stroke {
    fn new(dab: BrushDab, mesh: Arc<DiskMesh>, Screen { embedding, problem, .. }: Screen) -> Self {
        Self {
            dab,
            mesh,
            begin: embedding,
            problem,
            on_page: None,
            solver: None,
            is_waiting: true,
            is_ending: false,
            frame: None,
            has_moved: false,
        }
    }

    /// Applies the brush at another position.
    fn follow(&mut self, at: DVec2) {
        if !self.is_ending {
            (self.dab.at, self.is_waiting) = (at, true);
        }
    }

    /// Frame of the preview, with the vertices that have moved.
    fn preview(&self) -> Option<Frame> {
        let (solver, frame) = (self.solver.as_ref()?, self.frame.clone()?);
        let BrushFrame { obstacle, is_at_rest, verdict, .. } = frame;
        let embedding = solver.embedding();
        let moved: Vec<(VertexId, DVec2)> = solver.moved().iter().map(|&v| (v, embedding[v])).collect();
        let result = DragFrame { reached: 1.0, obstacle, is_at_rest, verdict };
        Some(Frame { begin: Arc::clone(&self.begin), moved, problem: self.problem.clone(), result })
    }
}

impl Session {
    /// True if brushes can shape the map on the screen: it is planar, belongs to the document, has no new vertices, and
    /// nothing solves it.
    pub fn can_brush(&self) -> bool {
        self.outcome_to_brush().is_some()
    }

    /// Radius that the newest frame of a stroke used: in the plane of the map on the screen, or in the page's plane.
    pub fn brush_radius(&self) -> Option<f64> {
        let stroke = self.brushing.stroke.as_ref()?;
        let scale = stroke.on_page.as_ref().map_or(1.0, |page| page.placement().scale());
        Some(scale * stroke.frame.as_ref()?.radius)
    }

    /// Stroke on a chart of the page, in progress.
    pub fn page_stroke(&self) -> Option<&PageStroke> {
        self.brushing.stroke.as_ref()?.on_page.as_ref()
    }

    /// True from the first frame of a stroke to its end.
    pub fn is_brushing(&self) -> bool {
        self.brushing.stroke.is_some()
    }

    /// Planar map on the screen that brushes can shape.
    fn outcome_to_brush(&self) -> Option<&Arc<Outcome>> {
        let is_at_rest = !self.is_running() && self.preview().is_none() && !self.history.is_in_gesture();
        if !is_at_rest || !self.is_current() || !self.has_form_as_wanted() {
            return None;
        }
        self.outcome().filter(|outcome| outcome.can_be_saved())
    }

    fn brushed_screen(&self) -> Option<Screen> {
        Screen::of(self.outcome_to_brush()?, self.disk()?.vertex_count())
    }

    /// True if brushes can shape a chart of the page.
    pub fn can_brush_chart(&self, chart: usize) -> bool {
        self.chart_to_brush(chart).is_some()
    }

    /// Chart of the page that brushes can shape.
    fn chart_to_brush(&self, chart: usize) -> Option<&PageChart> {
        let page = self.page().filter(|_| self.can_move_charts() && !self.is_moving_charts())?;
        let on_page = page.charts.get(chart).filter(|on_page| on_page.stacked.is_none())?;
        (on_page.outcome.can_be_saved() && !self.history.is_in_gesture()).then_some(on_page)
    }

    /// Planar map of a chart of the page that brushes can shape, and its stroke.
    fn brushed_chart(&self, chart: usize) -> Option<(Arc<DiskMesh>, Screen, PageStroke)> {
        let on_page = self.chart_to_brush(chart)?;
        let mesh = Arc::clone(on_page.model.disk()?);
        let screen = Screen::of(&on_page.outcome, mesh.vertex_count())?;
        Some((mesh, screen, PageStroke::new(self.page()?, chart)?))
    }

    /// Applies a brush at the pointer: starts a stroke, or continues it.
    pub(super) fn brush(&mut self, dab: BrushDab) {
        if let Some(stroke) = &mut self.brushing.stroke {
            if stroke.on_page.is_none() {
                stroke.follow(dab.at);
            }
        } else if dab.begins {
            let (Some(screen), Some(mesh)) = (self.brushed_screen(), self.disk().cloned()) else { return };
            self.brushing.stroke = Some(Stroke::new(dab, mesh, screen));
        }
        self.brushing.start_next();
    }

    /// Applies a brush to a chart of the page: starts a stroke, or continues it.
    pub(super) fn brush_on_page(&mut self, PageDab { chart, dab, insists }: PageDab) {
        if let Some(stroke) = &mut self.brushing.stroke {
            let is_ending = stroke.is_ending;
            let page = stroke.on_page.as_mut().filter(|page| page.chart() == chart && !is_ending);
            let Some(page) = page else { return };
            page.set_insists(insists);
            let at = page.placement().from_page(dab.at);
            stroke.follow(at);
        } else if dab.begins {
            let Some((mesh, screen, mut page)) = self.brushed_chart(chart) else { return };
            page.set_insists(insists);
            let dab = page.placement().dab_from_page(dab);
            self.brushing.stroke = Some(Stroke { on_page: Some(page), ..Stroke::new(dab, mesh, screen) });
        }
        self.brushing.start_next();
    }

    /// Ends a stroke: it becomes an edit at the next poll that has its newest frame. Not at once, because the window is
    /// drawn by then, and it would not show the run that begins.
    pub(super) fn end_brush(&mut self) {
        if let Some(stroke) = &mut self.brushing.stroke {
            stroke.is_ending = true;
        }
    }

    /// Drops a stroke and shows the map before it.
    pub(super) fn give_up_brush(&mut self) {
        if self.brushing.give_up() {
            self.drag.end();
        }
    }

    /// Shows finished frames, and makes a stroke that has ended an edit.
    pub(super) fn poll_brush(&mut self) {
        if self.brushing.awaited.is_some() && !self.awaits_stroke() {
            self.brushing.awaited = None;
        }
        if self.is_stroke_outdated() {
            return self.give_up_brush();
        }
        match self.brushing.frames.poll() {
            Some(((), Ok(Some(frame)))) => self.take_frame(frame),
            Some(((), Ok(None))) => self.give_up_brush(),
            Some(((), Err(failure))) => {
                self.give_up_brush();
                self.messages.fail_background(MessagePlace::Embedding, "moving vertices with a brush", &failure);
            }
            None => {}
        }
        self.brushing.start_next();
        let is_ending = self.brushing.stroke.as_ref().is_some_and(|stroke| stroke.is_ending);
        if is_ending && !self.brushing.is_busy() {
            self.take_stroke();
        }
    }

    /// True if the document, the mesh or the page has changed since the stroke began.
    fn is_stroke_outdated(&self) -> bool {
        let Some(stroke) = &self.brushing.stroke else { return false };
        let wanted = match &stroke.on_page {
            None => {
                let disk = self.disk().filter(|disk| Arc::ptr_eq(disk, &stroke.mesh));
                disk.map(|_| self.document.problem())
            }
            Some(page) => {
                let is_there = self.can_move_charts() && self.page().is_some_and(|now| now.revision == page.revision());
                self.problem_of_chart(page.chart()).filter(|_| is_there)
            }
        };
        !wanted.is_some_and(|wanted| stroke.problem.has_steps_of(&wanted))
    }

    /// Problem of a chart of the document.
    fn problem_of_chart(&self, chart: usize) -> Option<Problem> {
        let of = self.model()?.prepared.chart.as_ref()?;
        Some(self.document.problem_with(self.document.edits_of(chart, of)))
    }

    /// True if a stroke on the page has ended, and the page does not have its map yet.
    pub fn awaits_stroke(&self) -> bool {
        let awaited = self.brushing.awaited.as_ref();
        awaited.is_some_and(|(chart, problem)| self.problem_of_chart(*chart).as_ref() == Some(problem))
            && !self.can_move_charts()
    }

    fn take_frame(&mut self, BrushedFrame { solver, frame, on_page }: BrushedFrame) {
        let Some(stroke) = &mut self.brushing.stroke else { return };
        stroke.has_moved |= !solver.moved().is_empty();
        let is_accepted = stroke.on_page.as_mut().zip(on_page).is_none_or(|(page, frame)| page.take(frame));
        (stroke.solver, stroke.frame) = (Some(Box::new(solver)), Some(frame));
        if let Some(page) = stroke.on_page.as_mut().filter(|_| !is_accepted && stroke.dab.brush.kind != BrushKind::Grab)
        {
            // The effects of frames add up, so the next frame begins where this one is kept back. A grab follows the
            // pointer back by itself.
            (stroke.begin, stroke.solver) = (page.begin_again(), None);
        }
        let is_on_screen = stroke.has_moved && stroke.on_page.is_none();
        if let Some(frame) = stroke.preview().filter(|_| is_on_screen) {
            self.drag.show_live(frame);
        }
    }

    /// Makes the stroke an edit: the map that the user shaped. All charts stay where they lie on the page.
    fn take_stroke(&mut self) {
        let Some(stroke) = self.brushing.stroke.take() else { return };
        if let Some(page) = stroke.on_page {
            return self.take_page_stroke(page);
        }
        let shaped = stroke.solver.as_ref().map(|solver| solver.embedding().clone());
        let Some(shaped) = shaped.filter(|shaped| *shaped != *stroke.begin) else { return self.drag.end() };
        let mut edits = vec![Command::SetShaped(Some(ShapedMap(Arc::new(shaped)))), Command::SetRelaxed(0)];
        if let Some(layout) = self.layout_as_it_lies() {
            edits.push(Command::SetLayout(Box::new(layout)));
        }
        if self.apply(Command::Together(edits)) {
            // The preview stays until the map arrives with its distortion.
            self.begin_shaped();
        }
    }

    /// Begins the run that shows the shaped map of the shown chart.
    fn begin_shaped(&mut self) {
        self.solving.follow_newest();
        self.begin(Goal::Until(self.stop_conditions()));
    }

    /// Makes a stroke on the page an edit of its chart. The chart keeps the coordinates of the last frame.
    fn take_page_stroke(&mut self, stroke: PageStroke) {
        if let Some(verdict) = stroke.kept_back() {
            self.tell_kept_back(verdict);
        }
        let chart = stroke.chart();
        let Some((shaped, coordinates)) = stroke.into_shaped() else { return };
        let Some(mut layout) = self.layout_as_it_lies() else { return };
        let Some(of) = self.model().and_then(|model| model.prepared.chart.clone()) else { return };
        let first_face = of.charts.first_face(chart);
        let is_locked = layout.lock_of(&of.charts, chart).is_some();
        let places = if is_locked { &mut layout.locked } else { &mut layout.placed };
        // A chart with pins has no entry: its pins place it.
        if let (Some(place), Some(page)) = (places.get_mut(&first_face), self.page()) {
            *place = ChartPlace(given_place(&page.charts[chart], &coordinates));
        }
        let is_shown = of.charts.pick(self.document.chart) == chart;
        let edits = ChartEdits { shaped: Some(ShapedMap(shaped)), relaxed: 0, ..self.document.edits_of(chart, &of) };
        let mut commands = if is_shown {
            vec![Command::SetShaped(edits.shaped), Command::SetRelaxed(0)]
        } else {
            vec![Command::SetElsewhere { chart, edits }]
        };
        commands.push(Command::SetLayout(Box::new(layout)));
        self.remember_charts([chart]);
        if !self.apply(Command::Together(commands)) {
            return;
        }
        self.brushing.awaited = self.problem_of_chart(chart).map(|problem| (chart, problem));
        if is_shown {
            self.begin_shaped();
        }
    }
}
