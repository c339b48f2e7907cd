//! Irregular triangulations: random points in an outline at a wanted spacing, triangulated, then settled on a
//! surface. After settling, the triangles are good in space and not only in the plane.
//!
//! Settling alternates two steps. Edges flip if the two opposite angles, measured in space, sum to more than π (the
//! intrinsic Delaunay condition). Inner points move towards the centroid of their triangles, weighted by area over
//! spacing⁴. This is one round of Lloyd's method for a density that gives the wanted spacing.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use robust::orient2d;

use super::Random;
use super::delaunay::{coord, triangulate};
use freebound_core::mesh::{EdgeTable, TriMesh, VertexId};

/// Least distance of random points, as a share of the wanted spacing.
const NEAREST: f64 = 0.82;
/// Number of tries for each point that fits.
const TRIES: f64 = 15.0;
/// Share of the way to its centroid that a point moves in a round.
const PULL: f64 = 0.7;

/// Triangles over points in the plane; the first `boundary` points are the outline, counter-clockwise.
pub(super) struct Plane {
    pub(super) points: Vec<DVec2>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) boundary: usize,
}

/// Surface over the plane, with the wanted edge lengths.
pub(super) struct Sheet<'a> {
    /// Map from the plane into space.
    pub(super) surface: &'a (dyn Fn(DVec2) -> DVec3 + Sync + 'a),
    /// Map from space back to the plane, also from positions beside the surface.
    pub(super) chart: &'a (dyn Fn(DVec3) -> DVec2 + 'a),
    /// Wanted edge length at a point in space.
    pub(super) spacing: &'a (dyn Fn(DVec3) -> f64 + 'a),
}

/// True if a point lies inside a polygon, by the even-odd rule.
pub(super) fn is_inside(outline: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    for (i, &a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
            inside = !inside;
        }
    }
    inside
}

/// Points along a fine closed polyline, a spacing apart, with a little irregularity.
pub(super) fn walk_along(fine: &[DVec2], spacing: &dyn Fn(DVec2) -> f64, random: &mut Random) -> Vec<DVec2> {
    let mut reached = vec![0.0];
    for (i, &a) in fine.iter().enumerate() {
        let b = fine[(i + 1) % fine.len()];
        reached.push(reached[i] + a.distance(b) / spacing((a + b) / 2.0));
    }
    let total = reached[fine.len()];
    let count = total.round().max(3.0);
    let mut points = Vec::new();
    let mut i = 0;
    for k in 0..count as usize {
        let wanted = (k as f64 + random.between(0.0, 0.25)) * total / count;
        while reached[i + 1] < wanted {
            i += 1;
        }
        let share = (wanted - reached[i]) / (reached[i + 1] - reached[i]);
        points.push(fine[i].lerp(fine[(i + 1) % fine.len()], share));
    }
    points
}

/// Fills an outline, whose points are a spacing apart, with points and triangles.
pub(super) fn fill(outline: &[DVec2], spacing: &dyn Fn(DVec2) -> f64, random: &mut Random) -> Plane {
    let mut grid = Grid::new(outline, spacing);
    let (low, size) = (grid.low, grid.high - grid.low);
    let finest = outline.iter().map(|&p| spacing(p)).chain(grid.probe(spacing)).fold(f64::INFINITY, f64::min);
    let tries = TRIES * size.x * size.y / (finest * finest);
    for _ in 0..tries as usize {
        let p = low + size * DVec2::new(random.unit(), random.unit());
        let h = spacing(p);
        // A coarse region needs fewer tries than a fine one.
        if random.unit() * h * h <= finest * finest && grid.is_clear(p, NEAREST * h) && is_inside(outline, p) {
            grid.add(p);
        }
    }
    let points = grid.points;
    let mut triangles = triangulate(&points);
    triangles.retain(|t| {
        let centroid = t.iter().map(|&v| points[v as usize]).sum::<DVec2>() / 3.0;
        is_inside(outline, centroid)
    });
    Plane { points, triangles, boundary: outline.len() }
}

/// Points in square cells, to find near ones.
struct Grid {
    low: DVec2,
    high: DVec2,
    cell: f64,
    columns: usize,
    cells: Vec<Vec<u32>>,
    points: Vec<DVec2>,
}

impl Grid {
    fn new(outline: &[DVec2], spacing: &dyn Fn(DVec2) -> f64) -> Self {
        let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let cell =
            outline.iter().map(|&p| spacing(p)).fold(f64::INFINITY, f64::min).max((high - low).max_element() / 300.0);
        let columns = ((high.x - low.x) / cell) as usize + 1;
        let rows = ((high.y - low.y) / cell) as usize + 1;
        let mut grid = Self { low, high, cell, columns, cells: vec![Vec::new(); columns * rows], points: Vec::new() };
        for &p in outline {
            grid.add(p);
        }
        grid
    }

    /// Spacing at positions all over the grid.
    fn probe(&self, spacing: &dyn Fn(DVec2) -> f64) -> Vec<f64> {
        let at = |i: usize| i as f64 / 60.0;
        let size = self.high - self.low;
        (0..=60)
            .flat_map(|j| (0..=60).map(move |i| (i, j)))
            .map(|(i, j)| spacing(self.low + size * DVec2::new(at(i), at(j))))
            .collect()
    }

    fn place(&self, p: DVec2) -> (usize, usize) {
        let q = (p - self.low) / self.cell;
        (q.x.max(0.0) as usize, q.y.max(0.0) as usize)
    }

    fn add(&mut self, p: DVec2) {
        let (i, j) = self.place(p);
        self.cells[j * self.columns + i].push(u32::try_from(self.points.len()).expect("an example is small"));
        self.points.push(p);
    }

    fn is_clear(&self, p: DVec2, radius: f64) -> bool {
        let (i0, j0) = self.place(p - radius);
        let (i1, j1) = self.place(p + radius);
        let rows = self.cells.len() / self.columns;
        for j in j0..=j1.min(rows - 1) {
            for i in i0..=i1.min(self.columns - 1) {
                if self.cells[j * self.columns + i].iter().any(|&v| self.points[v as usize].distance(p) < radius) {
                    return false;
                }
            }
        }
        true
    }
}

impl Plane {
    /// Settles the triangulation on a surface, so that its triangles are good in space.
    pub(super) fn settle(&mut self, sheet: &Sheet, rounds: usize) {
        let mut raised: Vec<DVec3> = self.points.par_iter().map(|&p| (sheet.surface)(p)).collect();
        for _ in 0..rounds {
            self.flip(&raised);
            self.centre(sheet, &raised);
            raised = self.points.par_iter().map(|&p| (sheet.surface)(p)).collect();
        }
        self.flip(&raised);
    }

    /// Mesh in space.
    pub(super) fn raise(&self, surface: &(dyn Fn(DVec2) -> DVec3 + Sync)) -> TriMesh {
        TriMesh::new(self.points.par_iter().map(|&p| surface(p)).collect(), &self.triangles)
    }

    fn ccw(&self, a: u32, b: u32, c: u32) -> bool {
        let [a, b, c] = [a, b, c].map(|v| coord(self.points[v as usize]));
        orient2d(a, b, c) > 0.0
    }

    /// Flips edges until their opposite angles in space sum to at most π, as far as the plane allows.
    fn flip(&mut self, raised: &[DVec3]) {
        // Each sweep repairs most of what the sweep before left; a few are enough.
        for _ in 0..12 {
            let ids: Vec<[VertexId; 3]> = self.triangles.iter().map(|t| t.map(VertexId::new)).collect();
            let mut touched = vec![false; self.triangles.len()];
            let mut flips = 0;
            for sides in EdgeTable::new(self.points.len(), &ids).edges() {
                let &[s, t] = sides else { continue };
                let (f, g) = (s as usize / 3, t as usize / 3);
                if touched[f] || touched[g] {
                    continue;
                }
                let [a, b, c] = [0, 1, 2].map(|k| self.triangles[f][(s as usize % 3 + k) % 3]);
                let d = self.triangles[g][(t as usize % 3 + 2) % 3];
                let wide = cotangent(raised, [c, a, b]) + cotangent(raised, [d, b, a]) < -1e-9;
                if wide && self.ccw(a, d, c) && self.ccw(d, b, c) {
                    self.triangles[f] = [a, d, c];
                    self.triangles[g] = [d, b, c];
                    (touched[f], touched[g]) = (true, true);
                    flips += 1;
                }
            }
            if flips == 0 {
                return;
            }
        }
    }

    /// Moves inner points towards the weighted centroids of their triangles. No point leaves its ring of triangles.
    fn centre(&mut self, sheet: &Sheet, raised: &[DVec3]) {
        let mut around: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.points.len()];
        for &[a, b, c] in &self.triangles {
            around[a as usize].push([b, c]);
            around[b as usize].push([c, a]);
            around[c as usize].push([a, b]);
        }
        for v in self.boundary..self.points.len() {
            let here = self.points[v];
            let (mut sum, mut total) = (DVec3::ZERO, 0.0);
            for &[a, b] in &around[v] {
                let [x, y, z] = [v, a as usize, b as usize].map(|i| raised[i]);
                let centroid = (x + y + z) / 3.0;
                let h = (sheet.spacing)(centroid);
                let weight = (y - x).cross(z - x).length() / (h * h).powi(2);
                sum += weight * centroid;
                total += weight;
            }
            let mut step = (sheet.chart)(raised[v].lerp(sum / total, PULL)) - here;
            for _ in 0..4 {
                self.points[v] = here + step;
                if around[v].iter().all(|&[a, b]| self.ccw(u32::try_from(v).expect("small"), a, b)) {
                    break;
                }
                step /= 2.0;
                self.points[v] = here;
            }
        }
    }
}

/// Cotangent of the angle at the first corner.
fn cotangent(raised: &[DVec3], [at, a, b]: [u32; 3]) -> f64 {
    let (u, w) = (raised[a as usize] - raised[at as usize], raised[b as usize] - raised[at as usize]);
    u.dot(w) / u.cross(w).length().max(f64::MIN_POSITIVE)
}
