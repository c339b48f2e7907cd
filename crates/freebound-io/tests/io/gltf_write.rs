//! Written glTF files have other texture coordinates and nothing else changed, according to another reader.

use freebound_testkit::glb::{json_of, read, read_unique, written};
use std::collections::BTreeMap;

use freebound_core::mesh::{DiskMesh, NewVertex, PolygonMesh, Refinement, VertexId};
use freebound_io::{MeshFile, NO_TEXTURE, Refined, Texture};
use glam::DVec2;
use serde_json::{Value, json};

use freebound_testkit::glb::{GlbMaker, U8, U16, plain, seen, sheet};
use freebound_testkit::{Random, quad_sheet};

/// File with everything: two meshes in three nodes, materials, a picture, attributes of many kinds, morph targets, a
/// skin, lines, an unknown extension, and numbers that no other program knows.
fn rich() -> GlbMaker {
    let mut maker = plain(3, U16);
    let (positions, ..) = sheet(3);
    let count = positions.len() / 3;
    let numbers = |width: usize, f: fn(f32) -> f32| -> Vec<f32> { (0..count * width).map(|k| f(k as f32)).collect() };
    let integers = |width: u32, most: u32| -> Vec<u32> {
        (0..u32::try_from(count).unwrap() * width).map(|k| k * 7 % most).collect()
    };
    let normal = maker.floats("VEC3", &numbers(3, |k| if k % 3.0 == 2.0 { 1.0 } else { 0.0 }));
    let tangent = maker.floats("VEC4", &numbers(4, |k| if k % 4.0 == 0.0 || k % 4.0 == 3.0 { 1.0 } else { 0.0 }));
    let colour = maker.integers("VEC4", U8, &integers(4, 256));
    maker.json["accessors"][colour]["normalized"] = json!(true);
    let joints = maker.integers("VEC4", U8, &integers(4, 2));
    let weights = maker.floats("VEC4", &numbers(4, |k| if k % 4.0 == 0.0 { 1.0 } else { 0.0 }));
    let second = maker.floats("VEC2", &numbers(2, f32::sin));
    let own = maker.floats("SCALAR", &numbers(1, |k| 3.0 * k));
    let moved = maker.floats("VEC3", &numbers(3, f32::cos));
    let primitive = &mut maker.json["meshes"][0]["primitives"][0];
    for (name, accessor) in [
        ("NORMAL", normal),
        ("TANGENT", tangent),
        ("COLOR_0", colour),
        ("JOINTS_0", joints),
        ("WEIGHTS_0", weights),
        ("TEXCOORD_1", second),
        ("_PRESSURE", own),
    ] {
        primitive["attributes"][name] = json!(accessor);
    }
    primitive["targets"] = json!([{"POSITION": moved}, {"POSITION": moved, "NORMAL": normal}]);
    primitive["material"] = json!(0);
    primitive["extras"] = json!({"who": "knows"});
    let mut lines = primitive.clone();
    lines["mode"] = json!(1);
    maker.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(lines);
    maker.json["meshes"][0]["weights"] = json!([0.25, 0.1]);
    // A mesh of a strip without indices and without texture coordinates.
    let strip = maker.floats("VEC3", &[0., 0., 0., 0., 1., 0., 1., 0., 0., 1., 1., 0.5]);
    maker.push("meshes", json!({"name": "strip", "primitives": [{"attributes": {"POSITION": strip}, "mode": 5}]}));
    let picture = maker.view(b"\x89PNG and so on", None);
    maker.json["images"] = json!([{"bufferView": picture, "mimeType": "image/png"}]);
    maker.json["textures"] = json!([{"source": 0}]);
    maker.json["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "roughnessFactor": 0.3}}]);
    maker.json["extensionsUsed"] = json!(["EXT_unknown"]);
    maker.json["extensions"] = json!({"EXT_unknown": {"deep": {"number": 0.1, "list": [null, true]}}});
    maker.json["nodes"] = json!([
        {"mesh": 0, "children": [1, 2, 3], "name": "root", "extras": {"π": 2.25}},
        {"mesh": 0, "translation": [3, 0, 0], "scale": [1, -1, 1], "weights": [0.5, 0.5]},
        {"mesh": 1, "translation": [0, 5, 0]},
        {"camera": 0},
    ]);
    maker.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}]);
    maker.json["scenes"] = json!([{"nodes": [0], "name": "all"}]);
    maker.json["scene"] = json!(0);
    maker
}

/// Attributes at each corner of each triangle, except the first texture coordinates and the tangents, which follow from
/// them; morph targets by their number.
fn attributes(glb: &[u8]) -> Vec<BTreeMap<String, Vec<u8>>> {
    let file = gltf::Gltf::from_slice(glb).expect("another reader takes it");
    let blob = file.blob.as_deref().expect("a binary chunk");
    let element = |accessor: &gltf::Accessor<'_>, at: usize| {
        let view = accessor.view().expect("a view");
        let begin = view.offset() + accessor.offset() + at * view.stride().unwrap_or(accessor.size());
        assert!(at < accessor.count() && accessor.offset() + (at + 1) * accessor.size() <= view.length());
        blob[begin..begin + accessor.size()].to_vec()
    };
    let mut found = Vec::new();
    for mesh in file.nodes().filter_map(|node| node.mesh()) {
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|_| Some(blob));
            let count = reader.read_positions().expect("positions").len();
            let listed: Vec<usize> = match reader.read_indices() {
                Some(indices) => indices.into_u32().map(|index| index as usize).collect(),
                None => (0..count).collect(),
            };
            let own: Vec<(String, gltf::Accessor<'_>)> =
                primitive.attributes().map(|(name, accessor)| (name.to_string(), accessor)).collect();
            let targets: Vec<(String, gltf::Accessor<'_>)> = primitive
                .morph_targets()
                .enumerate()
                .flat_map(|(k, target)| {
                    let named = [("POSITION", target.positions()), ("NORMAL", target.normals())];
                    named.into_iter().filter_map(move |(name, found)| Some((format!("{k} {name}"), found?)))
                })
                .collect();
            for at in listed {
                let all = own.iter().chain(&targets).filter(|(name, _)| !["TEXCOORD_0", "TANGENT"].contains(&&**name));
                found.push(all.map(|(name, accessor)| (name.clone(), element(accessor, at))).collect());
            }
        }
    }
    found
}

/// Asserts that all of the old JSON is kept, except for changes due to texture coordinates.
fn assert_json_is_kept(before: &Value, after: &Value) {
    for (key, value) in before.as_object().unwrap() {
        match key.as_str() {
            "buffers" => assert_eq!(after[key][0]["name"], value[0]["name"]),
            "nodes" => {
                for (old, new) in value.as_array().unwrap().iter().zip(after[key].as_array().unwrap()) {
                    let without = |node: &Value| {
                        let mut node = node.clone();
                        node.as_object_mut().unwrap().remove("mesh");
                        node
                    };
                    assert_eq!(without(old), without(new));
                }
                assert_eq!(value.as_array().unwrap().len(), after[key].as_array().unwrap().len());
            }
            "meshes" => {
                for (old, new) in value.as_array().unwrap().iter().zip(after[key].as_array().unwrap()) {
                    for field in ["name", "weights", "extras"] {
                        assert_eq!(old[field], new[field]);
                    }
                    for (old, new) in
                        old["primitives"].as_array().unwrap().iter().zip(new["primitives"].as_array().unwrap())
                    {
                        assert_eq!(old["extras"], new["extras"]);
                        let material = &new["material"];
                        let is_default = old["material"].is_null() && material.is_u64();
                        assert!(is_default || old["material"] == *material, "{material}");
                    }
                }
            }
            // New entries come after the old ones.
            "accessors" | "bufferViews" | "materials" => {
                let old = value.as_array().unwrap();
                assert_eq!(old[..], after[key].as_array().unwrap()[..old.len()]);
            }
            _ => assert_eq!(value, &after[key], "{key}"),
        }
    }
}

/// Texture coordinates that a file should hold, in 32 bits and with v down, for each triangle.
fn wanted(mesh: &MeshFile, texture: &Texture) -> Vec<[DVec2; 3]> {
    #[expect(clippy::cast_possible_truncation, reason = "that is what is asked")]
    let down = |uv: DVec2| DVec2::new(f64::from(uv.x as f32), f64::from((1.0 - uv.y) as f32));
    let at = |k: usize| match texture.corners[k] {
        NO_TEXTURE => None,
        index => Some(down(texture.coordinates[index as usize])),
    };
    let faces = 0..mesh.polygons.face_count();
    faces.map(|face| [0, 1, 2].map(|k| at(3 * face + k).unwrap_or(DVec2::NAN))).collect()
}

fn assert_texture(mesh: &MeshFile, texture: &Texture, glb: &[u8]) {
    let found = seen(glb);
    let wanted = wanted(mesh, texture);
    assert_eq!(found.len(), wanted.len());
    for (seen, wanted) in found.iter().zip(wanted) {
        assert_eq!(seen.texture, Some(wanted));
    }
}

#[test]
fn tangents_stay_only_if_texture_coordinates_do() {
    let before = rich().glb();
    let has_tangents = |glb: &[u8]| {
        let json = json_of(glb);
        let all = json["meshes"].as_array().expect("meshes").iter().filter_map(|mesh| mesh["primitives"].as_array());
        // Lines and points are written as they are.
        let mut surfaces = all.flatten().filter(|primitive| primitive["mode"].as_u64().is_none_or(|mode| mode > 3));
        surfaces.any(|primitive| primitive["attributes"].get("TANGENT").is_some())
    };
    let file = read(&before);
    let same = written(&file, &file.texture.clone().expect("coordinates"));
    assert!(has_tangents(&before));
    assert!(has_tangents(&same));
    let places = file.polygons.positions.iter().map(|p| DVec2::new(p.x / 3.0, 0.7 - p.y)).collect();
    assert!(!has_tangents(&written(&file, &Texture::per_vertex(&file.polygons, &places))));
}

#[test]
fn every_surface_has_a_material() {
    for glb in [rich().glb(), written(&MeshFile::from(&freebound_testkit::grid(2, 2)), &Texture::default())] {
        let file = read(&glb);
        let json = json_of(&written(&file, &file.texture.clone().unwrap_or_default()));
        let primitives =
            json["meshes"].as_array().expect("meshes").iter().filter_map(|mesh| mesh["primitives"].as_array());
        assert!(primitives.flatten().all(|primitive| primitive["material"].is_u64()), "{json:#}");
    }
}

#[test]
fn texture_coordinates_of_vertices_change_nothing_else() {
    let before = rich().glb();
    let file = read_unique(&before).unwrap();
    let places = file.polygons.positions.iter().map(|p| DVec2::new(p.x / 3.0, 0.7 - p.y)).collect();
    let texture = Texture::per_vertex(&file.polygons, &places);
    let after = written(&file, &texture);
    assert_texture(&file, &texture, &after);
    assert_eq!(read_unique(&after).unwrap().polygons, file.polygons);
    assert_eq!(attributes(&before).len(), attributes(&after).len());
    assert_eq!(attributes(&before), attributes(&after));
    let (before, after) = (json_of(&before), json_of(&after));
    assert_json_is_kept(&before, &after);
    let primitive = |json: &Value| json["meshes"][0]["primitives"][0].clone();
    assert_eq!(primitive(&before)["indices"], primitive(&after)["indices"], "the same indices");
    assert_eq!(primitive(&before)["attributes"]["POSITION"], primitive(&after)["attributes"]["POSITION"]);
    assert_eq!(before["meshes"][0]["primitives"][1], after["meshes"][0]["primitives"][1], "lines are as they were");
}

#[test]
fn nodes_that_share_a_mesh_still_share_it_and_its_map() {
    let before = rich().glb();
    let file = read(&before);
    let count = u32::try_from(file.polygons.corners.len()).unwrap();
    let coordinates = (0..count).map(|k| DVec2::new(f64::from(k) / 7.0, f64::from(k % 5) * 0.3)).collect();
    let texture = Texture { coordinates, corners: (0..count).collect() };
    let after = written(&file, &texture);
    // Triangles of the first node, of the mirrored node that shares its mesh, and of the node of the other mesh.
    let (found, wanted) = (seen(&after), wanted(&file, &texture));
    let of_shared = found.len() - wanted.len();
    assert!(0 < of_shared && of_shared < wanted.len());
    let textures: Vec<[DVec2; 3]> = found.iter().map(|seen| seen.texture.expect("coordinates")).collect();
    let (first, rest) = textures.split_at(of_shared);
    let (mirrored, last) = rest.split_at(of_shared);
    assert_eq!([first, last].concat(), wanted);
    assert!(first.iter().zip(mirrored).all(|([a, b, c], mirrored)| [*a, *c, *b] == *mirrored));
    let (before, after) = (json_of(&before), json_of(&after));
    assert_eq!(before["nodes"], after["nodes"]);
    assert_eq!(before["meshes"].as_array().unwrap().len(), after["meshes"].as_array().unwrap().len());
    assert_ne!(before["meshes"][0]["primitives"], after["meshes"][0]["primitives"]);
}

#[test]
fn seams_double_vertices_with_all_that_they_have_and_nodes_get_meshes_of_their_own() {
    let before = rich().glb();
    let file = read_unique(&before).unwrap();
    let count = u32::try_from(file.polygons.corners.len()).unwrap();
    // Every corner has its own coordinate, except for two that share one.
    let corners: Vec<u32> = (0..count).map(|k| if k == 3 { 0 } else { k }).collect();
    let coordinates = (0..count).map(|k| DVec2::new(f64::from(k) / 7.0, f64::from(k % 5) * 0.3)).collect();
    let texture = Texture { coordinates, corners };
    let after = written(&file, &texture);
    assert_texture(&file, &texture, &after);
    let again = read_unique(&after).unwrap();
    assert_eq!(again.polygons, file.polygons, "welded again");
    let triangles = |glb: &[u8]| {
        let mut all = attributes(glb);
        all.retain(|corner| corner.len() > 1);
        all
    };
    assert_eq!(triangles(&before), triangles(&after));
    assert_json_is_kept(&json_of(&before), &json_of(&after));
    let json = json_of(&after);
    assert_eq!(json["nodes"][0]["mesh"], 0);
    assert_eq!(json["nodes"][1]["mesh"], 2, "a copy");
    assert_eq!(json["meshes"][2]["weights"], json["meshes"][0]["weights"]);
}

#[test]
fn texture_coordinates_that_are_given_as_they_were_read_come_back_bit_for_bit() {
    let mut maker = plain(3, U16);
    let odd = [1e-20_f32, 0.1, 1.0, -0.0, 0.0, f32::MIN_POSITIVE, 1e-9, -3.3, 7.7e8, 1.0 / 3.0];
    let at = 16 * 12;
    for (k, four) in maker.binary[at..at + 16 * 8].chunks_exact_mut(4).enumerate() {
        four.copy_from_slice(&odd[k % odd.len()].to_le_bytes());
    }
    let file = read(&maker.glb());
    let texture = file.texture.clone().expect("it has some");
    let after = written(&file, &texture);
    let bits = |glb: &[u8]| {
        let file = gltf::Gltf::from_slice(glb).expect("another reader takes it");
        let blob = file.blob.as_deref().expect("a chunk");
        let primitive = file.meshes().next().unwrap().primitives().next().unwrap();
        let all = primitive.reader(|_| Some(blob)).read_tex_coords(0).unwrap().into_f32();
        all.map(|uv| uv.map(f32::to_bits)).collect::<Vec<_>>()
    };
    assert_eq!(bits(&maker.glb()), bits(&after));
    // Corners without new coordinates keep their old ones, too.
    let none = Texture { corners: vec![NO_TEXTURE; texture.corners.len()], ..texture };
    assert_eq!(bits(&maker.glb()), bits(&written(&file, &none)));
}

#[test]
fn a_mesh_of_another_file_becomes_a_file_of_triangles_with_seams_where_there_are_some() {
    let mesh = quad_sheet(3, 2, 0.2, &mut Random(3));
    let file = MeshFile { polygons: mesh.clone(), ..MeshFile::default() };
    let flat = mesh.positions.iter().map(|p| p.truncate()).collect();
    let smooth = written(&file, &Texture::per_vertex(&mesh, &flat));
    assert_eq!(read(&smooth).polygons.positions.len(), mesh.positions.len());
    assert_eq!(json_of(&smooth)["accessors"][0]["count"], mesh.positions.len());
    let places = mesh.triangulate();
    let found = seen(&smooth);
    assert_eq!(found.len(), places.triangles.len());
    for (seen, triangle) in found.iter().zip(&places.triangles) {
        let near = |v: VertexId| places.positions[v.index()].as_vec3().as_dvec3();
        assert_eq!(seen.corners, triangle.map(near));
    }
    let count = u32::try_from(mesh.corners.len()).unwrap();
    let coordinates = (0..count).map(|k| DVec2::splat(f64::from(k))).collect();
    let parted = written(&file, &Texture { coordinates, corners: (0..count).collect() });
    assert_eq!(json_of(&parted)["accessors"][0]["count"], mesh.corners.len());
    let bare = read(&written(&file, &Texture::default()));
    assert_eq!(bare.texture, None);
}

#[test]
fn new_vertices_lie_between_the_ends_of_their_edge_in_all_numbers() {
    let mut maker = rich();
    maker.json["nodes"] = json!([{"mesh": 0}]);
    maker.json["scenes"] = json!([{"nodes": [0]}]);
    let before = maker.glb();
    let file = read(&before);
    let disk = DiskMesh::try_from(file.polygons.triangulate()).expect("a disk");
    // The diagonal of a square in the middle.
    let edge = [5, 10].map(VertexId::new);
    let new = VertexId::from_index(disk.vertex_count());
    let mut parts = BTreeMap::new();
    for face in disk.faces().filter(|&face| edge.iter().all(|end| disk.face(face).contains(end))) {
        let corners = disk.face(face);
        let k = (0..3).find(|&k| !edge.contains(&corners[k])).expect("an apex");
        let [apex, from, to] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
        parts.insert(face, vec![[from, new, apex], [new, to, apex]]);
    }
    assert_eq!(parts.len(), 2);
    let refinement = Refinement::new(&disk, vec![NewVertex { edge, at: 0.25 }], &parts).expect("a disk");
    let refined = Refined::new(&file, None, &refinement).mesh;
    let flat = refined.polygons.positions.iter().map(|p| p.truncate()).collect();
    let texture = Texture::per_vertex(&refined.polygons, &flat);
    let after = written(&refined, &texture);
    assert_texture(&refined, &texture, &after);
    let json = json_of(&after);
    let count = |name: &str| {
        let accessor = json["meshes"][0]["primitives"][0]["attributes"][name].as_u64().expect(name);
        json["accessors"][usize::try_from(accessor).unwrap()]["count"].clone()
    };
    assert_eq!(count("POSITION"), 17);
    let all = attributes(&after);
    let others = attributes(&before);
    let at = |name: &str, bytes: &[u8]| -> Vec<f32> {
        assert_ne!(name, "COLOR_0");
        bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
    };
    let own = |place: &[f32]| all.iter().find(|corner| at("POSITION", &corner["POSITION"]) == place).cloned();
    let end = |v: VertexId| {
        let place = file.polygons.positions[v.index()].as_vec3().to_array();
        others.iter().find(|corner| at("POSITION", &corner["POSITION"]) == place).cloned().expect("it is there")
    };
    let ends = edge.map(end);
    #[expect(clippy::cast_possible_truncation, reason = "that is what the format holds")]
    let mix = |name: &str| -> Vec<f32> {
        let [a, b] = [0, 1].map(|k| at(name, &ends[k][name]));
        a.iter().zip(b).map(|(&a, b)| (f64::from(a) + 0.25 * (f64::from(b) - f64::from(a))) as f32).collect()
    };
    let found = own(&mix("POSITION")).expect("the new vertex");
    for name in ["TEXCOORD_1", "_PRESSURE", "0 POSITION", "1 POSITION", "NORMAL"] {
        assert_eq!(at(name, &found[name]), mix(name), "{name}");
    }
    let colour = |corner: &BTreeMap<String, Vec<u8>>, k: usize| f64::from(corner["COLOR_0"][k]);
    for k in 0..4 {
        let [a, b] = [0, 1].map(|end| colour(&ends[end], k));
        assert_eq!(colour(&found, k), (a + 0.25 * (b - a)).round());
    }
    for name in ["JOINTS_0", "WEIGHTS_0"] {
        assert_eq!(found[name], ends[0][name], "those of the nearer end");
    }
    assert_eq!(read(&after).polygons.corners, refined.polygons.corners.clone());
}

#[test]
fn faces_that_were_turned_around_are_written_so() {
    let file = read_unique(&rich().glb()).unwrap().turned();
    let flat = file.polygons.positions.iter().map(|p| p.truncate()).collect();
    let texture = Texture::per_vertex(&file.polygons, &flat);
    let after = written(&file, &texture);
    assert_texture(&file, &texture, &after);
    assert_eq!(PolygonMesh { starts: None, ..read_unique(&after).unwrap().polygons }, file.polygons);
}
