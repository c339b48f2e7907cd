//! Morph between two compared methods: its frame on the screen, its camera, and its playback. Only proved frames are
//! shown, never an interpolation of two.

use std::sync::Arc;

use glam::DVec2;

use crate::session::MorphTour;
use crate::ui::editor::paint::Legend;
use crate::ui::editor::scene::MeshScene;
use crate::view::{FacePaint, MorphSight, PlaneArrays, PlaneCamera, Quantity, Range, UnitPlane};
use freebound_core::geom::Bounds;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::Embedding;
use freebound_core::verify::distortion;
use freebound_io::figure::Window;

/// State of the morph in the window.
#[derive(Debug, Default)]
pub struct MorphView {
    pub(super) is_shown: bool,
    /// Time in the morph, 0 to 1.
    pub(super) share: f64,
    /// Clock time at which the morph was at 0, or would have been, while it is played; seconds of the window's clock.
    pub(super) playing_since: Option<f64>,
    pub(super) drawn: Option<DrawnTour>,
    camera: Option<PlaneCamera>,
    /// Last camera that the window chose, and the size of the view at that time.
    framed: Option<(PlaneCamera, DVec2)>,
}

/// Index of a frame, and the quantity that colours its faces.
type FrameKey = (usize, Option<Quantity>);

/// Morph prepared for drawing: data common to all frames, computed once, and the last drawn frame.
#[derive(Debug)]
pub(super) struct DrawnTour {
    tour: Arc<MorphTour>,
    sight: MorphSight,
    /// Last requested quantity, and its range.
    range: Option<(Quantity, Option<Range>)>,
    frame: Option<(FrameKey, MorphFrame)>,
}

impl DrawnTour {
    fn new(tour: &Arc<MorphTour>) -> Self {
        Self { tour: Arc::clone(tour), sight: MorphSight::new(tour), range: None, frame: None }
    }

    /// Colour range of all frames: the common range of the maps at the stops.
    fn range_of(&mut self, quantity: Quantity) -> Option<Range> {
        if let Some((_, range)) = self.range.filter(|(of, _)| *of == quantity) {
            return range;
        }
        let ends = self.tour.stops.stops.iter().map(|stop| &stop.outcome.distortion);
        let range = quantity.common_range(ends);
        self.range = Some((quantity, range));
        range
    }

    /// Drawn frame, cached for the last key.
    fn frame(&mut self, mesh: Option<&Arc<MeshScene>>, key: FrameKey) -> Option<MorphFrame> {
        if self.frame.as_ref().is_none_or(|(of, _)| *of != key) {
            let (number, quantity) = key;
            let colours = quantity.and_then(|quantity| Some((quantity, self.range_of(quantity)?)));
            let embedding = self.tour.legs.first()?.frames.get(number)?;
            self.frame = Some((key, MorphFrame::new(mesh?, embedding, self.sight.window(embedding), colours)?));
        }
        self.frame.as_ref().map(|(_, frame)| frame.clone())
    }
}

/// Drawn data of a frame.
#[derive(Clone, Debug)]
pub(in crate::ui) struct MorphFrame {
    pub(in crate::ui) mesh: Arc<MeshScene>,
    pub(in crate::ui) arrays: Arc<PlaneArrays>,
    pub(in crate::ui) faces: Arc<FacePaint>,
    pub(in crate::ui) legend: Option<Legend>,
    /// Centre and half side of the square that this frame maps to the square [−1, 1]² of the common camera.
    middle: DVec2,
    half: f64,
}

impl MorphFrame {
    fn new(
        mesh: &Arc<MeshScene>,
        embedding: &Embedding,
        window: Window,
        colours: Option<(Quantity, Range)>,
    ) -> Option<Self> {
        let disk: &DiskMesh = mesh.model.disk()?;
        let unit = UnitPlane::of(Bounds::at(window.centre - window.half, DVec2::splat(2.0 * window.half)));
        let (faces, legend) = match colours {
            Some((by, range)) => {
                let values = by.values(&distortion(disk, embedding));
                (FacePaint::by_value(&values, by.scale(), range, &[]), Some(Legend::new(by.scale(), range, &values)))
            }
            None => (FacePaint::plain(disk.mesh().real_face_count(), &[]), None),
        };
        Some(Self {
            mesh: Arc::clone(mesh),
            arrays: Arc::new(PlaneArrays::in_frame(embedding, disk.mesh().real_triangles(), unit)),
            faces: Arc::new(faces),
            legend,
            middle: window.centre,
            half: window.half,
        })
    }

    /// Camera that shows this frame as `common` shows the square [−1, 1]².
    pub(in crate::ui) fn camera(&self, common: &PlaneCamera) -> PlaneCamera {
        common.over_similar(self.middle, self.half)
    }
}

impl MorphView {
    /// Open morph at its start.
    pub(super) fn shown() -> Self {
        Self { is_shown: true, ..Self::default() }
    }

    /// True if the morph shows in place of the cells.
    pub fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// Time in the morph, 0 to 1.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Bounding box of the last drawn frame in the plane; `None` without a drawn frame.
    pub fn bounds_drawn(&self) -> Option<Bounds> {
        self.drawn.as_ref()?.frame.as_ref().map(|(_, frame)| frame.arrays.bounds)
    }

    /// True while the morph is played.
    pub fn is_playing(&self) -> bool {
        self.playing_since.is_some()
    }

    /// Index of the frame at the current time, rounded to the nearest of `count` frames.
    pub fn frame_of(&self, count: usize) -> usize {
        let last = count.saturating_sub(1);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a small count")]
        let nearest = (self.share.clamp(0.0, 1.0) * last as f64).round() as usize;
        nearest.min(last)
    }

    /// Drawn data of the current frame, made if it is missing.
    pub(in crate::ui) fn drawn(
        &mut self,
        mesh: Option<&Arc<MeshScene>>,
        tour: &Arc<MorphTour>,
        quantity: Option<Quantity>,
    ) -> Option<MorphFrame> {
        let key = (self.frame_of(tour.legs.first()?.frames.len()), quantity);
        if self.drawn.as_ref().is_none_or(|drawn| !Arc::ptr_eq(&drawn.tour, tour)) {
            self.drawn = Some(DrawnTour::new(tour));
        }
        self.drawn.as_mut()?.frame(mesh, key)
    }

    /// Camera of all frames, for a view of this size. Reframes when the size changes, unless the user has moved the
    /// camera.
    pub(in crate::ui) fn camera_in(&mut self, size: DVec2) -> PlaneCamera {
        let is_framed = self.framed.is_some_and(|(camera, of)| self.camera == Some(camera) && of != size);
        if let Some(camera) = self.camera.filter(|_| !is_framed) {
            return camera;
        }
        let square = Bounds { low: DVec2::NEG_ONE, high: DVec2::ONE };
        let camera = PlaneCamera::framing(square, size);
        (self.camera, self.framed) = (Some(camera), Some((camera, size)));
        camera
    }

    pub(in crate::ui) fn set_camera(&mut self, camera: PlaneCamera) {
        self.camera = Some(camera);
    }

    /// Frames the whole morph.
    pub(super) fn frame(&mut self) {
        self.camera = None;
    }
}
