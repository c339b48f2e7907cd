//! Findings about a layout: a code, a severity, and the faces concerned.

use std::fmt::{self, Display};
use std::str::FromStr;

use crate::mesh::FaceId;

/// Largest number of faces or pairs that a finding lists.
pub const FINDINGS_LISTED: usize = 1000;

/// Importance of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum FindingSeverity {
    /// The layout is not usable as it is.
    Error,
    /// The layout may be meant so.
    Warning,
    /// A fact worth knowing.
    Note,
}

/// Kind of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum FindingCode {
    /// Faces with a coordinate that is infinite or not a number.
    NotFinite,
    /// Faces turned over against the majority of their chart.
    Flipped,
    /// Faces with area in space that lie on a line of the layout.
    Degenerate,
    /// Polygons that another cut into triangles would fold.
    ConcavePolygon,
    /// Faces of one chart that overlap.
    Overlap,
    /// Faces of different charts that overlap.
    OverlapOfCharts,
    /// Faces of different charts that overlap, one of them a mirror image.
    OverlapMirrored,
    /// Faces or charts that share exactly one place.
    Stacked,
    /// Faces without coordinates.
    NoCoordinates,
    /// Faces whose corners lie at one or two points.
    NoPlace,
    /// Faces with the corners of an earlier face, in space and in the layout.
    Duplicate,
    /// Charts beyond the unit square that fill no single tile.
    Outside,
    /// Faces with a corner far away from the unit square.
    FarAway,
    /// Charts whose scale differs from the usual one.
    Scale,
    /// Charts nearer to each other than the gap.
    Gap,
    /// Charts that are mirror images.
    Mirrored,
    /// Faces that run against the first face of their chart on the surface.
    Turned,
    /// Charts in other tiles than the unit square.
    Tiles,
}

impl FindingCode {
    /// All codes.
    pub const ALL: [Self; 18] = [
        Self::NotFinite,
        Self::Flipped,
        Self::Degenerate,
        Self::ConcavePolygon,
        Self::Overlap,
        Self::OverlapOfCharts,
        Self::OverlapMirrored,
        Self::Stacked,
        Self::NoCoordinates,
        Self::NoPlace,
        Self::Duplicate,
        Self::Outside,
        Self::FarAway,
        Self::Scale,
        Self::Gap,
        Self::Mirrored,
        Self::Turned,
        Self::Tiles,
    ];

    /// Severity of the finding, unless the user sets another one or much of the surface has no place.
    pub const fn severity(self) -> FindingSeverity {
        match self {
            Self::NotFinite
            | Self::Flipped
            | Self::Degenerate
            | Self::ConcavePolygon
            | Self::Overlap
            | Self::OverlapOfCharts
            | Self::OverlapMirrored
            | Self::Stacked => FindingSeverity::Error,
            Self::NoCoordinates
            | Self::NoPlace
            | Self::Duplicate
            | Self::Outside
            | Self::FarAway
            | Self::Scale
            | Self::Gap => FindingSeverity::Warning,
            Self::Mirrored | Self::Turned | Self::Tiles => FindingSeverity::Note,
        }
    }

    /// Fixed lower-case name.
    pub const fn name(self) -> &'static str {
        self.texts()[0]
    }

    /// Name, and description after a count, for one element and for several.
    const fn texts(self) -> [&'static str; 3] {
        match self {
            Self::NotFinite => {
                ["not-finite", "face has coordinates that are no numbers", "faces have coordinates that are no numbers"]
            }
            Self::Flipped => ["flipped", "flipped face", "flipped faces"],
            Self::Degenerate => ["degenerate", "face lies on a line", "faces lie on a line"],
            Self::ConcavePolygon => ["concave-polygon", "concave polygon", "concave polygons"],
            Self::Overlap => ["overlap", "pair of faces of one chart overlaps", "pairs of faces of one chart overlap"],
            Self::OverlapOfCharts => [
                "overlap-of-charts",
                "pair of faces of different charts overlaps",
                "pairs of faces of different charts overlap",
            ],
            Self::OverlapMirrored => [
                "overlap-mirrored",
                "pair of faces of charts that mirror each other overlaps",
                "pairs of faces of charts that mirror each other overlap",
            ],
            Self::Stacked => ["stacked", "face lies on another face or chart", "faces lie on other faces or charts"],
            Self::NoCoordinates => ["no-coordinates", "face has no coordinates", "faces have no coordinates"],
            Self::NoPlace => ["no-place", "face has no place", "faces have no place"],
            Self::Duplicate => ["duplicate", "face repeats an earlier face", "faces repeat earlier faces"],
            Self::Outside => {
                ["outside", "chart lies across the unit square's border", "charts lie across the unit square's border"]
            }
            Self::FarAway => {
                ["far-away", "face reaches far away from the unit square", "faces reach far away from the unit square"]
            }
            Self::Scale => ["scale", "chart differs in scale", "charts differ in scale"],
            Self::Gap => ["gap", "pair of charts lies too close", "pairs of charts lie too close"],
            Self::Mirrored => ["mirrored", "chart is a mirror image", "charts are mirror images"],
            Self::Turned => ["turned", "face is turned over on the surface", "faces are turned over on the surface"],
            Self::Tiles => ["tiles", "chart lies in another tile", "charts lie in other tiles"],
        }
    }
}

impl FromStr for FindingCode {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|code| code.name() == text).ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.into_iter().map(Self::name).collect();
            format!("unknown code \"{text}\": choose from {}", names.join(", "))
        })
    }
}

/// Finding about a layout.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Finding {
    /// Kind of the finding.
    pub code: FindingCode,
    /// Importance of the finding.
    pub severity: FindingSeverity,
    /// Number of faces, charts or pairs.
    pub count: usize,
    /// True if there are more pairs than counted.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "std::ops::Not::not"))]
    pub more: bool,
    /// Faces, or the first faces of charts, ascending. At most [`FINDINGS_LISTED`] unless more are asked for.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub faces: Vec<FaceId>,
    /// Pairs of faces, or of the first faces of charts, ascending. At most [`FINDINGS_LISTED`] unless more are asked for.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub pairs: Vec<[FaceId; 2]>,
}

impl Finding {
    /// Finding about faces, or about charts by their first faces.
    pub fn of_faces(code: FindingCode, faces: Vec<FaceId>) -> Self {
        Self { code, severity: code.severity(), count: faces.len(), more: false, faces, pairs: Vec::new() }
    }

    /// Count and description, without elements.
    pub fn headline(&self) -> String {
        let [_, one, many] = self.code.texts();
        let more = if self.more { "more than " } else { "" };
        let words = if self.count == 1 && !self.more { one } else { many };
        format!("{more}{} {words}", self.count)
    }

    /// Raises the severity.
    pub(super) fn into_error(self) -> Self {
        Self { severity: FindingSeverity::Error, ..self }
    }

    /// Finding about pairs, of which at most `most` were asked for.
    pub(super) fn of_pairs(code: FindingCode, mut pairs: Vec<[FaceId; 2]>, most: usize) -> Self {
        let more = pairs.len() > most;
        pairs.truncate(most);
        Self { code, severity: code.severity(), count: pairs.len(), more, faces: Vec::new(), pairs }
    }
}

impl Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.headline())?;
        let of_pair = |[a, b]: &[FaceId; 2]| format!("{} and {}", a.number(), b.number());
        let first = self.faces.first().map(|face| face.number().to_string());
        let first = first.or_else(|| self.pairs.first().map(of_pair));
        match first {
            Some(first) if self.count == 1 => write!(f, " ({first})"),
            Some(first) => write!(f, " (first: {first})"),
            None => Ok(()),
        }
    }
}
