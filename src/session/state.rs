//! Session: carries out requests by its parts.

use std::time::Instant;

use super::atlas_view::AtlasViews;
use super::background_jobs::BackgroundJobs;
use super::brushing::Brushing;
use super::charts::OtherCharts;
use super::comparing::Comparing;
use super::drag::Drag;
use super::exports::Export;
use super::files::Files;
use super::landmarks::Landmarks;
use super::layout_check::LayoutCheck;
use super::morphing::Morphing;
use super::open_mesh::OpenMesh;
use super::page::PagePart;
use super::solving::Solving;
use super::target_checks::TargetChecks;
use super::unwrapping::Unwrapping;
use super::v_axis::TurnedV;
use super::{Action, Document, History, Messages, RecentFiles, TIMELINE_BUDGET, Wake};

/// Open document and the work on it.
pub struct Session {
    pub(super) mesh: OpenMesh,
    pub(super) document: Document,
    pub(super) history: History,
    /// Run of the document with its steps.
    pub(super) solving: Solving,
    pub(super) charts: OtherCharts,
    pub(super) atlas_views: AtlasViews,
    pub(super) page: PagePart,
    pub(super) comparing: Comparing,
    pub(super) morphing: Morphing,
    pub(super) drag: Drag,
    pub(super) brushing: Brushing,
    pub(super) jobs: BackgroundJobs,
    pub(super) target_checks: TargetChecks,
    pub(super) landmarks: Landmarks,
    pub(super) files: Files,
    pub(super) messages: Messages,
    pub(super) turned_v: TurnedV,
    pub(super) unwrapping: Unwrapping,
    pub(super) layout_check: LayoutCheck,
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").field("document", &self.document).field("busy", &self.busy()).finish_non_exhaustive()
    }
}

impl Session {
    /// Creates an empty session. Background threads call `wake` when there is something to [`poll`](Self::poll).
    pub fn new(wake: Wake, recent: RecentFiles) -> Self {
        Self {
            mesh: OpenMesh::default(),
            document: Document::default(),
            history: History::default(),
            charts: OtherCharts::new(&wake),
            atlas_views: AtlasViews::new(&wake),
            page: PagePart::new(&wake),
            comparing: Comparing::new(&wake),
            morphing: Morphing::new(&wake),
            drag: Drag::new(&wake),
            brushing: Brushing::new(&wake),
            jobs: BackgroundJobs::new(&wake),
            target_checks: TargetChecks::new(&wake),
            landmarks: Landmarks::default(),
            files: Files::new(&wake, recent),
            messages: Messages::default(),
            turned_v: TurnedV::default(),
            unwrapping: Unwrapping::new(&wake),
            layout_check: LayoutCheck::new(&wake),
            solving: Solving::new(wake, TIMELINE_BUDGET),
        }
    }

    /// Document that the user edits.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Carries out a request. Work that takes time continues in the background.
    #[expect(clippy::too_many_lines, reason = "a line for each request")]
    pub fn handle(&mut self, action: Action) {
        match action {
            Action::Open(path) => self.files.open(path),
            Action::OpenTogether(files) => self.files.open_together(files),
            Action::OpenExample(example) => self.files.open_example(example),
            Action::OpenLarge => self.files.open_large(),
            Action::LeaveLarge => self.files.leave_large(),
            Action::CloseLandmarks => self.close_landmarks(),
            Action::LocatePicture(path) => {
                if let Some(picture) = self.files.locate_picture(path) {
                    self.open_picture(picture);
                }
            }
            Action::LocateMesh(mesh) => self.files.locate_mesh(mesh, &mut self.messages),
            Action::Recover(path) => self.files.recover(path, &mut self.messages),
            Action::DiscardRecovery(path) => self.files.autosave_mut().discard(&path),
            Action::ClearRecent => self.files.recent_mut().clear(),
            Action::Save(request) => self.save(Export::Result(request)),
            Action::SaveFlatMesh(path) => self.save(Export::FlatMesh(path)),
            Action::SavePattern(request) => self.save(Export::Pattern(request)),
            Action::SaveBaked(request) => self.save_baked(request),
            Action::SaveProject(path) => self.save_project(path),
            Action::ExportConstraints(path) => self.export_constraints(path),
            Action::RefuseName(path) => self.refuse_name(&path),
            Action::RefuseToReplace(path) => {
                let text = format!("{} exists and was not replaced", path.display());
                self.complain(text, Some("choose another name"));
            }
            Action::ShowFolder(file) => self.files.show_folder(file),
            Action::Dismiss(id) => self.messages.dismiss(id),
            Action::Solve => self.solve_from_scratch(),
            Action::Step => self.step(),
            Action::Run => self.run_on(),
            Action::Relax => self.relax(),
            Action::Repair => self.repair(),
            Action::Rest => self.rest(),
            Action::Brush(dab) => self.brush(dab),
            Action::BrushOnPage(dab) => self.brush_on_page(dab),
            Action::EndBrush => self.end_brush(),
            Action::GiveUpBrush => self.give_up_brush(),
            Action::EndGesture => self.end_gesture(),
            Action::Cancel => self.cancel(),
            Action::ShowStep(index) => self.solving.show(index),
            Action::Compare(index) => self.solving.compare(index),
            Action::CompareMethods(variants) => self.compare_methods(&variants),
            Action::Morph(between) => self.want_morph(between),
            Action::SetStop(stop) => self.solving.set_stop(stop),
            Action::GiveUpGesture => self.travel(History::give_up_gesture),
            Action::Undo => self.undo(),
            Action::Redo => self.redo(),
            Action::Fix(vertices) => self.fix(&vertices),
            Action::FixOnPage(vertices) => self.fix_on_page(&vertices),
            Action::OpenPicture(path) => self.open_picture(path),
            Action::RemovePicture => self.set_picture(None),
            Action::SetVAxis(v_axis) => self.set_v_axis(v_axis),
            Action::TurnFaces => self.turn_faces(),
            Action::Unwrap(bound) => self.unwrap(bound),
            Action::PaintSeams { edges, cost } => self.paint_seams(&edges, cost),
            Action::PreviewSeams(bound) => self.preview_seams(bound),
            Action::SetHoles(holes) => self.set_holes(holes),
            Action::CheckLayout => self.check_layout(),
            Action::TakeLayout => self.take_layout(),
            Action::AllowRepair(repair) => self.want_form(self.form_to_be().with_repair(repair)),
            Action::LeaveOut(parts) => self.leave_out(parts),
            Action::Weld(within) => self.weld(within),
            Action::CountNear(distance) => self.count_near(distance),
            Action::SetSeams(seams) => self.set_seams(seams),
            Action::ImportSeams(path) => self.import_seams(path),
            Action::CopyLayout(path) => self.copy_layout_of(path),
            Action::ExportSeams(path) => self.export_seams(path),
            Action::ShowChart(number) => self.show_chart(number),
            Action::SetPacking(options) => self.set_packing(options),
            Action::SetChartSize { chart, size } => self.set_chart_size(chart, size),
            Action::LockCharts { charts, lock } => self.lock_charts(&charts, lock),
            Action::MoveCharts { moves, insists } => self.move_charts(&moves, insists),
            Action::EndMove => self.end_move(),
            Action::GiveUpMove => self.give_up_move(),
            Action::PackCharts(charts) => self.pack_charts(charts.as_ref()),
            Action::StackCharts(charts) => self.stack_charts(&charts),
            Action::UnstackCharts(charts) => self.unstack_charts(&charts),
            Action::MirrorTargets => self.mirror_targets(),
            Action::FitTargets => self.fit_targets(),
            Action::ImportConstraints(path) => self.import_constraints(path),
            Action::Place { vertex, target } => self.place(vertex, target),
            Action::MovePin { vertex, target } => self.move_pins(&[(vertex, target)]),
            Action::MovePins(moves) => self.move_pins(&moves),
            Action::SetPinKind { vertices, kind } => self.set_pin_kind(&vertices, kind),
            Action::SlideHold { vertices, kind } => self.slide_hold(&vertices, kind),
            Action::NamePin { vertex, name } => self.name_pin(vertex, name),
            Action::MergePins(pins) => self.merge_pins(pins),
            Action::Unpin(vertices) => self.unpin(&vertices),
            Action::UnpinOnPage(vertices) => self.unpin_on_page(&vertices),
            Action::UnpinAll => self.unpin_all(),
            Action::SetSettings(settings) => self.choose(settings),
            Action::SlideSettings(settings) => self.slide_settings(settings),
        }
    }

    /// Processes the results of the background. Call once per frame.
    pub fn poll(&mut self) {
        self.poll_at(Instant::now());
    }

    /// Processes the results of the background at the time `now`. Recovery copies are due every few seconds.
    pub fn poll_at(&mut self, now: Instant) {
        if let Some(opened) = self.files.poll_loading(&mut self.messages) {
            self.take_opened(opened);
        }
        self.poll_jobs();
        self.poll_layout_check();
        self.choose_first_map();
        self.poll_unwrapping();
        self.poll_solving();
        self.poll_charts();
        self.save_awaited();
        self.poll_atlas();
        self.poll_page();
        self.poll_comparing();
        self.poll_morph();
        self.poll_drag();
        self.poll_brush();
        self.refresh_target_checks();
        self.files.poll_saving(&mut self.messages);
        if self.has_numbers_as_wanted() {
            self.poll_copies(now);
        }
    }

    /// Follows recovery copies, and writes one if it is due.
    fn poll_copies(&mut self, now: Instant) {
        self.files.poll_copies(&mut self.messages);
        let Some(model) = self.model().filter(|_| self.has_unsaved_work()).cloned() else {
            return self.files.leave_copy();
        };
        if self.files.is_copy_due(now, &self.document)
            && let Some(mut project) = self.project(&model)
        {
            project.recovery = Some(self.files.recovery_note(&model));
            self.files.begin_copy(now, project, &self.document, &mut self.messages);
        }
    }

    /// Undoes the last edit. A preparation or a search for seams in progress is dropped instead.
    fn undo(&mut self) {
        if self.page.give_up() {
            // A move that has not ended is no edit yet.
        } else if self.is_brushing() {
            self.give_up_brush();
        } else if self.mesh.wanted().is_some() {
            self.mesh.want(None);
        } else if self.unwrapping.is_busy() {
            self.stop_unwrapping();
        } else {
            self.travel(History::undo);
        }
    }

    /// Redoes the edit that was undone last. A preparation in progress is dropped.
    fn redo(&mut self) {
        if self.history.can_redo() {
            self.mesh.want(None);
            self.unwrapping.cancel();
            self.give_up_brush();
        }
        self.travel(History::redo);
    }

    /// Moves to another state of the document and shows its solution. If none is stored and the state needs another
    /// solution, a solve follows.
    fn travel(&mut self, to: impl FnOnce(&mut History, &mut Document) -> bool) {
        let (chart, was_in_gesture) = (self.document.chart, self.history.is_in_gesture());
        let wanted =
            |session: &Self| (session.document.problem(), session.document.relaxed, session.history.taken_to());
        let (form, before) = (self.document.form.clone(), wanted(self));
        self.remember();
        let charts = self.history.past_mut().charts(None);
        self.remember_charts(charts);
        if !to(&mut self.history, &mut self.document) {
            return;
        }
        self.recall_charts();
        if self.document.chart != chart {
            self.follow_chart();
        } else if was_in_gesture && self.document.form == form {
            self.give_up_drag();
        } else if (self.document.form != form || wanted(self) != before) && !self.recall() {
            self.solve();
        }
    }

    fn cancel(&mut self) {
        // Other work is stopped alone. Files are still written then.
        if self.is_only_saving() {
            self.files.stop_writing();
        }
        self.files.cancel_loading();
        self.drag.stop_following();
        self.give_up_brush();
        self.jobs.stop();
        self.mesh.want(None);
        self.give_up_exports();
        self.charts.forget_asked();
        self.solving.pause();
        // Last, because a mesh whose first map is stopped is solved as it is.
        self.stop_first_map();
        self.stop_unwrapping();
    }
}
