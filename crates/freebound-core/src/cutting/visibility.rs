//! Visibility of seams: a seam shows less along a crease, and in a place that the rest of its part hides.
//!
//! ```text
//! cost = length · (1 − weight · CREASED · crease) · (1 − weight · HIDDEN · (1 − exposure))
//! ```
//!
//! Other parts hide nothing, because parts may move, and equal parts should get equal seams if they stand alike.
//!
//! *Crease*: 0 on a smooth surface, 1 from an angle of 90° between the normals. *Exposure*: the share of light from all
//! around that reaches a point of the surface (ambient occlusion: Zhukov, Iones, Kronin 1998), with the cosine of the
//! light's angle as weight. Rays follow the light back in directions that are spread evenly, the same at all points, so
//! that the error varies as smoothly as the exposure. A surface can be looked at from either side: if the front gets
//! less than half of the light, the side with more light counts.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, BvhNode};
use bvh::ray::Ray;
use glam::DVec3;
use nalgebra::{Point3, Vector3};

use crate::mesh::{PolygonMesh, Repaired, TriMesh, VertexId};
use crate::parallel::prelude::*;
use crate::problem::{Control, SolveError};

/// Share of the cost that a sharp crease saves.
const CREASED: f64 = 0.4;

/// Share of the cost that a place without light saves.
const HIDDEN: f64 = 0.6;

/// Angles between the normals of two faces at which a crease begins and is sharp, radians: 25° and 90°.
const CREASE: [f64; 2] = [25.0 * std::f64::consts::PI / 180.0, std::f64::consts::FRAC_PI_2];

/// Number of directions, half of them on either side of the surface: fewest and most.
const DIRECTIONS: [usize; 2] = [16, 64];

/// Number of rays of a part above which its points get fewer directions.
const RAYS: usize = 500_000;

/// Exposure of the front from which the back is not looked at.
const LIT: f64 = 0.5;

/// Distance of a ray's start from the surface, relative to the longest side of the box around the part.
const LIFT: f64 = 1e-4;

/// Number of vertices between two looks at the flag that cancels.
const BLOCK: usize = 256;

/// Cost of a seam relative to its length for each edge of a part, in the order of its edge table: at most 1, and least on
/// hidden creases. `weight` is the one of the formula; it is clamped to 0 to 1. `None` if all costs are 1, because the weight
/// is 0 or the part has no extent.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(crate) fn costs_of_shape(
    part: &Repaired,
    weight: f64,
    control: Control<'_>,
) -> Result<Option<Vec<f64>>, SolveError> {
    let weight = weight.clamp(0.0, 1.0);
    // A weight that is no number fails the comparison.
    let polygons = if weight > 0.0 { in_unit_box(part.polygons()) } else { None };
    let Some(polygons) = polygons else { return Ok(None) };
    let normals = face_normals(&polygons);
    let exposures = Visibility::new(&polygons.triangulate()).exposures(&polygons, &normals, control)?;
    let cost = |(faces, ([a, b], _)): (Vec<u32>, ([VertexId; 2], usize))| {
        let exposure = f64::midpoint(exposures[a.index()], exposures[b.index()]);
        let crease = match faces[..] {
            [a, b] => crease(normals[a as usize], normals[b as usize]),
            _ => 0.0,
        };
        (1.0 - weight * CREASED * crease) * (1.0 - weight * HIDDEN * (1.0 - exposure))
    };
    Ok(Some(part.faces_of_edges().into_iter().zip(part.edges_with_sides()).map(cost).collect()))
}

/// The polygons moved into a box whose longest side is 1, so that no product overflows or vanishes. `None` if they have
/// no extent.
fn in_unit_box(polygons: &PolygonMesh) -> Option<PolygonMesh> {
    let used = || polygons.corners.iter().map(|vertex| polygons.positions[vertex.index()]);
    let low = used().fold(DVec3::INFINITY, DVec3::min);
    let high = used().fold(DVec3::NEG_INFINITY, DVec3::max);
    // Halves cannot overflow.
    let half_side = (0.5 * high - 0.5 * low).max_element();
    let middle = 0.5 * low + 0.5 * high;
    let place = |at: &DVec3| 0.5 * ((0.5 * *at - 0.5 * middle) / half_side);
    let is_usable = half_side.is_finite() && half_side > 0.0;
    let PolygonMesh { positions, corners, starts } = polygons;
    is_usable.then(|| PolygonMesh {
        positions: positions.iter().map(place).collect(),
        corners: corners.clone(),
        starts: starts.clone(),
    })
}

/// Light around a part, which its own faces keep from places.
struct Visibility {
    faces: Vec<Face>,
    tree: Bvh<f64, 3>,
}

/// Face that rays may hit.
struct Face {
    corners: [DVec3; 3],
    node: usize,
}

impl Bounded<f64, 3> for Face {
    fn aabb(&self) -> Aabb<f64, 3> {
        let [a, b, c] = self.corners;
        Aabb::with_bounds(point(a.min(b).min(c)), point(a.max(b).max(c)))
    }
}

impl BHShape<f64, 3> for Face {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Face {
    /// True if a ray hits the face from either side (Möller and Trumbore 1997).
    fn is_hit(&self, origin: DVec3, direction: DVec3) -> bool {
        let [first, second, third] = self.corners;
        let (u_axis, v_axis, from) = (second - first, third - first, origin - first);
        let across = direction.cross(v_axis);
        let volume = u_axis.dot(across);
        let beside = from.cross(u_axis);
        let [u, v, far] = [from.dot(across), direction.dot(beside), v_axis.dot(beside)].map(|part| part / volume);
        // A ray within the plane of a face has no volume. Some comparison fails then.
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && far > 0.0
    }
}

impl Visibility {
    fn new(mesh: &TriMesh) -> Self {
        let corners = |face: &[VertexId; 3]| face.map(|vertex| mesh.positions[vertex.index()]);
        let mut faces: Vec<Face> = mesh.triangles.iter().map(|face| Face { corners: corners(face), node: 0 }).collect();
        let tree = Bvh::build(&mut faces);
        Self { faces, tree }
    }

    /// Exposure of each vertex, from 0 to 1.
    fn exposures(
        &self,
        polygons: &PolygonMesh,
        normals: &[DVec3],
        control: Control<'_>,
    ) -> Result<Vec<f64>, SolveError> {
        let mut at_vertex = vec![DVec3::ZERO; polygons.positions.len()];
        for (face, normal) in normals.iter().enumerate() {
            polygons.face(face).iter().for_each(|vertex| at_vertex[vertex.index()] += *normal);
        }
        let places: Vec<(DVec3, DVec3)> = polygons.positions.iter().copied().zip(at_vertex).collect();
        let [fewest, most] = DIRECTIONS;
        let directions = directions((RAYS / places.len().max(1)).clamp(fewest, most));
        let block = |places: &[(DVec3, DVec3)]| {
            control.go_on()?;
            let light = |&(at, normal): &(DVec3, DVec3)| self.exposure(at, normal.normalize_or_zero(), &directions);
            Ok(places.iter().map(light).collect())
        };
        let blocks: Vec<Result<Vec<f64>, SolveError>> = places.par_chunks(BLOCK).map(block).collect();
        Ok(blocks.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Exposure of a point with a normal. A point without a normal is fully exposed.
    fn exposure(&self, at: DVec3, normal: DVec3, directions: &[DVec3]) -> f64 {
        if normal == DVec3::ZERO {
            return 1.0;
        }
        let mut open = Vec::new();
        let mut from = |outward: DVec3| {
            let (mut light, mut all) = (0.0, 0.0);
            for &direction in directions {
                let cosine = direction.dot(outward).max(0.0);
                all += cosine;
                if cosine > 0.0 && !self.is_blocked(at + LIFT * outward, direction, &mut open) {
                    light += cosine;
                }
            }
            light / all
        };
        let front = from(normal);
        if front >= LIT { front } else { front.max(from(-normal)) }
    }

    /// True if a ray hits a face. `open` is memory for nodes of the tree.
    fn is_blocked(&self, origin: DVec3, direction: DVec3, open: &mut Vec<usize>) -> bool {
        let ray = Ray::new(point(origin), Vector3::new(direction.x, direction.y, direction.z));
        open.clear();
        open.extend((!self.tree.nodes.is_empty()).then_some(0));
        while let Some(node) = open.pop() {
            match &self.tree.nodes[node] {
                BvhNode::Leaf { shape_index, .. } => {
                    if self.faces[*shape_index].is_hit(origin, direction) {
                        return true;
                    }
                }
                BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. } => {
                    let children = [(child_l_index, child_l_aabb), (child_r_index, child_r_aabb)];
                    open.extend(children.iter().filter(|(_, bounds)| ray.intersects_aabb(bounds)).map(|(at, _)| **at));
                }
            }
        }
        false
    }
}

fn point(at: DVec3) -> Point3<f64> {
    Point3::new(at.x, at.y, at.z)
}

/// Directions that are spread evenly over the sphere: a Fibonacci lattice. None lies in the plane of two axes.
fn directions(count: usize) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let direction = |number: usize| {
        let height = 1.0 - (2 * number + 1) as f64 / count as f64;
        let (sine, cosine) = (golden * (number as f64 + 0.5)).sin_cos();
        let radius = (1.0 - height * height).sqrt();
        DVec3::new(radius * cosine, radius * sine, height)
    };
    (0..count).map(direction).collect()
}

/// Unit normals of the faces; zero for a face without area.
fn face_normals(polygons: &PolygonMesh) -> Vec<DVec3> {
    (0..polygons.face_count()).map(|face| polygons.face_normal(face)).collect()
}

/// Sharpness of the crease between two faces, from 0 to 1.
fn crease(first: DVec3, last: DVec3) -> f64 {
    let angle = first.cross(last).length().atan2(first.dot(last));
    ((angle - CREASE[0]) / (CREASE[1] - CREASE[0])).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Preparation;

    /// Two squares that meet in an edge at an angle, in radians, each of 2 × 2 faces beside the edge and far larger than
    /// the distance between the vertices on the edge. The vertices on the edge have the numbers 0, 1 and 2.
    fn folded(angle: f64) -> PolygonMesh {
        let far = 100.0;
        let [left, right] = [-1.0, 1.0].map(|side: f64| {
            let (sine, cosine) = (0.5 * angle).sin_cos();
            [far * side * sine, far * cosine]
        });
        let row = |[x, z]: [f64; 2]| [-far, 0.0, far].map(|y| [x, y, z]);
        let positions = [row([0.0, 0.0]), row(left), row(right)].concat();
        PolygonMesh::from_arrays(&positions, &[[3, 0, 1, 4], [4, 1, 2, 5], [0, 6, 7, 1], [1, 7, 8, 2]])
    }

    fn costs(mesh: &PolygonMesh, weight: f64) -> Vec<f64> {
        let part = Preparation::default().repaired_along(mesh, None);
        let shape = costs_of_shape(&part, weight, Control::unattended()).unwrap();
        shape.unwrap_or_else(|| vec![1.0; part.edges_with_sides().len()])
    }

    fn exposures(mesh: &PolygonMesh) -> Vec<f64> {
        let mesh = in_unit_box(mesh).expect("an extent");
        let normals = face_normals(&mesh);
        Visibility::new(&mesh.triangulate()).exposures(&mesh, &normals, Control::unattended()).unwrap()
    }

    #[test]
    fn the_light_in_a_valley_is_the_sine_of_half_its_angle() {
        // The walls end at a distance, which lets little light in from the ends.
        for degrees in [75.0_f64, 90.0, 120.0, 180.0] {
            let exposure = exposures(&folded(degrees.to_radians()))[1];
            let exact = (0.5 * degrees).to_radians().sin();
            let at_ends = if degrees < 180.0 { 0.15 } else { 0.0 };
            assert!(exposure > exact - 0.06 && exposure < exact + 0.06 + at_ends, "{degrees}: {exposure} {exact}");
        }
    }

    #[test]
    fn a_sharp_crease_costs_less_than_a_flat_edge_and_nothing_counts_without_a_weight() {
        let of_edge = |degrees: f64, weight: f64| {
            let mesh = folded(degrees.to_radians());
            let part = Preparation::default().repaired_along(&mesh, None);
            let costs = costs(&mesh, weight);
            let at = part
                .edges_with_sides()
                .iter()
                .position(|([a, b], _)| [*a, *b].iter().all(|v| mesh.positions[v.index()].x == 0.0));
            costs[at.expect("the edge between the squares")]
        };
        let [sharp, blunt, flat] = [90.0, 130.0, 180.0].map(|degrees| of_edge(degrees, 1.0));
        assert!(sharp < blunt && blunt < flat, "{sharp} {blunt} {flat}");
        assert!((flat - 1.0).abs() < 1e-9);
        let without = costs(&folded(1.0), 0.0);
        assert_eq!(without, vec![1.0; without.len()]);
    }

    #[test]
    fn costs_do_not_depend_on_the_unit_of_length() {
        let scaled = |scale: f64| {
            let mut mesh = folded(1.4);
            mesh.positions.iter_mut().for_each(|at| *at *= scale);
            costs(&mesh, 1.0)
        };
        let usual = scaled(1.0);
        for scale in [2.0_f64.powi(-900), 2.0_f64.powi(-300), 2.0_f64.powi(300), 2.0_f64.powi(1010)] {
            let costs = scaled(scale);
            assert!(costs.iter().zip(&usual).all(|(a, b)| (a - b).abs() < 1e-9), "{scale:e}: {costs:?} {usual:?}");
        }
    }

    #[test]
    fn weights_beyond_the_range_and_parts_without_extent_keep_costs_above_zero() {
        let mesh = folded(1.0);
        assert_eq!(costs(&mesh, 3.0), costs(&mesh, 1.0));
        for weight in [-1.0, f64::NAN] {
            assert_eq!(costs(&mesh, weight), costs(&mesh, 0.0));
        }
        let point = PolygonMesh::from_arrays(&[[1.0; 3]; 3], &[[0, 1, 2]]);
        assert!(in_unit_box(&point).is_none());
    }
}
