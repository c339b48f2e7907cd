//! PLY files, as text and binary of both orders of bytes.
//!
//! | file      | what it holds                                                  |
//! |-----------|----------------------------------------------------------------|
//! | `header`  | which elements a file has, and their properties                |
//! | `numbers` | the numbers behind the header, in any encoding                 |
//! | `read`    | a mesh of them                                                 |
//! | `write`   | a file with other texture coordinates                          |
//! | `plan`    | where these stand in it, and its header                        |
//! | `row`     | a row of a file that is being written                          |
//!
//! Source: G. Turk, "The PLY polygon file format", 1994.

mod header;
mod numbers;
mod plan;
mod read;
mod row;
mod write;

pub(crate) use header::Header;
pub(crate) use read::parse_ply;
pub use write::write_ply;

/// The names of texture coordinates of vertices: those of u beside those of v.
const TEXTURE_NAMES: [[&str; 2]; 4] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// The names of the lists of faces.
const CORNER_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];
const FACE_TEXTURE: &str = "texcoord";
