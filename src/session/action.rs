//! Requests of the user. [`Session::handle`](super::Session::handle) carries them out.

use std::collections::BTreeSet;
use std::path::PathBuf;

use glam::DVec2;

use super::StopConditions;
use super::page::{ChartMove, ChartVertices};
use crate::examples::Example;
use freebound_core::bijective::Brush;
use freebound_core::geom::{PackingOptions, VAxis};
use freebound_core::mesh::{HoleTreatment, Repair, Seams, VertexId, WeldDistance};
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{PinKind, Settings, Variant};
use freebound_io::{BakeOptions, OutputKind, PatternOptions, PinName};

/// Request to write a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SaveRequest {
    /// Path of the file.
    pub path: PathBuf,
    /// Format and content of the file.
    pub kind: OutputKind,
    /// Size of the layout, unless the user's pins set the size.
    pub fit: Fit,
}

/// Request to write a cutting pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternRequest {
    /// Path of the file. Its extension selects the format.
    pub path: PathBuf,
    /// Options of the pattern.
    pub options: PatternOptions,
}

/// Request to draw the picture of the file's layout for the layout on the screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BakeRequest {
    /// Path of the new picture.
    pub path: PathBuf,
    /// Size and margin of the new picture.
    pub options: BakeOptions,
}

/// Files that are opened together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UndoGroup {
    /// Path of the mesh or project.
    pub mesh: PathBuf,
    /// Picture for the mesh.
    pub picture: Option<PathBuf>,
    /// Constraint files for the mesh.
    pub constraints: Vec<PathBuf>,
    /// Files that are not opened, because only one mesh with one picture can be open at a time.
    pub left: Vec<PathBuf>,
}

/// Brush with the position of the pointer in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushDab {
    /// The brush. It does not change during a stroke.
    pub brush: Brush,
    /// Position of the pointer.
    pub at: DVec2,
    /// True if the button was pressed for it. Otherwise it only continues a stroke.
    pub begins: bool,
}

/// Brush on a chart of the page. Radius and position are in the page's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageDab {
    /// The chart.
    pub chart: usize,
    /// The brush and its position.
    pub dab: BrushDab,
    /// True if the chart may come to overlap others.
    pub insists: bool,
}

/// Request of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Opens a mesh file or a project.
    Open(PathBuf),
    /// Opens a mesh file or a project together with a picture and constraints.
    OpenTogether(UndoGroup),
    /// Opens a built-in mesh.
    OpenExample(Example),
    /// Opens the file that waits for confirmation because it may take more than half of the machine's memory.
    OpenLarge,
    /// Declines to open the file that waits for confirmation.
    LeaveLarge,
    /// Opens the project whose mesh is missing with another mesh file.
    LocateMesh(PathBuf),
    /// Opens the project whose picture is missing with another picture file.
    LocatePicture(PathBuf),
    /// Drops the landmarks that wait for a vertex. Pins stay.
    CloseLandmarks,
    /// Clears the list of recently opened files.
    ClearRecent,
    /// Pins vertices at their current positions.
    Fix(Vec<VertexId>),
    /// Pins vertices of charts where they lie on the page. All charts stay where they lie.
    FixOnPage(Vec<ChartVertices>),
    /// Opens a picture to be mapped onto the mesh.
    OpenPicture(PathBuf),
    /// Removes the picture.
    RemovePicture,
    /// Sets the side of the picture with v = 0. The targets keep their positions on the picture.
    SetVAxis(VAxis),
    /// Reverses the orientation of all faces, which swaps the inside and the outside of the mesh.
    TurnFaces,
    /// Repairs the mesh and cuts it along short seams whose map keeps a bound on the mean symmetric Dirichlet energy.
    /// Default: the bound of the last cut, or 4.1.
    Unwrap(Option<f64>),
    /// Sets the cost of edges for automatic seams, relative to their length, and cuts the mesh along the seams that
    /// are cheapest then.
    PaintSeams {
        /// Edges, by vertices of the file.
        edges: Vec<[VertexId; 2]>,
        /// Their cost. Default of an edge: 1.
        cost: f64,
    },
    /// Finds the seams of [`Unwrap`](Self::Unwrap) for a bound and shows them, but does not cut the mesh. `None` ends
    /// the preview.
    PreviewSeams(Option<f64>),
    /// Replaces the seams that the mesh is cut along. Each seam edge has to be an edge of the file.
    SetSeams(Seams),
    /// Sets the treatment of holes.
    SetHoles(HoleTreatment),
    /// Judges the texture coordinates of the file in the background.
    CheckLayout,
    /// Starts from the texture coordinates of the file and cuts the mesh along their seams, if there are any.
    TakeLayout,
    /// Copies the layout of another mesh file: its seams, and its charts at their places.
    CopyLayout(PathBuf),
    /// Adds the edges in a file to the seams.
    ImportSeams(PathBuf),
    /// Writes the seams to a file of edges.
    ExportSeams(PathBuf),
    /// Allows one kind of repair of the mesh.
    AllowRepair(Repair),
    /// Replaces the set of parts that are left out. A part is identified by its first face, numbered in the file.
    LeaveOut(BTreeSet<u32>),
    /// Welds vertices within a distance, or stops welding.
    Weld(Option<WeldDistance>),
    /// Counts the vertices that welding within a distance would join.
    CountNear(WeldDistance),
    /// Shows another chart of a mesh with several charts.
    ShowChart(usize),
    /// Sets the packing options.
    SetPacking(PackingOptions),
    /// Sets the size of a chart relative to the other packed charts.
    SetChartSize {
        /// The chart.
        chart: usize,
        /// Relative size, within [`PackingOptions::SIZES`].
        size: f64,
    },
    /// Locks charts where they lie on the page, or unlocks them.
    LockCharts {
        /// The charts.
        charts: BTreeSet<usize>,
        /// True to lock the charts.
        lock: bool,
    },
    /// Moves charts in the page's plane, as a frame of a gesture. Each movement starts from the place before the gesture.
    MoveCharts {
        /// Charts and their movements.
        moves: Vec<ChartMove>,
        /// True if charts may come to overlap.
        insists: bool,
    },
    /// Ends a move of charts.
    EndMove,
    /// Drops a move of charts.
    GiveUpMove,
    /// Packs charts around all others: these charts, or all that are not locked.
    PackCharts(Option<BTreeSet<usize>>),
    /// Lays charts with congruent surfaces, or mirror images, on the first of them.
    StackCharts(BTreeSet<usize>),
    /// Gives stacked charts places of their own.
    UnstackCharts(BTreeSet<usize>),
    /// Places a constraint: pins a vertex, or replaces its pin.
    Place {
        /// The vertex.
        vertex: VertexId,
        /// Its target.
        target: Target,
    },
    /// Moves one pin during a drag. If the vertex is a gauge pin, all gauge pins become pins of the user.
    MovePin {
        /// The pinned vertex.
        vertex: VertexId,
        /// New target, in texture coordinates.
        target: DVec2,
    },
    /// Moves several of the user's pins during a drag.
    MovePins(Vec<(VertexId, DVec2)>),
    /// Applies a brush to the map on the screen, as a frame of a stroke.
    Brush(BrushDab),
    /// Applies a brush to a chart of the page, as a frame of a stroke.
    BrushOnPage(PageDab),
    /// Ends a stroke of a brush.
    EndBrush,
    /// Drops a stroke of a brush.
    GiveUpBrush,
    /// Reports that the pointer pauses during a drag, so that the remaining steps are taken.
    Rest,
    /// Changes the kind of pins.
    SetPinKind {
        /// The pinned vertices.
        vertices: Vec<VertexId>,
        /// New kind of the pins.
        kind: PinKind,
    },
    /// Changes the kind of pins during a drag of a slider.
    SlideHold {
        /// The pinned vertices.
        vertices: Vec<VertexId>,
        /// New kind of the pins.
        kind: PinKind,
    },
    /// Mirrors all targets left to right within their bounding box.
    MirrorTargets,
    /// Moves all targets by the similarity that fits them best to the undistorted embedding within the picture.
    FitTargets,
    /// Imports the constraints of a file. Constraints on other vertices are kept.
    ImportConstraints(PathBuf),
    /// Writes the user's pins to a constraint file.
    ExportConstraints(PathBuf),
    /// Saves the project.
    SaveProject(PathBuf),
    /// Opens the recovery copy of a session that ended without saving.
    Recover(PathBuf),
    /// Deletes a recovery copy.
    DiscardRecovery(PathBuf),
    /// Ends a drag.
    EndGesture,
    /// Cancels a drag and restores the state before it.
    GiveUpGesture,
    /// Names a pin, or takes its name away.
    NamePin {
        /// The pinned vertex.
        vertex: VertexId,
        /// New name.
        name: Option<PinName>,
    },
    /// Keeps the first of two pins and frees the second.
    MergePins([VertexId; 2]),
    /// Unpins vertices.
    Unpin(Vec<VertexId>),
    /// Unpins vertices of charts of the page. All other charts stay where they lie.
    UnpinOnPage(Vec<ChartVertices>),
    /// Unpins all vertices.
    UnpinAll,
    /// Sets method and weights.
    SetSettings(Settings),
    /// Sets method and weights during a drag of a slider.
    SlideSettings(Settings),
    /// Undoes the last edit.
    Undo,
    /// Redoes the edit that was undone last.
    Redo,
    /// Solves from scratch, ignoring the current embedding.
    Solve,
    /// Takes one more step.
    Step,
    /// Continues until a stop condition holds or the method ends.
    Run,
    /// Lowers the distortion of a planar embedding. Every step is one-to-one and meets the constraints exactly.
    Relax,
    /// Takes all steps of the automatic method if the newest step is not planar.
    Repair,
    /// Stops the work in the background. Steps that are finished are kept.
    Cancel,
    /// Shows a step.
    ShowStep(usize),
    /// Compares the shown step with another step, or ends the comparison.
    Compare(Option<usize>),
    /// Compares methods in the background. They run again after each edit of the document. An empty list ends the
    /// comparison.
    CompareMethods(Vec<Variant>),
    /// Finds the planar morph between the maps of two compared methods, again after each edit. `None` ends the morph.
    Morph(Option<[Variant; 2]>),
    /// Sets the stop conditions of runs.
    SetStop(StopConditions),
    /// Writes a file.
    Save(SaveRequest),
    /// Writes the layout as a flat mesh.
    SaveFlatMesh(PathBuf),
    /// Writes a cutting pattern.
    SavePattern(PatternRequest),
    /// Writes the picture of the file's layout, drawn for the layout on the screen.
    SaveBaked(BakeRequest),
    /// Reports a file name whose extension selects no kind of output.
    RefuseName(PathBuf),
    /// Reports a file that exists and is not replaced, because the user was not asked about it.
    RefuseToReplace(PathBuf),
    /// Shows the folder of a file in the system's file manager.
    ShowFolder(PathBuf),
    /// Dismisses a message.
    Dismiss(u64),
}
