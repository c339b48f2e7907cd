//! State of the file dialog inside the window, and the effect of clicks and keys.

use std::path::{Path, PathBuf};

use super::DialogChoice;
use super::listing::{ListColumn, ListOrder, Listing};
use crate::session::Wake;
use crate::ui::state::{DialogForm, FileDialogKind};

/// Answer of the user.
#[derive(Debug)]
pub(super) enum DialogAnswer {
    Cancelled,
    Chosen(DialogChoice),
}

/// Click on a row.
#[derive(Clone, Debug)]
struct RowClick {
    name: String,
    /// Time of the click, seconds.
    time: f64,
}

/// Clicks on rows. Two clicks are a double click only if both hit one entry of one folder.
#[derive(Debug, Default)]
struct RowClicks {
    last: Option<RowClick>,
    /// Time when a double click entered the folder, seconds.
    entered: Option<f64>,
}

/// File dialog inside the window.
#[derive(Debug)]
pub(super) struct Browser {
    pub(super) kind: FileDialogKind,
    pub(super) folder: PathBuf,
    /// Text of the name field.
    pub(super) name: String,
    pub(super) listing: Listing,
    /// Name of the selected entry.
    pub(super) selected: Option<String>,
    /// True if the list scrolls to the selected row in the next frame.
    pub(super) follows: bool,
    clicks: RowClicks,
    /// Existing file that is replaced if the user agrees.
    pub(super) overwrite: Option<PathBuf>,
    /// Reason why the named file cannot be chosen.
    pub(super) refusal: Option<String>,
    /// True until the dialog has been shown: its first frame focuses a field.
    pub(super) is_fresh: bool,
    pub(super) answer: Option<DialogAnswer>,
}

impl Browser {
    pub(super) fn new(wake: &Wake, kind: FileDialogKind, folder: PathBuf, name: String) -> Self {
        let mut browser = Self {
            kind,
            // Resolve the dots of a relative path, so that "Up" always works.
            folder: folder.canonicalize().unwrap_or(folder),
            name,
            listing: Listing::new(wake),
            selected: None,
            follows: false,
            clicks: RowClicks::default(),
            overwrite: None,
            refusal: None,
            is_fresh: true,
            answer: None,
        };
        browser.listing.read(&browser.folder);
        browser
    }

    /// Sets the order of the list.
    pub(super) fn ordered(mut self, order: ListOrder) -> Self {
        self.listing.order = order;
        self
    }

    pub(super) fn order(&self) -> ListOrder {
        self.listing.order
    }

    pub(super) fn is_listing(&self) -> bool {
        self.listing.is_busy()
    }

    pub(super) fn form(&self) -> DialogForm {
        self.kind.form()
    }

    /// Withdraws the question about an existing file. Returns true if it was asked.
    pub(super) fn leave_question(&mut self) -> bool {
        self.overwrite.take().is_some()
    }

    /// Lists another folder. Nothing is selected there.
    pub(super) fn enter(&mut self, folder: PathBuf) {
        if self.kind.is_reading() {
            self.name.clear();
        }
        (self.selected, self.overwrite, self.refusal) = (None, None, None);
        self.clicks = RowClicks::default();
        self.folder = folder;
        self.listing.read(&self.folder);
    }

    /// Lists the parent folder and selects the folder that was left.
    pub(super) fn go_up(&mut self) {
        let Some(parent) = self.folder.parent().map(Path::to_owned) else { return };
        let left = self.folder.file_name().map(|name| name.to_string_lossy().into_owned());
        self.enter(parent);
        (self.selected, self.follows) = (left, true);
    }

    /// Sorts by a column, or reverses its order.
    pub(super) fn sort_by(&mut self, column: ListColumn) {
        self.listing.order = self.listing.order.clicked(column);
        self.arrange();
    }

    /// Lists anew after a change of filter or order.
    pub(super) fn arrange(&mut self) {
        let form = self.form();
        self.listing.arrange(&form);
        if self.selected.as_ref().is_some_and(|name| self.listing.row_of(name).is_none()) {
            self.deselect();
        }
    }

    fn deselect(&mut self) {
        let is_named = self.selected.take().is_some_and(|name| name == self.name);
        if is_named && self.kind.is_reading() {
            self.name.clear();
        }
    }

    /// Selects the entry of a row. A file fills in the name.
    pub(super) fn select(&mut self, row: usize) {
        let Some(entry) = self.listing.row(row) else { return };
        if !entry.is_folder() {
            self.name.clone_from(&entry.name);
        } else if self.kind.is_reading() {
            self.name.clear();
        }
        self.selected = Some(entry.name.clone());
        (self.overwrite, self.refusal) = (None, None);
    }

    /// Moves the selection by rows.
    pub(super) fn step(&mut self, by: isize) {
        let Some(last) = self.listing.len().checked_sub(1) else { return };
        let now = self.selected.as_ref().and_then(|name| self.listing.row_of(name));
        let next = match now {
            Some(row) => row.saturating_add_signed(by).min(last),
            None if by > 0 => 0,
            None => last,
        };
        self.select(next);
        self.follows = true;
    }

    /// Clicks a row at a time, seconds. Two clicks on one entry within `delay` open it. A click that follows the double
    /// click into this folder does nothing, because its row appeared under the pointer.
    pub(super) fn click(&mut self, row: usize, time: f64, delay: f64) {
        let Some(name) = self.listing.row(row).map(|entry| entry.name.clone()) else { return };
        if self.clicks.entered.is_some_and(|entered| time - entered < delay) {
            return;
        }
        let is_second = self.clicks.last.take().is_some_and(|last| last.name == name && time - last.time < delay);
        self.select(row);
        if is_second {
            self.open_row(row);
            self.clicks.entered = Some(time);
        } else {
            self.clicks.last = Some(RowClick { name, time });
        }
    }

    /// Enters the folder of a row, or chooses its file.
    fn open_row(&mut self, row: usize) {
        let Some(entry) = self.listing.row(row) else { return };
        if entry.is_folder() {
            self.enter(self.folder.join(&entry.name));
        } else {
            self.confirm();
        }
    }

    /// Enter in the list: opens the selected row, else the named file.
    pub(super) fn open_selected(&mut self) {
        match self.selected.as_ref().and_then(|name| self.listing.row_of(name)) {
            Some(row) => self.open_row(row),
            None => self.confirm(),
        }
    }

    /// Path of the named file. A name without extension gets the default extension of the dialog kind when saving.
    pub(super) fn path(&self) -> Option<PathBuf> {
        let name = self.name.trim();
        if name.is_empty() {
            return None;
        }
        let path = self.folder.join(name);
        let bare = !self.kind.is_reading() && path.extension().is_none() && !path.is_dir();
        Some(if bare { path.with_extension(self.form().extensions[0]) } else { path })
    }

    /// True if the button of the dialog has an effect.
    pub(super) fn can_confirm(&self) -> bool {
        !self.name.trim().is_empty() || (self.kind.is_reading() && self.selected.is_some())
    }

    /// Chooses the named file, or enters the named or selected folder. Asks before a file is replaced.
    pub(super) fn confirm(&mut self) {
        let Some(path) = self.path() else {
            let folder = self.selected.clone().filter(|_| self.kind.is_reading());
            return folder.into_iter().for_each(|name| self.enter(self.folder.join(name)));
        };
        if path.is_dir() {
            self.enter(path);
        } else if self.kind.is_reading() && !path.exists() {
            self.refusal = Some(format!("There is no file {} in this folder", self.name.trim()));
        } else if !self.kind.is_reading() && path.exists() {
            self.overwrite = Some(path);
        } else {
            self.choose(path);
        }
    }

    /// Chooses a file.
    pub(super) fn choose(&mut self, path: PathBuf) {
        self.answer = Some(DialogAnswer::Chosen(DialogChoice { kind: self.kind, path }));
    }
}
