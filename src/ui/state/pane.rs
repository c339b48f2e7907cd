//! The two panes, and the tabs of the panel at the right.

/// Panes of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The mesh in space.
    Mesh,
    /// Its embedding.
    Plane,
}

impl Pane {
    /// From left to right.
    pub(in crate::ui) const BOTH: [Self; 2] = [Self::Mesh, Self::Plane];

    /// Title of the pane.
    pub(in crate::ui) const fn title(self) -> &'static str {
        match self {
            Self::Mesh => "Mesh",
            Self::Plane => "Embedding",
        }
    }
}

/// A panel at the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// Method and weights.
    #[default]
    Method,
    /// The pins.
    Pins,
    /// Defects of the embedding.
    Defects,
    /// The selected vertex.
    Vertex,
    /// The charts of a mesh that has several.
    Charts,
}

impl Tab {
    /// All tabs, from left to right.
    pub const ALL: [Self; 5] = [Self::Method, Self::Pins, Self::Defects, Self::Vertex, Self::Charts];

    /// Its name.
    pub const fn title(self) -> &'static str {
        ["Method", "Pins", "Defects", "Vertex", "Charts"][self as usize]
    }
}
