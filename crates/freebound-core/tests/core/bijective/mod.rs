//! Continuation, matchmaker, relaxation, dragging, morphs, virtual boundary and Schnyder drawings.

pub(crate) mod brush;
pub(crate) mod coarse;
pub(crate) mod continuation;
pub(crate) mod live;
pub(crate) mod matchmaker;
pub(crate) mod morph;
pub(crate) mod needless;
pub(crate) mod relaxing;
pub(crate) mod room;
pub(crate) mod schnyder;
pub(crate) mod virtual_boundary;
