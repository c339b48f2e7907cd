//! Cost of one move of a dragged pin: `cargo bench --bench drag`.
//!
//! The first part drags pins of an embedding that stays planar, proved at every frame (see `live.rs`). The second
//! part shapes such an embedding with brushes (see `brushes.rs`). The third part is for linear methods, and for
//! screens that show no planar embedding. `cargo bench --bench drag -- live`, `-- brushes` and `-- linear` run one
//! part. Numbers set other sizes: vertices in `linear`, faces in the others.
//!
//! In `linear` the pins are hard, except that every sixth is soft; all are dragged once. "first move" is the time
//! until the embedding follows: base and column are solved with the factors of the run before. "move" is all work of
//! the session for one further move. "arrays" is the window's work on arrays for the graphics card, and "bytes" is
//! the size of the upload. The verdict is computed separately. A frame at 60 frames per second has 16.7 ms.

mod brushes;
#[path = "../common/mod.rs"]
mod common;
mod live;

use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::session::{Action, RecentFiles, Session};
use freebound::view::{PlaneArrays, UnitPlane, bounds_of};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Method, PinKind, Settings};
use freebound_core::verify::verdict;
use freebound_io::{MeshFile, Texture, write_obj};
use glam::DVec2;

use common::machine::print_machine;
use common::table::{Table, seconds};
use common::{Times, arguments};
use freebound_testkit::sheet_of_faces;

/// Vertex counts of the meshes.
const SIZES: [usize; 2] = [20_000, 100_000];

/// Constraints on each mesh.
const CONSTRAINTS: usize = 24;

/// Measured moves of each drag.
const MOVES: u32 = 3;

fn main() {
    print_machine();
    let wanted: Vec<usize> = arguments().iter().filter_map(|text| text.parse().ok()).collect();
    let is_wanted = |part: &str| {
        let mut named = arguments()
            .into_iter()
            .filter(|argument| ["live", "brushes", "linear"].contains(&argument.as_str()))
            .peekable();
        named.peek().is_none() || named.any(|argument| argument == part)
    };
    if is_wanted("live") {
        live::print(&wanted);
    }
    if is_wanted("brushes") {
        brushes::print(&wanted);
    }
    if is_wanted("linear") {
        print_linear(&wanted);
    }
}

fn print_linear(wanted: &[usize]) {
    let sizes = if wanted.is_empty() { &SIZES } else { wanted };
    let heads = ["vertices", "first move", "move", "arrays", "bytes", "verdict", "moves a second"];
    let title = format!("dragging one of {CONSTRAINTS} constraints, seconds");
    let mut table = Table::new(&title, &heads);
    for &vertices in sizes {
        table.row(drag(vertices));
    }
    table.print();
}

/// Polls until the session is idle.
fn settle(session: &mut Session) {
    while session.busy().is_some() || session.is_following() {
        session.poll();
        std::thread::sleep(Duration::from_micros(200));
    }
}

fn opened(vertices: usize) -> Session {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.obj");
    let mut text = Vec::new();
    write_obj(&mut text, &MeshFile::from(&sheet_of_faces(2 * vertices)), &Texture::default()).expect("memory takes it");
    std::fs::write(&path, text).expect("a file");
    let mut session = Session::new(Arc::new(|| ()), RecentFiles::default());
    session.handle(Action::Open(path));
    settle(&mut session);
    session
}

fn drag(vertices: usize) -> [String; 7] {
    let mut session = opened(vertices);
    // The automatic strategy would iterate after every drag, which this benchmark does not measure.
    session.handle(Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    settle(&mut session);
    let mesh = Arc::clone(session.model().and_then(|model| model.disk()).expect("the sheet is a disk"));
    let flat = session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    let extent = bounds_of(&flat).extent();
    for k in 0..CONSTRAINTS {
        let vertex = VertexId::from_index((2 * k + 1) * mesh.vertex_count() / (2 * CONSTRAINTS));
        let kind = if k % 6 == 5 { PinKind::Soft(10.0) } else { PinKind::Hard };
        let target = flat[vertex.index()] + DVec2::from_angle(k as f64) * (0.01 * extent);
        session.handle(Action::Place { vertex, target: Target { uv: target, kind } });
    }
    settle(&mut session);
    let (mut first, mut move_, mut arrays, mut proof) =
        (Times::default(), Times::default(), Times::default(), Times::default());
    let mut bytes = 0;
    let pins: Vec<(VertexId, DVec2)> = session.document().targets.iter().map(|(&v, target)| (v, target.uv)).collect();
    for (vertex, from) in pins {
        let begin = Instant::now();
        session.handle(Action::MovePin { vertex, target: from + DVec2::X * (1e-4 * extent) });
        while session.preview().is_none() {
            session.poll();
            std::thread::sleep(Duration::from_micros(50));
        }
        first.add(begin.elapsed().as_secs_f64());
        let frame = UnitPlane::of(bounds_of(&flat));
        for k in 0..MOVES {
            let target = from + DVec2::new(f64::from(k), 1.0) * (1e-4 * extent);
            move_.run(|| session.handle(Action::MovePin { vertex, target }));
            let preview = session.preview().expect("it follows").embedding.clone();
            let drawn = arrays.run(|| PlaneArrays::in_frame(&preview, &mesh.mesh().triangles, frame));
            bytes = size_of_val(&*drawn.points) + size_of_val(&*drawn.corners);
            proof.run(|| verdict(&mesh, &preview));
        }
        session.handle(Action::GiveUpGesture);
        settle(&mut session);
    }
    [
        mesh.vertex_count().to_string(),
        seconds(first.median()),
        seconds(move_.median()),
        seconds(arrays.median()),
        bytes.to_string(),
        seconds(proof.median()),
        format!("{:.0}", 1.0 / (move_.median() + arrays.median())),
    ]
}
