//! The repairs by name, and which of them may be done.

use std::fmt;
use std::str::FromStr;

use crate::mesh::Fault;

/// What may be done to a mesh so that it flattens: a set of repairs, and within which distance vertices are welded.
///
/// As text it is `none`, `safe` or `all`, or names of repairs, with commas between; `safe,turn-faces` is more than `safe` by
/// one. The distance is no part of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "String", into = "String"))]
pub struct Repairs {
    /// A bit for each kind.
    kinds: u16,
    weld: Option<WeldDistance>,
}

impl Repairs {
    /// Nothing: a mesh with any fault is refused.
    pub const NONE: Self = Self::of(&[]);
    /// What changes no visible surface.
    pub const SAFE: Self =
        Self::of(&[Repair::DropRepeatedCorners, Repair::DropDuplicateFaces, Repair::SplitVertices, Repair::FillHoles]);
    /// All that can be done, cutting aside.
    pub const ALL: Self = Self::of(&Repair::CHOSEN);

    /// These repairs.
    pub const fn of(repairs: &[Repair]) -> Self {
        let mut found = Self { kinds: 0, weld: None };
        let mut at = 0;
        while at < repairs.len() {
            found.kinds |= repairs[at].bit();
            at += 1;
        }
        found
    }

    /// One repair more.
    #[must_use]
    pub const fn with(self, repair: Repair) -> Self {
        Self { kinds: self.kinds | repair.bit(), ..self }
    }

    /// The repairs of both, vertices welded within the distance of these.
    #[must_use]
    pub const fn and(self, others: Self) -> Self {
        Self { kinds: self.kinds | others.kinds, ..self }
    }

    /// The same, vertices welded within a distance, whatever parts they are of; or not.
    #[must_use]
    pub const fn welding(self, within: Option<WeldDistance>) -> Self {
        Self { weld: within, ..self }
    }

    /// Whether a repair may be done.
    pub const fn allows(self, repair: Repair) -> bool {
        self.kinds & repair.bit() != 0
    }

    /// Whether no repair may be done: nothing, or nothing but welding within a distance.
    pub const fn is_none(self) -> bool {
        self.kinds == 0
    }

    /// Within which distance vertices are welded, where they are.
    pub const fn weld_distance(self) -> Option<WeldDistance> {
        self.weld
    }
}

impl Default for Repairs {
    fn default() -> Self {
        Self::SAFE
    }
}

/// The sets that have a name.
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
                format!("there is no repair \"{name}\": name some of {}", names.collect::<Vec<_>>().join(", "))
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

/// One kind of repair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Repair {
    /// Corners that name a vertex again leave their face; what has fewer than three left goes.
    DropRepeatedCorners,
    /// Faces with the vertices of an earlier one go.
    DropDuplicateFaces,
    /// Vertices of different parts that lie in one place become one; or all that lie within a distance.
    WeldVertices,
    /// Faces at edges of three or more get edges of their own.
    SplitEdges,
    /// The fewer faces of a part are turned over, so that all run around alike.
    TurnFaces,
    /// Fans of faces that meet in nothing but a vertex get one each.
    SplitVertices,
    /// Inner boundary loops are filled with virtual faces, which are of no file.
    FillHoles,
    /// The surface is cut along seams that were given.
    CutSeams,
    /// The surface is cut along edges until each part is a disk.
    Cut,
    /// Parts that are not wanted are not flattened.
    LeaveOutParts,
}

impl Repair {
    /// Those that can be chosen one by one; cutting is chosen by itself.
    pub const CHOSEN: [Self; 7] = [
        Self::DropRepeatedCorners,
        Self::DropDuplicateFaces,
        Self::WeldVertices,
        Self::SplitEdges,
        Self::TurnFaces,
        Self::SplitVertices,
        Self::FillHoles,
    ];

    /// Its place in a set.
    const fn bit(self) -> u16 {
        1 << self as u16
    }

    /// A fixed lower-case name, as reports have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DropRepeatedCorners => "drop-repeated-corners",
            Self::DropDuplicateFaces => "drop-duplicate-faces",
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

    /// What a person is offered, and what comes of it.
    pub const fn offer(self) -> [&'static str; 2] {
        match self {
            Self::DropRepeatedCorners => [
                "Leave out corners",
                "Corners that repeat a vertex leave their face; a face with fewer than three left goes",
            ],
            Self::DropDuplicateFaces => ["Leave out duplicates", "Of faces with the same vertices the first stays"],
            Self::WeldVertices => ["Weld", "Vertices of different parts that lie in one place become one"],
            Self::SplitEdges => {
                ["Split edges", "Faces at edges of three or more get edges of their own: sheets come apart there"]
            }
            Self::TurnFaces => {
                ["Turn faces over", "The fewer faces of each part turn over, so that all run around alike"]
            }
            Self::SplitVertices => ["Split vertices", "Fans of faces that meet in nothing but a vertex get one each"],
            Self::FillHoles => {
                ["Fill holes", "Holes are filled while the mesh is flattened, with faces that no file gets"]
            }
            Self::LeaveOutParts => ["Leave out parts", "Parts that are not wanted stay in the file as they are"],
            Self::CutSeams => ["Cut along seams", "The surface is cut along the seams that were drawn"],
            Self::Cut => {
                ["Cut open", "Parts that are no disks are cut along short ways, creases first, until they are"]
            }
        }
    }

    /// What was done, for one element and for several.
    const fn words(self) -> [&'static str; 2] {
        match self {
            Self::DropRepeatedCorners => [
                "face that names a vertex twice mended, or left out",
                "faces that name a vertex twice mended, or left out",
            ],
            Self::DropDuplicateFaces => ["duplicate face left out", "duplicate faces left out"],
            Self::WeldVertices => ["vertex joined with another", "vertices joined with others"],
            Self::SplitEdges => ["edge of three faces or more split", "edges of three faces or more split"],
            Self::TurnFaces => ["face turned over", "faces turned over"],
            Self::SplitVertices => {
                ["vertex split, one for each fan of faces", "vertices split, one for each fan of faces"]
            }
            Self::FillHoles => ["hole filled while it is flattened", "holes filled while it is flattened"],
            Self::CutSeams => ["edge cut along a seam", "edges cut along seams"],
            Self::Cut => ["edge cut open", "edges cut open"],
            Self::LeaveOutParts => ["part left out", "parts left out"],
        }
    }
}

/// A repair, and how many elements it was done to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Done {
    /// What was done.
    pub repair: Repair,
    /// How often.
    pub count: usize,
}

impl fmt::Display for Done {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, many] = self.repair.words();
        write!(f, "{} {}", self.count, if self.count == 1 { one } else { many })
    }
}

impl Fault {
    /// Repairs that mend the fault, each by itself. Empty if none does.
    pub const fn repairs(&self) -> &'static [Repair] {
        match self {
            Self::RepeatedVertices(_) => &[Repair::DropRepeatedCorners],
            Self::DuplicateFaces(_) => &[Repair::DropDuplicateFaces],
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

/// The greatest distance of vertices that become one, in the mesh's units: finite, and 0 or more.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "f64", into = "f64"))]
pub struct WeldDistance(f64);

impl WeldDistance {
    /// A distance; none where the number is none.
    pub fn new(distance: f64) -> Option<Self> {
        (distance.is_finite() && distance >= 0.0).then_some(Self(distance.abs()))
    }

    /// The distance, in the mesh's units.
    pub const fn get(self) -> f64 {
        self.0
    }
}

// It is never NaN.
impl Eq for WeldDistance {}

impl TryFrom<f64> for WeldDistance {
    type Error = &'static str;

    fn try_from(distance: f64) -> Result<Self, Self::Error> {
        Self::new(distance).ok_or("a distance is finite, and 0 or more")
    }
}

impl From<WeldDistance> for f64 {
    fn from(distance: WeldDistance) -> Self {
        distance.0
    }
}
