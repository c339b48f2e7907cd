//! A mesh prepared for flattening: repaired, cut along its seams, its holes filled, as one disk or as several charts.
//!
//! Preparation never renumbers a vertex of the input: vertices made by cuts come after all others. The order of faces
//! stays.

use std::collections::HashSet;
use std::sync::Arc;

use crate::mesh::{
    Chart, Charts, Diagnosis, DiskMesh, Fault, PartFaces, PolygonMesh, Preparation, Repair, Repaired, Repairs, TriMesh,
    VertexId, diagnose, place_key, relative_volume,
};

/// Relative volume below which the outside of a surface is undecided: the volume of a cap 28 times as wide as it is
/// high.
const LEAST_VOLUME: f64 = 0.01;

/// A mesh after its preparation. Only a [`Surface::Disk`] can be flattened.
#[derive(Clone, Debug, Default)]
pub struct PreparedMesh {
    /// Requested repairs, cuts, seams, holes and parts.
    pub form: Preparation,
    /// Repairs of the input. `None` if it needed none.
    pub repaired: Option<Arc<Repaired>>,
    /// Repairs that would make a faulty mesh flattenable.
    pub remedy: Option<Arc<Repaired>>,
    /// Chart that `surface` holds, if the mesh has several.
    pub chart: Option<ChartOf>,
    /// Triangles of the mesh or of the chart, and their diagnosis.
    pub surface: Surface,
    /// Vertices at the position of a vertex of another part, with which they are not joined. 0 for a mesh of one chart.
    pub touching_vertices: usize,
    /// True if most faces seem to point inward. False if the surface is too flat to tell.
    pub faces_point_inward: bool,
}

/// Chart of a mesh that has several.
#[derive(Clone, Debug)]
pub struct ChartOf {
    /// All charts of the mesh.
    pub charts: Arc<Charts>,
    /// Number of this chart, from 0.
    pub number: usize,
    /// This chart.
    pub chart: Arc<Chart>,
}

/// Triangles and their diagnosis.
#[derive(Clone, Debug)]
pub enum Surface {
    /// A disk, which can be flattened.
    Disk(Arc<DiskMesh>),
    /// Triangles that are not a disk, and their faults.
    Faulty(Arc<TriMesh>, Arc<Diagnosis>),
}

impl Default for Surface {
    fn default() -> Self {
        Self::Faulty(Arc::default(), Arc::default())
    }
}

impl PreparedMesh {
    /// Prepares polygons. `labels` has one label per corner: if the preparation cuts along texture coordinates, edges
    /// at which labels differ are seams. If the preparation turns faces around, pass the polygons that
    /// [`turned`](PolygonMesh::turned) returns.
    pub fn new(polygons: &PolygonMesh, labels: Option<&[u32]>, form: Preparation) -> Self {
        let repaired = |form: &Preparation| form.repaired_along(polygons, labels);
        let lists_edges = !form.seams.edges().is_empty() || !form.seams.automatic().is_empty();
        let is_cut_along = lists_edges && !is_refused_uncut(polygons, form.repair);
        let has_seams = labels.is_some() || is_cut_along;
        let found = if has_seams { cut_surface(repaired(&form)) } else { surface_of(polygons, &form) };
        let remedy = match &found.surface {
            Surface::Disk(_) => None,
            Surface::Faulty(..) => Some(repaired(&form.with_all_repairs())).filter(Repaired::flattens).map(Arc::new),
        };
        let prepared = Self { form, remedy, ..Self::default() }.with(found);
        // Welding has joined all vertices that touch.
        let welds = prepared.form.allows(Repair::WeldVertices);
        let whole = prepared.chart.as_ref().map(|of| of.charts.whole()).filter(|_| !welds);
        let touching_vertices = whole.map_or(0, |whole| whole.touching_vertices(polygons));
        Self { touching_vertices, ..prepared }
    }

    /// Parts of the mesh, also those left out, in the order of their first faces.
    pub fn parts(&self, polygons: &PolygonMesh, labels: Option<&[u32]>) -> Vec<PartFaces> {
        self.form.parts(polygons, labels)
    }

    /// Another chart of the mesh. Returns a copy of `self` if the mesh has only one chart.
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

    /// Sides of the listed and automatic seam edges, by vertices of this mesh.
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

    /// Number of a vertex in the repaired mesh. Vertices of the input have the number of the input.
    pub fn vertex_in_file(&self, vertex: VertexId) -> VertexId {
        self.chart.as_ref().and_then(|of| of.chart.vertex_of.get(vertex.index()).copied()).unwrap_or(vertex)
    }

    /// Triangles, including virtual ones that fill holes.
    pub fn mesh(&self) -> &TriMesh {
        match &self.surface {
            Surface::Disk(disk) => disk.mesh(),
            Surface::Faulty(mesh, _) => mesh,
        }
    }

    /// The disk. `None` if the surface is faulty.
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
    /// Chart with this number.
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

    /// Surface that is not a disk after its repairs, with the remaining faults.
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
    let as_given = match as_given {
        Ok(disk) if is_welded => Some(disk),
        Ok(disk) => return Found::disk(disk, None),
        Err(diagnosis) if is_soup(polygons, form.repair, &diagnosis) => {
            let repaired = form.repaired(polygons);
            let left = diagnose(&repaired.triangulate());
            return Found::left(repaired, left);
        }
        Err(_) => None,
    };
    let repaired = form.repaired(polygons);
    if let Some(disk) = as_given.filter(|_| repaired.done().is_empty()) {
        return Found::disk(disk, None);
    }
    cut_surface(repaired)
}

/// Refusal of a mesh with faults that cutting does not repair, if no repair is allowed. Vertices are welded first:
/// faults that welding removes do not count. Vertices that lose their faces by welding do not count as unreferenced.
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

/// True if a mesh is refused however it is cut: it has faults that cutting does not repair.
fn is_refused_uncut(polygons: &PolygonMesh, repairs: Repairs) -> bool {
    if repairs.is_none() {
        return refused_unrepaired(polygons, repairs).is_some();
    }
    is_soup(polygons, repairs, &diagnose(&polygons.triangulate()))
}

/// True if most faces touch others without being connected to any: vertices are missing their joins. Larger parts that
/// touch are charts of their own.
fn is_soup(polygons: &PolygonMesh, repairs: Repairs, diagnosis: &Diagnosis) -> bool {
    let is_welded = repairs.allows(Repair::WeldVertices) || repairs.weld_distance().is_some();
    let coincident = diagnosis.faults.iter().find_map(|fault| match fault {
        Fault::CoincidentVertices(vertices) => Some(vertices),
        _ => None,
    });
    let Some(coincident) = coincident.filter(|_| !is_welded) else { return false };
    let place = |vertex: &VertexId| place_key(polygons.positions[vertex.index()]);
    let places: HashSet<[u64; 3]> = coincident.iter().map(place).collect();
    let parts = Preparation::default().parts(polygons, None);
    let single = parts.iter().filter(|part| part.count == 1).map(|part| polygons.face(part.first_face as usize));
    let alone = single.filter(|face| face.iter().any(|vertex| places.contains(&place(vertex)))).count();
    2 * alone > polygons.face_count()
}

/// Repaired and cut surface: a disk, several charts, or the remaining faults.
fn cut_surface(repaired: Repaired) -> Found {
    match DiskMesh::try_from(repaired.triangulate()) {
        Ok(disk) => {
            let is_repaired = !repaired.done().is_empty();
            Found::disk(disk, is_repaired.then_some(repaired))
        }
        Err(mut left) => match Charts::try_of(repaired).map(Arc::new) {
            Ok(charts) => Found::chart(&charts, charts.largest()),
            Err(repaired) => {
                // Vertices that cuts have split coincide by intention.
                left.faults.retain(|fault| !matches!(fault, Fault::CoincidentVertices(_)));
                Found::left(*repaired, *left)
            }
        },
    }
}
