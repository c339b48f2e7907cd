//! What can be chosen, as a person meets it: methods and families with name, one line and source; boundary shapes,
//! treatments and growths with name and one line. The command line, reports and project files all have it from here.

use super::{BoundaryShape, Growth, Method, Treatment};

/// One of a few things to choose by name.
pub trait Choice: Copy + Send + Sync + 'static {
    /// All there are, in the order of menus.
    const ALL: &'static [Self];

    /// The name on the command line, in reports and in project files.
    fn name(self) -> &'static str;

    /// What it does, in one line.
    fn about(self) -> &'static str;

    /// The one with this name.
    fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|choice| choice.name() == name)
    }
}

/// The methods; that of a convex boundary with a circle, whose shape is a choice of its own. Relaxing is a rung only.
impl Choice for Method {
    const ALL: &'static [Self] = &[
        Self::Auto,
        Self::Natural,
        Self::Iterate,
        Self::VirtualBoundary,
        Self::Convex(BoundaryShape::Circle),
        Self::Lscm,
        Self::Levy,
        Self::Continuation,
        Self::Matchmaker,
    ];

    fn name(self) -> &'static str {
        Method::name(self)
    }

    fn about(self) -> &'static str {
        METHODS.iter().find(|entry| entry.name == self.name()).map_or("", |entry| entry.about)
    }
}

impl Choice for BoundaryShape {
    const ALL: &'static [Self] = &[Self::Circle, Self::Square];

    fn name(self) -> &'static str {
        match self {
            Self::Circle => "circle",
            Self::Square => "square",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Circle => "a circle",
            Self::Square => "a square",
        }
    }
}

impl Choice for Treatment {
    const ALL: &'static [Self] = &[Self::Eliminate, Self::LeastSquares, Self::Weighted];

    fn name(self) -> &'static str {
        Treatment::name(self)
    }

    fn about(self) -> &'static str {
        match self {
            Self::Eliminate => "leave them out (paper §3.3)",
            Self::LeastSquares => "keep all, meet them as well as can be (paper §6)",
            Self::Weighted => "keep all, and let pins pull by their weights (paper §6)",
        }
    }
}

impl Choice for Growth {
    const ALL: &'static [Self] = &[Self::Double, Self::One];

    fn name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::One => "one",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Double => "twice as many each time",
            Self::One => "one more each time (paper §5)",
        }
    }
}

/// One thing to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CatalogueEntry {
    /// Its name on the command line and in reports.
    pub name: &'static str,
    /// Its name on the screen.
    pub title: &'static str,
    /// What it does, in one line.
    pub about: &'static str,
    /// The paper's section, or where else it comes from.
    pub source: &'static str,
}

/// All methods, in the order of menus.
pub const METHODS: &[CatalogueEntry] = &[
    CatalogueEntry {
        name: "auto",
        title: "Auto (ladder)",
        about: "one way after another, the least costly first, until the map is proved one-to-one and meets the constraints",
        source: "paper §3.3, §4, §5, and beyond",
    },
    CatalogueEntry {
        name: "natural",
        title: "Natural boundary",
        about: "free boundary from two pins or yours, one linear solve",
        source: "paper §3.3, eq. 2 and 3",
    },
    CatalogueEntry {
        name: "iterate",
        title: "Mean-value iteration",
        about: "natural boundary, then solved again and again with mean-value weights of its own embedding",
        source: "paper §4",
    },
    CatalogueEntry {
        name: "virtual-boundary",
        title: "Virtual boundary",
        about: "natural boundary, then mesh and outside embedded together within a convex outline",
        source: "paper §5",
    },
    CatalogueEntry {
        name: "convex",
        title: "Convex boundary",
        about: "boundary on a circle or a square (--boundary), inside at barycentres",
        source: "Tutte 1963, Floater 1997",
    },
    CatalogueEntry {
        name: "lscm",
        title: "Least-squares conformal",
        about: "least-squares conformal map; equals natural with conformal weights",
        source: "Lévy et al. 2002",
    },
    CatalogueEntry {
        name: "levy",
        title: "Lévy, summed",
        about: "Lévy's triangle equations summed around each vertex",
        source: "paper §3.2",
    },
    CatalogueEntry {
        name: "continuation",
        title: "Continuation",
        about: "from a planar map without constraints to their targets, one-to-one all the way",
        source: "ours; energy of Garanzha et al. 2021",
    },
    CatalogueEntry {
        name: "matchmaker",
        title: "Matchmaker",
        about: "paths between the constraints, with new vertices where they need room, made straight in the plane",
        source: "Eckstein et al. 2001; Kraevoy et al. 2003",
    },
];

/// All families, in the order of menus.
pub const FAMILIES: &[CatalogueEntry] = &[
    CatalogueEntry {
        name: "conformal",
        title: "Conformal",
        about: "d = r: cotangents, keeps angles",
        source: "paper §3.1; Pinkall and Polthier 1993",
    },
    CatalogueEntry {
        name: "mean-value",
        title: "Mean value",
        about: "d = 1: always positive",
        source: "paper §3.1; Floater 2003",
    },
    CatalogueEntry {
        name: "wachspress", title: "Wachspress", about: "d = 1/r", source: "paper §3.1; Wachspress 1975"
    },
    CatalogueEntry {
        name: "power:P",
        title: "Power",
        about: "d = r^P: Wachspress at −1, mean value at 0, conformal at 1",
        source: "paper §3.1; Floater, Hormann and Kós 2006",
    },
    CatalogueEntry {
        name: "uniform",
        title: "Uniform",
        about: "all weights equal; convex boundary only",
        source: "Tutte 1963",
    },
    CatalogueEntry {
        name: "shape-preserving",
        title: "Shape-preserving",
        about: "averaged barycentric coordinates; convex boundary only",
        source: "Floater 1997",
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_told_apart<C: Choice + PartialEq + std::fmt::Debug>() {
        for &choice in C::ALL {
            assert_eq!(C::named(choice.name()), Some(choice), "a name of its own");
            assert!(!choice.about().is_empty(), "{choice:?}");
        }
        assert_eq!(C::named("relax"), None);
    }

    #[test]
    fn every_choice_has_a_name_of_its_own_and_a_line_on_it() {
        assert_told_apart::<Method>();
        assert_told_apart::<BoundaryShape>();
        assert_told_apart::<Treatment>();
        assert_told_apart::<Growth>();
        let listed: Vec<&str> = METHODS.iter().map(|entry| entry.name).collect();
        let chosen: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
        assert_eq!(listed, chosen, "one order for all");
    }
}
