//! Draw calls of a frame: their buffers, their order and their uniforms.

use std::borrow::Cow;
use std::sync::Arc;

use eframe::wgpu;

use super::cache::{Cache, Key};
use super::frame::{LineLayer, MeshFrame, PictureLayer, PlaneFrame, Sampling, Style};
use super::uniforms::{LineUniforms, PaneSize, PaneUniforms};
use crate::view::{EdgeList, FacePaint, MeshArrays, Palette, PictureQuad, PlaneArrays, Revision};
use freebound_core::mesh::VertexId;

/// Shift of a line from its surface towards the eye, relative to the distance.
const LIFT: f32 = 0.0015;
/// Largest number of layers of a pane: fills and lines, outlines of flipped faces included.
pub(super) const LAYER_LIMIT: usize = 16;

/// Bytes of a line on the mesh: two points.
pub(super) const MESH_LINE_STRIDE: u64 = 24;
/// Bytes of a point in the plane.
pub(super) const PLANE_POINT_STRIDE: u64 = 16;
/// Bytes of a line in the plane: two split points.
pub(super) const PLANE_LINE_STRIDE: u64 = 32;

/// Pipelines that a pane is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Mesh,
    Plane,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Draw {
    /// Vertex buffers in the order of their slots.
    pub(super) buffers: Vec<Key>,
    /// Number of vertices of faces and fills, or of instances of lines.
    pub(super) count: u32,
}

/// Pictures that the faces of a pane show.
#[derive(Clone, Copy, Default)]
pub(super) struct Textures<'a> {
    pub(super) picture: Option<&'a PictureLayer>,
    /// Tile that repeats over the plane.
    pub(super) pattern: Option<&'a Arc<PictureQuad>>,
}

impl<'a> Textures<'a> {
    pub(super) fn of_mesh(frame: &'a MeshFrame) -> Self {
        Self { picture: frame.picture.as_ref(), pattern: frame.pattern.as_ref() }
    }

    pub(super) fn of_plane(frame: &'a PlaneFrame) -> Self {
        Self { picture: frame.picture.as_ref(), pattern: frame.pattern.as_ref() }
    }
}

/// Draw call of faces.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Faces {
    pub(super) draw: Draw,
    /// Opacity in the plane; faces of the mesh are opaque.
    pub(super) opacity: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Fill,
    Line,
}

/// Draw call with its own colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Layer {
    pub(super) shape: Shape,
    pub(super) draw: Draw,
    /// Bytes of a [`LineUniforms`].
    pub(super) uniforms: Vec<u8>,
}

/// Everything that a pane's picture depends on. Equal plans give equal pictures.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    pub(super) kind: Kind,
    pub(super) size: [u32; 2],
    /// Bytes of a [`PaneUniforms`].
    pub(super) uniforms: Vec<u8>,
    pub(super) faces: Vec<Faces>,
    /// Fills first, then lines.
    pub(super) layers: Vec<Layer>,
    pub(super) picture: Option<Revision>,
    pub(super) pattern: Option<Revision>,
    pub(super) sampling: Sampling,
    pub(super) clear: [f64; 4],
}

impl Plan {
    pub(super) fn keys(&self) -> impl Iterator<Item = Key> + '_ {
        let draws = self.faces.iter().map(|faces| &faces.draw).chain(self.layers.iter().map(|layer| &layer.draw));
        draws.flat_map(|draw| draw.buffers.iter().copied())
    }

    fn new(
        kind: Kind,
        size: PaneSize,
        uniforms: &PaneUniforms,
        palette: &Palette,
        Textures { picture, pattern }: Textures<'_>,
    ) -> Self {
        let [r, g, b, _] = palette.background.to_linear().map(f64::from);
        Self {
            kind,
            size: size.in_pixels,
            uniforms: bytemuck::bytes_of(uniforms).to_vec(),
            faces: Vec::new(),
            layers: Vec::new(),
            picture: picture.map(|layer| layer.picture.revision),
            pattern: pattern.map(|pattern| pattern.revision),
            sampling: picture.map_or(Sampling::default(), |layer| layer.sampling),
            // Alpha counts faces, so it starts at 0.
            clear: [r, g, b, 0.0],
        }
    }

    fn push(&mut self, shape: Shape, draw: Draw, uniforms: LineUniforms) {
        if draw.count > 0 && self.layers.len() < LAYER_LIMIT {
            self.layers.push(Layer { shape, draw, uniforms: bytemuck::bytes_of(&uniforms).to_vec() });
        }
    }
}

/// Access to the device and the buffers while planning.
pub(super) struct Planner<'a> {
    pub(super) device: &'a wgpu::Device,
    pub(super) cache: &'a mut Cache,
    pub(super) size: PaneSize,
}

impl Planner<'_> {
    /// Plans the 3D pane and creates the buffers that it lacks.
    pub(super) fn mesh(&mut self, frame: &MeshFrame) -> Plan {
        let uniforms = PaneUniforms::of_mesh(frame, self.size);
        let mut plan = Plan::new(Kind::Mesh, self.size, &uniforms, &frame.palette, Textures::of_mesh(frame));
        let mesh = &frame.mesh;
        let around = frame.around.as_ref().map(|around| (&around.mesh, None, Some(&around.paint)));
        for (mesh, plane, paint) in [(mesh, frame.plane.as_ref(), frame.paint.as_ref())].into_iter().chain(around) {
            plan.faces.push(Faces { draw: self.mesh_faces(mesh, plane, paint), opacity: 1.0 });
        }
        let around_lines =
            frame.around.iter().flat_map(|around| frame.around_lines.iter().map(|layer| (&around.mesh, layer)));
        for (mesh, layer) in frame.lines.iter().map(|layer| (mesh, layer)).chain(around_lines) {
            let key = Key::MeshLines(mesh.revision, layer.edges.revision);
            self.ensure_with(key, || segments(&mesh.points, vertex_pairs(&layer.edges)));
            plan.push(Shape::Line, self.draw_of(key, MESH_LINE_STRIDE), self.line(layer, LIFT));
        }
        if let Some((paint, uniforms)) = self.outline(&frame.style, &frame.palette, frame.paint.as_ref(), LIFT) {
            let key = Key::MeshLines(mesh.revision, paint.revision);
            self.ensure_with(key, || segments(&mesh.points, flipped_outline(mesh, paint)));
            plan.push(Shape::Line, self.draw_of(key, MESH_LINE_STRIDE), uniforms);
        }
        plan
    }

    /// Draw call of the faces of a mesh, with its embedding and its colours.
    fn mesh_faces(
        &mut self,
        mesh: &MeshArrays,
        plane: Option<&Arc<PlaneArrays>>,
        paint: Option<&Arc<FacePaint>>,
    ) -> Draw {
        let positions = Key::Positions(mesh.revision);
        let normals = Key::Normals(mesh.revision);
        self.ensure(positions, &mesh.corner_positions);
        self.ensure(normals, &mesh.corner_normals);
        let (plane, paint) = (self.plane_or_zeros(plane, mesh), self.paint_or_zeros(paint, mesh));
        Draw { buffers: vec![positions, normals, plane, paint], count: corner_count(mesh) }
    }

    pub(super) fn plane(&mut self, frame: &PlaneFrame) -> Plan {
        let uniforms = PaneUniforms::of_plane(frame, self.size);
        let mut plan = Plan::new(Kind::Plane, self.size, &uniforms, &frame.palette, Textures::of_plane(frame));
        let Some(plane) = frame.plane.as_ref() else { return plan };
        let mesh = &frame.mesh;
        // Flipped faces are drawn first: they are in front, and the depth test skips faces behind them.
        if let Some(paint) = frame.paint.as_ref().filter(|paint| !paint.flipped.is_empty()) {
            let corners = Key::FlippedPlane(plane.revision, paint.revision);
            let colours = Key::FlippedPaint(paint.revision);
            self.ensure_with(corners, || flipped_corners(&plane.corners, paint));
            self.ensure_with(colours, || flipped_corners(&paint.corners, paint));
            let count = u32::try_from(3 * paint.flipped.len()).unwrap_or(0);
            plan.faces.push(Faces { draw: Draw { buffers: vec![corners, colours], count }, opacity: 1.0 });
        }
        let corners = self.plane_or_zeros(Some(plane), mesh);
        let paint = self.paint_or_zeros(frame.paint.as_ref(), mesh);
        let draw = Draw { buffers: vec![corners, paint], count: corner_count(mesh) };
        plan.faces.push(Faces { draw, opacity: frame.style.face_opacity.into() });

        for layer in &frame.fills {
            let key = Key::PlaneFills(plane.revision, layer.faces.revision);
            // Corners at missing vertices coincide, so such faces vanish.
            let position = |v: VertexId| plane.points.get(v.index()).copied().unwrap_or_default();
            self.ensure_with(key, || layer.faces.triangles.iter().flat_map(|corners| corners.map(position)).collect());
            let uniforms = LineUniforms::new(layer.colour, 0.0, 1.0, 0.0);
            plan.push(Shape::Fill, self.draw_of(key, PLANE_POINT_STRIDE), uniforms);
        }
        let ghost = frame.ghost.as_ref().map(|ghost| (&ghost.plane, &ghost.line));
        for (plane, layer) in frame.lines.iter().map(|layer| (plane, layer)).chain(ghost) {
            let key = Key::PlaneLines(plane.revision, layer.edges.revision);
            self.ensure_with(key, || segments(&plane.points, vertex_pairs(&layer.edges)));
            plan.push(Shape::Line, self.draw_of(key, PLANE_LINE_STRIDE), self.line(layer, 0.0));
        }
        if let Some((paint, uniforms)) = self.outline(&frame.style, &frame.palette, frame.paint.as_ref(), 0.0) {
            let key = Key::PlaneLines(plane.revision, paint.revision);
            self.ensure_with(key, || segments(&plane.points, flipped_outline(mesh, paint)));
            plan.push(Shape::Line, self.draw_of(key, PLANE_LINE_STRIDE), uniforms);
        }
        plan
    }

    fn ensure<T: bytemuck::Pod>(&mut self, key: Key, values: &[T]) {
        self.cache.ensure(self.device, key, || Cow::Borrowed(bytemuck::cast_slice(values)));
    }

    fn ensure_with<T: bytemuck::Pod>(&mut self, key: Key, values: impl FnOnce() -> Vec<T>) {
        self.cache.ensure(self.device, key, || Cow::Owned(bytemuck::cast_slice(&values()).to_vec()));
    }

    fn plane_or_zeros(&mut self, plane: Option<&Arc<PlaneArrays>>, mesh: &MeshArrays) -> Key {
        self.stream_or_zeros(plane.map(|plane| (Key::Plane(plane.revision), &*plane.corners)), mesh)
    }

    fn paint_or_zeros(&mut self, paint: Option<&Arc<FacePaint>>, mesh: &MeshArrays) -> Key {
        self.stream_or_zeros(paint.map(|paint| (Key::Paint(paint.revision), &*paint.corners)), mesh)
    }

    /// Buffer with one value per corner of the mesh. A stream of another length belongs to another mesh and is
    /// replaced by zeros.
    fn stream_or_zeros<T: bytemuck::Pod>(&mut self, stream: Option<(Key, &[T])>, mesh: &MeshArrays) -> Key {
        let count = mesh.corner_positions.len();
        if let Some((key, corners)) = stream.filter(|(_, corners)| corners.len() == count) {
            self.ensure(key, corners);
            return key;
        }
        let size = (size_of::<T>() * count) as u64;
        self.cache.ensure_zeros(self.device, size);
        Key::Zeros(size)
    }

    /// Draw call of a whole buffer.
    fn draw_of(&self, key: Key, stride: u64) -> Draw {
        let size = self.cache.get(key).map_or(0, wgpu::Buffer::size);
        Draw { buffers: vec![key], count: u32::try_from(size / stride).unwrap_or(0) }
    }

    fn line(&self, layer: &LineLayer, lift: f32) -> LineUniforms {
        LineUniforms::new(layer.colour, layer.width_in_points, self.size.pixels_per_point, lift)
    }

    fn outline<'p>(
        &self,
        style: &Style,
        palette: &Palette,
        paint: Option<&'p Arc<FacePaint>>,
        lift: f32,
    ) -> Option<(&'p FacePaint, LineUniforms)> {
        let width = style.flipped_outline_in_points;
        let paint = paint.filter(|paint| width > 0.0 && !paint.flipped.is_empty())?;
        Some((paint, LineUniforms::new(palette.flipped, width, self.size.pixels_per_point, lift)))
    }
}

fn corner_count(mesh: &MeshArrays) -> u32 {
    u32::try_from(mesh.corner_positions.len()).unwrap_or(0)
}

fn vertex_pairs(edges: &EdgeList) -> impl Iterator<Item = [usize; 2]> + '_ {
    edges.ends.iter().map(|ends| ends.map(VertexId::index))
}

/// Start and end of each line; lines to missing vertices shrink to a point.
fn segments<P: Copy + Default + bytemuck::Pod>(points: &[P], ends: impl Iterator<Item = [usize; 2]>) -> Vec<P> {
    ends.flat_map(|ends| ends.map(|v| points.get(v).copied().unwrap_or_default())).collect()
}

/// Sides of flipped faces that no other flipped face shares: the outline of each flipped region.
fn flipped_outline(mesh: &MeshArrays, paint: &FacePaint) -> impl Iterator<Item = [usize; 2]> {
    let faces = paint.flipped.iter().filter_map(|face| mesh.triangles.get(face.index()));
    let mut sides: Vec<[usize; 2]> = faces
        .map(|triangle| triangle.map(VertexId::index))
        .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    sides.sort_unstable();
    sides.chunk_by(|a, b| a == b).filter(|run| run.len() == 1).map(|run| run[0]).collect::<Vec<_>>().into_iter()
}

fn flipped_corners<T: Copy>(corners: &[T], paint: &FacePaint) -> Vec<T> {
    let of_face = |face: usize| corners.get(3 * face..3 * face + 3).unwrap_or_default();
    paint.flipped.iter().flat_map(|face| of_face(face.index()).iter().copied()).collect()
}
