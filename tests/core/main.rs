//! Tests of the core: everything below the screen, in one crate so that it is linked once.

mod bad_input;
mod check_cli;
mod common;
mod convex;
mod diagnosis;
mod disk_oracle;
mod distortion;
mod examples;
mod flat;
mod flatten_cli;
mod layers;
mod linalg;
mod mesh;
mod obj;
mod obj_texture;
mod obj_write;
mod pins;
mod polygon;
mod program;
mod raster;
mod reproduction;
mod verdict;
mod verdict_cases;
mod verdict_oracle;
mod verdict_random;
mod weights;
