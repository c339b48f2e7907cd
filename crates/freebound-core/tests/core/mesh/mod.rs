//! Disks, diagnosis, repairs, cuts and seams.

pub(crate) mod connectivity;
pub(crate) mod diagnosis;
pub(crate) mod disk_oracle;
pub(crate) mod polygon;
pub(crate) mod repair;
pub(crate) mod seam_paths;
pub(crate) mod seams;
pub(crate) mod triangle_tree;
pub(crate) mod weld;
