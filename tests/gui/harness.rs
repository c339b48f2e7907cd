//! Test harness of the window, without a screen or a graphics card. Actions and observations are in `actions.rs`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;
use egui::Vec2;
use egui_kittest::{Harness, HarnessBuilder};
use freebound::app::{App, LaunchFile};
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::Editor;
use freebound_core::mesh::TriMesh;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Embedding;
use tempfile::TempDir;

pub(crate) use crate::actions::{MESH_VIEW, PLANE_VIEW, Pill};
pub(crate) use freebound_testkit::{sheet, write_obj};

/// Time limit for the background before a test fails, long enough for a machine under load.
const PATIENCE: Duration = Duration::from_secs(90);

/// Size of the window in most tests, points.
pub(crate) const SIZE: Vec2 = Vec2::new(1280.0, 800.0);

/// Editor in a test window, with a folder for its files.
pub(crate) struct Window {
    pub(crate) harness: Harness<'static, App>,
    folder: TempDir,
    /// Longest time that a frame took so far.
    pub(crate) slowest: Duration,
}

impl Window {
    /// Creates a window with `start`, and waits until it is settled.
    pub(crate) fn start(size: Vec2, start: LaunchFile) -> Self {
        Self::build(Harness::builder().with_size(size), start)
    }

    /// Window drawn by a graphics card, in one of the two themes.
    pub(crate) fn drawn(theme: egui::Theme, file: &Path) -> Self {
        let builder = Harness::builder().with_size(SIZE).with_theme(theme).with_render_cursor(false).wgpu();
        Self::build(builder, LaunchFile { file: Some(file.to_owned()), ..LaunchFile::default() })
    }

    fn build(builder: HarnessBuilder<App>, start: LaunchFile) -> Self {
        let builder = builder.with_step_dt(1.0 / 60.0);
        let harness = builder.build_eframe(move |context| App::new(context, start));
        let folder = tempfile::tempdir().expect("a folder for files");
        let mut window = Self { harness, folder, slowest: Duration::ZERO };
        window.settle();
        window
    }

    /// Writes a mesh to a file of this name, and opens it in a window.
    pub(crate) fn with_mesh(name: &str, mesh: &TriMesh) -> Self {
        let folder = tempfile::tempdir().expect("a folder for files");
        let path = folder.path().join(name);
        write_obj(&path, mesh);
        Self { folder, ..Self::with_file(&path) }
    }

    /// Window with a mesh that has faults. Opening the mesh unwrapped it, and undo gave its faults back.
    pub(crate) fn with_faulty(name: &str, mesh: &TriMesh) -> Self {
        let mut window = Self::with_mesh(name, mesh);
        window.give_faults_back();
        window
    }

    /// Undoes the unwrapping of a mesh that was opened.
    pub(crate) fn give_faults_back(&mut self) {
        assert!(self.is_proved(), "{}", self.verdict());
        self.press(egui::Modifiers::COMMAND, egui::Key::Z);
        assert!(self.is_faulty(), "{}", self.verdict());
    }

    /// Window with a built-in mesh, opened from a file of its name.
    pub(crate) fn with_example(example: Example) -> Self {
        Self::with_mesh(&format!("{}.obj", example.name()), &example.mesh())
    }

    /// Window with a file.
    pub(crate) fn with_file(path: &Path) -> Self {
        Self::start(SIZE, LaunchFile { file: Some(path.to_owned()), dialogs_inside: true, ..LaunchFile::default() })
    }

    /// Path in the window's folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn editor(&self) -> &Editor {
        self.harness.state().editor()
    }

    pub(crate) fn editor_mut(&mut self) -> &mut Editor {
        self.harness.state_mut().editor_mut()
    }

    pub(crate) fn outcome(&self) -> Arc<Outcome> {
        Arc::clone(self.editor().session.outcome().expect("solved"))
    }

    pub(crate) fn embedding(&self) -> Embedding {
        self.outcome().step.candidate.solution.embedding.clone()
    }

    /// Opens a file by an action of the session.
    pub(crate) fn open(&mut self, path: &Path) {
        self.editor_mut().session.handle(Action::Open(path.to_owned()));
        self.settle();
    }

    pub(crate) fn step(&mut self) {
        let begun = Instant::now();
        self.harness.step();
        self.slowest = self.slowest.max(begun.elapsed());
    }

    /// Runs one frame with all these events.
    pub(crate) fn frame(&mut self, events: impl IntoIterator<Item = egui::Event>) {
        self.harness.input_mut().events.extend(events);
        self.step();
    }

    /// Runs a [`frame`](Self::frame) this many seconds after the previous one.
    pub(crate) fn frame_after(&mut self, seconds: f64, events: impl IntoIterator<Item = egui::Event>) {
        let now = self.harness.ctx.input(|input| input.time);
        self.harness.input_mut().time = Some(now + seconds);
        self.frame(events);
        self.harness.input_mut().time = None;
    }

    /// Runs frames until the background is idle and both panes show its results.
    pub(crate) fn settle(&mut self) {
        self.settle_by(Self::step);
    }

    /// Waits like [`settle`](Self::settle), with the window's clock stopped: a held pointer does not count as
    /// resting, however long the background takes.
    pub(crate) fn settle_while_held(&mut self) {
        self.settle_by(|window| window.frame_after(0.0, []));
    }

    fn settle_by(&mut self, step: impl Fn(&mut Self)) {
        let start = Instant::now();
        step(self);
        while !self.is_settled() {
            assert!(start.elapsed() < PATIENCE, "still not settled: {:?}", self.editor());
            std::thread::sleep(Duration::from_millis(1));
            step(self);
        }
        // A grid has its final size in its second frame.
        self.harness.run_steps(2);
        self.harness.check_accessibility();
    }

    pub(crate) fn is_settled(&self) -> bool {
        let editor = self.editor();
        let session = &editor.session;
        let mesh_drawn = editor.mesh_scene().map(|scene| scene.model_revision);
        let plane_drawn = editor.plane.scene().map(|scene| scene.outcome_revision);
        let mesh_wanted = session.model().map(|_| session.model_revision());
        let plane_wanted = session.outcome().map(|_| session.outcome_revision());
        let scenes_drawn = mesh_drawn == mesh_wanted
            && plane_drawn == plane_wanted
            && editor.plane.hull_is_drawn()
            && !editor.plane.is_easing()
            && editor.plane.page.is_drawn(session)
            && !session.is_judging_move()
            && !editor.pane_shading.is_making_picture()
            && !editor.pane_shading.checker.is_making()
            && !editor.tools.seam.is_busy()
            && !session.is_comparing()
            && !session.is_morphing()
            && editor.plane.comparison.is_drawn(session)
            && !editor.files.dialogs.is_listing()
            && !editor.gpu.has_presses_waiting();
        session.busy().is_none() && !session.is_following() && scenes_drawn
    }
}
