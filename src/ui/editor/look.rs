//! How faces show in both panes: shading, wireframe, the picture, colours by numbers.

use std::sync::Arc;

use super::Shading;
use super::scene::{Legend, MeshScene, Paint, PaintKey, PlaneScene};
use crate::geom;
use crate::geom::Bounds;
use crate::render::{PictureLayer, Sampling};
use crate::session::{Document, Outcome};
use crate::view::{self};

/// How strongly the picture shows behind the embedding at the start.
const OPACITY: f32 = 0.55;

/// Fields of the checker across the embedding.
const CHECKER_FIELDS: f64 = 40.0;

#[derive(Debug)]
pub struct Look {
    pub shading: Shading,
    pub wireframe: bool,
    /// Whether insets magnify a defect and a pair.
    pub magnifier: bool,
    /// Whether vertices glide from step to step; off for those whom motion bothers.
    pub glides: bool,
    /// How strongly the picture shows behind the embedding, 0 to 1.
    pub opacity: f32,
    pub sampling: Sampling,
    /// The document's picture, and the same as the graphics card takes it.
    picture: Option<(Arc<geom::Picture>, Arc<view::Picture>)>,
    paint: Option<Paint>,
    /// Side of a check in the plane, and the mesh by its revision that it was chosen for.
    check: Option<(u64, f64)>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            shading: Shading::default(),
            wireframe: false,
            magnifier: true,
            glides: true,
            opacity: OPACITY,
            sampling: Sampling::Smooth,
            picture: None,
            paint: None,
            check: None,
        }
    }
}

impl Look {
    pub fn paint(&self) -> Option<&Paint> {
        self.paint.as_ref()
    }

    /// The scale of a shading by numbers.
    pub(in crate::ui) fn legend(&self) -> Option<&Legend> {
        self.paint.as_ref()?.legend.as_ref()
    }

    /// Whether pixels show as squares.
    pub(in crate::ui) fn is_sharp(&self) -> bool {
        self.sampling == Sampling::Sharp
    }

    pub(super) fn toggle_sharp(&mut self) {
        self.sampling = if self.is_sharp() { Sampling::Smooth } else { Sampling::Sharp };
    }

    /// Side of a check of the checker in the plane.
    pub fn check_size(&self) -> f64 {
        self.check.map_or(1.0, |(_, side)| side)
    }

    /// Chooses the checks' size for an embedding. It stays as long as it is about right, so that steps that are looked
    /// at one after the other have the same; while they are played, it stays whatever they are. Call once per frame.
    pub(super) fn refresh_checks(&mut self, plane: &PlaneScene, is_playing: bool) {
        let model = plane.mesh.model_revision;
        let wanted = plane.arrays.bounds.extent() / CHECKER_FIELDS;
        let is_right = |side: f64| (0.5..=2.0).contains(&(wanted / side));
        if self.check.is_none_or(|(of, side)| of != model || !(is_playing || is_right(side))) {
            self.check = Some((model, wanted));
        }
    }

    /// The picture as panes draw it, in its box in the plane.
    pub(in crate::ui) fn picture_layer(&self, bounds: Bounds) -> Option<PictureLayer> {
        let (_, picture) = self.picture.as_ref()?;
        Some(PictureLayer { picture: Arc::clone(picture), bounds, opacity: self.opacity, sampling: self.sampling })
    }

    /// Takes in another picture of the document's. A picture that comes in is put on the mesh. Call once per frame.
    pub(super) fn refresh_picture(&mut self, document: &Document) {
        let wanted = document.picture.as_ref().map(|file| &file.pixels);
        let shown = self.picture.as_ref().map(|(pixels, _)| pixels);
        if wanted.map(Arc::as_ptr) == shown.map(Arc::as_ptr) {
            return;
        }
        self.picture = wanted.and_then(|pixels| {
            let picture = view::Picture::new([pixels.width, pixels.height], pixels.pixels.clone())?;
            Some((Arc::clone(pixels), Arc::new(picture)))
        });
        self.shading = match self.shading {
            Shading::Picture if wanted.is_none() => Shading::Checker,
            Shading::Plain | Shading::Checker if wanted.is_some() => Shading::Picture,
            other => other,
        };
    }

    /// Colours the faces anew where mesh, embedding or shading have changed; moves are measured from `base`. Call once
    /// per frame.
    pub(super) fn refresh_paint(&mut self, given: &MeshScene, plane: Option<&PlaneScene>, base: Option<&Outcome>) {
        let base = base.filter(|_| self.shading == Shading::Move);
        let key = PaintKey {
            model: given.model_revision,
            outcome: plane.map_or(0, |scene| scene.outcome_revision),
            shading: self.shading,
            moved_from: base.map(|base| base.step.index),
        };
        if self.paint.as_ref().is_none_or(|paint| paint.key != key) {
            let mesh = plane.map_or(given, |plane| &plane.mesh).mesh();
            self.paint = Some(Paint::new(key, mesh, plane.map(|plane| plane.outcome.as_ref()), base));
        }
    }

    pub(super) fn forget_paint(&mut self) {
        self.paint = None;
    }
}
