//! Weights of all families, one-forms, the equation of a vertex.

pub(crate) mod families;
pub(crate) mod one_form;
pub(crate) mod vertex_equation;
