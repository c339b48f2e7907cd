//! Everything that needs no screen.

mod linalg;
mod linalg_faults;
mod linalg_matrices;
mod linalg_mean_value;
