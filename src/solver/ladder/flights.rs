//! The rungs by name, and which flights of them a part of a plan can have.

use self::Kind::{
    Again, Angles, Continuation, FewVertices, Fit, Given, Held, Iterate, Lee, Matchmaker, Natural, Schnyder, Slim,
    Spectral, Stretch, VirtualBoundary,
};
use super::Kept;
use super::rung::Rung;
use super::{
    again, angles, coarse, continuation, given, held, iterate, lee, matchmaker, natural, schnyder, slim, spectral,
    stretch, virtual_boundary,
};

/// The rungs of a part, flight by flight.
pub(super) type Flights = &'static [&'static [Kind]];

/// Until planar.
pub(super) const LADDER: Flights =
    &[&[Natural, Iterate], &[Again, Iterate], &[FewVertices], &[VirtualBoundary], &[Schnyder]];
/// Until planar, stalled or at the limit.
pub(super) const ITERATED: Flights = &[&[Natural, Iterate]];
/// Until planar.
pub(super) const BENT: Flights = &[&[Natural], &[VirtualBoundary]];
/// By theorem.
pub(super) const DRAWN: Flights = &[&[Schnyder]];
/// One linear solve of mesh and padding.
pub(super) const PADDED: Flights = &[&[Lee]];
/// As long as the energy falls.
pub(super) const LESS_ENERGETIC: Flights = &[&[Slim]];
/// As long as stretch falls.
pub(super) const LESS_STRETCHED: Flights = &[&[Stretch]];
/// Angles, laid out.
pub(super) const ANGLES: Flights = &[&[Angles]];
/// One eigenvector.
pub(super) const SPECTRAL: Flights = &[&[Spectral]];
/// One linear solve.
pub(super) const LINEAR: Flights = &[&[Natural]];
/// From a planar start until the constraints are met, or stuck.
pub(super) const CONTINUED: Flights = &[&[Fit, Continuation]];
/// From a boundary that follows its targets until the constraints are met, or stuck.
pub(super) const HELD: Flights = &[&[Held, Continuation]];
/// From a planar start until the constraints are met, with new vertices.
pub(super) const MATCHED: Flights = &[&[Fit, Matchmaker]];
/// From a planar start until the constraints are met, with new vertices where it cannot be otherwise.
pub(super) const CONTINUED_OR_MATCHED: Flights = &[&[Fit, Continuation], &[Matchmaker]];
/// From a one-to-one embedding, as it lies, until the constraints are met, or stuck.
pub(super) const GOING_ON: Flights = &[&[Continuation]];

/// The layout that it starts from, as it is.
pub(super) const GIVEN: Flights = &[&[Given]];
/// From that until planar, stalled or at the limit.
pub(super) const GIVEN_ITERATED: Flights = &[&[Given, Iterate]];
/// From that until planar.
pub(super) const GIVEN_BENT: Flights = &[&[Given], &[VirtualBoundary]];

/// Every rung but relaxing, which follows all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
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

impl Kind {
    pub(super) fn rung(self, kept: &Kept) -> Box<dyn Rung> {
        match self {
            Given => Box::<given::Given>::default(),
            Natural => Box::new(natural::Natural { prepared: kept.prepared.clone() }),
            Iterate => Box::<iterate::Iterate>::default(),
            Again => Box::<again::Again>::default(),
            FewVertices => Box::<coarse::FewVertices>::default(),
            VirtualBoundary => Box::<virtual_boundary::Bend>::default(),
            Schnyder => Box::<schnyder::Draw>::default(),
            Stretch => Box::<stretch::Stretch>::default(),
            Slim => Box::<slim::Iterations>::default(),
            Lee => Box::<lee::Pad>::default(),
            Spectral => Box::<spectral::Eigenvector>::default(),
            Angles => Box::<angles::Angles>::default(),
            Fit => Box::new(continuation::Fit { start: kept.planar_start.clone(), is_done: false }),
            Held => Box::<held::Held>::default(),
            Continuation => Box::<continuation::Continue>::default(),
            Matchmaker => Box::<matchmaker::Match>::default(),
        }
    }
}
