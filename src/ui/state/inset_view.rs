//! Zoom and pan of the insets over the panes.

use glam::DVec2;

use freebound_core::mesh::VertexId;

/// Limits of the zoom of an inset.
const REACH: std::ops::RangeInclusive<f64> = 0.1..=1e4;

/// Zoom and pan of the insets. The wheel zooms, a drag pans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ui) struct InsetView {
    /// Defect that the zoom belongs to, by its place in the list; `None` for pairs.
    of: Option<usize>,
    factor: f64,
    /// Pan of each kind of inset, with its subject; points.
    panned: [Option<(InsetSubject, DVec2)>; 3],
}

impl Default for InsetView {
    fn default() -> Self {
        Self { of: None, factor: 1.0, panned: [None; 3] }
    }
}

impl InsetView {
    /// True if the user has zoomed or panned an inset.
    pub(in crate::ui) fn is_set(&self, kind: InsetKind, about: InsetSubject) -> bool {
        (self.factor(about.defect()) - 1.0).abs() > f64::EPSILON || self.panned(kind, about) != DVec2::ZERO
    }

    /// Zoom of the inset of a defect, or of a pair. Another defect starts at 1.
    pub(in crate::ui) fn factor(&self, of: Option<usize>) -> f64 {
        if self.of == of { self.factor } else { 1.0 }
    }

    /// Pan of an inset, points. Another subject starts at zero.
    pub(in crate::ui) fn panned(&self, kind: InsetKind, about: InsetSubject) -> DVec2 {
        self.panned[kind as usize].filter(|(of, _)| *of == about).map_or(DVec2::ZERO, |(_, by)| by)
    }

    pub(in crate::ui) fn bring_nearer(&mut self, of: Option<usize>, by: f64) {
        let before = self.factor(of);
        let factor = (before * by).clamp(*REACH.start(), *REACH.end());
        (self.of, self.factor) = (of, factor);
        // Keep the point in the middle fixed.
        for (_, panned) in self.panned.iter_mut().flatten().filter(|(about, _)| about.defect() == of) {
            *panned *= factor / before;
        }
    }

    pub(in crate::ui) fn pan(&mut self, InsetPan { kind, about, by }: InsetPan) {
        self.panned[kind as usize] = Some((about, self.panned(kind, about) + by));
    }
}

/// Subject of an inset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum InsetSubject {
    /// Defect, by its place in the list.
    Defect(usize),
    /// Pair, by its vertex if already chosen.
    Pair(Option<VertexId>),
}

impl InsetSubject {
    pub(in crate::ui) const fn defect(self) -> Option<usize> {
        match self {
            Self::Defect(place) => Some(place),
            Self::Pair(_) => None,
        }
    }
}

/// Drag over an inset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsetPan {
    pub(in crate::ui) kind: InsetKind,
    pub(in crate::ui) about: InsetSubject,
    /// Displacement, points of the screen.
    pub(in crate::ui) by: DVec2,
}

/// Kinds of insets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::ui) enum InsetKind {
    /// Defect in the plane.
    Defect,
    /// Vertex of a pair, on the mesh.
    PairOnMesh,
    /// Target of a pair, in the plane.
    PairInPlane,
}
