//! Shape of the source: imports, names, sizes, the files in `assets` and `tests/data`, and what the documents name.

pub(crate) mod architecture;
pub(crate) mod assets;
pub(crate) mod corpus;
pub(crate) mod cycles;
pub(crate) mod data;
pub(crate) mod examples;
pub(crate) mod names;
pub(crate) mod shape;
pub(crate) mod sources;
