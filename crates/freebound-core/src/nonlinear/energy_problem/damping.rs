//! Damping of single elements: stiffness against strain that lets the others take long steps.
//!
//! A step ends before the first element folds. In a mesh of many thousand faces, one needle or one narrow gap between
//! two parts of the boundary would limit the step of all points. So elements that allow only a short step become
//! stiffer, by the square of the factor that they lack, and the direction is found anew. Elements that allow a long
//! step are eased. Rotations stay free, so that stiff elements follow the others.

/// Longest step, up to the fold of an element, from which the element is eased: a full Newton step.
const ROOMY: f64 = 1.0;

/// Damping of an element that has had none, relative to its energy.
const FIRST: f64 = 0.1;

/// Largest damping. It makes a needle of 10⁻⁹ of a neighbour's area as stiff as the neighbour.
const MOST: f64 = 1e9;

/// Factor of the damping of an element that allows a long step.
const EASING: f64 = 0.25;

/// Damping of the elements of a mesh and of its outside, as multiples of their energies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Damping {
    inner: Vec<f64>,
    outside: Vec<f64>,
}

/// Strain that an element is damped against, with its stiffness relative to the element's energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Damped {
    /// All strain. Rotations are free.
    Strain(f64),
    /// Change of area alone: the sides of a gap may slide along each other.
    Area(f64),
}

impl Damping {
    /// Damping of an element; 0 if there is none.
    pub(super) fn of(&self, element: usize) -> Damped {
        match (self.inner.get(element), self.outside.get(element.wrapping_sub(self.inner.len()))) {
            (Some(&damping), _) => Damped::Strain(damping),
            (None, damping) => Damped::Area(damping.copied().unwrap_or(0.0)),
        }
    }

    /// Adapts the damping of the mesh to the longest steps of its elements along a direction.
    pub(super) fn adapt_inner(&mut self, longest: &[f64]) {
        adapt(&mut self.inner, longest);
    }

    /// Adapts the damping of the outside to the longest steps of its elements along a direction.
    pub(super) fn adapt_outside(&mut self, longest: &[f64]) {
        adapt(&mut self.outside, longest);
    }

    /// Forgets the outside, because its triangles change.
    pub(crate) fn forget_outside(&mut self) {
        self.outside.clear();
    }
}

fn adapt(damping: &mut Vec<f64>, longest: &[f64]) {
    damping.resize(longest.len(), 0.0);
    for (damping, &longest) in damping.iter_mut().zip(longest) {
        *damping = if longest < ROOMY {
            (damping.max(FIRST) * (ROOMY / longest).powi(2)).min(MOST)
        } else {
            EASING * *damping
        };
    }
}
