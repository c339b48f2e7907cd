//! The picture in both panes: behind the embedding in its own frame, and mapped on the mesh.

use std::sync::Arc;

use crate::geom;
use crate::render::{PictureLayer, Sampling};
use crate::ui::{Editor, Shading};
use crate::view::{self, PlaneBox};

/// How strongly the picture shows behind the embedding at the start.
const OPACITY: f32 = 0.55;

/// The picture as the window has it.
#[derive(Debug)]
pub struct PictureView {
    /// How strongly it shows behind the embedding, 0 to 1.
    pub opacity: f32,
    /// How its pixels show.
    pub sampling: Sampling,
    /// The document's pixels, and the same as the graphics card takes them.
    shown: Option<(Arc<geom::Picture>, Arc<view::Picture>)>,
}

impl Default for PictureView {
    fn default() -> Self {
        Self { opacity: OPACITY, sampling: Sampling::Smooth, shown: None }
    }
}

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
        let (_, picture) = self.picture.shown.as_ref()?;
        Some(PictureLayer {
            picture: Arc::clone(picture),
            bounds: self.picture_box(),
            opacity: self.picture.opacity,
            sampling: self.picture.sampling,
        })
    }

    /// Takes in another picture of the document's. A picture that comes in is put on the mesh. Call once per frame.
    pub(super) fn refresh_picture(&mut self) {
        let wanted = self.session.document().picture.as_ref().map(|file| &file.pixels);
        let shown = self.picture.shown.as_ref().map(|(pixels, _)| pixels);
        match (wanted, shown) {
            (None, None) => {}
            (Some(wanted), Some(shown)) if Arc::ptr_eq(wanted, shown) => {}
            (None, Some(_)) => {
                self.picture.shown = None;
                if self.shading == Shading::Picture {
                    self.shading = Shading::Checker;
                }
            }
            (Some(wanted), _) => {
                let pixels = Arc::clone(wanted);
                let picture = view::Picture::new([pixels.width, pixels.height], pixels.pixels.clone());
                self.picture.shown = picture.map(|picture| (pixels, Arc::new(picture)));
                if matches!(self.shading, Shading::Plain | Shading::Checker) {
                    self.shading = Shading::Picture;
                }
            }
        }
    }
}
