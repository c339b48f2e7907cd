//! Sparse factorizations, eigenvectors and refinement.

pub(crate) mod augmented;
pub(crate) mod faults;
pub(crate) mod hermitian;
pub(crate) mod lanczos;
pub(crate) mod large;
pub(crate) mod matrices;
pub(crate) mod mean_value;
pub(crate) mod rough;
pub(crate) mod solvers;
