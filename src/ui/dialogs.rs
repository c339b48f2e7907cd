//! File dialogs: the native dialog of the system if there is one, else a small dialog inside the window.
//!
//! The native dialog runs off the UI thread, so that the window stays responsive while it is open.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eframe::egui;

use super::state::{DialogForm, FileDialogKind};
use crate::session::{Background, JobFailure, Wake};

/// An answer faster than this means that no dialog appeared: the system has none.
const TOO_QUICK: Duration = Duration::from_millis(1200);

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DialogChoice {
    pub kind: FileDialogKind,
    pub path: PathBuf,
}

/// The open dialog, if any.
#[derive(Debug, Default)]
pub struct Dialogs {
    native: Option<Background<Asked, Option<PathBuf>>>,
    browser: Option<Browser>,
    /// True if the system has turned out to have no native dialog.
    native_missing: bool,
}

/// Request to the native dialog, and its time.
struct Asked {
    kind: FileDialogKind,
    suggestion: PathBuf,
    since: Instant,
}

impl Dialogs {
    /// Dialogs inside the window only, for tests and for systems without native dialogs.
    pub fn inside_the_window() -> Self {
        Self { native_missing: true, ..Self::default() }
    }

    pub fn is_open(&self) -> bool {
        self.native.is_some() || self.browser.is_some()
    }

    /// Opens a dialog, unless one is open. `suggestion` is the suggested folder and name.
    pub(in crate::ui) fn ask(&mut self, wake: &Wake, kind: FileDialogKind, suggestion: PathBuf) {
        if self.is_open() {
            return;
        }
        if self.native_missing || !may_have_native() {
            self.browser = Some(Browser::new(kind, &suggestion));
            return;
        }
        let dialog = native_dialog(kind, &suggestion);
        let native = self.native.insert(Background::new("file dialog", wake));
        native.start(Asked { kind, suggestion, since: Instant::now() }, |_| pollster::block_on(dialog));
    }

    /// Returns the file chosen in the native dialog, once.
    pub fn poll(&mut self) -> Option<DialogChoice> {
        let (asked, answer) = self.native.as_mut()?.poll()?;
        self.native = None;
        let no_thread = matches!(answer, Err(JobFailure::NoThread(_)));
        let answer = answer.ok().flatten();
        let is_unseen = answer.is_none() && asked.since.elapsed() < TOO_QUICK && cfg!(target_os = "linux");
        if is_unseen || no_thread {
            self.native_missing = true;
            self.browser = Some(Browser::new(asked.kind, &asked.suggestion));
        }
        Some(DialogChoice { kind: asked.kind, path: answer? })
    }

    /// Shows the dialog inside the window, if it is open. Returns the file once chosen.
    pub fn show(&mut self, context: &egui::Context) -> Option<DialogChoice> {
        let browser = self.browser.as_mut()?;
        let answer = browser.show(context)?;
        let kind = browser.kind;
        self.browser = None;
        match answer {
            DialogAnswer::Cancelled => None,
            DialogAnswer::Chosen(path) => Some(DialogChoice { kind, path }),
        }
    }

    /// Closes the dialog inside the window. Returns true if it was open.
    pub fn close(&mut self) -> bool {
        self.browser.take().is_some()
    }
}

/// True if the system can have a native dialog. On Linux this needs the session bus or zenity.
fn may_have_native() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    let bus = || set("XDG_RUNTIME_DIR").is_some_and(|folder| Path::new(&folder).join("bus").exists());
    let zenity = || set("PATH").is_some_and(|paths| std::env::split_paths(&paths).any(|p| p.join("zenity").exists()));
    set("DBUS_SESSION_BUS_ADDRESS").is_some() || bus() || zenity()
}

fn native_dialog(kind: FileDialogKind, suggestion: &Path) -> impl Future<Output = Option<PathBuf>> + Send + use<> {
    let DialogForm { title, files, extensions, .. } = kind.form();
    let mut dialog = rfd::AsyncFileDialog::new().set_title(title).add_filter(files, extensions);
    if let Some(folder) = suggestion.parent().filter(|folder| folder.is_dir()) {
        dialog = dialog.set_directory(folder);
    }
    dialog = if kind.is_reading() {
        dialog.add_filter("All files", &["*"])
    } else {
        dialog.set_file_name(name_of(suggestion))
    };
    async move {
        let file = if kind.is_reading() { dialog.pick_file().await } else { dialog.save_file().await };
        file.map(|file| file.path().to_owned())
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// File dialog inside the window: the contents of a folder and a name.
#[derive(Debug)]
struct Browser {
    kind: FileDialogKind,
    folder: PathBuf,
    name: String,
    entries: Vec<Entry>,
    problem: Option<String>,
    /// True until the dialog has been shown: its first frame focuses the name field.
    is_fresh: bool,
    answer: Option<DialogAnswer>,
}

/// Entry of a folder. Folders sort before files.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Entry {
    Folder(String),
    File(String),
}

#[derive(Debug)]
enum DialogAnswer {
    Cancelled,
    Chosen(PathBuf),
}

impl Browser {
    fn new(kind: FileDialogKind, suggestion: &Path) -> Self {
        let here = std::env::current_dir().unwrap_or_default();
        let folder = suggestion.parent().filter(|f| f.is_dir()).map_or(here, Path::to_owned);
        // Resolve the dots of a relative path, so that "Up" always works.
        let folder = folder.canonicalize().unwrap_or(folder);
        let name = if kind.is_reading() { String::new() } else { name_of(suggestion) };
        let (entries, problem, answer) = (Vec::new(), None, None);
        let mut browser = Self { kind, folder, name, entries, problem, is_fresh: true, answer };
        browser.list();
        browser
    }

    fn list(&mut self) {
        let form = self.kind.form();
        let listed = |entry: std::fs::DirEntry| {
            let name = name_of(&entry.path());
            if name.starts_with('.') {
                None
            } else if entry.path().is_dir() {
                Some(Entry::Folder(name))
            } else {
                form.fits(Path::new(&name)).then_some(Entry::File(name))
            }
        };
        (self.entries, self.problem) = match std::fs::read_dir(&self.folder) {
            Ok(read) => (read.flatten().filter_map(listed).collect(), None),
            Err(error) => (Vec::new(), Some(format!("cannot list this folder: {error}"))),
        };
        self.entries.sort();
    }

    fn enter(&mut self, folder: PathBuf) {
        self.folder = folder;
        self.list();
    }

    /// Shows the dialog. Returns the answer once there is one.
    fn show(&mut self, context: &egui::Context) -> Option<DialogAnswer> {
        let mut open = true;
        egui::Window::new(self.kind.form().title)
            .id(egui::Id::unique("file dialog"))
            .open(&mut open)
            .collapsible(false)
            .default_size([460.0, 380.0])
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(context.content_rect().center())
            .show(context, |ui| self.contents(ui));
        if open { self.answer.take() } else { Some(DialogAnswer::Cancelled) }
    }

    fn contents(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let parent = self.folder.parent().map(Path::to_owned);
            let up = ui.add_enabled(parent.is_some(), egui::Button::new("Up")).on_hover_text("Open the parent folder");
            if let (true, Some(parent)) = (up.clicked(), parent) {
                self.enter(parent);
            }
            ui.add(egui::Label::new(self.folder.display().to_string()).truncate());
        });
        ui.separator();
        let height = (ui.available_height() - 72.0).max(120.0);
        let area = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(120.0).auto_shrink(false);
        area.show(ui, |ui| self.entries_ui(ui));
        if let Some(problem) = &self.problem {
            ui.colored_label(crate::ui::theme::theme_of(ui).flipped, problem);
        }
        ui.separator();
        let is_entered = ui.horizontal(|ui| self.name_ui(ui)).inner;
        ui.horizontal(|ui| self.buttons(ui, is_entered));
    }

    fn entries_ui(&mut self, ui: &mut egui::Ui) {
        let mut folder_to_enter = None;
        for entry in &self.entries {
            match entry {
                Entry::Folder(name) => {
                    if ui.selectable_label(false, format!("{name}/")).clicked() {
                        folder_to_enter = Some(self.folder.join(name));
                    }
                }
                Entry::File(name) => {
                    let response = ui.selectable_label(self.name == *name, name);
                    if response.double_clicked() && self.kind.is_reading() {
                        self.answer = Some(DialogAnswer::Chosen(self.folder.join(name)));
                    }
                    if response.clicked() {
                        self.name.clone_from(name);
                    }
                }
            }
        }
        if let Some(folder) = folder_to_enter {
            self.enter(folder);
        } else if self.entries.is_empty() && self.problem.is_none() {
            ui.weak("No matching files here. Go up, or type a name.");
        }
    }

    /// Field for the name. Returns true if Enter was pressed in the field.
    fn name_ui(&mut self, ui: &mut egui::Ui) -> bool {
        let label = ui.label("Name");
        let field = egui::TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label.id);
        if std::mem::take(&mut self.is_fresh) {
            field.request_focus();
        }
        field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter))
    }

    fn buttons(&mut self, ui: &mut egui::Ui, is_entered: bool) {
        let path = self.path();
        let exists = !self.kind.is_reading() && path.as_ref().is_some_and(|path| path.is_file());
        let words = if exists { "Replace" } else { self.kind.form().title.split(' ').next().unwrap_or_default() };
        let is_clicked = ui.add_enabled(path.is_some(), egui::Button::new(words)).clicked();
        match path.filter(|_| is_clicked || (is_entered && !exists)) {
            Some(path) if path.is_dir() => self.enter(path),
            Some(path) => self.answer = Some(DialogAnswer::Chosen(path)),
            None => {}
        }
        if ui.button("Cancel").clicked() {
            self.answer = Some(DialogAnswer::Cancelled);
        }
    }

    /// Path of the named file. A name without extension gets the default extension of the dialog kind when saving.
    fn path(&self) -> Option<PathBuf> {
        let name = self.name.trim();
        if name.is_empty() {
            return None;
        }
        let path = self.folder.join(name);
        let bare = !self.kind.is_reading() && path.extension().is_none();
        Some(if bare { path.with_extension(self.kind.form().extensions[0]) } else { path })
    }
}
