//! Vertices welded within a distance: the pairs against all pairs, and the effect on their faces.

use freebound_core::mesh::{
    DiskMesh, PolygonMesh, Repair, Repaired, Repairs, TriMesh, VertexId, WeldDistance, diagnose, near_vertices,
};
use glam::DVec3;

use freebound_testkit::{Random, grid};

fn distance(distance: f64) -> WeldDistance {
    WeldDistance::new(distance).expect("a distance")
}

fn welded(mesh: &PolygonMesh, within: f64) -> Repaired {
    Repaired::new(mesh, Repairs::SAFE.welding(Some(distance(within))))
}

/// Separate triangles over consecutive triples of positions.
fn soup(positions: Vec<DVec3>) -> PolygonMesh {
    let corners = (0..positions.len() / 3 * 3).map(VertexId::from_index).collect();
    PolygonMesh { positions, corners, starts: None }
}

/// Compares every vertex with all earlier representatives.
fn near_of_all_pairs(positions: &[DVec3], within: f64) -> Vec<[VertexId; 2]> {
    let mut standing: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    for (vertex, place) in positions.iter().enumerate() {
        let far = |other: usize| place.distance(positions[other]);
        match standing.iter().copied().filter(|&other| far(other) <= within).min_by(|&a, &b| far(a).total_cmp(&far(b)))
        {
            Some(other) => found.push([vertex, other].map(VertexId::from_index)),
            None => standing.push(vertex),
        }
    }
    found
}

#[test]
fn the_vertices_that_are_joined_are_those_of_all_pairs() {
    let mut random = Random(71);
    for case in 0..200 {
        let count = 3 * (1 + random.index(60));
        // Few positions along some axes, so that many vertices coincide or are collinear; near and far from the
        // origin.
        let origin = DVec3::new(random.unit(), random.unit(), random.unit()) * [0.0, 1.0, 1e3, 1e6][case % 4];
        let steps = [1.0, 3.0, 50.0, 1e9][random.index(4)];
        let mut place = || origin + (DVec3::new(random.unit(), random.unit(), random.unit()) * steps).round() / steps;
        let positions: Vec<DVec3> = (0..count).map(|_| place()).collect();
        for within in [0.0, 1e-12, 0.01, 0.1, 0.4, 3.0] {
            let found = near_vertices(&soup(positions.clone()), distance(within));
            assert_eq!(found, near_of_all_pairs(&positions, within), "case {case}, within {within}");
        }
    }
}

#[test]
fn the_largest_the_smallest_and_the_most_distant_numbers_are_joined_where_they_are_equal() {
    for size in [f64::MIN_POSITIVE, 1e-200, 1.0, 1e200, f64::MAX] {
        let places = [-DVec3::ONE, DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::X, -DVec3::ONE].map(|place| place * size);
        let found = near_vertices(&soup(places.to_vec()), distance(0.0));
        assert_eq!(found, [[4, 2], [5, 0]].map(|pair| pair.map(VertexId::new)), "{size}");
    }
}

#[test]
fn a_row_of_near_vertices_does_not_collapse_into_one() {
    let row: Vec<DVec3> = (0..30).map(|k| DVec3::X * f64::from(k)).collect();
    let joined = near_vertices(&soup(row), distance(1.0));
    let pairs: Vec<[u32; 2]> = joined.iter().map(|pair| pair.map(VertexId::number)).collect();
    assert_eq!(pairs, (0..15).map(|k| [2 * k + 1, 2 * k]).collect::<Vec<_>>());
}

#[test]
fn vertices_of_no_face_and_without_a_position_are_joined_with_nothing() {
    let mut positions = vec![DVec3::ZERO; 7];
    positions[1].x = f64::NAN;
    // The last vertex has no face.
    let joined = near_vertices(&soup(positions), distance(1.0));
    assert_eq!(joined, [[2, 0], [3, 0], [4, 0], [5, 0]].map(|pair| pair.map(VertexId::new)));
}

/// Sheet of squares in two halves whose vertices along the middle are a little apart.
fn halves(apart: f64) -> PolygonMesh {
    let left = grid(4, 5);
    let mut right = left.clone();
    let width = left.positions.iter().map(|place| place.x).fold(0.0, f64::max);
    right.positions.iter_mut().for_each(|place| place.x += width + apart);
    let count = left.vertex_count();
    let moved = right.triangles.iter().map(|face| face.map(|v| VertexId::from_index(v.index() + count)));
    let triangles = left.triangles.iter().copied().chain(moved).collect();
    let positions = [left.positions, right.positions].concat();
    PolygonMesh::from(&TriMesh { positions, triangles, polygon_of: None })
}

#[test]
fn two_halves_a_little_apart_become_one_and_every_vertex_keeps_its_place() {
    let source = halves(1e-3);
    assert!(DiskMesh::try_from(welded(&source, 9e-4).triangulate()).is_err());
    let one = welded(&source, 1.1e-3);
    let disk = DiskMesh::try_from(one.triangulate()).expect("a disk");
    assert_eq!(one.polygons().positions, source.positions);
    assert_eq!(
        one.done().iter().map(|done| (done.repair, done.count)).collect::<Vec<_>>(),
        [(Repair::WeldVertices, 6)]
    );
    assert_eq!(disk.vertex_count() - disk.used_vertex_count(), 6);
    // Every corner of the file maps to a vertex of the disk at its position.
    for (corner, vertex) in source.corners.iter().zip(one.vertices_at_corners(&source)) {
        let far = source.positions[corner.index()].distance(source.positions[vertex.expect("a vertex").index()]);
        assert!(far <= 1.1e-3, "{corner}: {far}");
    }
}

#[test]
fn faces_that_lose_their_area_by_welding_go_and_their_corners_have_vertices_all_the_same() {
    // A sheet whose small middle square collapses to a point: the triangles around it stay.
    let mut source = PolygonMesh::from(&grid(3, 3));
    let middle: Vec<usize> =
        (0..source.positions.len()).filter(|&v| (1..=2).contains(&(v % 4)) && (1..=2).contains(&(v / 4))).collect();
    let first = source.positions[middle[0]];
    for &v in &middle[1..] {
        source.positions[v] = first + (source.positions[v] - first) * 1e-3;
    }
    let welded = welded(&source, 0.1);
    assert!(diagnose(&welded.triangulate()).is_disk());
    assert_eq!(
        welded.polygons().face_count(),
        source.face_count() - 6,
        "2 within the square, one at each of its sides"
    );
    assert!(welded.vertices_at_corners(&source).iter().all(Option::is_some));
}

#[test]
fn a_distance_is_a_number_of_zero_or_more() {
    for odd in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(WeldDistance::new(odd), None, "{odd}");
    }
    assert!(distance(-0.0).get().is_sign_positive());
}
