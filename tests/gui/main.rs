//! Tests of what needs the feature `gui`. Those that draw need a Vulkan driver and are ignored without being asked for.
#![cfg(feature = "gui")]

mod defects;
mod dialogs;
mod gestures;
mod glyphs;
mod harness;
mod panels;
mod render;
mod screens;
mod shaders;
mod shortcuts;
mod window;
