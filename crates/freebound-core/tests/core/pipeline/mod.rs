//! Studies with their counterexamples, unwrapping in one call, and stacks of charts.

pub(crate) mod repack;
pub(crate) mod stacks;
pub(crate) mod study;
pub(crate) mod study_counterexamples;
pub(crate) mod unwrap;
