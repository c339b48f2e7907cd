//! Embedding drawn into an area with a colour on each face.

use std::collections::BTreeMap;

use glam::DVec2;

use super::{Ink, Page, Window, colours, placing};
use crate::raster::Colour;
use freebound_core::flatten::Step;
use freebound_core::geom::Bounds;
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::problem::Embedding;

/// Width of the edges of faces, points.
const EDGE: f64 = 0.3;

/// Least mean length of edges that are drawn, points: shorter ones would only blacken the faces.
const LEAST_EDGE: f64 = 6.0;

/// Width of the line around a face in the face's colour, points. It hides the gaps between faces.
const SEAL: f64 = 0.5;

/// Width of the boundary, points.
const BOUNDARY: f64 = 0.9;

/// Half the side of a pin's square, points.
const PIN: f64 = 2.4;

/// Radius of the ring around a crossing, points.
const RING: f64 = 4.0;

/// Number of corners of a ring.
const RING_CORNERS: u32 = 16;

/// Embedding with a colour on each face.
#[derive(Clone, Debug)]
pub struct TintedDrawing {
    faces: Vec<[DVec2; 3]>,
    /// Colour of each face.
    colours: Vec<Colour>,
    flipped: Vec<FaceId>,
    /// Boundary loop, and the loops around holes.
    boundary: Vec<Vec<DVec2>>,
    crossings: Vec<DVec2>,
    pins: Vec<DVec2>,
    /// Window that is shown.
    window: Window,
}

impl TintedDrawing {
    /// Drawing of a step: its defects, its pins, and a colour for each real face, in a window. `given` is the mesh
    /// before new vertices.
    ///
    /// # Panics
    ///
    /// If the number of colours is not the number of real faces.
    pub fn of_step(given: &DiskMesh, step: &Step, colours: Vec<Colour>, window: Window) -> Self {
        let (mesh, embedding) = (step.candidate.mesh(given), &step.candidate.solution.embedding);
        let triangles = mesh.mesh().real_triangles();
        assert_eq!(colours.len(), triangles.len(), "every face has a colour");
        let pins = step.candidate.solution.pins.keys().copied().filter(|_| !step.candidate.solution.gauge_completed);
        Self {
            faces: triangles.iter().map(|corners| corners.map(|v| embedding[v])).collect(),
            colours,
            flipped: step.verdict.flipped_faces.clone(),
            boundary: loops_of(mesh, embedding),
            crossings: crossings(mesh, embedding, step),
            pins: pins.map(|vertex| embedding[vertex]).collect(),
            window,
        }
    }

    /// Drawing of a planar embedding of a mesh, with a colour for each real face, in a window.
    ///
    /// # Panics
    ///
    /// If the number of colours is not the number of real faces.
    pub fn of_planar(mesh: &DiskMesh, embedding: &Embedding, colours: Vec<Colour>, window: Window) -> Self {
        let triangles = mesh.mesh().real_triangles();
        assert_eq!(colours.len(), triangles.len(), "every face has a colour");
        Self {
            faces: triangles.iter().map(|corners| corners.map(|v| embedding[v])).collect(),
            colours,
            flipped: Vec::new(),
            boundary: loops_of(mesh, embedding),
            crossings: Vec::new(),
            pins: Vec::new(),
            window,
        }
    }

    /// Draws the embedding into an area.
    pub(super) fn draw(&self, page: &mut Page, area: Bounds) {
        let place = placing(area, self.window);
        let clip = Some(area);
        let outline = |face: usize| self.faces[face].map(&place).to_vec();
        let mut by_colour: BTreeMap<Colour, Vec<Vec<DVec2>>> = BTreeMap::new();
        for (face, &colour) in self.colours.iter().enumerate() {
            by_colour.entry(colour).or_default().push(outline(face));
        }
        for (colour, outlines) in by_colour {
            page.outlines(outlines, Ink::both(colour, colour, SEAL), clip);
        }
        if self.mean_edge() * area.size().min_element() / (2.0 * self.window.half) >= LEAST_EDGE {
            let all = (0..self.faces.len()).map(outline).collect();
            page.outlines(all, Ink::stroke(colours::EDGE, EDGE), clip);
        }
        let flipped = self.flipped.iter().map(|face| outline(face.index())).collect();
        page.outlines(flipped, Ink::both(colours::FLIPPED, colours::FLIPPED_EDGE, EDGE), clip);
        let placed = |line: &Vec<DVec2>| line.iter().map(|&z| place(z)).collect();
        page.outlines(self.boundary.iter().map(placed).collect(), Ink::stroke(colours::INK, BOUNDARY), clip);
        let rings = self.crossings.iter().map(|&z| ring(place(z))).collect();
        page.outlines(rings, Ink::stroke(colours::CROSSING, 1.2), clip);
        let squares = self.pins.iter().map(|&z| {
            let (at, half) = (place(z), DVec2::splat(PIN));
            Bounds { low: at - half, high: at + half }.corners().to_vec()
        });
        page.outlines(squares.collect(), Ink::both(colours::PAPER, colours::PIN, 1.0), clip);
    }

    /// Mean length of the edges, in the plane; 0 without faces.
    fn mean_edge(&self) -> f64 {
        let around = |[a, b, c]: &[DVec2; 3]| a.distance(*b) + b.distance(*c) + c.distance(*a);
        let sum: f64 = self.faces.iter().map(around).filter(|length| length.is_finite()).sum();
        sum / (3 * self.faces.len()).max(1) as f64
    }
}

/// Boundary loop, and the loops around holes.
fn loops_of(mesh: &DiskMesh, embedding: &Embedding) -> Vec<Vec<DVec2>> {
    let places = |vertices: &[VertexId]| vertices.iter().map(|&v| embedding[v]).collect();
    let holes = mesh.mesh().holes();
    std::iter::once(mesh.boundary_loop()).chain(holes.iter().map(|hole| &hole.rim[..])).map(places).collect()
}

/// Marks of the boundary crossings: the midpoint of the midpoints of both edges.
fn crossings(mesh: &DiskMesh, embedding: &Embedding, step: &Step) -> Vec<DVec2> {
    let middle = |edge| {
        let [a, b] = mesh.ends(edge).map(|v| embedding[v]);
        a.midpoint(b)
    };
    step.verdict.boundary_crossings.iter().map(|pair| middle(pair[0]).midpoint(middle(pair[1]))).collect()
}

fn ring(centre: DVec2) -> Vec<DVec2> {
    let angle = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(RING_CORNERS);
    (0..RING_CORNERS).map(|k| centre + RING * DVec2::from_angle(angle(k))).collect()
}
