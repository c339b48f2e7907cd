//! Pictures of the materials of glTF files.

use std::fs;
use std::path::Path;

use base64::Engine as _;
use freebound_core::geom::Picture;
use freebound_io::raster::write_png;
use freebound_io::{PictureFile, material_pictures, read_mesh};
use freebound_testkit::glb::{GlbMaker, U16, plain};
use serde_json::{Value, json};

/// Picture of one colour.
fn plain_picture(colour: [u8; 3]) -> Picture {
    let [red, green, blue] = colour;
    Picture { width: 3, height: 2, pixels: [red, green, blue, 255].repeat(6) }
}

fn png(colour: [u8; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_png(&plain_picture(colour), &mut bytes).expect("memory");
    bytes
}

/// A sheet whose material shows an image with these fields.
fn with_image(mut maker: GlbMaker, image: &Value) -> GlbMaker {
    maker.json["images"] = json!([image]);
    maker.json["textures"] = json!([{"source": 0}]);
    maker.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    maker.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    maker
}

/// Files of the pictures of a GLB file in a folder.
fn pictures_in(folder: &Path, maker: &GlbMaker) -> Vec<std::path::PathBuf> {
    let path = folder.join("mesh.glb");
    fs::write(&path, maker.glb()).expect("the folder can be written to");
    material_pictures(&read_mesh(&path).expect("a mesh"), &path)
}

#[test]
fn a_picture_within_the_file_in_its_text_or_beside_it_is_the_picture_of_the_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a b.png"), png([7, 8, 9])).expect("the folder can be written to");
    let mut within = plain(3, U16);
    let view = within.view(&png([7, 8, 9]), None);
    let data = base64::engine::general_purpose::STANDARD.encode(png([7, 8, 9]));
    let cases = [
        (with_image(within, &json!({"bufferView": view, "mimeType": "image/png"})), "mesh.glb"),
        (with_image(plain(3, U16), &json!({"uri": format!("data:image/png;base64,{data}")})), "mesh.glb"),
        (with_image(plain(3, U16), &json!({"uri": "a%20b.png"})), "a b.png"),
    ];
    for (maker, expected) in cases {
        let found = pictures_in(folder.path(), &maker);
        assert_eq!(found, [folder.path().join(expected)]);
        for file in [found[0].clone(), folder.path().join("mesh.glb")] {
            assert_eq!(*PictureFile::read(&file).expect("a picture").pixels, plain_picture([7, 8, 9]), "{expected}");
        }
    }
}

#[test]
fn the_picture_on_most_triangles_comes_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut maker = plain(3, U16);
    let large = maker.json["meshes"][0]["primitives"][0].clone();
    let corners = maker.floats("VEC3", &[0., 0., 0., 0., 1., 0., 1., 0., 0.]);
    let uv = maker.floats("VEC2", &[0., 0., 0., 1., 1., 0.]);
    let small = json!({"attributes": {"POSITION": corners, "TEXCOORD_0": uv}, "material": 0});
    maker.json["meshes"][0]["primitives"] = json!([small, large]);
    maker.json["meshes"][0]["primitives"][1]["material"] = json!(1);
    let [first, second] = [[1, 1, 1], [2, 2, 2]].map(|colour| maker.view(&png(colour), None));
    maker.json["images"] = json!([{"bufferView": first}, {"bufferView": second}]);
    maker.json["textures"] = json!([{"source": 0}, {"source": 1}]);
    let look = |index: u32| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}});
    maker.json["materials"] = json!([look(0), look(1)]);
    let path = folder.path().join("mesh.glb");
    assert_eq!(pictures_in(folder.path(), &maker), [path.clone(), path.clone()]);
    assert_eq!(*PictureFile::read(&path).expect("a picture").pixels, plain_picture([2, 2, 2]));
}

#[test]
fn a_picture_of_other_coordinates_and_a_moved_one_are_not_the_picture_of_the_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut maker = plain(3, U16);
    let view = maker.view(&png([7, 8, 9]), None);
    let maker = with_image(maker, &json!({"bufferView": view}));
    let moved = json!({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.0]}}});
    for look in [json!({"index": 0, "texCoord": 1}), moved, json!({"index": 7}), json!({"index": -1}), json!(3)] {
        let mut json = maker.json.clone();
        json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = look.clone();
        let maker = GlbMaker { json, binary: maker.binary.clone() };
        assert!(pictures_in(folder.path(), &maker).is_empty(), "{look}");
        PictureFile::read(&folder.path().join("mesh.glb")).expect_err("no picture");
    }
}

#[test]
fn missing_and_broken_pictures_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut broken = plain(3, U16);
    let view = broken.view(b"\x89PNG and so on", None);
    let images = [
        json!({"uri": "nowhere.png"}),
        json!({"uri": "/etc/hostname"}),
        json!({"uri": "data:image/png;base64,&&&"}),
        json!({"bufferView": view}),
        json!({"bufferView": 99}),
        json!({}),
    ];
    for image in images {
        let maker = GlbMaker { json: broken.json.clone(), binary: broken.binary.clone() };
        assert_eq!(pictures_in(folder.path(), &with_image(maker, &image)).len(), 1);
        PictureFile::read(&folder.path().join("mesh.glb")).expect_err("no picture");
    }
}
