//! Colours of faces that a person can choose.

use super::pane::Pane;

/// Colours of faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadingMode {
    /// Clay.
    Plain,
    /// A checker over the plane, carried to the mesh.
    #[default]
    Checker,
    /// The picture, carried to the mesh; the checker where there is none.
    Picture,
    /// Angle distortion.
    Angle,
    /// Area distortion.
    Area,
    /// Stretch.
    Stretch,
    /// Distance moved since another step.
    Move,
    /// Of the embedding alone: a thin fill that the picture behind it shows through.
    SeeThrough,
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

    /// True if a pane can be shaded so.
    pub fn is_for(self, pane: Pane) -> bool {
        self != Self::SeeThrough || pane == Pane::Plane
    }

    /// The shading of that name, where there is one.
    pub(in crate::ui) fn called(name: Option<&str>) -> Option<Self> {
        Self::ALL.into_iter().find(|shading| Some(shading.title()) == name)
    }

    /// True if faces are coloured by a number each.
    pub(in crate::ui) const fn is_by_number(self) -> bool {
        matches!(self, Self::Angle | Self::Area | Self::Stretch | Self::Move)
    }

    /// Its name in menus.
    pub const fn title(self) -> &'static str {
        self.words()[0]
    }

    /// Its name in menus, and what it shows.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Plain => ["Plain", "no colours but those of defects"],
            Self::Checker => {
                ["Checker", "squares of the plane, carried to the mesh: they show angles and sizes at a glance"]
            }
            Self::Picture => ["Picture", "the picture, carried to the mesh; a checker where there is none"],
            Self::Angle => ["Angle distortion", "ratio of the singular values σ₁/σ₂ per face: 1 keeps angles"],
            Self::Area => [
                "Area distortion",
                "area in the plane over area on the mesh per face, at equal total areas: 1 keeps areas",
            ],
            Self::Stretch => ["Stretch", "root mean square stretch from the plane to the mesh per face (L²)"],
            Self::Move => ["Move", "how far faces have moved since the compared step, or else since the one before"],
            Self::SeeThrough => ["See-through", "a fill of 30 %: the picture behind the embedding shows through"],
        }
    }
}
