//! Tests of the core, in one crate so that it is linked once.

mod examples;
mod raster;
