//! Studies with their counterexamples, and unwrapping in one call.

pub(crate) mod study;
pub(crate) mod study_counterexamples;
pub(crate) mod unwrap;
