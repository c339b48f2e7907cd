//! glTF 2.0 files, as text (`.gltf`) and binary (`.glb`).
//!
//! | file        | what it holds                                                                    |
//! |-------------|----------------------------------------------------------------------------------|
//! | `document`  | the JSON of a file, as far as meshes need it                                     |
//! | `container` | a file taken apart into its JSON and the bytes of its buffers                    |
//! | `accessor`  | arrays of elements in these bytes                                                |
//! | `scene`     | which meshes a file shows, where, and the corners of their triangles             |
//! | `read`      | a mesh of them                                                                   |
//! | `write`     | a mesh written as a binary file: the one that it was read from, or a new one     |
//! | `carried`   | the file that a mesh was read from, with other texture coordinates               |
//! | `placed`    | which vertices of the file its corners get, and which of them twice              |
//! | `grown`     | accessors with more elements                                                     |
//! | `files`     | the files that belong to a file                                                  |
//! | `growing`   | a binary file that is being made                                                 |
//!
//! What is shown are the meshes of all nodes of the file's scene, or of all nodes where it names none, with their
//! transforms, from the first root down, a node before its children, and its primitives in order. Within a node's mesh,
//! vertices at one place are one vertex, because programs part them where normals or texture coordinates differ; vertices
//! of different nodes never are. Points and lines, skins and shapes to morph to are kept and not looked at.
//!
//! glTF counts v downwards. It is turned over as `1 − v`, which is exact but for numbers below 2⁻³⁰.
//!
//! The crate `gltf` is not used for it: it keeps no part of the JSON that it does not know, and all of it is to be written
//! again. The tests read with it.
//!
//! Source: "glTF 2.0 Specification", Khronos Group, 2021.

mod accessor;
mod carried;
mod container;
mod document;
mod files;
mod growing;
mod grown;
mod placed;
mod read;
mod scene;
mod write;

pub(crate) use files::files_beside;
pub(crate) use read::parse_gltf;
pub(crate) use scene::Scene;
pub use write::write_glb;

/// The names of attributes.
const POSITION: &str = "POSITION";
const TEXTURE: &str = "TEXCOORD_0";
