//! To be written.

pub mod raster;
