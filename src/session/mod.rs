//! One open document: what the user edits, its history, and the work that goes on in the background. No screen.

mod action;
mod document;
mod files;
mod job;
mod load;
mod message;
mod pane_picture;
mod picture;
mod pins;
mod preview;
mod recent;
mod run;
mod save;
mod solve;
mod state;
mod stop;
mod stubs;
mod timeline;

pub use action::Action;
pub use document::{Command, Document, History};
pub use job::{Job, JobContext, Poll};
pub use load::{Model, Surface};
pub use message::{Message, Place, Severity};
pub use picture::PictureFile;
pub use preview::Preview;
pub use recent::RecentFiles;
pub use save::{Finished, SaveRequest};
pub use solve::{Outcome, OutputFit, Placement};
pub use state::{Busy, Session, Wake};
pub use stop::{Stop, StopConditions};
pub use stubs::Recoverable;
pub use timeline::{TIMELINE_BUDGET, Timeline};
