//! Meshes with new vertices as files: everything old is unchanged.

use std::collections::BTreeMap;
use std::fs;

use freebound_core::mesh::{DiskMesh, FaceId, NewVertex, Refinement, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::verdict;
use freebound_io::{MeshFile, Refined, Texture, read_mesh, read_stream, write_obj};

use super::program::Program;

/// Two squares side by side, a triangle on top, and a triangle to the right of the second square.
const MESH: &str = "\
v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0.25\nv 1 1 0.1\nv 2 1 0\nv 0.5 2 0\nv 3 0.5 0\n\
o thing\ng left\nf 1 2 5 4\ng right\nf 2 3 6 5\nusemtl skin\nf 4 5 7\ns off\nf 3 8 6\n";

/// Mesh as read, as a disk, and refined with a new vertex on the edge between the first square and the top triangle.
fn refined() -> (MeshFile, DiskMesh, Refinement) {
    let file = read_stream(MESH.as_bytes()).unwrap();
    let disk = DiskMesh::try_from(file.polygons.triangulate()).unwrap();
    let [a, b] = [3, 4].map(VertexId::new);
    let new = VertexId::from_index(disk.vertex_count());
    let mut parts = BTreeMap::new();
    for face in disk.faces() {
        let corners = disk.face(face);
        let Some(k) = (0..3).find(|&k| [a, b].contains(&corners[k]) && [a, b].contains(&corners[(k + 1) % 3])) else {
            continue;
        };
        let [from, to, apex] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
        parts.insert(face, vec![[from, new, apex], [new, to, apex]]);
    }
    assert_eq!(parts.len(), 2, "an edge between two faces");
    let refinement = Refinement::new(&disk, vec![NewVertex { edge: [a, b], at: 0.25 }], &parts).unwrap();
    (file, disk, refinement)
}

/// File as text.
fn text_of(mesh: &MeshFile, texture: &Embedding) -> String {
    let mut bytes = Vec::new();
    write_obj(&mut bytes, mesh, &Texture::per_vertex(&mesh.polygons, texture)).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn old_vertices_whole_polygons_and_statements_stay_and_split_polygons_become_triangles() {
    let (file, _, refinement) = refined();
    let [before, after] = [
        text_of(&file, &Embedding::default()),
        text_of(&Refined::new(&file, None, &refinement).mesh, &Embedding::default()),
    ];
    let lines = |text: &str, word: &str| -> Vec<String> {
        text.lines().filter(|line| line.starts_with(word)).map(str::to_owned).collect()
    };
    let vertices = lines(&after, "v ");
    assert_eq!(vertices[..8], lines(&before, "v "));
    assert_eq!(vertices[8..], ["v 0.25 1.0 0.2125"], "a quarter of the way along its edge");
    let rest: Vec<&str> = after.lines().filter(|line| !line.starts_with("v ")).collect();
    let place = |line: &str| rest.iter().position(|l| *l == line).unwrap_or_else(|| panic!("{line} in {after}"));
    assert_eq!([place("o thing"), place("g left"), place("g right")], [0, 1, 5], "the first square is three triangles");
    assert_eq!([place("f 2 3 6 5"), place("usemtl skin")], [6, 7]);
    assert_eq!([place("s off"), place("f 3 8 6")], [10, 11], "the triangle on top is two");
    assert_eq!(rest.len(), 12);
    assert!(rest[2..5].iter().chain(&rest[8..10]).all(|line| line.split(' ').count() == 4), "triangles: {after}");
}

#[test]
fn the_refined_file_is_the_refined_mesh() {
    let (file, _, refinement) = refined();
    let disk = refinement.disk();
    let embedding: Embedding = disk.vertices().map(|v| disk.position(v).truncate()).collect();
    let back = read_stream(text_of(&Refined::new(&file, None, &refinement).mesh, &embedding).as_bytes()).unwrap();
    let texture = back.texture_mesh().unwrap();
    assert_eq!(texture.mesh.positions, disk.mesh().positions);
    assert_eq!(texture.mesh.triangles, disk.mesh().triangles, "in the same order");
    assert_eq!(texture.embedding, embedding);
    let read = DiskMesh::try_from(texture.mesh).unwrap();
    assert_eq!(verdict(&read, &texture.embedding), verdict(disk, &embedding));
    assert_eq!(read.mesh().area().to_bits(), disk.mesh().area().to_bits());
}

#[test]
fn other_programs_read_it_and_check_proves_it() {
    let (file, _, refinement) = refined();
    let disk = refinement.disk();
    let embedding: Embedding = disk.vertices().map(|v| disk.position(v).truncate()).collect();
    let program = Program::new();
    let path = program.write("out.obj", &text_of(&Refined::new(&file, None, &refinement).mesh, &embedding));
    program.run(&["check", "out.obj"]).expect(0);
    let (models, _) = tobj::load_obj(&path, &tobj::GPU_LOAD_OPTIONS).unwrap();
    let corners: usize = models.iter().map(|model| model.mesh.indices.len()).sum();
    assert_eq!(corners, 3 * disk.face_count());
    assert!(models.iter().all(|model| model.mesh.texcoords.len() / 2 == model.mesh.positions.len() / 3));
}

#[test]
fn a_refinement_without_new_vertices_changes_nothing() {
    let (file, disk, _) = refined();
    let whole = Refinement::new(&disk, Vec::new(), &BTreeMap::<FaceId, _>::new()).unwrap();
    let same = Refined::new(&file, None, &whole).mesh;
    assert_eq!(same.polygons, file.polygons);
    assert_eq!(same.statements, file.statements);
    let program = Program::new();
    let path = program.write("in.obj", &text_of(&same, &Embedding::default()));
    assert_eq!(read_mesh(&path).unwrap().polygons, file.polygons);
    assert_eq!(fs::read_to_string(&path).unwrap(), text_of(&file, &Embedding::default()));
}
