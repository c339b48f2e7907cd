//! The place of the picture in the plane.

use crate::session::Document;
use freebound_core::geom::Bounds;

/// Box of a document's picture in the plane; without one, the unit square of texture coordinates.
pub(in crate::ui) fn picture_box(document: &Document) -> Bounds {
    let [low, high] = document.frame().corners();
    Bounds { low, high }
}
