//! Automatic seams in a session: found once, undone, saved, and opened again with their map.

use freebound::session::{Action, MapOrigin, Message, MessagePlace, Session};
use freebound_core::mesh::{Seams, VertexId};
use freebound_core::problem::Embedding;
use freebound_testkit::{bumpy_ball, write_obj};
use tempfile::TempDir;

use super::basics::{session, settled};
use super::documents::errors;

/// Session with a closed ball, in a temporary folder.
fn with_ball() -> (TempDir, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ball.obj");
    write_obj(&path, &bumpy_ball().triangulate());
    let mut session = session();
    settled(&mut session, Action::Open(path));
    (folder, session)
}

fn seams(session: &Session) -> Seams {
    session.document().form.seams.clone()
}

fn embedding(session: &Session) -> Embedding {
    session.outcome().expect("solved").step.candidate.solution.embedding.clone()
}

#[test]
fn a_project_keeps_seams_paint_and_bound_and_opens_with_the_same_map() {
    let (folder, mut session) = with_ball();
    let edges: Vec<[VertexId; 2]> = seams(&session).automatic().iter().copied().take(5).collect();
    settled(&mut session, Action::PaintSeams { edges, cost: Seams::AVOIDED });
    settled(&mut session, Action::Unwrap(Some(4.3)));
    let project = folder.path().join("ball.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(project.clone()));
    assert_eq!(seams(&again), seams(&session));
    assert_eq!((seams(&again).costs().len(), seams(&again).bound()), (5, Some(4.3)));
    assert_eq!(embedding(&again), embedding(&session));
    let text = std::fs::read_to_string(&project).expect("written");
    let wrong = text.replace("\"cost\": 1000.0", "\"cost\": -1.0");
    assert_ne!(wrong, text);
    std::fs::write(&project, wrong).expect("written");
    let mut refused = super::basics::session();
    settled(&mut refused, Action::Open(project));
    assert!(refused.model().is_none() && errors(&refused).len() == 1);
}

#[test]
fn a_bound_that_was_found_before_needs_no_search() {
    let (_folder, mut session) = with_ball();
    let (first, map) = (seams(&session), embedding(&session));
    settled(&mut session, Action::Unwrap(Some(4.5)));
    assert_ne!(seams(&session), first);
    session.handle(Action::Unwrap(Some(4.1)));
    assert!(session.seam_search().is_none(), "it is known");
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::Undo);
    assert_eq!((seams(&session), embedding(&session)), (first, map));
}

#[test]
fn another_edit_of_the_preparation_ends_the_search() {
    let (_folder, mut session) = with_ball();
    let before = seams(&session);
    session.handle(Action::Unwrap(Some(4.01)));
    assert!(session.seam_search().is_some());
    settled(&mut session, Action::TurnFaces);
    assert!(session.document().form.faces_turned && seams(&session) == before);
    assert!(session.outcome().expect("solved").step.verdict.planar && session.is_current());
}

#[test]
fn undo_during_a_search_ends_it_and_undoes_nothing_else() {
    let (_folder, mut session) = with_ball();
    let before = seams(&session);
    session.handle(Action::Unwrap(Some(4.01)));
    settled(&mut session, Action::Undo);
    assert!(session.seam_search().is_none() && seams(&session) == before);
}

#[test]
fn paint_waits_for_the_search_and_outlives_a_preview() {
    let (_folder, mut session) = with_ball();
    let edges: Vec<[VertexId; 2]> = seams(&session).automatic().iter().copied().take(5).collect();
    session.handle(Action::PaintSeams { edges: edges.clone(), cost: Seams::AVOIDED });
    session.handle(Action::PreviewSeams(Some(4.3)));
    session.handle(Action::Unwrap(Some(4.3)));
    settled(&mut session, Action::PreviewSeams(None));
    assert_eq!((seams(&session).costs().len(), seams(&session).bound()), (5, Some(4.3)));
    assert!(edges.iter().all(|edge| !seams(&session).automatic().contains(edge)));
    settled(&mut session, Action::Undo);
    assert!(seams(&session).costs().is_empty());
}

#[test]
fn previews_do_not_make_the_mesh_forget_the_map_of_its_seams() {
    let (_folder, mut session) = with_ball();
    for step in 0..10 {
        settled(&mut session, Action::PreviewSeams(Some(4.2 + 0.1 * f64::from(step))));
    }
    assert!(session.automatic_seams().is_some());
    settled(&mut session, Action::PreviewSeams(None));
    assert!(session.seams_to_be().is_none());
}

#[test]
fn parts_that_touch_are_named_when_the_mesh_opens_and_stay_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("two.obj");
    let text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n";
    std::fs::write(&path, text).expect("written");
    let mut session = session();
    settled(&mut session, Action::Open(path));
    let prepared = &session.model().expect("opened").prepared;
    assert_eq!((prepared.chart_count(), prepared.touching_vertices), (2, 2));
    let of_mesh = |message: &&Message| message.place == MessagePlace::Mesh;
    assert_eq!(session.messages().iter().filter(of_mesh).count(), 1);
    assert!(errors(&session).is_empty());
}

#[test]
fn what_was_left_out_of_a_file_is_noted_until_another_mesh_is_opened() {
    let (folder, mut session) = with_ball();
    let of_mesh = |session: &Session| -> Vec<Message> {
        session.messages().iter().filter(|message| message.place == MessagePlace::Mesh).cloned().collect()
    };
    assert_eq!(of_mesh(&session), []);
    let (whole, part) = (folder.path().join("ball.obj"), folder.path().join("left-out.obj"));
    let text = std::fs::read_to_string(&whole).expect("written") + "f 1 2\nf 3 4\n";
    std::fs::write(&part, text).expect("written");
    settled(&mut session, Action::Open(part));
    assert!(matches!(session.map_origin(), Some(MapOrigin::AutomaticSeams(_))), "the search for seams has ended");
    let warning = session.model().expect("opened").source.warnings[0].clone();
    assert_eq!(of_mesh(&session).iter().map(|message| &message.text[..]).collect::<Vec<_>>(), [warning.to_string()]);
    settled(&mut session, Action::Open(whole));
    assert_eq!(of_mesh(&session), []);
}
