//! Closed ball with bumps or folds, cut open along long random seams.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::iter::successors;

use glam::{DVec3, IVec3};

use super::Random;
use freebound_core::mesh::{TriMesh, VertexId};

/// Roughness of a ball.
#[derive(Clone, Copy, Debug)]
pub enum Relief {
    /// Gentle bumps.
    Bumps,
    /// Deep furrows with steep walls.
    Folds,
}

/// Largest move of a vertex along the ball, as a share of the mean edge.
const JITTER: f64 = 0.25;

/// Ball of 8 `cells`² faces, cut open along a tree of `seam_edges` edges that reaches everywhere. The result is a
/// disk with 2 · `seam_edges` boundary edges.
pub fn seamed_ball(cells: i32, seam_edges: usize, relief: Relief, seed: u64) -> TriMesh {
    let mut random = Random(seed);
    let closed = ball(cells, relief, &mut random);
    let seams = random_tree(&closed, seam_edges, &mut random);
    cut_open(&closed, &seams)
}

/// Octahedron with `cells`² triangles in each face, blown up to a ball.
fn ball(cells: i32, relief: Relief, random: &mut Random) -> TriMesh {
    let mut numbers = BTreeMap::new();
    let mut positions = Vec::new();
    let mut number = |at: IVec3| {
        *numbers.entry(at.to_array()).or_insert_with(|| {
            let jitter = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
            let out = (at.as_dvec3() + 2.0 * JITTER * jitter).normalize_or_zero();
            positions.push(out * radius(out, relief));
            u32::try_from(positions.len() - 1).expect("a vertex fits")
        })
    };
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let sign = IVec3::new(1 - 2 * (octant & 1), 1 - (octant & 2), 1 - (octant & 4) / 2);
        for (a, b) in (0..cells).flat_map(|a| (0..cells - a).map(move |b| (a, b))) {
            let at = |a: i32, b: i32| sign * IVec3::new(a, b, cells - a - b);
            let mut faces = vec![[at(a, b), at(a + 1, b), at(a, b + 1)]];
            if a + b + 1 < cells {
                faces.push([at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)]);
            }
            for mut face in faces {
                if sign.element_product() < 0 {
                    face.swap(0, 1);
                }
                triangles.push(face.map(&mut number));
            }
        }
    }
    TriMesh::new(positions, &triangles)
}

/// Distance of the surface from the centre, in a direction.
fn radius(out: DVec3, relief: Relief) -> f64 {
    let wave = |by: f64| (by * out.x + 0.7).sin() * (by * out.y - 0.4).sin() + (by * out.z + 1.1).sin();
    match relief {
        Relief::Bumps => 1.0 + 0.12 * wave(3.0) + 0.04 * wave(8.0),
        Relief::Folds => 1.0 + 0.18 * (4.0 * wave(4.0)).tanh() + 0.08 * (3.0 * wave(9.0)).tanh(),
    }
}

/// Edges of a tree: paths from a random vertex to others, each the shortest for random edge lengths, until the tree
/// has `edges` edges.
fn random_tree(mesh: &TriMesh, edges: usize, random: &mut Random) -> BTreeSet<[u32; 2]> {
    let mut neighbours = vec![Vec::new(); mesh.vertex_count()];
    for [a, b] in sides(mesh).filter(|[a, b]| a < b) {
        let length = u64::from(500 + random.below(1000));
        neighbours[a as usize].push((b, length));
        neighbours[b as usize].push((a, length));
    }
    let root = random.index(mesh.vertex_count());
    let mut before = vec![u32::MAX; mesh.vertex_count()];
    let mut nearest = vec![u64::MAX; mesh.vertex_count()];
    nearest[root] = 0;
    let mut queue = BinaryHeap::from([Reverse((0, root))]);
    while let Some(Reverse((distance, v))) = queue.pop() {
        if distance > nearest[v] {
            continue;
        }
        for &(next, length) in &neighbours[v] {
            if distance + length < nearest[next as usize] {
                nearest[next as usize] = distance + length;
                before[next as usize] = u32::try_from(v).expect("a vertex fits");
                queue.push(Reverse((distance + length, next as usize)));
            }
        }
    }
    let mut is_in_tree = vec![false; mesh.vertex_count()];
    is_in_tree[root] = true;
    let mut tree = BTreeSet::new();
    while tree.len() < edges {
        let from = random.index(mesh.vertex_count());
        let way = successors(Some(from), |&v| (!is_in_tree[v]).then(|| before[v] as usize));
        let way: Vec<usize> = way.collect();
        // From the tree outwards: if the last edges do not suffice, the seam ends before its vertex.
        for pair in way.windows(2).rev().take(edges - tree.len()) {
            let [a, b] = [pair[0], pair[1]].map(|v| u32::try_from(v).expect("a vertex fits"));
            tree.insert([a.min(b), a.max(b)]);
            is_in_tree[pair[0]] = true;
        }
    }
    tree
}

fn sides(mesh: &TriMesh) -> impl Iterator<Item = [u32; 2]> + '_ {
    mesh.triangles.iter().flat_map(|t| (0..3).map(|k| [t[k].number(), t[(k + 1) % 3].number()]))
}

/// Lowest corner of a corner's part, found by links to lower corners. Shortens the links on the path.
fn root(part: &mut [usize], mut corner: usize) -> usize {
    while part[corner] != corner {
        part[corner] = part[part[corner]];
        corner = part[corner];
    }
    corner
}

/// Mesh with a vertex for each part of the faces around a vertex that the seams separate.
fn cut_open(mesh: &TriMesh, seams: &BTreeSet<[u32; 2]>) -> TriMesh {
    // Corner at the tail of each side, by the side's ends.
    let corner_at: BTreeMap<[u32; 2], usize> = sides(mesh).zip(0..).collect();
    let mut part: Vec<usize> = (0..3 * mesh.face_count()).collect();
    let next = |corner: usize| corner - corner % 3 + (corner + 1) % 3;
    for (&[a, b], &corner) in corner_at.iter().filter(|([a, b], _)| a < b && !seams.contains(&[*a, *b])) {
        let twin = corner_at[&[b, a]];
        for (one, other) in [(corner, next(twin)), (next(corner), twin)] {
            let [one, other] = [one, other].map(|corner| root(&mut part, corner));
            part[one.max(other)] = one.min(other);
        }
    }
    let mut numbers = BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for (face, corners) in mesh.triangles.iter().enumerate() {
        triangles.push([0, 1, 2].map(|k: usize| {
            let root = root(&mut part, 3 * face + k);
            *numbers.entry(root).or_insert_with(|| {
                positions.push(mesh.positions[corners[k].index()]);
                VertexId::from_index(positions.len() - 1)
            })
        }));
    }
    TriMesh { positions, triangles, polygon_of: None }
}
