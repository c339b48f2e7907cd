//! Ways to select vertices by the mesh, by the map and by the selection.

/// Ways to select vertices, or charts of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectBy {
    /// Selects everything.
    All,
    /// Inverts the selection.
    Invert,
    /// Adds the neighbours.
    Grow,
    /// Removes the rim.
    Shrink,
    /// Adds faces until sharp edges.
    SharpEdges,
    /// Follows edges straight.
    Loops,
    /// Goes across quadrilaterals, from edge to opposite edge.
    Rings,
    /// Selects the boundary.
    Boundary,
    /// Selects the pins, or charts with pins.
    Pins,
    /// Selects what is most distorted.
    Distorted,
}

impl SelectBy {
    /// All ways, in the order of the menu.
    pub const ALL: [Self; 10] = [
        Self::All,
        Self::Invert,
        Self::Grow,
        Self::Shrink,
        Self::SharpEdges,
        Self::Loops,
        Self::Rings,
        Self::Boundary,
        Self::Pins,
        Self::Distorted,
    ];

    /// Reason why the way does not apply to vertices, or to the charts of the page.
    pub(in crate::ui) const fn reason(self, is_on_page: bool) -> &'static str {
        match self {
            Self::Grow | Self::Shrink | Self::SharpEdges | Self::Loops | Self::Rings | Self::Boundary if is_on_page => {
                "Show one chart alone first"
            }
            Self::Loops | Self::Rings => "Select both ends of an edge first",
            Self::Grow | Self::Shrink | Self::SharpEdges => "Select vertices of the map first",
            Self::All | Self::Invert | Self::Boundary => "Open a mesh first",
            Self::Pins => "There are no pins",
            Self::Distorted if is_on_page => "No chart has an energy above 4.1",
            Self::Distorted => "There is no map yet",
        }
    }

    /// Entry of the menu, and its description.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::All => ["Select all", "All vertices, or all charts of the page"],
            Self::Invert => ["Invert the selection", "Vertices or charts that are not selected"],
            Self::Grow => ["Grow the selection", "Adds the neighbours of the selected vertices"],
            Self::Shrink => ["Shrink the selection", "Keeps only vertices whose neighbours are all selected"],
            Self::SharpEdges => {
                ["Select up to sharp edges", "Faces that are reached from the selection without crossing a sharp edge"]
            }
            Self::Loops => ["Select edge loops", "From each selected edge straight, to its end or around"],
            Self::Rings => ["Select edge rings", "From each selected edge across quadrilaterals to the opposite edge"],
            Self::Boundary => ["Select the boundary", "Vertices of the boundary, and of holes that were filled"],
            Self::Pins => ["Select the pins", "Vertices with pins, or charts with them"],
            Self::Distorted => {
                ["Select the most distorted", "The worst tenth of the area, or the charts with an energy above 4.1"]
            }
        }
    }
}
