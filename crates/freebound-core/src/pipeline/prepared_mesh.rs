//! A mesh prepared for flattening: repaired, cut along its seams, its holes filled, as one disk or as several charts.
//!
//! Preparation changes no number of a vertex that the input has: vertices made by cuts come behind all others, and the order of
//! faces stays.

use std::sync::Arc;

use crate::mesh::{
    Chart, Charts, Diagnosis, DiskMesh, Fault, PartFaces, PolygonMesh, Preparation, Repair, Repaired, Repairs, TriMesh,
    VertexId, diagnose, relative_volume,
};

/// Relative volume below which nobody can say which side of a surface is the outside: that of a cap 28 times as wide as
/// it is high.
const LEAST_VOLUME: f64 = 0.01;

/// A mesh after its preparation, whether or not it can be flattened.
#[derive(Clone, Debug, Default)]
pub struct PreparedMesh {
    /// Repairs, cuts, seams, holes and parts that were asked for.
    pub form: Preparation,
    /// Repairs of the input. `None` if it needed none.
    pub repaired: Option<Arc<Repaired>>,
    /// Repairs that would make a disk of a mesh that is none.
    pub remedy: Option<Arc<Repaired>>,
    /// Chart that this is, if the mesh has several.
    pub chart: Option<ChartOf>,
    /// Triangles of the mesh or of the chart, with their diagnosis.
    pub surface: Surface,
    /// True if most faces seem to point inward. False if the surface is too flat to tell.
    pub faces_point_inward: bool,
}

/// One chart of several.
#[derive(Clone, Debug)]
pub struct ChartOf {
    /// All charts of the mesh.
    pub charts: Arc<Charts>,
    /// Number of this chart, from 0.
    pub number: usize,
    /// This chart.
    pub chart: Arc<Chart>,
}

/// Triangles, with their diagnosis.
#[derive(Clone, Debug)]
pub enum Surface {
    /// A disk, which can be flattened.
    Disk(Arc<DiskMesh>),
    /// Triangles that are no disk, and their faults.
    Faulty(Arc<TriMesh>, Arc<Diagnosis>),
}

impl Default for Surface {
    fn default() -> Self {
        Self::Faulty(Arc::default(), Arc::default())
    }
}

impl PreparedMesh {
    /// Prepares polygons. `labels` has one label per corner: seams run along the edges at which labels differ, if the
    /// preparation cuts along texture coordinates. The polygons are those that [`turned`](PolygonMesh::turned) gives if the
    /// preparation turns faces around.
    pub fn new(polygons: &PolygonMesh, labels: Option<&[u32]>, form: Preparation) -> Self {
        let repaired = |form: &Preparation| form.repaired_along(polygons, labels);
        let is_cut_along = !form.seams.edges().is_empty() && !is_refused_uncut(polygons, form.repair);
        let has_seams = labels.is_some() || is_cut_along;
        let found = if has_seams { cut_surface(repaired(&form)) } else { surface_of(polygons, &form) };
        let remedy = match &found.surface {
            Surface::Disk(_) => None,
            Surface::Faulty(..) => Some(repaired(&form.with_all_repairs())).filter(Repaired::flattens).map(Arc::new),
        };
        Self { form, remedy, ..Self::default() }.with(found)
    }

    /// Parts of the mesh, in the order of their first faces, left-out ones among them.
    pub fn parts(&self, polygons: &PolygonMesh, labels: Option<&[u32]>) -> Vec<PartFaces> {
        self.form.parts(polygons, labels)
    }

    /// Another chart of the same mesh, if it has several.
    #[must_use = "the mesh itself stays as it is"]
    pub fn of_chart(&self, number: usize) -> Self {
        match &self.chart {
            Some(now) if now.number != number => self.clone().with(Found::chart(&now.charts, number)),
            _ => self.clone(),
        }
    }

    fn with(self, Found { surface, repaired, chart }: Found) -> Self {
        let faces_point_inward = matches!(&surface, Surface::Disk(disk) if relative_volume(disk) < -LEAST_VOLUME);
        Self { repaired, chart, surface, faces_point_inward, ..self }
    }

    /// Sides of the edges that are listed as seams, by vertices of this mesh.
    pub fn seam_sides(&self, polygons: &PolygonMesh) -> Vec<[VertexId; 2]> {
        match &self.repaired {
            Some(repaired) => repaired.seam_sides(&self.form.seams, polygons),
            None => self.form.seams.edges().iter().copied().collect(),
        }
    }

    /// Number of charts of the mesh.
    pub fn chart_count(&self) -> usize {
        self.chart.as_ref().map_or(1, |of| of.charts.count())
    }

    /// Repairs of the whole mesh, if there are any.
    pub fn whole_repaired(&self) -> Option<&Repaired> {
        self.chart.as_ref().map(|of| of.charts.whole()).or(self.repaired.as_deref())
    }

    /// Vertex of the repaired mesh that a vertex of this mesh or chart is. Its number is the input's, if the input has it.
    pub fn vertex_in_file(&self, vertex: VertexId) -> VertexId {
        self.chart.as_ref().and_then(|of| of.chart.vertex_of.get(vertex.index()).copied()).unwrap_or(vertex)
    }

    /// Triangles, those that fill holes included.
    pub fn mesh(&self) -> &TriMesh {
        match &self.surface {
            Surface::Disk(disk) => disk.mesh(),
            Surface::Faulty(mesh, _) => mesh,
        }
    }

    /// The disk, if it is one.
    pub fn disk(&self) -> Option<&Arc<DiskMesh>> {
        match &self.surface {
            Surface::Disk(disk) => Some(disk),
            Surface::Faulty(..) => None,
        }
    }
}

/// Result of a preparation.
struct Found {
    surface: Surface,
    /// Repairs that were needed.
    repaired: Option<Arc<Repaired>>,
    chart: Option<ChartOf>,
}

impl Found {
    /// One chart of several.
    fn chart(charts: &Arc<Charts>, number: usize) -> Self {
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

/// Surface of the faces after a preparation without seams.
fn surface_of(polygons: &PolygonMesh, form: &Preparation) -> Found {
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
fn is_refused_uncut(polygons: &PolygonMesh, repairs: Repairs) -> bool {
    let has = |is_fault: &dyn Fn(&Fault) -> bool| diagnose(&polygons.triangulate()).faults.iter().any(is_fault);
    if repairs.is_none() {
        return refused_unrepaired(polygons, repairs).is_some();
    }
    let is_welded = repairs.allows(Repair::WeldVertices) || repairs.weld_distance().is_some();
    !is_welded && has(&|fault| matches!(fault, Fault::CoincidentVertices(_)))
}

/// What a surface is that is cut along its seams.
fn cut_surface(repaired: Repaired) -> Found {
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
