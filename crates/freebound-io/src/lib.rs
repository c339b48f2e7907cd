//! Files in and out: mesh formats, constraints, projects, pictures, drawings and reports.
//!
//! | file          | contents                                                                   |
//! |---------------|----------------------------------------------------------------------------|
//! | `animation`   | animated pictures (APNG)                                                   |
//! | `mesh_file`   | meshes of any format: reading, and the contents kept of a file             |
//! | `obj`         | OBJ files with their materials, in and out                                 |
//! | `ply`         | PLY files                                                                  |
//! | `gltf`        | glTF files, as text and binary (GLB)                                       |
//! | `constraints` | constraint files: one pinned vertex per line                               |
//! | `carried_constraints` | constraints of one mesh on another mesh                            |
//! | `pin_notes`   | names of pins and landmarks, notes on pins                                 |
//! | `pts`         | landmarks of a picture (PTS)                                               |
//! | `landmark_sets` | numbered sets of landmarks on faces, with names                          |
//! | `matrix_market` | the linear system of a step (MTX)                                        |
//! | `edges`       | edges files: one edge of a seam per line                                   |
//! | `project`     | project files: the user's edits of a mesh (JSON)                           |
//! | `picture`     | pictures in (PNG, JPEG)                                                    |
//! | `output`      | the table of formats; a finished flattening, written in any of them        |
//! | `finished`    | outcomes and atlases as [`Output`], with their report                      |
//! | `charts`      | texture coordinates of charts at the corners of one mesh file              |
//! | `repacked`    | layouts with new places for their charts, ready to be written               |
//! | `precision`   | precision of the written coordinates                                       |
//! | `rounding`    | rounding to the precision of a file, and the verdict on the rounded map    |
//! | `report`      | report of a run (JSON)                                                     |
//! | `comparison`  | report of several methods on one mesh (JSON), and its table                |
//! | `step_report` | a step in the report, and as a row of a table                              |
//! | `error_report`| report of a run without a result (JSON)                                    |
//! | `svg`         | an embedding or a step as a drawing                                        |
//! | `steps`       | the steps of a run as a folder of drawings and a table                     |
//! | `study_table` | the runs of a study as a table, out and in                                 |
//! | `study_plots` | the runs of a study as plots                                               |
//! | `pattern`     | cutting patterns in true size: allowances, notches, pages of paper         |
//! | `raster`      | pictures of meshes without a screen                                        |
//! | `figure`      | figures: panels on a page, as a drawing and as a picture                   |
//! | `atomic`      | files that are written whole or not at all                                 |
//! | `finite`      | check for finite coordinates, used by every writer                         |
//! | `machine`     | memory figures of the operating system                                     |
//! | `unfinished`  | temporary files and folders, removed at a sudden end                       |
//! | `paths`       | identity of files, and relative paths                                      |
//! | `bake`        | picture of one layout, drawn anew for another layout                      |
//! | `transferred` | layout of one file on the mesh of another                                 |
//! | `textured_file` | mesh file with new texture coordinates, ready to be written             |
//! | `value_table` | numbers of vertices or faces from a table (CSV)                            |
//! | `stamp`       | length and checksum of a file                                              |
//! | `nearby`      | search for a moved file by its stamp                                       |

mod animation;
mod atomic;
mod bake;
mod carried_constraints;
mod charts;
mod comparison;
mod constraints;
mod corner_data;
mod edges;
mod error_report;
pub mod figure;
mod file_data;
mod file_layout;
mod file_values;
mod finished;
mod finite;
mod flat_mesh;
mod gltf;
mod landmark_sets;
mod machine;
mod matrix_market;
mod mesh_file;
mod nearby;
mod not_kept;
mod obj;
mod output;
mod paths;
mod pattern;
mod picture;
mod pin_notes;
mod ply;
mod precision;
mod project;
mod pts;
pub mod raster;
mod registration;
mod repacked;
mod report;
mod rounding;
mod stamp;
mod step_report;
mod steps;
mod study_plots;
mod study_table;
mod svg;
mod textured_file;
mod transferred;
mod true_size;
mod unfinished;
mod value_table;

pub use animation::{AnimationForm, AnimationFrame, write_animation};
pub use atomic::{WriteError, try_place, write_atomically, write_durably, write_to_standard_output};
pub use bake::{BakeOptions, BakeReport, BakedPicture, PaintedSurface, bake};
pub use carried_constraints::{CarriedConstraints, CarriedVertex, CarryReport, carried_constraints};
pub use charts::TexturedMesh;
pub use comparison::{
    Cell, ChartNumber, Column, ComparisonReport, ComparisonSeconds, Direction, LeftOutReport, LegReport, MethodError,
    MethodReport, MethodSeconds, MorphReport, ResultReport, TimedStep, VerdictCounts,
};
pub use constraints::{ConstraintFault, Constraints, ConstraintsError, targets_at_landmarks, write_constraints};
pub use edges::{EdgeFault, EdgesError, parse_edges, read_edge_costs, read_edges, write_edges};
pub use error_report::{ErrorReport, ErrorWords, FaultElements, FaultReport, MeshName};
pub use file_data::FileData;
pub use file_layout::{JudgeError, JudgedLayout, groups_of};
pub use finished::ResultSource;
pub use gltf::write_glb;
pub use landmark_sets::LandmarkSet;
pub use machine::{bytes_in_words, machine_memory_bytes, peak_memory_bytes};
pub use matrix_market::MatrixFile;
pub use mesh_file::{
    Instances, LabelError, LayoutError, MAX_PARSE_FAULTS, MemoryShortage, MeshFile, NO_TEXTURE, NamedGroups,
    ParseFault, ParseFaultKind, ReadError, ReadOptions, ReadProgress, ReadWarning, ReadWarningKind, Refined,
    RefinedChart, Source, Statement, Texture, TextureError, TextureMesh, check_memory, memory_to_read, read_mesh,
    read_mesh_with, read_stream, read_stream_with,
};
pub use nearby::find_nearby;
pub use obj::{Materials, copies_of_materials, material_files, material_picture, material_pictures, write_obj};
pub use output::{EXTENSIONS, Format, Output, OutputKind, ProvedEmbedding};
pub use paths::{is_same_file, is_standard_input, would_replace};
pub use pattern::{
    AllowanceJoins, EdgeStrain, LengthUnit, Pattern, PatternError, PatternFormat, PatternOptions, PatternPaper,
};
pub use picture::{PictureError, PictureFile, decode_picture};
pub use pin_notes::{PinName, PinNameFault, PinNote, PinNotes};
pub use ply::write_ply;
pub use precision::Precision;
pub use project::{
    PROJECT_EXTENSION, PROJECT_VERSION, PathStyle, ProjectError, ProjectFile, ProjectPins, ProjectSource, ProjectView,
    RecoveryNote, SavedMap,
};
pub use pts::{IncompleteSet, PictureLandmark, PtsError, PtsFault, in_order_of_a_set, parse_pts, read_pts, write_pts};
pub use registration::Registration;
pub use repacked::{LayoutPacking, LayoutToPackError, RepackedFile};
pub use report::{
    ChartReport, MeshReport, REPORT_SCHEMA, Report, SeamsReport, Seconds, ShapeReport, TransferReport,
    verdict_as_in_file, write_report,
};
pub use rounding::RoundingReport;
pub use stamp::FileStamp;
pub use step_report::StepReport;
pub use steps::StepsFolder;
pub use study_plots::study_plots;
pub use study_table::{read_study, write_study};
pub use transferred::{FileForm, TransferError, TransferOptions, TransferredFile, copied_texture};
pub use unfinished::discard_unfinished;
pub use value_table::{ElementCounts, TableElement, TableError, ValueColumn, ValueTable};
