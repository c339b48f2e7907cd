//! The window: eframe around the editor.

use std::path::PathBuf;

use eframe::egui;

use crate::examples::Example;
use crate::render;
use crate::session::{Action, Preferences, RecentFiles, recovery_folder};
use crate::ui::{Dialogs, Editor, theme, window_ui};
use freebound_io::machine_memory_bytes;

/// Size of the window at the start, points.
const WINDOW_SIZE: [f32; 2] = [1280.0, 800.0];

/// Size below which the window does not shrink, points.
const LEAST_SIZE: [f32; 2] = [640.0, 420.0];

/// A window wider or higher than this was never left, points.
const GREATEST_SIDE: f32 = 16_384.0;

/// The editor in its window.
#[derive(Debug)]
pub struct App {
    editor: Editor,
    /// Where it is kept how the window is left.
    preferences: Option<PathBuf>,
}

/// What to open at the start, and how.
#[derive(Clone, Debug, Default)]
pub struct LaunchFile {
    /// A mesh; the built-in face without one.
    pub file: Option<PathBuf>,
    /// Where the list of recent files is kept; nowhere in tests.
    pub recent_store: Option<PathBuf>,
    /// Where it is kept how the window is left; nowhere in tests.
    pub preferences: Option<PathBuf>,
    /// Where copies for recovery are kept; nowhere in tests.
    pub recovery_folder: Option<PathBuf>,
    /// The machine's memory, bytes: a file that may take more than half of it is asked about. None asks about none.
    pub memory: Option<u64>,
    /// Whether to leave the system's file dialogs alone.
    pub dialogs_inside: bool,
}

impl App {
    /// An editor that opens what `start` says.
    pub fn new(context: &eframe::CreationContext<'_>, start: LaunchFile) -> Self {
        theme::install(&context.egui_ctx);
        let recent = start.recent_store.map_or_else(RecentFiles::default, RecentFiles::load);
        let mut editor = Editor::new(&context.egui_ctx, recent);
        if let Some(state) = &context.wgpu_render_state {
            render::install(state);
            editor.gpu.use_gpu();
        }
        if let Some(path) = &start.preferences {
            editor.put_on(&Preferences::load(path));
        }
        if start.dialogs_inside {
            editor.files.dialogs = Dialogs::inside_the_window();
        }
        if let Some(folder) = start.recovery_folder {
            editor.session.keep_copies_in(folder);
        }
        if let Some(bytes) = start.memory {
            editor.session.heed_memory(bytes);
        }
        editor.session.handle(start.file.map_or(Action::OpenExample(Example::Face), Action::Open));
        Self { editor, preferences: start.preferences }
    }

    /// The editor's state.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The editor's state, for tests that bring it somewhere first.
    pub fn editor_mut(&mut self) -> &mut Editor {
        &mut self.editor
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        window_ui(ui, &mut self.editor);
    }

    fn on_exit(&mut self) {
        if let Some(path) = &self.preferences {
            self.editor.preferences().store(path);
        }
        self.editor.session.finish_writing();
        // Where the person was not asked, such as at the end of a session of the system's, the copy stays.
        if self.editor.gpu.is_quitting() || !self.editor.session.has_unsaved_work() {
            self.editor.session.close();
        }
    }
}

/// The size that the window was left in, where it makes sense.
fn size_of_window(left: &Preferences) -> [f32; 2] {
    let makes_sense = |[width, height]: &[f32; 2]| {
        (LEAST_SIZE[0]..=GREATEST_SIDE).contains(width) && (LEAST_SIZE[1]..=GREATEST_SIDE).contains(height)
    };
    left.window_size.filter(makes_sense).unwrap_or(WINDOW_SIZE)
}

/// Opens the window and runs until it is closed.
///
/// # Errors
///
/// Where there is no display, or no driver to draw with: one line that says so.
pub fn run(file: Option<PathBuf>) -> Result<(), String> {
    let preferences = Preferences::default_store();
    let left = preferences.as_deref().map(Preferences::load).unwrap_or_default();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Freebound")
            .with_app_id("freebound")
            .with_inner_size(size_of_window(&left))
            .with_min_inner_size(LEAST_SIZE)
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        ..eframe::NativeOptions::default()
    };
    let start = LaunchFile {
        file,
        recent_store: RecentFiles::default_store(),
        preferences,
        recovery_folder: recovery_folder(),
        memory: machine_memory_bytes(),
        dialogs_inside: false,
    };
    eframe::run_native("freebound", options, Box::new(|context| Ok(Box::new(App::new(context, start))))).map_err(
        |error| match error {
            eframe::Error::WinitEventLoop(_) => "no display".to_owned(),
            eframe::Error::Wgpu(_) => {
                "a display, but no graphics driver (on Debian: apt install mesa-vulkan-drivers libvulkan1)".to_owned()
            }
            other => format!("the window cannot open: {other}"),
        },
    )
}
