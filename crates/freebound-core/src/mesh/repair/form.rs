//! Preparation of a file's faces: its settings, and the mesh that results.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::{PartFaces, Repair, Repaired, Repairs, Seams};
use crate::mesh::PolygonMesh;

/// Settings for the preparation of a file's faces before they are flattened.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preparation {
    /// True if all faces are reversed: the other side becomes the outside.
    pub faces_turned: bool,
    /// Allowed repairs.
    pub repair: Repairs,
    /// Treatment of holes.
    pub holes: HoleTreatment,
    /// True if parts that are not disks are cut open.
    pub cut: bool,
    /// Seams along which the surface is cut first.
    pub seams: Seams,
    /// Parts of the surface to leave out, by the file's numbers of their first faces.
    pub left_out: Arc<BTreeSet<u32>>,
}

/// Treatment of inner boundary loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum HoleTreatment {
    /// Fill holes with virtual faces, if repairs allow it.
    #[default]
    Fill,
    /// Cut holes open to the outer boundary, if the surface is cut at all.
    Cut,
}

impl Preparation {
    /// True if two preparations differ at most in the bound of their automatic seams: they prepare any mesh alike.
    pub fn prepares_like(&self, other: &Self) -> bool {
        Self { seams: self.seams.bound_as(&other.seams), ..self.clone() } == *other
    }

    /// Adds all repairs that can help to make disks, and cutting.
    #[must_use]
    pub fn with_all_repairs(&self) -> Self {
        Self { repair: self.repair.and(Repairs::ALL), cut: true, ..self.clone() }
    }

    /// True if a repair is allowed.
    pub fn allows(&self, repair: Repair) -> bool {
        match repair {
            Repair::Cut => self.cut,
            Repair::LeaveOutParts => !self.left_out.is_empty(),
            Repair::CutSeams => !self.seams.is_empty(),
            Repair::FillHoles => self.holes == HoleTreatment::Fill && self.repair.allows(repair),
            _ => self.repair.allows(repair),
        }
    }

    /// Allows one more repair.
    #[must_use]
    pub fn with_repair(&self, repair: Repair) -> Self {
        let form = self.clone();
        match repair {
            Repair::Cut => Self { cut: true, ..form },
            // A repair does not name the parts or seams.
            Repair::LeaveOutParts | Repair::CutSeams => form,
            Repair::FillHoles => Self { holes: HoleTreatment::Fill, repair: form.repair.with(repair), ..form },
            _ => Self { repair: form.repair.with(repair), ..form },
        }
    }

    /// Repairs a mesh.
    ///
    /// If faces are reversed, `source` is the reversed mesh. The repair runs on its original orientation and reverses
    /// the result, so that every vertex has the number that it has without reversal. For seams of texture coordinates
    /// use [`repaired_along`](Self::repaired_along).
    pub fn repaired(&self, source: &PolygonMesh) -> Repaired {
        self.repaired_along(source, None)
    }

    /// Parts of the mesh after repairs and cuts along its seams; `left_out` names parts by their first faces. For
    /// `labels` see [`repaired_along`](Self::repaired_along).
    pub fn parts(&self, source: &PolygonMesh, labels: Option<&[u32]>) -> Vec<PartFaces> {
        let form = Self { left_out: Arc::default(), cut: false, holes: HoleTreatment::Cut, ..self.clone() };
        form.repaired_along(source, labels).parts()
    }

    /// Repairs a mesh like [`repaired`](Self::repaired), and also cuts it at edges with different labels on their two
    /// sides. `labels` has one label per corner of `source`.
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
