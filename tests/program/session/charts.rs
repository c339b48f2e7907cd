//! Session with a mesh of several charts: each is solved and keeps its steps and pins; all are laid out and proved.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::session::{Action, ChartState, LockState, SaveRequest, Session};
use freebound_core::geom::{PackingOptions, Rotations, Stacking, VAxis};
use freebound_core::mesh::{VertexId, parts};
use freebound_core::pipeline::{Fit, Outcome, Target, Targets};
use freebound_core::problem::{Method, Settings};
use freebound_core::verify::atlas_verdict;
use freebound_io::{Constraints, MeshFile, OutputKind, ProjectFile, Texture, read_mesh, write_obj};
use glam::DVec2;
use tempfile::TempDir;

use super::basics::{session, settle, settled};
use super::documents::errors;
use freebound_testkit::Random;
use freebound_testkit::many_parts::{disks, interleaved};

const PATIENCE: Duration = Duration::from_secs(90);

/// Five disks in one file, in a temporary folder.
pub(crate) fn with_disks() -> (TempDir, Session) {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(9);
    let parts = disks(&mut random);
    let mesh = MeshFile { polygons: interleaved(&parts, &mut random), ..MeshFile::default() };
    let path = folder.path().join("parts.obj");
    write_obj(&mut std::fs::File::create(&path).unwrap(), &mesh, &Texture::default()).unwrap();
    let mut session = session();
    settled(&mut session, Action::Open(path));
    until_laid_out(&mut session);
    (folder, session)
}

/// Polls until every chart is solved and all are laid out.
#[track_caller]
pub(crate) fn until_laid_out(session: &mut Session) {
    let start = Instant::now();
    settle(session);
    while session.atlas().is_none() {
        assert!(start.elapsed() < PATIENCE, "{session:?}: {:?}", session.messages());
        std::thread::sleep(Duration::from_millis(1));
        settle(session);
    }
}

fn solved(session: &Session, chart: usize) -> Arc<Outcome> {
    match session.chart_state(chart) {
        ChartState::Solved(outcome) => outcome,
        other => panic!("chart {chart}: {other:?}"),
    }
}

fn count(session: &Session) -> usize {
    session.charts().expect("several charts").count()
}

/// Pins the first vertices of the shown chart.
fn pin(session: &mut Session, at: DVec2) -> [VertexId; 2] {
    let vertices = [VertexId::new(0), VertexId::new(1)];
    for (vertex, by) in vertices.into_iter().zip([0.0, 0.25]) {
        settled(session, Action::Place { vertex, target: Target::hard(at + by) });
    }
    vertices
}

fn file(folder: &TempDir, name: &str) -> PathBuf {
    folder.path().join(name)
}

#[test]
fn every_chart_is_solved_and_the_largest_shows_first() {
    let (_folder, session) = with_disks();
    let charts = session.charts().expect("five disks");
    assert_eq!(charts.count(), 5);
    assert_eq!(session.chart_on_screen(), Some(charts.largest()));
    assert!(session.is_current());
    let atlas = session.atlas().expect("laid out");
    assert!(atlas.verdict.planar && atlas.verdict.planar_in_f32, "{}", atlas.verdict.summary());
    assert_eq!((atlas.outlines.len(), atlas.verdict.charts.len()), (5, 5));
    assert!(atlas.outlines.iter().flatten().all(|uv| uv.cmpge(DVec2::ZERO).all() && uv.cmple(DVec2::ONE).all()));
    for chart in 0..5 {
        assert!(solved(&session, chart).step.verdict.planar);
    }
}

#[test]
fn a_chart_that_comes_back_on_the_screen_has_its_steps_still() {
    let (_folder, mut session) = with_disks();
    let largest = session.chart_on_screen().expect("one of five");
    settled(&mut session, Action::Step);
    let (before, steps) = (solved(&session, largest), session.timeline().records().len());
    assert!(steps > 1);
    let other = (largest + 1) % 5;
    let of_other = solved(&session, other);
    let revision = session.outcome_revision();
    settled(&mut session, Action::ShowChart(other));
    assert_eq!(session.chart_on_screen(), Some(other));
    assert!(Arc::ptr_eq(session.outcome().expect("solved before"), &of_other));
    assert!(session.is_current() && session.outcome_revision() != revision);
    settled(&mut session, Action::Undo);
    assert_eq!(session.chart_on_screen(), Some(largest));
    assert!(Arc::ptr_eq(session.outcome().expect("solved before"), &before));
    assert_eq!(session.timeline().records().len(), steps);
}

#[test]
fn pins_belong_to_their_chart_and_undo_goes_where_they_are() {
    let (_folder, mut session) = with_disks();
    let (opening, opened_depth) = (session.document().clone(), session.history().depth());
    let first = session.chart_on_screen().expect("one of five");
    pin(&mut session, DVec2::splat(0.1));
    let second = (first + 1) % 5;
    settled(&mut session, Action::ShowChart(second));
    assert!(session.document().targets.is_empty());
    pin(&mut session, DVec2::splat(0.6));
    until_laid_out(&mut session);
    for (chart, at) in [(first, 0.1), (second, 0.6)] {
        let outcome = solved(&session, chart);
        assert_eq!(outcome.problem.targets[&VertexId::new(0)].uv, DVec2::splat(at));
        assert!(outcome.step.unmet().is_empty());
    }
    let last = session.document().clone();
    for _ in 0..2 {
        settled(&mut session, Action::Undo);
    }
    assert_eq!((session.chart_on_screen(), session.document().targets.len()), (Some(second), 0));
    for _ in 0..2 {
        settled(&mut session, Action::Undo);
    }
    assert_eq!((session.chart_on_screen(), session.document().targets.len()), (Some(first), 1));
    settled(&mut session, Action::Undo);
    assert_eq!(session.document().targets, opening.targets);
    assert!(session.document().elsewhere.is_empty());
    assert_eq!(session.history().depth(), opened_depth);
    for _ in 0..5 {
        settled(&mut session, Action::Redo);
    }
    assert_eq!(*session.document(), last);
    until_laid_out(&mut session);
}

#[test]
fn another_method_is_for_all_charts() {
    let (_folder, mut session) = with_disks();
    let settings = Settings { method: Method::Lscm, ..session.document().settings.clone() };
    settled(&mut session, Action::SetSettings(settings));
    until_laid_out(&mut session);
    for chart in 0..count(&session) {
        assert_eq!(solved(&session, chart).problem.settings.method, Method::Lscm, "chart {chart}");
    }
}

#[test]
fn a_project_brings_chart_pins_and_packing_back() {
    let (folder, mut session) = with_disks();
    let first = session.chart_on_screen().expect("one of five");
    pin(&mut session, DVec2::splat(0.1));
    let second = (first + 2) % 5;
    settled(&mut session, Action::ShowChart(second));
    pin(&mut session, DVec2::splat(0.6));
    settled(
        &mut session,
        Action::SetPacking(PackingOptions {
            picture: [512, 256],
            gap: 7,
            rotations: Rotations::Quarter,
            ..PackingOptions::default()
        }),
    );
    settled(&mut session, Action::SetChartSize { chart: (first + 1) % 5, size: 2.5 });
    let path = file(&folder, "work.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let of_file = ProjectFile::read(&path).unwrap();
    let charts = session.charts().unwrap();
    for (chart, at) in [(first, 0.1), (second, 0.6)] {
        let vertex = charts.chart(chart).vertex_of[0];
        assert_eq!(of_file.pins.targets[&vertex].uv, DVec2::splat(at), "pins have the file's numbers");
    }
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    assert!(again.messages().is_empty(), "{:?}", again.messages());
    assert_eq!(again.document(), session.document());
    until_laid_out(&mut again);
    until_laid_out(&mut session);
    for chart in 0..5 {
        assert_eq!(
            solved(&again, chart).step.candidate.solution.embedding,
            solved(&session, chart).step.candidate.solution.embedding
        );
    }
}

#[test]
fn a_chart_gets_more_of_the_picture_without_being_solved_again() {
    let (_folder, mut session) = with_disks();
    until_laid_out(&mut session);
    let densities = |session: &Session| session.atlas().unwrap().densities.clone();
    let before = densities(&session);
    let steps: Vec<_> = (0..5).map(|chart| solved(&session, chart)).collect();
    settled(&mut session, Action::SetChartSize { chart: 3, size: 2.0 });
    until_laid_out(&mut session);
    let after = densities(&session);
    for chart in 0..5 {
        let ratio = after[chart] / after[0];
        let expected = before[chart] / before[0] * if chart == 3 { 2.0 } else { 1.0 };
        assert!((ratio / expected - 1.0).abs() < 1e-9, "chart {chart}: {ratio} {expected}");
        assert!(Arc::ptr_eq(&steps[chart], &solved(&session, chart)));
    }
    settled(&mut session, Action::Undo);
    until_laid_out(&mut session);
    assert_eq!(densities(&session), before);
    for refused in [0.0, -1.0, f64::NAN, 1e9] {
        settled(&mut session, Action::SetChartSize { chart: 3, size: refused });
    }
    settled(&mut session, Action::SetChartSize { chart: 5, size: 2.0 });
    assert_eq!(session.sizes(), vec![1.0; 5]);
}

/// Sets packing options and waits for the layout.
fn pack(session: &mut Session, options: PackingOptions) {
    settled(session, Action::SetPacking(options));
    until_laid_out(session);
}

#[test]
fn stacking_density_and_tiles_are_edits_that_a_project_brings_back() {
    let (folder, mut session) = with_disks();
    let opening = session.packing();
    let found = session.atlas().unwrap().packing.expect("packed").density;
    let options = PackingOptions {
        stack: Stacking::Mirrored,
        density: Some(1.25 * found),
        tiles: 9,
        ..PackingOptions::default()
    };
    pack(&mut session, options);
    let packing = session.atlas().unwrap().packing.expect("packed");
    assert!((packing.density / (1.25 * found) - 1.0).abs() < 1e-12, "{packing:?}");
    assert!(packing.tiles > 1 && packing.picture == opening.picture, "{packing:?}");
    assert!(session.atlas().unwrap().tiles.iter().flatten().any(|&tile| tile > 1001));
    let path = file(&folder, "tiles.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    assert_eq!(again.packing(), options);
    until_laid_out(&mut again);
    assert_eq!(again.atlas().unwrap().coordinates, session.atlas().unwrap().coordinates);
    settled(&mut session, Action::Undo);
    assert_eq!(session.packing(), opening);
    settled(&mut session, Action::Redo);
    assert_eq!(session.packing(), options);
}

#[test]
fn a_locked_chart_stays_while_others_are_packed_around_it() {
    for picture in [[1024, 1024], [1024, 512]] {
        let (folder, mut session) = with_disks();
        pack(&mut session, PackingOptions { picture, ..PackingOptions::default() });
        let before = session.atlas().unwrap().coordinates[2].clone();
        assert_eq!(session.lock_state(2), LockState::Open);
        settled(&mut session, Action::LockCharts { charts: [2].into(), lock: true });
        assert_eq!(session.lock_state(2), LockState::Locked);
        until_laid_out(&mut session);
        let lain = session.atlas().unwrap().coordinates.clone();
        pack(&mut session, PackingOptions { picture, gap: 20, ..PackingOptions::default() });
        assert_eq!(session.atlas().unwrap().coordinates, lain, "nothing moves until it is packed");
        settled(&mut session, Action::PackCharts(None));
        until_laid_out(&mut session);
        let atlas = session.atlas().unwrap();
        assert_eq!(atlas.coordinates[2], before, "bit for bit");
        assert_ne!(atlas.coordinates, lain);
        assert!(atlas.verdict.planar, "{}", atlas.verdict.summary());
        let path = file(&folder, "locked.freebound");
        settled(&mut session, Action::SaveProject(path.clone()));
        let mut again = super::basics::session();
        settled(&mut again, Action::Open(path));
        assert_eq!(again.document(), session.document());
        until_laid_out(&mut again);
        assert_eq!(again.atlas().unwrap().coordinates, session.atlas().unwrap().coordinates);
        for _ in 0..3 {
            settled(&mut session, Action::Undo);
        }
        until_laid_out(&mut session);
        assert_eq!(session.lock_state(2), LockState::Open);
        settled(&mut session, Action::Redo);
        assert_eq!(session.lock_state(2), LockState::Locked);
        settled(&mut session, Action::LockCharts { charts: [2].into(), lock: false });
        until_laid_out(&mut session);
        assert_eq!(session.lock_state(2), LockState::Open);
        settled(&mut session, Action::LockCharts { charts: [5].into(), lock: true });
        assert!(session.document().layout.locked.is_empty());
    }
}

#[test]
fn a_chart_with_pins_cannot_be_locked_and_turned_faces_unlock_charts() {
    let (_folder, mut session) = with_disks();
    let shown = session.chart_on_screen().expect("one of five");
    let other = (shown + 1) % 5;
    settled(&mut session, Action::LockCharts { charts: [other].into(), lock: true });
    pin(&mut session, DVec2::splat(0.1));
    until_laid_out(&mut session);
    assert_eq!(session.lock_state(shown), LockState::Pinned);
    settled(&mut session, Action::LockCharts { charts: [shown].into(), lock: true });
    assert_eq!(session.document().layout.locked.len(), 1);
    settled(&mut session, Action::TurnFaces);
    assert!(session.document().layout.locked.is_empty());
    settled(&mut session, Action::Undo);
    assert_eq!(session.lock_state(other), LockState::Locked);
    until_laid_out(&mut session);
}

#[test]
fn constraints_go_to_their_charts_and_come_back_in_the_numbers_of_the_file() {
    let (folder, mut session) = with_disks();
    let charts = Arc::clone(session.charts().unwrap());
    let of = |chart: usize, place: usize| charts.chart(chart).vertex_of[place].number();
    let lines: Vec<String> =
        (0..4).map(|chart| format!("{} 0.{chart} 0.5\n{} 0.{chart}5 0.75\n", of(chart, 0), of(chart, 2))).collect();
    let [path, out] = ["in.txt", "out.txt"].map(|name| file(&folder, name));
    std::fs::write(&path, lines.concat()).unwrap();
    settled(&mut session, Action::ImportConstraints(path.clone()));
    settled(&mut session, Action::ExportConstraints(out.clone()));
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
    let count = charts.whole().polygons().positions.len();
    let [before, after] = [path, out].map(|path| Constraints::read(&path, count).unwrap().targets);
    assert_eq!((before.len(), &before), (8, &after));
    until_laid_out(&mut session);
    settled(&mut session, Action::Undo);
    assert!(session.document().targets.is_empty() && session.document().elsewhere.is_empty());
}

#[test]
fn all_charts_are_written_together_and_proved() {
    let (folder, mut session) = with_disks();
    for (name, kind) in [("all.obj", OutputKind::Obj), ("all.ply", OutputKind::Ply), ("all.svg", OutputKind::Svg)] {
        let path = file(&folder, name);
        settled(&mut session, Action::Save(SaveRequest { path: path.clone(), kind, fit: Fit::Unit }));
        assert!(errors(&session).is_empty(), "{:?}", session.messages());
        if kind == OutputKind::Svg {
            let drawing = std::fs::read_to_string(&path).unwrap();
            assert_eq!(drawing.matches(r#"class="boundary""#).count(), 5);
        } else {
            let texture = read_mesh(&path).unwrap().texture_mesh().unwrap();
            let charts = parts(&texture.mesh).unwrap();
            let verdict = atlas_verdict(&charts, &texture.embedding);
            assert!(verdict.planar && charts.len() == 5, "{}", verdict.summary());
        }
    }
}

#[test]
fn nothing_is_written_while_charts_have_no_embedding() {
    let (folder, mut session) = with_disks();
    let settings = Settings { method: Method::Lscm, ..session.document().settings.clone() };
    session.handle(Action::SetSettings(settings));
    let path = file(&folder, "early.obj");
    session.handle(Action::Save(SaveRequest { path: path.clone(), kind: OutputKind::Obj, fit: Fit::Unit }));
    assert!(!errors(&session).is_empty() && !path.exists());
    until_laid_out(&mut session);
}

#[test]
fn turned_faces_keep_each_chart_s_pins() {
    let (_folder, mut session) = with_disks();
    let first = session.chart_on_screen().expect("one of five");
    pin(&mut session, DVec2::splat(0.1));
    settled(&mut session, Action::ShowChart((first + 1) % 5));
    settled(&mut session, Action::TurnFaces);
    settled(&mut session, Action::ShowChart(first));
    assert_eq!(session.document().targets[&VertexId::new(0)].uv, DVec2::splat(0.1));
    assert!(session.is_current());
    until_laid_out(&mut session);
}

#[test]
fn a_walk_among_charts_and_back_ends_where_it_began() {
    let (_folder, mut session) = with_disks();
    let opening = session.document().clone();
    let mut random = Random(77);
    for _ in 0..120 {
        let vertex = VertexId::new(random.below(2));
        let at = DVec2::new(random.unit(), random.unit());
        session.handle(match random.below(9) {
            0..3 => Action::ShowChart(random.index(6)),
            3 | 4 => Action::Place { vertex, target: Target::hard(at) },
            5 => Action::Undo,
            6 => Action::Redo,
            7 => Action::Unpin(vec![vertex]),
            _ => Action::Step,
        });
        if random.below(3) == 0 {
            settle(&mut session);
            assert_eq!(session.chart_on_screen(), Some(session.charts().unwrap().pick(session.document().chart)));
        } else {
            session.poll();
        }
    }
    until_laid_out(&mut session);
    let last = session.document().clone();
    while session.history().can_undo() {
        session.handle(Action::Undo);
    }
    settle(&mut session);
    assert_eq!((&session.document().targets, &session.document().elsewhere), (&opening.targets, &opening.elsewhere));
    while session.history().can_redo() {
        session.handle(Action::Redo);
    }
    settle(&mut session);
    assert_eq!(*session.document(), last);
    until_laid_out(&mut session);
}

#[test]
fn a_chart_shown_in_the_middle_of_another_method_is_solved_by_it() {
    let (_folder, mut session) = with_disks();
    for method in [Method::Lscm, Method::Natural, Method::Lscm] {
        let settings = Settings { method, ..session.document().settings.clone() };
        session.handle(Action::SetSettings(settings));
        session.poll();
        let next = (session.chart_on_screen().expect("one of five") + 1) % 5;
        session.handle(Action::ShowChart(next));
        session.poll();
    }
    until_laid_out(&mut session);
    for chart in 0..5 {
        assert_eq!(solved(&session, chart).problem.settings.method, Method::Lscm, "chart {chart}");
    }
}

#[test]
fn a_chart_asked_for_before_it_is_there_comes_and_pins_never_go_to_another() {
    let (folder, _) = with_disks();
    let mut session = session();
    session.handle(Action::Open(file(&folder, "parts.obj")));
    while session.chart_on_screen().is_none() {
        session.poll();
    }
    let first = session.chart_on_screen().expect("one of five");
    let next = (first + 3) % 5;
    session.handle(Action::ShowChart(next));
    // The pin belongs to the chart that is now shown, whichever it is.
    let shown = session.chart_on_screen().expect("one of five");
    session.handle(Action::Place { vertex: VertexId::new(2), target: Target::hard(DVec2::splat(0.5)) });
    until_laid_out(&mut session);
    assert_eq!(session.chart_on_screen(), Some(next));
    let pinned: Vec<usize> = (0..5).filter(|&chart| !solved(&session, chart).problem.targets.is_empty()).collect();
    assert_eq!(pinned, [shown]);
}

#[test]
fn a_look_at_another_chart_that_is_taken_back_is_no_change() {
    let (_folder, mut session) = with_disks();
    let opening = session.document().clone();
    let other = (session.chart_on_screen().expect("one of five") + 1) % 5;
    settled(&mut session, Action::ShowChart(other));
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), opening);
}

#[test]
fn pins_of_all_charts_keep_their_places_where_v_runs_the_other_way() {
    let (_folder, mut session) = with_disks();
    let first = session.chart_on_screen().expect("one of five");
    pin(&mut session, DVec2::new(0.1, 0.2));
    settled(&mut session, Action::ShowChart((first + 1) % 5));
    pin(&mut session, DVec2::new(0.6, 0.3));
    let before = session.document().clone();
    settled(&mut session, Action::SetVAxis(VAxis::Down));
    let v = |targets: &Targets| targets[&VertexId::new(0)].uv.y;
    assert_eq!(v(&session.document().targets), 1.0 - 0.3);
    assert_eq!(v(&session.document().elsewhere[&first].targets), 1.0 - 0.2);
    settled(&mut session, Action::SetVAxis(VAxis::Up));
    assert_eq!(*session.document(), before);
    until_laid_out(&mut session);
}
