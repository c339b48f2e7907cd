//! Constraints of one mesh, carried to another mesh of the surface.

use std::collections::BTreeSet;

use glam::DVec3;
use serde::Serialize;

use super::bake::FAR_APART;
use super::{Constraints, Registration};
use freebound_core::geom::SpaceBounds;
use freebound_core::mesh::{FaceId, PolygonMesh, TriMesh, VertexId};
use freebound_core::pipeline::SurfaceSearch;

/// Constraints for the vertices of another mesh, with their correspondence.
#[derive(Clone, Debug)]
pub struct CarriedConstraints {
    /// Constraints for the other mesh.
    pub constraints: Constraints,
    /// Summary.
    pub report: CarryReport,
}

/// Vertex of a constraint on both meshes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CarriedVertex {
    /// Vertex of the old mesh.
    pub from: VertexId,
    /// Vertex of the new mesh. `None` if the constraint is lost, because no free vertex is near.
    pub to: Option<VertexId>,
    /// Distance between both, mesh units; 0 for a lost constraint.
    pub distance: f64,
}

/// Summary of carried constraints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CarryReport {
    /// True if both meshes have the same faces, so that every vertex keeps its number.
    pub same_faces: bool,
    /// Number of constraints for the new mesh.
    pub count: usize,
    /// Vertices of the constraints on both meshes, in the order of the old vertices.
    pub vertices: Vec<CarriedVertex>,
    /// Largest distance of a vertex of the old mesh from the surface of the new one, mesh units. Absent for meshes with
    /// the same faces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_gap: Option<f64>,
    /// Diagonal of the box around the new mesh, mesh units.
    pub diagonal: f64,
}

impl CarryReport {
    /// True if some vertices are farther from the surface of the new mesh than 5 % of its diagonal.
    pub fn is_apart(&self) -> bool {
        self.largest_gap.is_some_and(|gap| gap > FAR_APART * self.diagonal)
    }

    /// Vertices of the old mesh whose constraints are lost.
    pub fn lost(&self) -> Vec<VertexId> {
        self.vertices.iter().filter(|carried| carried.to.is_none()).map(|carried| carried.from).collect()
    }

    /// A distance in percent of the diagonal.
    pub fn percent(&self, distance: f64) -> f64 {
        if self.diagonal > 0.0 { 100.0 * distance / self.diagonal } else { 0.0 }
    }

    /// Largest distance between both vertices of a constraint, in percent of the diagonal.
    pub fn largest_percent(&self) -> f64 {
        self.percent(self.vertices.iter().map(|carried| carried.distance).fold(0.0, f64::max))
    }
}

/// Carries constraints from an old mesh to a new one.
///
/// If both have the same faces, in either orientation, vertices keep their numbers. Otherwise each constraint goes to the
/// corner of the nearest triangle that is nearest to its vertex, on the side of the surface that its vertex has. Two
/// constraints never share a vertex: the one farther away takes the nearest free vertex within 5 % of the diagonal, on the
/// same side, or is lost.
pub fn carried_constraints(
    constraints: &Constraints,
    old: &PolygonMesh,
    new: &PolygonMesh,
    registration: Registration,
) -> CarriedConstraints {
    let is_same = |old: &PolygonMesh| old.corners == new.corners && old.starts == new.starts;
    let same_faces = is_same(old) || is_same(&old.turned());
    let used: BTreeSet<VertexId> = new.corners.iter().copied().collect();
    let diagonal = SpaceBounds::of(used.iter().map(|vertex| new.positions[vertex.index()])).diagonal();
    let (vertices, largest_gap) = if same_faces {
        (with_their_numbers(constraints, [old, new], &used), None)
    } else {
        let (vertices, gap) = nearest(constraints, &old.triangulate(), &new.triangulate(), registration);
        (vertices, Some(gap))
    };
    let mut carried = Constraints::default();
    for (before, after) in vertices.iter().filter_map(|&CarriedVertex { from, to, .. }| Some((from, to?))) {
        carried.targets.extend(constraints.targets.get(&before).map(|&target| (after, target)));
        carried.lines.extend(constraints.lines.get(&before).map(|&line| (after, line)));
        carried.notes.extend(constraints.notes.get(&before).cloned().map(|note| (after, note)));
    }
    let count = carried.targets.len();
    CarriedConstraints {
        constraints: carried,
        report: CarryReport { same_faces, count, vertices, largest_gap, diagonal },
    }
}

/// Every vertex with its number, if the faces of the new mesh use it.
fn with_their_numbers(
    constraints: &Constraints,
    [old, new]: [&PolygonMesh; 2],
    used: &BTreeSet<VertexId>,
) -> Vec<CarriedVertex> {
    let carried = |&from: &VertexId| {
        let to = used.contains(&from).then_some(from);
        let [before, after] = [old, new].map(|mesh| mesh.positions.get(from.index()).copied());
        let distance = to.and(before.zip(after)).map_or(0.0, |(before, after)| before.distance(after));
        CarriedVertex { from, to, distance }
    };
    constraints.targets.keys().map(carried).collect()
}

/// Place of a constraint beside the new surface.
struct ConstraintPlace {
    vertex: VertexId,
    position: DVec3,
    /// Normal of the old surface there, with the orientation of the new one.
    normal: DVec3,
    /// Corners of the nearest triangle with their distances, the nearest first.
    corners: Vec<(f64, VertexId)>,
}

impl ConstraintPlace {
    fn distance(&self) -> f64 {
        self.corners.first().map_or(f64::INFINITY, |first| first.0)
    }
}

/// Vertices at the nearest corners, and the largest distance from the new surface. Constraints with the least distances
/// come first.
fn nearest(
    constraints: &Constraints,
    old: &TriMesh,
    surface: &TriMesh,
    registration: Registration,
) -> (Vec<CarriedVertex>, f64) {
    let search = SurfaceSearch::new(surface);
    let used = surface.triangles.iter().flatten().map(|vertex| surface.positions[vertex.index()]);
    let old = registration.applied(old, used);
    let oriented = |face: usize| {
        let face = FaceId::from_index(face);
        (old.corners(face).iter().sum::<DVec3>() / 3.0, old.double_area_vector(face))
    };
    let sense = search.sense(old.face_count(), oriented);
    let normals = normals(&old);
    let mut gap = 0.0_f64;
    let place = |&vertex: &VertexId| {
        let position = old.positions.get(vertex.index()).copied().unwrap_or(DVec3::NAN);
        let normal = sense * normals.get(vertex.index()).copied().unwrap_or_default();
        let mut corners = Vec::new();
        if let Some(found) = search.nearest(position, normal, None) {
            gap = gap.max(found.distance_squared.sqrt());
            let distance = |corner: VertexId| surface.positions[corner.index()].distance(position);
            corners.extend(surface.triangles[found.triangle as usize].map(|corner| (distance(corner), corner)));
        }
        corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        ConstraintPlace { vertex, position, normal, corners }
    };
    let mut places: Vec<ConstraintPlace> = constraints.targets.keys().map(place).collect();
    places.sort_by(|a, b| a.distance().total_cmp(&b.distance()).then(a.vertex.cmp(&b.vertex)));
    let mut taken = BTreeSet::new();
    let mut vertices: Vec<CarriedVertex> = Vec::new();
    for place in places {
        let corner = place.corners.iter().find(|(_, corner)| !taken.contains(corner)).copied();
        let free = corner.or_else(|| nearest_free(surface, &place, FAR_APART * search.diagonal(), &taken));
        let (distance, to) = free.map_or((0.0, None), |(distance, vertex)| (distance, Some(vertex)));
        taken.extend(to);
        vertices.push(CarriedVertex { from: place.vertex, to, distance });
    }
    vertices.sort_by_key(|carried| carried.from);
    (vertices, gap)
}

/// Nearest vertex within a distance that no other constraint has, on the side of the surface that a constraint has.
fn nearest_free(
    surface: &TriMesh,
    place: &ConstraintPlace,
    most: f64,
    taken: &BTreeSet<VertexId>,
) -> Option<(f64, VertexId)> {
    let normals = normals(surface);
    let used: BTreeSet<VertexId> = surface.triangles.iter().flatten().copied().collect();
    let is_free = |vertex: &VertexId| !taken.contains(vertex) && normals[vertex.index()].dot(place.normal) >= 0.0;
    let distance = |vertex: VertexId| (surface.positions[vertex.index()].distance(place.position), vertex);
    let near = used.into_iter().filter(is_free).map(distance).filter(|(distance, _)| *distance <= most);
    near.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Normals of a surface at its vertices, weighted by area.
fn normals(surface: &TriMesh) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; surface.positions.len()];
    for (face, corners) in surface.triangles.iter().enumerate() {
        let area = surface.double_area_vector(FaceId::from_index(face));
        for corner in corners {
            normals[corner.index()] += area;
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;
    use freebound_core::pipeline::Target;
    use freebound_testkit::shaped;
    use glam::DVec2;

    /// Bent sheet with this many squares along each side, of one size, moved and scaled.
    fn sheet(side: u32, place: DVec3, scale: f64) -> PolygonMesh {
        let step = 12.0 / f64::from(side);
        let bent = |x: f64, y: f64| place + scale * DVec3::new(x * step, y * step, (x * step * 0.4).sin());
        let mesh = shaped(side, side, bent);
        let faces: Vec<[u32; 3]> = mesh.triangles.iter().map(|corners| corners.map(VertexId::number)).collect();
        let positions: Vec<[f64; 3]> = mesh.positions.iter().map(DVec3::to_array).collect();
        PolygonMesh::from_arrays(&positions, &faces)
    }

    fn constraints(vertices: &[u32]) -> Constraints {
        let line = |vertex: &u32| format!("{vertex} {vertex}.5 0.25 # pin {vertex}");
        let lines = vertices.iter().map(line).collect::<Vec<_>>().join("\n");
        Constraints::parse(&lines, 20_000).expect("constraints")
    }

    fn moves(carried: &CarriedConstraints) -> Vec<(u32, Option<u32>)> {
        carried.report.vertices.iter().map(|it| (it.from.number(), it.to.map(VertexId::number))).collect()
    }

    #[test]
    fn vertices_of_equal_faces_keep_their_numbers_however_the_mesh_was_bent() {
        let old = constraints(&[0, 17, 40]);
        let far = sheet(6, DVec3::new(100.0, 0.0, 0.0), 3.0);
        let carried = carried_constraints(&old, &sheet(6, DVec3::ZERO, 1.0), &far, Registration::AsTheyAre);
        assert_eq!((carried.constraints.targets, carried.constraints.notes), (old.targets, old.notes));
        assert!(carried.report.same_faces && !carried.report.is_apart());
    }

    #[test]
    fn constraints_go_to_the_same_places_of_a_finer_mesh_with_their_names() {
        // Every vertex of the coarse sheet lies on a vertex of the fine one.
        let [coarse, fine] = [4, 12].map(|side| sheet(side, DVec3::ZERO, 1.0));
        let old = constraints(&[0, 7, 12, 24]);
        let carried = carried_constraints(&old, &coarse, &fine, Registration::AsTheyAre);
        let on_fine = |vertex: u32| 13 * 3 * (vertex / 5) + 3 * (vertex % 5);
        let expected: Vec<_> = [0, 7, 12, 24].map(|vertex| (vertex, Some(on_fine(vertex)))).into();
        assert_eq!(moves(&carried), expected);
        let target = carried.constraints.targets[&VertexId::new(on_fine(12))];
        assert_eq!(target, Target { uv: DVec2::new(12.5, 0.25), ..target });
        let name = carried.constraints.notes[&VertexId::new(on_fine(12))].name.clone().expect("a name");
        assert_eq!(name.to_string(), "pin 12");
        assert!(carried.report.largest_percent() < 1e-9 && carried.report.largest_gap < Some(1e-12));
    }

    #[test]
    fn a_moved_and_scaled_mesh_is_fitted_if_that_is_asked_for() {
        let (coarse, fine) = (sheet(4, DVec3::ZERO, 1.0), sheet(12, DVec3::new(50.0, 9.0, -3.0), 0.01));
        let old = constraints(&[0, 7, 12, 24]);
        let apart = carried_constraints(&old, &coarse, &fine, Registration::AsTheyAre);
        assert!(apart.report.is_apart());
        let fitted = carried_constraints(&old, &coarse, &fine, Registration::ByBox);
        let expected = carried_constraints(&old, &coarse, &sheet(12, DVec3::ZERO, 1.0), Registration::AsTheyAre);
        assert_eq!(moves(&fitted), moves(&expected));
        assert!(!fitted.report.is_apart());
    }

    #[test]
    fn reversed_faces_are_the_same_faces() {
        let old = constraints(&[0, 17, 40]);
        let turned = sheet(6, DVec3::ZERO, 1.0).turned();
        let carried = carried_constraints(&old, &sheet(6, DVec3::ZERO, 1.0), &turned, Registration::AsTheyAre);
        assert!(carried.report.same_faces);
        assert_eq!(carried.constraints.targets, old.targets);
    }

    #[test]
    fn a_vertex_that_the_new_faces_do_not_use_loses_its_constraint() {
        let (old, mesh) = (constraints(&[3, 49, 50]), sheet(6, DVec3::ZERO, 1.0));
        let mut with_more = mesh.clone();
        with_more.positions.extend([DVec3::ZERO; 2]);
        let carried = carried_constraints(&old, &with_more, &mesh, Registration::AsTheyAre);
        assert_eq!(moves(&carried), [(3, Some(3)), (49, None), (50, None)]);
        assert_eq!(carried.report.lost(), [49, 50].map(VertexId::new));
        let empty = PolygonMesh::default();
        let carried = carried_constraints(&old, &with_more, &empty, Registration::ByBox);
        assert!(carried.constraints.targets.is_empty() && carried.report.largest_percent() == 0.0);
    }

    #[test]
    fn constraints_share_no_vertex_and_those_without_a_free_one_near_are_lost() {
        let [fine, coarse] = [12, 4].map(|side| sheet(side, DVec3::ZERO, 1.0));
        // All vertices of the fine sheet between two rows of the coarse one want few corners.
        let crowd: Vec<u32> = (0..13 * 4).collect();
        let carried = carried_constraints(&constraints(&crowd), &fine, &coarse, Registration::AsTheyAre);
        let taken: Vec<u32> = moves(&carried).into_iter().filter_map(|(_, to)| to).collect();
        assert_eq!(moves(&carried)[0], (0, Some(0)), "the nearest one comes first");
        assert_eq!(taken.iter().collect::<BTreeSet<_>>().len(), taken.len());
        assert_eq!(carried.report.count + carried.report.lost().len(), crowd.len());
        assert!(!carried.report.lost().is_empty() && carried.report.count >= 10);
    }

    #[test]
    fn a_crowd_at_one_place_takes_the_free_vertices_around() {
        // Five vertices of a very fine sheet lie at one corner of a triangle, and its corners are three.
        let [fine, coarse] = [120, 60].map(|side| sheet(side, DVec3::ZERO, 1.0));
        let middle = 121 * 60 + 60;
        let old = constraints(&[middle, middle + 1, middle - 1, middle + 121, middle - 121]);
        let carried = carried_constraints(&old, &fine, &coarse, Registration::AsTheyAre);
        assert!(carried.report.lost().is_empty() && carried.report.count == 5);
    }
}
