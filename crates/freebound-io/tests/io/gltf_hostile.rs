//! Faulty glTF files: each is rejected with a named fault, at once, and without taking memory.

use std::time::{Duration, Instant};

use freebound_io::{ParseFaultKind, ReadError, read_mesh, read_stream};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::obj::{assert_faults, out_of_range, place_and_kind, too_many, unexpected};
use freebound_testkit::assert_message;
use freebound_testkit::glb::{GlbMaker, U16, bytes_of, plain, read_unique};

fn fault(bytes: &[u8]) -> ReadError {
    let start = Instant::now();
    let error = read_unique(bytes).expect_err("it is wrong");
    assert!(start.elapsed() < Duration::from_millis(200), "{error}: {:?}", start.elapsed());
    assert!(!error.remedy().is_empty());
    error
}

/// Correct file with a change.
fn changed(change: impl Fn(&mut Value)) -> Vec<u8> {
    let mut maker = plain(2, U16);
    change(&mut maker.json);
    maker.glb()
}

/// Change of a correct file, and place and kind of the fault.
type Case<'a> = (&'a dyn Fn(&mut Value), &'a str, ParseFaultKind);

#[test]
fn faults_of_accessors_are_named_by_their_elements() {
    let cases: [Case<'_>; 16] = [
        (&|j| j["accessors"][0]["count"] = json!(1_u64 << 60), "accessor 0", too_many("element", 1 << 60)),
        (&|j| j["accessors"][0]["count"] = json!(10), "accessor 0", ParseFaultKind::BeyondEnd),
        (&|j| j["accessors"][0]["byteOffset"] = json!(u64::MAX), "accessor 0", ParseFaultKind::BeyondEnd),
        (&|j| j["accessors"][0]["componentType"] = json!(5130), "accessor 0", unexpected("5130")),
        (&|j| j["accessors"][0]["type"] = json!("VEC9"), "accessor 0", unexpected("VEC9")),
        (&|j| j["accessors"][0]["type"] = json!("VEC2"), "accessor 0", unexpected("9")),
        (&|j| j["accessors"][1]["count"] = json!(8), "accessor 1", unexpected("8")),
        (&|j| j["accessors"][0]["bufferView"] = json!(99), "accessor 0", out_of_range("view", 99, 3)),
        (&|j| j["bufferViews"][0]["buffer"] = json!(7), "accessor 0", out_of_range("buffer", 7, 1)),
        (&|j| j["bufferViews"][0]["byteLength"] = json!(u64::MAX), "accessor 0", ParseFaultKind::BeyondEnd),
        (&|j| j["bufferViews"][0]["byteStride"] = json!(4), "accessor 0", unexpected("4")),
        (&|j| j["bufferViews"][0]["byteStride"] = json!(u64::MAX), "accessor 0", ParseFaultKind::BeyondEnd),
        (&|j| j["accessors"][2]["componentType"] = json!(5126), "accessor 2", ParseFaultKind::BeyondEnd),
        (&|j| j["meshes"][0]["primitives"][0]["indices"] = json!(0), "accessor 0", unexpected("numbers")),
        (&|j| j["meshes"][0]["primitives"][0]["indices"] = json!(9), "accessor 9", out_of_range("accessor", 9, 3)),
        (
            &|j| j["nodes"][0] = json!({"mesh": 0, "scale": [1e308, 1, 1], "translation": [1.7e308, 0, 0]}),
            "accessor 0",
            ParseFaultKind::NotFinite,
        ),
    ];
    let faults = cases.map(|(change, place, kind)| (fault(&changed(change)), place, kind));
    assert_faults("gltf-hostile-accessors", faults);
}

#[test]
fn faults_of_nodes_are_named_by_their_elements() {
    let cases: [Case<'_>; 4] = [
        (&|j| j["nodes"][0]["mesh"] = json!(3), "node 0", out_of_range("mesh", 3, 1)),
        (&|j| j["nodes"][0]["children"] = json!([0]), "node 0", ParseFaultKind::SecondParent),
        (&|j| j["nodes"][0]["children"] = json!([5]), "node 5", out_of_range("node", 5, 1)),
        (&|j| j["scene"] = json!(2), "scene 2", out_of_range("scene", 2, 0)),
    ];
    let faults = cases.map(|(change, place, kind)| (fault(&changed(change)), place, kind));
    assert_faults("gltf-hostile-nodes", faults);
    let nothing = fault(&changed(|j| j["meshes"][0]["primitives"] = json!([])));
    assert!(matches!(nothing, ReadError::NoFaces { .. }));
}

#[test]
fn json_of_another_form_version_or_extension_is_refused() {
    let version = fault(&changed(|j| j["asset"]["version"] = json!("1.0")));
    assert!(matches!(version, ReadError::NotReadYet(_)), "{version}");
    let asset = fault(&changed(|j| j["asset"] = json!(3)));
    assert!(matches!(&asset, ReadError::Json { field, .. } if field == "asset"), "{asset}");
    let count = fault(&changed(|j| j["accessors"][0]["count"] = json!(-1)));
    assert!(matches!(&count, ReadError::Json { field, .. } if field == "accessors[0].count"), "{count}");
    let extension = "KHR_draco_mesh_compression";
    let compressed = fault(&changed(|j| j["extensionsRequired"] = json!([extension])));
    assert!(matches!(&compressed, ReadError::NeedsExtension(name) if name == extension), "{compressed}");
    let messages = [version, asset, count, compressed].map(|error| error.to_string());
    assert_message("gltf-hostile-json", &messages.join("\n"));
}

#[test]
fn nodes_in_a_ring_and_nodes_with_two_parents_are_refused() {
    for nodes in [
        json!([{"children": [1]}, {"children": [2]}, {"children": [0], "mesh": 0}]),
        json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}]),
        json!([{"children": [1, 1]}, {"mesh": 0}]),
        json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
    ] {
        let (place, kind) = place_and_kind(&fault(&changed(|j| j["nodes"] = nodes.clone())));
        assert_eq!(kind, ParseFaultKind::SecondParent, "{nodes}: {place}");
    }
}

#[test]
fn numbers_that_are_none_and_indices_of_no_vertex_are_refused() {
    let mut maker = plain(2, U16);
    let at = maker.binary.windows(4).position(|four| four == 1.1_f32.to_le_bytes()).expect("a position");
    maker.binary[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(place_and_kind(&fault(&maker.glb())), ("accessor 0".to_owned(), ParseFaultKind::NotFinite));
    let mut maker = plain(2, U16);
    let last = maker.binary.len() - 2;
    maker.binary[last..].copy_from_slice(&[9, 0]);
    assert_eq!(place_and_kind(&fault(&maker.glb())), ("accessor 2".to_owned(), out_of_range("vertex", 9, 9)));
}

#[test]
fn sparse_elements_out_of_order_or_out_of_range_are_refused() {
    let cases = [
        ([3, 0, 3, 0], 2, unexpected("3")),
        ([9, 0, 10, 0], 2, unexpected("9")),
        ([1, 0, 2, 0], 3, ParseFaultKind::BeyondEnd),
        ([1, 0, 2, 0], 1_u64 << 40, too_many("element", 1 << 40)),
    ];
    let faults = cases.map(|(places, count, kind)| {
        let mut maker = plain(2, U16);
        let (places, values) = (maker.view(&places, None), maker.view(&bytes_of(&[0.5; 6]), None));
        maker.json["accessors"][0]["sparse"] = json!({
            "count": count, "indices": {"bufferView": places, "componentType": U16}, "values": {"bufferView": values},
        });
        (fault(&maker.glb()), "accessor 0", kind)
    });
    assert_faults("gltf-hostile-sparse-elements", faults);
}

#[test]
fn what_a_binary_header_says_is_not_believed_without_the_bytes() {
    let glb = plain(2, U16).glb();
    let with = |at: usize, bytes: &[u8]| [&glb[..at], bytes, &glb[at + bytes.len()..]].concat();
    let version = fault(&with(4, &[1]));
    assert!(matches!(version, ReadError::NotReadYet(_)), "{version}");
    let json = fault(&with(20, b"]"));
    assert!(matches!(&json, ReadError::Json { field, .. } if field == "JSON"), "{json}");
    let cases = [
        (with(8, &[255; 4]), "byte 8", too_many("byte", u32::MAX.into())),
        (with(12, &[255; 4]), "byte 12", too_many("byte", u32::MAX.into())),
        (with(16, b"XXXX"), "byte 12", unexpected("a")),
        (glb[..9].to_vec(), "byte 9", ParseFaultKind::EndsEarly),
        (glb[..12].to_vec(), "byte 8", too_many("byte", glb.len() as u64)),
    ];
    assert_faults("gltf-hostile-header", cases.map(|(bytes, place, kind)| (fault(&bytes), place, kind)));
    for length in 0..glb.len() {
        read_stream(&glb[..length]).expect_err("it is cut short");
    }
}

#[test]
fn buffers_that_are_nowhere_or_elsewhere_are_refused() {
    let mut messages = Vec::new();
    for uri in [
        "https://example.org/a.bin",
        "/dev/zero",
        "data:application/octet-stream;base64,!!",
        "data:application/octet-stream,abc",
    ] {
        let text = plain(2, U16).finished(Some(uri.to_owned())).to_string();
        let error = fault(text.as_bytes());
        assert!(matches!(&error, ReadError::Beside { buffer: 0, uri: named, .. } if named == uri), "{error}");
        messages.push(error.to_string());
    }
    let without = fault(plain(2, U16).finished(None).to_string().as_bytes());
    assert!(matches!(without, ReadError::Beside { buffer: 0, .. }), "{without}");
    messages.push(without.to_string());
    assert_message("gltf-hostile-buffers", &messages.join("\n"));
    let short = plain(2, U16).finished(Some("data:;base64,AAAA".to_owned())).to_string();
    let (place, kind) = place_and_kind(&fault(short.as_bytes()));
    assert!(place == "buffer 0" && matches!(kind, ParseFaultKind::TooMany { .. }), "{place}: {kind}");
}

#[test]
fn few_bytes_shown_many_times_are_refused_before_they_are_made() {
    let mut maker = plain(100, U16);
    maker.json["nodes"] = (0..3_000).map(|_| json!({"mesh": 0})).collect();
    let error = fault(&maker.glb());
    assert!(matches!(error, ReadError::TooManyCopies { .. }), "{error}");
    let mut maker = GlbMaker::new();
    maker.view(&[0; 4000], None);
    maker.push("accessors", json!({"componentType": 5126, "count": 3000, "type": "VEC3"}));
    let primitive = json!({"attributes": {"POSITION": 0}, "mode": 5});
    maker.push("meshes", json!({"primitives": vec![primitive; 3_000]}));
    let error = fault(&maker.glb());
    assert!(matches!(error, ReadError::TooManyCopies { .. }), "{error}");
}

#[test]
fn parts_without_faces_that_are_shown_many_times_are_refused_before_they_are_made() {
    let mut maker = GlbMaker::new();
    maker.view(&[0; 40], None);
    maker.push("accessors", json!({"componentType": 5126, "count": 0, "type": "VEC3"}));
    let primitive = json!({"attributes": {"POSITION": 0}});
    maker.push("meshes", json!({"primitives": vec![primitive; 3_000]}));
    maker.json["nodes"] = (0..6_000).map(|_| json!({"mesh": 0})).collect();
    let error = fault(&maker.glb());
    assert!(matches!(error, ReadError::TooManyCopies { shown: 18_000_000 }), "{error}");
}

#[test]
fn one_file_is_not_read_for_any_number_of_buffers() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.bin"), [0; 100]).expect("written");
    let mut json = plain(2, U16).finished(Some("a.bin".to_owned()));
    json["buffers"] = vec![json!({"uri": "a.bin", "byteLength": 100}); 17].into();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, json.to_string()).expect("written");
    let error = read_mesh(&path).expect_err("it is wrong");
    assert!(matches!(&error, ReadError::Beside { buffer: 16, uri, .. } if uri == "a.bin"), "{error}");
    assert_message("gltf-hostile-too-many-buffers", &error.to_string());
}

/// Value in a JSON tree, on a path chosen by numbers.
fn value_at<'a>(json: &'a mut Value, choices: &[usize]) -> &'a mut Value {
    let Some((&choice, rest)) = choices.split_first() else { return json };
    let is_inner = match json {
        Value::Array(list) => !list.is_empty(),
        Value::Object(map) => !map.is_empty(),
        _ => false,
    };
    if !is_inner {
        return json;
    }
    match json {
        Value::Array(list) => {
            let at = choice % list.len();
            value_at(&mut list[at], rest)
        }
        Value::Object(map) => {
            let at = choice % map.len();
            value_at(map.values_mut().nth(at).expect("within"), rest)
        }
        _ => unreachable!("it has values within"),
    }
}

proptest! {
    #[test]
    fn any_json_in_the_place_of_any_other_is_read_or_refused(
        choices in prop::collection::vec(0_usize..40, 1..7),
        number in prop_oneof![Just(json!(0)), Just(json!(1)), Just(json!(-1)), Just(json!(255)), Just(json!(4_294_967_295_u64)),
            Just(json!(u64::MAX)), Just(json!(1e300)), Just(json!(null)), Just(json!([])), Just(json!({})), Just(json!("VEC3")),
            Just(json!(5121)), Just(json!(5125)), Just(json!([0, 0, 0])), Just(json!([1e308, 0, 1e308]))],
    ) {
        let mut maker = plain(3, U16);
        let (places, values) = (maker.view(&[1, 2, 3, 4], None), maker.view(&bytes_of(&[0.5; 12]), None));
        maker.json["accessors"][0]["sparse"] = json!({
            "count": 3, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": values},
        });
        maker.json["nodes"] = json!([{"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [1, 2, 3], "rotation": [0, 0, 0, 1]}]);
        let mut json = maker.finished(None);
        *value_at(&mut json, &choices) = number;
        let glb = freebound_testkit::glb::glb_of(&json, &maker.binary);
        if let Ok(file) = read_unique(&glb) {
            prop_assert!(file.polygons.positions.iter().all(|p| p.is_finite()));
            prop_assert!(file.polygons.corners.iter().all(|v| v.index() < file.polygons.positions.len()));
        }
    }

    #[test]
    fn any_byte_in_the_place_of_any_other_is_read_or_refused(at in 0_usize..2000, byte: u8) {
        let mut glb = plain(3, U16).glb();
        let at = at % glb.len();
        glb[at] = byte;
        let _ = read_stream(glb.as_slice());
    }
}
