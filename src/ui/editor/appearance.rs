//! How faces show in both panes: shading, wireframe, the picture, colours by numbers.

use std::sync::Arc;

use super::async_scene::AsyncScene;
use super::paint::{BrushPaint, Legend, PaintKey};
use super::scene::{MeshScene, PlaneScene};
use crate::render::{PictureLayer, Sampling};
use crate::session::{Document, JobFailure, Wake};
use crate::ui::state::{Pane, ShadingMode};
use crate::view::{self};
use freebound_core::geom;
use freebound_core::geom::Bounds;
use freebound_core::pipeline::Outcome;

/// How strongly the picture shows behind the embedding at the start.
const OPACITY: f32 = 0.55;

/// Fields of the checker across the embedding.
const CHECKER_FIELDS: f64 = 40.0;

/// How faces show in the two panes, and how strongly the picture behind the embedding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    mesh: ShadingMode,
    plane: ShadingMode,
    /// From 0 to 1.
    pub opacity: f32,
    /// Whether it is as the window was left: then the first picture that comes in changes nothing.
    pub(super) is_kept: bool,
    /// What a person has chosen for the two panes, now or in a run before; a project's shadings are not theirs.
    pub(super) own: [Option<ShadingMode>; 2],
}

impl Appearance {
    /// While places on a picture are sought: clay to find vertices on, and all of the picture.
    const OVER_PICTURE: Self =
        Self { mesh: ShadingMode::Plain, plane: ShadingMode::SeeThrough, opacity: 1.0, is_kept: false, own: [None; 2] };

    /// The shading of a pane.
    pub fn shading(self, pane: Pane) -> ShadingMode {
        match pane {
            Pane::Mesh => self.mesh,
            Pane::Plane => self.plane,
        }
    }

    /// Shades a pane, if it can be shaded so.
    pub(super) fn shade(&mut self, pane: Pane, shading: ShadingMode) {
        match pane {
            _ if !shading.is_for(pane) => {}
            Pane::Mesh => self.mesh = shading,
            Pane::Plane => self.plane = shading,
        }
    }
}

#[derive(Debug)]
pub struct PaneShading {
    /// As chosen.
    pub(super) usual: Appearance,
    /// As chosen for the constrain tool over a picture.
    pub(super) over_picture: Appearance,
    pub wireframe: bool,
    /// Whether insets magnify a defect and a pair.
    pub magnifier: bool,
    /// Whether vertices glide from step to step; off for those whom motion bothers.
    pub glides: bool,
    pub sampling: Sampling,
    /// The document's picture.
    pixels: Option<Arc<geom::Picture>>,
    /// The same as the graphics card takes it, once that is made.
    picture: Option<Arc<view::PictureQuad>>,
    /// By the count of pictures.
    job: AsyncScene<u64, Option<view::PictureQuad>>,
    picture_count: u64,
    /// Of the mesh's pane and of the embedding's; one and the same where both are coloured alike.
    paints: [Option<Arc<BrushPaint>>; 2],
    /// Side of a check in the plane, and the mesh by its revision that it was chosen for.
    check: Option<(u64, f64)>,
}

impl PaneShading {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            usual: Appearance {
                mesh: ShadingMode::default(),
                plane: ShadingMode::default(),
                opacity: OPACITY,
                is_kept: false,
                own: [None; 2],
            },
            over_picture: Appearance::OVER_PICTURE,
            wireframe: false,
            magnifier: true,
            glides: true,
            sampling: Sampling::Smooth,
            pixels: None,
            picture: None,
            job: AsyncScene::new("picture", wake),
            picture_count: 0,
            paints: [None, None],
            check: None,
        }
    }

    pub fn paint(&self, pane: Pane) -> Option<&BrushPaint> {
        self.paints[pane as usize].as_deref()
    }

    /// The scale of a shading by numbers.
    pub(in crate::ui) fn legend(&self, pane: Pane) -> Option<&Legend> {
        self.paint(pane)?.legend.as_ref()
    }

    /// What a person has chosen for a pane.
    pub(super) fn own_shading(&self, pane: Pane) -> Option<ShadingMode> {
        self.usual.own[pane as usize]
    }

    /// Takes over what a person has chosen in a run before, by its name.
    pub(super) fn keep_own_shading(&mut self, pane: Pane, name: Option<&str>) {
        let Some(shading) = ShadingMode::called(name).filter(|shading| shading.is_for(pane)) else { return };
        self.usual.own[pane as usize] = Some(shading);
        self.usual.shade(pane, shading);
        self.usual.is_kept = true;
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

    /// The picture as panes draw it, in its box in the plane, so strong behind the embedding.
    pub(in crate::ui) fn picture_layer(&self, bounds: Bounds, opacity: f32) -> Option<PictureLayer> {
        let picture = Arc::clone(self.picture.as_ref()?);
        Some(PictureLayer { picture, bounds, opacity, sampling: self.sampling })
    }

    /// Whether the document's picture is not ready to be drawn yet.
    pub fn is_making_picture(&self) -> bool {
        self.job.is_busy()
    }

    /// Why the picture could not be made ready; each failure once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// Takes in another picture of the document's. A picture that comes in is put on the mesh, as soon as its smaller sizes
    /// are made in the background. Call once per frame.
    pub(super) fn refresh_picture(&mut self, document: &Document) {
        if let Some((_, made)) = self.job.poll() {
            self.picture = made.map(Arc::new);
        }
        let wanted = document.picture.as_ref().map(|file| &file.pixels);
        if wanted.map(Arc::as_ptr) == self.pixels.as_ref().map(Arc::as_ptr) {
            return;
        }
        (self.pixels, self.picture) = (wanted.cloned(), None);
        self.job.cancel();
        if let Some(pixels) = wanted.cloned() {
            self.picture_count += 1;
            self.job.make(self.picture_count, move |_| view::PictureQuad::new(pixels));
        }
        let is_kept = wanted.is_some() && std::mem::take(&mut self.usual.is_kept);
        for shading in [&mut self.usual.mesh, &mut self.usual.plane] {
            *shading = match *shading {
                ShadingMode::Picture | ShadingMode::SeeThrough if wanted.is_none() => ShadingMode::Checker,
                ShadingMode::Plain | ShadingMode::Checker if wanted.is_some() && !is_kept => ShadingMode::Picture,
                other => other,
            };
        }
    }

    /// Colours the faces of a pane anew where mesh, embedding or shading have changed; moves are measured from `base`.
    pub(super) fn refresh_paint(&mut self, pane: Pane, shading: ShadingMode, sources: PaintSources<'_>) {
        let PaintSources { given, plane, base } = sources;
        let base = base.filter(|_| shading == ShadingMode::Move);
        let key = PaintKey {
            model: given.model_revision,
            outcome: plane.map_or(0, |scene| scene.outcome_revision),
            // Where faces are not coloured by a number, one paint serves all shadings.
            shading: if shading.is_by_number() { shading } else { ShadingMode::Plain },
            moved_from: base.map(|base| base.step.index),
        };
        let fits = |paint: &&Arc<BrushPaint>| paint.key == key;
        if self.paints[pane as usize].as_ref().is_none_or(|paint| paint.key != key) {
            let shared = self.paints.iter().flatten().find(fits).cloned();
            let mesh = plane.map_or(given, |plane| &plane.mesh).mesh();
            let made = || Arc::new(BrushPaint::new(key, mesh, plane.map(|plane| plane.outcome.as_ref()), base));
            self.paints[pane as usize] = Some(shared.unwrap_or_else(made));
        }
    }

    pub(super) fn forget_paint(&mut self) {
        self.paints = [None, None];
    }
}

/// What faces are coloured from.
#[derive(Clone, Copy)]
pub(super) struct PaintSources<'a> {
    /// The mesh as given.
    pub(super) given: &'a MeshScene,
    /// The embedding.
    pub(super) plane: Option<&'a PlaneScene>,
    /// The step that moves are measured from.
    pub(super) base: Option<&'a Outcome>,
}
