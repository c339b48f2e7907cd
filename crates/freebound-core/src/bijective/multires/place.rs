//! Return of one vertex into the polygon of its neighbours.

use glam::{DVec2, DVec3};

use crate::geom::{Orientation, centre_of_gravity, kernel, orientation};
use crate::mesh::{THINNEST, laid_flat};
use crate::nonlinear::foldover_energy::{Element, Energy, Stiffness};

/// Steps of a vertex that is put back, with its neighbours held.
const PUT_BACK: Steps = Steps { most: 4, share: SHARE_BEFORE_FOLD };

/// Largest step, as a share of the distance to the first fold.
pub(super) const SHARE_BEFORE_FOLD: f64 = 0.8;
/// Most halvings of a step.
const HALVINGS: usize = 8;

/// Least relative gain of a step that is followed by another.
const TOLERANCE: f64 = 1e-2;

/// Most halvings of the distance from a corner into the polygon.
const HALVINGS_FROM_CORNER: usize = 60;

/// Limits of the Newton steps of one vertex.
#[derive(Clone, Copy)]
pub(super) struct Steps {
    /// Most steps.
    pub(super) most: usize,
    /// Largest step, as a share of the distance to the first fold.
    pub(super) share: f64,
}

/// Polygon around a vertex, into which it is put back or in which it moves.
pub(super) struct Room<'a> {
    /// Corners, counter-clockwise. The first corner sees the whole polygon if a vertex is put back.
    pub(super) polygon: &'a [DVec2],
    /// Triangles of the vertex that resist distortion. The vertex is point 0; the polygon's corners follow.
    pub(super) elements: &'a [Element],
}

impl Room<'_> {
    /// Position of the vertex with little distortion, in which all triangles to the polygon's sides are positive.
    /// Improves `guess` if that is such a position. `None` if rounding leaves no such position.
    pub(super) fn place(&self, guess: Option<DVec2>) -> Option<DVec2> {
        let middle = || centre_of_gravity(&kernel(self.polygon));
        let in_order = |z: &DVec2| self.is_in_order(*z);
        let begin = guess.filter(in_order).or_else(|| middle().filter(in_order)).or_else(|| self.near_corner())?;
        Some(self.improved(begin, PUT_BACK))
    }

    /// True if all triangles from a point to the polygon's sides are positive.
    fn is_in_order(&self, z: DVec2) -> bool {
        self.sides().all(|[a, b]| orientation(z, a, b) == Some(Orientation::CounterClockwise))
    }

    fn sides(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let next = self.polygon.iter().cycle().skip(1);
        self.polygon.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// Valid position on the bisector of the first corner's angle, as far as possible from the corner.
    fn near_corner(&self) -> Option<DVec2> {
        let corner = self.polygon[0];
        let to = |z: DVec2| (z - corner).normalize_or_zero();
        let spokes: Vec<DVec2> = self.polygon[1..].iter().map(|z| to(*z)).collect();
        let angle: f64 = spokes.windows(2).map(|pair| pair[0].angle_to(pair[1])).sum();
        let reach = self.polygon[1..].iter().map(|z| z.distance(corner)).fold(f64::INFINITY, f64::min);
        let along = reach * DVec2::from_angle(0.5 * angle).rotate(spokes[0]);
        let shares = (0..HALVINGS_FROM_CORNER).scan(0.5, |share, _| Some(std::mem::replace(share, 0.5 * *share)));
        shares.map(|share| corner + share * along).find(|z| self.is_in_order(*z))
    }

    fn energy(&self, z: DVec2) -> f64 {
        self.elements.iter().map(|element| self.energy_of(element, z)).sum()
    }

    /// Largest energy of an element relative to its weight. The energy without distortion is 2.
    pub(super) fn worst(&self, z: DVec2) -> f64 {
        self.elements.iter().map(|element| self.energy_of(element, z) / element.weight()).fold(0.0, f64::max)
    }

    fn energy_of(&self, element: &Element, z: DVec2) -> f64 {
        element.energy(self.corners(element, z), Energy::SymmetricDirichlet)
    }

    fn corners(&self, element: &Element, z: DVec2) -> [DVec2; 3] {
        let [_, a, b] = element.corners;
        [z, self.polygon[a as usize - 1], self.polygon[b as usize - 1]]
    }

    /// Minimises the energy from a valid position, through valid positions only.
    pub(super) fn improved(&self, mut z: DVec2, limits: Steps) -> DVec2 {
        let mut before = self.energy(z);
        for _ in 0..limits.most {
            let Some(direction) = self.direction(z) else { break };
            let to_fold = |[a, b]: [DVec2; 2]| Element::longest_step([z, a, b], [direction, DVec2::ZERO, DVec2::ZERO]);
            let longest = self.sides().map(to_fold).fold(f64::INFINITY, f64::min);
            let first = (limits.share * longest).min(1.0);
            let steps = (0..HALVINGS).scan(first, |step, _| Some(std::mem::replace(step, 0.5 * *step)));
            let mut trials = steps.map(|step| z + step * direction);
            let Some(lower) = trials.find(|trial| self.energy(*trial) < before && self.is_in_order(*trial)) else {
                break;
            };
            let after = self.energy(lower);
            let gain = before - after;
            let is_last = gain < TOLERANCE * before;
            (z, before) = (lower, after);
            if is_last {
                break;
            }
        }
        z
    }

    /// Newton direction of the vertex.
    fn direction(&self, z: DVec2) -> Option<DVec2> {
        let (mut gradient, mut hessian) = (DVec2::ZERO, [0.0; 3]);
        for element in self.elements {
            let model = element.model(self.corners(element, z), Energy::SymmetricDirichlet);
            gradient += DVec2::new(model.gradient[0], model.gradient[1]);
            let [first, second] = [model.hessian[0], model.hessian[1]];
            hessian = [hessian[0] + first[0], hessian[1] + first[1], hessian[2] + second[1]];
        }
        let [xx, xy, yy] = hessian;
        let determinant = xx * yy - xy * xy;
        let direction = -DVec2::new(yy * gradient.x - xy * gradient.y, xx * gradient.y - xy * gradient.x) / determinant;
        (determinant > 0.0 && direction.is_finite()).then_some(direction)
    }
}

/// Element of a triangle in space of a vertex and two polygon corners, with its rest shape scaled by `scale`.
pub(super) fn resistance(shape: [DVec3; 3], corners: [usize; 2], scale: f64) -> Element {
    let flat = laid_flat(shape).map(|x| scale * x);
    let [p, q, r] = flat;
    let number = |k: usize| u32::try_from(k + 1).expect("a vertex has few neighbours");
    Element::new(
        [0, number(corners[0]), number(corners[1])],
        flat,
        Stiffness { weight: (q - p).perp_dot(r - p), thinnest: THINNEST },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of a polygon whose first corner alone sees all of it.
    fn narrow() -> Vec<DVec2> {
        let corners = [(0.0, 0.0), (4.0, -1.0), (1.0, 0.25), (4.0, 4.0), (0.25, 1.0), (-1.0, 4.0)];
        corners.map(|(x, y)| DVec2::new(x, y)).to_vec()
    }

    #[test]
    fn near_the_corner_that_sees_all_of_a_polygon_there_is_room() {
        let polygon = narrow();
        let room = Room { polygon: &polygon, elements: &[] };
        let near = room.near_corner().unwrap();
        assert!(room.is_in_order(near) && near.length() < 1.0, "{near}");
        // The fallback is also used if neither guess nor kernel gives a valid position.
        assert!(room.place(Some(DVec2::new(3.0, 3.0))).is_some_and(|z| room.is_in_order(z)));
    }

    #[test]
    fn a_vertex_of_equal_triangles_goes_near_the_middle_of_its_polygon() {
        let polygon: Vec<DVec2> = (0..6).map(|k| DVec2::from_angle(f64::from(k) * 1.047_197_551_196_597_6)).collect();
        let rest = [DVec2::ZERO, polygon[0], polygon[1]];
        let elements: Vec<Element> = (0..6)
            .map(|k| Element::new([0, k + 1, (k + 1) % 6 + 1], rest, Stiffness { weight: 1.0, thinnest: 0.0 }))
            .collect();
        let room = Room { polygon: &polygon, elements: &elements };
        let far = DVec2::new(0.7, 0.1);
        let z = room.place(Some(far)).unwrap();
        // By symmetry, the middle is the minimum.
        let [least, here, there] = [DVec2::ZERO, z, far].map(|z| room.energy(z));
        assert!(least <= here && here < 1.02 * least && there > 1.5 * least, "{z}: {least} {here} {there}");
    }
}
