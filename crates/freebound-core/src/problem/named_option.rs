//! Options that are chosen by name. Each kind has one table, [`NamedOption::labels`]. The command line, the editor,
//! reports and project files take names and descriptions from this table.

use std::borrow::Cow;

/// Labels of an option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Labels {
    /// Name on the command line, in reports and in project files.
    pub name: &'static str,
    /// Name on the screen.
    pub title: &'static str,
    /// Description in one line.
    pub about: &'static str,
    /// Section of the paper, or another source. Empty if there is none.
    pub source: &'static str,
}

impl Labels {
    /// Name and title, with neither description nor source.
    pub const fn new(name: &'static str, title: &'static str) -> Self {
        Self { name, title, about: "", source: "" }
    }

    /// Adds the description.
    #[must_use]
    pub const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }

    /// Adds the source.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// Description, with the source in brackets.
    pub fn tip(&self) -> String {
        if self.source.is_empty() { self.about.to_owned() } else { format!("{} ({})", self.about, self.source) }
    }
}

/// Option that is chosen by name from a few values.
pub trait NamedOption: Clone + Send + Sync + 'static {
    /// All values, in the order of menus. A value that holds a number is listed with a usual one.
    const ALL: &'static [Self];

    /// Labels of the value.
    fn labels(&self) -> Labels;

    /// Name, without the number that some values hold.
    fn name(&self) -> &'static str {
        self.labels().name
    }

    /// Name as written in files, with the number if there is one.
    fn written(&self) -> Cow<'static, str> {
        self.name().into()
    }

    /// Value with this written name.
    fn named(text: &str) -> Option<Self> {
        Self::ALL.iter().find(|choice| choice.name() == text).cloned()
    }

    /// All names, as a message lists them.
    fn names() -> String {
        Self::ALL.iter().map(Self::name).collect::<Vec<_>>().join(", ")
    }
}
