//! Names of the repairs, and sets of allowed repairs.

use std::fmt;
use std::str::FromStr;

use crate::mesh::Fault;

/// Allowed repairs of a mesh: a set of repairs, and the distance within which vertices are welded.
///
/// The text form is `none`, `safe` or `all`, or names of repairs separated by commas: `safe,turn-faces` adds one
/// repair to `safe`. The text does not contain the distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "String", into = "String"))]
pub struct Repairs {
    /// Bit set of repairs.
    kinds: u16,
    weld: Option<WeldDistance>,
}

impl Repairs {
    /// No repairs: a mesh with any fault is refused.
    pub const NONE: Self = Self::of(&[]);
    /// Repairs that do not change the visible surface.
    pub const SAFE: Self =
        Self::of(&[Repair::DropRepeatedCorners, Repair::StackDuplicates, Repair::SplitVertices, Repair::FillHoles]);
    /// All repairs except cutting. Duplicate faces share one place.
    pub const ALL: Self = Self::SAFE.and(Self::of(&[Repair::WeldVertices, Repair::SplitEdges, Repair::TurnFaces]));

    /// Set of the given repairs.
    pub const fn of(repairs: &[Repair]) -> Self {
        let mut found = Self { kinds: 0, weld: None };
        let mut at = 0;
        while at < repairs.len() {
            found.kinds |= repairs[at].bit();
            at += 1;
        }
        found
    }

    /// Adds a repair.
    #[must_use]
    pub const fn with(self, repair: Repair) -> Self {
        Self { kinds: self.kinds | repair.bit(), ..self }
    }

    /// Union of two sets. Keeps the weld distance of `self`.
    #[must_use]
    pub const fn and(self, others: Self) -> Self {
        Self { kinds: self.kinds | others.kinds, ..self }
    }

    /// Sets the distance within which vertices are welded, of all parts; `None` disables welding by distance.
    #[must_use]
    pub const fn welding(self, within: Option<WeldDistance>) -> Self {
        Self { weld: within, ..self }
    }

    /// True if a repair is allowed.
    pub const fn allows(self, repair: Repair) -> bool {
        self.kinds & repair.bit() != 0
    }

    /// True if no repair of the set is allowed; welding within a distance does not count.
    pub const fn is_none(self) -> bool {
        self.kinds == 0
    }

    /// Distance within which vertices are welded, if any.
    pub const fn weld_distance(self) -> Option<WeldDistance> {
        self.weld
    }
}

impl Default for Repairs {
    fn default() -> Self {
        Self::SAFE
    }
}

/// Sets with a name.
const NAMED: [(&str, Repairs); 3] = [("none", Repairs::NONE), ("safe", Repairs::SAFE), ("all", Repairs::ALL)];

impl fmt::Display for Repairs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, _)) = NAMED.iter().find(|(_, named)| named.kinds == self.kinds) {
            return f.write_str(name);
        }
        let is_safe = self.and(Repairs::SAFE) == *self;
        let others = Repair::CHOSEN.into_iter().filter(|&repair| self.allows(repair));
        let others = others.filter(|&repair| !(is_safe && Repairs::SAFE.allows(repair))).map(Repair::name);
        let names: Vec<&str> = is_safe.then_some("safe").into_iter().chain(others).collect();
        f.write_str(&names.join(","))
    }
}

impl FromStr for Repairs {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split(',').map(str::trim).try_fold(Self::NONE, |found, name| {
            let set = NAMED.iter().find(|(other, _)| *other == name).map(|(_, repairs)| *repairs);
            let single =
                || Repair::CHOSEN.into_iter().find(|repair| repair.name() == name).map(|repair| Self::of(&[repair]));
            let repairs = set.or_else(single).ok_or_else(|| {
                let names = NAMED.map(|(name, _)| name).into_iter().chain(Repair::CHOSEN.map(Repair::name));
                format!("unknown repair \"{name}\": choose from {}", names.collect::<Vec<_>>().join(", "))
            })?;
            Ok(found.and(repairs))
        })
    }
}

impl TryFrom<String> for Repairs {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Repairs> for String {
    fn from(repairs: Repairs) -> Self {
        repairs.to_string()
    }
}

/// Kind of repair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Repair {
    /// Remove corners that repeat the vertex before them or run back along a side, and faces left with fewer than three
    /// corners. No area is lost.
    DropRepeatedCorners,
    /// Give faces with the vertices of an earlier face the place of that face in the map.
    StackDuplicates,
    /// Give faces with the vertices of an earlier face vertices of their own, so that they become charts. Takes
    /// precedence over [`StackDuplicates`](Self::StackDuplicates).
    SeparateDuplicates,
    /// Join vertices of different parts that coincide, or all vertices within a distance.
    WeldVertices,
    /// Give faces at edges with three or more faces separate edges.
    SplitEdges,
    /// Flip the smaller set of faces of each part, so that all have a consistent orientation.
    TurnFaces,
    /// Give each fan of faces that meet only at a vertex its own vertex.
    SplitVertices,
    /// Fill inner boundary loops with virtual faces, which are never written to a file.
    FillHoles,
    /// Cut the surface along given seams.
    CutSeams,
    /// Cut the surface along edges until each part is a disk.
    Cut,
    /// Leave out unwanted parts: they are not flattened.
    LeaveOutParts,
}

impl Repair {
    /// Repairs that can be chosen one by one; cutting is a separate setting.
    pub const CHOSEN: [Self; 8] = [
        Self::DropRepeatedCorners,
        Self::StackDuplicates,
        Self::SeparateDuplicates,
        Self::WeldVertices,
        Self::SplitEdges,
        Self::TurnFaces,
        Self::SplitVertices,
        Self::FillHoles,
    ];

    /// Bit of the repair in a set.
    const fn bit(self) -> u16 {
        1 << self as u16
    }

    /// A fixed lower-case name, used in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DropRepeatedCorners => "drop-repeated-corners",
            Self::SeparateDuplicates => "separate-duplicates",
            Self::StackDuplicates => "stack-duplicates",
            Self::WeldVertices => "weld-vertices",
            Self::SplitEdges => "split-edges",
            Self::TurnFaces => "turn-faces",
            Self::SplitVertices => "split-vertices",
            Self::FillHoles => "fill-holes",
            Self::CutSeams => "cut-seams",
            Self::Cut => "cut",
            Self::LeaveOutParts => "leave-out-parts",
        }
    }

    /// Label of the button that offers the repair, and description of its effect.
    pub const fn offer(self) -> [&'static str; 2] {
        match self {
            Self::DropRepeatedCorners => {
                ["Leave out corners", "Removes corners that repeat a vertex, and faces left without area"]
            }
            Self::SeparateDuplicates => {
                ["Separate duplicates", "Gives faces with equal vertices places of their own in the map"]
            }
            Self::StackDuplicates => ["Stack duplicates", "Gives faces with equal vertices one place in the map"],
            Self::WeldVertices => ["Weld", "Joins vertices of different parts at one position"],
            Self::SplitEdges => {
                ["Split edges", "Gives each sheet its own edge if three or more faces share one: the sheets separate"]
            }
            Self::TurnFaces => {
                ["Turn faces over", "Turns over the minority of each part's faces, so that all have one orientation"]
            }
            Self::SplitVertices => {
                ["Split vertices", "Gives each fan of faces its own vertex if fans share only a vertex"]
            }
            Self::FillHoles => {
                ["Fill holes", "Fills holes during flattening; the extra faces are not written to files"]
            }
            Self::LeaveOutParts => ["Leave out parts", "Keeps unwanted parts unchanged in the file"],
            Self::CutSeams => ["Cut along seams", "Cuts the surface along the drawn seams"],
            Self::Cut => ["Cut open", "Cuts parts that are not disks along short paths, creases first"],
        }
    }

    /// Description of the completed repair, for one element and for several.
    const fn words(self) -> [&'static str; 2] {
        match self {
            Self::DropRepeatedCorners => [
                "face with a repeated vertex repaired or left out",
                "faces with a repeated vertex repaired or left out",
            ],
            Self::SeparateDuplicates => {
                ["duplicate face given its own vertices", "duplicate faces given their own vertices"]
            }
            Self::StackDuplicates => {
                ["duplicate face stacked on an earlier face", "duplicate faces stacked on earlier faces"]
            }
            Self::WeldVertices => ["vertex joined with another", "vertices joined with others"],
            Self::SplitEdges => ["edge of three or more faces split", "edges of three or more faces split"],
            Self::TurnFaces => ["face turned over", "faces turned over"],
            Self::SplitVertices => {
                ["vertex split into one per fan of faces", "vertices split into one per fan of faces"]
            }
            Self::FillHoles => ["hole filled during flattening", "holes filled during flattening"],
            Self::CutSeams => ["edge cut along a seam", "edges cut along seams"],
            Self::Cut => ["edge cut open", "edges cut open"],
            Self::LeaveOutParts => ["part left out", "parts left out"],
        }
    }
}

/// A completed repair, and the number of elements that it changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Done {
    /// Kind of repair.
    pub repair: Repair,
    /// Number of elements that were changed.
    pub count: usize,
}

impl fmt::Display for Done {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, many] = self.repair.words();
        write!(f, "{} {}", self.count, if self.count == 1 { one } else { many })
    }
}

impl Fault {
    /// Repairs that fix the fault, each by itself. Empty if none does.
    pub const fn repairs(&self) -> &'static [Repair] {
        match self {
            Self::RepeatedVertices(_) => &[Repair::DropRepeatedCorners],
            Self::DuplicateFaces(_) => &[Repair::StackDuplicates, Repair::SeparateDuplicates],
            Self::NonManifoldEdges(_) => &[Repair::SplitEdges],
            Self::NonManifoldVertices(_) => &[Repair::SplitVertices],
            Self::MixedOrientation { .. } => &[Repair::TurnFaces],
            Self::CoincidentVertices(_) => &[Repair::WeldVertices],
            Self::SeveralBoundaryLoops(_) => &[Repair::FillHoles, Repair::Cut],
            Self::NonOrientable(_) | Self::Closed { .. } | Self::Handles { .. } => &[Repair::Cut],
            Self::NoFaces
            | Self::MissingVertices(_)
            | Self::NotFinite(_)
            | Self::UnreferencedVertices(_)
            | Self::ZeroArea(_)
            | Self::SeveralComponents { .. } => &[],
        }
    }
}

/// Largest distance of vertices that are welded, in mesh units: finite, and 0 or more.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "f64", into = "f64"))]
pub struct WeldDistance(f64);

impl WeldDistance {
    /// Checks a distance; `None` if it is negative, infinite or not a number.
    pub fn new(distance: f64) -> Option<Self> {
        (distance.is_finite() && distance >= 0.0).then_some(Self(distance.abs()))
    }

    /// Distance in mesh units.
    pub const fn get(self) -> f64 {
        self.0
    }
}

// The distance is never NaN.
impl Eq for WeldDistance {}

impl TryFrom<f64> for WeldDistance {
    type Error = &'static str;

    fn try_from(distance: f64) -> Result<Self, Self::Error> {
        Self::new(distance).ok_or("the distance must be finite and at least 0")
    }
}

impl From<WeldDistance> for f64 {
    fn from(distance: WeldDistance) -> Self {
        distance.0
    }
}
