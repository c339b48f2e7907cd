//! Tests of the core: everything below the screen, in one crate so that it is linked once.
#![allow(clippy::unwrap_used, reason = "a helper that fails fails its test")]
#![allow(clippy::float_cmp, reason = "results are compared to the last bit on purpose")]

mod bad_input;
mod check_cli;
mod common;
mod convex;
mod diagnosis;
mod disk_oracle;
mod distortion;
mod examples;
mod figures;
mod flat;
mod flatten_cli;
mod flatten_files;
mod iterate;
mod ladder;
mod layers;
mod linalg;
mod linalg_faults;
mod linalg_matrices;
mod linalg_mean_value;
mod materials;
mod mesh;
mod natural;
mod obj;
mod obj_texture;
mod obj_write;
mod pins;
mod polygon;
mod program;
mod raster;
mod reproduction;
mod session;
mod session_run;
mod session_timeline;
mod shapes;
mod steps;
mod verdict;
mod verdict_cases;
mod verdict_oracle;
mod verdict_random;
mod vertex_equation;
mod view;
mod virtual_boundary;
mod weights;
