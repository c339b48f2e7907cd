//! Indices of one-forms: their sum is Euler's for any one-form. Indices of embeddings along directions are compared
//! with the definition and with the hulls of neighbours.

use std::cmp::Ordering;

use freebound_core::geom::order_along;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{CornerKind, OneFormIndices, hull_standing, index_range, verdict};
use glam::DVec2;
use num_rational::BigRational;

use crate::verify::hull_condition::ring;
use crate::verify::verdict_cases::{grid_case, nearly_planar_case, nudge};
use freebound_testkit::{Random, grid};

#[test]
fn the_order_along_a_direction_is_that_of_rational_numbers() {
    let mut random = Random(41);
    let exact = |x: f64| BigRational::from_float(x).unwrap();
    let mut equal = 0;
    for round in 0..20_000 {
        let scale = [1.0, 0.1, 5e-324, 1e-200, 1e300][round % 5];
        let mut point = || DVec2::new(f64::from(random.below(7)) - 3.0, f64::from(random.below(7)) - 3.0) * scale;
        let mut points: Embedding = vec![point(), point(), point()].into();
        if round % 3 == 0 {
            nudge(&mut random, &mut points);
        }
        let [d, a, b] = [points[0], points[1], points[2]];
        let along = |z: DVec2| exact(d.x) * exact(z.x) + exact(d.y) * exact(z.y);
        let expected = along(b).cmp(&along(a));
        assert_eq!(order_along(d, a, b), Some(expected), "{d}, {a}, {b}");
        equal += usize::from(expected == Ordering::Equal);
    }
    assert!((1_000..10_000).contains(&equal), "{equal}");
    assert_eq!(order_along(DVec2::X, DVec2::ZERO, DVec2::new(f64::INFINITY, 0.0)), None);
}

#[test]
fn the_indices_of_any_one_form_add_up_to_two() {
    let mut random = Random(42);
    for round in 0..3_000 {
        let mesh = nearly_planar_case(&mut random).mesh();
        let edges: Vec<bool> = mesh.edges().map(|_| random.below(2) == 0).collect();
        let is_positive = |h| edges[mesh.edge_of(h).index()] == (mesh.halfedge(mesh.edge_of(h)) == h);
        let indices = OneFormIndices::new(&mesh, is_positive);
        assert_eq!(indices.sum(), 2, "{round}");
        assert!(indices.faces.iter().all(|index| [0, 1].contains(index)), "a triangle's signs change twice or never");
    }
}

/// Random direction.
fn direction(random: &mut Random) -> DVec2 {
    DVec2::from_angle(std::f64::consts::TAU * random.unit())
}

#[test]
fn the_indices_of_an_embedding_along_a_direction_add_up_to_two_and_are_zero_at_faces() {
    let mut random = Random(43);
    let mut counted = 0;
    for _ in 0..6_000 {
        let case = if random.below(2) == 0 { grid_case(&mut random) } else { nearly_planar_case(&mut random) };
        let Some(indices) = OneFormIndices::along(&case.mesh(), &case.embedding, direction(&mut random)) else {
            continue;
        };
        assert_eq!(indices.sum(), 2, "{case:?}");
        assert!(indices.faces.iter().all(|&index| index == 0), "{case:?}");
        counted += 1;
    }
    assert!(counted > 3_000, "{counted}");
    let mesh = DiskMesh::try_from(grid(2, 2)).unwrap();
    let flat: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    assert_eq!(OneFormIndices::along(&mesh, &flat, DVec2::X), None, "some edges are at right angles to it");
}

/// Least and greatest index of a vertex, from the directions on both sides of each edge's normal.
fn range_by_directions(mesh: &DiskMesh, embedding: &Embedding, vertex: VertexId) -> [i64; 2] {
    let edges: Vec<DVec2> = mesh.outgoing(vertex).map(|h| embedding[mesh.head(h)] - embedding[vertex]).collect();
    // Coordinates are small integers, so a turn this small passes no other line.
    let beside = edges.iter().flat_map(|e| [1e-4, -1e-4].map(|by| e.perp().rotate(DVec2::from_angle(by))));
    let index = |d: DVec2| {
        let signs: Vec<bool> = edges.iter().map(|e| d.dot(*e) > 0.0).collect();
        let changes = (0..signs.len()).filter(|&k| signs[k] != signs[(k + 1) % signs.len()]).count();
        1 - i64::try_from(changes).unwrap() / 2
    };
    beside.map(index).fold([i64::MAX, i64::MIN], |[low, high], index| [low.min(index), high.max(index)])
}

#[test]
fn the_range_of_a_vertex_is_that_of_the_directions_beside_each_change() {
    let mut random = Random(44);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..6_000 {
        let case = grid_case(&mut random);
        let mesh = case.mesh();
        for vertex in mesh.vertices() {
            let coincides = mesh.outgoing(vertex).any(|h| case.embedding[mesh.head(h)] == case.embedding[vertex]);
            let range = index_range(&mesh, &case.embedding, vertex);
            assert_eq!(range.is_none(), coincides, "{vertex} of {case:?}");
            let Some(range) = range else { continue };
            assert_eq!(range, range_by_directions(&mesh, &case.embedding, vertex), "{vertex} of {case:?}");
            seen.insert(range);
        }
    }
    for range in [[0, 0], [0, 1], [-1, 1], [-1, 0], [-1, -1], [1, 1]] {
        assert!(seen.contains(&range) || range == [1, 1], "{range:?} is not among {seen:?}");
    }
}

#[test]
fn a_vertex_inside_the_hull_is_an_extreme_along_no_direction_and_one_away_from_it_along_some() {
    let mut random = Random(45);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..4_000 {
        let case = nearly_planar_case(&mut random);
        let (mesh, verdict) = (case.mesh(), verdict(&case.mesh(), &case.embedding));
        for vertex in mesh.vertices() {
            let Some([_, greatest]) = index_range(&mesh, &case.embedding, vertex) else { continue };
            let standing = hull_standing(&mesh, &case.embedding, vertex, verdict.upright()).unwrap();
            if standing.is_inside {
                assert!(greatest <= 0, "{vertex} of {case:?}");
                inside += 1;
            } else if standing.corner == CornerKind::Interior && is_off_the_rim(&mesh, &case.embedding, vertex) {
                assert_eq!(greatest, 1, "{vertex} of {case:?}");
                outside += 1;
            }
            if verdict.is_one_to_one() && standing.corner == CornerKind::Interior {
                assert_eq!(index_range(&mesh, &case.embedding, vertex), Some([0, 0]), "{vertex} of {case:?}");
            }
        }
    }
    assert!(inside > 1_000 && outside > 200, "{inside} inside, {outside} outside");
}

/// True if a vertex lies on no line through two of its neighbours.
fn is_off_the_rim(mesh: &DiskMesh, embedding: &Embedding, vertex: VertexId) -> bool {
    let arms: Vec<DVec2> = mesh.outgoing(vertex).map(|h| embedding[mesh.head(h)] - embedding[vertex]).collect();
    arms.iter().enumerate().all(|(k, a)| arms[..k].iter().all(|b| a.perp_dot(*b) != 0.0))
}

#[test]
fn around_a_hole_of_a_planar_surface_no_index_is_negative_however_its_filling_folds() {
    let mut random = Random(46);
    let (mesh, mut folded) = (ring(7), 0);
    for _ in 0..2_000 {
        let mut embedding: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
        (7..14).for_each(|k| embedding[k] *= 0.2 + 2.3 * random.unit());
        for vertex in mesh.virtual_vertices() {
            embedding[vertex] = DVec2::new(random.unit(), random.unit()) * 3.0;
        }
        let verdict = verdict(&mesh, &embedding);
        if !verdict.planar {
            continue;
        }
        folded += usize::from(verdict.is_filling_folded);
        for vertex in (0..14).map(VertexId::new) {
            let range = index_range(&mesh, &embedding, vertex).expect("no two places are one");
            assert!(range[0] >= 0, "{vertex}: {range:?} in {embedding:?}");
        }
    }
    assert!(folded > 100, "{folded} with a folded filling: too few to tell");
}
