//! Tests of the feature `gui`. Tests that draw need a Vulkan driver and are ignored by default.
#![cfg(feature = "gui")]
#![allow(clippy::unwrap_used, reason = "a helper that fails fails its test")]
#![allow(clippy::float_cmp, reason = "results are compared to the last bit on purpose")]

mod actions;
mod advice;
mod artist;
mod charts;
mod compare;
mod comparison;
mod constrained;
mod constraint_rows;
mod constraints;
mod defects;
mod dialogs;
mod equation;
mod file_layout;
mod gestures;
mod glide;
mod glyphs;
mod harness;
mod head;
mod help;
mod hull;
mod large;
mod layout;
mod magnifier;
mod mend;
mod messages;
mod morph;
mod newcomer;
mod page;
mod pane_shading;
mod panels;
mod picture_filter;
mod pictures;
mod preferences;
mod presses;
mod render;
mod render_work;
mod screens;
mod seam_numbers;
mod seam_rules;
mod seams;
mod shaders;
mod shortcuts;
mod start;
mod timeline;
mod timeline_run;
mod toast;
mod tour;
mod unsaved;
mod unwrapping;
mod walk;
mod window;
mod without_pins;
