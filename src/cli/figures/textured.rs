//! Figures 8 and 9: texture mapping with constraints, on the built-in face and its portrait.

use std::sync::Arc;

use glam::DVec2;

use super::free::flips_in_words;
use super::{Figure, Numbers, Row};
use crate::examples::{Example, Landmark};
use crate::geom::Picture;
use crate::io::figure::{Panel, PhotoDrawing, PlaneDrawing, Sheet, Window, zones_of};
use crate::io::raster::{Canvas, Paint, View, mesh_picture, mesh_places};
use crate::mesh::DiskMesh;
use crate::solver::{Control, Ladder, Method, Pin, Pins, Settings, SolveError, Step};

/// Pixels across the pictures of the mesh.
const PIXELS: u32 = 580;

/// Weights of figure 9's rows, with their names: with the larger ones the constraints are met nearly exactly.
const WEIGHTS: [(&str, f64); 2] = [("large", 30.0), ("medium", 1.0)];

/// The face with what belongs to it.
pub(super) struct Subject {
    mesh: Arc<DiskMesh>,
    portrait: Picture,
    landmarks: Vec<Landmark>,
}

impl Subject {
    pub(super) fn face() -> Self {
        let mesh = DiskMesh::try_from(Example::Face.mesh()).expect("built-in meshes are disks");
        let portrait = Example::Face.picture().expect("the face has a portrait");
        Self { mesh: Arc::new(mesh), portrait, landmarks: Example::Face.landmarks() }
    }

    /// The landmarks as constraints that are met exactly.
    fn hard_pins(&self) -> Pins {
        self.landmarks.iter().map(|landmark| (landmark.vertex, Pin::hard(landmark.target.into()))).collect()
    }

    /// The landmarks as constraints by weight.
    fn weighted_pins(&self, weight: f64) -> Pins {
        let pin = |landmark: &Landmark| (landmark.vertex, Pin::weighted(landmark.target.into(), weight));
        self.landmarks.iter().map(pin).collect()
    }

    /// The first solve, and where the iteration ends.
    fn solved(&self, pins: Pins, control: Control<'_>) -> Result<[Step; 2], SolveError> {
        let settings = Settings { method: Method::Iterate, ..Settings::default() };
        let mut steps: Vec<Step> = Vec::new();
        Ladder::new(settings, pins).finish(&self.mesh, control, |step| steps.push(step))?;
        let last = steps.last().expect("a run that ends well has a step").clone();
        Ok([steps.swap_remove(0), last])
    }

    /// The mesh from the front, under a paint.
    fn seen(&self, paint: Paint) -> Picture {
        let mesh = self.mesh.mesh();
        mesh_picture(&mesh.positions, &mesh.triangles, &View::FRONT, &Canvas::clay(PIXELS, PIXELS), paint)
    }

    /// The mesh from the front, under the portrait.
    fn textured(&self, step: &Step) -> Picture {
        self.seen(Paint::Picture { coordinates: &step.solution.embedding, picture: &self.portrait })
    }

    /// An embedding with the flipped faces magnified.
    fn layout(&self, step: &Step) -> PlaneDrawing {
        let places = &step.solution.embedding;
        let zones = zones_of(&self.mesh, places, &step.verdict.flipped_faces);
        PlaneDrawing {
            flipped: step.verdict.flipped_faces.clone(),
            pins: step.solution.pins.keys().copied().collect(),
            insets: zones.iter().take(1).map(|zone| Window::on_faces(&self.mesh, places, zone)).collect(),
            ..PlaneDrawing::new(&self.mesh, places.clone())
        }
    }
}

/// The correspondences, and the texture on the mesh where they are met exactly.
pub(super) fn figure_8(face: &Subject, control: Control<'_>) -> Result<Figure, SolveError> {
    let [first, last] = face.solved(face.hard_pins(), control)?;
    let mesh = face.mesh.mesh();
    let places = mesh_places(&mesh.positions, &View::FRONT, &Canvas::clay(PIXELS, PIXELS));
    let on_mesh = face.landmarks.iter().map(|landmark| places[landmark.vertex.index()]).collect();
    let on_picture: Vec<DVec2> = face.landmarks.iter().map(|landmark| landmark.target.into()).collect();
    let photo = |picture: Picture, marks: Vec<DVec2>| PhotoDrawing { picture, marks };
    let iterations = iterations_in_words(last.index - first.index);
    let words = [
        format!("(a) the mesh with {} constraints", face.landmarks.len()),
        "(b) the picture with their targets".to_owned(),
        format!("(c) the picture on the mesh after {iterations}"),
    ];
    let rows = [None, None, Some(Numbers::of(&last))];
    let rows = ('a'..).zip(&words).zip(rows).map(|((panel, words), numbers)| Row {
        panel,
        shows: words[4..].to_owned(),
        numbers,
    });
    let rows = rows.collect();
    let [first_words, second_words, third_words] = words.map(|words| vec![words]);
    let panels = vec![
        Panel::photo(first_words, photo(face.seen(Paint::Clay), on_mesh)),
        Panel::photo(second_words, photo(face.portrait.clone(), on_picture)),
        Panel::photo(third_words, photo(face.textured(&last), Vec::new())),
    ];
    let caption = "Figure 8. Texture mapping with constraints: (a) landmarks of the mesh and (b) their places in the \
                   picture, of the same number; (c) the mesh with the picture. Each landmark lies on its place exactly, and \
                   no face is flipped."
        .to_owned();
    Ok(Figure { number: 8, sheet: Sheet { columns: 3, panels, caption }, rows })
}

fn iterations_in_words(count: usize) -> String {
    if count == 1 { "1 iteration".to_owned() } else { format!("{count} iterations") }
}

/// Weighted constraints, before and after the iteration.
pub(super) fn figure_9(face: &Subject, control: Control<'_>) -> Result<Figure, SolveError> {
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    let mut letters = 'a'..='z';
    let mut take = |words: &str, step: &Step| {
        let panel = letters.next().expect("a figure has few panels");
        rows.push(Row { panel, shows: words.to_owned(), numbers: Some(Numbers::of(step)) });
        vec![format!("({panel}) {words}")]
    };
    for (name, weight) in WEIGHTS {
        let [first, last] = face.solved(face.weighted_pins(weight), control)?;
        let miss = face
            .landmarks
            .iter()
            .map(|landmark| last.solution.embedding[landmark.vertex].distance(landmark.target.into()));
        let miss = miss.fold(0.0, f64::max);
        let words = take(&format!("{name} weights: {}", flips_in_words(&first)), &first);
        panels.push(Panel::plane(words, face.layout(&first)));
        let words = take(&format!("after {}: {}", iterations_in_words(last.index), flips_in_words(&last)), &last);
        panels.push(Panel::plane(words, face.layout(&last)));
        let words = take(&format!("the picture on the mesh; the farthest off by {miss:.1e}"), &last);
        panels.push(Panel::photo(words, PhotoDrawing { picture: face.textured(&last), marks: Vec::new() }));
    }
    let caption = format!(
        "Figure 9. Constraints by weights: large ones, {}, above, and medium ones, {}, below. The first solve (left) \
         flips faces, red; the iteration (middle) repairs them; the picture on the mesh (right). \
         The larger the weights, the nearer do the landmarks come to their places; the farthest is off by so much of the \
         picture's width.",
        WEIGHTS[0].1, WEIGHTS[1].1
    );
    Ok(Figure { number: 9, sheet: Sheet { columns: 3, panels, caption }, rows })
}
