//! Something the user asked for. [`Session::handle`](super::Session::handle) carries it out.

use std::collections::BTreeSet;
use std::path::PathBuf;

use glam::DVec2;

use super::StopConditions;
use crate::examples::Example;
use freebound_core::geom::{PackingOptions, VAxis};
use freebound_core::mesh::{HoleTreatment, Repair, Seams, VertexId, WeldDistance};
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{PinKind, Settings, Variant};
use freebound_io::OutputKind;

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SaveRequest {
    /// Where.
    pub path: PathBuf,
    /// What.
    pub kind: OutputKind,
    /// At which size, where the user's pins do not say.
    pub fit: Fit,
}

/// Files that are opened together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UndoGroup {
    /// The mesh, or the project.
    pub mesh: PathBuf,
    /// A picture for it.
    pub picture: Option<PathBuf>,
    /// Constraints on it.
    pub constraints: Vec<PathBuf>,
    /// Files that are not opened, for there is one mesh at a time, with one picture.
    pub left: Vec<PathBuf>,
}

/// One request.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Opens a mesh file, or a project.
    Open(PathBuf),
    /// Opens a mesh file or a project, and what belongs to it.
    OpenTogether(UndoGroup),
    /// Opens a built-in mesh.
    OpenExample(Example),
    /// Opens the file that waits for a word, for it may take more than half of the machine's memory.
    OpenLarge,
    /// Leaves it.
    LeaveLarge,
    /// Forgets the files opened last.
    ClearRecent,
    /// Pins vertices where they lie.
    Fix(Vec<VertexId>),
    /// Opens a picture to map on the mesh.
    OpenPicture(PathBuf),
    /// Goes without a picture.
    RemovePicture,
    /// Chooses where v = 0 is on the picture. The targets keep their places on it.
    SetVAxis(VAxis),
    /// Turns the mesh's faces around: the other side is the outside.
    TurnFaces,
    /// Mends what keeps the mesh from being a disk, and cuts it open.
    Mend,
    /// Cuts the mesh along these seams, and no others. They are of edges that the file has.
    SetSeams(Seams),
    /// Chooses what becomes of the mesh's holes.
    SetHoles(HoleTreatment),
    /// Starts from the texture coordinates of the file, cut along their seams, where they have any.
    TakeLayout,
    /// Cuts the mesh along the edges of a file, too.
    ImportSeams(PathBuf),
    /// Writes the seams as a file of edges.
    ExportSeams(PathBuf),
    /// Mends one kind of fault of the mesh.
    AllowRepair(Repair),
    /// Leaves out parts of the mesh, by the file's numbers of their first faces, and no others.
    LeaveOut(BTreeSet<u32>),
    /// Joins vertices of the mesh that lie within a distance, or does not any more.
    Weld(Option<WeldDistance>),
    /// Counts the vertices that a distance would join.
    CountNear(WeldDistance),
    /// Puts another chart on the screen, where the mesh has several.
    ShowChart(usize),
    /// Chooses how charts are packed.
    SetPacking(PackingOptions),
    /// Chooses how many times as large as the others a chart is packed.
    SetChartSize {
        /// The chart.
        chart: usize,
        /// How many times, within [`PackingOptions::SIZES`].
        size: f64,
    },
    /// Places a constraint: pins a vertex, which may be pinned already.
    Place {
        /// The vertex.
        vertex: VertexId,
        /// Its target.
        target: Target,
    },
    /// Moves a pin, as part of a drag. A gauge pin becomes the user's, with all others.
    MovePin {
        /// The pinned vertex.
        vertex: VertexId,
        /// Where it is to go, in texture coordinates.
        target: DVec2,
    },
    /// Moves several pins of the user's, as part of a drag.
    MovePins(Vec<(VertexId, DVec2)>),
    /// The pointer rests in the middle of a drag: the steps after the first are worth taking.
    Rest,
    /// Holds pins in another way.
    SetPinKind {
        /// The pinned vertices.
        vertices: Vec<VertexId>,
        /// How they are to be held.
        kind: PinKind,
    },
    /// The same as part of a drag of a slider.
    SlideHold {
        /// The pinned vertices.
        vertices: Vec<VertexId>,
        /// How they are to be held.
        kind: PinKind,
    },
    /// Mirrors all targets left to right, within the box around them.
    MirrorTargets,
    /// Turns, scales and moves all targets together to where they fit the undistorted embedding best, in the picture.
    FitTargets,
    /// Takes over the constraints of a file; those of other vertices stay.
    ImportConstraints(PathBuf),
    /// Writes the user's pins as a constraint file.
    ExportConstraints(PathBuf),
    /// Saves the project.
    SaveProject(PathBuf),
    /// Opens what was left of a session that ended without saving.
    Recover(PathBuf),
    /// Forgets it.
    DiscardRecovery(PathBuf),
    /// Ends a drag.
    EndGesture,
    /// Gives a drag up: everything is as it was before it.
    GiveUpGesture,
    /// Frees vertices.
    Unpin(Vec<VertexId>),
    /// Frees all vertices.
    UnpinAll,
    /// Chooses method and weights.
    SetSettings(Settings),
    /// Chooses method and weights as part of a drag of a slider.
    SlideSettings(Settings),
    /// Takes back the last edit.
    Undo,
    /// Repeats the last edit taken back.
    Redo,
    /// Solves from scratch: goes on from nothing that was there.
    Solve,
    /// Takes one further step.
    Step,
    /// Goes on until a stop condition holds or the method has ended.
    Run,
    /// Lowers the distortion of a planar embedding, one-to-one throughout, constraints exact.
    Relax,
    /// Takes all steps of the flattener where the newest one is at fault.
    Repair,
    /// Stops what is going on in the background. The steps that there are stay.
    Cancel,
    /// Puts a step on the screen.
    ShowStep(usize),
    /// Compares the step on the screen with another one, or with none.
    Compare(Option<usize>),
    /// Compares these methods in the background, on the document as it is and as it will be; none ends that.
    CompareMethods(Vec<Variant>),
    /// Finds the planar morph between the maps of two methods that are compared, as they are and as they will be; none ends that.
    Morph(Option<[Variant; 2]>),
    /// Chooses where a run comes to rest.
    SetStop(StopConditions),
    /// Writes a file.
    Save(SaveRequest),
    /// Says that a name does not tell what kind of file to write.
    RefuseName(PathBuf),
    /// Shows the folder that a file lies in.
    ShowFolder(PathBuf),
    /// Takes a message off the screen.
    Dismiss(u64),
}
