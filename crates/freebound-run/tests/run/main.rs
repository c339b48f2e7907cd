//! Tests of runs from a mesh in memory to a layout.

mod layouts;
