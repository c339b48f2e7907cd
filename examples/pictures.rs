//! Draws the pictures of the README into `book/src/pictures/`: `cargo run --release --example pictures`.
//!
//! All meshes and the portrait are made by the project's own code. The moving picture is a pin that is dragged around its
//! target: every frame is an embedding that is proved planar before it is drawn.

use std::f64::consts::TAU;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use freebound_core::bijective::{DragSolver, DragTarget};
use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::Picture;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Method, Pin, Pins, Settings};
use freebound_core::verify::UvFrame;
use freebound_io::figure::{Drawing, OutsideShade, Page, Panel, PhotoDrawing, PlaneDrawing, Pockets, PrintedSheet};
use freebound_io::raster::{Canvas, RasterPaint, View, mesh_picture, write_png};
use freebound_io::{AnimationForm, AnimationFrame, write_animation};
use freebound_testkit::{BuiltIn, portrait};

/// Pixels of a page per point, of a still and of the moving picture.
const SCALE: f64 = 1.1;
const MOVING_SCALE: f64 = 0.9;

/// Pixels across a picture of a mesh in space.
const PIXELS: u32 = 330;

/// Frames of the moving picture, their duration in milliseconds, and the radius of the pin's path on the picture.
const FRAMES: usize = 24;
const MILLISECONDS: u16 = 90;
const RADIUS: f64 = 0.05;

/// Turns of the views, radians: the face nearly from the front, other meshes from the side.
const FACE_TURN: f64 = 0.35;
const SIDE_TURN: f64 = 0.6;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn main() -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src/pictures");
    fs::create_dir_all(&folder)?;
    let face = Face::new();
    moving(&face, &folder.join("drag.png"))?;
    let gallery: [(&str, PrintedSheet); 8] = [
        ("portrait", face.portrait_on_face()),
        ("folds", face.folds()),
        ("checker", checker(&BuiltIn::BumpyCap.mesh(), SIDE_TURN)),
        ("virtual-boundary", virtual_boundary()),
        ("grid", grid()),
        ("swirl", swirl()),
        ("spiral", checker(&BuiltIn::Spiral.mesh(), SIDE_TURN)),
        ("ell", checker(&BuiltIn::Ell.mesh(), SIDE_TURN)),
    ];
    for (name, sheet) in gallery {
        write(&sheet.page(), &folder.join(format!("{name}.png")))?;
    }
    Ok(())
}

fn write(page: &Page, path: &Path) -> Outcome {
    write_png(&page.picture(SCALE), BufWriter::new(File::create(path)?))?;
    println!("{:>9} bytes: {}", fs::metadata(path)?.len(), path.display());
    Ok(())
}

/// All steps of a method.
fn steps(mesh: &DiskMesh, settings: Settings, pins: Pins) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut run = Flattener::new(settings, pins);
    run.finish(mesh, Control::unattended(), |step| steps.push(step)).expect("built-in problems are solved");
    steps
}

fn last_of(mesh: &DiskMesh, settings: Settings, pins: Pins) -> Step {
    steps(mesh, settings, pins).pop().expect("a run has a step")
}

/// Two panels side by side, with a caption.
fn pair(left: (&str, Drawing), right: (&str, Drawing), caption: &str) -> PrintedSheet {
    let panel = |(words, drawing): (&str, Drawing)| Panel { words: words.to_owned(), drawing };
    PrintedSheet { columns: 2, panels: vec![panel(left), panel(right)], caption: caption.to_owned() }
}

/// A mesh in space.
fn seen(mesh: &TriMesh, turn: f64, paint: RasterPaint) -> Drawing {
    let canvas = Canvas::clay(PIXELS, PIXELS);
    let picture = mesh_picture(&mesh.positions, &mesh.triangles, &View::turned(turn), &canvas, paint);
    Drawing::Photo(PhotoDrawing { picture, marks: Vec::new() })
}

fn disk(mesh: TriMesh) -> Arc<DiskMesh> {
    Arc::new(DiskMesh::try_from(mesh).expect("built-in meshes are disks"))
}

/// The built-in face with its portrait and landmarks.
struct Face {
    mesh: Arc<DiskMesh>,
    portrait: Picture,
    pins: Pins,
}

impl Face {
    fn new() -> Self {
        let pin = |landmark: freebound_testkit::PlacedLandmark| (landmark.vertex, Pin::hard(landmark.target.into()));
        let pins = BuiltIn::Face.landmarks().into_iter().map(pin).collect();
        Self { mesh: disk(BuiltIn::Face.mesh()), portrait: portrait(512), pins }
    }

    fn textured(&self, embedding: &Embedding) -> Drawing {
        seen(self.mesh.mesh(), FACE_TURN, RasterPaint::Picture { coordinates: embedding, picture: &self.portrait })
    }

    fn portrait_on_face(&self) -> PrintedSheet {
        let step = last_of(&self.mesh, Settings::default(), self.pins.clone());
        pair(
            ("portrait on the face", self.textured(&step.candidate.solution.embedding)),
            ("embedding", Drawing::Plane(PlaneDrawing::of_step(&self.mesh, &step))),
            &format!("Twelve landmarks, met exactly; {}.", step.verdict.summary()),
        )
    }

    fn folds(&self) -> PrintedSheet {
        let all = steps(&self.mesh, Settings::default(), self.pins.clone());
        let (first, last) = (&all[0], &all[all.len() - 1]);
        let drawing = |step: &Step| Drawing::Plane(PlaneDrawing::of_step(&self.mesh, step));
        pair(
            ("first linear solve", drawing(first)),
            ("last step", drawing(last)),
            &format!("{} flipped faces, red, before; none after.", first.verdict.flipped_faces.len()),
        )
    }
}

/// A mesh under a checker, and its embedding.
fn checker(mesh: &TriMesh, turn: f64) -> PrintedSheet {
    let disk = disk(mesh.clone());
    let step = last_of(&disk, Settings { relax_rounds: Some(40), ..Settings::default() }, Pins::new());
    let embedding = &step.candidate.solution.embedding;
    let size = embedding.bounds().size().max_element() / 24.0;
    pair(
        ("checker", seen(mesh, turn, RasterPaint::Checker { coordinates: embedding, size })),
        ("embedding", Drawing::Plane(PlaneDrawing::new(&disk, embedding.clone()))),
        &format!("{} faces; {}.", mesh.triangles.len(), step.verdict.summary()),
    )
}

/// Hull and pockets of the virtual boundary, and its result.
fn virtual_boundary() -> PrintedSheet {
    let mesh = disk(BuiltIn::Cube.mesh());
    let ends = [24, 435].map(VertexId::new);
    let [a, b] = ends.map(|vertex| mesh.mesh().positions[vertex.index()]);
    let targets = [DVec2::ZERO, DVec2::new(a.distance(b), 0.0)];
    let pins = ends.into_iter().zip(targets.map(Pin::hard)).collect();
    let all = steps(&mesh, Settings::new(Method::VirtualBoundary, Family::MeanValue), pins);
    let last = &all[all.len() - 1];
    let stages = last.candidate.virtual_boundary.as_deref().expect("the method ends with a virtual boundary");
    let outside =
        OutsideShade { hull: stages.hull.clone(), pockets: stages.pockets.clone(), style: Pockets::Triangulated };
    let before = PlaneDrawing {
        embedding: stages.before.clone(),
        outside: Some(outside),
        ..PlaneDrawing::of_step(&mesh, &all[0])
    };
    pair(
        ("hull and pockets", Drawing::Plane(before)),
        ("result", Drawing::Plane(PlaneDrawing::of_step(&mesh, last))),
        "The virtual boundary of the paper (section 5).",
    )
}

/// The drawing on a grid, and what relaxing makes of it.
fn grid() -> PrintedSheet {
    let mesh = disk(BuiltIn::Dome.mesh());
    let all = steps(&mesh, Settings::new(Method::Schnyder, Family::Conformal), Pins::new());
    let drawing = |step: &Step| Drawing::Plane(PlaneDrawing::of_step(&mesh, step));
    pair(
        ("whole numbers on a grid", drawing(&all[0])),
        ("relaxed", drawing(&all[all.len() - 1])),
        "Schnyder's drawing is planar by theorem, and relaxing keeps it so.",
    )
}

/// A sheet whose inner pins are turned by a quarter.
fn swirl() -> PrintedSheet {
    let cells = 28_u32;
    let at = |x: u32, y: u32| DVec3::new(f64::from(x), f64::from(y), 0.0) / f64::from(cells);
    let number = |x: u32, y: u32| VertexId::new(y * (cells + 1) + x);
    let mut mesh = TriMesh::default();
    for y in 0..=cells {
        mesh.positions.extend((0..=cells).map(|x| at(x, y)));
    }
    for (x, y) in (0..cells).flat_map(|y| (0..cells).map(move |x| (x, y))) {
        let [a, b, c, d] = [number(x, y), number(x + 1, y), number(x + 1, y + 1), number(x, y + 1)];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let disk = disk(mesh);
    let middle = DVec2::splat(0.5);
    let inner = [(9, 9), (19, 9), (19, 19), (9, 19)].map(|(x, y)| {
        let from = at(x, y).truncate() - middle;
        (number(x, y), Pin::hard(middle + DVec2::from_angle(TAU / 4.0).rotate(from)))
    });
    let outer = [(0, 0), (cells, 0), (cells, cells), (0, cells)];
    let outer = outer.map(|(x, y)| (number(x, y), Pin::hard(at(x, y).truncate())));
    let pins: Pins = inner.into_iter().chain(outer).collect();
    let all = steps(&disk, Settings::default(), pins);
    let drawing = |step: &Step| Drawing::Plane(PlaneDrawing::of_step(&disk, step));
    let last = &all[all.len() - 1];
    pair(
        ("first linear solve", drawing(&all[0])),
        ("last step", drawing(last)),
        &format!("Four inner pins turned by a quarter; {}.", last.verdict.summary()),
    )
}

/// Drags the landmark on the tip of the chin, or the last one, around its target.
fn moving(face: &Face, path: &Path) -> Outcome {
    let settings = Settings::default();
    let step = last_of(&face.mesh, settings.clone(), face.pins.clone());
    let (&vertex, pin) = face.pins.iter().next_back().ok_or("the face has landmarks")?;
    let target = |pins: &Pins| DragTarget { pins: settings.held(pins), sheet: Arc::new(UvFrame::default()) };
    let start = step.candidate.solution.embedding.clone();
    let mut solver = DragSolver::new(&face.mesh, start, &[vertex], target(&face.pins)).ok_or("the map is planar")?;
    let mut frames = Vec::new();
    for frame in 0..FRAMES {
        let turn = TAU * frame as f64 / FRAMES as f64;
        let mut pins = face.pins.clone();
        let place = pin.target + RADIUS * (DVec2::from_angle(turn) - DVec2::X);
        pins.insert(vertex, Pin { target: place, ..*pin });
        let mut now = solver.drag(&face.mesh, &target(&pins), Control::unattended())?;
        while now.reached < 1.0 && now.obstacle.is_none() && !now.is_at_rest {
            now = solver.drag(&face.mesh, &target(&pins), Control::unattended())?;
        }
        let embedding = solver.embedding().clone();
        let drawing = PlaneDrawing {
            flipped: now.verdict.flipped_faces.clone(),
            pins: pins.keys().copied().collect(),
            ..PlaneDrawing::new(&face.mesh, embedding.clone())
        };
        let sheet = pair(
            ("the portrait follows", face.textured(&embedding)),
            ("a dragged pin", Drawing::Plane(drawing)),
            &format!("Frame {} of {FRAMES}; {}.", frame + 1, now.verdict.summary()),
        );
        frames.push(AnimationFrame { picture: sheet.page().picture(MOVING_SCALE), milliseconds: MILLISECONDS });
    }
    let size = [frames[0].picture.width, frames[0].picture.height];
    let form = AnimationForm { size, frame_count: u32::try_from(frames.len())? };
    write_animation(BufWriter::new(File::create(path)?), form, frames)?;
    println!("{:>9} bytes: {}", fs::metadata(path)?.len(), path.display());
    Ok(())
}
