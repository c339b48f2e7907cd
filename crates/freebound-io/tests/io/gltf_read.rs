//! Reading glTF files: the triangles of another reader, welded within a mesh, with every bit of the numbers.

use freebound_testkit::glb::{plain, read_unique, sheet};
use std::fs;
use std::io::ErrorKind;

use freebound_io::{MeshFile, NO_TEXTURE, ReadError, ReadWarning, ReadWarningKind, read_mesh, read_stream};
use glam::{DVec2, DVec3};
use serde_json::json;

use freebound_testkit::assert_message;
use freebound_testkit::glb::{F32, GlbMaker, Seen, U8, U16, U32, bytes_of, seen};

fn read(bytes: &[u8]) -> MeshFile {
    read_stream(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// Triangles of a mesh with their texture coordinates, v pointing down again.
fn triangles(file: &MeshFile) -> Vec<Seen> {
    let mesh = &file.polygons;
    (0..mesh.face_count())
        .map(|face| {
            let range = mesh.corner_range(face);
            let own = range.clone().map(|k| file.texture.as_ref().map_or(NO_TEXTURE, |texture| texture.corners[k]));
            let own: Vec<u32> = own.collect();
            let down = |uv: DVec2| DVec2::new(uv.x, 1.0 - uv.y);
            let at = |k: usize| down(file.texture.as_ref().unwrap().coordinates[own[k] as usize]);
            Seen {
                corners: [0, 1, 2].map(|k| mesh.positions[mesh.face(face)[k].index()]),
                texture: (!own.contains(&NO_TEXTURE)).then(|| [0, 1, 2].map(at)),
            }
        })
        .collect()
}

#[test]
fn indices_of_all_kinds_give_the_triangles_that_another_reader_sees_to_the_last_bit() {
    for kind in [U8, U16, U32] {
        let maker = plain(6, kind);
        let file = read(&maker.glb());
        assert_eq!(triangles(&file), seen(&maker.glb()), "{kind}");
        assert_eq!(read(maker.text().as_bytes()).polygons, file.polygons, "as text");
    }
}

#[test]
fn strips_fans_and_lists_without_indices_give_the_triangles_that_another_reader_sees() {
    for (mode, count, listed) in [
        (4, 12, None),
        (5, 9, None),
        (6, 7, None),
        (4, 9, Some(vec![0, 1, 2, 2, 1, 3, 8, 7, 6])),
        // Two strips, joined by triangles without area.
        (5, 9, Some(vec![0, 1, 2, 3, 3, 4, 4, 5, 6, 7])),
        (6, 9, Some(vec![4, 1, 2, 3, 5])),
    ] {
        let mut maker = GlbMaker::new();
        let numbers: Vec<f32> = (0..3 * count).map(|k| (k as f32 * 1.7).sin()).collect();
        let position = maker.floats("VEC3", &numbers);
        let mut primitive = json!({"attributes": {"POSITION": position}, "mode": mode});
        if let Some(listed) = &listed {
            primitive["indices"] = json!(maker.integers("SCALAR", U16, listed));
        }
        let lines = json!({"attributes": {"POSITION": position}, "mode": 1});
        maker.push("meshes", json!({"primitives": [lines, primitive]}));
        maker.push("nodes", json!({"mesh": 0}));
        let file = read(&maker.glb());
        assert_eq!(triangles(&file), seen(&maker.glb()), "{mode} {listed:?}");
        assert_eq!(file.texture, None);
        assert!(!file.polygons.corners.is_empty());
    }
}

#[test]
fn interleaved_and_sparse_and_normalized_elements_are_those_that_another_reader_sees() {
    let (positions, texture, indices) = sheet(4);
    for (kind, largest, size) in [(U8, 255.0, 1), (U16, 65535.0, 2)] {
        let mut maker = GlbMaker::new();
        // Rows of four unrelated bytes, a position, texture coordinates of small integers, and padding.
        let mut rows = Vec::new();
        for (place, uv) in positions.chunks_exact(3).zip(texture.chunks_exact(2)) {
            rows.extend([0xAA; 4]);
            rows.extend(bytes_of(place));
            for x in uv {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and positive")]
                rows.extend(((x * largest).round() as u32).to_le_bytes()[..size].to_vec());
            }
            rows.resize(rows.len().next_multiple_of(4), 0xAA);
        }
        let count = positions.len() / 3;
        let view = maker.view(&rows[..], Some(rows.len() / count));
        let moved = maker.view(&bytes_of(&[0.5, 0.25, 3.0, -1.0, -2.0, -3.0]), None);
        let places = maker.view(&[3, 0, 17, 0], None);
        maker.push("accessors", json!({
            "bufferView": view, "byteOffset": 4, "componentType": F32, "count": count, "type": "VEC3",
            "min": [-1, -2, -3], "max": [2, 2, 3],
            "sparse": {"count": 2, "indices": {"bufferView": places, "componentType": U16}, "values": {"bufferView": moved}},
        }));
        maker.push("accessors", json!({
            "bufferView": view, "byteOffset": 16, "componentType": kind, "normalized": true, "count": count, "type": "VEC2",
        }));
        // Sparse positions: all are 0 except those that the file lists.
        maker.push("accessors", json!({
            "componentType": F32, "count": 18, "type": "VEC3", "min": [-1, -2, -3], "max": [1, 1, 3],
            "sparse": {"count": 2, "indices": {"bufferView": places, "componentType": U16}, "values": {"bufferView": moved}},
        }));
        let listed = maker.integers("SCALAR", U16, &indices);
        let few = maker.integers("SCALAR", U8, &[0, 3, 17]);
        maker.push(
            "meshes",
            json!({"primitives": [
                {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": listed},
                {"attributes": {"POSITION": 2}, "indices": few},
            ]}),
        );
        maker.push("nodes", json!({"mesh": 0}));
        let (found, others) = (triangles(&read(&maker.glb())), seen(&maker.glb()));
        assert_eq!(found.len(), others.len());
        for (own, other) in found.iter().zip(&others) {
            assert_eq!(own.corners, other.corners);
            for (uv, near) in own.texture.iter().flatten().zip(other.texture.iter().flatten()) {
                // The other reader multiplies by a rounded 1/255; glTF says to divide.
                assert!((*uv - *near).abs().max_element() <= f64::from(f32::EPSILON), "{uv} {near}");
                for x in uv.to_array() {
                    #[expect(clippy::cast_possible_truncation, reason = "a small integer")]
                    let whole = (x * f64::from(largest)).round() as f32;
                    assert_eq!(x, f64::from(whole / largest), "{kind}");
                }
            }
        }
        assert_eq!(found.last().expect("the bare one").texture, None);
    }
}

#[test]
fn nodes_are_walked_from_the_first_root_down_with_their_transforms() {
    let mut maker = plain(2, U16);
    maker.json["nodes"] = json!([
        {"mesh": 0, "translation": [8, -4, 2], "children": [3, 1]},
        {"mesh": 0, "scale": [2, 4, -0.5], "extras": "a mirror"},
        {"mesh": 0},
        {"rotation": [0, 1, 0, 0], "children": [4]},
        {"mesh": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 3, 5, 7, 1]},
    ]);
    let all = seen(&maker.glb());
    assert_eq!(all.len(), 4 * 8);
    assert_eq!(triangles(&read_unique(&maker.glb()).unwrap()), all, "all nodes, where no scene is named");
    maker.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [2, 0]}]);
    maker.json["scene"] = json!(1);
    let of_scene = seen(&maker.glb());
    assert_eq!(of_scene.len(), 4 * 8);
    assert_ne!(of_scene, all, "another order");
    assert_eq!(triangles(&read_unique(&maker.glb()).unwrap()), of_scene);
    maker.json["scene"] = json!(0);
    assert_eq!(triangles(&read_unique(&maker.glb()).unwrap()).len(), 3 * 8);
}

#[test]
fn nodes_of_one_mesh_share_it_at_the_place_of_the_first_and_copies_by_an_extension_are_named() {
    let mut maker = plain(2, U16);
    let second = maker.json["meshes"][0].clone();
    maker.push("meshes", second);
    maker.json["nodes"] = json!([
        {"mesh": 0, "translation": [8, -4, 2]},
        {"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {}}}},
        {"mesh": 0, "scale": [2, 4, -0.5]},
        {"mesh": 0},
    ]);
    let file = read(&maker.glb());
    let all = seen(&maker.glb());
    assert_eq!(triangles(&file), all[..2 * 8]);
    let warning = |kind, count| ReadWarning { kind, count, line: None };
    let of = [warning(ReadWarningKind::SharedInstances, 2), warning(ReadWarningKind::RepeatedNodes, 1)];
    assert_eq!(file.warnings, of);
    let unique = read_unique(&maker.glb()).unwrap();
    assert_eq!(triangles(&unique), all);
    assert_eq!(unique.warnings, of[1..]);
}

#[test]
fn a_shared_mesh_is_read_at_its_first_node_that_does_not_collapse_it() {
    let mut maker = plain(2, U16);
    maker.json["nodes"] = json!([{"mesh": 0, "scale": [0, 0, 0]}, {"mesh": 0, "translation": [1, 2, 3]}, {"mesh": 0}]);
    let file = read(&maker.glb());
    assert_eq!(triangles(&file), seen(&maker.glb())[8..16]);
    maker.json["nodes"] = json!([{"mesh": 0, "scale": [0, 0, 0]}, {"mesh": 0, "scale": [1, 0, 1]}]);
    assert_eq!(triangles(&read(&maker.glb())), seen(&maker.glb())[..8], "all of them collapse it");
}

#[test]
fn transforms_are_taken_in_64_bits() {
    let mut maker = plain(2, U16);
    maker.json["nodes"] = json!([{"mesh": 0, "translation": [0.1, 0.2, 0.3], "scale": [0.3, 0.3, 0.3]}]);
    let (positions, ..) = sheet(2);
    let found = read(&maker.glb()).polygons.positions;
    for (own, place) in positions.chunks_exact(3).zip(&found) {
        let own = DVec3::new(f64::from(own[0]), f64::from(own[1]), f64::from(own[2]));
        let expected = own * 0.3 + DVec3::new(0.1, 0.2, 0.3);
        assert!((expected - place).abs().max_element() < 1e-15, "{expected} {place}");
    }
}

#[test]
fn a_skinned_mesh_lies_where_its_joints_put_it_not_its_node() {
    let mut maker = plain(2, U16);
    let unmoved = triangles(&read(&maker.glb()));
    maker.json["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [1, 2, 3]}, {}]);
    maker.json["skins"] = json!([{"joints": [1]}]);
    assert_eq!(triangles(&read(&maker.glb())), unmoved);
}

#[test]
fn vertices_at_one_place_are_one_within_a_node_and_never_between_nodes() {
    let mut maker = GlbMaker::new();
    let (positions, texture, indices) = sheet(3);
    // Every corner has its own vertex, and −0 for 0; half of the faces belong to another primitive.
    let pick = |all: &[f32], width: usize, from: &[u32]| -> Vec<f32> {
        let numbers = from.iter().flat_map(|&v| all[v as usize * width..][..width].to_vec());
        numbers.enumerate().map(|(k, x)| if x == 0.0 && k % 2 == 0 { -0.0 } else { x }).collect()
    };
    let mut primitives = Vec::new();
    for part in [&indices[..24], &indices[24..]] {
        let position = maker.floats("VEC3", &pick(&positions, 3, part));
        let texture = maker.floats("VEC2", &pick(&texture, 2, part));
        primitives.push(json!({"attributes": {"POSITION": position, "TEXCOORD_0": texture}}));
    }
    maker.push("meshes", json!({"primitives": primitives}));
    maker.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0}]);
    let file = read_unique(&maker.glb()).unwrap();
    assert_eq!(file.polygons.positions.len(), 2 * 16, "two nodes of 16 vertices");
    let whole = read(&plain(3, U16).glb());
    assert_eq!(triangles(&file), [triangles(&whole), triangles(&whole)].concat());
    let own: Vec<u32> = file.polygons.corners[..indices.len()].iter().map(|v| v.number()).collect();
    let mut first_uses = own.clone();
    first_uses.dedup();
    assert!(own.iter().all(|&v| v < 16));
    // Distinct vertices that are all used are numbered in the order of the file.
    let own: Vec<u32> = whole.polygons.corners.iter().map(|v| v.number()).collect();
    assert_eq!(own, indices);
}

#[test]
fn texture_coordinates_are_turned_over_exactly_and_parts_without_have_none() {
    let mut maker = plain(2, U16);
    let mut bare = maker.json["meshes"][0]["primitives"][0].clone();
    bare["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    maker.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(bare);
    let file = read(&maker.glb());
    let (_, texture, indices) = sheet(2);
    let found = file.texture.as_ref().expect("texture coordinates");
    for (corner, &v) in indices.iter().enumerate() {
        let uv = found.coordinates[found.corners[corner] as usize];
        let own = &texture[2 * v as usize..][..2];
        assert_eq!(uv.x, f64::from(own[0]));
        assert_eq!(uv.y, 1.0 - f64::from(own[1]));
        assert_eq!(1.0 - uv.y, f64::from(own[1]), "and back");
    }
    assert!(found.corners[indices.len()..].iter().all(|&corner| corner == NO_TEXTURE));
}

#[test]
fn buffers_beside_a_file_are_read_from_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let maker = plain(4, U16);
    fs::create_dir(folder.path().join("a b")).expect("a folder");
    fs::write(folder.path().join("a b/all.bin"), &maker.binary).expect("written");
    let path = folder.path().join("sheet.gltf");
    let text = maker.finished(Some("a%20b/all.bin".to_owned())).to_string();
    fs::write(&path, &text).expect("written");
    assert_eq!(read_mesh(&path).expect("it is right").polygons, read(&maker.glb()).polygons);
    let of_stream = read_stream(text.as_bytes()).expect_err("a stream has no folder");
    let is_named = matches!(&of_stream, ReadError::Beside { buffer: 0, uri, .. } if uri == "a%20b/all.bin");
    assert!(is_named, "{of_stream}");
    fs::write(folder.path().join("a b/all.bin"), &maker.binary[1..]).expect("written");
    let cut_short = read_mesh(&path).expect_err("a byte lacks");
    let is_short = matches!(&cut_short, ReadError::Beside { source, .. } if source.kind() == ErrorKind::UnexpectedEof);
    assert!(is_short, "{cut_short}");
    assert_message("gltf-read-buffers-beside", &format!("{of_stream}\n{cut_short}"));
}

/// Measures reading: `FREEBOUND_MESH=file cargo test … time_of_reading -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn time_of_reading() {
    let path = std::env::var("FREEBOUND_MESH").expect("a file");
    for _ in 0..3 {
        let start = std::time::Instant::now();
        let file = read_mesh(path.as_ref()).expect("it is right");
        println!("{} faces read in {:?}", file.polygons.face_count(), start.elapsed());
        let start = std::time::Instant::now();
        let mut bytes = Vec::new();
        freebound_io::write_glb(&mut bytes, &file, file.texture.as_ref().expect("texture coordinates"))
            .expect("memory");
        println!("{} bytes written in {:?}", bytes.len(), start.elapsed());
    }
}
