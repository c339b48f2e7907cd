//! Descent on an energy: Newton steps with a line search, within the barriers of unfolded triangles.

use crate::parallel::prelude::*;
use crate::parallel::reduce;
use glam::DVec2;

use super::super::foldover_energy::{Element, Energy};
use super::direction::Memory;
use super::{CHUNK, EnergyProblem};
use crate::linear::block_pattern::HELD;
use crate::problem::{Control, Phase, SolveError};

/// Smallest ε² while a triangle is folded.
const LEAST_EPSILON_SQUARED: f64 = 1e-12;

/// Smallest ε² while a triangle is folded and the others have barriers. Folded triangles end with a clearly positive
/// area.
const LEAST_EPSILON_SQUARED_BESIDE_BARRIERS: f64 = 1e-4;

/// Share of the worst determinant's square that is added to the smallest ε².
const EPSILON_SQUARED_SHARE: f64 = 0.04;

/// Largest share of the longest unfolded step.
const STEP_SHARE: f64 = 0.9;

/// Smallest decrease of the energy, relative to the decrease that the gradient predicts (Armijo).
const DECREASE: f64 = 1e-4;

/// Number of halvings of a step before it counts as failed.
const HALVINGS: usize = 40;

/// Rule for a descent while some triangle is folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unfolding {
    /// Other triangles may fold meanwhile. The descent continues once none is folded.
    Freely,
    /// Other triangles may fold meanwhile. The descent ends once none is folded.
    Alone,
    /// Unfolded triangles stay unfolded.
    BesideBarriers,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Largest number of Newton steps.
    pub(crate) steps: usize,
    /// Energy while no triangle is folded: a barrier.
    pub(crate) unfolded: Energy,
    /// Rule while some triangle is folded.
    pub(crate) unfolding: Unfolding,
    /// Smallest relative decrease of the energy after which the descent continues, once no triangle is folded.
    pub(crate) tolerance: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Descent {
    pub(crate) least_determinant: f64,
    /// Relative decrease of the energy since the triangles were unfolded.
    pub(crate) gain: f64,
}

/// Memory that all steps of a descent share.
struct Place {
    /// Trial points.
    trial: Vec<DVec2>,
    memory: Memory,
}

/// Energy of each element.
pub(super) struct Energies {
    unfolded: Energy,
    folded: Energy,
    /// True for each folded element; empty if all have the unfolded energy.
    is_folded: Vec<bool>,
    /// Number of leading elements that are measured at their own size, and their energy.
    own: Option<(usize, Energy)>,
}

impl Energies {
    pub(super) fn all(energy: Energy) -> Self {
        Self { unfolded: energy, folded: energy, is_folded: Vec::new(), own: None }
    }

    fn is_folded(&self, element: usize) -> bool {
        self.is_folded.get(element) == Some(&true)
    }

    pub(super) fn of(&self, element: usize) -> Energy {
        match self.own {
            Some((count, energy)) if element < count => energy,
            _ if self.is_folded(element) => self.folded,
            _ => self.unfolded,
        }
    }

    /// Number of leading elements that are measured at their own size.
    pub(super) fn own_count(&self) -> usize {
        self.own.map_or(0, |(count, _)| count)
    }
}

impl EnergyProblem {
    /// Minimises the energy step by step.
    pub(crate) fn descend(&self, z: &mut [DVec2], limits: Limits, control: Control<'_>) -> Result<Descent, SolveError> {
        let mut place = Place { trial: z.to_vec(), memory: self.no_memory() };
        let mut unfolded_energies: Option<[f64; 2]> = None;
        // The constant energy of held elements does not count towards the gain.
        let idle = self.energy_of_held(z, limits.unfolded);
        for _ in 0..limits.steps {
            control.enter(Phase::Solve)?;
            let least = self.least_determinant(z);
            if least > 0.0 && limits.unfolding == Unfolding::Alone {
                break;
            }
            let energies = self.energies(z, least, limits);
            let Some([before, after]) = self.newton_step(z, &mut place, &energies, control)? else { break };
            if least > 0.0 {
                let [before, after] = [before, after].map(|energy| energy - idle);
                let [first, _] = unfolded_energies.unwrap_or([before, before]);
                unfolded_energies = Some([first, after]);
                if before - after < limits.tolerance * before {
                    break;
                }
            }
        }
        let gain = unfolded_energies.map_or(0.0, |[first, last]| 1.0 - last / first);
        Ok(Descent { least_determinant: self.least_determinant(z), gain })
    }

    /// Energy of the elements whose corners are all held; 0 if one of them is folded.
    fn energy_of_held(&self, z: &[DVec2], energy: Energy) -> f64 {
        let is_held = |element: &&Element| element.corners.iter().all(|&c| self.unknown_of[c as usize] == HELD);
        let of = |element: &Element| element.energy(Self::corners(element, z), energy);
        let sum: f64 = self.elements.iter().filter(is_held).map(of).sum();
        if sum.is_finite() { sum } else { 0.0 }
    }

    /// Energies for a step from points with this least determinant.
    fn energies(&self, z: &[DVec2], least: f64, limits: Limits) -> Energies {
        if least > 0.0 {
            let is_sized = self.own_count > 0 && limits.unfolded == Energy::SymmetricDirichlet;
            let own = is_sized.then(|| (self.own_count, self.own_sums(z).model()));
            return Energies { own, ..Energies::all(limits.unfolded) };
        }
        let has_barriers = limits.unfolding == Unfolding::BesideBarriers;
        let floor = if has_barriers { LEAST_EPSILON_SQUARED_BESIDE_BARRIERS } else { LEAST_EPSILON_SQUARED };
        let folded = Energy::Foldover((floor + EPSILON_SQUARED_SHARE * least * least).sqrt());
        if !has_barriers {
            return Energies::all(folded);
        }
        let is_folded = |element: &Element| element.determinant(Self::corners(element, z)) <= 0.0;
        let is_folded = self.elements.par_iter().with_min_len(CHUNK).map(is_folded).collect();
        Energies { unfolded: limits.unfolded, folded, is_folded, own: None }
    }

    /// Longest step along a direction that folds no element with a barrier.
    fn longest_within_barriers(&self, z: &[DVec2], direction: &[DVec2], energies: &Energies) -> f64 {
        let of = |(at, element): (usize, &Element)| {
            if !energies.of(at).is_barrier() {
                return f64::INFINITY;
            }
            Element::longest_step(Self::corners(element, z), Self::corners(element, direction))
        };
        reduce(self.elements.par_iter().enumerate().with_min_len(CHUNK).map(of), || f64::INFINITY, f64::min)
    }

    /// Takes one step with line search. Returns the energies before and after, or `None` if no step lowers the energy.
    fn newton_step(
        &self,
        z: &mut [DVec2],
        Place { trial, memory }: &mut Place,
        energies: &Energies,
        control: Control<'_>,
    ) -> Result<Option<[f64; 2]>, SolveError> {
        let before = self.energy(z, energies);
        control.go_on()?;
        let (gradient, hessian) = self.linearise(z, energies, None, control)?;
        control.go_on()?;
        let direction = self.direction(&gradient, hessian, memory, control)?;
        control.go_on()?;
        let along = |(&point, g): (&u32, &[f64])| DVec2::new(g[0], g[1]).dot(direction[point as usize]);
        let slope: f64 = self.unknowns.iter().zip(gradient.chunks_exact(2)).map(along).sum();
        let mut step = (STEP_SHARE * self.longest_within_barriers(z, &direction, energies)).min(1.0);
        for _ in 0..HALVINGS {
            control.go_on()?;
            for ((trial, z), direction) in trial.iter_mut().zip(&*z).zip(&direction) {
                *trial = *z + step * *direction;
            }
            let after = self.energy(trial, energies);
            if before - after >= -DECREASE * step * slope && after < before {
                z.copy_from_slice(trial);
                return Ok(Some([before, after]));
            }
            step *= 0.5;
        }
        Ok(None)
    }
}
