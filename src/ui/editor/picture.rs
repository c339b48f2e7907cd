//! The picture in the plane: behind the embedding in its own frame.

use crate::render::PictureLayer;
use crate::ui::Editor;
use crate::view::PlaneBox;

impl Editor {
    /// Whether the document has a picture.
    pub fn has_picture(&self) -> bool {
        self.session.document().picture.is_some()
    }

    /// Where the picture lies in the plane; without one, the unit square of texture coordinates.
    pub(in crate::ui) fn picture_box(&self) -> PlaneBox {
        let [min, max] = self.session.document().frame().corners();
        PlaneBox { min, max }
    }

    /// What the window shows of the plane by itself: the picture where there is one, so that it stays where it is while
    /// the embedding changes; else the embedding.
    pub(super) fn framed_box(&self, embedding: PlaneBox) -> PlaneBox {
        if self.has_picture() { self.picture_box() } else { embedding }
    }

    /// All that there is in the plane: the embedding, and the picture where there is one.
    pub(in crate::ui) fn with_picture(&self, embedding: PlaneBox) -> PlaneBox {
        if self.has_picture() { embedding.union(self.picture_box()) } else { embedding }
    }

    /// The picture as panes draw it.
    pub(in crate::ui) fn picture_layer(&self) -> Option<PictureLayer> {
        self.look.picture_layer(self.picture_box())
    }
}
