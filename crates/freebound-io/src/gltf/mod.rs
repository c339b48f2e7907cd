//! glTF 2.0 files, as text (`.gltf`) and binary (`.glb`).
//!
//! | file        | contents                                                                         |
//! |-------------|----------------------------------------------------------------------------------|
//! | `document`  | JSON of a file, as far as meshes need it                                         |
//! | `container` | a file split into its JSON and the bytes of its buffers                          |
//! | `accessor`  | arrays of elements in these bytes                                                |
//! | `scene`     | meshes that a file shows, their transforms, and the corners of their triangles   |
//! | `read`      | a mesh from the scene                                                            |
//! | `write`     | writer of a binary file: the one that the mesh was read from, or a new one       |
//! | `carried`   | the file that a mesh was read from, with other texture coordinates               |
//! | `placed`    | vertices of the file for the corners of the mesh, duplicated if needed           |
//! | `grown`     | accessors with added elements                                                    |
//! | `shading`   | materials of a new file                                                          |
//! | `files`     | files that belong to a glTF file                                                 |
//! | `pictures`  | pictures that its materials show                                                 |
//! | `growing`   | a binary file under construction                                                 |
//!
//! Read are the meshes of all nodes of the file's scene, with their transforms; or of all nodes if the file names no
//! scene. Order: from the first root down, a node before its children, its primitives in order.
//!
//! Within the mesh of a node, vertices at equal positions are joined, because programs duplicate vertices with
//! several normals or texture coordinates. Vertices of different nodes are never joined. Points and lines, skins and
//! morph targets are kept and otherwise ignored.
//!
//! In glTF v points down. It is converted by `1 − v`, which is exact except for numbers below 2⁻³⁰.
//!
//! The crate `gltf` is not used for reading: it drops JSON that it does not know, and all of it must be written
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
pub(crate) mod pictures;
mod placed;
mod read;
mod scene;
mod shading;
mod write;

pub(crate) use files::files_beside;
pub(crate) use read::parse_gltf;
pub(crate) use scene::Scene;
pub(crate) use shading::Shading;
pub use write::write_glb;
pub(crate) use write::write_glb_with;

/// Names of attributes.
const POSITION: &str = "POSITION";
const NORMAL: &str = "NORMAL";
const COLOUR: &str = "COLOR_0";
const TANGENT: &str = "TANGENT";
const TEXTURE: &str = "TEXCOORD_0";
