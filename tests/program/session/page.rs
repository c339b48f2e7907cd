//! Page of a session: charts are moved, packed, stacked and locked, and every frame of a move is judged.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::session::{Action, ChartPage, LockState, Session};
use freebound_core::geom::{Bounds, PackingOptions};
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_core::pipeline::StackedOn;
use freebound_core::problem::Embedding;
use freebound_testkit::{shaped, sheet, write_obj};
use glam::{DAffine2, DVec2, DVec3};
use tempfile::TempDir;

use super::basics::{session, settle, settled};
use super::documents::errors;

const PATIENCE: Duration = Duration::from_secs(90);

/// Session with a bulging sheet, a sheet without a symmetry, and the mirror image of that sheet.
fn with_sheets() -> (TempDir, Session) {
    let chiral = shaped(4, 3, |x, y| DVec3::new(x + 0.1 * y * y, y, 0.05 * x * x * y));
    let mut mirrored = chiral.clone();
    mirrored.positions.iter_mut().for_each(|position| position.x = 20.0 - position.x);
    mirrored.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let mut whole = TriMesh::default();
    for part in [sheet(6, 0.3), chiral, mirrored] {
        let offset = whole.positions.len();
        let aside = 7.0 * offset as f64 * DVec3::Y;
        whole.positions.extend(part.positions.iter().map(|&at| at + aside));
        let moved = |vertex: VertexId| VertexId::from_index(offset + vertex.index());
        whole.triangles.extend(part.triangles.iter().map(|corners| corners.map(moved)));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sheets.obj");
    write_obj(&path, &whole);
    let mut session = session();
    settled(&mut session, Action::Open(path));
    until_proved(&mut session);
    (folder, session)
}

/// Polls until the page shows the document, moves have ended, and the layout is judged.
#[track_caller]
fn until_proved(session: &mut Session) {
    let start = Instant::now();
    settle(session);
    while session.atlas().is_none()
        || session.is_judging_move()
        || !session.can_move_charts()
        || session.page().is_none_or(|page| page.is_planar.is_none())
    {
        assert!(start.elapsed() < PATIENCE, "{session:?}: {:?}", session.messages());
        std::thread::sleep(Duration::from_millis(1));
        settle(session);
    }
}

fn page(session: &Session) -> &ChartPage {
    session.page().expect("all charts are solved")
}

fn coordinates(session: &Session) -> Vec<Arc<Embedding>> {
    page(session).charts.iter().map(|chart| Arc::clone(&chart.coordinates)).collect()
}

/// Moves charts in one gesture, and waits for the proof.
fn moved(session: &mut Session, moves: &[(usize, DAffine2)], insists: bool) {
    session.handle(Action::MoveCharts { moves: moves.to_vec(), insists });
    session.handle(Action::EndMove);
    until_proved(session);
}

const fn shift(x: f64, y: f64) -> DAffine2 {
    DAffine2 { matrix2: glam::DMat2::IDENTITY, translation: DVec2::new(x, y) }
}

/// Movement of chart `from` to the middle of chart `to`.
fn onto(session: &Session, from: usize, to: usize) -> DAffine2 {
    DAffine2::from_translation(page(session).bounds_of(to).middle() - page(session).bounds_of(from).middle())
}

fn are_near(a: &Embedding, b: &Embedding) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.distance(*b) < 1e-12)
}

#[test]
fn a_moved_chart_lies_where_it_was_put_and_the_others_stay_bit_for_bit() {
    let (_folder, mut session) = with_sheets();
    let before = coordinates(&session);
    let solved = session.outcome().cloned().unwrap();
    moved(&mut session, &[(1, shift(2.0, 0.5))], false);
    let after = coordinates(&session);
    let expected: Embedding = before[1].iter().map(|uv| *uv + DVec2::new(2.0, 0.5)).collect();
    assert!(are_near(&after[1], &expected));
    assert_eq!([&after[0], &after[2]], [&before[0], &before[2]]);
    let atlas = session.atlas().unwrap();
    assert!(atlas.verdict.planar && page(&session).is_planar == Some(true));
    assert_eq!(atlas.coordinates, after, "files get what the page shows");
    assert!(Arc::ptr_eq(&solved, session.outcome().unwrap()), "nothing is solved again");
    settled(&mut session, Action::Undo);
    until_proved(&mut session);
    assert_eq!(coordinates(&session), before);
    settled(&mut session, Action::Redo);
    until_proved(&mut session);
    assert_eq!(coordinates(&session), after);
}

#[test]
fn many_frames_of_a_gesture_are_one_edit_and_a_dropped_gesture_is_none() {
    let (_folder, mut session) = with_sheets();
    let depth = session.history().depth();
    for frame in 1..20 {
        session.handle(Action::MoveCharts { moves: vec![(0, shift(0.1 * f64::from(frame), 2.0))], insists: false });
        session.poll();
    }
    assert!(session.is_moving_charts());
    session.handle(Action::EndMove);
    until_proved(&mut session);
    assert_eq!(session.history().depth(), depth + 1);
    assert!(!session.is_moving_charts());
    let low = page(&session).bounds_of(0).low;
    assert!(low.x > 1.8 && low.y > 1.9, "the last frame counts: {low}");
    session.handle(Action::MoveCharts { moves: vec![(0, shift(5.0, 5.0))], insists: false });
    session.handle(Action::GiveUpMove);
    until_proved(&mut session);
    assert_eq!((session.history().depth(), page(&session).bounds_of(0).low), (depth + 1, low));
}

#[test]
fn charts_come_to_overlap_only_if_the_user_insists() {
    let (_folder, mut session) = with_sheets();
    let (before, depth) = (coordinates(&session), session.history().depth());
    let over = onto(&session, 0, 1);
    moved(&mut session, &[(0, over)], false);
    assert_eq!((coordinates(&session), session.history().depth()), (before, depth));
    assert_eq!(session.messages().len(), 1, "the charts in the way are named: {:?}", session.messages());
    moved(&mut session, &[(0, over)], true);
    assert_eq!(page(&session).is_planar, Some(false));
    let atlas = session.atlas().unwrap();
    assert!(!atlas.verdict.planar && !atlas.verdict.overlapping_faces.is_empty());
    settled(&mut session, Action::PackCharts(None));
    until_proved(&mut session);
    assert!(session.atlas().unwrap().verdict.planar);
}

#[test]
fn a_move_that_is_kept_back_ends_at_its_last_free_place() {
    let (_folder, mut session) = with_sheets();
    let aside = shift(3.0, 0.0);
    session.handle(Action::MoveCharts { moves: vec![(0, aside)], insists: false });
    let start = Instant::now();
    while session.move_state().is_none_or(|state| state.accepted.is_none()) {
        assert!(start.elapsed() < PATIENCE);
        session.poll();
    }
    let over = onto(&session, 0, 1);
    let before = page(&session).bounds_of(0).low;
    moved(&mut session, &[(0, over)], false);
    assert!((page(&session).bounds_of(0).low - before - DVec2::new(3.0, 0.0)).length() < 1e-12);
}

#[test]
fn a_turned_scaled_and_mirrored_chart_keeps_its_shape_and_its_size_counts_when_it_is_packed() {
    let (_folder, mut session) = with_sheets();
    let density = |session: &Session| session.atlas().unwrap().densities[1];
    let (before, energy) = (density(&session), solved_energy(&session));
    let turn = DAffine2::from_angle(0.7) * DAffine2::from_scale(DVec2::new(-0.5, 0.5));
    moved(&mut session, &[(1, shift(4.0, 0.0) * turn)], false);
    assert!((density(&session) / before - 0.5).abs() < 1e-9);
    assert_eq!(solved_energy(&session).to_bits(), energy.to_bits());
    assert!(session.atlas().unwrap().verdict.planar);
    let mirrored = &session.atlas().unwrap().verdict.charts[1];
    assert!(mirrored.mirrored && mirrored.planar);
    assert!((session.sizes()[1] - 0.5).abs() < 1e-12);
    settled(&mut session, Action::PackCharts(None));
    until_proved(&mut session);
    let densities = session.atlas().unwrap().densities.clone();
    assert!((densities[1] / densities[0] - 0.5).abs() < 1e-9);
}

fn solved_energy(session: &Session) -> f64 {
    session.outcome().unwrap().distortion.summary.symmetric_dirichlet.mean
}

#[test]
fn mirrored_charts_are_stacked_moved_together_and_unstacked() {
    let (_folder, mut session) = with_sheets();
    settled(&mut session, Action::StackCharts(BTreeSet::from([1, 2])));
    until_proved(&mut session);
    let on_first = Some(StackedOn { chart: 1, mirrored: true });
    assert_eq!(page(&session).charts.iter().map(|chart| chart.stacked).collect::<Vec<_>>(), [None, None, on_first]);
    assert_eq!(session.lock_state(2), LockState::Stacked);
    // Moving either moves both.
    let before = page(&session).bounds_of(1);
    moved(&mut session, &[(2, shift(2.0, 1.0))], false);
    let [first, second] = [1, 2].map(|chart| page(&session).bounds_of(chart));
    assert_eq!(first, second);
    assert!((first.low - before.low - DVec2::new(2.0, 1.0)).length() < 1e-12);
    assert!(session.atlas().unwrap().verdict.planar && session.atlas().unwrap().verdict.stacks == 1);
    settled(&mut session, Action::PackCharts(None));
    until_proved(&mut session);
    assert_eq!(page(&session).charts[2].stacked, on_first, "a stack is packed as one");
    settled(&mut session, Action::UnstackCharts(BTreeSet::from([2])));
    until_proved(&mut session);
    assert_eq!(page(&session).charts[2].stacked, None);
    assert!(session.atlas().unwrap().verdict.planar);
}

#[test]
fn charts_that_are_not_congruent_are_named_and_stay() {
    let (_folder, mut session) = with_sheets();
    let before = coordinates(&session);
    settled(&mut session, Action::StackCharts(BTreeSet::from([0, 1])));
    until_proved(&mut session);
    assert_eq!(coordinates(&session), before);
    assert_eq!(errors(&session).len(), 1);
}

#[test]
fn locked_charts_stay_while_a_selection_is_packed_around_all_others() {
    let (_folder, mut session) = with_sheets();
    moved(&mut session, &[(0, shift(0.0, 3.0)), (1, shift(3.0, 0.0))], false);
    settled(&mut session, Action::LockCharts { charts: BTreeSet::from([0]), lock: true });
    until_proved(&mut session);
    let before = coordinates(&session);
    moved(&mut session, &[(0, shift(1.0, 0.0))], false);
    assert_eq!(coordinates(&session)[0], before[0], "a locked chart cannot be moved");
    settled(&mut session, Action::PackCharts(Some(BTreeSet::from([1]))));
    until_proved(&mut session);
    let after = coordinates(&session);
    assert_eq!([&after[0], &after[2]], [&before[0], &before[2]]);
    assert_ne!(after[1], before[1]);
    assert!(session.atlas().unwrap().verdict.planar);
}

#[test]
fn a_project_brings_back_places_stacks_and_sizes_bit_for_bit() {
    let (folder, mut session) = with_sheets();
    settled(&mut session, Action::StackCharts(BTreeSet::from([1, 2])));
    until_proved(&mut session);
    moved(
        &mut session,
        &[(1, shift(0.3, 4.0) * DAffine2::from_angle(0.3) * DAffine2::from_scale(DVec2::splat(0.7)))],
        false,
    );
    let path = folder.path().join("placed.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    until_proved(&mut again);
    assert_eq!(again.document(), session.document());
    assert_eq!(coordinates(&again), coordinates(&session));
    assert!(!again.has_unsaved_work());
}

#[test]
fn a_typed_size_scales_a_placed_chart_about_its_centre() {
    let (_folder, mut session) = with_sheets();
    moved(&mut session, &[(0, shift(5.0, 5.0))], false);
    let before = page(&session).bounds_of(0);
    settled(&mut session, Action::SetChartSize { chart: 0, size: 2.0 });
    until_proved(&mut session);
    let Bounds { low, high } = page(&session).bounds_of(0);
    assert!(((high - low) - 2.0 * before.size()).length() < 1e-9);
    assert!((low.midpoint(high) - before.middle()).length() < 1e-9);
    assert!((session.sizes()[0] - 2.0).abs() < 1e-12);
}

#[test]
fn a_move_that_the_document_has_overtaken_is_dropped() {
    let (_folder, mut session) = with_sheets();
    moved(&mut session, &[(1, shift(5.0, 0.0))], false);
    let (before, depth) = (coordinates(&session), session.history().depth());
    session.handle(Action::MoveCharts { moves: vec![(0, shift(3.0, 3.0))], insists: false });
    session.handle(Action::EndMove);
    session.handle(Action::Undo);
    until_proved(&mut session);
    // The move that had not ended was dropped, and the edit before it stays.
    assert_eq!((coordinates(&session), session.history().depth()), (before.clone(), depth));
    session.handle(Action::MoveCharts { moves: vec![(0, shift(3.0, 3.0))], insists: false });
    while session.is_judging_move() {
        session.poll();
    }
    session.handle(Action::PackCharts(None));
    session.poll();
    session.handle(Action::EndMove);
    until_proved(&mut session);
    assert!(!session.has_placed_charts(), "charts were packed, and the move began at other places");
}

#[test]
fn an_overlap_that_alt_allowed_ends_if_alt_is_released() {
    let (_folder, mut session) = with_sheets();
    let (before, over) = (coordinates(&session), onto(&session, 0, 1));
    for insists in [true, false] {
        session.handle(Action::MoveCharts { moves: vec![(0, over)], insists });
        while session.is_judging_move() {
            session.poll();
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    session.handle(Action::EndMove);
    until_proved(&mut session);
    assert_eq!((coordinates(&session), page(&session).is_planar), (before, Some(true)));
}

#[test]
fn a_page_keeps_its_shape_after_its_charts_are_placed() {
    let (folder, mut session) = with_sheets();
    let wide = PackingOptions { picture: [2048, 1024], ..PackingOptions::default() };
    settled(&mut session, Action::SetPacking(wide));
    until_proved(&mut session);
    assert!((page(&session).aspect - 2.0).abs() < 1e-12);
    let turned = shift(5.0, 0.0) * DAffine2::from_angle(1.0);
    moved(&mut session, &[(0, turned)], false);
    let after = coordinates(&session);
    assert!((page(&session).aspect - 2.0).abs() < 1e-12);
    let path = folder.path().join("wide.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    until_proved(&mut again);
    assert_eq!((coordinates(&again), page(&again).aspect), (after, 2.0));
    // A page of another shape is packed anew.
    settled(&mut session, Action::SetPacking(PackingOptions::default()));
    until_proved(&mut session);
    assert!(!session.has_placed_charts() && page(&session).is_planar == Some(true));
}

#[test]
fn requests_that_change_no_chart_are_no_edits_and_place_nothing() {
    let (_folder, mut session) = with_sheets();
    let depth = session.history().depth();
    for action in [
        Action::LockCharts { charts: BTreeSet::new(), lock: true },
        Action::LockCharts { charts: BTreeSet::from([0, 1]), lock: false },
        Action::StackCharts(BTreeSet::from([0])),
        Action::UnstackCharts(BTreeSet::from([0, 1, 2])),
        Action::PackCharts(None),
        Action::LockCharts { charts: BTreeSet::from([99]), lock: true },
    ] {
        settled(&mut session, action);
    }
    assert!(!session.has_placed_charts() && session.history().depth() == depth);
}

#[test]
fn requests_while_charts_are_being_cut_again_harm_nothing() {
    let (_folder, mut session) = with_sheets();
    moved(&mut session, &[(2, shift(5.0, 0.0))], false);
    // Without the first part the mesh has fewer charts, and the page of the former ones is still there.
    session.handle(Action::MoveCharts { moves: vec![(2, shift(9.0, 0.0))], insists: false });
    session.handle(Action::LeaveOut(BTreeSet::from([0])));
    for action in [
        Action::LockCharts { charts: BTreeSet::from([0, 1, 2]), lock: true },
        Action::PackCharts(Some(BTreeSet::from([2]))),
        Action::StackCharts(BTreeSet::from([1, 2])),
        Action::UnstackCharts(BTreeSet::from([1, 2])),
        Action::EndMove,
    ] {
        session.handle(action);
        session.poll();
    }
    until_proved(&mut session);
    assert_eq!(page(&session).charts.len(), 2);
    assert_eq!(page(&session).is_planar, Some(true));
}
