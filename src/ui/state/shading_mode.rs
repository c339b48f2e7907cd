//! Colours of faces, chosen by the user.

use super::pane::Pane;
use crate::view::Quantity;

/// Colours of faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadingMode {
    /// Clay.
    Plain,
    /// Checkerboard in the plane, mapped to the mesh.
    #[default]
    Checker,
    /// Picture, mapped to the mesh; the checkerboard if there is no picture.
    Picture,
    /// Angle distortion.
    Angle,
    /// Area distortion.
    Area,
    /// Stretch.
    Stretch,
    /// Distance moved since another step.
    Move,
    /// Translucent faces over the picture, for the embedding only.
    SeeThrough,
    /// Column of a table that the user opened. Not among [`ALL`](Self::ALL): menus list its columns.
    Column,
}

impl ShadingMode {
    /// All shadings, in the order of menus.
    pub const ALL: [Self; 8] = [
        Self::Plain,
        Self::Checker,
        Self::Picture,
        Self::Angle,
        Self::Area,
        Self::Stretch,
        Self::Move,
        Self::SeeThrough,
    ];

    /// True if a pane offers this shading.
    pub fn is_for(self, pane: Pane) -> bool {
        self != Self::SeeThrough || pane == Pane::Plane
    }

    /// Shading with a name, if there is one.
    pub(in crate::ui) fn called(name: Option<&str>) -> Option<Self> {
        Self::ALL.into_iter().find(|shading| Some(shading.title()) == name)
    }

    /// True if each face is coloured by a number.
    pub(in crate::ui) const fn is_by_number(self) -> bool {
        matches!(self, Self::Angle | Self::Area | Self::Stretch | Self::Move | Self::Column)
    }

    /// Quantity that colours the faces, if the shading shows a distortion.
    pub(in crate::ui) const fn quantity(self) -> Option<Quantity> {
        match self {
            Self::Angle => Some(Quantity::Angle),
            Self::Area => Some(Quantity::Area),
            Self::Stretch => Some(Quantity::Stretch),
            Self::Plain | Self::Checker | Self::Picture | Self::Move | Self::SeeThrough | Self::Column => None,
        }
    }

    /// Name in menus.
    pub const fn title(self) -> &'static str {
        self.words()[0]
    }

    /// Name in menus, and description.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Plain => ["Plain", "only defects are coloured"],
            Self::Checker => ["Checker", "squares of the plane, mapped to the mesh: they show angles and sizes"],
            Self::Picture => ["Picture", "the picture, mapped to the mesh; a checker if there is no picture"],
            Self::Angle => ["Angle distortion", "ratio of the singular values σ₁/σ₂ per face: 1 keeps angles"],
            Self::Area => [
                "Area distortion",
                "area in the plane over area on the mesh per face, at equal total areas: 1 keeps areas",
            ],
            Self::Stretch => ["Stretch", "root mean square stretch from the plane to the mesh per face (L²)"],
            Self::Move => ["Move", "movement of faces since the compared step, or since the previous step"],
            Self::Column => ["Column", "number of a table for each vertex or face"],
            Self::SeeThrough => ["See-through", "faces filled at 30 %, so that the picture behind them is visible"],
        }
    }
}
