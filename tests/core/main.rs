//! Tests of the core: everything below the screen, in one crate so that it is linked once.

mod bad_input;
mod common;
mod diagnosis;
mod disk_oracle;
mod distortion;
mod examples;
mod linalg;
mod linalg_faults;
mod linalg_matrices;
mod linalg_mean_value;
mod mesh;
mod obj;
mod obj_texture;
mod obj_write;
mod polygon;
mod raster;
mod session;
mod verdict;
mod verdict_cases;
mod verdict_oracle;
mod verdict_random;
mod view;
