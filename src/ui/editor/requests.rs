//! Handling of requests by the editor.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::Editor;
use super::appearance::OnPicture;
use crate::session::{Action, BakeRequest, LockState, PatternRequest, SaveRequest, UndoGroup, WaitingLandmark};
use crate::ui::dialogs::DialogChoice;
use crate::ui::state::{FileDialogKind, Half, PageRequest, Pane, PendingClose, Request, StepTarget, Tool, is_picture};
use crate::view::ElementSet;
use freebound_core::mesh::VertexId;
use freebound_core::problem::PinKind;
use freebound_io::PROJECT_EXTENSION;

/// Approximate time to play all steps, seconds.
const PLAY_SECONDS: f64 = 6.0;

/// Least and greatest time that a played step shows, seconds.
const STEP_SECONDS: (f64, f64) = (0.1, 0.8);

/// Extensions of files that a mesh file refers to.
const BESIDE: &[&str] = &["mtl", "bin"];

impl Editor {
    /// Carries out a request.
    #[expect(clippy::too_many_lines, reason = "a line for each request")]
    pub fn handle(&mut self, request: Request) {
        self.keep_selection_kind();
        match request {
            Request::Do(action) => self.act(action),
            Request::RunOrPause => self.run_or_pause(),
            Request::GoToStep(target) => self.go_to_step(target),
            Request::TogglePlay => self.toggle_play(),
            Request::ToggleCurves => self.timeline.curves_wanted = Some(!self.timeline.curves_shown()),
            Request::Curve(request) => self.timeline.handle(request),
            Request::SetTool(tool) => self.take_up_tool(tool),
            Request::SetBrush(brush) => self.tools.brush = brush,
            Request::ResizeBrush { grows } => {
                self.tools.brush = self.tools.brush.resized(if grows { 1.0 } else { -1.0 });
            }
            Request::ClickSeam(click) => self.take_seam_click(click),
            Request::CutByRule(rule) => self.cut_by_rule(rule),
            Request::ClearSeams => self.act(Action::SetSeams(self.without_seams())),
            Request::SetSharp(degrees) => self.tools.seam.rules.degrees = degrees.clamp(0.0, 180.0),
            Request::EndSeam => drop(self.tools.seam.end()),
            Request::SetCreases(share) => self.tools.seam.set_creases(share),
            Request::ToggleErasing => self.tools.seam.toggle_erases(),
            Request::TogglePainting => self.tools.seam.toggle_paints(),
            Request::TakeVertex(vertex) => self.take_vertex(vertex),
            Request::SetShading(shading) => self.shade(shading),
            Request::SetPaneShading(pane, shading) => self.shade_pane(pane, shading),
            Request::ShowColumn(place) => self.show_column(place),
            Request::ToggleWireframe => self.pane_shading.wireframe = !self.pane_shading.wireframe,
            Request::ToggleEase => self.pane_shading.glides = !self.pane_shading.glides,
            Request::ToggleThrough => self.selection.through ^= true,
            Request::ToggleOutsideHull => self.selection.marks_outside_hull ^= true,
            Request::ToggleMagnifier => self.pane_shading.magnifier = !self.pane_shading.magnifier,
            Request::ZoomInset(of, by) => self.layout.insets.bring_nearer(of, by),
            Request::PanInset(drag) => self.layout.insets.pan(drag),
            Request::ToggleHull => self.plane.toggle_hull(),
            Request::SetStage(stage) => self.plane.set_stage(stage),
            Request::ShowTab(tab) => self.layout.show_tab(tab),
            Request::TogglePanels => self.layout.toggle_panels(),
            Request::Frame => self.frame(),
            Request::GoTo(vertices) => self.go_to_vertices(vertices),
            Request::GoToFileFaces(faces) => self.go_to_file_faces(&faces),
            Request::GoToFileVertices(numbers) => self.go_to_file_vertices(numbers),
            Request::GoToDefect(place) => self.go_to_defect(place),
            Request::StepChart(by) => self.step_chart(by),
            Request::ToggleLock => self.toggle_lock(),
            Request::StepDefect(by) => self.step_defect(by),
            Request::SelectBy(by) => self.select_by(by),
            Request::Select(vertices) => self.selection.select(vertices),
            Request::AddToSelection(vertices) => self.selection.add(vertices),
            Request::ToggleSelected(vertex) => self.selection.toggle(vertex),
            Request::SetSelectionKind(kind) => self.set_selection_kind(kind),
            Request::SelectElement { element, adds } => self.select_element(element, adds),
            Request::SelectNothing => self.set_elements(ElementSet::default()),
            Request::AddElements(elements) => self.add_elements(&elements),
            Request::CutSelection => self.cut_selection(),
            Request::JoinSelection => self.join_selection(),
            Request::Nudge(nudge) => self.nudge(nudge),
            Request::EndNudge => self.end_nudge(),
            Request::TakeLandmark { after } => self.take_landmark(after),
            Request::SetPinKind(kind) => self.set_pin_kind(kind),
            Request::SetOpacity(opacity) => self.appearance_mut().opacity = opacity.clamp(0.0, 1.0),
            Request::Checker(request) => self.handle_checker(request),
            Request::ToggleSharp => self.pane_shading.toggle_sharp(),
            Request::FixSelection => self.fix_selection(),
            Request::UnpinSelected => self.unpin_selected(),
            Request::UnpinAll => self.unpin_all(),
            Request::Escape => self.escape(),
            Request::Page(request) => self.handle_page(request),
            Request::ToggleFull(pane) => self.layout.toggle_full(pane),
            Request::TogglePane => {
                let pane = self.pointer.pane().unwrap_or(Pane::Plane);
                self.handle(Request::ToggleFull(pane));
            }
            Request::ToggleComparison => self.toggle_comparison(),
            Request::ToggleContender(variant) => self.toggle_contender(variant),
            Request::TakeContender(variant) => self.act(self.take_contender(&variant)),
            Request::ColourComparison(quantity) => self.plane.comparison.colour_by(quantity),
            Request::SortComparison(column) => self.plane.comparison.sort_by(column),
            Request::ToggleComparisonTable => self.plane.comparison.toggle_table(),
            Request::Morph(request) => self.morph(request),
            Request::CopyCommandLine => self.copy_command_line(),
            Request::Ask(kind) => self.ask(kind),
            Request::SaveProject => self.save_project(),
            Request::ToggleExports => self.layout.exports_shown = !self.layout.exports_shown,
            Request::ToggleOptions(of) => {
                self.layout.exports_shown = false;
                self.files.options_shown = Some(of).filter(|_| self.files.options_shown != Some(of));
            }
            Request::Answer(answer) => self.answer(answer),
            Request::LeaveFaces => self.opened.leave_faces(&self.session),
            Request::LeaveTargets => self.opened.leave_targets(&self.session),
            Request::CloseMapOrigin => self.opened.close_map_origin(&self.session),
            Request::AskGoTo => self.layout.ask_go_to(),
            Request::OpenMenu(place) => self.layout.menu_asked = Some(place),
            Request::ToggleKeys => self.layout.keys_shown = !self.layout.keys_shown,
            Request::ToggleWelcome => self.layout.welcome.toggle(),
            Request::ToggleWelcomeAtStart => self.layout.welcome.at_start = !self.layout.welcome.at_start,
            Request::TogglePalette => self.layout.help.toggle_palette(),
            Request::ShowDocumentation(place) => self.layout.help.show_documentation(place),
            Request::ToggleLog => self.layout.help.log_shown ^= true,
            Request::ToggleAbout => self.layout.help.about_shown ^= true,
            Request::StartTour => self.layout.start_tour(),
            Request::SetTheme(theme) => self.gpu.context().set_theme(theme),
            Request::SetFit(fit) => self.files.fit = fit,
            Request::Quit => self.close_or_ask(PendingClose::Quit),
        }
    }

    pub(in crate::ui) fn ask(&mut self, kind: FileDialogKind) {
        self.layout.exports_shown = false;
        let project = self.session.project_path().filter(|_| kind == FileDialogKind::SaveProject);
        let suggestion = project.cloned().unwrap_or_else(|| self.suggested_name(kind));
        self.files.dialogs.ask(&self.gpu.wake(), kind, suggestion);
    }

    /// Opens, saves or exports the file that the user chose in a dialog.
    pub fn take_choice(&mut self, choice: DialogChoice) {
        let DialogChoice { kind, path } = choice;
        if !kind.takes(&path) {
            return self.act(Action::RefuseName(path));
        }
        match kind {
            FileDialogKind::Open => self.act(Action::Open(path)),
            FileDialogKind::OpenPicture => self.act(Action::OpenPicture(path)),
            FileDialogKind::LocatePicture => self.act(Action::LocatePicture(path)),
            FileDialogKind::LocateMesh => self.act(Action::LocateMesh(path)),
            FileDialogKind::CopyLayout => self.act(Action::CopyLayout(path)),
            FileDialogKind::ImportConstraints => self.act(Action::ImportConstraints(path)),
            FileDialogKind::ExportConstraints => self.act(Action::ExportConstraints(path)),
            FileDialogKind::ImportSeams => self.act(Action::ImportSeams(path)),
            FileDialogKind::ExportSeams => self.act(Action::ExportSeams(path)),
            FileDialogKind::SaveProject => {
                self.keep_view();
                self.act(Action::SaveProject(path));
            }
            FileDialogKind::FlatMesh => self.act(Action::SaveFlatMesh(path)),
            FileDialogKind::Pattern => {
                self.files.options_shown = None;
                let options = self.files.pattern;
                self.act(Action::SavePattern(PatternRequest { path, options }));
            }
            FileDialogKind::Baked => self.export_baked(path),
            FileDialogKind::PanePicture(pane) => self.shoot_pane(pane, path),
            FileDialogKind::Curves(what) => self.export_curves(what, path),
            FileDialogKind::OpenTable => self.open_table(path),
            FileDialogKind::OpenChecker => self.open_checker(path),
            FileDialogKind::LinearSystem => self.export_linear_system(path),
            FileDialogKind::StepPictures => self.export_step_pictures(&path),
            FileDialogKind::Comparison(what) => self.export_comparison(what, path),
            FileDialogKind::Export(output, fit) => {
                let fit = fit.unwrap_or(self.files.fit);
                self.act(Action::Save(SaveRequest { path, kind: output, fit }));
            }
        }
    }

    /// Requests for files dropped on the window, by their extensions. One mesh or project is opened. Pictures and
    /// constraints belong to it, or to the open document if no mesh is dropped. Edges belong to the open document.
    pub(in crate::ui) fn dropped(paths: Vec<PathBuf>) -> Vec<Request> {
        let is_for = |kind: FileDialogKind| move |path: &PathBuf| kind.form().fits(path);
        let (pictures, others): (Vec<PathBuf>, Vec<PathBuf>) = paths.into_iter().partition(|path| is_picture(path));
        let is_constraints = is_for(FileDialogKind::ImportConstraints);
        let (constraints, others): (Vec<_>, Vec<_>) =
            others.into_iter().partition(|path| is_constraints(path) && !has_extension(path, &[PROJECT_EXTENSION]));
        let (edges, mut meshes): (Vec<_>, Vec<_>) = others.into_iter().partition(is_for(FileDialogKind::ImportSeams));
        // A project names its mesh, so projects come first.
        meshes.sort_by_key(|path| !has_extension(path, &[PROJECT_EXTENSION]));
        if meshes.iter().any(|path| !has_extension(path, BESIDE)) {
            meshes.retain(|path| !has_extension(path, BESIDE));
        }
        let (mut pictures, mut meshes) = (pictures.into_iter(), meshes.into_iter());
        let beside = pictures.len() + constraints.len() + edges.len();
        let actions: Vec<Action> = match (meshes.next(), beside + meshes.len()) {
            (None, _) => pictures
                .map(Action::OpenPicture)
                .chain(constraints.into_iter().map(Action::ImportConstraints))
                .chain(edges.into_iter().map(Action::ImportSeams))
                .collect(),
            (Some(mesh), 0) => vec![Action::Open(mesh)],
            (Some(mesh), _) => {
                let picture = pictures.next();
                let left = meshes.chain(pictures).chain(edges).collect();
                vec![Action::OpenTogether(UndoGroup { mesh, picture, constraints, left })]
            }
        };
        actions.into_iter().map(Request::Do).collect()
    }

    /// Shows the chart `by` places after the current one, cyclically; on the page, selects it.
    fn step_chart(&mut self, by: isize) {
        let count = self.session.charts().map(|charts| charts.count());
        let of_elements = || self.charts_of_elements().first().copied();
        let selected = self.plane.page.selected().first().copied().or_else(of_elements);
        let selected = selected.filter(|_| self.shows_page());
        let Some((count, now)) = count.zip(selected.or(self.session.chart_on_screen())) else { return };
        let next = (now.cast_signed() + by).rem_euclid(count.cast_signed()).cast_unsigned();
        if self.shows_page() {
            self.handle_page(PageRequest::Pick { chart: Some(next), adds: false });
        } else {
            self.act(Action::ShowChart(next));
        }
    }

    /// Locks the selected charts of the page, or the chart on the screen; or unlocks them if all are locked.
    fn toggle_lock(&mut self) {
        let charts = self.charts_to_work_on();
        let lock = charts.iter().any(|&chart| self.session.lock_state(chart) == LockState::Open);
        self.act(Action::LockCharts { charts, lock });
    }

    /// Selected charts of the page, or the chart on the screen if the page is not shown.
    pub(in crate::ui) fn charts_to_work_on(&self) -> BTreeSet<usize> {
        if self.shows_page() {
            self.plane.page.selected().clone()
        } else {
            self.session.chart_on_screen().into_iter().collect()
        }
    }

    fn set_pin_kind(&mut self, kind: PinKind) {
        if kind != PinKind::Fixed {
            self.tools.set_pin_kind(kind);
        }
        let vertices: Vec<VertexId> = self.pins_selected().collect();
        self.act(Action::SetPinKind { vertices, kind });
    }

    pub(super) fn act(&mut self, action: Action) {
        if matches!(action, Action::Step | Action::Run | Action::Relax | Action::Repair | Action::ShowStep(_)) {
            self.timeline.playing_since = None;
        }
        let action = match action {
            Action::Open(path) if is_picture(&path) => Action::OpenPicture(path),
            other => other,
        };
        if matches!(action, Action::OpenPicture(_)) {
            self.pane_shading.usual.on_picture = OnPicture::Shows;
        }
        let opens = matches!(action, Action::Open(_) | Action::OpenTogether(_) | Action::OpenExample(_));
        if opens || matches!(action, Action::Recover(_) | Action::LocateMesh(_) | Action::LocatePicture(_)) {
            return self.close_or_ask(PendingClose::Do(action));
        }
        if self.drop_gesture() && matches!(action, Action::Undo | Action::Redo) {
            // A gesture that has not ended is no edit yet.
            return;
        }
        let before = self.session.document().frame();
        let landmark = self.landmark_taken();
        self.session.handle(action);
        self.let_go_of_vertices();
        if landmark.is_some() && self.landmark_taken() != landmark {
            self.tools.set_pair(None);
        }
        let after = self.session.document().frame();
        if before.aspect.to_bits() == after.aspect.to_bits() {
            // If the direction of v changes, the picture moves in the plane. Move the cameras so that it stays on the
            // screen.
            self.plane.go_along(after.corners()[0] - before.corners()[0]);
        }
    }

    /// File name suggested from the mesh on the screen.
    fn suggested_name(&self, kind: FileDialogKind) -> PathBuf {
        let ending = kind.form().ending;
        let Some(model) = self.session.model() else { return PathBuf::from(format!("layout{ending}")) };
        let stem = Path::new(&model.name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = model.path.as_ref().and_then(|path| path.parent()).map(PathBuf::from).unwrap_or_default();
        folder.join(format!("{stem}{ending}"))
    }

    fn take_vertex(&mut self, vertex: VertexId) {
        self.tools.take_up(Tool::Constrain);
        self.tools.set_pair(Some(Half::Vertex(vertex)));
        self.selection.select([vertex]);
    }

    /// Landmark that waits for a click on its vertex.
    pub(in crate::ui) fn landmark_taken(&self) -> Option<WaitingLandmark> {
        match self.tools.pair() {
            Some(Half::Target(uv)) => self.session.landmark_at(uv),
            _ => None,
        }
    }

    /// Lets the next landmark wait for a click on its vertex.
    fn take_landmark(&mut self, after: Option<DVec2>) {
        let Some(landmark) = self.session.next_landmark(after) else { return };
        self.tools.take_up(Tool::Constrain);
        self.tools.set_pair(Some(Half::Target(landmark.uv)));
        self.selection.select([]);
    }

    fn export_baked(&mut self, path: PathBuf) {
        self.files.options_shown = None;
        if let Some(picture) = &self.session.document().picture {
            let options = self.files.baked.options(&picture.pixels);
            self.act(Action::SaveBaked(BakeRequest { path, options }));
        }
    }

    fn escape(&mut self) {
        let closes = self.close_question()
            || self.leave_large()
            || self.files.dialogs.close()
            || self.files.options_shown.take().is_some();
        if closes || self.layout.close_window() || self.timeline.close_curve() || self.drop_gesture() {
        } else if self.session.is_brushing() {
            self.act(Action::GiveUpBrush);
        } else if self.tools.end_drag() {
            self.act(Action::GiveUpGesture);
        } else if self.pointer.end_region() {
        } else if self.tools.pair().is_some() {
            self.tools.set_pair(None);
        } else if self.tools.seam.end() || self.leave_morph() || self.leave_comparison() {
        } else if self.tools.tool() != Tool::Select {
            self.tools.take_up(Tool::Select);
        } else if self.shows_page() {
            self.set_elements(ElementSet::default());
        } else if self.selection.vertices().is_empty() && self.session.charts().is_some() {
            self.handle_page(PageRequest::Show(true));
        } else {
            self.selection.select([]);
        }
    }
}

/// Moves along the steps of a run.
impl Editor {
    /// True if the open mesh is a disk and can be solved. The timeline then shows, so that the panes have their final
    /// size before the first step.
    pub fn has_disk(&self) -> bool {
        self.session.model().is_some_and(|model| model.disk().is_some())
    }

    /// True for each direction with a kept step: before and after the step on the screen.
    pub(in crate::ui) fn steps_around(&self) -> [bool; 2] {
        let timeline = self.session.timeline();
        let Some(shown) = timeline.shown() else { return [false; 2] };
        [timeline.previous_kept(shown).is_some(), timeline.next_kept(shown).is_some()]
    }

    pub(super) fn go_to_step(&mut self, target: StepTarget) {
        self.timeline.playing_since = None;
        let timeline = self.session.timeline();
        let Some(shown) = timeline.shown() else { return };
        let wanted = match target {
            StepTarget::First => Some(0),
            StepTarget::Previous => timeline.previous_kept(shown),
            StepTarget::Next => timeline.next_kept(shown),
            StepTarget::Last => timeline.newest(),
        };
        if let Some(index) = wanted {
            self.session.handle(Action::ShowStep(index));
        }
    }

    pub(super) fn run_or_pause(&mut self) {
        self.timeline.playing_since = None;
        self.session.handle(if self.session.is_running() { Action::Cancel } else { Action::Run });
    }

    /// Plays the steps from the step on the screen, or from the first if no step follows; or stops playing.
    pub(super) fn toggle_play(&mut self) {
        let timeline = self.session.timeline();
        let Some(shown) = timeline.shown() else { return };
        if self.timeline.playing_since.take().is_some() {
            return;
        }
        if timeline.next_kept(shown).is_none() {
            self.session.handle(Action::ShowStep(0));
        }
        self.timeline.playing_since = Some(self.gpu.now());
    }

    /// Shows the next step when it is due and the step before has arrived. Call once per frame.
    pub(super) fn go_on_playing(&mut self) {
        let Some(since) = self.timeline.playing_since else { return };
        self.gpu.context().request_repaint();
        let timeline = self.session.timeline();
        let Some(next) = timeline.shown().and_then(|shown| timeline.next_kept(shown)) else {
            self.timeline.playing_since = None;
            return;
        };
        let now = self.gpu.now();
        if now - since >= self.pace() && !self.plane.is_moving(&self.session) {
            self.session.handle(Action::ShowStep(next));
            self.timeline.playing_since = Some(now);
        }
    }

    /// Time that a played step shows, seconds.
    pub(super) fn pace(&self) -> f64 {
        let gaps = self.session.timeline().kept().count().max(2) - 1;
        (PLAY_SECONDS / gaps as f64).clamp(STEP_SECONDS.0, STEP_SECONDS.1)
    }
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let extension = path.extension().unwrap_or_default();
    extensions.iter().any(|other| extension.eq_ignore_ascii_case(other))
}
