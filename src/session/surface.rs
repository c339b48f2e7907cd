//! What comes of a file's faces: a disk, several, or what is left to be mended.

use std::sync::Arc;

use super::model::{ChartOf, Surface};
use crate::mesh::{Charts, Diagnosis, DiskMesh, Fault, Form, PolygonMesh, Repair, Repaired, Repairs, diagnose};

/// What a file's faces are in a form.
pub(super) struct Found {
    pub(super) surface: Surface,
    /// The repairs that this took.
    pub(super) repaired: Option<Arc<Repaired>>,
    pub(super) chart: Option<ChartOf>,
}

impl Found {
    /// One chart of several.
    pub(super) fn chart(charts: &Arc<Charts>, number: usize) -> Self {
        let chart = Arc::new(charts.chart(number));
        let mesh = chart.repaired.triangulate();
        let surface = match DiskMesh::try_from(mesh.clone()) {
            Ok(disk) => Surface::Disk(Arc::new(disk)),
            Err(diagnosis) => Surface::Faulty(Arc::new(mesh), Arc::new(*diagnosis)),
        };
        let repaired = Some(Arc::new(chart.repaired.clone()));
        Self { surface, repaired, chart: Some(ChartOf { charts: Arc::clone(charts), number, chart }) }
    }

    fn disk(disk: DiskMesh, repaired: Option<Repaired>) -> Self {
        Self { surface: Surface::Disk(Arc::new(disk)), repaired: repaired.map(Arc::new), chart: None }
    }

    /// What is no disk after its repairs, with the faults that are left.
    fn left(repaired: Repaired, left: Diagnosis) -> Self {
        let surface = Surface::Faulty(Arc::new(repaired.triangulate()), Arc::new(left));
        let is_repaired = !repaired.done().is_empty();
        Self { surface, repaired: is_repaired.then(|| Arc::new(repaired)), chart: None }
    }
}

/// What a file's faces are in a form.
pub(super) fn surface_of(polygons: &PolygonMesh, form: &Form) -> Found {
    if let Some(refused) = refused_unrepaired(polygons, form.repair) {
        return refused;
    }
    let as_given = DiskMesh::try_from(polygons.triangulate());
    let is_welded = form.repair.weld_distance().is_some();
    let (as_given, diagnosis) = match as_given {
        Ok(disk) if is_welded => (Some(disk), Diagnosis::default()),
        Ok(disk) => return Found::disk(disk, None),
        Err(diagnosis) => (None, *diagnosis),
    };
    let repaired = form.repaired(polygons);
    if let Some(disk) = as_given.filter(|_| repaired.done().is_empty()) {
        return Found::disk(disk, None);
    }
    // Parts that lie side by side, vertex on vertex, are as a rule one surface that a program took apart.
    let lies_apart = diagnosis.faults.iter().any(|fault| matches!(fault, Fault::CoincidentVertices(_)));
    let is_meant_as_one = lies_apart && !form.repair.allows(Repair::WeldVertices) && !is_welded;
    match DiskMesh::try_from(repaired.triangulate()) {
        Err(left) if is_meant_as_one => Found::left(repaired, *left),
        found => charts_of(repaired, found),
    }
}

/// A mesh with faults that cutting does not mend, where nothing may be repaired. Vertices are welded first: what this mends is
/// no fault, and vertices that have no face for it alone are none.
fn refused_unrepaired(polygons: &PolygonMesh, repairs: Repairs) -> Option<Found> {
    if !repairs.is_none() {
        return None;
    }
    let welded = Repaired::new(polygons, repairs);
    let mut left = diagnose(&welded.triangulate());
    if !welded.done().is_empty() {
        let is_unused = |fault: &Fault| matches!(fault, Fault::UnreferencedVertices(_));
        left.faults.retain(|fault| !is_unused(fault));
        left.faults.extend(diagnose(&polygons.triangulate()).faults.into_iter().filter(is_unused));
    }
    let is_refused = left.faults.iter().any(|fault| !(fault.is_cut_open() || fault.is_of_charts()));
    is_refused.then(|| Found::left(welded, left))
}

/// Whether a mesh is refused wherever it is cut: for faults that cutting does not mend.
pub(super) fn is_refused_uncut(polygons: &PolygonMesh, repairs: Repairs) -> bool {
    let has = |is_fault: &dyn Fn(&Fault) -> bool| diagnose(&polygons.triangulate()).faults.iter().any(is_fault);
    if repairs.is_none() {
        return refused_unrepaired(polygons, repairs).is_some();
    }
    let is_welded = repairs.allows(Repair::WeldVertices) || repairs.weld_distance().is_some();
    !is_welded && has(&|fault| matches!(fault, Fault::CoincidentVertices(_)))
}

/// What a surface is that is cut along its seams.
pub(super) fn cut_surface(repaired: Repaired) -> Found {
    let found = DiskMesh::try_from(repaired.triangulate());
    charts_of(repaired, found)
}

/// A disk, or several, or what is left to be mended.
fn charts_of(repaired: Repaired, found: Result<DiskMesh, Box<Diagnosis>>) -> Found {
    match found {
        Ok(disk) => {
            let is_repaired = !repaired.done().is_empty();
            Found::disk(disk, is_repaired.then_some(repaired))
        }
        Err(mut left) => match Charts::try_of(repaired).map(Arc::new) {
            Ok(charts) => Found::chart(&charts, charts.largest()),
            Err(repaired) => {
                // What was split lies in one place, as it is meant to.
                left.faults.retain(|fault| !matches!(fault, Fault::CoincidentVertices(_)));
                Found::left(*repaired, *left)
            }
        },
    }
}
