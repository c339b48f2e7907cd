//! What a move of a dragged pin costs: `cargo bench --bench drag`.
//!
//! First a planar embedding that stays so, proved at every frame (see `live.rs`); then what follows where a method is linear, or
//! the screen shows no planar embedding. `cargo bench --bench drag -- live` and `-- linear` print one of the two;
//! further numbers are other sizes, in faces there and in vertices here. The constraints are hard but for every sixth, which pulls;
//! all are dragged once. "first move" is what passes until the embedding follows: base and column are solved for with
//! the factors of the run before. "move" is all that the session does for one further move, "arrays" what the window
//! makes of it for the graphics card, "bytes" what it uploads; the verdict comes in its own time. A frame at 60 a second
//! has 16.7 ms.

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

/// Vertices of the meshes.
const SIZES: [usize; 2] = [20_000, 100_000];

/// Constraints on each mesh.
const CONSTRAINTS: usize = 24;

/// Moves of each drag that are measured.
const MOVES: u32 = 3;

fn main() {
    print_machine();
    let wanted: Vec<usize> = arguments().iter().filter_map(|text| text.parse().ok()).collect();
    let is_wanted = |part: &str| {
        let mut named =
            arguments().into_iter().filter(|argument| ["live", "linear"].contains(&argument.as_str())).peekable();
        named.peek().is_none() || named.any(|argument| argument == part)
    };
    if is_wanted("live") {
        live::print(&wanted);
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

/// Polls until nothing goes on.
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
    // The flattener would iterate after every drag, which is not what is measured here.
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
