//! Tests of what needs the feature `gui`. Those that draw need a Vulkan driver and are ignored without being asked for.
#![cfg(feature = "gui")]

mod glyphs;
mod render;
mod shaders;
