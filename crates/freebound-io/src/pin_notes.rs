//! Names of pins and landmarks, and notes on pins that no solve needs.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use freebound_core::mesh::VertexId;

/// Name of a pin or of a landmark: one line of letters, with single spaces.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct PinName(Arc<str>);

/// Reason why a text is no name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PinNameFault {
    /// The text has no letters.
    #[error("the name is empty")]
    Empty,
    /// The text has too many characters.
    #[error("the name has {0} characters: use at most {most}", most = PinName::LONGEST)]
    TooLong(usize),
    /// The text has a character without a sign, such as a line break.
    #[error("the name has a control character: use letters, numbers and signs")]
    Control,
}

impl PinName {
    /// Greatest number of characters of a name.
    pub const LONGEST: usize = 60;

    /// Name from a text. White space at its ends is dropped, other white space becomes a single space.
    ///
    /// # Errors
    ///
    /// [`PinNameFault`] if nothing is left, the name is too long, or it has a control character.
    pub fn new(text: &str) -> Result<Self, PinNameFault> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let name = words.join(" ");
        let length = name.chars().count();
        match length {
            0 => Err(PinNameFault::Empty),
            _ if length > Self::LONGEST => Err(PinNameFault::TooLong(length)),
            _ if name.chars().any(char::is_control) => Err(PinNameFault::Control),
            _ => Ok(Self(name.into())),
        }
    }

    /// Text of the name.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Key for joins by name: names that differ only in capital letters are equal.
    pub fn key(&self) -> String {
        self.0.to_lowercase()
    }
}

impl fmt::Display for PinName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl TryFrom<String> for PinName {
    type Error = PinNameFault;

    fn try_from(text: String) -> Result<Self, PinNameFault> {
        Self::new(&text)
    }
}

impl From<PinName> for String {
    fn from(name: PinName) -> Self {
        name.0.as_ref().to_owned()
    }
}

/// Note on a pin, which no solve needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PinNote {
    /// Name of the pin.
    pub name: Option<PinName>,
}

impl PinNote {
    /// Note with a name only.
    pub fn named(name: PinName) -> Self {
        Self { name: Some(name) }
    }

    /// True if the note says nothing.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Notes on pins. Pins without an entry have an empty note.
pub type PinNotes = BTreeMap<VertexId, PinNote>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_one_line_of_visible_characters() {
        assert_eq!(PinName::new("  left  eye,\n outer ").unwrap().as_str(), "left eye, outer");
        assert_eq!(PinName::new(" \t"), Err(PinNameFault::Empty));
        assert_eq!(PinName::new("a\u{0}b"), Err(PinNameFault::Control));
        let longest = "é".repeat(PinName::LONGEST);
        assert_eq!(PinName::new(&longest).unwrap().as_str(), longest);
        assert_eq!(PinName::new(&format!("{longest}é")), Err(PinNameFault::TooLong(PinName::LONGEST + 1)));
    }

    #[test]
    fn capital_letters_do_not_tell_names_apart() {
        assert_eq!(PinName::new("Left Eye").unwrap().key(), PinName::new("left eye").unwrap().key());
    }
}
