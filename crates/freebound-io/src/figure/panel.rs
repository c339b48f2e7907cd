//! Embedding drawn into an area: faces, flipped faces, hull and pockets, pins.

use std::sync::Arc;

use glam::DVec2;

use super::{Anchor, Ink, Page, colours};
use freebound_core::flatten::Step;
use freebound_core::geom::Bounds;
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::problem::Embedding;

/// Half the side of a pin's square, points.
const PIN: f64 = 3.2;

/// Least half side of a frame around a magnified part, points.
const LEAST_FRAME: f64 = 8.0;

/// Width of the lines of an embedding that is shown whole, points.
const EDGE: f64 = 0.4;

/// Width of the hull, points.
const HULL: f64 = 1.6;

/// Factor of the line widths in a magnified window.
const MAGNIFIED: f64 = 2.2;

/// Margin around an embedding, relative to its extent.
const MARGIN: f64 = 0.03;

/// Margin around the faces that a window shows, relative to their extent.
const WINDOW_MARGIN: f64 = 0.45;

/// Margin around the triangles of a pocket, relative to their extent.
const TRIANGLES_MARGIN: f64 = 0.08;

/// Faces nearer to each other than this fraction of the embedding's extent share a window.
const ZONE: f64 = 0.1;

/// Square of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Centre of the square.
    pub centre: DVec2,
    /// Half the side of the square.
    pub half: f64,
}

impl Window {
    /// Square around a box, with a margin on each side relative to the box's extent.
    fn around(bounds: Bounds, margin: f64) -> Self {
        Self { centre: bounds.middle(), half: bounds.size().max_element() * (0.5 + margin) }
    }

    /// Square around all embeddings, so that drawings of them have one camera.
    pub fn common<'a>(embeddings: impl Iterator<Item = &'a Embedding>) -> Option<Self> {
        embeddings.map(Embedding::bounds).reduce(Bounds::union).map(|bounds| Self::around(bounds, MARGIN))
    }

    /// Square around some faces of an embedding.
    pub fn on_faces(mesh: &DiskMesh, embedding: &Embedding, faces: &[FaceId]) -> Self {
        let corners = faces.iter().flat_map(|&face| mesh.face(face));
        Self::around(Bounds::of(corners.map(|v| embedding[v])), WINDOW_MARGIN)
    }

    /// Square around some triangles of an embedding, moved into the part that a panel of the whole embedding shows.
    pub fn on_triangles(embedding: &Embedding, triangles: &[[VertexId; 3]]) -> Self {
        let whole = Self::around(embedding.bounds(), MARGIN);
        let window = Self::around(Bounds::of(triangles.iter().flatten().map(|&v| embedding[v])), TRIANGLES_MARGIN);
        let room = DVec2::splat((whole.half - window.half).max(0.0));
        Self { centre: window.centre.clamp(whole.centre - room, whole.centre + room), ..window }
    }
}

/// Groups faces that are near each other in an embedding, the largest group first.
pub fn zones_of(mesh: &DiskMesh, embedding: &Embedding, faces: &[FaceId]) -> Vec<Vec<FaceId>> {
    let reach = ZONE * 2.0 * Window::around(embedding.bounds(), 0.0).half;
    let centre = |face: FaceId| mesh.face(face).iter().map(|v| embedding[v]).sum::<DVec2>() / 3.0;
    let mut zones: Vec<Vec<FaceId>> = Vec::new();
    for &face in faces {
        let is_near = |zone: &Vec<FaceId>| zone.iter().any(|&other| centre(face).distance(centre(other)) < reach);
        let (near, mut far): (Vec<_>, Vec<_>) = zones.into_iter().partition(is_near);
        let mut joined: Vec<FaceId> = near.into_iter().flatten().collect();
        joined.push(face);
        joined.sort_unstable();
        far.push(joined);
        zones = far;
    }
    zones.sort_by_key(|zone| (std::cmp::Reverse(zone.len()), zone.first().copied()));
    zones
}

/// Style of the pockets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pockets {
    /// Filled areas.
    Filled,
    /// Triangles with their edges.
    Triangulated,
}

/// Hull and pockets of a virtual boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideShade {
    /// Convex outline.
    pub hull: Vec<VertexId>,
    /// Triangles between boundary and hull.
    pub pockets: Vec<[VertexId; 3]>,
    /// Style of the pockets.
    pub style: Pockets,
}

/// Embedding in a panel.
#[derive(Clone, Debug)]
pub struct PlaneDrawing {
    /// The mesh.
    pub mesh: Arc<DiskMesh>,
    /// Embedding of the mesh's vertices, followed by the virtual vertices.
    pub embedding: Embedding,
    /// Faces drawn red.
    pub flipped: Vec<FaceId>,
    /// Tinted faces, which were flipped before.
    pub with_all_repairs: Vec<FaceId>,
    /// Hull and pockets.
    pub outside: Option<OutsideShade>,
    /// Pinned vertices, marked by squares.
    pub pins: Vec<VertexId>,
    /// Window that is shown. Default: the whole embedding.
    pub window: Option<Window>,
    /// Framed window, which another panel magnifies.
    pub framed: Option<Window>,
    /// Windows that insets beside the drawing magnify.
    pub insets: Vec<Window>,
}

impl PlaneDrawing {
    /// Plain drawing of an embedding.
    pub fn new(mesh: &Arc<DiskMesh>, embedding: Embedding) -> Self {
        Self {
            mesh: Arc::clone(mesh),
            embedding,
            flipped: Vec::new(),
            with_all_repairs: Vec::new(),
            outside: None,
            pins: Vec::new(),
            window: None,
            framed: None,
            insets: Vec::new(),
        }
    }

    /// Drawing of a step with its flipped faces and pins.
    pub fn of_step(mesh: &Arc<DiskMesh>, step: &Step) -> Self {
        Self {
            flipped: step.verdict.flipped_faces.clone(),
            pins: step.candidate.solution.pins.keys().copied().collect(),
            ..Self::new(mesh, step.candidate.solution.embedding.clone())
        }
    }

    /// Adds insets that magnify flipped faces, at most `most`.
    #[must_use]
    pub fn with_insets(self, most: usize) -> Self {
        let zones = zones_of(&self.mesh, &self.embedding, &self.flipped);
        let window = |zone: &Vec<FaceId>| Window::on_faces(&self.mesh, &self.embedding, zone);
        let insets = zones.iter().take(most).map(window).collect();
        Self { insets, ..self }
    }

    /// Draws the embedding into an area.
    pub(super) fn draw(&self, page: &mut Page, area: Bounds) {
        let shown = self.window.unwrap_or_else(|| Window::around(self.embedding.bounds(), MARGIN));
        self.draw_window(page, area, shown);
        if self.window.is_some() {
            page.outlines(vec![area.corners().to_vec()], Ink::stroke(colours::INK, 0.8), None);
        }
        let frame_of = |window: &Window| {
            let place = placing(area, shown);
            let half = DVec2::new(window.half, -window.half);
            let [low, high] = [place(window.centre - half), place(window.centre + half)];
            // A frame that a pin's square would hide is drawn larger than its window.
            let (centre, half) = (low.midpoint(high), ((high - low) / 2.0).max(DVec2::splat(LEAST_FRAME)));
            Bounds { low: centre - half, high: centre + half }
        };
        let frame_ink = Ink::stroke(colours::FRAME, 0.9);
        if let Some(window) = &self.framed {
            page.outlines(vec![frame_of(window).corners().to_vec()], frame_ink, None);
        }
        for (number, window) in (1..).zip(&self.insets) {
            let frame = frame_of(window);
            page.outlines(vec![frame.corners().to_vec()], frame_ink, None);
            let at = DVec2::new(frame.high.x + 2.5, frame.low.y + 7.0);
            page.words(at, Anchor::Start, 9.0, &format!("{number}"));
        }
    }

    /// Draws a magnified window, in a frame with its number.
    pub(super) fn draw_inset(&self, page: &mut Page, area: Bounds, number: usize) {
        self.draw_window(page, area, self.insets[number]);
        page.outlines(vec![area.corners().to_vec()], Ink::stroke(colours::FRAME, 0.9), None);
        let label = Bounds::at(area.low, DVec2::new(12.0, 13.0));
        page.outlines(vec![label.corners().to_vec()], Ink::both(colours::PAPER, colours::FRAME, 0.9), None);
        let at = DVec2::new(label.middle().x, label.high.y - 3.0);
        page.words(at, Anchor::Middle, 9.0, &format!("{}", number + 1));
    }

    fn draw_window(&self, page: &mut Page, area: Bounds, shown: Window) {
        let place = placing(area, shown);
        let at = |v: VertexId| place(self.embedding[v]);
        let whole = Window::around(self.embedding.bounds(), MARGIN);
        let width = if shown.half < 0.5 * whole.half { MAGNIFIED * EDGE } else { EDGE };
        let clip = Some(area);
        let corners = |faces: &[FaceId]| -> Vec<Vec<DVec2>> {
            faces.iter().map(|&face| self.mesh.face(face).map(at).to_vec()).collect()
        };
        let all: Vec<FaceId> = self.mesh.faces().collect();
        if let Some(outside) = &self.outside {
            let pockets: Vec<Vec<DVec2>> = outside.pockets.iter().map(|t| t.map(at).to_vec()).collect();
            let edge = match outside.style {
                Pockets::Filled => colours::POCKET,
                Pockets::Triangulated => colours::POCKET_EDGE,
            };
            page.outlines(pockets, Ink::both(colours::POCKET, edge, 0.6 * width), clip);
        }
        page.outlines(corners(&all), Ink::fill(colours::FACE), clip);
        page.outlines(corners(&self.with_all_repairs), Ink::fill(colours::MENDED), clip);
        let edges = self.mesh.edges().filter(|&e| !self.mesh.is_boundary_edge(e));
        page.lines(
            edges.map(|e| self.mesh.ends(e).map(at).to_vec()).collect(),
            Ink::stroke(colours::EDGE, width),
            clip,
        );
        let red = Ink::both(colours::FLIPPED, colours::FLIPPED_EDGE, width);
        page.outlines(corners(&self.flipped), red, clip);
        let boundary = self.mesh.boundary_loop().iter().map(|&v| at(v)).collect();
        page.outlines(vec![boundary], Ink::stroke(colours::INK, 2.5 * width), clip);
        if let Some(outside) = &self.outside {
            let hull = outside.hull.iter().map(|&v| at(v)).collect();
            page.outlines(vec![hull], Ink::stroke(colours::HULL, HULL), clip);
        }
        self.draw_pins(page, area, &at);
    }

    fn draw_pins(&self, page: &mut Page, area: Bounds, at: &impl Fn(VertexId) -> DVec2) {
        let squares = self.pins.iter().map(|&v| {
            let half = DVec2::splat(PIN);
            Bounds { low: at(v) - half, high: at(v) + half }.corners().to_vec()
        });
        page.outlines(squares.collect(), Ink::both(colours::PAPER, colours::PIN, 1.4), Some(area));
    }
}

/// Map from the plane to an area of the page, as large as fits.
pub(super) fn placing(area: Bounds, shown: Window) -> impl Fn(DVec2) -> DVec2 {
    let scale = area.size().min_element() / (2.0 * shown.half);
    move |z| area.middle() + scale * DVec2::new(z.x - shown.centre.x, shown.centre.y - z.y)
}
