//! Shortest paths along edges, for seams, compared with a search without a queue that measures edges independently.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use freebound_core::mesh::{EdgePaths, PathTree, PolygonMesh, Repairs, Seams, TriMesh, VertexId};
use glam::DVec3;

use freebound_testkit::{Random, grid, quad_sheet, tetrahedron};

/// Cost of the sharpest edges relative to their length.
const CREASED: f64 = 0.05;

/// Relative tolerance for path costs that differ by rounding.
const TOLERANCE: f64 = 1e-12;

type Edge = [VertexId; 2];

fn ordered([a, b]: Edge) -> Edge {
    [a.min(b), a.max(b)]
}

/// Area vector of a face by Newell's formula, normalised.
fn normal(mesh: &PolygonMesh, face: usize) -> DVec3 {
    let corners = mesh.face(face);
    let at = |k: usize| mesh.positions[corners[k % corners.len()].index()];
    (0..corners.len()).map(|k| at(k).cross(at(k + 1))).sum::<DVec3>().normalize_or_zero()
}

/// Cost of every edge, by the formula.
fn costs(mesh: &PolygonMesh, creases: f64) -> BTreeMap<Edge, f64> {
    let mut normals: BTreeMap<Edge, Vec<DVec3>> = BTreeMap::new();
    for face in 0..mesh.face_count() {
        let corners = mesh.face(face);
        for k in 0..corners.len() {
            let edge = ordered([corners[k], corners[(k + 1) % corners.len()]]);
            normals.entry(edge).or_default().push(normal(mesh, face));
        }
    }
    let cost = |(edge, of): (Edge, Vec<DVec3>)| {
        let [a, b] = edge.map(|v| mesh.positions[v.index()]);
        let angle = of[0].dot(of[of.len() - 1]).clamp(-1.0, 1.0).acos();
        (edge, a.distance(b) * (1.0 - creases * (1.0 - CREASED) * (angle / FRAC_PI_2).min(1.0)))
    };
    normals.into_iter().map(cost).collect()
}

/// Distances of all vertices from one, relaxing all edges until nothing changes.
fn distances(mesh: &PolygonMesh, costs: &BTreeMap<Edge, f64>, from: VertexId) -> Vec<f64> {
    let mut far = vec![f64::INFINITY; mesh.positions.len()];
    far[from.index()] = 0.0;
    loop {
        let before = far.clone();
        for ([a, b], cost) in costs {
            for [a, b] in [[a, b], [b, a]] {
                far[b.index()] = far[b.index()].min(far[a.index()] + cost);
            }
        }
        if far == before {
            return far;
        }
    }
}

fn tree(mesh: &PolygonMesh, from: VertexId, creases: f64) -> PathTree {
    PathTree::new(&Arc::new(EdgePaths::new(mesh, Repairs::SAFE)), from, creases)
}

/// Asserts that edges lead without a gap from one vertex back to another.
fn assert_leads(path: &[Edge], from: VertexId, to: VertexId) {
    let end = path.iter().fold(to, |at, &[a, b]| {
        assert!(at == a || at == b, "{at} is no end of {a} to {b}");
        if at == a { b } else { a }
    });
    assert_eq!(end, from);
}

/// Cube of quads from (0, 0, 0) to (cells, cells, cells).
fn cube(cells: u32) -> PolygonMesh {
    let mut numbers: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let (mut positions, mut corners) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for high in [false, true] {
            for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
                let mut around = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                if !high {
                    around.reverse();
                }
                for [u, v] in around {
                    let mut at = [0; 3];
                    (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (if high { cells } else { 0 }, u, v);
                    let number = *numbers.entry(at).or_insert_with(|| {
                        positions.push(DVec3::from(at.map(f64::from)));
                        u32::try_from(positions.len() - 1).unwrap()
                    });
                    corners.push(VertexId::new(number));
                }
            }
        }
    }
    let starts = (0..=corners.len() / 4).map(|face| u32::try_from(4 * face).unwrap()).collect();
    PolygonMesh { positions, corners, starts: Some(starts) }
}

fn vertex_at(mesh: &PolygonMesh, place: [u32; 3]) -> VertexId {
    let place = DVec3::from(place.map(f64::from));
    VertexId::from_index(mesh.positions.iter().position(|&at| at == place).expect("a vertex lies there"))
}

#[test]
fn a_path_costs_as_much_as_the_best_that_a_search_of_all_edges_finds() {
    let mut random = Random(17);
    let rough = quad_sheet(7, 6, 0.8, &mut random);
    for (name, mesh) in [("rough sheet", rough), ("cube", cube(3)), ("tetrahedron", PolygonMesh::from(&tetrahedron()))]
    {
        for creases in [0.0, 0.3, 0.7, 1.0] {
            let costs = costs(&mesh, creases);
            let from = VertexId::from_index(random.index(mesh.positions.len()));
            let (tree, far) = (tree(&mesh, from, creases), distances(&mesh, &costs, from));
            for to in (0..mesh.positions.len()).map(VertexId::from_index) {
                let path = tree.path_to(to).expect("all hangs together");
                assert_leads(&path, from, to);
                let cost: f64 = path.iter().map(|&edge| costs[&ordered(edge)]).sum();
                let best = far[to.index()];
                assert!((cost - best).abs() <= TOLERANCE * best, "{name}, {creases}: {to} at {cost} for {best}");
            }
        }
    }
}

#[test]
fn on_a_cube_a_path_of_creases_goes_along_its_edges() {
    let cells = 4;
    let mesh = cube(cells);
    let [from, to] = [[0, 0, 0], [cells, cells, cells]].map(|place| vertex_at(&mesh, place));
    let on_edge = |vertex: &VertexId| {
        let at = mesh.positions[vertex.index()].to_array();
        at.iter().filter(|&&x| x == 0.0 || x == f64::from(cells)).count() >= 2
    };
    let path = tree(&mesh, from, 1.0).path_to(to).unwrap();
    assert_eq!(path.len(), 3 * cells as usize, "no longer than any other, and nothing sharp is left out");
    assert!(path.as_flattened().iter().all(on_edge), "{path:?}");
    // From the middle of a side's edge to the middle of the opposite one: straight across, or around the side.
    let [from, to] = [[0, 2, 0], [cells, 2, 0]].map(|place| vertex_at(&mesh, place));
    let [straight, around] = [0.0, 1.0].map(|creases| tree(&mesh, from, creases).path_to(to).unwrap());
    assert_eq!((straight.len(), around.len()), (4, 8));
    assert!(around.as_flattened().iter().all(on_edge), "{around:?}");
}

#[test]
fn a_path_crosses_where_the_repair_joins_two_sheets_and_not_where_it_does_not() {
    // Two sheets side by side, each with its own vertices along the line between them.
    let one = grid(3, 2);
    let moved = one.positions.iter().map(|&at| at + DVec3::X * (one.positions[3] - one.positions[0]).length());
    let count = u32::try_from(one.positions.len()).unwrap();
    let both = TriMesh {
        positions: one.positions.iter().copied().chain(moved).collect(),
        triangles: one
            .triangles
            .iter()
            .copied()
            .chain(one.triangles.iter().map(|t| t.map(|v| VertexId::new(v.number() + count))))
            .collect(),
        polygon_of: None,
    };
    let mesh = PolygonMesh::from(&both);
    let [from, to] = [0, 2 * count - 1].map(VertexId::new);
    let path = |repairs: Repairs| PathTree::new(&Arc::new(EdgePaths::new(&mesh, repairs)), from, 0.0).path_to(to);
    assert_eq!(path(Repairs::SAFE), None);
    let path = path(Repairs::ALL).expect("welded, they are one");
    let real: Vec<Edge> = costs(&mesh, 0.0).into_keys().collect();
    assert!(path.iter().all(|&edge| real.contains(&ordered(edge))), "edges are the file's: {path:?}");
    let places: Vec<[DVec3; 2]> = path.iter().map(|edge| edge.map(|v| mesh.positions[v.index()])).collect();
    let meet = |pair: &[[DVec3; 2]]| pair[0].iter().any(|at| pair[1].contains(at));
    assert!(places.windows(2).all(meet), "without a gap in space: {places:?}");
}

#[test]
fn there_are_no_paths_where_corners_are_missing_or_to_a_vertex_that_is_not_there() {
    let mut mesh = PolygonMesh::from(&grid(2, 2));
    let there = |mesh: &PolygonMesh, to: u32| tree(mesh, VertexId::new(0), 0.5).path_to(VertexId::new(to));
    assert_eq!(there(&mesh, 0), Some(Vec::new()));
    assert!(there(&mesh, 8).is_some());
    assert_eq!(there(&mesh, 9), None);
    mesh.corners[1] = VertexId::new(100);
    assert_eq!(there(&mesh, 8), None);
    let stroke = PolygonMesh { corners: vec![VertexId::new(0); 2], starts: Some(vec![0, 2]), ..mesh };
    assert_eq!(there(&stroke, 8), None);
}

fn edges(of: &[[u32; 2]]) -> Vec<Edge> {
    of.iter().map(|edge| edge.map(VertexId::new)).collect()
}

#[test]
fn a_stretch_of_a_seam_ends_where_seams_end_or_meet() {
    // A line 0–1–2–3 with a branch 2–4–5, and a ring 6–7–8.
    let seams = Seams::default().with(edges(&[[0, 1], [2, 1], [2, 3], [2, 4], [5, 4], [6, 7], [7, 8], [8, 6]]));
    let through = |vertex: u32| seams.stretches_through(VertexId::new(vertex));
    assert_eq!(through(1), edges(&[[0, 1], [1, 2]]));
    assert_eq!(through(0), through(1));
    assert_eq!(through(5), edges(&[[2, 4], [4, 5]]));
    assert_eq!(through(2), edges(&[[0, 1], [1, 2], [2, 3], [2, 4], [4, 5]]), "where seams meet, all that meet");
    assert_eq!(through(7), edges(&[[6, 7], [6, 8], [7, 8]]));
    assert!(through(9).is_empty());
}

#[test]
fn a_way_along_seams_takes_the_fewest_edges() {
    let seams = Seams::default().with(edges(&[[0, 1], [1, 2], [2, 3], [3, 0], [3, 4], [7, 8]]));
    let way = |from: u32, to: u32| seams.way(VertexId::new(from), VertexId::new(to));
    assert_eq!(way(0, 4), Some(edges(&[[0, 3], [3, 4]])));
    assert_eq!(way(4, 1).map(|way| way.len()), Some(3));
    assert_eq!(way(2, 2), Some(Vec::new()));
    assert_eq!((way(0, 8), way(0, 9)), (None, None));
}
