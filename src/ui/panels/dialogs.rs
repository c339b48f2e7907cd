//! Asking for a file: the system's own dialog where there is one, else a small one inside the window.
//!
//! The system's dialog runs off the UI thread, so that the window lives on while it is open.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eframe::egui;

use crate::session::{Job, Poll};
use crate::ui::editor::purpose::{Purpose, has_extension};

/// A dialog that answers faster than this was not seen by a person: the system has none.
const TOO_QUICK: Duration = Duration::from_millis(1200);

/// A file that a person chose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// What it was asked for.
    pub purpose: Purpose,
    /// The file.
    pub path: PathBuf,
}

/// The dialog that is open, if one is.
#[derive(Debug, Default)]
pub struct Dialogs {
    native: Option<Native>,
    browser: Option<Browser>,
    /// Set once the system has shown that it has no dialog of its own.
    native_missing: bool,
}

#[derive(Debug)]
struct Native {
    purpose: Purpose,
    suggestion: PathBuf,
    job: Job<(), Option<PathBuf>>,
    since: Instant,
}

impl Dialogs {
    /// Dialogs inside the window only: for tests, and where the system has none.
    pub fn inside_the_window() -> Self {
        Self { native_missing: true, ..Self::default() }
    }

    /// Whether a dialog is open.
    pub fn is_open(&self) -> bool {
        self.native.is_some() || self.browser.is_some()
    }

    /// Asks for a file. `suggestion` is the name to begin with.
    pub fn ask(&mut self, context: &egui::Context, purpose: Purpose, suggestion: PathBuf) {
        if self.is_open() {
            return;
        }
        if self.native_missing || !may_have_native() {
            self.browser = Some(Browser::new(purpose, &suggestion));
            return;
        }
        let dialog = native_dialog(purpose, &suggestion);
        let waker = context.clone();
        let work = move |_: &_| pollster::block_on(dialog);
        match Job::spawn("file dialog", move || waker.request_repaint(), work) {
            Ok(job) => self.native = Some(Native { purpose, suggestion, job, since: Instant::now() }),
            Err(_) => self.browser = Some(Browser::new(purpose, &suggestion)),
        }
    }

    /// The file chosen in the system's dialog, once.
    pub fn poll(&mut self) -> Option<Choice> {
        let native = self.native.as_ref()?;
        let answer = match native.job.poll() {
            Poll::Running => return None,
            Poll::Done(answer) => answer,
            Poll::Lost => None,
        };
        let native = self.native.take()?;
        if answer.is_none() && native.since.elapsed() < TOO_QUICK && cfg!(target_os = "linux") {
            self.native_missing = true;
            self.browser = Some(Browser::new(native.purpose, &native.suggestion));
        }
        Some(Choice { purpose: native.purpose, path: answer? })
    }

    /// Shows the dialog inside the window, where one is open. Gives the file chosen.
    pub fn show(&mut self, context: &egui::Context) -> Option<Choice> {
        let browser = self.browser.as_mut()?;
        match browser.show(context) {
            Answer::None => None,
            Answer::Cancelled => {
                self.browser = None;
                None
            }
            Answer::Chosen(path) => {
                let purpose = browser.purpose;
                self.browser = None;
                Some(Choice { purpose, path })
            }
        }
    }

    /// Closes the dialog inside the window. Returns whether one was open.
    pub fn close(&mut self) -> bool {
        self.browser.take().is_some()
    }
}

/// Whether a dialog of the system's can be there at all: on Linux it comes over the session bus, or from zenity.
fn may_have_native() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    let bus = || set("XDG_RUNTIME_DIR").is_some_and(|folder| Path::new(&folder).join("bus").exists());
    let zenity = || set("PATH").is_some_and(|paths| std::env::split_paths(&paths).any(|p| p.join("zenity").exists()));
    set("DBUS_SESSION_BUS_ADDRESS").is_some() || bus() || zenity()
}

fn native_dialog(purpose: Purpose, suggestion: &Path) -> impl Future<Output = Option<PathBuf>> + Send + use<> {
    let mut dialog = rfd::AsyncFileDialog::new().set_title(purpose.title());
    if let Some(folder) = suggestion.parent().filter(|folder| folder.is_dir()) {
        dialog = dialog.set_directory(folder);
    }
    let name = suggestion.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let dialog = dialog.add_filter(purpose.files(), purpose.extensions());
    let dialog = if purpose.is_reading() { dialog.add_filter("All files", &["*"]) } else { dialog.set_file_name(name) };
    async move {
        let file = if purpose.is_reading() { dialog.pick_file().await } else { dialog.save_file().await };
        file.map(|file| file.path().to_owned())
    }
}

/// A file dialog inside the window: a folder's contents and a name.
#[derive(Debug)]
struct Browser {
    purpose: Purpose,
    folder: PathBuf,
    name: String,
    entries: Vec<Entry>,
    problem: Option<String>,
    /// Whether it has not been shown yet: the name then takes the keyboard.
    is_fresh: bool,
}

#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Entry {
    Folder(String),
    File(String),
}

enum Answer {
    None,
    Cancelled,
    Chosen(PathBuf),
}

impl Browser {
    fn new(purpose: Purpose, suggestion: &Path) -> Self {
        let here = std::env::current_dir().unwrap_or_default();
        let folder = suggestion.parent().filter(|f| f.is_dir()).map_or(here, Path::to_owned);
        // Without the dots of a relative path, so that going up always works.
        let folder = folder.canonicalize().unwrap_or(folder);
        let name = if purpose.is_reading() {
            String::new()
        } else {
            suggestion.file_name().unwrap_or_default().to_string_lossy().into_owned()
        };
        let mut browser = Self { purpose, folder, name, entries: Vec::new(), problem: None, is_fresh: true };
        browser.list();
        browser
    }

    fn list(&mut self) {
        self.entries.clear();
        let read = match std::fs::read_dir(&self.folder) {
            Ok(read) => read,
            Err(error) => {
                self.problem = Some(format!("cannot list this folder: {error}"));
                return;
            }
        };
        self.problem = None;
        for entry in read.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') {
                continue;
            }
            if entry.path().is_dir() {
                self.entries.push(Entry::Folder(name));
            } else if self.fits(&name) {
                self.entries.push(Entry::File(name));
            }
        }
        self.entries.sort();
    }

    fn fits(&self, name: &str) -> bool {
        has_extension(Path::new(name), self.purpose.extensions())
    }

    fn enter(&mut self, folder: PathBuf) {
        self.folder = folder;
        self.list();
    }

    fn show(&mut self, context: &egui::Context) -> Answer {
        let mut answer = Answer::None;
        let mut open = true;
        egui::Window::new(self.purpose.title())
            .id(egui::Id::unique("file dialog"))
            .open(&mut open)
            .collapsible(false)
            .default_size([460.0, 380.0])
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(context.content_rect().center())
            .show(context, |ui| answer = self.contents(ui));
        if open { answer } else { Answer::Cancelled }
    }

    fn contents(&mut self, ui: &mut egui::Ui) -> Answer {
        let mut answer = Answer::None;
        ui.horizontal(|ui| {
            let parent = self.folder.parent().map(Path::to_owned);
            let up = ui.add_enabled(parent.is_some(), egui::Button::new("Up")).on_hover_text("The folder above");
            if let (true, Some(parent)) = (up.clicked(), parent) {
                self.enter(parent);
            }
            ui.add(egui::Label::new(self.folder.display().to_string()).truncate());
        });
        ui.separator();
        let list_height = (ui.available_height() - 72.0).max(120.0);
        egui::ScrollArea::vertical().max_height(list_height).min_scrolled_height(120.0).auto_shrink(false).show(
            ui,
            |ui| {
                if let Some(chosen) = self.entries_ui(ui) {
                    answer = chosen;
                }
            },
        );
        if let Some(problem) = &self.problem {
            ui.colored_label(crate::ui::theme::theme_of(ui).flipped, problem);
        }
        ui.separator();
        let mut entered = false;
        ui.horizontal(|ui| {
            let label = ui.label("Name");
            let field = egui::TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(label.id);
            if std::mem::take(&mut self.is_fresh) {
                field.request_focus();
            }
            entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        });
        ui.horizontal(|ui| {
            let path = self.path();
            let exists = !self.purpose.is_reading() && path.as_ref().is_some_and(|path| path.is_file());
            let words = if exists { "Replace" } else { self.purpose.button() };
            let go = ui.add_enabled(path.is_some(), egui::Button::new(words)).clicked();
            if go || (entered && !exists) {
                match path {
                    Some(path) if path.is_dir() => self.enter(path),
                    Some(path) => answer = Answer::Chosen(path),
                    None => {}
                }
            }
            if ui.button("Cancel").clicked() {
                answer = Answer::Cancelled;
            }
        });
        answer
    }

    fn entries_ui(&mut self, ui: &mut egui::Ui) -> Option<Answer> {
        let mut folder_to_enter = None;
        let mut answer = None;
        for entry in &self.entries {
            match entry {
                Entry::Folder(name) => {
                    if ui.selectable_label(false, format!("{name}/")).clicked() {
                        folder_to_enter = Some(self.folder.join(name));
                    }
                }
                Entry::File(name) => {
                    let response = ui.selectable_label(self.name == *name, name);
                    if response.double_clicked() && self.purpose.is_reading() {
                        answer = Some(Answer::Chosen(self.folder.join(name)));
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
            ui.weak("Nothing here that fits. Go up, or type a name.");
        }
        answer
    }

    /// The file named, with the extension that the purpose asks for where it has none.
    fn path(&self) -> Option<PathBuf> {
        let name = self.name.trim();
        if name.is_empty() {
            return None;
        }
        let path = self.folder.join(name);
        let bare = !self.purpose.is_reading() && path.extension().is_none();
        Some(if bare { path.with_extension(self.purpose.extensions()[0]) } else { path })
    }
}
