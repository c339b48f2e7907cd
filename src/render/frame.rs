//! What a pane shows in one frame. Cheap to make: the arrays are shared, the rest is small.

use std::sync::Arc;

use crate::view::{
    DrawnFaces, EdgeList, FacePaint, MeshArrays, OrbitCamera, Palette, PictureQuad, PlaneArrays, PlaneCamera, Srgb,
};
use freebound_core::geom::Bounds;

/// Tells panes apart, so that each keeps its own target. Two panes in one window must not share a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PaneId(pub &'static str);

/// Where the colours of the faces come from. Flipped faces show in their own colour in all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceShading {
    /// Clay on the mesh, one flat colour in the plane.
    #[default]
    Plain,
    /// A checker in the plane, carried over to the mesh.
    Checker,
    /// The colours of the [`FacePaint`].
    Paint,
    /// The picture in the plane, carried over to the mesh.
    Picture,
}

/// How the mesh's light is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Smooth but for creases.
    #[default]
    Smooth,
    /// One per face.
    Flat,
}

/// How faces look, apart from their colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Where the colours come from.
    pub shading: FaceShading,
    /// How the mesh's light is computed.
    pub normals: Normals,
    /// Width of the wireframe in points, 0 for none.
    pub wire_in_points: f32,
    /// Width of the outline of flipped faces in points, 0 for none. It shows faces too thin to see.
    pub flipped_outline_in_points: f32,
    /// Side of a check, embedding units.
    pub check_size: f64,
    /// Opacity of the faces in the plane, 0 to 1; flipped ones are opaque, as all on the mesh are.
    pub face_opacity: f32,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            shading: FaceShading::Plain,
            normals: Normals::Smooth,
            wire_in_points: 0.0,
            flipped_outline_in_points: 1.5,
            check_size: 0.1,
            face_opacity: 1.0,
        }
    }
}

/// Edges drawn as lines of one colour and width.
#[derive(Clone, Debug)]
pub struct LineLayer {
    /// Which edges.
    pub edges: Arc<EdgeList>,
    /// Their colour.
    pub colour: Srgb,
    /// Their width.
    pub width_in_points: f32,
}

/// Faces that are not the mesh's, filled with one colour. They show where no face of the mesh lies over them.
#[derive(Clone, Debug)]
pub struct FillLayer {
    /// Which faces.
    pub faces: Arc<DrawnFaces>,
    /// Their colour.
    pub colour: Srgb,
}

/// A line over the embedding whose vertices are not the embedding's.
#[derive(Clone, Debug)]
pub struct GhostLayer {
    /// Where its vertices lie, in the same unit space as the embedding.
    pub plane: Arc<PlaneArrays>,
    /// The line.
    pub line: LineLayer,
}

/// How a picture's pixels show where they are larger than the screen's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Each fades into the next.
    #[default]
    Smooth,
    /// Each is a square of one colour.
    Sharp,
}

/// A picture in the plane.
#[derive(Clone, Debug)]
pub struct PictureLayer {
    /// The pixels.
    pub picture: Arc<PictureQuad>,
    /// Where the picture lies, embedding units: the unit square, unless the embedding is kept otherwise.
    pub bounds: Bounds,
    /// Opacity behind the embedding, 0 to 1. On faces it is opaque.
    pub opacity: f32,
    /// How its pixels show.
    pub sampling: Sampling,
}

/// What stands around the mesh, in the same unit space.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Its faces.
    pub mesh: Arc<MeshArrays>,
    /// How they stand back: [`FacePaint::faint`].
    pub paint: Arc<FacePaint>,
}

/// The 3D pane.
#[derive(Clone, Debug)]
pub struct MeshFrame {
    /// What stands around the mesh.
    pub around: Option<Surroundings>,
    /// The mesh.
    pub mesh: Arc<MeshArrays>,
    /// Its embedding, for checker and picture. Without one they stay plain.
    pub plane: Option<Arc<PlaneArrays>>,
    /// Colours and flags of the faces. Without it none is flipped.
    pub paint: Option<Arc<FacePaint>>,
    /// Lines, the later over the earlier.
    pub lines: Vec<LineLayer>,
    /// Lines on what stands around the mesh.
    pub around_lines: Vec<LineLayer>,
    /// The picture for [`FaceShading::Picture`].
    pub picture: Option<PictureLayer>,
    /// From where it is seen.
    pub camera: OrbitCamera,
    /// How it looks.
    pub style: Style,
    /// Its colours.
    pub palette: Palette,
}

/// The embedding's pane.
#[derive(Clone, Debug)]
pub struct PlaneFrame {
    /// The mesh, for its faces.
    pub mesh: Arc<MeshArrays>,
    /// The embedding. Without one only the background shows.
    pub plane: Option<Arc<PlaneArrays>>,
    /// Colours and flags of the faces. Without it none is flipped.
    pub paint: Option<Arc<FacePaint>>,
    /// Faces beside the mesh's.
    pub fills: Vec<FillLayer>,
    /// Lines, the later over the earlier.
    pub lines: Vec<LineLayer>,
    /// A line of another embedding, over all others.
    pub ghost: Option<GhostLayer>,
    /// The picture behind the embedding.
    pub picture: Option<PictureLayer>,
    /// What is outlined: the unit square of texture coordinates, as it lies in the plane.
    pub outlined: Bounds,
    /// What part of the plane is seen.
    pub camera: PlaneCamera,
    /// How it looks.
    pub style: Style,
    /// Its colours.
    pub palette: Palette,
}
