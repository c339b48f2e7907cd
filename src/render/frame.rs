//! Content of a pane in one frame. Cheap to build: the arrays are shared, the rest is small.

use std::sync::Arc;

use crate::view::{
    DrawnFaces, EdgeList, FacePaint, MeshArrays, OrbitCamera, Palette, PictureQuad, PlaneArrays, PlaneCamera, Srgb,
};
use freebound_core::geom::Bounds;

/// Name of a pane, so that each keeps its own target. Panes in one window need different names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PaneId(pub &'static str);

/// Source of the face colours. Flipped faces have their own colour in every shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceShading {
    /// Clay on the mesh, one flat colour in the plane.
    #[default]
    Plain,
    /// Checker pattern in the plane, mapped to the mesh.
    Checker,
    /// The colours of the [`FacePaint`].
    Paint,
    /// Picture in the plane, mapped to the mesh.
    Picture,
    /// Picture repeated over the plane, mapped to the mesh: a tile for every eight by eight checks.
    Pattern,
}

impl FaceShading {
    /// Width of a legible wireframe, points. Lines between two pixels cover each by half their width; over a checker
    /// or a picture that must suffice for a contrast of 3 : 1.
    pub const fn wire_in_points(self) -> f32 {
        match self {
            Self::Plain | Self::Paint => 1.0,
            Self::Checker | Self::Picture | Self::Pattern => 1.75,
        }
    }
}

/// Normals for the light on the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Smooth except at creases.
    #[default]
    Smooth,
    /// Flat normals, a single normal per face.
    Flat,
}

/// Appearance of faces other than their colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Source of the face colours.
    pub shading: FaceShading,
    /// Normals for the light on the mesh.
    pub normals: Normals,
    /// Width of the wireframe in points, 0 for none.
    pub wire_in_points: f32,
    /// Width of the outline of flipped faces in points, 0 for none. The outline shows faces that are too thin to
    /// see.
    pub flipped_outline_in_points: f32,
    /// Side of a check, embedding units.
    pub check_size: f64,
    /// Opacity of the faces in the plane, 0 to 1. Flipped faces and all faces of the mesh are opaque.
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
    /// Edges to draw.
    pub edges: Arc<EdgeList>,
    /// Colour of the lines.
    pub colour: Srgb,
    /// Width of the lines, points.
    pub width_in_points: f32,
}

/// Faces that do not belong to the mesh, filled with one colour. Faces of the mesh cover them.
#[derive(Clone, Debug)]
pub struct FillLayer {
    /// Faces to fill.
    pub faces: Arc<DrawnFaces>,
    /// Fill colour.
    pub colour: Srgb,
}

/// Line over the embedding with vertices of another embedding.
#[derive(Clone, Debug)]
pub struct GhostLayer {
    /// Positions of the line's vertices, in the unit space of the shown embedding.
    pub plane: Arc<PlaneArrays>,
    /// Line to draw.
    pub line: LineLayer,
}

/// Sampling of a picture whose pixels are larger than the screen's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Interpolated between pixels.
    #[default]
    Smooth,
    /// Squares of one colour.
    Sharp,
}

/// Picture in the plane.
#[derive(Clone, Debug)]
pub struct PictureLayer {
    /// Pixels of the picture.
    pub picture: Arc<PictureQuad>,
    /// Position of the picture, embedding units. Default: the unit square.
    pub bounds: Bounds,
    /// Opacity behind the embedding, 0 to 1. On faces it is opaque.
    pub opacity: f32,
    /// Sampling of the pixels.
    pub sampling: Sampling,
}

/// Other parts around the mesh, in the same unit space.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Faces of the other parts.
    pub mesh: Arc<MeshArrays>,
    /// Faint paint of the other parts: [`FacePaint::faint`].
    pub paint: Arc<FacePaint>,
}

/// Content of the 3D pane.
#[derive(Clone, Debug)]
pub struct MeshFrame {
    /// Other parts around the mesh.
    pub around: Option<Surroundings>,
    /// Mesh to show.
    pub mesh: Arc<MeshArrays>,
    /// Embedding, for checker and picture. Without it these shadings are plain.
    pub plane: Option<Arc<PlaneArrays>>,
    /// Colours and flags of the faces. Without it no face is flipped.
    pub paint: Option<Arc<FacePaint>>,
    /// Lines; later ones cover earlier ones.
    pub lines: Vec<LineLayer>,
    /// Lines on the other parts around the mesh.
    pub around_lines: Vec<LineLayer>,
    /// The picture for [`FaceShading::Picture`].
    pub picture: Option<PictureLayer>,
    /// Tile for [`FaceShading::Pattern`].
    pub pattern: Option<Arc<PictureQuad>>,
    /// Camera of the pane.
    pub camera: OrbitCamera,
    /// Appearance of the faces.
    pub style: Style,
    /// Colours of the pane.
    pub palette: Palette,
}

/// Content of the embedding's pane.
#[derive(Clone, Debug)]
pub struct PlaneFrame {
    /// Mesh, for its faces.
    pub mesh: Arc<MeshArrays>,
    /// Embedding. Without it only the background shows.
    pub plane: Option<Arc<PlaneArrays>>,
    /// Colours and flags of the faces. Without it no face is flipped.
    pub paint: Option<Arc<FacePaint>>,
    /// Faces that do not belong to the mesh.
    pub fills: Vec<FillLayer>,
    /// Lines; later ones cover earlier ones.
    pub lines: Vec<LineLayer>,
    /// Line of another embedding, over all other lines.
    pub ghost: Option<GhostLayer>,
    /// Picture behind the embedding.
    pub picture: Option<PictureLayer>,
    /// Tile for [`FaceShading::Pattern`].
    pub pattern: Option<Arc<PictureQuad>>,
    /// Outlined box: the unit square of texture coordinates, in the plane.
    pub outlined: Bounds,
    /// Camera of the pane.
    pub camera: PlaneCamera,
    /// Appearance of the faces.
    pub style: Style,
    /// Colours of the pane.
    pub palette: Palette,
}
