//! Things to choose by name. Each kind has one table, its [`Choice::words`], from which the command line, the editor,
//! reports and project files take names and words.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use serde::ser::{Serialize, Serializer};

use super::{BoundaryShape, Family, Growth, Method, Spacing, Treatment};

/// What a choice is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// Its name on the command line, in reports and in project files.
    pub name: &'static str,
    /// Its name on the screen.
    pub title: &'static str,
    /// What it does, in one line.
    pub about: &'static str,
    /// The paper's section, or where else it comes from; empty where there is nothing to name.
    pub source: &'static str,
}

impl Words {
    pub(super) const fn new(name: &'static str, title: &'static str) -> Self {
        Self { name, title, about: "", source: "" }
    }

    pub(super) const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }

    pub(super) const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// What it does and where it comes from.
    pub fn tip(&self) -> String {
        if self.source.is_empty() { self.about.to_owned() } else { format!("{} ({})", self.about, self.source) }
    }
}

/// One of a few things to choose by name.
pub trait Choice: Copy + Send + Sync + 'static {
    /// All there are to choose, in the order of menus; those with a number, with a usual one.
    const ALL: &'static [Self];

    /// What it is called.
    fn words(self) -> Words;

    /// The name, without the number that some have.
    fn name(self) -> &'static str {
        self.words().name
    }

    /// The name as files have it, with its number.
    fn written(self) -> Cow<'static, str> {
        self.name().into()
    }

    /// The one that is written so.
    fn named(text: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|choice| choice.name() == text)
    }

    /// All names, as a message lists them.
    fn names() -> String {
        Self::ALL.iter().map(|choice| choice.name()).collect::<Vec<_>>().join(", ")
    }
}

/// Reads a choice by its name. A fault is noticed at the name, so that it is told with its line.
struct ByName<C>(PhantomData<C>);

impl<C: Choice> Visitor<'_> for ByName<C> {
    type Value = C;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "one of {}", C::names())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<C, E> {
        C::named(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

/// Has choices stand in files by their names.
macro_rules! stand_by_name {
    ($($choice:ty),+) => {$(
        impl Serialize for $choice {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(&self.written())
            }
        }

        impl<'de> Deserialize<'de> for $choice {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_str(ByName(PhantomData))
            }
        }
    )+};
}

stand_by_name!(Method, BoundaryShape, Spacing, Family, Treatment, Growth);
