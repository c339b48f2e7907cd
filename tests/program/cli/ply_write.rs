//! PLY files survive a round trip except for texture coordinates, as checked by another reader.

use std::collections::BTreeMap;
use std::fs;

use freebound_core::mesh::{DiskMesh, NewVertex, PolygonMesh, Refinement, VertexId};
use freebound_io::{MeshFile, NO_TEXTURE, Precision, Refined, Texture, read_stream, write_ply};
use glam::DVec2;

use super::program::Program;
use freebound_testkit::ply::{Encoding, PlyElement, PlyMaker, taken_apart};
use freebound_testkit::{Random, grid, quad_sheet};

/// All names of texture coordinates in these files.
const TEXTURE: [&str; 5] = ["u", "v", "s", "t", "texcoord"];

fn written(mesh: &MeshFile, texture: &Texture) -> Vec<u8> {
    written_in(mesh, texture, Precision::F64)
}

fn written_in(mesh: &MeshFile, texture: &Texture, precision: Precision) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_ply(&mut bytes, mesh, texture, precision).expect("memory takes all");
    bytes
}

fn by_vertex(mesh: &PolygonMesh) -> Texture {
    Texture::per_vertex(mesh, &mesh.positions.iter().map(|p| DVec2::new(p.y / 3.0, -p.x)).collect())
}

/// Distinct coordinates for all corners except those of the first face, which has none.
fn by_corner(mesh: &PolygonMesh) -> Texture {
    let count = u32::try_from(mesh.corners.len()).expect("few");
    let first = mesh.corner_range(0).len();
    let corners = (0..count).map(|k| if (k as usize) < first { NO_TEXTURE } else { k }).collect();
    Texture { coordinates: (0..count).map(|k| DVec2::new(f64::from(k) / 7.0, -0.1)).collect(), corners }
}

/// Asserts that two files differ in texture coordinates alone.
fn assert_same_but_texture(before: &[u8], after: &[u8]) -> Vec<PlyElement> {
    let ((others, elements), (others_after, elements_after)) = (taken_apart(before), taken_apart(after));
    assert_eq!(others, others_after);
    assert_eq!(elements.len(), elements_after.len());
    for (element, after) in elements.iter().zip(&elements_after) {
        assert_eq!(element.without(&TEXTURE), after.without(&TEXTURE));
    }
    elements_after
}

fn pairs(columns: [Option<Vec<Vec<f64>>>; 2]) -> Vec<DVec2> {
    let [u, v] = columns.map(|column| column.expect("it is there").concat());
    u.into_iter().zip(v).map(DVec2::from).collect()
}

#[test]
fn coordinates_without_seams_stand_at_vertices_under_the_names_that_the_file_has() {
    let mesh = quad_sheet(3, 3, 0.2, &mut Random(7));
    for encoding in Encoding::ALL {
        for at_vertices in [None, Some(["u", "v"]), Some(["s", "t"])] {
            for at_corners in [None, Some(usize::MAX)] {
                let before = PlyMaker { encoding, at_vertices, at_corners, ..PlyMaker::rich(&mesh) }.bytes();
                let file = read_stream(before.as_slice()).expect("it is right");
                let texture = by_vertex(&mesh);
                let after = written(&file, &texture);
                let elements = assert_same_but_texture(&before, &after);
                let [u, v] = at_vertices.unwrap_or(["s", "t"]);
                if at_corners.is_none() || at_vertices.is_some() {
                    assert_eq!(pairs([elements[0].column(u), elements[0].column(v)]), texture.coordinates);
                }
                assert_eq!(elements[2].column("texcoord").is_some(), at_corners.is_some());
                let again = read_stream(after.as_slice()).expect("it reads back");
                assert_eq!(again.polygons, mesh);
                let found = again.texture.expect("it has texture coordinates");
                let at = |t: &Texture| t.corners.iter().map(|&k| t.coordinates[k as usize]).collect::<Vec<_>>();
                assert_eq!(at(&found), at(&texture), "{encoding:?} {at_vertices:?} {at_corners:?}");
            }
        }
    }
}

#[test]
fn coordinates_with_seams_stand_at_corners_and_old_ones_at_vertices_are_gone() {
    let mesh = quad_sheet(3, 3, 0.2, &mut Random(7));
    for encoding in Encoding::ALL {
        for (at_vertices, at_corners) in [(None, None), (Some(["u", "v"]), None), (None, Some(2))] {
            let before = PlyMaker { encoding, at_vertices, at_corners, ..PlyMaker::rich(&mesh) }.bytes();
            let texture = by_corner(&mesh);
            let after = written(&read_stream(before.as_slice()).expect("it is right"), &texture);
            let elements = assert_same_but_texture(&before, &after);
            assert!(elements[0].column("u").is_none() && elements[0].column("s").is_none());
            let lists = elements[2].column("texcoord").expect("there are lists");
            assert_eq!(lists[0], [0.0; 0], "the first face has none");
            for (face, list) in lists.iter().enumerate().skip(1) {
                let own = mesh.corner_range(face).map(|k| texture.coordinates[k].to_array());
                assert_eq!(*list, own.collect::<Vec<_>>().concat(), "{encoding:?} face {face}");
            }
        }
    }
}

#[test]
fn in_32_bits_a_vertex_is_written_once_for_each_of_its_coordinates() {
    let mesh = quad_sheet(3, 3, 0.2, &mut Random(7));
    let corners = u32::try_from(mesh.corners.len()).expect("few");
    // Faces on the left and on the right are apart; a coordinate that stands twice in the file is one.
    let side = |face: usize| f64::from(u8::from(face % 3 == 2));
    let coordinates = (0..mesh.face_count()).flat_map(|face| {
        mesh.face(face).iter().map(move |vertex| DVec2::new(side(face), f64::from(vertex.number()) / 4.0))
    });
    let texture = Texture { coordinates: coordinates.collect(), corners: (0..corners).collect() };
    for encoding in Encoding::ALL {
        for at_vertices in [None, Some(["u", "v"]), Some(["s", "t"])] {
            let before = PlyMaker { encoding, at_vertices, ..PlyMaker::rich(&mesh) }.bytes();
            let file = read_stream(before.as_slice()).expect("it is right");
            let after = written_in(&file, &texture, Precision::F32);
            let ((_, old), (_, elements)) = (taken_apart(&before), taken_apart(&after));
            let count = mesh.positions.len();
            let rows = elements[0].without(&TEXTURE).rows;
            assert_eq!(rows[..count], old[0].without(&TEXTURE).rows, "vertices keep their numbers and properties");
            // Four vertices lie on the seam.
            assert_eq!(rows.len(), count + 4);
            assert!(rows[count..].iter().all(|row| rows[..count].contains(row)), "copies have all properties");
            assert!(elements[2].column("texcoord").is_none());
            let head = String::from_utf8_lossy(&after).into_owned();
            let [u, _] = at_vertices.unwrap_or(["s", "t"]);
            assert!(head.contains(&format!("property float {u}")));
            let again = read_stream(after.as_slice()).expect("it reads back");
            let found = again.texture.expect("it has texture coordinates");
            let at = |t: &Texture| t.corners.iter().map(|&k| t.coordinates[k as usize]).collect::<Vec<_>>();
            assert_eq!(at(&found), at(&texture), "{encoding:?} {at_vertices:?}");
            let places = |mesh: &PolygonMesh| {
                mesh.corners.iter().map(|vertex| mesh.positions[vertex.index()]).collect::<Vec<_>>()
            };
            assert_eq!(places(&again.polygons), places(&mesh));
        }
    }
}

#[test]
fn in_32_bits_a_file_with_lists_keeps_them_and_its_vertices() {
    let mesh = quad_sheet(3, 3, 0.2, &mut Random(7));
    let before = PlyMaker { at_corners: Some(usize::MAX), ..PlyMaker::rich(&mesh) }.bytes();
    let file = read_stream(before.as_slice()).expect("it is right");
    let mut texture = by_corner(&mesh);
    texture.corners = (0..u32::try_from(mesh.corners.len()).expect("few")).collect();
    let after = written_in(&file, &texture, Precision::F32);
    let elements = assert_same_but_texture(&before, &after);
    let lists = elements[2].column("texcoord").expect("there are lists").concat();
    let halves = texture.coordinates.iter().flat_map(|uv| uv.as_vec2().as_dvec2().to_array());
    assert_eq!(lists, halves.collect::<Vec<_>>());
}

#[test]
fn a_mesh_of_another_file_becomes_a_ply_file_whose_numbers_are_exact() {
    let mesh = quad_sheet(3, 2, 0.2, &mut Random(3));
    let file = MeshFile { polygons: mesh.clone(), ..MeshFile::default() };
    let (_, elements) = taken_apart(&written(&file, &by_vertex(&mesh)));
    assert_eq!(pairs([elements[0].column("s"), elements[0].column("t")]), by_vertex(&mesh).coordinates);
    assert_eq!(pairs([elements[0].column("x"), elements[0].column("z")]).len(), mesh.positions.len());
    let again = read_stream(written(&file, &Texture::default()).as_slice()).expect("it reads back");
    assert_eq!((again.polygons, again.texture), (mesh, None));
}

#[test]
fn new_vertices_lie_between_the_ends_of_their_edge_in_all_numbers_and_only_their_faces_are_cut() {
    let mesh = PolygonMesh::from(&grid(3, 2));
    for encoding in Encoding::ALL {
        let before = PlyMaker { encoding, ..PlyMaker::rich(&mesh) }.bytes();
        let file = read_stream(before.as_slice()).expect("it is right");
        let disk = DiskMesh::try_from(mesh.triangulate()).expect("a disk");
        let new = VertexId::from_index(disk.vertex_count());
        let inner = |face| {
            let corners = disk.face(face);
            corners.contains(&VertexId::new(5)) && corners.contains(&VertexId::new(6))
        };
        let edge = [5, 6].map(VertexId::new);
        let mut parts = BTreeMap::new();
        for face in disk.faces().filter(|&face| inner(face)) {
            let corners = disk.face(face);
            let k = (0..3).find(|&k| !edge.contains(&corners[k])).expect("an apex");
            let [apex, from, to] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
            parts.insert(face, vec![[from, new, apex], [new, to, apex]]);
        }
        assert_eq!(parts.len(), 2);
        let refinement = Refinement::new(&disk, vec![NewVertex { edge, at: 0.25 }], &parts).expect("a disk");
        let refined = Refined::new(&file, None, &refinement).mesh;
        let after = written(&refined, &by_vertex(&refined.polygons));
        let ((_, old), (_, elements)) = (taken_apart(&before), taken_apart(&after));
        assert_eq!(elements[0].without(&TEXTURE).rows[..12], old[0].rows);
        let row = &elements[0].rows[12];
        // Red goes from 5 to 6; the list is that of the first end; the confidence of both is one half.
        let place = refined.polygons.positions[12].to_array().map(|x| vec![x]);
        assert_eq!(row[..4], [vec![vec![5.0]], place.to_vec()].concat());
        assert_eq!(row[4..6], [vec![-3.0; 2], vec![0.5]]);
        assert_eq!([&elements[1], &elements[3]], [&old[1], &old[3]]);
        let faces = elements[2].column("vertex_indices").expect("faces");
        assert_eq!(faces.len(), old[2].rows.len() + 2);
        assert_eq!(read_stream(after.as_slice()).expect("it reads back").polygons, refined.polygons, "{encoding:?}");
    }
}

#[test]
fn the_program_reads_and_writes_ply_files_by_their_names_and_proves_what_they_hold() {
    let program = Program::new();
    let mesh = quad_sheet(4, 4, 0.2, &mut Random(7));
    let before = PlyMaker { encoding: Encoding::Big, number: "float", ..PlyMaker::rich(&mesh) }.bytes();
    fs::write(program.path("in.ply"), &before).expect("written");
    program.run(&["flatten", "in.ply", "-o", "out.ply"]).expect(0);
    program.run(&["check", "out.ply"]).expect(0);
    assert_same_but_texture(&before, &fs::read(program.path("out.ply")).expect("it is there"));
    program.run(&["flatten", "out.ply", "-o", "out.obj"]).expect(0);
    program.run(&["flatten", "out.obj", "-o", "again.PLY"]).expect(0);
    program.run(&["check", "again.PLY"]).expect(0);
}
