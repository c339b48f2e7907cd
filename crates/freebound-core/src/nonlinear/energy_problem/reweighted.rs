//! SLIM iteration on the elements: steps towards the minimiser of their proxies while the energy falls.

use glam::DVec2;

use super::super::foldover_energy::{Element, Energy};
use super::super::slim::Proxy;
use super::EnergyProblem;
use super::descent::Energies;
use crate::geom::double_area;
use crate::problem::{Control, Phase, Progress, SolveError};

/// Largest share of the distance to the first fold that a step may take.
const SHARE_BEFORE_FOLD: f64 = 0.8;

/// Number of halvings of a step before it counts as failed.
const HALVINGS: usize = 40;

impl EnergyProblem {
    /// Symmetric Dirichlet energy |J|² + |J⁻¹|² of the first `count` elements, times their weights, and their least
    /// determinant.
    pub(crate) fn standing(&self, z: &[DVec2], count: usize) -> Progress {
        let placed = || self.elements[..count].iter().map(|element| (element, Self::corners(element, z)));
        let energy = placed().map(|(element, z)| 2.0 * element.energy(z, Energy::SymmetricDirichlet)).sum();
        let least_determinant = placed().map(|(element, z)| element.determinant(z)).fold(f64::INFINITY, f64::min);
        Progress { energy, least_determinant, distance_left: 0.0 }
    }

    /// Twice the area of the first `count` elements.
    pub(crate) fn double_area(&self, z: &[DVec2], count: usize) -> f64 {
        self.elements[..count].iter().map(|element| double_area(Self::corners(element, z))).sum()
    }

    /// Steps towards the minimiser of the proxies at `z`, at most to a share of the distance to the first fold. Halves
    /// the step until the energy falls. Returns the energies before and after. Returns `None` and leaves `z` unchanged
    /// if no step lowers the energy.
    pub(crate) fn reweighted_step(
        &self,
        z: &mut Vec<DVec2>,
        control: Control<'_>,
    ) -> Result<Option<[f64; 2]>, SolveError> {
        control.enter(Phase::Assemble)?;
        let energy = |z: &[DVec2]| self.energy(z, &Energies::all(Energy::SymmetricDirichlet));
        let before = energy(z);
        control.go_on()?;
        let proxy = |_: usize, element: &Element| {
            let corners = Self::corners(element, z);
            Proxy::at(element, corners).model(element, corners)
        };
        let (gradient, hessian) = self.assembled(z, proxy, None, control)?;
        control.enter(Phase::Factor)?;
        let direction = self.direction(&gradient, hessian, &mut self.no_memory(), control)?;
        control.enter(Phase::Solve)?;
        let to_fold = self.longest_step(z, &direction, self.elements.len());
        let mut step = (SHARE_BEFORE_FOLD * to_fold).min(1.0);
        for _ in 0..HALVINGS {
            control.go_on()?;
            let trial: Vec<DVec2> = z.iter().zip(&direction).map(|(z, direction)| *z + step * *direction).collect();
            let after = energy(&trial);
            if after < before {
                *z = trial;
                return Ok(Some([before, after]));
            }
            step *= 0.5;
        }
        Ok(None)
    }

    /// Moves to the minimiser of Σ A ½ |J − R|², with the rotation R of each element as a complex number of length 1.
    pub(crate) fn rigid_step(
        &self,
        z: &mut [DVec2],
        rotation: impl Fn(usize, &Element) -> DVec2 + Sync,
        control: Control<'_>,
    ) -> Result<(), SolveError> {
        control.enter(Phase::Assemble)?;
        let at = |number: usize, element: &Element| {
            Proxy::rigid(rotation(number, element)).model(element, Self::corners(element, z))
        };
        let (gradient, hessian) = self.assembled(z, at, None, control)?;
        control.enter(Phase::Factor)?;
        let direction = self.direction(&gradient, hessian, &mut self.no_memory(), control)?;
        z.iter_mut().zip(direction).for_each(|(z, by)| *z += by);
        Ok(())
    }
}
