//! Layouts on other meshes of their surfaces.

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;

use freebound_core::mesh::{PolygonMesh, TriMesh, VertexId};
use freebound_core::pipeline::{
    CopiedLayout, CopyLayoutError, LayoutSurface, PipelineOptions, Unwrapped, copy_layout, unwrap,
};
use freebound_core::problem::{Control, Embedding};
use freebound_core::verify::{LayoutOptions, LayoutVerdict, PlaneLayout, layout_verdict_with};
use freebound_testkit::many_parts::{ball, torus};
use freebound_testkit::{Random, grid, shaped};
use glam::{DVec2, DVec3};

/// Layout of a mesh of triangles: a coordinate of each corner.
struct Layout {
    /// Triangles with one vertex per coordinate.
    mesh: TriMesh,
    coordinates: Embedding,
    /// Coordinate of each corner.
    of_corner: Vec<DVec2>,
}

impl Layout {
    fn of(mesh: &PolygonMesh, coordinates: &[DVec2], corners: &[u32]) -> Self {
        let of_corner: Vec<DVec2> = corners.iter().map(|&corner| coordinates[corner as usize]).collect();
        let (mut number_of, mut positions, mut of_vertices) = (HashMap::new(), Vec::new(), Vec::new());
        let mut number = |(vertex, uv): (&VertexId, &DVec2)| {
            let next = VertexId::from_index(number_of.len());
            *number_of.entry((*vertex, uv.to_array().map(f64::to_bits))).or_insert_with(|| {
                positions.push(mesh.positions[vertex.index()]);
                of_vertices.push(*uv);
                next
            })
        };
        let vertices: Vec<VertexId> = mesh.corners.iter().zip(&of_corner).map(&mut number).collect();
        let triangles = vertices.as_chunks::<3>().0.to_vec();
        Self { mesh: TriMesh { positions, triangles, polygon_of: None }, coordinates: of_vertices.into(), of_corner }
    }

    fn unwrapped(mesh: &TriMesh) -> Self {
        let mesh = PolygonMesh::from(mesh);
        let Unwrapped { coordinates, corners, .. } =
            unwrap(&mesh, &PipelineOptions::for_any_mesh()).expect("it unwraps");
        Self::of(&mesh, &coordinates, &corners)
    }

    /// Layout of a mesh without seams.
    fn by_positions(mesh: TriMesh, place: impl Fn(DVec3) -> DVec2) -> Self {
        let coordinates: Vec<DVec2> = mesh.positions.iter().map(|&position| place(position)).collect();
        let of_corner = mesh.triangles.iter().flatten().map(|vertex| coordinates[vertex.index()]).collect();
        Self { mesh, coordinates: coordinates.into(), of_corner }
    }

    fn surface(&self) -> LayoutSurface<'_> {
        LayoutSurface { mesh: &self.mesh, coordinates: &self.coordinates }
    }

    fn onto(&self, mesh: &TriMesh) -> (Self, CopiedLayout) {
        let mesh = PolygonMesh::from(mesh);
        let copied = copy_layout(self.surface(), &mesh, Control::unattended()).expect("it can be copied");
        (Self::of(&mesh, &copied.coordinates, &copied.corners), copied)
    }

    fn verdict(&self) -> LayoutVerdict {
        let Self { mesh, coordinates, .. } = self;
        let layout = PlaneLayout { mesh, coordinates, groups: &[], bare_faces: &[] };
        layout_verdict_with(layout, LayoutOptions::default(), Control::unattended()).expect("nobody cancels")
    }
}

/// Flat sheet on the unit square.
fn flat(columns: u32, rows: u32) -> TriMesh {
    shaped(columns, rows, |x, y| DVec3::new(x / f64::from(columns), y / f64::from(rows), 0.0))
}

/// Tube between two rings, from its angle and its height.
fn tube(around: u32, along: u32, turn: f64) -> TriMesh {
    shaped(around, along, |x, y| {
        let angle = std::f64::consts::TAU * x / f64::from(around) + turn;
        DVec3::new(angle.cos(), angle.sin(), 3.0 * y / f64::from(along))
    })
}

/// Tube whose two sides along the cut share their vertices.
fn closed_tube(around: u32, along: u32, turn: f64) -> TriMesh {
    let mut mesh = tube(around, along, turn);
    let width = around + 1;
    for vertex in mesh.triangles.iter_mut().flatten() {
        if vertex.number() % width == around {
            *vertex = VertexId::new(vertex.number() - around);
        }
    }
    mesh
}

#[test]
fn a_copy_onto_the_own_mesh_is_the_layout_bit_for_bit() {
    for mesh in [ball(12, 8), torus(9, 14), grid(5, 4)] {
        let layout = Layout::unwrapped(&mesh);
        let (copy, copied) = layout.onto(&mesh);
        let bits = |layout: &Layout| -> Vec<[u64; 2]> {
            layout.of_corner.iter().map(|uv| uv.to_array().map(f64::to_bits)).collect()
        };
        assert!(bits(&copy) == bits(&layout));
        assert_eq!(copied.coordinates.len(), layout.coordinates.len());
        assert_eq!(copied.largest_distance, 0.0);
    }
}

#[test]
fn a_linear_layout_of_a_flat_sheet_stays_linear_on_any_other_mesh_of_the_sheet() {
    let place = |p: DVec3| DVec2::new(0.2 + 0.5 * p.x - 0.1 * p.y, 0.3 + 0.2 * p.x + 0.4 * p.y);
    let layout = Layout::by_positions(flat(13, 7), place);
    let other = flat(4, 9);
    let (copy, _) = layout.onto(&other);
    let expected = other.triangles.iter().flatten().map(|vertex| place(other.positions[vertex.index()]));
    let error = copy.of_corner.iter().zip(expected).map(|(uv, wanted)| uv.distance(wanted)).fold(0.0, f64::max);
    assert!(error < 1e-14, "{error:e}");
    let verdict = copy.verdict();
    assert!(verdict.planar && verdict.charts == 1, "{verdict:?}");
}

#[test]
fn the_seam_of_a_tube_is_found_again_wherever_the_edges_of_the_new_mesh_run() {
    let unrolled = |p: DVec3| {
        let turn = p.y.atan2(p.x) / std::f64::consts::TAU;
        DVec2::new(turn.rem_euclid(1.0), p.z / 3.0)
    };
    for (around, along, turn) in [(24, 10, 0.0), (24, 10, 0.1), (11, 4, 0.2), (7, 3, 0.4), (64, 40, 0.03)] {
        let mut layout = Layout::by_positions(tube(32, 12, 0.0), unrolled);
        // The last column lies at one turn, not at none.
        for (vertex, uv) in layout.coordinates.iter_mut().enumerate() {
            if vertex % 33 == 32 {
                uv.x = 1.0;
            }
        }
        let (copy, _) = layout.onto(&closed_tube(around, along, turn));
        let verdict = copy.verdict();
        assert!(verdict.planar && verdict.charts == 1, "{around} {along} {turn}: {verdict:?}");
        for face in copy.of_corner.as_chunks::<3>().0 {
            let span = |k: usize| (face[k].x - face[(k + 1) % 3].x).abs();
            assert!((0..3).all(|k| span(k) < 2.0 / f64::from(around)), "{around} {along} {turn}: {face:?}");
        }
    }
}

#[test]
fn every_vertex_beside_a_flat_sheet_gets_a_coordinate_at_any_height() {
    let at = |mesh: TriMesh, height: f64| {
        let positions = mesh.positions.iter().map(|p| *p + height * DVec3::Z).collect();
        TriMesh { positions, ..mesh }
    };
    for (height, above) in [(0.1, 0.15), (0.3, 0.301), (10.1, 10.3), (0.7, 0.7)] {
        let layout = Layout::by_positions(at(flat(9, 7), height), DVec3::truncate);
        let mesh = PolygonMesh::from(&at(flat(13, 17), above));
        let copied = copy_layout(layout.surface(), &mesh, Control::unattended()).expect("it can be copied");
        assert!(copied.corners.iter().all(|corner| (*corner as usize) < copied.coordinates.len()), "{height} {above}");
        assert!((copied.mean_distance - (above - height)).abs() < 1e-12, "{height} {above}");
    }
}

#[test]
fn charts_of_a_closed_surface_are_copied_to_coarser_and_finer_meshes() {
    let layout = Layout::unwrapped(&ball(40, 26));
    let charts = layout.verdict().charts;
    for (around, rows) in [(24, 15), (61, 40), (40, 26)] {
        let (copy, copied) = layout.onto(&ball(around, rows));
        let verdict = copy.verdict();
        assert!(verdict.planar, "{around} {rows}: {verdict:?}");
        assert_eq!(verdict.charts, charts, "{around} {rows}");
        assert!(copied.largest_distance < 0.02 * copied.diagonal, "{around} {rows}");
    }
}

/// Two flat sheets, the lower one facing down, as the sides of a wall.
fn wall(columns: u32, rows: u32, gap: f64) -> TriMesh {
    let mut mesh = flat(columns, rows);
    let count = u32::try_from(mesh.vertex_count()).expect("few");
    let back: Vec<DVec3> = mesh.positions.iter().map(|p| *p - DVec3::Z * gap).collect();
    mesh.positions.extend(back);
    let turned = |t: &[VertexId; 3]| [t[0], t[2], t[1]].map(|v| VertexId::new(v.number() + count));
    mesh.triangles.extend(mesh.triangles.iter().map(turned).collect::<Vec<_>>());
    mesh
}

/// The mesh with all its faces turned over.
fn inside_out(mesh: TriMesh) -> TriMesh {
    TriMesh { triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..mesh }
}

#[test]
fn both_sides_of_a_thin_wall_keep_their_charts() {
    let place = |p: DVec3| DVec2::new(0.4 * p.x + if p.z < 0.0 { 0.5 } else { 0.0 }, p.y);
    for (gap, is_turned) in [(1e-3, false), (1e-9, false), (1e-3, true), (1e-4, true)] {
        let layout = Layout::by_positions(wall(9, 9, gap), place);
        let new = wall(4, 6, gap);
        let (copy, _) = layout.onto(&if is_turned { inside_out(new) } else { new });
        let verdict = copy.verdict();
        assert!(verdict.charts == 2, "{gap} {is_turned}: {verdict:?}");
        let of_front = &copy.of_corner[..copy.of_corner.len() / 2];
        assert!(of_front.iter().all(|uv| uv.x < 0.45), "{gap} {is_turned}: the front lies on the back's chart");
    }
}

/// Closed shell: a ball of radius 1, and within it a ball that faces inwards.
fn shell(outer: [u32; 2], inner: [u32; 2], thickness: f64) -> TriMesh {
    let mut mesh = ball(outer[0], outer[1]);
    let within = inside_out(ball(inner[0], inner[1]));
    let count = u32::try_from(mesh.vertex_count()).expect("few");
    mesh.positions.extend(within.positions.iter().map(|p| (1.0 - thickness) * *p));
    mesh.triangles.extend(within.triangles.iter().map(|t| t.map(|v| VertexId::new(v.number() + count))));
    mesh
}

#[test]
fn both_sides_of_a_thin_shell_keep_their_charts_whatever_their_numbers_of_faces() {
    // The inner side lies on the right half of the page.
    let place = |thickness: f64| {
        move |p: DVec3| DVec2::new(0.2 * p.x + if p.length() < 1.0 - 0.5 * thickness { 0.75 } else { 0.25 }, p.y)
    };
    for (outer, inner, thickness) in
        [([24, 14], [12, 7], 0.005), ([20, 12], [12, 7], 0.005), ([24, 14], [12, 7], 0.01), ([12, 7], [24, 14], 0.005)]
    {
        let layout = Layout::by_positions(shell([40, 24], [40, 24], thickness), place(thickness));
        let new = shell(outer, inner, thickness);
        let outer_corners = 3 * ball(outer[0], outer[1]).face_count();
        let (copy, _) = layout.onto(&new);
        let (of_outer, of_inner) = copy.of_corner.split_at(outer_corners);
        let wrong = of_outer.iter().filter(|uv| uv.x > 0.5).count() + of_inner.iter().filter(|uv| uv.x < 0.5).count();
        assert!(wrong == 0, "{outer:?} {inner:?} {thickness}: {wrong} corners of the other side");
    }
}

#[test]
fn a_copy_does_not_crack_where_vertices_lie_beside_the_surface_by_rounding() {
    let layout = Layout::unwrapped(&ball(40, 24));
    let coordinates = |mesh: &TriMesh| {
        let (copy, copied) = layout.onto(mesh);
        (copied.coordinates.len(), copy.verdict().charts)
    };
    let (exact, charts) = coordinates(&ball(20, 12));
    for noise in [1e-7, 1e-6, 1e-5] {
        let mut random = Random(5);
        let mut mesh = ball(20, 12);
        for p in &mut mesh.positions {
            *p *= 1.0 + noise * (random.unit() - 0.5);
        }
        let (count, found) = coordinates(&mesh);
        assert!(count <= exact && found == charts, "{noise}: {count} {exact}, {found} {charts}");
    }
    let mut mesh = ball(20, 12);
    for p in &mut mesh.positions {
        *p = p.as_vec3().as_dvec3();
    }
    assert!(coordinates(&mesh).0 <= exact);
}

#[test]
fn an_inside_out_mesh_takes_the_nearest_side_not_the_far_one() {
    let layout = Layout::unwrapped(&ball(16, 10));
    let (copy, copied) = layout.onto(&inside_out(ball(16, 10)));
    assert_eq!(copied.largest_distance, 0.0);
    assert_eq!(copy.verdict().charts, layout.verdict().charts);
}

#[test]
fn a_layout_without_triangles_and_a_cancelled_copy_are_refused() {
    let empty = Layout::by_positions(TriMesh::default(), DVec3::truncate);
    let mesh = PolygonMesh::from(&grid(2, 2));
    let refused = copy_layout(empty.surface(), &mesh, Control::unattended());
    assert_eq!(refused, Err(CopyLayoutError::NoTriangles));
    let layout = Layout::by_positions(grid(3, 3), DVec3::truncate);
    let cancel = AtomicBool::new(true);
    let refused = copy_layout(layout.surface(), &mesh, Control::new(&cancel, &|_| {}));
    assert_eq!(refused, Err(CopyLayoutError::Cancelled));
}
