//! Families of weights (paper §3.1).

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use super::{Labels, Method, NamedOption, SolveError};

/// Family of weights: dependence of the offset d on the edge length r.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Family {
    /// d = r: cotangents.
    #[default]
    Conformal,
    /// d = 1: always positive.
    MeanValue,
    /// d = 1/r.
    Wachspress,
    /// d = rᵖ: from Wachspress (−1) over mean value (0) to conformal (1), and beyond.
    Power(f64),
    /// All weights equal (Tutte 1963); convex boundary only.
    Uniform,
    /// Averaged barycentric coordinates (Floater 1997); convex boundary only.
    ShapePreserving,
}

impl Family {
    /// Power of [`Family::Conformal`], d = r.
    pub const CONFORMAL_POWER: f64 = 1.0;
    /// Power of [`Family::Wachspress`], d = 1/r.
    pub const WACHSPRESS_POWER: f64 = -1.0;

    /// Power p of d = rᵖ. `None` for families that are not three-point.
    pub const fn power(self) -> Option<f64> {
        match self {
            Self::Conformal => Some(Self::CONFORMAL_POWER),
            Self::MeanValue => Some(0.0),
            Self::Wachspress => Some(Self::WACHSPRESS_POWER),
            Self::Power(p) => Some(p),
            Self::Uniform | Self::ShapePreserving => None,
        }
    }

    /// True if a method can be solved with this family. A family that is not three-point needs a convex boundary.
    pub const fn goes_with(self, method: &Method) -> bool {
        self.power().is_some() || method.takes_any_family()
    }

    /// Checks that a method with a choice of weights can be solved with this family.
    ///
    /// # Errors
    ///
    /// [`SolveError::FamilyNotApplicable`] if it cannot.
    pub fn check_for(self, method: &Method) -> Result<(), SolveError> {
        if !method.uses_family() || self.goes_with(method) {
            return Ok(());
        }
        Err(SolveError::FamilyNotApplicable {
            method: method.labels().title,
            family: self.title().to_lowercase(),
            remedy: "choose Convex boundary or Lee's virtual boundary",
        })
    }
}

impl Family {
    /// Title, with the number of a power.
    fn title(self) -> String {
        let title = self.labels().title;
        if let Self::Power(p) = self { format!("{title} {p}") } else { title.to_owned() }
    }
}

/// Prefix of a written power, before its number.
const POWER: &str = "power:";

impl NamedOption for Family {
    const ALL: &'static [Self] =
        &[Self::Conformal, Self::MeanValue, Self::Wachspress, Self::Power(0.5), Self::Uniform, Self::ShapePreserving];

    fn labels(&self) -> Labels {
        match self {
            Self::Conformal => Labels::new("conformal", "Conformal")
                .about("d = r: cotangents, keeps angles; positive if opposite angles sum to less than 180°")
                .source("paper §3.1; Pinkall and Polthier 1993"),
            Self::MeanValue => Labels::new("mean-value", "Mean value")
                .about("d = 1: always positive")
                .source("paper §3.1; Floater 2003"),
            Self::Wachspress => Labels::new("wachspress", "Wachspress")
                .about("d = 1/r; positive if rings of neighbours are convex")
                .source("paper §3.1; Wachspress 1975"),
            Self::Power(_) => Labels::new("power:P", "Power")
                .about("d = r^P: Wachspress at −1, mean value at 0, conformal at 1")
                .source("paper §3.1; Floater, Hormann and Kós 2006"),
            Self::Uniform => Labels::new("uniform", "Uniform")
                .about("all weights equal, so always positive; convex boundary only")
                .source("Tutte 1963"),
            Self::ShapePreserving => Labels::new("shape-preserving", "Shape-preserving")
                .about("averaged barycentric coordinates: always positive; convex boundary only")
                .source("Floater 1997"),
        }
    }

    fn written(&self) -> Cow<'static, str> {
        if let Self::Power(p) = self { format!("{POWER}{p}").into() } else { self.name().into() }
    }

    fn named(text: &str) -> Option<Self> {
        let Some(power) = text.strip_prefix(POWER) else {
            return Self::ALL.iter().copied().find(|family| family.name() == text);
        };
        power.parse().ok().filter(|p: &f64| p.is_finite()).map(Self::Power)
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written())
    }
}

impl FromStr for Family {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::named(text).ok_or_else(|| format!("choose one of {}", Self::names()))
    }
}
