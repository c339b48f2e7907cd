//! Requests to the method comparison: file exports, and control of the morph.

use freebound_core::problem::Variant;

/// Exports of the method comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonExport {
    /// Embeddings side by side.
    Picture,
    /// Embeddings side by side as a drawing.
    Drawing,
    /// Embeddings side by side as a document.
    Document,
    /// Table of the methods.
    Table,
    /// Every step of every method.
    Steps,
    /// Morph on the screen.
    Morph,
}

impl ComparisonExport {
    /// All exports, in menu order.
    pub const ALL: [Self; 6] = [Self::Picture, Self::Drawing, Self::Document, Self::Table, Self::Steps, Self::Morph];

    /// Menu entry and description.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Picture => ["Picture…", "PNG: the embeddings at one scale, with their numbers"],
            Self::Drawing => ["Drawing…", "SVG: the embeddings at one scale, with their numbers"],
            Self::Document => ["Document…", "PDF: the embeddings at one scale, with their numbers"],
            Self::Table => ["Table…", "CSV, a line for each method"],
            Self::Steps => ["Steps…", "CSV, every step of every method with its seconds, energy and stretch"],
            Self::Morph => ["Animated picture…", "APNG: the morph on the screen, forwards and back"],
        }
    }
}

/// Requests to the morph.
#[derive(Clone, Debug, PartialEq)]
pub enum MorphRequest {
    /// Shows the morph in place of the cells, or the cells again.
    Toggle,
    /// Sets the method at the start.
    From(Variant),
    /// Sets the method at the end.
    To(Variant),
    /// Shows the frame at a time, 0 to 1.
    Seek(f64),
    /// Plays from the current time, or from the start if the morph is at its end; or stops playing.
    Play,
}
