//! A method with its weights and its boundary, as comparisons name it.

use std::fmt;
use std::str::FromStr;

use crate::geom::ConvexPolygon;

use super::{BoundaryShape, Family, Method, NamedOption, Settings, Start};

/// What stands before the weights, and before the shape of the boundary.
const FAMILY_MARK: char = '/';
const SHAPE_MARK: char = '@';

/// A method, on its boundary, with weights where it has a choice: `METHOD[/FAMILY][@BOUNDARY]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// The method, with its shape where it lays a boundary on one.
    pub method: Method,
    /// Its weights; none where it has no choice, or takes those of the settings that it is run with.
    pub family: Option<Family>,
}

impl Variant {
    /// The method and the weights of settings.
    pub fn of(settings: &Settings) -> Self {
        let family = settings.method.uses_family().then(|| settings.family());
        Self { method: settings.method.clone(), family }
    }

    /// The settings that it is run with, everything else as in `base`: without weights of its own it takes those that were
    /// asked for there, where they go with the method; it goes on from a layout where that is wanted and the method can.
    pub fn settings(&self, base: &Settings) -> Settings {
        let settings = base.clone().by(self.method.clone());
        let start = if self.method.continues_from_layout() { base.start } else { Start::FromScratch };
        Settings { family: self.family.or(settings.family), start, ..settings }
    }

    /// The shape that its boundary is laid on, where that is not the usual one.
    fn unusual_shape(&self) -> Option<&BoundaryShape> {
        self.method.boundary_shape().filter(|shape| **shape != BoundaryShape::default())
    }

    /// Its name on the screen.
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

/// As it is typed; the usual weights and the usual shape are left out.
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
        let method = Method::named(name).ok_or_else(|| format!("no method `{name}`: choose of {}", Method::names()))?;
        let method = match (method.boundary_shape(), shape) {
            (Some(_), Some(shape)) => method.on_shape(shape_named(shape)?),
            (None, Some(_)) => {
                return Err(format!("{name} lays its boundary on no shape: leave out {SHAPE_MARK} and it"));
            }
            (_, None) => method,
        };
        let family = family.map(Family::from_str).transpose()?;
        match family {
            Some(_) if !method.uses_family() => Err(format!("{name} has no choice of weights: leave them out")),
            Some(family) if !family.goes_with(&method) => {
                Err(format!("{family} weights are for convex boundaries only, not for {name}"))
            }
            _ => Ok(Self { method, family }),
        }
    }
}

/// The shape of that name, or with these corners.
fn shape_named(text: &str) -> Result<BoundaryShape, String> {
    if let Some(corners) = text.strip_prefix(BoundaryShape::POLYGON) {
        let polygon = ConvexPolygon::parse(corners);
        return polygon.map(BoundaryShape::Polygon).map_err(|fault| {
            format!("{text}: {fault}; among methods the numbers of a corner have a space between, no comma")
        });
    }
    BoundaryShape::named(text).ok_or_else(|| format!("no boundary `{text}`: choose of {}", BoundaryShape::names()))
}
