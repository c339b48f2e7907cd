//! Writes the built-in meshes, the portrait and the landmarks into `assets/`: `cargo run --release --example assets`.
//!
//! OBJ numbers have the fewest digits that read back exactly.

use std::fs;
use std::path::Path;

use freebound_io::{MeshFile, Texture, write_obj};
use freebound_testkit::{BuiltIn, PlacedLandmark, bumpy_ball, scan, table};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, RgbaImage};

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    fs::create_dir_all(&folder).expect("the folder can be made");
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.join(name), bytes).expect("the file can be written");
        println!("{:>9} bytes: {name}", bytes.len());
    };
    for example in BuiltIn::ALL {
        let mut text = Vec::new();
        write_obj(&mut text, &MeshFile::from(&example.mesh()), &Texture::default()).expect("memory takes it");
        write(&format!("{}.obj", example.name()), &text);
    }
    for (name, polygons) in [("ball", bumpy_ball()), ("scan", scan()), ("table", table())] {
        let mut text = Vec::new();
        let file = MeshFile { polygons, ..MeshFile::default() };
        write_obj(&mut text, &file, &Texture::default()).expect("memory takes it");
        write(&format!("{name}.obj"), &text);
    }
    write("face-landmarks.txt", landmarks().as_bytes());
    write("portrait.png", &portrait());
}

/// Landmarks as a constraint file, each with its name.
fn landmarks() -> String {
    let head = "# vertex u v # name; vertices count from 0, left and right are the person's".to_owned();
    let line = |landmark: PlacedLandmark| {
        let [u, v] = landmark.target;
        format!("{} {u:?} {v:?} # {}", landmark.vertex.number(), landmark.name)
    };
    let lines = freebound_testkit::landmarks().into_iter().map(line);
    std::iter::once(head).chain(lines).map(|line| line + "\n").collect()
}

/// Portrait as a PNG file without opacity.
fn portrait() -> Vec<u8> {
    let picture = freebound_testkit::portrait(freebound_testkit::PORTRAIT_SIZE);
    let pixels = RgbaImage::from_raw(picture.width, picture.height, picture.pixels).expect("four bytes a pixel");
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    DynamicImage::from(pixels).into_rgb8().write_with_encoder(encoder).expect("memory takes it");
    bytes
}
