//! Tests of the library.
#![allow(clippy::unwrap_used, reason = "a helper that fails fails its test")]
#![allow(clippy::float_cmp, reason = "results are compared to the last bit on purpose")]

mod bijective;
mod cutting;
mod flatten;
mod geom;
mod linalg;
mod linear;
mod mesh;
mod nonlinear;
mod pipeline;
mod verify;
mod weights;
