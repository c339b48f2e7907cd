//! Delaunay triangulation of points in the plane, by insertion (Bowyer 1981, Watson 1981) with exact predicates.

use glam::DVec2;
use robust::{Coord, incircle, orient2d};

/// Mark of a side without a triangle on its other side.
const NONE: u32 = u32::MAX;

/// Size of the outer triangle relative to the points: so large that it hides no relevant edge between points.
const OUTER_SCALE: f64 = 1e4;

pub fn coord(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// Triangles, counter-clockwise, over points that are pairwise different. May leave out slivers along the hull.
pub fn triangulate(points: &[DVec2]) -> Vec<[u32; 3]> {
    let mut work = Work::new(points);
    for v in 0..u32::try_from(points.len()).expect("an example is small") {
        work.insert(v);
    }
    let real = u32::try_from(points.len()).expect("an example is small");
    let whole = |t: &[u32; 3]| t.iter().all(|&v| v < real);
    work.corners.into_iter().zip(work.dead).filter(|(t, dead)| !dead && whole(t)).map(|(t, _)| t).collect()
}

struct Work {
    points: Vec<DVec2>,
    corners: Vec<[u32; 3]>,
    /// Triangle across the side from corner `k` to corner `k + 1`.
    across: Vec<[u32; 3]>,
    dead: Vec<bool>,
    free: Vec<u32>,
    last: u32,
}

impl Work {
    fn new(points: &[DVec2]) -> Self {
        let mut points = points.to_vec();
        let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let (centre, reach) = ((low + high) / 2.0, OUTER_SCALE * (high - low).max_element());
        let first = u32::try_from(points.len()).expect("an example is small");
        points.extend([(-1.0, -0.7), (1.1, -0.6), (0.1, 1.2)].map(|(x, y)| centre + reach * DVec2::new(x, y)));
        Self {
            points,
            corners: vec![[first, first + 1, first + 2]],
            across: vec![[NONE; 3]],
            dead: vec![false],
            free: Vec::new(),
            last: 0,
        }
    }

    fn at(&self, v: u32) -> Coord<f64> {
        coord(self.points[v as usize])
    }

    /// Walks to the triangle that contains a point.
    fn locate(&self, v: u32) -> u32 {
        let mut t = self.last;
        'walk: loop {
            let corners = self.corners[t as usize];
            for k in 0..3 {
                if orient2d(self.at(corners[k]), self.at(corners[(k + 1) % 3]), self.at(v)) < 0.0 {
                    t = self.across[t as usize][k];
                    continue 'walk;
                }
            }
            return t;
        }
    }

    /// Triangles whose circumcircle contains the point, and the sides around them with the triangles beyond.
    fn cavity(&self, v: u32) -> (Vec<u32>, Vec<[u32; 3]>) {
        let mut inside = vec![self.locate(v)];
        let mut rim = Vec::new();
        let mut next = 0;
        while next < inside.len() {
            let t = inside[next];
            next += 1;
            for k in 0..3 {
                let beyond = self.across[t as usize][k];
                if inside.contains(&beyond) {
                    continue;
                }
                if beyond != NONE && self.holds(beyond, v) {
                    inside.push(beyond);
                }
            }
        }
        for &t in &inside {
            for k in 0..3 {
                let beyond = self.across[t as usize][k];
                if !inside.contains(&beyond) {
                    rim.push([self.corners[t as usize][k], self.corners[t as usize][(k + 1) % 3], beyond]);
                }
            }
        }
        (inside, rim)
    }

    fn holds(&self, t: u32, v: u32) -> bool {
        let [a, b, c] = self.corners[t as usize].map(|w| self.at(w));
        incircle(a, b, c, self.at(v)) > 0.0
    }

    fn insert(&mut self, v: u32) {
        let (inside, rim) = self.cavity(v);
        for &t in &inside {
            self.dead[t as usize] = true;
            self.free.push(t);
        }
        let fresh: Vec<u32> = rim.iter().map(|&[a, b, _]| self.place([a, b, v])).collect();
        for (&t, &[a, b, beyond]) in fresh.iter().zip(&rim) {
            let with =
                |position: usize, w: u32| fresh[rim.iter().position(|r| r[position] == w).expect("a closed rim")];
            self.across[t as usize] = [beyond, with(0, b), with(1, a)];
            if beyond != NONE {
                let sides = self.corners[beyond as usize];
                let k = sides.iter().position(|&w| w == b).expect("a shared side");
                self.across[beyond as usize][k] = t;
            }
        }
        self.last = fresh[0];
    }

    fn place(&mut self, corners: [u32; 3]) -> u32 {
        if let Some(t) = self.free.pop() {
            self.corners[t as usize] = corners;
            self.dead[t as usize] = false;
            return t;
        }
        self.corners.push(corners);
        self.across.push([NONE; 3]);
        self.dead.push(false);
        u32::try_from(self.corners.len() - 1).expect("an example is small")
    }
}
