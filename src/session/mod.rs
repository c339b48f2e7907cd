//! One open document: what the user edits, its history, and the work that goes on in the background. No screen.
//!
//! The session is made of parts, each with fields of its own that nothing else touches. Requests come in through
//! `Session::handle`, what the background has finished through `Session::poll`.
//!
//! | file                 | what it holds                                                             |
//! |----------------------|---------------------------------------------------------------------------|
//! | `state`              | the session: its parts, `handle`, `poll`                                  |
//! | `action`             | what a person can ask for                                                 |
//! | `status`             | the state of the work on the screen                                       |
//! | `queries`            | questions that the parts answer                                           |
//! | `edits`              | what is done to the document                                              |
//! | `chart_actions`      | charts on the screen and in the background, and their layout              |
//! | `comparison_actions` | methods that are compared, and the morph between two of them              |
//! | `dragging`           | a drag of pins, frame by frame                                            |
//! | `arrivals`           | what background jobs bring for the document                               |
//! | `forming`            | the form that the mesh is to have, and its chart on the screen            |
//! | `reshaping`          | the mesh in another form, with the pins that it has                       |
//! | `seams`              | seams that a person draws, and files of them                              |
//! | `v_axis`             | part: how v was turned around last                                        |
//! | `runs`               | how the document is solved                                                |
//! | `filing`             | what is opened and written                                                |
//! | `in_use`             | files that are open, which nothing else is written over                   |
//! | `document`           | part: what the user edits; one edit                                       |
//! | `history`            | part: undo and redo                                                       |
//! | `past`               | of history: what was solved for documents that undo and redo come back to |
//! | `open_mesh`          | part: the open mesh, its faces one way around or the other                |
//! | `solving/`           | part: a run, its timeline, and where it comes to rest                     |
//! | `timeline`           | the steps of a run                                                        |
//! | `stop`               | where a run comes to rest                                                 |
//! | `comparing`          | part: methods that are compared in the background                         |
//! | `comparison`         | methods run beside each other on one mesh                                 |
//! | `morphing`           | part: the morph between two methods that are compared                     |
//! | `morphs`             | planar morphs through what methods have come to                           |
//! | `atlas_view`         | part: that layout for files, and for the screen                           |
//! | `chart_targets`      | pins of a mesh with several charts, in files and in the document          |
//! | `charts`             | part: charts that are not on the screen, solved in the background         |
//! | `drag`               | part: what follows the pointer                                            |
//! | `drag_request`       | pins on their way, and what is on the screen when they begin to move      |
//! | `continue_from`      | what a run of an edited document goes on from                             |
//! | `live`               | part: a planar embedding that follows the pointer, proved at every frame  |
//! | `background_jobs`    | part: small work for the document that takes time                         |
//! | `target_checks`      | part: conflicts among targets, and whether they look mirrored             |
//! | `files`              | part: what is open and saved, read and written                            |
//! | `open_project`       | of files: the project that is open, and the document as it was saved      |
//! | `opened`             | what opening brings                                                       |
//! | `large`              | what is to be opened; files that ask for much memory                      |
//! | `model`              | a mesh as it was opened                                                   |
//! | `seam_edges`         | edges of a mesh that seams follow as a rule                               |
//! | `saving`             | projects on their way to the disk                                         |
//! | `recovery`           | copies for recovery                                                       |
//! | `folder`             | shows where a file lies                                                   |
//! | `recent`             | the files opened last                                                     |
//! | `preferences`        | how the window was left, kept between runs                                |
//! | `messages`           | part: what there is to tell a person                                      |
//! | `background`         | slots for work on background threads                                      |

mod action;
mod arrivals;
mod atlas_view;
mod background;
mod background_jobs;
mod chart_actions;
mod chart_targets;
mod charts;
mod comparing;
mod comparison;
mod comparison_actions;
mod continue_from;
mod document;
mod drag;
mod drag_request;
mod dragging;
mod edits;
mod files;
mod filing;
mod folder;
mod forming;
mod history;
mod in_use;
mod large;
mod live;
mod messages;
mod model;
mod morphing;
mod morphs;
mod open_mesh;
mod open_project;
mod opened;
mod past;
mod preferences;
mod queries;
mod recent;
mod recovery;
mod reshaping;
mod runs;
mod saving;
mod seam_edges;
mod seams;
mod solving;
mod state;
mod status;
mod stop;
mod target_checks;
mod timeline;
mod v_axis;

pub use action::{Action, SaveRequest, UndoGroup};
pub use atlas_view::AtlasView;
pub use background::{Background, JobFailure, Wake};
pub use charts::ChartState;
pub use comparing::{Contender, ContenderState};
pub use comparison::{Compared, comparison_report};
pub use document::{ChartEdits, Command, Document, Shape};
pub use drag::{LivePreview, MovedVertices, Preview};
pub use history::History;
pub use large::LargeFile;
pub use messages::{Message, MessagePlace, Severity, named};
use messages::{Messages, Written};
pub use model::{LayoutFile, Model, SolvedModel, example_picture, finished_atlas};
pub use morphing::MorphState;
pub use morphs::{MORPH_FRAMES, MissingLeg, MorphLeg, MorphShortage, MorphStop, MorphStops, MorphTour, morph_end};
pub use preferences::Preferences;
pub use recent::RecentFiles;
pub use recovery::{Recoverable, recovery_folder};
pub use state::Session;
pub use status::{Busy, Status};
pub use stop::{RunStop, StopConditions};
pub use timeline::{StepDistortion, TIMELINE_BUDGET, Timeline};
