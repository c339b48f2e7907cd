//! What a person can ask of the window. Panels collect requests; the editor carries them out after the frame.

use eframe::egui;
use glam::DVec2;

use crate::io::{Column, OutputFit};
use crate::mesh::VertexId;
use crate::session::Action;
use crate::solver::{Hold, Variant};
use crate::ui::editor::seam_rules::SeamRule;
use crate::ui::editor::seam_tool::SeamClick;
use crate::ui::panes::inset::InsetPan;
use crate::ui::{Answer, MorphRequest, Purpose, Stage};
use crate::view::Quantity;

/// What the left mouse button does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Selects vertices.
    #[default]
    Select,
    /// Pins vertices where they lie.
    Fix,
    /// Joins vertices with their places on the picture.
    Constrain,
    /// Cuts the mesh along paths from vertex to vertex.
    Seam,
}

impl Tool {
    /// All tools, from top to bottom.
    pub const ALL: [Self; 4] = [Self::Select, Self::Fix, Self::Constrain, Self::Seam];

    /// Its name in files, its entry in menus, and what it does.
    pub(in crate::ui) const fn words(self) -> [&'static str; 3] {
        match self {
            Self::Select => ["select", "Select vertices", "Select vertices"],
            Self::Fix => ["fix", "Fix vertices", "Fix: pin a vertex where it lies"],
            Self::Constrain => ["constrain", "Constrain vertices", "Constrain: join a vertex with its place"],
            Self::Seam => ["seam", "Draw seams", "Seam: cut the mesh along paths from vertex to vertex"],
        }
    }
}

/// How faces are coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Clay.
    Plain,
    /// A checker over the plane, carried to the mesh.
    #[default]
    Checker,
    /// The picture, carried to the mesh; the checker where there is none.
    Picture,
    /// Angle distortion.
    Angle,
    /// Area distortion.
    Area,
    /// Stretch.
    Stretch,
    /// Distance moved since another step.
    Move,
    /// Of the embedding alone: a thin fill that the picture behind it shows through.
    SeeThrough,
}

impl Shading {
    /// All shadings, in the order of menus.
    pub const ALL: [Self; 8] = [
        Self::Plain,
        Self::Checker,
        Self::Picture,
        Self::Angle,
        Self::Area,
        Self::Stretch,
        Self::Move,
        Self::SeeThrough,
    ];

    /// Whether a pane can be shaded so.
    pub fn is_for(self, pane: Pane) -> bool {
        self != Self::SeeThrough || pane == Pane::Plane
    }

    /// The shading of that name, where there is one.
    pub(super) fn called(name: Option<&str>) -> Option<Self> {
        Self::ALL.into_iter().find(|shading| Some(shading.title()) == name)
    }

    /// Whether faces are coloured by a number each.
    pub(in crate::ui) const fn is_by_number(self) -> bool {
        matches!(self, Self::Angle | Self::Area | Self::Stretch | Self::Move)
    }

    /// Its name in menus.
    pub const fn title(self) -> &'static str {
        self.words()[0]
    }

    /// The same, and what it shows.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Plain => ["Plain", "no colours but those of defects"],
            Self::Checker => {
                ["Checker", "squares of the plane, carried to the mesh: they show angles and sizes at a glance"]
            }
            Self::Picture => ["Picture", "the picture, carried to the mesh; a checker where there is none"],
            Self::Angle => ["Angle distortion", "ratio of the singular values σ₁/σ₂ per face: 1 keeps angles"],
            Self::Area => [
                "Area distortion",
                "area in the plane over area on the mesh per face, at equal total areas: 1 keeps areas",
            ],
            Self::Stretch => ["Stretch", "root mean square stretch from the plane to the mesh per face (L²)"],
            Self::Move => ["Move", "how far faces have moved since the compared step, or else since the one before"],
            Self::SeeThrough => ["See-through", "a fill of 30 %: the picture behind the embedding shows through"],
        }
    }
}

/// One of the two panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The mesh in space.
    Mesh,
    /// Its embedding.
    Plane,
}

impl Pane {
    /// From left to right.
    pub(in crate::ui) const BOTH: [Self; 2] = [Self::Mesh, Self::Plane];

    /// What it shows.
    pub(in crate::ui) const fn title(self) -> &'static str {
        match self {
            Self::Mesh => "Mesh",
            Self::Plane => "Embedding",
        }
    }
}

/// A panel at the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// Method and weights.
    #[default]
    Method,
    /// The pins.
    Pins,
    /// What is wrong with the embedding.
    Defects,
    /// The selected vertex.
    Vertex,
    /// The charts of a mesh that has several.
    Charts,
}

impl Tab {
    /// All tabs, from left to right.
    pub const ALL: [Self; 5] = [Self::Method, Self::Pins, Self::Defects, Self::Vertex, Self::Charts];

    /// Its name.
    pub const fn title(self) -> &'static str {
        ["Method", "Pins", "Defects", "Vertex", "Charts"][self as usize]
    }
}

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
    SetShading(Shading),
    /// Colours faces in one pane.
    SetPaneShading(Pane, Shading),
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
    SetStage(Stage),
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
    SetHold(Hold),
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
    Ask(Purpose),
    /// Saves the project where it was saved before, or asks where.
    SaveProject,
    /// Shows or hides what can be exported.
    ToggleExports,
    /// Answers the question about unsaved work.
    Answer(Answer),
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
    SetFit(OutputFit),
    /// Ends the program.
    Quit,
}

impl From<Action> for Request {
    fn from(action: Action) -> Self {
        Self::Do(action)
    }
}
