//! Requests of a person to the window. Panels collect requests; the editor carries them out after the frame.

use eframe::egui;
use glam::DVec2;

use super::comparison::MorphRequest;
use super::file_dialog_kind::FileDialogKind;
use super::hull_stage::HullStage;
use super::inset_view::InsetPan;
use super::pane::{Pane, Tab};
use super::seam::{SeamClick, SeamRule};
use super::shading_mode::ShadingMode;
use super::tool::Tool;
use super::unsaved::UnsavedAnswer;
use crate::session::Action;
use crate::view::Quantity;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Fit;
use freebound_core::problem::{PinKind, Variant};
use freebound_io::Column;

/// A step among those that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepTarget {
    /// The first.
    First,
    /// The one before that on the screen.
    Previous,
    /// The one after that on the screen.
    Next,
    /// The newest.
    Last,
}

/// Something a person asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// An edit of the document, or work on it.
    Do(Action),
    /// Lets the run go on, or pauses it.
    RunOrPause,
    /// Shows another step.
    GoToStep(StepTarget),
    /// Plays the steps as an animation, or stops it.
    TogglePlay,
    /// Shows or hides the curves under the panes.
    ToggleCurves,
    /// Takes up a tool.
    SetTool(Tool),
    /// Takes up the constrain tool with a vertex, whose place is to come.
    TakeVertex(VertexId),
    /// The seam tool clicks a vertex.
    ClickSeam(SeamClick),
    /// Cuts along the edges of a rule.
    CutByRule(SeamRule),
    /// Closes all seams that are listed.
    ClearSeams,
    /// Chooses from which angle on edges are sharp, degrees.
    SetSharp(f64),
    /// The next click of the seam tool begins another seam.
    EndSeam,
    /// Chooses what the paths of seams follow: from 0, the shortest, to 1, creases.
    SetCreases(f64),
    /// Lets clicks of the seam tool take seams away, or cut again.
    ToggleErasing,
    /// Colours faces in the pane under the pointer, or in both where it is over neither.
    SetShading(ShadingMode),
    /// Colours faces in one pane.
    SetPaneShading(Pane, ShadingMode),
    /// Shows or hides the wireframe.
    ToggleWireframe,
    /// Shows or hides the inset that magnifies a defect.
    ToggleMagnifier,
    /// Brings what an inset shows nearer by a factor: that of a defect by its place in the list, or that of a pair.
    ZoomInset(Option<usize>, f64),
    /// Pans what an inset shows.
    PanInset(InsetPan),
    /// Marks vertices outside the hull of their neighbours, or not.
    ToggleOutsideHull,
    /// Lets vertices glide from step to step, or not.
    ToggleEase,
    /// Shows or hides hull and pockets of the virtual boundary.
    ToggleHull,
    /// Chooses the stage of the virtual boundary that shows.
    SetStage(HullStage),
    /// Opens a tab.
    ShowTab(Tab),
    /// Shows or hides the panels.
    TogglePanels,
    /// Frames the selection, or all where nothing is selected.
    Frame,
    /// Shows vertices in both panes and selects them.
    GoTo(Vec<VertexId>),
    /// Shows a defect in both panes, by its place in the list.
    GoToDefect(usize),
    /// Goes to another defect: 1 the next, −1 the one before.
    StepDefect(isize),
    /// Puts another chart on the screen: 1 the next, −1 the one before.
    StepChart(isize),
    /// Selects exactly these vertices.
    Select(Vec<VertexId>),
    /// Adds vertices to the selection.
    AddToSelection(Vec<VertexId>),
    /// Selects a vertex beside the others, or no more.
    ToggleSelected(VertexId),
    /// Frees the selected pins.
    UnpinSelected,
    /// Moves the selected pins by pixels of the picture; y runs up.
    Nudge(DVec2),
    /// The keys that nudge are let go.
    EndNudge,
    /// Holds the selected pins in another way, and pins that are placed from now on.
    SetPinKind(PinKind),
    /// Chooses how strongly the picture shows behind the embedding, 0 to 1.
    SetOpacity(f32),
    /// Shows pixels of the picture as squares, or fading into each other.
    ToggleSharp,
    /// Gives up the gesture, then the tool, then the selection.
    Escape,
    /// Shows one pane in full size, or both again.
    ToggleFull(Pane),
    /// Shows the pane without the pointer in full size, or both again.
    TogglePane,
    /// Shows methods side by side in the place of the embedding, or the embedding again.
    ToggleComparison,
    /// Has a method take part in the comparison, or no more.
    ToggleContender(Variant),
    /// Takes a method of the comparison as that of the document.
    TakeContender(Variant),
    /// Colours the faces of all methods by a quantity, or not at all.
    ColourComparison(Option<Quantity>),
    /// Sorts the table of the comparison by a column.
    SortComparison(Column),
    /// Shows or hides the table of the comparison.
    ToggleComparisonTable,
    /// Does something with the morph between two methods of the comparison.
    Morph(MorphRequest),
    /// Asks for a file.
    Ask(FileDialogKind),
    /// Saves the project where it was saved before, or asks where.
    SaveProject,
    /// Shows or hides what can be exported.
    ToggleExports,
    /// Answers the question about unsaved work.
    Answer(UnsavedAnswer),
    /// Leaves faces that point inward as they are.
    LeaveFaces,
    /// Leaves targets that look mirrored as they are.
    LeaveTargets,
    /// Asks for an element to go to.
    AskGoTo,
    /// Opens a menu of the bar by its place, for whoever has no mouse.
    OpenMenu(usize),
    /// Shows or hides the list of keys.
    ToggleKeys,
    /// Follows the system's theme, or a fixed one.
    SetTheme(egui::ThemePreference),
    /// Chooses the size of coordinates in files.
    SetFit(Fit),
    /// Ends the program.
    Quit,
}

impl From<Action> for Request {
    fn from(action: Action) -> Self {
        Self::Do(action)
    }
}
