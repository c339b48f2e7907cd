//! Linear solves with free and fixed boundaries, against dense and independent solves.

pub(crate) mod convex;
pub(crate) mod flat;
pub(crate) mod gauge;
pub(crate) mod iterate;
pub(crate) mod lee;
pub(crate) mod many_pins;
pub(crate) mod natural;
pub(crate) mod reproduction;
pub(crate) mod shapes;
pub(crate) mod spectral;
pub(crate) mod stretch;
pub(crate) mod weighted;
