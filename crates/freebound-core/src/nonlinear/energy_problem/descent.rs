//! Descent on an energy: Newton steps with a line search, within the barriers of unfolded triangles.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::super::foldover_energy::{Element, Energy};
use super::damping::Damping;
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

/// Smallest factor by which a step past the outside must exceed the step within it. A shorter one is not worth a new
/// triangulation.
const WORTH_PASSING: f64 = 2.0;

/// Step up to the first fold from which a direction is taken without more damping.
const LONG_ENOUGH: f64 = 0.28;

/// Most directions that are found for one step.
const DIRECTIONS: usize = 4;

/// Most lengths that are tried for a step past the outside.
const TRIES_TO_PASS: usize = 8;

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

/// Outside of a mesh that a step may fold. The outside forbids moves that keep the boundary simple: a boundary vertex
/// may not cross the line between two others. A direct test of the points does not forbid them.
pub(crate) struct PassableOutside<'a> {
    /// Number of elements before those of the outside.
    pub(crate) first: usize,
    /// True if the boundary is simple with all points at these positions.
    pub(crate) is_simple: &'a (dyn Fn(&[DVec2]) -> bool + Sync),
    /// Damping of the elements so far.
    pub(crate) damping: &'a mut Damping,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Descent {
    pub(crate) least_determinant: f64,
    /// Relative decrease of the energy since the triangles were unfolded.
    pub(crate) gain: f64,
    /// Number of Newton steps.
    pub(crate) steps: usize,
    /// True if the last step folded the outside, which ends the descent.
    pub(crate) has_passed: bool,
}

/// Result of one Newton step.
#[derive(Clone, Copy)]
struct Stepped {
    before: f64,
    after: f64,
    has_passed: bool,
}

/// Newton direction.
struct Course {
    direction: Vec<DVec2>,
    /// Slope of the energy along the direction.
    slope: f64,
    /// Energy at the start.
    before: f64,
}

/// Memory that all steps of a descent share.
struct Place<'a> {
    /// Trial points.
    trial: Vec<DVec2>,
    memory: Memory,
    control: Control<'a>,
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
    /// Minimises the energy step by step. Steps may fold the outside if `outside` allows it; such a step is the last.
    pub(crate) fn descend(
        &self,
        z: &mut [DVec2],
        limits: Limits,
        mut outside: Option<PassableOutside<'_>>,
        control: Control<'_>,
    ) -> Result<Descent, SolveError> {
        let mut place = Place { trial: z.to_vec(), memory: self.no_memory(), control };
        let mut unfolded_energies: Option<[f64; 2]> = None;
        // The constant energy of held elements does not count towards the gain.
        let idle = self.energy_of_held(z, limits.unfolded);
        let (mut steps, mut has_passed) = (0, false);
        while steps < limits.steps && !has_passed {
            control.enter(Phase::Solve)?;
            let least = self.least_determinant(z);
            if least > 0.0 && limits.unfolding == Unfolding::Alone {
                break;
            }
            let energies = self.energies(z, least, limits);
            let outside = outside.as_mut().filter(|_| least > 0.0);
            let Some(stepped) = self.newton_step(z, &mut place, &energies, outside)? else { break };
            (steps, has_passed) = (steps + 1, stepped.has_passed);
            if least > 0.0 {
                let [before, after] = [stepped.before, stepped.after].map(|energy| energy - idle);
                let [first, _] = unfolded_energies.unwrap_or([before, before]);
                unfolded_energies = Some([first, after]);
                if before - after < limits.tolerance * before {
                    break;
                }
            }
        }
        let gain = unfolded_energies.map_or(0.0, |[first, last]| 1.0 - last / first);
        Ok(Descent { least_determinant: self.least_determinant(z), gain, steps, has_passed })
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

    /// Takes one step with line search. Returns `None` if no step lowers the energy.
    fn newton_step(
        &self,
        z: &mut [DVec2],
        place: &mut Place<'_>,
        energies: &Energies,
        outside: Option<&mut PassableOutside<'_>>,
    ) -> Result<Option<Stepped>, SolveError> {
        let Some(outside) = outside else {
            let course = self.course(z, energies, &Damping::default(), place)?;
            return self.step_within(z, place, &course, energies);
        };
        let mut directions = 0;
        loop {
            let course = self.course(z, energies, outside.damping, place)?;
            directions += 1;
            let longest = self.longest_steps(z, &course.direction, energies);
            let (inner, beyond) = longest.split_at(outside.first);
            outside.damping.adapt_inner(inner);
            if directions < DIRECTIONS && least(inner) < LONG_ENOUGH {
                continue;
            }
            let limits = [inner, &longest].map(least);
            if let Some(passed) = self.step_past(z, place, &course, energies, outside, limits)? {
                outside.damping.forget_outside();
                return Ok(Some(passed));
            }
            outside.damping.adapt_outside(beyond);
            if directions == DIRECTIONS || least(&longest) >= LONG_ENOUGH {
                return self.step_within(z, place, &course, energies);
            }
        }
    }

    /// Finds the Newton direction at `z`.
    fn course(
        &self,
        z: &[DVec2],
        energies: &Energies,
        damping: &Damping,
        Place { memory, control, .. }: &mut Place<'_>,
    ) -> Result<Course, SolveError> {
        let before = self.energy(z, energies);
        control.go_on()?;
        let (gradient, hessian) = self.linearise(z, energies, damping, *control)?;
        control.go_on()?;
        let direction = self.direction(&gradient, hessian, memory, *control)?;
        control.go_on()?;
        let along = |(&point, g): (&u32, &[f64])| DVec2::new(g[0], g[1]).dot(direction[point as usize]);
        let slope = self.unknowns.iter().zip(gradient.chunks_exact(2)).map(along).sum();
        Ok(Course { direction, slope, before })
    }

    /// Takes a step that folds no element with a barrier.
    fn step_within(
        &self,
        z: &mut [DVec2],
        Place { trial, control, .. }: &mut Place<'_>,
        course: &Course,
        energies: &Energies,
    ) -> Result<Option<Stepped>, SolveError> {
        let longest = least(&self.longest_steps(z, &course.direction, energies));
        let mut step = (STEP_SHARE * longest).min(1.0);
        for _ in 0..HALVINGS {
            control.go_on()?;
            course.follow(z, step, trial);
            let after = self.energy(trial, energies);
            if course.is_descent(step, course.before - after) {
                z.copy_from_slice(trial);
                return Ok(Some(Stepped { before: course.before, after, has_passed: false }));
            }
            step *= 0.5;
        }
        Ok(None)
    }

    /// Takes a step that folds no element before the outside, and is much longer than a step within the outside.
    /// `limits` are the longest steps that fold no element before the outside, and no element at all. Returns `None`
    /// if there is no such step.
    #[expect(clippy::too_many_arguments, reason = "points, direction, energies and limits of one step")]
    fn step_past(
        &self,
        z: &mut [DVec2],
        Place { trial, control, .. }: &mut Place<'_>,
        course: &Course,
        energies: &Energies,
        outside: &PassableOutside<'_>,
        limits: [f64; 2],
    ) -> Result<Option<Stepped>, SolveError> {
        let [mut step, within] = limits.map(|longest| (STEP_SHARE * longest).min(1.0));
        let inner = self.energy_of_first(outside.first, z, energies);
        for _ in 0..TRIES_TO_PASS {
            if step < WORTH_PASSING * within {
                break;
            }
            control.go_on()?;
            course.follow(z, step, trial);
            let decrease = inner - self.energy_of_first(outside.first, trial, energies);
            if course.is_descent(step, decrease) && (outside.is_simple)(trial) {
                z.copy_from_slice(trial);
                return Ok(Some(Stepped { before: course.before, after: course.before - decrease, has_passed: true }));
            }
            step *= 0.5;
        }
        Ok(None)
    }

    /// Longest step along a direction for each element, up to its fold; infinite for elements without a barrier.
    fn longest_steps(&self, z: &[DVec2], direction: &[DVec2], energies: &Energies) -> Vec<f64> {
        let of = |(at, element): (usize, &Element)| {
            if !energies.of(at).is_barrier() {
                return f64::INFINITY;
            }
            Element::longest_step(Self::corners(element, z), Self::corners(element, direction))
        };
        self.elements.par_iter().enumerate().with_min_len(CHUNK).map(of).collect()
    }
}

/// Least of several lengths; infinite if there are none.
fn least(lengths: &[f64]) -> f64 {
    lengths.iter().copied().fold(f64::INFINITY, f64::min)
}

impl Course {
    /// Moves the points by a step.
    fn follow(&self, z: &[DVec2], step: f64, trial: &mut [DVec2]) {
        for ((trial, z), direction) in trial.iter_mut().zip(z).zip(&self.direction) {
            *trial = *z + step * *direction;
        }
    }

    /// True if a step lowers the energy as much as its length promises.
    fn is_descent(&self, step: f64, decrease: f64) -> bool {
        decrease >= -DECREASE * step * self.slope && decrease > 0.0
    }
}
