//! Value for the shape of a boundary: a name, the corners of a polygon, or a file of corners.

use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

use freebound_core::geom::ConvexPolygon;
use freebound_core::problem::{BoundaryShape, NamedOption as _};

/// Shape, and the file that it was read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TypedShape {
    /// Shape of the boundary.
    pub shape: BoundaryShape,
    /// File of the polygon's corners.
    pub file: Option<PathBuf>,
}

impl FromStr for TypedShape {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some(corners) = text.strip_prefix(BoundaryShape::POLYGON) else {
            let shape = BoundaryShape::named(text);
            let shape = shape.ok_or_else(|| format!("choose one of {}, or polygon:FILE", BoundaryShape::names()))?;
            return Ok(Self { shape, file: None });
        };
        let polygon = |text: &str| ConvexPolygon::parse(text).map_err(|fault| fault.to_string());
        let path = PathBuf::from(corners);
        if corners.contains(';') && !path.exists() {
            return Ok(Self { shape: BoundaryShape::Polygon(polygon(corners)?), file: None });
        }
        let text = fs::read_to_string(&path).map_err(|error| format!("{corners}: {error}"))?;
        let polygon = polygon(&text).map_err(|fault| format!("{corners}: {fault}"))?;
        Ok(Self { shape: BoundaryShape::Polygon(polygon), file: Some(path) })
    }
}
