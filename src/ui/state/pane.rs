//! Panes of the window, and tabs of the panel at the right.

/// Panes of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// Mesh in space.
    Mesh,
    /// Embedding of the mesh.
    Plane,
}

impl Pane {
    /// Both panes, from left to right.
    pub(in crate::ui) const BOTH: [Self; 2] = [Self::Mesh, Self::Plane];

    /// Title of the pane.
    pub(in crate::ui) const fn title(self) -> &'static str {
        match self {
            Self::Mesh => "Mesh",
            Self::Plane => "Embedding",
        }
    }
}

/// Tab of the panel at the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// Method and weights.
    #[default]
    Method,
    /// Pins.
    Pins,
    /// Defects of the embedding.
    Defects,
    /// Selected vertex.
    Vertex,
    /// Charts, for a mesh that has several.
    Charts,
}

impl Tab {
    /// All tabs, from left to right.
    pub const ALL: [Self; 5] = [Self::Method, Self::Pins, Self::Defects, Self::Vertex, Self::Charts];

    /// Name of the tab.
    pub const fn title(self) -> &'static str {
        ["Method", "Pins", "Defects", "Vertex", "Charts"][self as usize]
    }
}
