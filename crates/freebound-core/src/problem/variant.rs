//! A method with its weights and its boundary, as comparisons name it.

use std::fmt;
use std::str::FromStr;

use crate::geom::ConvexPolygon;

use super::{BoundaryShape, Family, Method, NamedOption, Settings, Start};

/// Mark before the family of weights. [`SHAPE_MARK`] comes before the boundary shape.
const FAMILY_MARK: char = '/';
const SHAPE_MARK: char = '@';

/// Method with its weights and its boundary shape, if it has a choice: `METHOD[/FAMILY][@BOUNDARY]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Method, with its boundary shape if it has one.
    pub method: Method,
    /// Family of weights. Absent if the method has no choice, or uses the family of the settings that it is run with.
    pub family: Option<Family>,
}

impl Variant {
    /// Variant of these settings: their method and weights.
    pub fn of(settings: &Settings) -> Self {
        let family = settings.method.uses_family().then(|| settings.family());
        Self { method: settings.method.clone(), family }
    }

    /// Settings for a run of this variant. All other settings come from `base`. Default family: the family of `base`,
    /// if it goes with the method. The start of `base` is kept if the method can continue from a layout.
    pub fn settings(&self, base: &Settings) -> Settings {
        let settings = base.clone().by(self.method.clone());
        let start = if self.method.continues_from_layout() { base.start } else { Start::FromScratch };
        Settings { family: self.family.or(settings.family), start, ..settings }
    }

    /// Boundary shape, if it is not the default.
    fn unusual_shape(&self) -> Option<&BoundaryShape> {
        self.method.boundary_shape().filter(|shape| **shape != BoundaryShape::default())
    }

    /// Name on the screen.
    pub fn title(&self) -> String {
        let shape = self.unusual_shape().map(|shape| shape.labels().title.to_lowercase());
        let family = self.family.map(|family| match family {
            Family::Power(power) => format!("power {power}"),
            named => named.labels().title.to_lowercase(),
        });
        let parts = [Some(self.method.labels().title.to_owned()), family, shape];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// Written form. The default family and the default shape are left out.
impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.method.name())?;
        if let Some(family) = self.family.filter(|family| *family != self.method.usual_family()) {
            write!(f, "{FAMILY_MARK}{family}")?;
        }
        match self.unusual_shape() {
            Some(shape) => write!(f, "{SHAPE_MARK}{}", shape.written()),
            None => Ok(()),
        }
    }
}

impl FromStr for Variant {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (text, shape) = text.split_once(SHAPE_MARK).map_or((text, None), |(text, shape)| (text, Some(shape)));
        let (name, family) = text.split_once(FAMILY_MARK).map_or((text, None), |(text, family)| (text, Some(family)));
        let method =
            Method::named(name).ok_or_else(|| format!("unknown method `{name}`: choose from {}", Method::names()))?;
        let method = match (method.boundary_shape(), shape) {
            (Some(_), Some(shape)) => method.on_shape(shape_named(shape)?),
            (None, Some(_)) => {
                return Err(format!("{name} has no boundary shape: remove {SHAPE_MARK} and the shape"));
            }
            (_, None) => method,
        };
        let family = family.map(Family::from_str).transpose()?;
        match family {
            Some(_) if !method.uses_family() => Err(format!("{name} has no choice of weights: remove them")),
            Some(family) if !family.goes_with(&method) => {
                Err(format!("{name} does not support {family} weights, which need a convex boundary"))
            }
            _ => Ok(Self { method, family }),
        }
    }
}

/// Shape with this name, or the polygon with these corners.
fn shape_named(text: &str) -> Result<BoundaryShape, String> {
    if let Some(corners) = text.strip_prefix(BoundaryShape::POLYGON) {
        let polygon = ConvexPolygon::parse(corners);
        return polygon
            .map(BoundaryShape::Polygon)
            .map_err(|fault| format!("{text}: {fault}; separate the numbers of a corner by a space, not by a comma"));
    }
    BoundaryShape::named(text)
        .ok_or_else(|| format!("unknown boundary `{text}`: choose from {}", BoundaryShape::names()))
}
