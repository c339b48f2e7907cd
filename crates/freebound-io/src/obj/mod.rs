//! OBJ files.
//!
//! | file           | what it holds                                                           |
//! |----------------|-------------------------------------------------------------------------|
//! | `lines`        | the lines of a text as pieces of its bytes                              |
//! | `line`         | words of a line: numbers and corners                                    |
//! | `parse`        | lines put together to a mesh                                            |
//! | `material`     | the files that the materials name                                       |
//! | `libraries`    | material libraries of a mesh that is written into another folder        |
//! | `beside`       | files that belong to a mesh and lie beside it                           |
//! | `write`        | writes a file that reads back bit for bit                               |
//! | `digits`       | numbers as text                                                         |
//! | `carried`      | a mesh written as the text that it was read from                        |
//! | `with_picture` | writes a file, its material and its picture side by side                |

mod beside;
mod carried;
mod digits;
mod libraries;
mod line;
mod lines;
mod material;
mod parse;
mod with_picture;
mod write;

pub(crate) use carried::Edits;
pub use libraries::{Materials, copies_of_materials};
pub(crate) use libraries::{copy_materials, relocated};
pub(crate) use line::{number, quoted, words};
pub(crate) use lines::{Lines, split_mark};
pub use material::{material_files, material_picture};
pub(crate) use parse::parse;
pub use write::write_obj;
pub(crate) use write::write_obj_with;
