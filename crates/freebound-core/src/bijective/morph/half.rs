//! Half of the route through a circle: from an end of the morph to its boundary on the circle. See the module
//! `circle`.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use glam::DVec2;

use super::blend::normalized;
use super::pockets::{Apex, Pockets};
use crate::geom::Bounds;
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::scaffold::disk_in_plane;
use crate::problem::{Embedding, PinPositions};
use crate::weights::equations::Equations;

/// Duration of rounding, in proportion to the other stages.
const ROUND: f64 = 1.5;
/// Duration of turning.
const TURN: f64 = 0.75;
/// Duration of bulging.
const BULGE: f64 = 0.5;
/// Duration of the release and push of all layers together.
const LAYERS: f64 = 2.0;

/// Stages before the layers. Layer k is released in stage 3 + 2 k, and pushed in stage 4 + 2 k.
const ROUNDING: usize = 0;
const TURNING: usize = 1;
const BULGING: usize = 2;
const FIRST_RELEASE: usize = 3;

/// Moment of one half: a stage, and the elapsed share of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    stage: usize,
    share: f64,
}

impl Moment {
    /// Number of held layers. A layer is held from its push on.
    pub(super) fn layers_held(self) -> usize {
        (self.stage + 1).saturating_sub(FIRST_RELEASE) / 2
    }
}

/// Circle, with the turn of the directions on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    middle: DVec2,
    radius: f64,
    turned: f64,
}

impl Round {
    /// Point of the circle in a direction, before the turn.
    pub(super) fn point(&self, angle: f64) -> DVec2 {
        self.middle + self.radius * DVec2::from_angle(angle + self.turned)
    }

    /// Circle between two circles, linear in `share`, turned the shorter way.
    pub(super) fn between([from, to]: [&Self; 2], share: f64) -> Self {
        let apart = to.turned - from.turned;
        let shortest = apart - (apart / TAU).round() * TAU;
        Self {
            middle: from.middle.lerp(to.middle, share),
            radius: from.radius + share * (to.radius - from.radius),
            turned: from.turned + share * shortest,
        }
    }
}

/// Role of a place of the boundary.
#[derive(Clone, Copy, Debug)]
enum Role {
    /// Corner of the hull. After rounding its direction on the circle leads the final one by the angle `ahead`.
    Corner { ahead: f64 },
    /// Vertex within a side of the hull, at a share of the side. Held from the beginning.
    Within { apex: Apex, share: f64 },
    /// Vertex in a layer of a pocket. Held from its push on.
    Pocket { apex: Apex, layer: usize },
}

/// Half of the route, from an end to the circle.
pub(super) struct Half {
    /// Mesh and pockets.
    pub(super) disk: DiskMesh,
    equations: Equations<f64>,
    end: Vec<DVec2>,
    places: Vec<VertexId>,
    roles: Vec<Role>,
    /// Final directions of all places, ascending.
    pub(super) angles: Vec<f64>,
    pub(super) round: Round,
    layers: Vec<Vec<Apex>>,
    has_bulge: bool,
}

impl Half {
    /// `None` if the outside cannot be triangulated.
    pub(super) fn new(mesh: &DiskMesh, end: &Embedding, angles: &[f64]) -> Option<Self> {
        let polygon = end.boundary(mesh);
        let Pockets { corners, within_sides, layers, triangles } = Pockets::of(&polygon)?;
        let places = mesh.boundary_loop().to_vec();
        let pockets = triangles.into_iter().map(|t| t.map(|place| places[place as usize]));
        let all = mesh.mesh().triangles.iter().copied().chain(pockets).collect();
        let disk = disk_in_plane(end, all)?;
        let bounds = Bounds::of(polygon.iter().copied());
        let ahead = ahead_of(&corners, &polygon, angles);
        let turned = ahead.iter().sum::<f64>() / corners.len() as f64;
        let mut roles = vec![Role::Corner { ahead: 0.0 }; polygon.len()];
        for (&corner, ahead) in corners.iter().zip(ahead) {
            roles[corner] = Role::Corner { ahead: ahead - turned };
        }
        for &apex in &within_sides {
            let [a, b] = apex.ends.map(|end| polygon[end]);
            let share = (polygon[apex.place] - a).length() / (b - a).length();
            roles[apex.place] = Role::Within { apex, share };
        }
        for (layer, apexes) in layers.iter().enumerate() {
            for &apex in apexes {
                roles[apex.place] = Role::Pocket { apex, layer };
            }
        }
        Some(Self {
            equations: normalized(&disk, end),
            disk,
            end: polygon,
            places,
            roles,
            angles: angles.to_vec(),
            round: Round { middle: bounds.middle(), radius: 0.5 * bounds.size().max_element(), turned },
            layers,
            has_bulge: !within_sides.is_empty(),
        })
    }

    /// Boundary loop of the mesh, by places.
    pub(super) fn boundary(&self) -> &[VertexId] {
        &self.places
    }

    /// Duration of each stage.
    fn stages(&self) -> Vec<f64> {
        let bulge = if self.has_bulge { BULGE } else { 0.0 };
        let each = LAYERS / (2.0 * self.layers.len() as f64);
        let layers = std::iter::repeat_n(each, 2 * self.layers.len());
        [ROUND, TURN, bulge].into_iter().chain(layers).collect()
    }

    /// Total duration.
    pub(super) fn lasts(&self) -> f64 {
        self.stages().iter().sum()
    }

    /// Moment at a time.
    pub(super) fn moment(&self, time: f64) -> Moment {
        let mut left = time;
        let stages = self.stages();
        for (stage, &lasts) in stages.iter().enumerate() {
            if left < lasts {
                return Moment { stage, share: left / lasts };
            }
            left -= lasts;
        }
        Moment { stage: stages.len(), share: 0.0 }
    }

    /// Positions of all held points at a moment: the outline.
    pub(super) fn outline(&self, moment: Moment) -> PinPositions {
        let held = |place: usize| Some((self.places[place], self.point_at(place, moment)?));
        (0..self.places.len()).filter_map(held).collect()
    }

    /// Position of a place of the boundary if it is held.
    fn point_at(&self, place: usize, moment: Moment) -> Option<DVec2> {
        let Moment { stage, share } = moment;
        let arrived = self.round.point(self.angles[place]);
        match self.roles[place] {
            Role::Corner { ahead } => Some(match stage {
                ROUNDING => self.end[place].lerp(self.round.point(self.angles[place] + ahead), share),
                TURNING => self.round.point(self.angles[place] + (1.0 - share) * ahead),
                _ => arrived,
            }),
            Role::Within { apex, share: of_side } => {
                let chord = |along: f64| {
                    let [a, b] = apex.ends.map(|end| self.point_at(end, moment));
                    Some(a?.lerp(b?, along))
                };
                let of_arc = self.share_of_arc(apex);
                match stage {
                    ROUNDING => chord(of_side),
                    TURNING => chord(of_side + share * (of_arc - of_side)),
                    BULGING => Some(chord(of_arc)?.lerp(arrived, share)),
                    _ => Some(arrived),
                }
            }
            Role::Pocket { apex, layer } => match stage.cmp(&(FIRST_RELEASE + 2 * layer + 1)) {
                Ordering::Less => None,
                Ordering::Equal => {
                    let [a, b] = apex.ends.map(|end| self.round.point(self.angles[end]));
                    Some(a.lerp(b, self.share_of_arc(apex)).lerp(arrived, share))
                }
                Ordering::Greater => Some(arrived),
            },
        }
    }

    /// Final position of a place on the arc between its ends, as a share of the arc.
    fn share_of_arc(&self, apex: Apex) -> f64 {
        let [a, b] = apex.ends.map(|end| self.angles[end]);
        (self.angles[apex.place] - a).rem_euclid(TAU) / (b - a).rem_euclid(TAU)
    }

    /// Weights at a moment. During the release of a layer, its apexes shift to depend on the ends of their sides
    /// alone.
    pub(super) fn equations_at(&self, moment: Moment) -> Equations<f64> {
        let mut equations = self.equations.clone();
        let Some(since) = moment.stage.checked_sub(FIRST_RELEASE).filter(|since| since % 2 == 0) else {
            return equations;
        };
        for &apex in self.layers.get(since / 2).into_iter().flatten() {
            let share = self.share_of_arc(apex);
            let ends = apex.ends.map(|end| self.places[end]);
            for link in self.disk.links_from(self.places[apex.place]) {
                let head = self.disk.head(link);
                let drawn = if head == ends[0] {
                    1.0 - share
                } else if head == ends[1] {
                    share
                } else {
                    0.0
                };
                let weight = &mut equations.coefficients[link.index()];
                *weight += moment.share * (drawn - *weight);
            }
        }
        equations
    }
}

/// Angle by which the direction of each corner's outer normals leads its direction on the circle.
fn ahead_of(corners: &[usize], polygon: &[DVec2], angles: &[f64]) -> Vec<f64> {
    let count = corners.len();
    let outward = |k: usize| {
        let along = polygon[corners[(k + 1) % count]] - polygon[corners[k % count]];
        -along.normalize_or_zero().perp()
    };
    let mut direction = None;
    (0..count)
        .map(|k| {
            let found = (outward(k + count - 1) + outward(k)).to_angle();
            // Directions ascend once around, as on the circle.
            let ascended = direction.map_or(found, |before: f64| before + (found - before).rem_euclid(TAU));
            direction = Some(ascended);
            ascended - angles[corners[k]]
        })
        .collect()
}
