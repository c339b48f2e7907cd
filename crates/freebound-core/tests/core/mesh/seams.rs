//! Surfaces cut along listed edges.

use freebound_testkit::cubes::polygons;
use freebound_testkit::cubes::{cube, edge};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use freebound_core::mesh::{
    Charts, DiskMesh, EdgePaths, HoleTreatment, PathTree, PolygonMesh, Preparation, Repair, Repaired, Repairs, Seams,
    VertexId, WeldDistance, borders, creases,
};
use glam::DVec3;

use freebound_testkit::many_parts::ball;
use freebound_testkit::many_parts::torus;
use freebound_testkit::{Random, band, grid, quad_sheet};

/// Cylinder of quads, open at both ends.
fn cylinder(around: u32, rows: u32) -> PolygonMesh {
    let at = |row: u32, x: u32| row * around + x % around;
    let place = |v: u32| {
        let turn = std::f64::consts::TAU * f64::from(v % around) / f64::from(around);
        DVec3::new(turn.cos(), turn.sin(), f64::from(v / around))
    };
    let squares: Vec<[u32; 4]> = (0..rows)
        .flat_map(|row| (0..around).map(move |x| [at(row, x), at(row, x + 1), at(row + 1, x + 1), at(row + 1, x)]))
        .collect();
    let faces: Vec<&[u32]> = squares.iter().map(|square| &square[..]).collect();
    polygons((0..around * (rows + 1)).map(place).collect(), &faces)
}

/// Preparation with these seams only; holes stay open.
fn only(edges: impl IntoIterator<Item = [VertexId; 2]>) -> Preparation {
    Preparation { holes: HoleTreatment::Cut, seams: Seams::default().with(edges), ..Preparation::default() }
}

fn cuts(repaired: &Repaired) -> Vec<(Repair, usize)> {
    repaired.done().iter().map(|done| (done.repair, done.count)).collect()
}

/// Euler characteristic V − E + F, counted independently.
fn euler_number(mesh: &PolygonMesh) -> i64 {
    let mut edges = BTreeSet::new();
    for face in 0..mesh.face_count() {
        let corners = mesh.face(face);
        edges.extend((0..corners.len()).map(|k| {
            let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
            [a.min(b), a.max(b)]
        }));
    }
    let vertices: BTreeSet<VertexId> = mesh.corners.iter().copied().collect();
    [vertices.len(), mesh.face_count()].map(|n| i64::try_from(n).expect("few")).iter().sum::<i64>()
        - i64::try_from(edges.len()).expect("few")
}

#[test]
fn a_cylinder_cut_from_end_to_end_is_a_disk() {
    let source = cylinder(9, 4);
    let cut = only((0..4).map(|row| edge(9 * row + 2, 9 * row + 11))).repaired(&source);
    let disk = DiskMesh::try_from(cut.triangulate()).expect("a disk");
    assert_eq!(disk.boundary_loop().len(), 2 * 9 + 2 * 4);
    assert_eq!(cuts(&cut), [(Repair::CutSeams, 4)]);
    assert_eq!(disk.polygons().count(), 36, "no quad is cut through");
}

#[test]
fn a_torus_cut_along_two_loops_is_a_disk() {
    let source = PolygonMesh::from(&torus(6, 8));
    assert_eq!(euler_number(&source), 0);
    let short = (0..6).map(|k| edge(k, (k + 1) % 6));
    let long = (0..8).map(|k| edge(6 * k, 6 * ((k + 1) % 8)));
    let ring = only(short.clone()).repaired(&source);
    assert_eq!(euler_number(ring.polygons()), 0, "one loop leaves a ring");
    let cut = only(short.chain(long)).repaired(&source);
    assert_eq!(euler_number(cut.polygons()), 1);
    assert_eq!(cuts(&cut), [(Repair::CutSeams, 14)]);
    assert_eq!(DiskMesh::try_from(cut.triangulate()).expect("a disk").boundary_loop().len(), 28);
}

#[test]
fn a_mobius_strip_cut_across_is_a_disk_of_faces_that_run_alike() {
    let source = PolygonMesh::from(&band(13, 1));
    assert!(DiskMesh::try_from(source.triangulate()).is_err());
    // Each edge with two faces goes from one side of the strip to the other.
    let between = all_edges(&source).into_iter().filter(|(_, faces)| faces.len() == 2);
    for (across, _) in between {
        let form = Preparation { repair: Repairs::ALL, ..only([across]) };
        let cut = form.repaired(&source);
        DiskMesh::try_from(cut.triangulate()).expect("a disk");
        assert_eq!(cuts(&cut)[0], (Repair::CutSeams, 1));
    }
}

#[test]
fn seams_that_take_a_surface_apart_make_charts_of_it() {
    // Three squares per side, cut along both lines from one side to the other, and along a crossing line.
    let source = quad_sheet(3, 3, 0.0, &mut Random(1));
    let lines = [1, 2].into_iter().flat_map(|x| (0..3).map(move |row| edge(4 * row + x, 4 * row + x + 4)));
    let charts = Charts::of(only(lines.clone()).repaired(&source)).expect("disks");
    assert_eq!((0..charts.count()).map(|chart| charts.faces(chart).len()).collect::<Vec<_>>(), [3, 3, 3]);
    let crossing = lines.chain((0..3).map(|x| edge(x + 4, x + 5)));
    let charts = Charts::of(only(crossing).repaired(&source)).expect("disks");
    assert_eq!((0..charts.count()).map(|chart| charts.faces(chart).len()).collect::<Vec<_>>(), [1, 1, 1, 2, 2, 2]);
    for chart in 0..charts.count() {
        assert_eq!(charts.vertex_count(chart), charts.chart(chart).vertex_of.len());
    }
    assert_eq!((charts.largest(), charts.pick(Some(1)), charts.pick(Some(6))), (3, 1, 3), "the first of equal ones");
}

#[test]
fn a_seam_inside_a_surface_is_a_slit_and_one_edge_is_nothing() {
    let source = PolygonMesh::from(&grid(5, 5));
    let none = only([edge(14, 15)]).repaired(&source);
    assert_eq!((none.polygons(), none.done()), (&source, &[][..]));
    let slit = only([edge(14, 15), edge(15, 16)]).repaired(&source);
    assert_eq!((slit.polygons().positions.len(), cuts(&slit)), (37, vec![(Repair::CutSeams, 2)]));
    assert_eq!(euler_number(slit.polygons()), 0, "a hole");
    let filled = Preparation { holes: HoleTreatment::Fill, ..only([edge(14, 15), edge(15, 16)]) }.repaired(&source);
    assert!(DiskMesh::try_from(filled.triangulate()).is_ok());
}

#[test]
fn a_seam_along_the_boundary_and_one_that_is_no_edge_change_nothing() {
    let source = quad_sheet(3, 3, 0.0, &mut Random(1));
    let idle = only([edge(0, 1), edge(1, 2), edge(0, 5), edge(0, 15), edge(3, 900)]).repaired(&source);
    assert_eq!((idle.polygons(), idle.done()), (&source, &[][..]));
}

#[test]
fn faces_turned_around_are_cut_alike_with_the_same_numbers() {
    let source = PolygonMesh::from(&ball(7, 5));
    let edges: Vec<_> = all_edges(&source).into_keys().step_by(3).collect();
    let cut = only(edges.clone()).repaired(&source);
    let turned = Preparation { faces_turned: true, ..only(edges) }.repaired(&source.turned());
    assert_eq!(turned.polygons(), &cut.polygons().turned());
    assert_eq!(turned.done(), cut.done());
}

#[test]
fn after_welding_a_seam_of_either_part_is_cut() {
    // Two squares with separate vertices along their common side.
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let places = vec![at(0., 0.), at(1., 0.), at(1., 1.), at(0., 1.), at(1., 0.), at(2., 0.), at(2., 1.), at(1., 1.)];
    let source = polygons(places, &[&[0, 1, 2, 3], &[4, 5, 6, 7]]);
    for seam in [edge(1, 2), edge(7, 4)] {
        let form = Preparation { repair: Repairs::ALL, ..only([seam]) };
        assert_eq!(cuts(&form.repaired(&source)), [(Repair::WeldVertices, 2), (Repair::CutSeams, 1)]);
    }
    assert_eq!(borders(&source, Repairs::ALL, &[4, 5]), [edge(1, 2)], "faces that are joined are neighbours");
    assert!(borders(&source, Repairs::SAFE, &[4, 5]).is_empty());
}

/// All edges with the positions of their sides: first corners in the faces.
fn all_edges(mesh: &PolygonMesh) -> BTreeMap<[VertexId; 2], Vec<usize>> {
    let mut edges: BTreeMap<[VertexId; 2], Vec<usize>> = BTreeMap::new();
    for face in 0..mesh.face_count() {
        let range = mesh.corner_range(face);
        for corner in range.clone() {
            let next = if corner + 1 == range.end { range.start } else { corner + 1 };
            let [a, b] = [corner, next].map(|at| mesh.corners[at]);
            edges.entry([a.min(b), a.max(b)]).or_default().push(corner);
        }
    }
    edges
}

/// Groups of corners that stay together, labelled by their least corner. A group has corners of one vertex in faces
/// that share uncut edges.
fn corners_together(mesh: &PolygonMesh, cut: &BTreeSet<[VertexId; 2]>) -> Vec<usize> {
    let mut label: Vec<usize> = (0..mesh.corners.len()).collect();
    let face_of: Vec<usize> =
        (0..mesh.face_count()).flat_map(|face| mesh.corner_range(face).map(move |_| face)).collect();
    let joined: Vec<[usize; 2]> = all_edges(mesh)
        .into_iter()
        .filter(|(ends, _)| !cut.contains(ends))
        .flat_map(|(ends, sides)| {
            let corner = |side: usize, v: VertexId| {
                mesh.corner_range(face_of[side]).find(|&at| mesh.corners[at] == v).expect("an end of the side")
            };
            let [first, second] = [sides[0], sides[sides.len() - 1]];
            ends.map(|v| [corner(first, v), corner(second, v)])
        })
        .collect();
    // Propagates labels until nothing changes.
    loop {
        let before = label.clone();
        for &[a, b] in &joined {
            let least = label[a].min(label[b]);
            label[a] = least;
            label[b] = least;
        }
        if label == before {
            return label;
        }
    }
}

#[test]
fn random_seams_part_the_corners_that_no_whole_edge_joins() {
    let mut random = Random(31);
    for case in 0..120 {
        let source: PolygonMesh = match case % 4 {
            0 => quad_sheet(5, 4, 0.2, &mut random),
            1 => (&torus(5, 6)).into(),
            2 => (&ball(6, 4)).into(),
            _ => cylinder(6, 3),
        };
        let share = 1 + random.index(9);
        let seam: BTreeSet<_> = all_edges(&source).into_keys().filter(|_| random.index(10) < share).collect();
        let cut = only(seam.iter().map(|&[a, b]| [b, a])).repaired(&source);
        let expected = corners_together(&source, &seam);
        let found = &cut.polygons().corners;
        assert_eq!(found.len(), expected.len());
        let mut vertex_of_label = BTreeMap::new();
        let mut label_of_vertex = BTreeMap::new();
        for (corner, (&vertex, &label)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(*vertex_of_label.entry(label).or_insert(vertex), vertex, "case {case}: corner {corner}");
            assert_eq!(*label_of_vertex.entry(vertex).or_insert(label), label, "case {case}: corner {corner}");
            let of = source.corners[corner];
            assert_eq!(cut.polygons().positions[vertex.index()], source.positions[of.index()]);
            // The first fan of a vertex keeps its number.
            let is_first = source.corners.iter().position(|v| *v == of) == Some(corner);
            assert!(!is_first || vertex == of, "case {case}: corner {corner}");
        }
        assert_eq!(cut, only(seam).repaired(&source), "the same again");
    }
}

#[test]
fn creases_are_edges_of_faces_at_an_angle() {
    let mut cube = cube();
    assert_eq!(creases(&cube, Repairs::SAFE, 90.0).len(), 12);
    assert!(creases(&cube, Repairs::SAFE, 90.001).is_empty());
    // A reversed face does not count as a crease by itself.
    cube.corners[4..8].reverse();
    assert_eq!(creases(&cube, Repairs::SAFE, 90.0).len(), 12);
    assert!(creases(&cube, Repairs::SAFE, 90.001).is_empty());
    // Vertical edges of an eight-sided prism have 45 degrees.
    let prism = cylinder(8, 2);
    let upright: Vec<_> = (0..16).map(|v| edge(v, v + 8)).collect();
    assert_eq!(creases(&prism, Repairs::SAFE, 45.0), upright);
    assert!(creases(&prism, Repairs::SAFE, 46.0).is_empty());
    assert!(creases(&(&grid(3, 3)).into(), Repairs::SAFE, 0.5).is_empty());
}

#[test]
fn seams_are_a_set_of_edges_whose_ends_come_in_any_order() {
    let seams = Seams::default().with([edge(5, 2), edge(2, 5), edge(1, 1), edge(0, 9)]);
    assert_eq!(seams.edges().iter().copied().collect::<Vec<_>>(), [edge(0, 9), edge(2, 5)]);
    assert_eq!(seams.without([edge(5, 2), edge(7, 8)]).edges().len(), 1);
    assert!(seams.without([edge(5, 2), edge(9, 0)]).is_empty() && !seams.is_empty());
}

/// Quad with two corners near each other, in every order of its corners, beside a quad with its own corners. Welding
/// joins vertices 1 and 2, and 3 and 5, so the side from 2 to 3 joins that of the other quad.
fn near_corners() -> Vec<PolygonMesh> {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let places =
        vec![at(0., 0.), at(1., 0.), at(1., 0.001), at(1., 1.), at(0., 1.), at(1., 1.0), at(2., 0.), at(2., 1.)];
    let mut meshes = Vec::new();
    for start in 0..5 {
        for other in [[1, 6, 7, 5], [5, 7, 6, 1]] {
            let mut quad = [0, 1, 2, 3, 4];
            quad.rotate_left(start);
            meshes.push(polygons(places.clone(), &[&quad, &other]));
            quad.reverse();
            meshes.push(polygons(places.clone(), &[&quad, &other]));
        }
    }
    meshes
}

#[test]
fn edges_found_after_welding_are_edges_of_the_file_and_cut_where_they_are() {
    let repair = Repairs::ALL.welding(WeldDistance::new(0.01));
    for mesh in near_corners() {
        let of_file = all_edges(&mesh);
        let found = borders(&mesh, repair, &[0, 1]);
        assert_eq!(found, [edge(2, 3)], "the first face names it: {:?}", mesh.corners);
        let path = PathTree::new(&Arc::new(EdgePaths::new(&mesh, repair)), VertexId::new(1), 0.0);
        let path = path.path_to(VertexId::new(3)).expect("it leads there");
        assert_eq!(path, [edge(2, 3)]);
        assert!(path.iter().all(|edge| of_file.contains_key(edge)));
        for (seam, faces_turned) in [(edge(2, 3), false), (edge(2, 3), true), (edge(1, 5), false), (edge(1, 5), true)] {
            let form = Preparation { repair, faces_turned, ..only([seam]) };
            let source = if faces_turned { mesh.turned() } else { mesh.clone() };
            let cut = form.repaired(&source);
            assert_eq!(cuts(&cut).last(), Some(&(Repair::CutSeams, 1)), "{seam:?} of {:?}", source.corners);
            assert_eq!(cut.seam_sides(&form.seams, &source).len(), 1, "{seam:?} of {:?}", source.corners);
        }
        let idle = Preparation { repair, ..only([edge(1, 2), edge(1, 3)]) }.repaired(&mesh);
        assert!(
            cuts(&idle).iter().all(|(repair, _)| *repair != Repair::CutSeams),
            "a side that has no length any more"
        );
    }
}

#[test]
fn every_face_knows_its_chart() {
    let source = quad_sheet(3, 3, 0.0, &mut Random(1));
    let lines = [1, 2].into_iter().flat_map(|x| (0..3).map(move |row| edge(4 * row + x, 4 * row + x + 4)));
    let charts = Charts::of(only(lines).repaired(&source)).expect("disks");
    for chart in 0..charts.count() {
        assert!(charts.faces(chart).iter().all(|&face| charts.chart_of_face(face) == Some(chart)));
    }
    assert_eq!(charts.chart_of_face(9), None, "there are nine faces");
}
