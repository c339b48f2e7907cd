//! Appearance of faces in both panes: shading, wireframe, picture, colours by numbers.

use std::sync::Arc;

use super::async_scene::AsyncScene;
use super::checker::Checker;
use super::colour_table::ShownColumn;
use super::in_file::vertices_in_file;
use super::paint::{BrushPaint, Legend, PaintKey, PaintValues};
use super::scene::{MeshScene, PlaneScene};
use crate::render::{PictureLayer, Sampling};
use crate::session::{Document, JobFailure, Wake};
use crate::ui::state::{Pane, ShadingMode};
use crate::view::{self};
use freebound_core::geom;
use freebound_core::geom::Bounds;
use freebound_core::pipeline::Outcome;

/// Initial opacity of the picture behind the embedding.
const OPACITY: f32 = 0.55;

/// Effect of a new picture on the shadings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum OnPicture {
    /// Plain and checkered faces show it.
    #[default]
    FillsIn,
    /// The shadings stay, because they were restored from the last run.
    Leaves,
    /// All faces show it, because the user opens it.
    Shows,
}

/// Shading of the faces in the two panes, and opacity of the picture behind the embedding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    mesh: ShadingMode,
    plane: ShadingMode,
    /// Opacity of the picture, 0 to 1.
    pub opacity: f32,
    /// Effect of the next picture.
    pub(super) on_picture: OnPicture,
    /// Shadings that the user chose for the two panes, now or in an earlier run. Shadings of a project do not count.
    pub(super) own: [Option<ShadingMode>; 2],
}

impl Appearance {
    /// Appearance while targets are placed on a picture: clay on the mesh, so that vertices are easy to find, and an
    /// opaque picture.
    const OVER_PICTURE: Self = Self {
        mesh: ShadingMode::Plain,
        plane: ShadingMode::SeeThrough,
        opacity: 1.0,
        on_picture: OnPicture::FillsIn,
        own: [None; 2],
    };

    /// Shading of a pane.
    pub fn shading(self, pane: Pane) -> ShadingMode {
        match pane {
            Pane::Mesh => self.mesh,
            Pane::Plane => self.plane,
        }
    }

    /// Sets the shading of a pane. Ignores a shading that the pane does not have.
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
    /// Appearance for all tools except the constrain tool over a picture.
    pub(super) usual: Appearance,
    /// Appearance for the constrain tool over a picture.
    pub(super) over_picture: Appearance,
    pub wireframe: bool,
    /// True if insets magnify a defect and a pair.
    pub magnifier: bool,
    /// True if vertices glide from step to step. Users sensitive to motion turn it off.
    pub glides: bool,
    pub sampling: Sampling,
    /// Picture of the document.
    pixels: Option<Arc<geom::Picture>>,
    /// Picture of the document prepared for the graphics card, once it is ready.
    picture: Option<Arc<view::PictureQuad>>,
    /// Background job that prepares the picture. Key: `picture_count` at its start.
    job: AsyncScene<u64, Option<view::PictureQuad>>,
    picture_count: u64,
    /// Face colours of the mesh pane and of the embedding pane, shared if both are equal.
    paints: [Option<Arc<BrushPaint>>; 2],
    pub checker: Checker,
}

impl PaneShading {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            usual: Appearance {
                mesh: ShadingMode::default(),
                plane: ShadingMode::default(),
                opacity: OPACITY,
                on_picture: OnPicture::FillsIn,
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
            checker: Checker::new(wake),
        }
    }

    pub fn paint(&self, pane: Pane) -> Option<&BrushPaint> {
        self.paints[pane as usize].as_deref()
    }

    /// Colour scale of a shading by numbers.
    pub(in crate::ui) fn legend(&self, pane: Pane) -> Option<&Legend> {
        self.paint(pane)?.legend.as_ref()
    }

    /// Shading that the user chose for a pane.
    pub(super) fn own_shading(&self, pane: Pane) -> Option<ShadingMode> {
        self.usual.own[pane as usize]
    }

    /// Restores the shading that the user chose in an earlier run, by its name.
    pub(super) fn keep_own_shading(&mut self, pane: Pane, name: Option<&str>) {
        let Some(shading) = ShadingMode::called(name).filter(|shading| shading.is_for(pane)) else { return };
        self.usual.own[pane as usize] = Some(shading);
        self.usual.shade(pane, shading);
        self.usual.on_picture = OnPicture::Leaves;
    }

    /// True if pixels are drawn as squares.
    pub(in crate::ui) fn is_sharp(&self) -> bool {
        self.sampling == Sampling::Sharp
    }

    pub(super) fn toggle_sharp(&mut self) {
        self.sampling = if self.is_sharp() { Sampling::Smooth } else { Sampling::Sharp };
    }

    /// Layer that draws the picture in its box in the plane, with an opacity.
    pub(in crate::ui) fn picture_layer(&self, bounds: Bounds, opacity: f32) -> Option<PictureLayer> {
        let picture = Arc::clone(self.picture.as_ref()?);
        Some(PictureLayer { picture, bounds, opacity, sampling: self.sampling })
    }

    /// True while the picture of the document is being prepared for drawing.
    pub fn is_making_picture(&self) -> bool {
        self.job.is_busy()
    }

    /// Failure to prepare the picture, returned once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// Follows a change of the document's picture. Prepares a new picture for drawing in the background (mip levels).
    /// Plain and checkered faces switch to a new picture, unless their shading was restored from an earlier run. All
    /// faces switch to a picture that the user opens.
    /// Without a picture, shadings by the picture fall back to the checker. Call once per frame.
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
        let on_picture = wanted.map(|_| std::mem::take(&mut self.usual.on_picture));
        for shading in [&mut self.usual.mesh, &mut self.usual.plane] {
            *shading = match *shading {
                ShadingMode::Picture | ShadingMode::SeeThrough if on_picture.is_none() => ShadingMode::Checker,
                _ if on_picture == Some(OnPicture::Shows) => ShadingMode::Picture,
                ShadingMode::Plain | ShadingMode::Checker if on_picture == Some(OnPicture::FillsIn) => {
                    ShadingMode::Picture
                }
                other => other,
            };
        }
    }

    /// Recolours the faces of a pane if mesh, embedding or shading have changed. Moves are measured from `base`.
    pub(super) fn refresh_paint(&mut self, pane: Pane, shading: ShadingMode, sources: PaintSources<'_>) {
        let PaintSources { given, plane, base, column } = sources;
        let column = column.filter(|_| shading == ShadingMode::Column);
        let base = base.filter(|_| shading == ShadingMode::Move);
        let key = PaintKey {
            model: given.model_revision,
            outcome: plane.map_or(0, |scene| scene.outcome_revision),
            // Shadings without a number per face share one paint.
            shading: if shading.is_by_number() { shading } else { ShadingMode::Plain },
            moved_from: base.map(|base| base.step.index),
            column: column.map_or(0, |column| column.revision),
        };
        let fits = |paint: &&Arc<BrushPaint>| paint.key == key;
        if self.paints[pane as usize].as_ref().is_none_or(|paint| paint.key != key) {
            let shared = self.paints.iter().flatten().find(fits).cloned();
            let mesh = plane.map_or(given, |plane| &plane.mesh).mesh();
            let made = || {
                let numbers = |column: ShownColumn<'_>| {
                    column.values_on(mesh, &given.model, vertices_in_file(&given.model).as_deref())
                };
                let values = PaintValues { base, column: column.map(numbers) };
                Arc::new(BrushPaint::new(key, mesh, plane.map(|plane| plane.outcome.as_ref()), values))
            };
            self.paints[pane as usize] = Some(shared.unwrap_or_else(made));
        }
    }

    pub(super) fn forget_paint(&mut self) {
        self.paints = [None, None];
    }
}

/// Inputs of the face colours.
#[derive(Clone, Copy)]
pub(super) struct PaintSources<'a> {
    /// Mesh as given.
    pub(super) given: &'a MeshScene,
    /// Embedding on the screen.
    pub(super) plane: Option<&'a PlaneScene>,
    /// Step that moves are measured from.
    pub(super) base: Option<&'a Outcome>,
    /// Column of a table.
    pub(super) column: Option<ShownColumn<'a>>,
}
