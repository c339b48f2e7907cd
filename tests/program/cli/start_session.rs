//! Session that starts from the layout of a file, and then without it.

use freebound::session::{Action, Session};
use freebound_core::mesh::PolygonMesh;
use freebound_core::problem::{Embedding, Family, Method, Settings, Start};
use glam::DVec2;

use super::program::textured_text;
use crate::session::basics::{session, settle, settled};
use crate::session::constraints::place;
use freebound_testkit::surfaces::bump;

/// Session with a bumpy sheet and its layout; four corners are pinned a little off the layout.
fn with_sheet(method: Method, start: Start) -> Session {
    let mesh = bump(6);
    let layout: Vec<DVec2> = mesh.positions.iter().map(|p| DVec2::new(0.1 * p.x + 0.05 * p.y, 0.03 * p.y)).collect();
    let polygons = PolygonMesh::from(&mesh);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.obj");
    let text = textured_text(&polygons, &layout, |face, k| [polygons.face(face)[k].index(); 2]);
    std::fs::write(&path, text).expect("a folder to write to");
    let mut session = session();
    settled(&mut session, Action::Open(path));
    let pins = [0, 6, 42, 48].map(|v| (v, layout[v as usize] + DVec2::new(0.01 * f64::from(v % 4), 0.02)));
    place(&mut session, &pins);
    choose(&mut session, method, start);
    session
}

fn choose(session: &mut Session, method: Method, start: Start) {
    settled(session, Action::SetSettings(Settings { start, ..Settings::new(method, Family::Conformal) }));
    settle(session);
}

fn embedding(session: &Session) -> Embedding {
    let outcome = session.outcome().expect("solved");
    assert!(outcome.step.verdict.planar && outcome.step.unmet().is_empty());
    outcome.step.candidate.solution.embedding.clone()
}

#[test]
fn constraints_are_met_from_the_layout_or_from_the_surface_whatever_was_before() {
    for method in [Method::Continuation, Method::Matchmaker] {
        let [from_scratch, from_layout] =
            [Start::FromScratch, Start::File].map(|start| embedding(&with_sheet(method.clone(), start)));
        assert!(from_scratch != from_layout, "{method:?}: the starts differ");
        for starts in [[Start::FromScratch, Start::File], [Start::File, Start::FromScratch]] {
            let mut session = with_sheet(method.clone(), starts[0]);
            for start in [starts[1], starts[0], starts[1]] {
                choose(&mut session, method.clone(), start);
                let expected = if start == Start::File { &from_layout } else { &from_scratch };
                assert!(embedding(&session) == *expected, "to the last bit, {method:?} {start:?}");
            }
        }
    }
}
