//! Stages by name, and the sequences of stages of a phase.

use self::StageKind::{
    Again, Angles, Continuation, FewVertices, Fit, Given, Held, Iterate, Lee, Matchmaker, Natural, Schnyder, Slim,
    Spectral, Stretch, VirtualBoundary,
};
use super::SolverCache;
use super::stage::RunStage;
use super::{coarse, continuation, held, iterate, matchmaker, single_step, slim, stretch, virtual_boundary};

/// Stages of a phase, sequence by sequence.
pub(super) type Sequence = &'static [&'static [StageKind]];

/// All stages of `auto`, until planar.
pub(super) const LADDER: Sequence =
    &[&[Natural, Iterate], &[Again, Iterate], &[FewVertices], &[VirtualBoundary], &[Schnyder]];
/// Iteration, until planar, stalled or at the limit.
pub(super) const ITERATED: Sequence = &[&[Natural, Iterate]];
/// Virtual boundary, until planar.
pub(super) const BENT: Sequence = &[&[Natural], &[VirtualBoundary]];
/// Grid drawing, planar by theorem.
pub(super) const DRAWN: Sequence = &[&[Schnyder]];
/// Lee's method: a single linear solve of mesh and padding.
pub(super) const PADDED: Sequence = &[&[Lee]];
/// SLIM, while the energy falls.
pub(super) const LESS_ENERGETIC: Sequence = &[&[Slim]];
/// Stretch minimising, while the stretch falls.
pub(super) const LESS_STRETCHED: Sequence = &[&[Stretch]];
/// Angle based flattening.
pub(super) const ANGLES: Sequence = &[&[Angles]];
/// Spectral map: a single eigenvector.
pub(super) const SPECTRAL: Sequence = &[&[Spectral]];
/// Single linear solve.
pub(super) const LINEAR: Sequence = &[&[Natural]];
/// Continuation from a planar start until the constraints are met, or stuck.
pub(super) const CONTINUED: Sequence = &[&[Fit, Continuation]];
/// Continuation from a boundary that follows its targets until the constraints are met, or stuck.
pub(super) const HELD: Sequence = &[&[Held, Continuation]];
/// Matchmaker from a planar start, which meets the constraints with new vertices.
pub(super) const MATCHED: Sequence = &[&[Fit, Matchmaker]];
/// Continuation from a planar start, then new vertices if the constraints cannot be met otherwise.
pub(super) const CONTINUED_OR_MATCHED: Sequence = &[&[Fit, Continuation], &[Matchmaker]];
/// Continuation from a one-to-one embedding, not moved to fit, until the constraints are met, or stuck.
pub(super) const CONTINUING: Sequence = &[&[Continuation]];

/// Given layout, unchanged.
pub(super) const GIVEN: Sequence = &[&[Given]];
/// Iteration from the given layout, until planar, stalled or at the limit.
pub(super) const GIVEN_ITERATED: Sequence = &[&[Given, Iterate]];
/// Virtual boundary from the given layout, until planar.
pub(super) const GIVEN_BENT: Sequence = &[&[Given], &[VirtualBoundary]];

/// Name of a stage. Relaxing has none: it can follow every stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum StageKind {
    Given,
    Natural,
    Iterate,
    Again,
    FewVertices,
    VirtualBoundary,
    Schnyder,
    Stretch,
    Slim,
    Lee,
    Spectral,
    Angles,
    Fit,
    Held,
    Continuation,
    Matchmaker,
}

impl StageKind {
    pub(super) fn stage(self, cache: &SolverCache) -> Box<dyn RunStage> {
        match self {
            Given => Box::<single_step::Given>::default(),
            Natural => Box::new(single_step::Natural { prepared: cache.prepared.clone() }),
            Iterate => Box::<iterate::Iterate>::default(),
            Again => Box::<single_step::Again>::default(),
            FewVertices => Box::<coarse::FewVertices>::default(),
            VirtualBoundary => Box::<virtual_boundary::Bend>::default(),
            Schnyder => Box::<single_step::Draw>::default(),
            Stretch => Box::<stretch::Stretch>::default(),
            Slim => Box::<slim::Iterations>::default(),
            Lee => Box::<single_step::Pad>::default(),
            Spectral => Box::<single_step::Eigenvector>::default(),
            Angles => Box::<single_step::Angles>::default(),
            Fit => Box::new(continuation::Fit { start: cache.planar_start.clone(), is_done: false }),
            Held => Box::<held::HeldBoundary>::default(),
            Continuation => Box::<continuation::Continue>::default(),
            Matchmaker => Box::<matchmaker::Match>::default(),
        }
    }
}
