//! The stages by name, and which sequences of them a part of a strategy can have.

use self::StageKind::{
    Again, Angles, Continuation, FewVertices, Fit, Given, Held, Iterate, Lee, Matchmaker, Natural, Schnyder, Slim,
    Spectral, Stretch, VirtualBoundary,
};
use super::SolverCache;
use super::stage::RunStage;
use super::{coarse, continuation, held, iterate, matchmaker, single_step, slim, stretch, virtual_boundary};

/// The stages of a phase, sequence by sequence.
pub(super) type Sequence = &'static [&'static [StageKind]];

/// Until planar.
pub(super) const LADDER: Sequence =
    &[&[Natural, Iterate], &[Again, Iterate], &[FewVertices], &[VirtualBoundary], &[Schnyder]];
/// Until planar, stalled or at the limit.
pub(super) const ITERATED: Sequence = &[&[Natural, Iterate]];
/// Until planar.
pub(super) const BENT: Sequence = &[&[Natural], &[VirtualBoundary]];
/// By theorem.
pub(super) const DRAWN: Sequence = &[&[Schnyder]];
/// One linear solve of mesh and padding.
pub(super) const PADDED: Sequence = &[&[Lee]];
/// As long as the energy falls.
pub(super) const LESS_ENERGETIC: Sequence = &[&[Slim]];
/// As long as stretch falls.
pub(super) const LESS_STRETCHED: Sequence = &[&[Stretch]];
/// Angles, laid out.
pub(super) const ANGLES: Sequence = &[&[Angles]];
/// One eigenvector.
pub(super) const SPECTRAL: Sequence = &[&[Spectral]];
/// One linear solve.
pub(super) const LINEAR: Sequence = &[&[Natural]];
/// From a planar start until the constraints are met, or stuck.
pub(super) const CONTINUED: Sequence = &[&[Fit, Continuation]];
/// From a boundary that follows its targets until the constraints are met, or stuck.
pub(super) const HELD: Sequence = &[&[Held, Continuation]];
/// From a planar start until the constraints are met, with new vertices.
pub(super) const MATCHED: Sequence = &[&[Fit, Matchmaker]];
/// From a planar start until the constraints are met, with new vertices where it cannot be otherwise.
pub(super) const CONTINUED_OR_MATCHED: Sequence = &[&[Fit, Continuation], &[Matchmaker]];
/// From a one-to-one embedding, as it lies, until the constraints are met, or stuck.
pub(super) const CONTINUING: Sequence = &[&[Continuation]];

/// The layout that it starts from, as it is.
pub(super) const GIVEN: Sequence = &[&[Given]];
/// From that until planar, stalled or at the limit.
pub(super) const GIVEN_ITERATED: Sequence = &[&[Given, Iterate]];
/// From that until planar.
pub(super) const GIVEN_BENT: Sequence = &[&[Given], &[VirtualBoundary]];

/// Every stage but relaxing, which follows all of them.
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
