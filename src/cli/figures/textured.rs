//! Figures 8 and 9: texture mapping with constraints, on the built-in face and its portrait.

use std::sync::Arc;

use glam::DVec2;

use super::{Figure, flips_in_words, iterations_in_words};
use crate::examples::{Example, Landmark};
use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::Picture;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Method, Pin, Pins, Settings, SolveError};
use freebound_io::figure::{Drawing, PhotoDrawing, PlaneDrawing};
use freebound_io::raster::{Canvas, RasterPaint, View, mesh_picture, mesh_places};

/// Width of the pictures of the mesh, pixels.
const PIXELS: u32 = 580;

/// Weights of the rows of figure 9, with their names. Large weights meet the constraints nearly exactly.
const WEIGHTS: [(&str, f64); 2] = [("large", 30.0), ("medium", 1.0)];

/// Face mesh with its portrait and landmarks.
pub(super) struct FigureSubject {
    mesh: Arc<DiskMesh>,
    portrait: Picture,
    landmarks: Vec<Landmark>,
}

impl FigureSubject {
    pub(super) fn face() -> Self {
        let mesh = DiskMesh::try_from(Example::Face.mesh()).expect("built-in meshes are disks");
        let portrait = Example::Face.picture().expect("the face has a portrait");
        Self { mesh: Arc::new(mesh), portrait, landmarks: Example::Face.landmarks() }
    }

    /// Landmarks as pins. `pin` makes a pin of a target.
    fn pins(&self, pin: impl Fn(DVec2) -> Pin) -> Pins {
        self.landmarks.iter().map(|landmark| (landmark.vertex, pin(landmark.target.into()))).collect()
    }

    /// First and last step of the iteration.
    fn solved(&self, pins: Pins, control: Control<'_>) -> Result<[Step; 2], SolveError> {
        let settings = Settings { method: Method::Iterate, ..Settings::default() };
        let mut steps: Vec<Step> = Vec::new();
        Flattener::new(settings, pins).finish(&self.mesh, control, |step| steps.push(step))?;
        let last = steps.last().expect("a run that ends well has a step").clone();
        Ok([steps.swap_remove(0), last])
    }

    /// Front view of the mesh with a paint.
    fn seen(&self, paint: RasterPaint) -> Picture {
        let mesh = self.mesh.mesh();
        mesh_picture(&mesh.positions, &mesh.triangles, &View::FRONT, &Canvas::clay(PIXELS, PIXELS), paint)
    }

    /// Front view of the mesh with the portrait.
    fn textured(&self, step: &Step) -> Picture {
        self.seen(RasterPaint::Picture { coordinates: &step.candidate.solution.embedding, picture: &self.portrait })
    }

    /// Drawing of an embedding, with flipped faces magnified.
    fn layout(&self, step: &Step) -> Drawing {
        Drawing::Plane(PlaneDrawing::of_step(&self.mesh, step).with_insets(1))
    }
}

/// Picture with numbered marks.
fn photo(picture: Picture, marks: Vec<DVec2>) -> Drawing {
    Drawing::Photo(PhotoDrawing { picture, marks })
}

/// Draws the correspondences, and the textured mesh with hard constraints.
pub(super) fn figure_8(face: &FigureSubject, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = "Figure 8. Texture mapping with constraints: (a) landmarks of the mesh and (b) their targets in the \
                   picture, with equal numbers; (c) the mesh with the picture. Each landmark lies exactly on its \
                   target, and no face is flipped.";
    let mut figure = Figure::new(8, 3, caption);
    let [first, last] = face.solved(face.pins(Pin::hard), control)?;
    let mesh = face.mesh.mesh();
    let points = mesh_places(&mesh.positions, &View::FRONT, &Canvas::clay(PIXELS, PIXELS));
    let on_mesh = face.landmarks.iter().map(|landmark| points[landmark.vertex.index()]).collect();
    let on_picture = face.landmarks.iter().map(|landmark| landmark.target.into()).collect();
    figure.panel(
        &format!("the mesh with {} constraints", face.landmarks.len()),
        photo(face.seen(RasterPaint::Clay), on_mesh),
    );
    figure.panel("the picture with their targets", photo(face.portrait.clone(), on_picture));
    let words = format!("the picture on the mesh after {}", iterations_in_words(last.index - first.index));
    figure.panel(&words, photo(face.textured(&last), Vec::new())).measure(&last);
    Ok(figure)
}

/// Draws soft constraints before and after the iteration.
pub(super) fn figure_9(face: &FigureSubject, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = format!(
        "Figure 9. Soft constraints: large weights, {}, above, and medium weights, {}, below. The first solve (left) \
         flips faces, red; the iteration (middle) repairs them; the picture on the mesh (right). Larger weights bring \
         the landmarks nearer to their targets; the largest distance is given in picture widths.",
        WEIGHTS[0].1, WEIGHTS[1].1
    );
    let mut figure = Figure::new(9, 3, caption);
    for (name, weight) in WEIGHTS {
        let [first, last] = face.solved(face.pins(|target| Pin::weighted(target, weight)), control)?;
        let words = format!("{name} weights: {}", flips_in_words(&first));
        figure.panel(&words, face.layout(&first)).measure(&first);
        let words = format!("after {}: {}", iterations_in_words(last.index), flips_in_words(&last));
        figure.panel(&words, face.layout(&last)).measure(&last);
        let off = |mark: &Landmark| last.candidate.solution.embedding[mark.vertex.index()].distance(mark.target.into());
        let miss = face.landmarks.iter().map(off).fold(0.0, f64::max);
        let words = format!("the picture on the mesh; largest distance {miss:.1e}");
        figure.panel(&words, photo(face.textured(&last), Vec::new())).measure(&last);
    }
    Ok(figure)
}
