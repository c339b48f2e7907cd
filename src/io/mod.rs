//! Files in and out.

mod atomic;
mod constraints;
mod error;
pub mod figure;
mod json_fault;
mod material;
mod obj;
mod obj_line;
mod obj_material;
mod obj_parse;
mod obj_read;
mod obj_refined;
mod obj_texture;
mod obj_write;
mod output;
mod picture;
mod project;
mod project_fields;
mod project_json;
pub mod raster;
mod report;
mod stamp;
mod steps;
mod svg;
mod targets;

pub use atomic::{write_atomically, write_durably};
pub use constraints::{ConstraintFault, Constraints, ConstraintsError, write_constraints};
pub use error::{MAX_PARSE_FAULTS, ParseFault, ParseFaultKind, ReadError, TextureError, WriteError};
pub use material::material_picture;
pub use obj::{NO_TEXTURE, ObjMesh, Statement, Texture};
pub use obj_read::{Progress, read_mesh, read_mesh_with, read_obj, read_obj_with};
pub use obj_refined::refined_obj;
pub use obj_texture::TextureMesh;
pub use obj_write::write_obj;
pub use output::{Output, OutputKind, TexturePicture, layout_picture};
pub use picture::{PictureError, read_picture};
pub use project::{
    PROJECT_EXTENSION, PROJECT_VERSION, PathStyle, ProjectError, ProjectFile, ProjectSource, ProjectView, RecoveryNote,
};
pub use report::{
    MeshReport, PinsReport, Report, Seconds, StepReport, WeightedPinReport, peak_memory_bytes, verdict_as_in_file,
};
pub use stamp::FileStamp;
pub use steps::StepsFolder;
pub use svg::{SvgPage, write_step_svg, write_svg};
pub use targets::{Target, Targets, hard_targets, pins_in_plane};
