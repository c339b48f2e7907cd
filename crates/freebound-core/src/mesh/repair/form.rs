//! What is wanted of a file's faces, and the mesh that comes of it.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::{PartFaces, Repair, Repaired, Repairs, Seams};
use crate::mesh::PolygonMesh;

/// What is made of a file's faces before they are flattened.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Preparation {
    /// Whether all faces are turned around: the other side is the outside.
    pub faces_turned: bool,
    /// What may be repaired.
    pub repair: Repairs,
    /// What becomes of holes.
    pub holes: HoleTreatment,
    /// Whether parts that are no disks are cut open.
    pub cut: bool,
    /// Where the surface is cut before that.
    pub seams: Seams,
    /// Parts of the surface that are left out, by the file's numbers of their first faces.
    pub left_out: Arc<BTreeSet<u32>>,
}

/// What becomes of inner boundary loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum HoleTreatment {
    /// They are filled with virtual faces, unless nothing may be repaired.
    #[default]
    Fill,
    /// They are cut open to the outside, where a surface is cut at all.
    Cut,
}

impl Preparation {
    /// All that can be done to make disks.
    #[must_use]
    pub fn with_all_repairs(&self) -> Self {
        Self { repair: self.repair.and(Repairs::ALL), cut: true, ..self.clone() }
    }

    /// Whether a repair may be done.
    pub fn allows(&self, repair: Repair) -> bool {
        match repair {
            Repair::Cut => self.cut,
            Repair::LeaveOutParts => !self.left_out.is_empty(),
            Repair::CutSeams => !self.seams.is_empty(),
            Repair::FillHoles => self.holes == HoleTreatment::Fill && self.repair.allows(repair),
            _ => self.repair.allows(repair),
        }
    }

    /// The same where a repair may be done, too.
    #[must_use]
    pub fn with_repair(&self, repair: Repair) -> Self {
        let form = self.clone();
        match repair {
            Repair::Cut => Self { cut: true, ..form },
            // Which parts or seams, a repair does not say.
            Repair::LeaveOutParts | Repair::CutSeams => form,
            Repair::FillHoles => Self { holes: HoleTreatment::Fill, repair: form.repair.with(repair), ..form },
            _ => Self { repair: form.repair.with(repair), ..form },
        }
    }

    /// The repairs of a mesh, whose faces are turned already: the same as before they were, so that every vertex keeps its
    /// number when they are turned. Seams of texture coordinates are for [`repaired_along`](Self::repaired_along).
    pub fn repaired(&self, source: &PolygonMesh) -> Repaired {
        self.repaired_along(source, None)
    }

    /// The parts that are left out where their first faces are named: those of the mesh repaired, cut along its seams. `labels`
    /// are as in [`repaired_along`](Self::repaired_along).
    pub fn parts(&self, source: &PolygonMesh, labels: Option<&[u32]>) -> Vec<PartFaces> {
        let form = Self { left_out: Arc::default(), cut: false, holes: HoleTreatment::Cut, ..self.clone() };
        form.repaired_along(source, labels).parts()
    }

    /// As [`repaired`](Self::repaired), the surface cut at edges, too, that have different labels on their sides: there is one for
    /// each corner of `source`.
    pub fn repaired_along(&self, source: &PolygonMesh, labels: Option<&[u32]>) -> Repaired {
        if self.faces_turned {
            let before = source.turned();
            let labels = labels.map(|labels| source.turned_at_corners(labels));
            let form = Self { faces_turned: false, ..self.clone() };
            return form.repaired_along(&before, labels.as_deref()).turned(&before);
        }
        let mut repaired = Repaired::new(source, self.repair);
        repaired.cut_along(&self.seams, labels, source);
        repaired.leave_parts_out(&self.left_out);
        repaired.fills = self.allows(Repair::FillHoles);
        let repaired = if self.cut { repaired.cut_to_disks() } else { repaired };
        repaired.fill_holes()
    }
}
