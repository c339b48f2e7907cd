//! State of the windows that help: command palette, list of keys, documentation, messages of this run, and About.

use eframe::egui::KeyboardShortcut;
use egui_commonmark::CommonMarkCache;

use crate::ui::documentation::{BookAnchor, FoundSection, PAGES, ShownPage};

/// Greatest number of recent commands.
const MOST_RECENT: usize = 8;

/// Command palette that is open.
#[derive(Clone, Debug, Default)]
pub(in crate::ui) struct Palette {
    pub(in crate::ui) query: String,
    /// Row of the selected command.
    pub(in crate::ui) row: usize,
    /// True once its field has the focus.
    pub(in crate::ui) has_focus: bool,
}

/// Change of keys that another binding has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) struct KeyClash {
    /// Binding to be changed, by its place in the table.
    pub(in crate::ui) place: usize,
    pub(in crate::ui) shortcut: KeyboardShortcut,
    /// Binding that has the keys.
    pub(in crate::ui) owner: usize,
}

/// State of the list of keys.
#[derive(Clone, Debug, Default)]
pub(in crate::ui) struct KeyList {
    pub(in crate::ui) query: String,
    /// True once its field has the focus.
    pub(in crate::ui) has_focus: bool,
    /// Binding that the next press changes, by its place in the table.
    pub(in crate::ui) listens_for: Option<usize>,
    pub(in crate::ui) clash: Option<KeyClash>,
}

/// Documentation window that is open.
#[derive(Debug)]
pub(in crate::ui) struct DocumentationView {
    pub(in crate::ui) query: String,
    /// True once its search field has the focus.
    pub(in crate::ui) has_focus: bool,
    /// Sections that the search found.
    pub(in crate::ui) found: Vec<FoundSection>,
    /// Page, and the heading that was asked for.
    now: BookAnchor,
    pub(in crate::ui) shown: ShownPage,
    /// Heading to scroll to in the next frame.
    goal: Option<BookAnchor>,
    /// Pages before this one.
    before: Vec<BookAnchor>,
    /// State of the viewer.
    pub(in crate::ui) cache: CommonMarkCache,
}

impl DocumentationView {
    fn new(anchor: BookAnchor) -> Self {
        let mut view = Self {
            query: String::new(),
            has_focus: false,
            found: Vec::new(),
            now: anchor.clone(),
            shown: ShownPage::default(),
            goal: None,
            before: Vec::new(),
            cache: CommonMarkCache::default(),
        };
        view.show(anchor);
        view
    }

    /// Number of the page.
    pub(in crate::ui) fn page_number(&self) -> usize {
        self.now.page
    }

    pub(in crate::ui) fn go_to(&mut self, anchor: BookAnchor) {
        self.before.push(self.now.clone());
        self.show(anchor);
    }

    pub(in crate::ui) fn can_go_back(&self) -> bool {
        !self.before.is_empty()
    }

    /// Returns to the page before.
    pub(in crate::ui) fn go_back(&mut self) {
        if let Some(anchor) = self.before.pop() {
            self.show(anchor);
        }
    }

    /// Heading to scroll to, once.
    pub(in crate::ui) fn take_goal(&mut self) -> Option<BookAnchor> {
        self.goal.take()
    }

    fn show(&mut self, anchor: BookAnchor) {
        self.shown = PAGES[anchor.page].shown();
        self.goal = Some(anchor.clone());
        self.now = anchor;
        self.cache.link_hooks_clear();
        for (link, _) in &self.shown.links {
            self.cache.add_link_hook(link.clone());
        }
    }
}

/// Windows that help.
#[derive(Debug, Default)]
pub struct Help {
    pub(in crate::ui) palette: Option<Palette>,
    /// Names of the commands chosen last in the palette, newest first.
    pub(in crate::ui) recent: Vec<String>,
    pub(in crate::ui) keys: KeyList,
    pub(in crate::ui) log_shown: bool,
    pub(in crate::ui) about_shown: bool,
    pub(in crate::ui) documentation: Option<DocumentationView>,
}

impl Help {
    /// True if the command palette is open.
    pub fn has_palette(&self) -> bool {
        self.palette.is_some()
    }

    /// True if the documentation is open.
    pub fn has_documentation(&self) -> bool {
        self.documentation.is_some()
    }

    /// True if a window with words to read is open.
    pub(in crate::ui) fn is_reading(&self) -> bool {
        self.documentation.is_some() || self.about_shown || self.log_shown
    }

    /// Opens the documentation at a place. Without a place, opens it at its beginning, or closes it.
    pub(in crate::ui) fn show_documentation(&mut self, place: Option<&str>) {
        self.documentation = match (place, self.documentation.take()) {
            (None, Some(_)) => None,
            (place, None) => Some(DocumentationView::new(BookAnchor::of(place.unwrap_or_default()))),
            (Some(place), Some(mut view)) => {
                view.go_to(BookAnchor::of(place));
                Some(view)
            }
        };
    }

    /// Opens the command palette, or closes it.
    pub(in crate::ui) fn toggle_palette(&mut self) {
        self.palette = if self.palette.is_some() { None } else { Some(Palette::default()) };
    }

    /// Puts a command first among the recent ones.
    pub(in crate::ui) fn remember(&mut self, id: String) {
        self.recent.retain(|other| *other != id);
        self.recent.insert(0, id);
        self.recent.truncate(MOST_RECENT);
    }

    /// Closes one window. Returns true if one was open.
    pub(in crate::ui) fn close(&mut self) -> bool {
        self.palette.take().is_some()
            || self.documentation.take().is_some()
            || std::mem::take(&mut self.log_shown)
            || std::mem::take(&mut self.about_shown)
    }
}
