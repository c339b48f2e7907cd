//! Choices by name: kinds of seams, and parts of a mesh.

use std::collections::BTreeSet;
use std::str::FromStr;
use std::sync::Arc;

use super::Model;
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{PartFaces, Preparation, VertexId};
use freebound_io::LabelError;
use glam::{DVec2, UVec2};

/// Size of the picture that charts are packed into for an aspect ratio, pixels: the longer side is the usual one.
pub fn picture_of_aspect(aspect: f64) -> [u32; 2] {
    let usual = UVec2::from_array(PackingOptions::default().picture).as_dvec2();
    let size = usual * DVec2::new(aspect, 1.0) / aspect.max(1.0);
    size.round().max(DVec2::ONE).as_u64vec2().as_uvec2().to_array()
}

/// Kind of edges that a mesh is cut along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeamKind {
    /// Edges whose face normals differ by at least this angle, degrees.
    Sharp(f64),
    /// Edges between faces of different materials.
    Materials,
    /// Edges between faces of different groups or objects.
    Groups,
    /// Edges at which the file's mesh is split, and joined by a repair.
    Splits,
}

impl FromStr for SeamKind {
    type Err = &'static str;

    /// Parses "sharp", "sharp=degrees", "materials", "groups" or "splits".
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parsed = || match text.split_once('=') {
            Some(("sharp", degrees)) => {
                let degrees: f64 = degrees.trim().parse().ok()?;
                (degrees > 0.0 && degrees <= 180.0).then_some(Self::Sharp(degrees))
            }
            None if text == "sharp" => Some(Self::Sharp(Model::SHARP_DEGREES)),
            None if text == "materials" => Some(Self::Materials),
            None if text == "groups" => Some(Self::Groups),
            None if text == "splits" => Some(Self::Splits),
            _ => None,
        };
        parsed().ok_or("write sharp, sharp=DEGREES (above 0, up to 180), materials, groups or splits")
    }
}

impl SeamKind {
    /// Name without the angle.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sharp(_) => "sharp",
            Self::Materials => "materials",
            Self::Groups => "groups",
            Self::Splits => "splits",
        }
    }
}

/// Parts of a mesh that are flattened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PartChoice {
    /// Part with the most faces.
    Largest,
    /// Parts with these numbers, from 0 in the order of their first faces.
    Numbered(BTreeSet<usize>),
}

impl FromStr for PartChoice {
    type Err = &'static str;

    /// Parses "largest", or numbers of parts separated by commas.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text.trim() == "largest" {
            return Ok(Self::Largest);
        }
        let numbers: Result<BTreeSet<usize>, _> = text.split(',').map(|number| number.trim().parse()).collect();
        numbers.map(Self::Numbered).map_err(|_| "write numbers separated by commas, for example 0,2, or largest")
    }
}

/// Number of a part that the mesh does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no part {part}: the mesh has {count}, numbered from 0")]
pub struct NoSuchPart {
    /// Number that was asked for.
    pub part: usize,
    /// Number of parts.
    pub count: usize,
}

impl Model {
    /// Edges of a kind, by the file's vertices.
    ///
    /// # Errors
    ///
    /// [`LabelError`] if the file has no materials or groups.
    pub fn edges_of(&self, kind: SeamKind) -> Result<Vec<[VertexId; 2]>, LabelError> {
        match kind {
            SeamKind::Sharp(degrees) => Ok(self.crease_edges(degrees)),
            SeamKind::Splits => Ok(self.split_edges()),
            SeamKind::Materials => self.material_borders(),
            SeamKind::Groups => self.group_borders(),
        }
    }

    /// Model without the parts that are not chosen.
    ///
    /// # Errors
    ///
    /// [`NoSuchPart`] if a number is too large.
    pub fn with_parts(self, choice: &PartChoice) -> Result<Self, NoSuchPart> {
        let parts = self.parts();
        let kept = match choice {
            // The first of the largest parts.
            PartChoice::Largest => (0..parts.len()).rev().max_by_key(|&part| parts[part].count).into_iter().collect(),
            PartChoice::Numbered(numbers) => numbers.clone(),
        };
        if let Some(&part) = kept.iter().find(|&&number| number >= parts.len()) {
            return Err(NoSuchPart { part, count: parts.len() });
        }
        let unwanted = parts.iter().enumerate().filter(|(part, _)| !kept.contains(part));
        let left_out: BTreeSet<u32> = unwanted.map(|(_, PartFaces { first_face, .. })| *first_face).collect();
        if left_out.is_empty() {
            return Ok(self);
        }
        let form = Preparation { left_out: Arc::new(left_out), ..self.prepared.form.clone() };
        Ok(self.in_form(form))
    }
}
