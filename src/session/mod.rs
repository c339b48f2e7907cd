//! Open document: the user's edits, their history, and the work in the background. Independent of the screen.
//!
//! The session consists of parts with private fields. Requests enter through `Session::handle`, results of background
//! work through `Session::poll`.
//!
//! | file                 | content                                                                |
//! |----------------------|------------------------------------------------------------------------|
//! | `state`              | the session: its parts, `handle`, `poll`                               |
//! | `action`             | requests of the user                                                   |
//! | `status`             | state of the work on the screen                                        |
//! | `queries`            | queries that the parts answer                                          |
//! | `edits`              | edits of the document                                                  |
//! | `page_actions`       | moves, packing, stacks and locks of charts on the page                 |
//! | `page_pins`          | pins of charts on the page                                             |
//! | `carried_pins`       | constraints of a project for another mesh                              |
//! | `carrying`           | constraints of a project on the open mesh                              |
//! | `chart_actions`      | shown chart, charts in the background, and their layout                |
//! | `comparison_actions` | compared methods, and the morph between two of them                    |
//! | `dragging`           | frames of a drag of pins                                               |
//! | `arrivals`           | results of background jobs for the document                            |
//! | `forming`            | wanted preparation of the mesh, and its shown chart                    |
//! | `reshaping`          | mesh in another preparation, with its pins                             |
//! | `seams`              | seams that the user draws, and their files                             |
//! | `unwrapping`         | part: automatic seams, found in the background                         |
//! | `first_map`          | first map of an opened mesh: layout of its file, automatic seams, or none |
//! | `layout_check`       | part: verdict on the texture coordinates of the file                   |
//! | `v_axis`             | part: last reversal of v                                               |
//! | `runs`               | runs that solve the document                                           |
//! | `filing`             | opening and saving                                                     |
//! | `exports`            | files of results, and cutting patterns                                 |
//! | `in_use`             | open files, which must not be overwritten                              |
//! | `document`           | part: the document that the user edits; its edits                      |
//! | `history`            | part: undo and redo                                                    |
//! | `past`               | of history: solutions of documents that undo and redo return to        |
//! | `open_mesh`          | part: the open mesh in its preparations                                |
//! | `solving/`           | part: a run, its timeline, and its stop conditions                     |
//! | `timeline`           | steps of a run                                                         |
//! | `stop`               | stop conditions of a run                                               |
//! | `comparing`          | part: methods that are compared in the background                      |
//! | `comparison`         | independent runs of methods on one mesh                                |
//! | `morphing`           | part: morph between two compared methods                               |
//! | `morphs`             | planar morphs through the results of methods                           |
//! | `atlas_view`         | part: layout of all charts, for files and for the screen               |
//! | `page`               | part: charts as they lie on the page, and moves of charts              |
//! | `layout_of_other`    | layout of another mesh file on the open mesh                           |
//! | `layout_copying`     | of the session: the copy of such a layout as an edit                   |
//! | `chart_layout`       | of the document: sizes, places, locks and stacks of charts             |
//! | `chart_targets`      | pins of a mesh with several charts, in files and in the document       |
//! | `charts`             | part: charts that are not shown, solved in the background              |
//! | `drag`               | part: preview of a drag                                                |
//! | `drag_request`       | request of a drag, and the state of the screen at its start            |
//! | `continue_from`      | start of a run after an edit                                           |
//! | `brushing`           | part: strokes of brushes on the map, proved at every frame             |
//! | `page_stroke`        | chart of the page that a brush shapes                                  |
//! | `live`               | part: planar embedding that follows the pointer, proved at every frame |
//! | `background_jobs`    | part: short background jobs for the document                           |
//! | `target_checks`      | part: conflicts among targets, and the check for mirrored targets      |
//! | `landmarks`          | part: landmarks of the picture, which wait for their vertices          |
//! | `landmark_pins`      | landmarks as pins: import, names, export                               |
//! | `files`              | part: files that are open, read and written                            |
//! | `open_project`       | of files: the open project, and the document in its saved state        |
//! | `opened`             | result of opening a file                                               |
//! | `large`              | requests to open files; files that need much memory                    |
//! | `locating`           | missing files of projects: search in nearby folders                   |
//! | `restored_charts`    | of opening: charts of a project with their saved maps                  |
//! | `saved_maps`         | maps of a project, which return without a solve                        |
//! | `saving`             | projects being written                                                 |
//! | `recovery`           | recovery copies                                                        |
//! | `folder`             | display of a file's folder                                             |
//! | `recent`             | recently opened files                                                  |
//! | `preferences`        | state of the window, kept between runs                                 |
//! | `messages`           | part: messages to the user                                             |
//! | `numbers`            | errors of solves, with the numbers of files                            |
//! | `background`         | slots for work on background threads                                   |

mod action;
mod arrivals;
mod atlas_view;
mod background;
mod background_jobs;
mod brushing;
mod carried_pins;
mod carrying;
mod chart_actions;
mod chart_layout;
mod chart_targets;
mod charts;
mod command_line;
mod comparing;
mod comparison;
mod comparison_actions;
mod continue_from;
mod document;
mod drag;
mod drag_request;
mod dragging;
mod edits;
mod exports;
mod files;
mod filing;
mod first_map;
mod folder;
mod forming;
mod history;
mod in_use;
mod landmark_pins;
mod landmarks;
mod large;
mod layout_check;
mod layout_copying;
mod layout_of_other;
mod live;
mod locating;
mod messages;
mod morphing;
mod morphs;
mod numbers;
mod open_mesh;
mod open_project;
mod opened;
mod page;
mod page_actions;
mod page_pins;
mod page_stroke;
mod past;
mod preferences;
mod queries;
mod recent;
mod recovery;
mod reshaping;
mod restored_charts;
mod runs;
mod saved_maps;
mod saving;
mod seams;
mod solving;
mod state;
mod status;
mod stop;
mod target_checks;
mod timeline;
mod unwrapping;
mod v_axis;

pub use action::{Action, BakeRequest, BrushDab, PageDab, PatternRequest, SaveRequest, UndoGroup};
pub use atlas_view::AtlasView;
pub use background::{Background, JobFailure, Wake};
pub use chart_layout::{ChartLayout, ChartPlace};
pub use charts::{ChartState, LockState};
pub use command_line::CommandLine;
pub use comparing::{Contender, ContenderState};
pub use comparison::{Compared, comparison_report};
pub use document::{ChartEdits, Command, Document, Shape};
pub use drag::{LivePreview, MovedVertices, Preview};
pub use first_map::{FirstMapWork, MapOrigin};
pub use freebound_run::{Model, SolvedModel, finished_atlas};
pub use history::History;
pub use landmarks::WaitingLandmark;
pub use large::{LargeFile, MissingFile};
pub use layout_check::LayoutCheckState;
pub use messages::{LoggedMessage, Message, MessagePlace, Severity, named};
use messages::{Messages, Written};

pub use morphing::MorphState;
pub use morphs::{MORPH_FRAMES, MissingLeg, MorphLeg, MorphShortage, MorphStop, MorphStops, MorphTour, morph_end};
pub use page::{
    ChartMove, ChartPage, ChartVertices, JudgedFrame, JudgedFrames, JudgedMove, MoveState, PageChart, movement_about,
};
pub use page_stroke::{ChartPlacement, PageStroke};
pub use preferences::{KeptChecker, KeptFolders, Preferences};
pub use recent::RecentFiles;
pub use recovery::{Recoverable, recovery_folder};
pub use state::Session;
pub use status::{Busy, Status};
pub use stop::{RunStop, StopConditions};
pub use timeline::{StepDistortion, TIMELINE_BUDGET, Timeline};
pub use unwrapping::SeamSearch;
