//! Studies with their counterexamples, unwrapping in one call, stacks of charts, and copies of layouts.

pub(crate) mod layout_copy;
pub(crate) mod repack;
pub(crate) mod stacks;
pub(crate) mod study;
pub(crate) mod study_counterexamples;
pub(crate) mod unwrap;
