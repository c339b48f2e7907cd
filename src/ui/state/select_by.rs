//! Kinds of what is selected, and ways to select by the mesh, by the map and by the selection.

use crate::view::ElementKind;

/// Kinds of what clicks and regions select.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SelectionKind {
    /// Charts of the page. Vertices of a chart that is shown alone.
    #[default]
    Charts,
    /// Vertices, edges or faces.
    Elements(ElementKind),
}

impl SelectionKind {
    /// All kinds, in the order of menus.
    pub const ALL: [Self; 4] = [
        Self::Elements(ElementKind::Vertices),
        Self::Elements(ElementKind::Edges),
        Self::Elements(ElementKind::Faces),
        Self::Charts,
    ];

    /// Title for menus and buttons, and description.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Elements(ElementKind::Vertices) => ["Vertices", "Clicks and regions select vertices"],
            Self::Elements(ElementKind::Edges) => ["Edges", "Clicks and regions select edges"],
            Self::Elements(ElementKind::Faces) => ["Faces", "Clicks and regions select faces"],
            Self::Charts => ["Charts", "Clicks and regions select charts of the page"],
        }
    }
}

/// Ways to select vertices, edges, faces, or charts of the page.
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
    /// Adds everything that is connected with the selection.
    Connected,
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
    pub const ALL: [Self; 11] = [
        Self::All,
        Self::Invert,
        Self::Grow,
        Self::Shrink,
        Self::SharpEdges,
        Self::Connected,
        Self::Loops,
        Self::Rings,
        Self::Boundary,
        Self::Pins,
        Self::Distorted,
    ];

    /// Reason why the way does not apply to elements, or to the charts of the page.
    /// `kind` is the kind of the elements; `None` for charts.
    pub(in crate::ui) const fn reason(self, kind: Option<ElementKind>) -> &'static str {
        let are_charts = kind.is_none();
        match self {
            Self::Grow
            | Self::Shrink
            | Self::SharpEdges
            | Self::Connected
            | Self::Loops
            | Self::Rings
            | Self::Boundary
                if are_charts =>
            {
                "Choose vertices, edges or faces first"
            }
            Self::Loops => "Select an edge, or two faces beside each other, first",
            Self::Rings if matches!(kind, Some(ElementKind::Faces)) => "Choose vertices or edges first",
            Self::Rings => "Select an edge first",
            Self::Grow | Self::Shrink | Self::SharpEdges | Self::Connected => "Select something first",
            Self::All | Self::Invert | Self::Boundary => "Open a mesh first",
            Self::Pins if matches!(kind, Some(ElementKind::Edges | ElementKind::Faces)) => "Choose vertices first",
            Self::Pins => "There are no pins to select",
            Self::Distorted if are_charts => "No chart has an energy above 4.1",
            Self::Distorted => "There is no map yet",
        }
    }

    /// Entry of the menu, and its description.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::All => ["Select all", "All vertices, edges, faces or charts"],
            Self::Invert => ["Invert the selection", "Selects what is not selected"],
            Self::Grow => ["Grow the selection", "Adds the neighbours of what is selected"],
            Self::Shrink => ["Shrink the selection", "Keeps only what has all its neighbours selected"],
            Self::SharpEdges => {
                ["Select up to sharp edges", "Faces that are reached from the selection without crossing a sharp edge"]
            }
            Self::Connected => ["Select all connected", "Everything on the charts of the selection"],
            Self::Loops => ["Select edge loops", "From each selected edge straight, to its end or around"],
            Self::Rings => ["Select edge rings", "From each selected edge across quadrilaterals to the opposite edge"],
            Self::Boundary => ["Select the boundary", "The boundary, and the rims of holes that were filled"],
            Self::Pins => ["Select the pins", "Vertices with pins, or charts with them"],
            Self::Distorted => {
                ["Select the most distorted", "The worst tenth of the area, or the charts with an energy above 4.1"]
            }
        }
    }
}
