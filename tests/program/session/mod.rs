//! Session: an open document, its history, runs and files, without a window.

pub(crate) mod background;
pub(crate) mod basics;
pub(crate) mod charts;
pub(crate) mod constraints;
pub(crate) mod documents;
pub(crate) mod drag;
pub(crate) mod edits;
pub(crate) mod face_labels;
pub(crate) mod files;
pub(crate) mod forms;
pub(crate) mod fuzz;
pub(crate) mod history;
pub(crate) mod live;
pub(crate) mod many_charts;
pub(crate) mod mend;
pub(crate) mod page;
pub(crate) mod placing;
pub(crate) mod projects;
pub(crate) mod recovery;
pub(crate) mod run;
pub(crate) mod seams;
pub(crate) mod timeline;
pub(crate) mod unwrapping;
pub(crate) mod upright;
pub(crate) mod view_beside;
pub(crate) mod wishes;
