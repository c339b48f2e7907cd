//! Studies: many runs on a mesh, and their counterexamples.

pub(crate) mod study;
pub(crate) mod study_counterexamples;
