//! Diagnosis of disks against a naive implementation of the definition of a disk.

use std::collections::{BTreeMap, BTreeSet};

use freebound_core::mesh::{DiskMesh, TriMesh, VertexId, diagnose};
use glam::DVec3;

use freebound_testkit::{Random, band, fan, grid, tetrahedron};

#[test]
fn random_soups_get_the_verdict_of_a_naive_oracle() {
    let mut random = Random(1);
    let mut disk_count = 0;
    for case in 0..30_000 {
        let mesh = random_mesh(&mut random);
        let is_faultless = all_faces_have_an_area(&mesh) && is_disk_by_definition(&mesh);
        let expected = mesh.positions.iter().all(|p| p.is_finite()) && is_disk_by_definition(&compact(&mesh));
        let diagnosis = diagnose(&mesh);
        assert_eq!(diagnosis.is_disk(), expected, "case {case}: {:?}\n{diagnosis}", mesh.triangles);
        assert_eq!(diagnosis.faults.is_empty(), is_faultless, "case {case}: {:?}\n{diagnosis}", mesh.triangles);
        assert_eq!(DiskMesh::try_from(mesh).is_ok(), expected, "case {case}");
        disk_count += usize::from(expected);
    }
    assert!((2_000..28_000).contains(&disk_count), "both verdicts occur: {disk_count}");
}

/// Small random mesh: a disk with a few changes, or a soup.
fn random_mesh(random: &mut Random) -> TriMesh {
    let mut mesh = match random.below(6) {
        0 => fan(3 + random.below(4)),
        1 => tetrahedron(),
        2 => band(3 + random.below(3), random.below(2)),
        3 => TriMesh::new(vec![DVec3::ZERO; 3 + random.below(4) as usize], &[]),
        _ => grid(1 + random.below(3), 1 + random.below(2)),
    };
    // Small integers: the oracle decides collinearity without rounding.
    let coordinate = |random: &mut Random| f64::from(random.below(41)) - 20.0;
    for p in &mut mesh.positions {
        *p = DVec3::new(coordinate(random), coordinate(random), coordinate(random));
    }
    if random.below(50) == 0 {
        mesh.positions[0].z = f64::NEG_INFINITY;
    }
    for _ in 0..random.below(4) {
        let vertex_count = u32::try_from(mesh.vertex_count()).expect("small");
        // Sometimes one beyond the last.
        let vertex = |random: &mut Random| {
            let beyond = u32::from(random.below(40) == 0);
            VertexId::new(random.below(vertex_count + beyond))
        };
        let face = random.below(u32::try_from(mesh.face_count()).expect("small").max(1)) as usize;
        match random.below(6) {
            0 if !mesh.triangles.is_empty() => drop(mesh.triangles.remove(face)),
            1 if !mesh.triangles.is_empty() => mesh.triangles[face].swap(0, 1),
            2 if !mesh.triangles.is_empty() => mesh.triangles.push(mesh.triangles[face]),
            3 if !mesh.triangles.is_empty() => mesh.triangles[face][random.below(3) as usize] = vertex(random),
            4 if !mesh.triangles.is_empty() => drop(mesh.triangles.pop()),
            _ => mesh.triangles.push([vertex(random), vertex(random), vertex(random)]),
        }
    }
    mesh
}

/// Mesh without unreferenced vertices.
fn compact(mesh: &TriMesh) -> TriMesh {
    let used: BTreeSet<VertexId> = mesh.triangles.iter().flatten().copied().collect();
    let positions = used.iter().map(|v| mesh.positions.get(v.index()).copied().unwrap_or(DVec3::NAN)).collect();
    let number = |v: &VertexId| used.range(..v).count();
    let triangles = mesh.triangles.iter().map(|t| t.map(|v| VertexId::from_index(number(&v)))).collect();
    TriMesh { positions, triangles, polygon_of: None }
}

fn all_faces_have_an_area(mesh: &TriMesh) -> bool {
    let corners = |t: &[VertexId; 3]| t.map(|v| mesh.positions.get(v.index()).copied().unwrap_or(DVec3::ZERO));
    mesh.triangles.iter().map(corners).all(|[a, b, c]| (b - a).cross(c - a) != DVec3::ZERO)
}

/// Definition of a disk with sets and walks, regardless of the areas of faces.
fn is_disk_by_definition(mesh: &TriMesh) -> bool {
    let faces: Vec<[usize; 3]> = mesh.triangles.iter().map(|t| t.map(VertexId::index)).collect();
    let in_range = faces.iter().flatten().all(|&v| v < mesh.vertex_count());
    if faces.is_empty() || !in_range || !mesh.positions.iter().all(|p| p.is_finite()) {
        return false;
    }
    // Each directed edge once: manifold edges and one orientation. Also excludes repeated vertices and duplicates.
    let mut directed = BTreeMap::new();
    for f in &faces {
        for k in 0..3 {
            if f[k] == f[(k + 1) % 3] || directed.insert((f[k], f[(k + 1) % 3]), f[(k + 2) % 3]).is_some() {
                return false;
            }
        }
    }
    let sets: BTreeSet<BTreeSet<usize>> = faces.iter().map(|f| f.iter().copied().collect()).collect();
    let edge_count = directed.keys().filter(|&&(a, b)| a < b || !directed.contains_key(&(b, a))).count();
    let euler = mesh.vertex_count() + faces.len() == edge_count + 1;
    sets.len() == faces.len()
        && euler
        && (0..mesh.vertex_count()).all(|v| link_is_one_chain(v, &faces))
        && boundary_is_one_loop(&directed)
        && reaches_all(&faces, mesh.vertex_count())
}

/// True if the edges opposite to a vertex form a single path or cycle.
fn link_is_one_chain(vertex: usize, faces: &[[usize; 3]]) -> bool {
    let mut next = BTreeMap::new();
    for f in faces {
        if let Some(k) = f.iter().position(|&v| v == vertex) {
            next.insert(f[(k + 1) % 3], f[(k + 2) % 3]);
        }
    }
    let ends: BTreeSet<usize> = next.values().copied().collect();
    let Some(start) = next.keys().find(|v| !ends.contains(v)).or_else(|| next.keys().next()).copied() else {
        return false;
    };
    let mut at = start;
    let mut length = 0;
    while let Some(&to) = next.get(&at) {
        length += 1;
        at = to;
        if at == start || length > next.len() {
            break;
        }
    }
    length == next.len()
}

fn boundary_is_one_loop(directed: &BTreeMap<(usize, usize), usize>) -> bool {
    let next: BTreeMap<usize, usize> =
        directed.keys().filter(|&&(a, b)| !directed.contains_key(&(b, a))).copied().collect();
    let Some((&start, &first)) = next.iter().next() else { return false };
    let mut at = first;
    let mut length = 1;
    while at != start && length <= next.len() {
        let Some(&to) = next.get(&at) else { return false };
        at = to;
        length += 1;
    }
    length == next.len()
}

fn reaches_all(faces: &[[usize; 3]], vertex_count: usize) -> bool {
    let mut reached = BTreeSet::from([faces[0][0]]);
    for _ in 0..vertex_count {
        for f in faces {
            if f.iter().any(|v| reached.contains(v)) {
                reached.extend(f);
            }
        }
    }
    reached.len() == vertex_count
}
