//! OBJ files.
//!
//! | file           | contents                                                                |
//! |----------------|-------------------------------------------------------------------------|
//! | `lines`        | lines of a text, as slices of its bytes                                 |
//! | `line`         | words of a line: numbers and corners                                    |
//! | `parse`        | a mesh from its lines                                                   |
//! | `values`       | normals and colours, for writers of other formats                       |
//! | `material`     | files that the materials name                                           |
//! | `libraries`    | material libraries of a mesh that is written into another folder        |
//! | `beside`       | files that belong to a mesh, in its folder                              |
//! | `write`        | writer of files that read back bit for bit                              |
//! | `digits`       | numbers as text                                                         |
//! | `carried`      | writer of a mesh as the text that it was read from                      |
//! | `with_picture` | writer of a mesh with its material and its picture                      |

mod beside;
mod carried;
mod digits;
mod libraries;
mod line;
mod lines;
mod material;
mod parse;
mod values;
mod with_picture;
mod write;

pub(crate) use carried::Edits;
pub use libraries::{Materials, copies_of_materials};
pub(crate) use libraries::{copy_materials, relocated};
pub(crate) use line::{number, quoted, words};
pub(crate) use lines::{Lines, split_mark};
pub(crate) use material::obj_materials;
pub use material::{material_files, material_picture, material_pictures};
pub(crate) use parse::parse;
pub(crate) use values::corner_values;
pub use write::write_obj;
pub(crate) use write::write_obj_with;
