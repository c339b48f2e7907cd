//! Structure of the source: imports, names, sizes, the files in `assets` and `tests/data`, and paths in the
//! documents.

pub(crate) mod architecture;
pub(crate) mod assets;
pub(crate) mod corpus;
pub(crate) mod cycles;
pub(crate) mod data;
pub(crate) mod examples;
pub(crate) mod licences;
pub(crate) mod names;
pub(crate) mod prose;
pub(crate) mod shape;
pub(crate) mod sources;
