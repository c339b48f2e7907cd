//! The problem of one disk or chart: settings, output frame and targets.

use std::sync::Arc;

use super::{Target, Targets, pins_in_plane, upright};
use crate::bijective::DragTarget;
use crate::flatten::{Flattener, Options};
use crate::geom::{Bounds, PictureFrame};
use crate::mesh::VertexId;
use crate::problem::{Embedding, GaugeSize, Method, Pins, Settings, Variant};
use crate::verify::UvFrame;

/// Least number of pins that fix the map: two fix position, rotation and size.
const HOLDING_PINS: usize = 2;

/// Map that the user shaped by hand: one position per vertex, in the plane. Equal if all positions are.
#[derive(Clone, Debug)]
pub struct ShapedMap(pub Arc<Embedding>);

impl PartialEq for ShapedMap {
    fn eq(&self, other: &Self) -> bool {
        // Most maps are shared, and a map can have a million vertices.
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

/// Problem of one chart: settings, output frame and targets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// Method and weights.
    pub settings: Settings,
    /// Position of texture coordinates in the plane of the embedding.
    pub frame: PictureFrame,
    /// Targets of the user's pins.
    pub targets: Targets,
    /// Map that the steps start from, if the user shaped one.
    pub shaped: Option<ShapedMap>,
}

impl Problem {
    /// Makes a problem. With a picture, an embedding without pins lies within the picture. Without a picture, its
    /// area is the area of the surface.
    pub fn new(settings: &Settings, frame: PictureFrame, has_picture: bool, targets: Targets) -> Self {
        let [low, high] = frame.corners();
        let size = if has_picture { GaugeSize::Within(Bounds { low, high }) } else { GaugeSize::TrueArea };
        Self { settings: Settings { size, ..settings.clone() }, frame, targets, shaped: None }
    }

    /// This problem, with steps that start from a map that the user shaped.
    #[must_use]
    pub fn with_shaped_map(self, shaped: Option<ShapedMap>) -> Self {
        Self { shaped, ..self }
    }

    /// Pins in the plane of the embedding.
    pub fn pins(&self) -> Pins {
        pins_in_plane(&self.targets, self.frame)
    }

    /// Options of a flattener for this problem. Each step is proved in its output coordinates.
    pub fn options(&self) -> Options {
        Options {
            settings: self.settings.clone(),
            pins: self.pins(),
            output_frame: self.output_frame(),
            ..Options::default()
        }
    }

    /// Options of a flattener that starts from an existing layout: one texture coordinate per vertex, v up.
    pub fn options_from(&self, layout: &Embedding) -> Options {
        Options { layout: Some(Arc::new(self.in_plane(layout))), ..self.options() }
    }

    /// Options of a flattener that starts from a planar map, which leaves position, rotation and size open. The map
    /// is used by [`Method::Auto`] without pins alone.
    pub fn options_with_map(&self, map: Option<Embedding>) -> Options {
        let is_usable = self.settings.method == Method::Auto && self.targets.is_empty();
        let layout = map.filter(|_| is_usable).map(Arc::new);
        Options { layout_is_free: layout.is_some(), layout, ..self.options() }
    }

    /// Position of a layout in the plane. The layout has v up.
    pub fn in_plane(&self, layout: &Embedding) -> Embedding {
        let upright = upright(layout, self.frame.v_axis);
        upright.as_ref().unwrap_or(layout).iter().map(|&uv| self.frame.plane_from_uv(uv)).collect()
    }

    /// Flattener of this problem. Each step is proved in its output coordinates.
    pub fn flattener(&self) -> Flattener {
        Flattener::with_options(self.options())
    }

    /// Output frame: the picture's frame and the texture coordinates of hard pins.
    pub fn output_frame(&self) -> UvFrame {
        let is_hard = |target: &Target| self.settings.is_hard(target.kind);
        let exact = self.targets.iter().filter(|(_, target)| is_hard(target));
        UvFrame::new(self.frame, exact.map(|(&vertex, target)| (vertex, target.uv)).collect())
    }

    /// True if the user shaped a map that meets all hard pins as it is.
    pub fn shaped_map_meets_pins(&self) -> bool {
        let Some(ShapedMap(shaped)) = &self.shaped else { return false };
        let pins = self.settings.held(&self.pins());
        let mut hard = pins.iter().filter(|(_, pin)| pin.kind.is_hard());
        hard.all(|(vertex, pin)| shaped.get(vertex.index()) == Some(&pin.target))
    }

    /// True if both problems pin the same vertices in the same way and differ at most in targets.
    pub fn differs_in_targets_alone(&self, other: &Self) -> bool {
        let is_alike = self.settings.resolves_to(&other.settings) && self.frame == other.frame;
        let is_alike = is_alike && self.shaped == other.shaped;
        let are_like = |((v, target), (w, other)): ((&VertexId, &Target), (&VertexId, &Target))| {
            v == w && target.kind.is_like(other.kind)
        };
        is_alike && self.targets.len() == other.targets.len() && self.targets.iter().zip(&other.targets).all(are_like)
    }

    /// True if both problems have identical steps. Targets are compared only if the method uses pins.
    pub fn has_steps_of(&self, other: &Self) -> bool {
        let has_targets = !self.settings.method.uses_pins() || self.targets == other.targets;
        has_targets && self.settings == other.settings && self.frame == other.frame && self.shaped == other.shaped
    }

    /// This problem with another method, which starts from scratch.
    #[must_use]
    pub fn by(&self, variant: &Variant) -> Self {
        Self { settings: variant.settings(&self.settings), shaped: None, ..self.clone() }
    }

    /// True if a method is useful for this problem. With constraints, the method must accept constraints. Without
    /// constraints, the method must have something to do without them.
    pub fn suits(&self, method: &Method) -> bool {
        if self.settings.are_constraints(&self.pins()) {
            method.takes_constraints()
        } else {
            !method.only_meets_constraints()
        }
    }

    /// True if a planar solution of `before` can start this problem. Settings must agree except for edge splits, and
    /// at least two targets must be unchanged.
    pub fn continues_from(&self, before: &Self) -> bool {
        let of_way = |settings: Settings| Settings { new_vertices: true, ..settings };
        let is_alike = of_way(self.settings.clone()).resolves_to(&of_way(before.settings.clone()))
            && self.frame == before.frame
            && self.shaped == before.shaped;
        let stays = before
            .targets
            .iter()
            .filter(|(vertex, target)| self.targets.get(vertex).is_some_and(|now| now.uv == target.uv));
        is_alike && self.settings.continues(&self.pins()) && stays.count() >= HOLDING_PINS
    }

    /// Pins and output frame of a drag.
    pub fn drag_target(&self) -> DragTarget {
        DragTarget { pins: self.settings.held(&self.pins()), sheet: Arc::new(self.output_frame()) }
    }

    /// True if both problems differ at most in the targets of `moved`, which is sorted. All of `moved` must be
    /// pinned.
    pub fn differs_in_targets_of(&self, other: &Self, moved: &[VertexId]) -> bool {
        let is_moved = |vertex: &VertexId| moved.binary_search(vertex).is_ok();
        let stays = |(vertex, target): (&VertexId, &Target)| {
            is_moved(vertex) || self.targets.get(vertex).is_some_and(|before| before.uv == target.uv)
        };
        let have_all = moved.iter().all(|vertex| self.targets.contains_key(vertex));
        have_all && other.targets.iter().all(stays) && self.differs_in_targets_alone(other)
    }
}
