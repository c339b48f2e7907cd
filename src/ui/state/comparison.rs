//! Requests to the comparison of methods: files to write, and moves of the morph.

use freebound_core::problem::Variant;

/// Files that can be written of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonExport {
    /// The embeddings side by side.
    Picture,
    /// The table.
    Table,
    /// Every step of every method.
    Steps,
    /// The morph that shows.
    Morph,
}

impl ComparisonExport {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 4] = [Self::Picture, Self::Table, Self::Steps, Self::Morph];

    /// Its entry in menus, and what it is.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Picture => ["Picture…", "PNG, drawn anew: the embeddings at one scale, with their numbers"],
            Self::Table => ["Table…", "CSV, a line for each method"],
            Self::Steps => ["Steps…", "CSV, every step of every method with its seconds, energy and stretch"],
            Self::Morph => ["Animated picture…", "APNG, drawn anew: the morph that shows, there and back"],
        }
    }
}

/// Requests to the morph.
#[derive(Clone, Debug, PartialEq)]
pub enum MorphRequest {
    /// Shows it in the place of the cells, or the cells again.
    Toggle,
    /// Begins it with the map of a method.
    From(Variant),
    /// Ends it with the map of a method.
    To(Variant),
    /// Shows it at a share of its time, 0 to 1.
    Seek(f64),
    /// Plays it from where it stands, or from the beginning where it stands at its end; or stops playing.
    Play,
}
