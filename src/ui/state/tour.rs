//! The guided tour: its cards, and what the window was like when a card came up.

use crate::view::OrbitCamera;
use freebound_core::pipeline::Targets;

/// Card of the tour. Each asks for one action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TourCard {
    /// Turn the mesh.
    Look,
    /// Pin a vertex.
    Pin,
    /// Drag a pin.
    Drag,
    /// Take steps until the map is planar.
    Step,
    /// Place a landmark on the photo.
    Landmark,
    /// Export the map.
    Export,
}

impl TourCard {
    /// All cards, in order.
    pub const ALL: [Self; 6] = [Self::Look, Self::Pin, Self::Drag, Self::Step, Self::Landmark, Self::Export];

    /// Title and instruction.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Look => ["Turn the mesh", "Drag with the left button over the mesh. The wheel zooms."],
            Self::Pin => {
                ["Pin a vertex", "Press P, then click a vertex of the mesh. It stays at its place in the map."]
            }
            Self::Drag => ["Drag the pin", "Drag the pin's square in the embedding. The map follows the pointer."],
            Self::Step => [
                "Repair the folds",
                "Press Space for a step, until the pill at the top says Planar. Red faces are folded.",
            ],
            Self::Landmark => [
                "Place a landmark",
                "Press C. Click a vertex of the mesh, then its place in the embedding. With a photo, click the same \
                 feature there.",
            ],
            Self::Export => ["Export the map", "Press Ctrl+E and choose a format. The file holds what was proved."],
        }
    }
}

/// State of the window when a card came up.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::ui) struct TourStart {
    /// Revision of the mesh. Another mesh restarts the card.
    pub(in crate::ui) mesh: u64,
    /// Camera of the mesh pane.
    pub(in crate::ui) camera: Option<OrbitCamera>,
    /// Pins of the document.
    pub(in crate::ui) targets: Targets,
    /// True if the list of exports showed, and was not closed since.
    pub(in crate::ui) exports_shown: bool,
}

/// The tour under way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tour {
    /// Place of the current card.
    pub(in crate::ui) place: usize,
    /// State when the card came up; `None` before its first frame.
    pub(in crate::ui) start: Option<TourStart>,
    /// True once the action of the card was done.
    pub(in crate::ui) is_done: bool,
}

impl Tour {
    /// Current card.
    pub fn card(&self) -> TourCard {
        TourCard::ALL[self.place.min(TourCard::ALL.len() - 1)]
    }

    /// True once the action of the current card was done.
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// Tour at the next card; `None` after the last.
    pub(in crate::ui) fn next(&self) -> Option<Self> {
        let place = self.place + 1;
        (place < TourCard::ALL.len()).then(|| Self { place, ..Self::default() })
    }
}
