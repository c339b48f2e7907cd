//! Application window: eframe around the editor.

use std::path::PathBuf;

use eframe::egui;

use crate::examples::Example;
use crate::render;
use crate::session::{Action, Preferences, RecentFiles, recovery_folder};
use crate::ui::{Dialogs, Editor, is_picture, theme, window_ui};
use freebound_io::machine_memory_bytes;

/// Initial size of the window, points.
const WINDOW_SIZE: [f32; 2] = [1280.0, 800.0];

/// Least size of the window, points.
const LEAST_SIZE: [f32; 2] = [640.0, 420.0];

/// Largest plausible side of a stored window size, points. Larger values are ignored.
const GREATEST_SIDE: f32 = 16_384.0;

/// Editor in its window.
#[derive(Debug)]
pub struct App {
    editor: Editor,
    /// File for the preferences, which include the window's state.
    preferences: Option<PathBuf>,
}

/// File to open at the start, and stores for the editor's files.
#[derive(Clone, Debug, Default)]
pub struct LaunchFile {
    /// Mesh, project or picture. A picture is shown on the built-in face. Default: the built-in face.
    pub file: Option<PathBuf>,
    /// Store of the list of recent files; `None` in tests.
    pub recent_store: Option<PathBuf>,
    /// Store of the preferences, which include the window's state; `None` in tests.
    pub preferences: Option<PathBuf>,
    /// Folder for recovery copies; `None` in tests.
    pub recovery_folder: Option<PathBuf>,
    /// Memory of the machine, bytes. The editor asks before it opens a file that may need more than half of it.
    /// `None` never asks.
    pub memory: Option<u64>,
    /// True to use dialogs inside the window instead of the system's file dialogs.
    pub dialogs_inside: bool,
}

impl App {
    /// Creates the editor and opens the file of `start`.
    pub fn new(context: &eframe::CreationContext<'_>, start: LaunchFile) -> Self {
        theme::install(&context.egui_ctx);
        let recent = start.recent_store.map_or_else(RecentFiles::default, RecentFiles::load);
        let mut editor = Editor::new(&context.egui_ctx, recent);
        if let Some(state) = &context.wgpu_render_state {
            render::install(state);
            editor.gpu.use_gpu();
        }
        if start.dialogs_inside {
            editor.files.dialogs = Dialogs::inside_the_window();
        }
        if let Some(path) = &start.preferences {
            editor.put_on(&Preferences::load(path));
        }
        if let Some(folder) = start.recovery_folder {
            editor.session.keep_copies_in(folder);
        }
        if let Some(bytes) = start.memory {
            editor.session.heed_memory(bytes);
        }
        if start.preferences.is_some() && start.file.is_none() {
            editor.layout.welcome.greet();
        }
        match start.file {
            Some(path) if !is_picture(&path) => editor.session.handle(Action::Open(path)),
            picture => {
                // A picture needs a mesh.
                editor.session.handle(Action::OpenExample(Example::Face));
                if let Some(path) = picture {
                    editor.session.handle(Action::OpenPicture(path));
                }
            }
        }
        Self { editor, preferences: start.preferences }
    }

    /// Read access to the editor's state.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// Write access to the editor's state, for tests.
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
        // If the user was not asked to save, such as at the end of a system session, the recovery copy stays.
        if self.editor.gpu.is_quitting() || !self.editor.session.has_unsaved_work() {
            self.editor.session.close();
        }
    }
}

/// Stored size of the window if it is plausible, otherwise the initial size.
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
/// A message of one line if there is no display, or no driver to draw with.
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
