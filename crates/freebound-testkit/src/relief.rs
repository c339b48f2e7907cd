//! Scene of the portrait: skin, hair and clothes as distances, and their relief seen from the front.
//!
//! Depth, normals and hollows are smooth, and sampled on a grid half as fine as the picture. Outlines would be jagged
//! on this grid. So each grid point also knows how much of its surroundings each matter covers. An outline runs where
//! the interpolated cover is one half.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::paint::{Spot, colour};
use super::portrait::{MIDDLE, REACH, plane, sculpture_from_plane};
use super::sculpt::{bar, cut, distance, ellipsoid, join, ramp};

/// Depth at which rays end without having met anything.
const BACK: f64 = -0.75;
/// Depth at which rays begin.
const FRONT: f64 = 1.0;
/// Size of the cells of the grid that finds where rays should begin, in cells of the relief.
const COARSER: usize = 8;
/// Distance before nearby surfaces at which rays begin.
const AHEAD: f64 = 0.10;

/// Matter that a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Matter {
    Air,
    Skin,
    Hair,
    Cloth,
}

impl Matter {
    const ALL: [Self; 4] = [Self::Air, Self::Skin, Self::Hair, Self::Cloth];
}

/// Distances to skin, hair and cloth.
fn matter(p: DVec3) -> [f64; 3] {
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let mut skin = distance(p);
    // An ear: a flat shell with a hollow.
    let ear = ellipsoid(q, DVec3::new(0.735, -0.02, -0.13), DVec3::new(0.075, 0.185, 0.10));
    let ear = cut(ear, ellipsoid(q, DVec3::new(0.765, 0.0, -0.02), DVec3::new(0.035, 0.115, 0.06)), 0.04);
    skin = join(skin, ear, 0.05);
    skin = join(skin, bar(q, [DVec3::new(0.0, -1.0, -0.25), DVec3::new(0.0, -1.7, -0.25)], [0.37, 0.40]), 0.10);
    skin = join(skin, ellipsoid(q, DVec3::new(0.0, -1.62, -0.30), DVec3::new(1.0, 0.30, 0.35)), 0.15);
    let cap = ellipsoid(q, DVec3::new(0.0, 0.45, -0.28), DVec3::new(0.85, 0.91, 0.97));
    let cap = cap - 0.012 * (9.0 * q.x + 5.0 * p.y).sin() * ramp(p.y, 0.2, 0.8);
    let face = ellipsoid(DVec3::new(p.x + 0.10, p.y, p.z), DVec3::new(0.0, 0.12, 0.62), DVec3::new(0.70, 0.74, 0.80));
    let side = (0.02 - p.y) * 0.8;
    let hair = cut(join_max(cap, side, 0.08), face, 0.05);
    let cloth = ellipsoid(q, DVec3::new(0.0, -1.66, -0.32), DVec3::new(1.22, 0.46, 0.46));
    let collar = ellipsoid(q, DVec3::new(0.0, -1.18, 0.20), DVec3::new(0.42, 0.33, 0.62));
    [skin, hair, cut(cloth, collar, 0.03)]
}

fn join_max(a: f64, b: f64, blend: f64) -> f64 {
    -join(-a, -b, blend)
}

/// Depth, normal and matter on a grid half as fine as the picture.
pub(super) struct Relief {
    size: usize,
    depth: Vec<f64>,
    matter: Vec<Matter>,
    normals: Vec<DVec3>,
    /// Depth of each position behind its surroundings.
    hollow: Vec<f64>,
    /// Share of a position's surroundings that each matter covers, for smooth outlines at any resolution.
    cover: Vec<[f64; 4]>,
}

impl Relief {
    pub(super) fn new(size: usize) -> Self {
        let (depth, matter) = trace_all(size).into_iter().unzip();
        let mut relief = Self { size, depth, matter, normals: Vec::new(), hollow: Vec::new(), cover: Vec::new() };
        let grid = || (0..size).flat_map(|j| (0..size).map(move |i| (i, j)));
        relief.normals = grid().map(|(i, j)| relief.normal(i, j)).collect();
        relief.cover = grid().map(|(i, j)| relief.covered(i, j)).collect();
        let mean = relief.blurred((size / 40).max(1));
        relief.hollow = mean.iter().zip(&relief.depth).map(|(m, d)| (m - d).clamp(-0.05, 0.10)).collect();
        relief
    }

    fn at(&self, i: usize, j: usize) -> usize {
        j.min(self.size - 1) * self.size + i.min(self.size - 1)
    }

    /// The normal in picture axes, y up.
    fn normal(&self, i: usize, j: usize) -> DVec3 {
        let here = self.at(i, j);
        let step = 2.0 * REACH / self.size as f64;
        // Differences across an outline do not describe the surface: the flatter of the two sides counts there.
        let slope = |before: usize, after: usize| {
            let side =
                |k: usize| (self.matter[k] == self.matter[here]).then(|| (self.depth[k] - self.depth[here]) / step);
            let sides = [side(before).map(|d| -d), side(after)];
            match sides {
                [Some(a), Some(b)] if (a - b).abs() < 2.0 => f64::midpoint(a, b),
                [Some(a), Some(b)] => {
                    if a.abs() < b.abs() {
                        a
                    } else {
                        b
                    }
                }
                [a, b] => a.or(b).unwrap_or(0.0),
            }
            .clamp(-4.0, 4.0)
        };
        let x = slope(self.at(i.saturating_sub(1), j), self.at(i + 1, j));
        let y = slope(self.at(i, j + 1), self.at(i, j.saturating_sub(1)));
        DVec3::new(-x, -y, 1.0).try_normalize().unwrap_or(DVec3::Z)
    }

    /// Positions up to two rows and columns away, with weights that sum to 1 and decrease with the distance.
    fn around(&self, i: usize, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        const SHARES: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
        (0..25).map(move |k| {
            let (di, dj) = (k % 5, k / 5);
            (self.at((i + di).saturating_sub(2), (j + dj).saturating_sub(2)), SHARES[di] * SHARES[dj] / 256.0)
        })
    }

    /// Shares of the matters around a position.
    fn covered(&self, i: usize, j: usize) -> [f64; 4] {
        let mut shares = [0.0; 4];
        for (k, share) in self.around(i, j) {
            shares[self.matter[k] as usize] += share;
        }
        shares
    }

    /// Mean depth around each position.
    fn blurred(&self, radius: usize) -> Vec<f64> {
        let once = |source: &[f64], stride: usize, other: usize| {
            let mut out = vec![0.0; source.len()];
            for line in 0..self.size {
                let (mut sum, mut count) = (0.0, 0_usize);
                let value = |k: usize| source[line * other + k * stride];
                for k in 0..self.size + radius {
                    if k < self.size {
                        (sum, count) = (sum + value(k), count + 1);
                    }
                    if k > 2 * radius {
                        (sum, count) = (sum - value(k - 2 * radius - 1), count - 1);
                    }
                    if k >= radius {
                        out[line * other + (k - radius) * stride] = sum / count as f64;
                    }
                }
            }
            out
        };
        once(&once(&self.depth, 1, self.size), self.size, 1)
    }

    /// Colour at a position of the picture's plane.
    pub(super) fn colour(&self, place: DVec2) -> DVec3 {
        let grid = (DVec2::new(place.x, MIDDLE - place.y) / REACH + 1.0) * (self.size as f64 / 2.0) - 0.5;
        let grid = grid.clamp(DVec2::ZERO, DVec2::splat(self.size as f64 - 1.0));
        let (i, j) = (grid.x as usize, grid.y as usize);
        let f = grid - grid.floor();
        let shares = [(1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y];
        let corners = [0, 1, 2, 3].map(|k| (self.at(i + k % 2, j + k / 2), shares[k]));
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for matter in Matter::ALL {
            let cover: f64 = corners.iter().map(|&(k, share)| share * self.cover[k][matter as usize]).sum();
            let weight = ramp(cover, 0.36, 0.64);
            if weight > 0.0 {
                let is_at_corner = corners.iter().any(|&(k, share)| share > 0.0 && self.matter[k] == matter);
                let spot = if is_at_corner {
                    self.spot(place, matter, corners.into_iter())
                } else {
                    self.spot(place, matter, self.around(i, j))
                };
                sum += weight * colour(&spot);
                total += weight;
            }
        }
        // Three matters may meet at a position, none with enough cover.
        if total > 0.0 {
            sum / total
        } else {
            colour(&self.spot(place, self.matter[corners[0].0], corners.into_iter()))
        }
    }

    /// Sample of a matter from the nearby positions that show it.
    fn spot(&self, place: DVec2, matter: Matter, near: impl Iterator<Item = (usize, f64)>) -> Spot {
        let (mut normal, mut hollow, mut depth, mut total) = (DVec3::ZERO, 0.0, 0.0, 0.0);
        for (k, share) in near.filter(|&(k, _)| self.matter[k] == matter) {
            normal += share * self.normals[k];
            hollow += share * self.hollow[k];
            depth += share * self.depth[k];
            total += share;
        }
        let on_face = sculpture_from_plane(place).extend(depth / total);
        Spot { place, on_face, normal: normal.try_normalize().unwrap_or(DVec3::Z), hollow: hollow / total, matter }
    }
}

/// Depth and matter at all positions of a grid.
fn trace_all(size: usize) -> Vec<(f64, Matter)> {
    // Rays of a coarse grid, traced all the way, tell the others where to begin: a little before anything near them.
    let place = |size: usize, k: usize| {
        sculpture_from_plane(plane(size, DVec2::new((k % size) as f64, (k / size) as f64) + 0.5))
    };
    let coarse = size.div_ceil(COARSER);
    let first: Vec<f64> = (0..coarse * coarse).into_par_iter().map(|k| trace(place(coarse, k), FRONT).0).collect();
    let start = |k: usize| {
        let (i, j) = (k % size * coarse / size, k / size * coarse / size);
        let near = (0..9).map(|n| {
            let (x, y) = ((i + n % 3).saturating_sub(1).min(coarse - 1), (j + n / 3).saturating_sub(1).min(coarse - 1));
            first[y * coarse + x]
        });
        (near.fold(BACK, f64::max) + AHEAD).min(FRONT)
    };
    (0..size * size).into_par_iter().map(|k| trace(place(size, k), start(k))).collect()
}

/// Depth at which a ray from the front meets a surface, and its matter.
fn trace(p: DVec2, start: f64) -> (f64, Matter) {
    const NEAR: f64 = 3e-4;
    let mut z = start;
    for step in 0..80 {
        let [skin, hair, cloth] = matter(p.extend(z));
        let nearest = skin.min(hair).min(cloth);
        if step == 0 && nearest < 0.01 && z < FRONT {
            // Begun inside or too near to the surface: restart from the front.
            z = FRONT;
            continue;
        }
        if nearest < NEAR {
            let matter = if skin <= nearest {
                Matter::Skin
            } else if hair <= nearest {
                Matter::Hair
            } else {
                Matter::Cloth
            };
            return (z, matter);
        }
        z -= 0.85 * nearest;
        if z < BACK {
            break;
        }
    }
    (BACK, Matter::Air)
}
