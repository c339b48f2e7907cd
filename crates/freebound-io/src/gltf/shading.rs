//! Materials of a new file: those of an OBJ file, or one with a picture.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::growing::{DEFAULT_MATERIAL, Growing};
use crate::obj::obj_materials;
use crate::raster::write_png;
use crate::{MeshFile, PictureFile};

/// Name of the material with a picture.
const WITH_PICTURE: &str = "picture";

/// Materials, and the one of each face.
#[derive(Debug)]
pub(crate) struct Shading {
    materials: Vec<Material>,
    /// Encoded pictures.
    pictures: Vec<EncodedPicture>,
    /// Material of each face.
    of_face: Vec<usize>,
}

#[derive(Debug)]
struct Material {
    name: String,
    /// Red, green, blue and opacity, from 0 to 1.
    colour: [f32; 4],
    /// Number of its picture.
    picture: Option<usize>,
}

#[derive(Debug)]
struct EncodedPicture {
    bytes: Vec<u8>,
    kind: &'static str,
}

impl EncodedPicture {
    /// Picture of a file. `None` if it is missing or neither PNG nor JPEG, the formats that glTF allows.
    fn read(path: &Path) -> Option<Self> {
        // Only regular files are opened: reading a pipe could block for ever.
        let bytes = path.is_file().then(|| fs::read(path).ok()).flatten()?;
        let kind = match bytes.as_slice() {
            [0x89, b'P', b'N', b'G', ..] => "image/png",
            [0xff, 0xd8, 0xff, ..] => "image/jpeg",
            _ => return None,
        };
        Some(Self { bytes, kind })
    }
}

impl Shading {
    /// A single material with a picture.
    pub(crate) fn of_picture(picture: &PictureFile, mesh: &MeshFile) -> io::Result<Self> {
        let mut bytes = Vec::new();
        write_png(&picture.pixels, &mut bytes)?;
        Ok(Self {
            materials: vec![Material { name: WITH_PICTURE.to_owned(), colour: [1.0; 4], picture: Some(0) }],
            pictures: vec![EncodedPicture { bytes, kind: "image/png" }],
            of_face: vec![0; mesh.polygons.face_count()],
        })
    }

    /// Materials of an OBJ file at `path`, with the colours and pictures of its libraries if these can be read. `None`
    /// if its faces have no materials.
    pub(crate) fn of_obj(mesh: &MeshFile, path: Option<&Path>) -> Option<Self> {
        let uses = mesh.statements.iter().filter(|statement| statement.keyword() == b"usemtl");
        let mut uses = uses.peekable();
        uses.peek()?;
        let looks = obj_materials(mesh, path);
        let mut shading = Self { materials: Vec::new(), pictures: Vec::new(), of_face: Vec::new() };
        let mut number_of: BTreeMap<Option<String>, usize> = BTreeMap::new();
        let mut picture_at: BTreeMap<PathBuf, Option<usize>> = BTreeMap::new();
        let (mut name, mut current) = (None, None);
        for face in 0..mesh.polygons.face_count() {
            while let Some(statement) = uses.next_if(|statement| statement.before_face as usize <= face) {
                name = Some(statement.argument().into_owned());
                current = None;
            }
            let number = *current.get_or_insert_with(|| {
                *number_of.entry(name.clone()).or_insert_with_key(|name| {
                    let look = name.as_ref().and_then(|name| looks.get(name)).cloned().unwrap_or_default();
                    let picture = look
                        .picture
                        .and_then(|path| *picture_at.entry(path).or_insert_with_key(|path| shading.add_picture(path)));
                    shading.add_material(name.as_deref(), look.colour, picture)
                })
            });
            shading.of_face.push(number);
        }
        Some(shading)
    }

    fn add_picture(&mut self, path: &Path) -> Option<usize> {
        self.pictures.push(EncodedPicture::read(path)?);
        Some(self.pictures.len() - 1)
    }

    fn add_material(&mut self, name: Option<&str>, colour: [f32; 4], picture: Option<usize>) -> usize {
        let [red, green, blue, opacity] = colour;
        // Programs multiply a picture with the colour, which many write as black or grey beside a picture.
        let colour = if picture.is_some() { [1.0, 1.0, 1.0, opacity] } else { [red, green, blue, opacity] };
        self.materials.push(Material { name: name.unwrap_or(DEFAULT_MATERIAL).to_owned(), colour, picture });
        self.materials.len() - 1
    }

    /// Adds materials and pictures to a file. Returns the index of each material.
    pub(super) fn put_into(&self, file: &mut Growing<'_>) -> Vec<usize> {
        let mut textures = Vec::new();
        for EncodedPicture { bytes, kind } in &self.pictures {
            let view = file.view(bytes, None);
            let image = file.push("images", json!({ "bufferView": view, "mimeType": kind }));
            textures.push(file.push("textures", json!({ "source": image })));
        }
        let material = |Material { name, colour, picture }: &Material| {
            let mut look = json!({ "metallicFactor": 0.0 });
            if colour.iter().any(|share| *share < 1.0) {
                look["baseColorFactor"] = json!(colour);
            }
            if let Some(picture) = picture {
                look["baseColorTexture"] = json!({ "index": textures[*picture] });
            }
            let mut material = json!({ "name": name, "pbrMetallicRoughness": look });
            if colour[3] < 1.0 {
                material["alphaMode"] = Value::from("BLEND");
            }
            material
        };
        self.materials.iter().map(|own| file.push("materials", material(own))).collect()
    }

    /// Triangles of each material, in their order. `face_of` gives the face of each triangle; default: its own number.
    pub(super) fn divided(&self, triangles: &[[u32; 3]], face_of: Option<&[u32]>) -> Vec<Vec<[u32; 3]>> {
        let mut of_material = vec![Vec::new(); self.materials.len()];
        for (number, triangle) in triangles.iter().enumerate() {
            let face = face_of.map_or(number, |faces| faces[number] as usize);
            of_material[self.of_face[face]].push(*triangle);
        }
        of_material
    }
}
