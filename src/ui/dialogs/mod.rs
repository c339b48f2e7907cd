//! File dialogs: the native dialog of the system if there is one, else a dialog inside the window.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | choice between the two dialogs; the native dialog, off the UI thread |
//! | `browser.rs` | state of the dialog inside the window, and the effect of clicks and keys |
//! | `browser_ui.rs` | its drawing |
//! | `listing.rs` | contents of a folder: read in the background, filtered and sorted |

mod browser;
mod browser_ui;
mod listing;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;

use super::state::{DialogForm, FileDialogKind};
use crate::session::{Background, JobFailure, KeptFolders, Wake};
use browser::{Browser, DialogAnswer};
use listing::ListOrder;

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
    /// Folders that the dialog inside the window offers.
    pub(in crate::ui) folders: KeptFolders,
    /// Order of its list, kept from dialog to dialog.
    order: ListOrder,
}

/// Request to the native dialog, and its time.
struct Asked {
    kind: FileDialogKind,
    suggestion: PathBuf,
    since: Instant,
    wake: Wake,
}

impl Dialogs {
    /// Dialogs inside the window only, for tests and for systems without native dialogs.
    pub fn inside_the_window() -> Self {
        Self { native_missing: true, ..Self::default() }
    }

    pub fn is_open(&self) -> bool {
        self.native.is_some() || self.is_inside()
    }

    /// True if the dialog inside the window is open. All keys then belong to it.
    pub(in crate::ui) fn is_inside(&self) -> bool {
        self.browser.is_some()
    }

    /// True while the dialog inside the window reads a folder.
    pub fn is_listing(&self) -> bool {
        self.browser.as_ref().is_some_and(Browser::is_listing)
    }

    /// Opens a dialog, unless one is open. `suggestion` is the suggested folder and name.
    pub(in crate::ui) fn ask(&mut self, wake: &Wake, kind: FileDialogKind, suggestion: PathBuf) {
        if self.is_open() {
            return;
        }
        if self.native_missing || !may_have_native() {
            self.browse(wake, kind, &suggestion);
            return;
        }
        let dialog = native_dialog(kind, &suggestion);
        let native = self.native.insert(Background::new("file dialog", wake));
        let asked = Asked { kind, suggestion, since: Instant::now(), wake: Arc::clone(wake) };
        native.start(asked, |_| pollster::block_on(dialog));
    }

    /// Opens the dialog inside the window. Default folder: the one used last.
    fn browse(&mut self, wake: &Wake, kind: FileDialogKind, suggestion: &Path) {
        let suggested = suggestion.parent().filter(|folder| folder.is_dir());
        let last = || self.folders.recent.first().filter(|folder| folder.is_dir()).cloned();
        let here = || std::env::current_dir().unwrap_or_default();
        let folder = suggested.map(Path::to_owned).or_else(last).unwrap_or_else(here);
        let name = if kind.is_reading() { String::new() } else { name_of(suggestion) };
        self.browser = Some(Browser::new(wake, kind, folder, name).ordered(self.order));
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
            self.browse(&asked.wake, asked.kind, &asked.suggestion);
        }
        let path = answer?;
        self.remember(&path);
        Some(DialogChoice { kind: asked.kind, path })
    }

    /// Shows the dialog inside the window, if it is open. Returns the file once chosen.
    pub fn show(&mut self, context: &egui::Context) -> Option<DialogChoice> {
        let browser = self.browser.as_mut()?;
        let answer = browser.show(context, &mut self.folders)?;
        self.order = browser.order();
        self.browser = None;
        match answer {
            DialogAnswer::Cancelled => None,
            DialogAnswer::Chosen(choice) => {
                self.remember(&choice.path);
                Some(choice)
            }
        }
    }

    /// Leaves the question of the dialog inside the window, or closes this dialog. Returns true if it was open.
    pub fn close(&mut self) -> bool {
        let Some(browser) = &mut self.browser else { return false };
        if !browser.leave_question() {
            self.order = browser.order();
            self.browser = None;
        }
        true
    }

    /// Puts the folder of a chosen file first among the recent folders.
    fn remember(&mut self, path: &Path) {
        if let Some(folder) = path.parent().filter(|folder| folder.is_absolute()) {
            self.folders.remember(folder);
        }
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
