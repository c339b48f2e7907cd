//! PLY files, as text and as binary in both byte orders.
//!
//! | file      | contents                                                       |
//! |-----------|----------------------------------------------------------------|
//! | `header`  | elements of a file, and their properties                       |
//! | `numbers` | numbers after the header, in any encoding                      |
//! | `read`    | a mesh from the numbers                                        |
//! | `write`   | a file with other texture coordinates                          |
//! | `plan`    | layout of the texture coordinates in the file, and its header  |
//! | `row`     | row of a file that is being written                            |
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

/// Names of the texture coordinates of vertices: u and v.
const TEXTURE_NAMES: [[&str; 2]; 4] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// Name of the element of triangle strips.
const STRIPS: &str = "tristrips";

/// Names of the vertex lists of faces.
const CORNER_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];
const FACE_TEXTURE: &str = "texcoord";
