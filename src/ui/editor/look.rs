//! How faces show in both panes: shading, wireframe, the picture, colours by numbers.

use std::sync::Arc;

use super::making::Making;
use super::paint::{Legend, Paint, PaintKey};
use super::scene::{MeshScene, PlaneScene};
use super::{Editor, Pane, Shading, Tool};
use crate::geom;
use crate::geom::Bounds;
use crate::render::{PictureLayer, Sampling};
use crate::session::{Document, Failure, Outcome, Wake};
use crate::view::{self};

/// How strongly the picture shows behind the embedding at the start.
const OPACITY: f32 = 0.55;

/// Fields of the checker across the embedding.
const CHECKER_FIELDS: f64 = 40.0;

/// How faces show in the two panes, and how strongly the picture behind the embedding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    mesh: Shading,
    plane: Shading,
    /// From 0 to 1.
    pub opacity: f32,
    /// Whether it is as the window was left: then the first picture that comes in changes nothing.
    pub(super) is_kept: bool,
    /// What a person has chosen for the two panes, now or in a run before; a project's shadings are not theirs.
    own: [Option<Shading>; 2],
}

impl Appearance {
    /// While places on a picture are sought: clay to find vertices on, and all of the picture.
    const OVER_PICTURE: Self =
        Self { mesh: Shading::Plain, plane: Shading::SeeThrough, opacity: 1.0, is_kept: false, own: [None; 2] };

    /// The shading of a pane.
    pub fn shading(self, pane: Pane) -> Shading {
        match pane {
            Pane::Mesh => self.mesh,
            Pane::Plane => self.plane,
        }
    }

    /// Shades a pane, if it can be shaded so.
    pub(super) fn shade(&mut self, pane: Pane, shading: Shading) {
        match pane {
            _ if !shading.is_for(pane) => {}
            Pane::Mesh => self.mesh = shading,
            Pane::Plane => self.plane = shading,
        }
    }
}

#[derive(Debug)]
pub struct Look {
    /// As chosen.
    pub(super) usual: Appearance,
    /// As chosen for the constrain tool over a picture.
    over_picture: Appearance,
    pub wireframe: bool,
    /// Whether insets magnify a defect and a pair.
    pub magnifier: bool,
    /// Whether vertices glide from step to step; off for those whom motion bothers.
    pub glides: bool,
    pub sampling: Sampling,
    /// The document's picture.
    pixels: Option<Arc<geom::Picture>>,
    /// The same as the graphics card takes it, once that is made.
    picture: Option<Arc<view::Picture>>,
    /// By the count of pictures.
    making: Making<u64, Option<view::Picture>>,
    picture_count: u64,
    /// Of the mesh's pane and of the embedding's; one and the same where both are coloured alike.
    paints: [Option<Arc<Paint>>; 2],
    /// Side of a check in the plane, and the mesh by its revision that it was chosen for.
    check: Option<(u64, f64)>,
}

impl Look {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            usual: Appearance {
                mesh: Shading::default(),
                plane: Shading::default(),
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
            making: Making::new("picture", wake),
            picture_count: 0,
            paints: [None, None],
            check: None,
        }
    }

    pub fn paint(&self, pane: Pane) -> Option<&Paint> {
        self.paints[pane as usize].as_deref()
    }

    /// The scale of a shading by numbers.
    pub(in crate::ui) fn legend(&self, pane: Pane) -> Option<&Legend> {
        self.paint(pane)?.legend.as_ref()
    }

    /// What a person has chosen for a pane.
    pub(super) fn own_shading(&self, pane: Pane) -> Option<Shading> {
        self.usual.own[pane as usize]
    }

    /// Takes over what a person has chosen in a run before, by its name.
    pub(super) fn keep_own_shading(&mut self, pane: Pane, name: Option<&str>) {
        let Some(shading) = Shading::called(name).filter(|shading| shading.is_for(pane)) else { return };
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
        self.making.is_busy()
    }

    /// Why the picture could not be made ready; each failure once.
    pub(super) fn take_failure(&mut self) -> Option<Failure> {
        self.making.take_failure()
    }

    /// Takes in another picture of the document's. A picture that comes in is put on the mesh, as soon as its smaller sizes
    /// are made in the background. Call once per frame.
    pub(super) fn refresh_picture(&mut self, document: &Document) {
        if let Some((_, made)) = self.making.poll() {
            self.picture = made.map(Arc::new);
        }
        let wanted = document.picture.as_ref().map(|file| &file.pixels);
        if wanted.map(Arc::as_ptr) == self.pixels.as_ref().map(Arc::as_ptr) {
            return;
        }
        (self.pixels, self.picture) = (wanted.cloned(), None);
        self.making.cancel();
        if let Some(pixels) = wanted.cloned() {
            self.picture_count += 1;
            self.making.make(self.picture_count, move |_| view::Picture::new(pixels));
        }
        let is_kept = wanted.is_some() && std::mem::take(&mut self.usual.is_kept);
        for shading in [&mut self.usual.mesh, &mut self.usual.plane] {
            *shading = match *shading {
                Shading::Picture | Shading::SeeThrough if wanted.is_none() => Shading::Checker,
                Shading::Plain | Shading::Checker if wanted.is_some() && !is_kept => Shading::Picture,
                other => other,
            };
        }
    }

    /// Colours the faces of a pane anew where mesh, embedding or shading have changed; moves are measured from `base`.
    pub(super) fn refresh_paint(&mut self, pane: Pane, shading: Shading, sources: PaintSources<'_>) {
        let PaintSources { given, plane, base } = sources;
        let base = base.filter(|_| shading == Shading::Move);
        let key = PaintKey {
            model: given.model_revision,
            outcome: plane.map_or(0, |scene| scene.outcome_revision),
            // Where faces are not coloured by a number, one paint serves all shadings.
            shading: if shading.is_by_number() { shading } else { Shading::Plain },
            moved_from: base.map(|base| base.step.index),
        };
        let fits = |paint: &&Arc<Paint>| paint.key == key;
        if self.paints[pane as usize].as_ref().is_none_or(|paint| paint.key != key) {
            let shared = self.paints.iter().flatten().find(fits).cloned();
            let mesh = plane.map_or(given, |plane| &plane.mesh).mesh();
            let made = || Arc::new(Paint::new(key, mesh, plane.map(|plane| plane.outcome.as_ref()), base));
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

impl Editor {
    /// How faces show now. The constrain tool over a picture has an appearance of its own, and leaves the other as it is.
    pub fn appearance(&self) -> &Appearance {
        if self.is_placing_on_picture() { &self.look.over_picture } else { &self.look.usual }
    }

    /// The same, to be changed.
    pub fn appearance_mut(&mut self) -> &mut Appearance {
        if self.is_placing_on_picture() { &mut self.look.over_picture } else { &mut self.look.usual }
    }

    fn is_placing_on_picture(&self) -> bool {
        self.tools.tool() == Tool::Constrain && self.has_picture()
    }

    /// The shading of a pane.
    pub fn shading(&self, pane: Pane) -> Shading {
        self.appearance().shading(pane)
    }

    /// Shades the pane under the pointer, or both where it is over neither.
    pub(super) fn shade(&mut self, shading: Shading) {
        if self.pointer.pane() != Some(Pane::Mesh) && self.shade_comparison(shading) {
            return;
        }
        match self.pointer.pane() {
            Some(pane) => self.shade_pane(pane, shading),
            None => Pane::BOTH.into_iter().for_each(|pane| self.shade_pane(pane, shading)),
        }
    }

    /// Shades a pane as a person chose.
    pub(super) fn shade_pane(&mut self, pane: Pane, shading: Shading) {
        let appearance = self.appearance_mut();
        appearance.shade(pane, shading);
        if shading.is_for(pane) {
            appearance.own[pane as usize] = Some(shading);
        }
    }

    /// Colours the faces anew where that is due. Call once per frame.
    pub(super) fn refresh_paints(&mut self) {
        let Some(given) = self.mesh.scene() else { return };
        let base = self.plane.moved_from(&self.session).map(AsRef::as_ref);
        let sources = PaintSources { given, plane: self.plane.scene().map(AsRef::as_ref), base };
        for (pane, shading) in Pane::BOTH.map(|pane| (pane, self.shading(pane))) {
            self.look.refresh_paint(pane, shading, sources);
        }
    }
}
