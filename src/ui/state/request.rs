//! Requests of the user to the window. Panels collect requests; the editor carries them out after the frame.

use eframe::egui;
use glam::DVec2;

use super::brush::BrushChoice;
use super::checker::CheckerRequest;
use super::comparison::MorphRequest;
use super::file_dialog_kind::{ExportOptions, FileDialogKind};
use super::hull_stage::HullStage;
use super::inset_view::InsetPan;
use super::page::PageRequest;
use super::pane::{Pane, Tab};
use super::seam::{SeamClick, SeamRule};
use super::select_by::{SelectBy, SelectionKind};
use super::shading_mode::ShadingMode;
use super::timeline_view::CurveRequest;
use super::tool::Tool;
use super::unsaved::UnsavedAnswer;
use crate::session::Action;
use crate::view::{ElementSet, MeshElement, Quantity};
use freebound_core::mesh::{FaceId, VertexId};
use freebound_core::pipeline::Fit;
use freebound_core::problem::{PinKind, Variant};
use freebound_io::Column;

/// Target among the existing steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepTarget {
    /// First step.
    First,
    /// Step before the one on the screen.
    Previous,
    /// Step after the one on the screen.
    Next,
    /// Newest step.
    Last,
}

/// Request of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Edit of the document, or work on it.
    Do(Action),
    /// Starts or continues the run, or pauses it.
    RunOrPause,
    /// Shows another step.
    GoToStep(StepTarget),
    /// Plays the steps as an animation, or stops it.
    TogglePlay,
    /// Shows or hides the curves under the panes.
    ToggleCurves,
    /// Request to the curves of the steps.
    Curve(CurveRequest),
    /// Activates a tool.
    SetTool(Tool),
    /// Sets the brush of the brush tool.
    SetBrush(BrushChoice),
    /// Enlarges the brush by a step, or makes it smaller.
    ResizeBrush {
        /// True to enlarge it.
        grows: bool,
    },
    /// Activates the constrain tool with a vertex that waits for its target.
    TakeVertex(VertexId),
    /// Click of the seam tool on a vertex.
    ClickSeam(SeamClick),
    /// Adds the edges that a rule chooses to the seams.
    CutByRule(SeamRule),
    /// Closes all listed seams.
    ClearSeams,
    /// Sets the least angle of sharp edges, degrees.
    SetSharp(f64),
    /// Ends the seam being drawn. The next click of the seam tool begins another.
    EndSeam,
    /// Sets the preference of seam paths: from 0, shortest, to 1, along creases.
    SetCreases(f64),
    /// Switches clicks of the seam tool between cutting and closing seams.
    ToggleErasing,
    /// Starts or ends painting where no automatic seam may run.
    TogglePainting,
    /// Sets the shading of the pane under the pointer, or of both panes if it is over neither.
    SetShading(ShadingMode),
    /// Sets the shading of one pane.
    SetPaneShading(Pane, ShadingMode),
    /// Colours both panes by a column of the open table.
    ShowColumn(usize),
    /// Request to the checker over the plane.
    Checker(CheckerRequest),
    /// Shows or hides the wireframe.
    ToggleWireframe,
    /// Shows or hides the insets that magnify a defect and a pair.
    ToggleMagnifier,
    /// Zooms an inset by a factor: the inset of a defect by its place in the list, or the insets of a pair.
    ZoomInset(Option<usize>, f64),
    /// Pans an inset.
    PanInset(InsetPan),
    /// Marks vertices outside the hull of their neighbours, or stops marking.
    ToggleOutsideHull,
    /// Turns transitions between steps on or off.
    ToggleEase,
    /// Picks and selects vertices behind the mesh, too, or no longer (X-ray).
    ToggleThrough,
    /// Shows or hides hull and pockets of the virtual boundary.
    ToggleHull,
    /// Sets the displayed stage of the virtual boundary.
    SetStage(HullStage),
    /// Opens a tab.
    ShowTab(Tab),
    /// Shows or hides the panels.
    TogglePanels,
    /// Frames the selection, or everything if nothing is selected.
    Frame,
    /// Shows vertices in both panes and selects them.
    GoTo(Vec<VertexId>),
    /// Shows faces of the file in both panes, with the chart of the first one, and selects their vertices.
    GoToFileFaces(Vec<FaceId>),
    /// Shows vertices by their numbers in files, with the chart of the first one, and selects them.
    GoToFileVertices(Vec<VertexId>),
    /// Shows a defect in both panes, by its place in the list.
    GoToDefect(usize),
    /// Shows another defect: 1 is the next, −1 the previous.
    StepDefect(isize),
    /// Shows another chart: 1 is the next, −1 the previous.
    StepChart(isize),
    /// Locks the chart on the screen where it lies in the layout of all charts, or unlocks it.
    ToggleLock,
    /// Selects vertices, or charts of the page, by the mesh, the map or the selection.
    SelectBy(SelectBy),
    /// Selects exactly these vertices.
    Select(Vec<VertexId>),
    /// Adds vertices to the selection.
    AddToSelection(Vec<VertexId>),
    /// Adds a vertex to the selection, or removes it.
    ToggleSelected(VertexId),
    /// Sets what clicks and regions select.
    SetSelectionKind(SelectionKind),
    /// Selects an element of the page or of the chart on the screen.
    SelectElement {
        /// The element.
        element: MeshElement,
        /// True to add it to the selection, or to remove it.
        adds: bool,
    },
    /// Selects nothing on the page or on the chart on the screen.
    SelectNothing,
    /// Adds elements of the page or of the chart on the screen to the selection.
    AddElements(ElementSet),
    /// Cuts the mesh along the selected edges, or around the selected faces.
    CutSelection,
    /// Closes the seams along the selected edges.
    JoinSelection,
    /// Pins the selected vertices of the page or of the chart on the screen at their current positions.
    FixSelection,
    /// Removes the selected pins.
    UnpinSelected,
    /// Removes all pins of the page, or of the chart on the screen.
    UnpinAll,
    /// Moves the selected pins by pixels of the picture; y points up.
    Nudge(DVec2),
    /// Ends a nudge: its keys are released.
    EndNudge,
    /// Sets the kind of the selected pins. A kind other than fixed also applies to pins placed later.
    SetPinKind(PinKind),
    /// Takes the next landmark that waits for a vertex, after the one with these texture coordinates.
    TakeLandmark {
        /// Landmark before, if any.
        after: Option<DVec2>,
    },
    /// Sets the opacity of the picture behind the embedding, 0 to 1.
    SetOpacity(f32),
    /// Draws pixels of the picture as squares, or interpolated.
    ToggleSharp,
    /// Closes the topmost dialog, else cancels the gesture, else the tool, else the selection.
    Escape,
    /// Request to the page of all charts.
    Page(PageRequest),
    /// Shows one pane in full size, or both again.
    ToggleFull(Pane),
    /// Shows the pane under the pointer in full size, or both panes again. Default: the embedding pane.
    TogglePane,
    /// Shows the method comparison in place of the embedding, or the embedding again.
    ToggleComparison,
    /// Adds a method to the comparison, or removes it.
    ToggleContender(Variant),
    /// Sets the document's settings to those of a compared method.
    TakeContender(Variant),
    /// Colours the faces of all methods by a quantity, or plain.
    ColourComparison(Option<Quantity>),
    /// Sorts the table of the comparison by a column.
    SortComparison(Column),
    /// Shows or hides the table of the comparison.
    ToggleComparisonTable,
    /// Request to the morph between two compared methods.
    Morph(MorphRequest),
    /// Copies the command line that makes the map of the document.
    CopyCommandLine,
    /// Opens a file dialog.
    Ask(FileDialogKind),
    /// Saves the project to its file, or asks for one.
    SaveProject,
    /// Shows or hides the list of exports.
    ToggleExports,
    /// Shows or hides the options of an export.
    ToggleOptions(ExportOptions),
    /// Answers the question about unsaved work.
    Answer(UnsavedAnswer),
    /// Accepts faces that point inward.
    LeaveFaces,
    /// Accepts targets that look mirrored.
    LeaveTargets,
    /// Closes the line on the origin of the map, until another file is opened.
    CloseMapOrigin,
    /// Opens the window "Go to".
    AskGoTo,
    /// Opens a menu of the bar by its place, for use without a mouse.
    OpenMenu(usize),
    /// Shows or hides the list of keys.
    ToggleKeys,
    /// Shows or hides the welcome.
    ToggleWelcome,
    /// Sets whether the welcome shows at a start without a file.
    ToggleWelcomeAtStart,
    /// Opens the command palette, or closes it.
    TogglePalette,
    /// Opens the documentation at a place such as `window.md#pins`. Without a place, opens or closes it.
    ShowDocumentation(Option<&'static str>),
    /// Shows or hides the messages of this run.
    ToggleLog,
    /// Shows or hides version, licence and reference of the program.
    ToggleAbout,
    /// Starts the guided tour.
    StartTour,
    /// Follows the system's theme, or sets a fixed one.
    SetTheme(egui::ThemePreference),
    /// Sets the size of coordinates in files.
    SetFit(Fit),
    /// Ends the program.
    Quit,
}

impl From<PageRequest> for Request {
    fn from(request: PageRequest) -> Self {
        Self::Page(request)
    }
}

impl From<CheckerRequest> for Request {
    fn from(request: CheckerRequest) -> Self {
        Self::Checker(request)
    }
}

impl From<Action> for Request {
    fn from(action: Action) -> Self {
        Self::Do(action)
    }
}
