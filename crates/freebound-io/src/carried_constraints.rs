//! Constraints of one mesh, carried to another mesh of the surface.

use std::collections::BTreeSet;

use glam::DVec3;
use serde::Serialize;

use super::bake::FAR_APART;
use super::{Constraints, MeshFile, Registration};
use freebound_core::mesh::{FaceId, TriMesh, VertexId};
use freebound_core::pipeline::SurfaceSearch;

/// Constraints for the vertices of another mesh, with their correspondence.
#[derive(Clone, Debug)]
pub struct CarriedConstraints {
    /// Constraints for the other mesh.
    pub constraints: Constraints,
    /// Vertices of the constraints on both meshes, in the order of the old vertices.
    pub moves: Vec<CarriedVertex>,
    /// Summary.
    pub report: CarryReport,
}

/// Vertex of a constraint on both meshes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CarriedVertex {
    /// Vertex of the old mesh.
    pub from: VertexId,
    /// Vertex of the new mesh. `None` if the constraint is lost, because others took all vertices near its place.
    pub to: Option<VertexId>,
    /// Distance between both, mesh units.
    pub distance: f64,
}

/// Summary of carried constraints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CarryReport {
    /// True if both meshes have the same faces, so that every vertex keeps its number.
    pub same_faces: bool,
    /// Number of constraints for the new mesh.
    pub count: usize,
    /// Vertices of the old mesh whose constraints are lost.
    pub lost: Vec<VertexId>,
    /// Largest distance between a vertex of the old mesh and its vertex of the new mesh, mesh units.
    pub largest_distance: f64,
    /// Diagonal of the box around the new mesh, mesh units.
    pub diagonal: f64,
}

impl CarryReport {
    /// True if some vertices are farther apart than 5 % of the diagonal.
    pub fn is_apart(&self) -> bool {
        !self.same_faces && self.largest_distance > FAR_APART * self.diagonal
    }
}

/// Carries constraints from an old mesh to a new one.
///
/// If both have the same faces, vertices keep their numbers. Otherwise each constraint goes to the corner of the nearest
/// triangle that is nearest to its vertex, on the side of the surface that its vertex has. Two constraints never share a
/// vertex: the one farther away takes another corner of its triangle, or is lost.
pub fn carried_constraints(
    constraints: &Constraints,
    old: &MeshFile,
    new: &MeshFile,
    registration: Registration,
) -> CarriedConstraints {
    let [from, to] = [old, new].map(|mesh| &mesh.polygons);
    let surface = to.triangulate();
    let search = SurfaceSearch::new(&surface);
    let same_faces = from.corners == to.corners && from.starts == to.starts;
    let moves = if same_faces {
        kept(constraints)
    } else {
        nearest(constraints, &from.triangulate(), &search, &surface, registration)
    };
    let carried = moves.iter().filter_map(|&CarriedVertex { from, to, .. }| Some((from, to?)));
    let mut placed = Constraints::default();
    for (before, after) in carried {
        placed.targets.extend(constraints.targets.get(&before).map(|&target| (after, target)));
        placed.lines.extend(constraints.lines.get(&before).map(|&line| (after, line)));
        placed.notes.extend(constraints.notes.get(&before).cloned().map(|note| (after, note)));
    }
    let report = CarryReport {
        same_faces,
        count: placed.targets.len(),
        lost: moves.iter().filter(|carried| carried.to.is_none()).map(|carried| carried.from).collect(),
        largest_distance: moves.iter().filter(|carried| carried.to.is_some()).map(|it| it.distance).fold(0.0, f64::max),
        diagonal: search.diagonal(),
    };
    CarriedConstraints { constraints: placed, moves, report }
}

/// Every vertex with its number.
fn kept(constraints: &Constraints) -> Vec<CarriedVertex> {
    constraints.targets.keys().map(|&from| CarriedVertex { from, to: Some(from), distance: 0.0 }).collect()
}

/// Vertices at the nearest corners, those with the least distances first.
fn nearest(
    constraints: &Constraints,
    old: &TriMesh,
    search: &SurfaceSearch<'_>,
    surface: &TriMesh,
    registration: Registration,
) -> Vec<CarriedVertex> {
    let used = surface.triangles.iter().flatten().map(|vertex| surface.positions[vertex.index()]);
    let old = registration.applied(old, used);
    let middle = |face: usize| {
        let face = FaceId::from_index(face);
        (old.corners(face).iter().sum::<DVec3>() / 3.0, old.double_area_vector(face))
    };
    let sense = search.sense(old.face_count(), middle);
    let normals = normals_at(&old, constraints);
    // Corners of the nearest triangle of each constraint, the nearest first.
    let mut offers: Vec<(VertexId, Vec<(f64, VertexId)>)> = Vec::new();
    for (&from, normal) in constraints.targets.keys().zip(normals) {
        let place = old.positions.get(from.index()).copied().unwrap_or(DVec3::NAN);
        let mut corners: Vec<(f64, VertexId)> = match search.nearest(place, sense * normal, None) {
            None => Vec::new(),
            Some(found) => surface.triangles[found.triangle as usize]
                .iter()
                .map(|&corner| (surface.positions[corner.index()].distance(place), corner))
                .collect(),
        };
        corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        offers.push((from, corners));
    }
    let distance = |corners: &[(f64, VertexId)]| corners.first().map_or(f64::INFINITY, |first| first.0);
    offers.sort_by(|(a, near_a), (b, near_b)| distance(near_a).total_cmp(&distance(near_b)).then(a.cmp(b)));
    let mut taken = BTreeSet::new();
    let mut moves: Vec<CarriedVertex> = Vec::new();
    for (from, corners) in offers {
        let free = corners.iter().find(|(_, corner)| taken.insert(*corner));
        let (distance, to) = free.map_or((0.0, None), |&(distance, corner)| (distance, Some(corner)));
        moves.push(CarriedVertex { from, to, distance });
    }
    moves.sort_by_key(|carried| carried.from);
    moves
}

/// Normals of a surface at the vertices of constraints, weighted by area.
fn normals_at(surface: &TriMesh, constraints: &Constraints) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; surface.positions.len()];
    for (face, corners) in surface.triangles.iter().enumerate() {
        let area = surface.double_area_vector(FaceId::from_index(face));
        for corner in corners {
            normals[corner.index()] += area;
        }
    }
    let normal = |vertex: &VertexId| normals.get(vertex.index()).copied().unwrap_or_default();
    constraints.targets.keys().map(normal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use freebound_core::mesh::PolygonMesh;
    use freebound_core::pipeline::Target;
    use freebound_testkit::shaped;
    use glam::DVec2;

    /// Bent sheet with this many squares along each side, of one size, moved and scaled.
    fn sheet(side: u32, place: DVec3, scale: f64) -> MeshFile {
        let step = 12.0 / f64::from(side);
        let bent = |x: f64, y: f64| place + scale * DVec3::new(x * step, y * step, (x * step * 0.4).sin());
        let mesh = shaped(side, side, bent);
        let faces: Vec<[u32; 3]> = mesh.triangles.iter().map(|corners| corners.map(VertexId::number)).collect();
        let positions: Vec<[f64; 3]> = mesh.positions.iter().map(DVec3::to_array).collect();
        MeshFile::from(PolygonMesh::from_arrays(&positions, &faces))
    }

    fn constraints(vertices: &[u32]) -> Constraints {
        let line = |vertex: &u32| format!("{vertex} {vertex}.5 0.25 # pin {vertex}");
        let lines = vertices.iter().map(line).collect::<Vec<_>>().join("\n");
        Constraints::parse(&lines, 1000).expect("constraints")
    }

    fn moves(carried: &CarriedConstraints) -> Vec<(u32, Option<u32>)> {
        carried.moves.iter().map(|it| (it.from.number(), it.to.map(VertexId::number))).collect()
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
        assert!(carried.report.largest_distance < 1e-12);
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
    fn constraints_share_no_vertex_of_a_coarse_mesh_and_those_without_room_are_lost() {
        let [fine, coarse] = [12, 1].map(|side| sheet(side, DVec3::ZERO, 1.0));
        // Five neighbours at one corner, but no triangle has more than three corners.
        let old = constraints(&[0, 1, 2, 13, 14]);
        let carried = carried_constraints(&old, &fine, &coarse, Registration::AsTheyAre);
        let taken: Vec<u32> = moves(&carried).into_iter().filter_map(|(_, to)| to).collect();
        assert_eq!(moves(&carried)[0], (0, Some(0)), "the nearest one comes first");
        assert_eq!(taken.iter().collect::<BTreeSet<_>>().len(), taken.len());
        assert_eq!(carried.report.count + carried.report.lost.len(), 5);
        assert!(!carried.report.lost.is_empty());
    }
}
