//! glTF 2.0 files, as text (`.gltf`) and binary (`.glb`).
//!
//! | file        | what it holds                                                                    |
//! |-------------|----------------------------------------------------------------------------------|
//! | `document`  | the JSON of a file, as far as meshes need it                                     |
//! | `container` | a file taken apart into its JSON and the bytes of its buffers                    |
//! | `accessor`  | arrays of elements in these bytes                                                |
//! | `scene`     | which meshes a file shows, where, and the corners of their triangles             |
//! | `read`      | a mesh of them                                                                   |
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
mod container;
mod document;
mod read;
mod scene;

pub(in crate::io) use read::parse_gltf;
pub(in crate::io) use scene::Scene;

/// The names of attributes.
const POSITION: &str = "POSITION";
const TEXTURE: &str = "TEXCOORD_0";
