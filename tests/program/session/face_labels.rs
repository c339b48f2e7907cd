//! Labels of faces in a file, and the edges between faces with different labels.

use freebound::session::Model;
use freebound_core::mesh::{Preparation, Repairs, VertexId, borders};
use freebound_io::{Instances, LabelError, MeshFile, ReadOptions, read_stream};
use serde_json::{Value, json};

use freebound_testkit::glb::{GlbMaker, U32, sheet};

/// Four squares in a row, with these lines before each.
fn row(before: [&str; 4]) -> MeshFile {
    let vertices: Vec<String> = (0..10).map(|v| format!("v {} {} 0\n", v % 5, v / 5)).collect();
    let face = |(k, lines): (usize, &&str)| format!("{lines}f {} {} {} {}\n", k + 1, k + 2, k + 7, k + 6);
    let faces: Vec<String> = before.iter().enumerate().map(face).collect();
    read_stream([vertices, faces].concat().concat().as_bytes()).expect("it is right")
}

#[test]
fn faces_of_one_material_have_one_label_wherever_they_stand() {
    let file = row(["", "usemtl red\n", "usemtl  blue\t\n", "usemtl red\n"]);
    let labels = file.material_labels().expect("materials");
    assert_eq!(labels, [0, 1, 2, 1], "those without a material are of a kind of their own");
    assert_eq!(file.group_labels(), Err(LabelError::NoGroups));
    let one = row(["usemtl red\n", "", "usemtl red\n", ""]).material_labels().expect("materials");
    assert_eq!(one, [1, 1, 1, 1]);
}

#[test]
fn groups_are_of_objects() {
    let file = row(["o a\ng x\n", "o b\n", "o b\ng x\n", "o a\n"]);
    let labels = file.group_labels().expect("groups");
    assert_eq!((labels[1], labels[3]), (labels[2], labels[0]));
    assert_ne!(labels[0], labels[1]);
    assert_eq!(file.material_labels(), Err(LabelError::NoMaterials));
}

#[test]
fn borders_are_edges_of_faces_with_two_labels() {
    let file = row(["", "usemtl red\n", "usemtl blue\n", ""]);
    let labels = file.material_labels().expect("materials");
    let found = borders(&file.polygons, Repairs::SAFE, &labels);
    assert_eq!(found, [[1, 6], [2, 7]].map(|edge| edge.map(VertexId::new)));
}

/// Sheet whose lower and upper squares are two primitives of one mesh, shown by `nodes` nodes.
fn two_primitives(materials: [Value; 2], nodes: usize) -> Model {
    let mut maker = GlbMaker::new();
    let (positions, _, indices) = sheet(4);
    let position = maker.floats("VEC3", &positions);
    let primitives: Vec<Value> = indices
        .chunks(indices.len() / 2)
        .zip(materials)
        .map(|(half, material)| {
            let half = maker.integers("SCALAR", U32, half);
            let mut primitive = json!({"attributes": {"POSITION": position}, "indices": half});
            if !material.is_null() {
                primitive["material"] = material;
            }
            primitive
        })
        .collect();
    maker.json["materials"] = json!([{"name": "red"}, {"name": "blue"}]);
    let mesh = maker.push("meshes", json!({"primitives": primitives}));
    for k in 0..nodes {
        maker.push("nodes", json!({"mesh": mesh, "translation": [0, 0, 9 * k]}));
    }
    let options = ReadOptions { instances: Instances::Unique };
    let model = Model::read_stream("sheet", maker.glb().as_slice(), options, &|| false).expect("it is right");
    model.in_form(Preparation::default())
}

#[test]
fn primitives_of_a_gltf_file_have_materials_and_nodes_are_groups() {
    let across = |model: &Model| model.material_borders().expect("materials").len();
    assert_eq!(across(&two_primitives([json!(0), json!(1)], 1)), 4);
    assert_eq!(across(&two_primitives([json!(0), Value::Null], 1)), 4);
    assert_eq!(across(&two_primitives([json!(1), json!(1)], 1)), 0);
    let plain = two_primitives([Value::Null, Value::Null], 2);
    assert_eq!(plain.material_borders(), Err(LabelError::NoMaterials));
    let labels = plain.source.group_labels().expect("nodes");
    assert_eq!((labels[0], labels[31], labels[32], labels[63]), (0, 0, 1, 1));
    assert_eq!(plain.group_borders(), Ok(Vec::new()), "nodes lie apart");
}
