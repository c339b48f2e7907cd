//! Things to choose by name. Each kind has one table, its [`NamedOption::words`], from which the command line, the editor,
//! reports and project files take names and words.

use std::borrow::Cow;

/// What a choice is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Labels {
    /// Its name on the command line, in reports and in project files.
    pub name: &'static str,
    /// Its name on the screen.
    pub title: &'static str,
    /// What it does, in one line.
    pub about: &'static str,
    /// The paper's section, or where else it comes from; empty where there is nothing to name.
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

    /// What it does and where it comes from.
    pub fn tip(&self) -> String {
        if self.source.is_empty() { self.about.to_owned() } else { format!("{} ({})", self.about, self.source) }
    }
}

/// One of a few things to choose by name.
pub trait NamedOption: Clone + Send + Sync + 'static {
    /// All there are to choose, in the order of menus; those with a number, with a usual one.
    const ALL: &'static [Self];

    /// What it is called.
    fn labels(&self) -> Labels;

    /// The name, without the number that some have.
    fn name(&self) -> &'static str {
        self.labels().name
    }

    /// The name as files have it, with its number.
    fn written(&self) -> Cow<'static, str> {
        self.name().into()
    }

    /// The one that is written so.
    fn named(text: &str) -> Option<Self> {
        Self::ALL.iter().find(|choice| choice.name() == text).cloned()
    }

    /// All names, as a message lists them.
    fn names() -> String {
        Self::ALL.iter().map(Self::name).collect::<Vec<_>>().join(", ")
    }
}
