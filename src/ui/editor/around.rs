//! Charts around the chart on the screen: drawn and picked.

use std::sync::Arc;

use glam::DVec3;

use crate::render::Surroundings;
use crate::session::Model;
use crate::view::{EdgeList, FacePaint, MeshArrays, Ray, Sphere, SurfacePicker};
use freebound_core::mesh::FaceId;

/// The other charts, around the chart on the screen.
#[derive(Debug)]
pub struct Around {
    /// Mesh and colours of the other charts, for drawing.
    pub surroundings: Surroundings,
    /// Seams of all charts, by vertices of the whole mesh.
    pub seams: Arc<EdgeList>,
    picker: SurfacePicker,
    /// Chart of each face of the other charts.
    chart_of: Vec<u32>,
}

impl Around {
    pub(super) fn of(model: &Model, positions: &[DVec3], sphere: Sphere) -> Option<Self> {
        let of = model.prepared.chart.as_ref()?;
        let polygons = of.charts.whole().polygons();
        let mut chart_of_polygon = vec![None; polygons.face_count()];
        for (number, chart) in (0..).zip(0..of.charts.count()).filter(|(_, chart)| *chart != of.number) {
            of.charts.faces(chart).iter().for_each(|&face| chart_of_polygon[face as usize] = Some(number));
        }
        let whole = polygons.triangulate();
        let chart_of_face = |face: usize| chart_of_polygon[whole.polygon(FaceId::from_index(face)) as usize];
        let others = (0..whole.face_count()).filter_map(|face| Some((whole.triangles[face], chart_of_face(face)?)));
        let (triangles, chart_of): (Vec<_>, Vec<u32>) = others.unzip();
        let mesh = MeshArrays::in_frame(positions, &triangles, sphere);
        let paint = FacePaint::faint(triangles.len());
        let surroundings = Surroundings { mesh: Arc::new(mesh), paint: Arc::new(paint) };
        let seams = of.charts.whole().seam_sides(&model.prepared.form.seams, &model.source.polygons);
        let seams = Arc::new(EdgeList::new(seams));
        Some(Self { surroundings, seams, picker: SurfacePicker::new(positions, &triangles), chart_of })
    }

    /// First other chart that a ray meets, and its distance from the ray's origin.
    pub(super) fn chart_at(&self, ray: Ray) -> Option<(usize, f64)> {
        let hit = self.picker.hit(ray)?;
        Some((self.chart_of[hit.face.index()] as usize, hit.distance))
    }
}
