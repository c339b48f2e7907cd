//! Virtual boundary (paper §5): pockets, frames, reproduction, and difficult boundaries.

use std::collections::BTreeSet;

use freebound_core::bijective::{Extended, Outline};
use freebound_core::flatten::{Flattener, Step, largest_move};
use freebound_core::geom::{Orientation, orientation};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Growth, Method, Pins, Settings};
use freebound_core::verify::verdict;
use freebound_core::weights::plane_weights::{mean_value_in_plane, residuals_in_plane};
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};

use freebound_testkit::{Random, corpus_entry, corpus_test, disk, grid};

/// Largest move of a planar embedding relative to its diameter: 2D reproduction.
const REPRODUCED: f64 = 1e-12;

fn flat(mesh: &DiskMesh) -> Embedding {
    mesh.mesh().positions.iter().map(|x| DVec2::new(x.x, x.y)).collect()
}

/// Solves within the outline, and returns the mesh's part.
fn solved(mesh: &DiskMesh, extended: &Extended) -> Embedding {
    let equations = mean_value_in_plane(&extended.disk, &extended.embedding, Control::unattended()).unwrap();
    // Accumulated from the equations, so that the result does not rely on positive faces.
    let (positions, numbers) = extended.solve(equations, &extended.embedding, None, Control::unattended()).unwrap();
    assert!(numbers.residual <= 1e-10, "{:.1e}", numbers.residual);
    Embedding::of_mesh(mesh, &positions)
}

/// Grid with extra triangles on its lower side, their tips at the given heights above that side's edge.
fn grid_with_ears(columns: u32, heights: &[(u32, f64)]) -> (DiskMesh, Embedding) {
    let TriMesh { mut positions, triangles, .. } = grid(columns, columns);
    let mut faces: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(VertexId::number)).collect();
    let mut places: Vec<DVec2> = positions.iter().map(|x| DVec2::new(x.x, x.y)).collect();
    for &(column, height) in heights {
        let tip = u32::try_from(positions.len()).unwrap();
        let middle = f64::from(column) + 0.5;
        positions.push(DVec3::new(middle, -0.8, 0.0));
        places.push(DVec2::new(middle, height));
        faces.push([column, tip, column + 1]);
    }
    (disk(TriMesh::new(positions, &faces)), places.into())
}

fn steps_of(mesh: &DiskMesh, settings: Settings) -> Vec<Step> {
    let mut steps = Vec::new();
    Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    steps
}

#[test]
fn a_planar_embedding_comes_back_within_the_hull_and_within_a_frame() {
    for example in [BuiltIn::Ell, BuiltIn::Spiral] {
        let mesh = disk(example.mesh());
        let embedding = flat(&mesh);
        for extended in [Extended::up_to_hull(&mesh, &embedding), Extended::up_to_frame(&mesh, &embedding)] {
            let extended = extended.unwrap();
            let moved = largest_move(&embedding, &solved(&mesh, &extended)) / embedding.bounds().diameter();
            println!("{example:?} {:?}: {moved:.1e}", extended.outline);
            assert!(moved <= REPRODUCED, "{example:?} {:?}: {moved:.1e}", extended.outline);
        }
    }
}

#[test]
fn the_pockets_of_a_planar_embedding_are_positive_and_reach_the_hull() {
    let mesh = disk(BuiltIn::Ell.mesh());
    let extended = Extended::up_to_hull(&mesh, &flat(&mesh)).unwrap();
    assert!(!extended.pockets.is_empty());
    assert!(verdict(&extended.disk, &extended.embedding).planar, "mesh and pockets together are one-to-one");
    let hull: Vec<DVec2> = extended.disk.boundary_loop().iter().map(|v| extended.embedding[*v]).collect();
    for k in 0..hull.len() {
        let [a, b, c] = [0, 1, 2].map(|i| hull[(k + i) % hull.len()]);
        assert_ne!(orientation(a, b, c), Some(Orientation::Clockwise), "the outline is convex");
    }
}

#[test]
fn boundary_points_on_one_line_stay_on_the_hull() {
    let mesh = disk(grid(5, 4));
    let embedding = flat(&mesh);
    let extended = Extended::new(&mesh, &embedding).unwrap();
    assert_eq!((extended.outline, extended.pockets.len()), (Outline::Hull, 0));
    assert_eq!(extended.disk.boundary_loop().len(), mesh.boundary_loop().len(), "corners and points between them");
    assert!(verdict(&mesh, &solved(&mesh, &extended)).planar);
}

#[test]
fn folds_inside_a_simple_boundary_are_solved_away() {
    let mut random = Random(5);
    for columns in [6, 12, 25] {
        let mesh = disk(grid(columns, columns));
        let mut embedding = flat(&mesh);
        for v in mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()) {
            embedding[v] = DVec2::new(random.unit(), random.unit()) * f64::from(columns);
        }
        assert!(verdict(&mesh, &embedding).flipped_faces.len() > 10);
        let extended = Extended::new(&mesh, &embedding).unwrap();
        let result = verdict(&mesh, &solved(&mesh, &extended));
        assert!(result.planar, "{columns} columns: {}", result.summary());
    }
}

#[test]
fn a_boundary_that_touches_itself_is_refused_and_bent() {
    let (mesh, mut embedding) = grid_with_ears(4, &[(1, -0.8)]);
    // The ear's tip on a boundary edge, on a boundary vertex, and beyond them.
    for place in [DVec2::new(0.5, 0.0), DVec2::ZERO, DVec2::new(2.5, 4.0)] {
        *embedding.last_mut().unwrap() = place;
        assert!(!verdict(&mesh, &embedding).boundary_crossings.is_empty());
        assert!(Extended::new(&mesh, &embedding).is_none(), "{place}");
    }
}

#[test]
fn coincident_boundary_points_are_refused() {
    let mesh = disk(grid(4, 4));
    let mut embedding = flat(&mesh);
    embedding[2] = embedding[1];
    assert!(Extended::new(&mesh, &embedding).is_none());
    embedding[2] = DVec2::NAN;
    assert!(Extended::new(&mesh, &embedding).is_none());
}

#[test]
fn an_ear_on_the_hull_stays_a_triangle() {
    let (mesh, embedding) = grid_with_ears(4, &[(0, -0.8), (2, -0.3)]);
    let extended = Extended::new(&mesh, &embedding).unwrap();
    assert_eq!(extended.outline, Outline::Hull);
    let result = solved(&mesh, &extended);
    assert!(largest_move(&embedding, &result) <= REPRODUCED * embedding.bounds().diameter());
    assert!(verdict(&mesh, &result).planar);
}

#[test]
fn an_ear_flat_on_a_side_of_the_hull_gets_a_frame() {
    let (mesh, embedding) = grid_with_ears(4, &[(1, 0.0)]);
    let extended = Extended::new(&mesh, &embedding).unwrap();
    assert_eq!(extended.outline, Outline::Frame, "its base would lie along the outline");
    let result = verdict(&mesh, &solved(&mesh, &extended));
    assert!(result.planar, "{}", result.summary());
}

#[test]
fn an_ear_folded_inward_gets_a_frame_and_unfolds() {
    for ears in [vec![(1, 0.4)], vec![(0, 0.2), (1, 0.3), (3, 0.45)]] {
        let (mesh, embedding) = grid_with_ears(4, &ears);
        let before = verdict(&mesh, &embedding);
        assert_eq!(before.flipped_faces.len(), ears.len());
        assert!(before.boundary_crossings.is_empty(), "the boundary is simple");
        let extended = Extended::new(&mesh, &embedding).unwrap();
        assert_eq!(extended.outline, Outline::Frame, "the base of the ear would be a double edge");
        assert!(extended.embedding.len() > mesh.vertex_count() + 8, "the double edges are split");
        let result = verdict(&mesh, &solved(&mesh, &extended));
        assert!(result.planar, "{ears:?}: {}", result.summary());
    }
}

#[test]
fn a_larger_flap_folded_inward_unfolds() {
    // A strip of two columns hangs from the lower side, folded up into the grid.
    let TriMesh { mut positions, triangles, .. } = grid(6, 6);
    let mut faces: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(VertexId::number)).collect();
    let mut upper = [2, 3, 4];
    for row in 1..=3 {
        let lower = [0, 1, 2].map(|k| {
            positions.push(DVec3::new(2.0 + f64::from(k), -0.5 * f64::from(row), 0.0));
            u32::try_from(positions.len() - 1).unwrap()
        });
        for k in 0..2 {
            faces.push([upper[k], lower[k], lower[k + 1]]);
            faces.push([upper[k], lower[k + 1], upper[k + 1]]);
        }
        upper = lower;
    }
    let mesh = disk(TriMesh::new(positions, &faces));
    let embedding: Embedding =
        flat(&mesh).iter().map(|z| DVec2::new(z.x, z.y.abs() * if z.y < 0.0 { 0.9 } else { 1.0 })).collect();
    let before = verdict(&mesh, &embedding);
    assert_eq!((before.flipped_faces.len(), before.boundary_crossings.len()), (12, 0), "{}", before.summary());
    let extended = Extended::new(&mesh, &embedding).unwrap();
    let result = verdict(&mesh, &solved(&mesh, &extended));
    assert!(result.planar, "{}", result.summary());
}

#[test]
fn what_a_flipped_embedding_leaves_is_the_same_both_ways() {
    let (mesh, embedding) = grid_with_ears(5, &[(1, 0.4), (3, 0.2)]);
    let extended = Extended::new(&mesh, &embedding).unwrap();
    let equations = mean_value_in_plane(&extended.disk, &extended.embedding, Control::unattended()).unwrap();
    let left = residuals_in_plane(&extended.disk, &extended.embedding, Control::unattended()).unwrap();
    let (positions, _) = extended.solve(equations, &extended.embedding, Some(&left), Control::unattended()).unwrap();
    let apart = largest_move(&solved(&mesh, &extended), &positions[..mesh.vertex_count()]);
    assert!(apart <= 1e-10 * embedding.bounds().diameter(), "{apart:.1e}");
}

corpus_test! {
    fn more_boundary_vertices_are_pinned_until_the_boundary_is_simple() {
        let mesh = corpus_entry("cow_seamster.obj").disk();
        let settings = Settings::new(Method::VirtualBoundary, Family::Conformal);
        let steps = steps_of(&mesh, settings.clone());
        let bent: BTreeSet<usize> = steps.iter().map(|step| step.candidate.bent_vertices).collect();
        assert!(bent.iter().copied().take(4).eq([0, 4, 8, 16]), "{bent:?}");
        let last = steps.last().unwrap();
        assert!(last.verdict.planar && last.candidate.has_convex_boundary());

        let mut one_by_one = Flattener::new(Settings { growth: Growth::One, ..settings }, Pins::new());
        let bent: Vec<usize> =
            (0..4).map(|_| one_by_one.step(&mesh, Control::unattended()).unwrap().candidate.bent_vertices).collect();
        assert_eq!(bent, [0, 3, 4, 5], "as the paper has it");
    }
}

corpus_test! {
    fn the_stages_of_a_step_belong_together() {
        let mesh = corpus_entry("cow_seamster.obj").disk();
        let steps = steps_of(&mesh, Settings::default());
        let stages = steps.iter().find_map(|step| step.candidate.virtual_boundary.as_ref()).expect("the last rung has stages");
        assert_eq!(stages.before.len(), stages.solved.len());
        for v in &stages.hull {
            assert_eq!(stages.before[v.index()], stages.solved[v.index()], "the outline stays where it is");
        }
        let count = stages.before.len();
        assert!(stages.pockets.iter().flatten().all(|v| v.index() < count));
    }
}
