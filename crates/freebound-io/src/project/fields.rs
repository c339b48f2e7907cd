//! Form of sources, seams and pins in a project file.

use std::fmt;
use std::path::PathBuf;

use glam::DVec2;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{ProjectPins, ProjectSource};
use crate::{FileStamp, PinName, PinNote};
use freebound_core::mesh::{Seams, VertexId};
use freebound_core::pipeline::Target;
use freebound_core::problem::{Pin, PinKind};

/// Mesh or picture: an example or a file, possibly with its stamp.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct SourceFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    example: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bytes: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sha256: Option<String>,
}

impl TryFrom<SourceFields> for ProjectSource {
    type Error = &'static str;

    fn try_from(fields: SourceFields) -> Result<Self, Self::Error> {
        let stamp = fields.bytes.zip(fields.sha256).map(|(bytes, sha256)| FileStamp { bytes, sha256 });
        match (fields.example, fields.file) {
            (Some(name), None) => Ok(Self::Example(name)),
            (None, Some(path)) => Ok(Self::File { path, stamp }),
            _ => Err("name either a \"file\" or an \"example\""),
        }
    }
}

impl From<ProjectSource> for SourceFields {
    fn from(source: ProjectSource) -> Self {
        match source {
            ProjectSource::Example(name) => Self { example: Some(name), ..Self::default() },
            ProjectSource::File { path, stamp } => {
                let (bytes, sha256) = stamp.map(|stamp| (stamp.bytes, stamp.sha256)).unzip();
                Self { file: Some(path), bytes, sha256, ..Self::default() }
            }
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum HoldName {
    Fixed,
    Hard,
    Weighted,
}

#[derive(Serialize, Deserialize)]
struct PinFields {
    vertex: u32,
    u: f64,
    v: f64,
    hold: HoldName,
    #[serde(default, deserialize_with = "weight", skip_serializing_if = "Option::is_none")]
    weight: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<PinName>,
}

impl PinFields {
    fn of(vertex: VertexId, target: &Target, note: Option<&PinNote>) -> Self {
        let (hold, weight) = match target.kind {
            PinKind::Fixed => (HoldName::Fixed, None),
            PinKind::Hard => (HoldName::Hard, None),
            PinKind::Soft(weight) => (HoldName::Weighted, Some(weight)),
        };
        let PinNote { name } = note.cloned().unwrap_or_default();
        let (vertex, DVec2 { x: u, y: v }) = (vertex.number(), target.uv);
        Self { vertex, u, v, hold, weight, name }
    }

    fn target(&self) -> Target {
        let kind = match self.hold {
            HoldName::Fixed => PinKind::Fixed,
            HoldName::Hard => PinKind::Hard,
            HoldName::Weighted => PinKind::Soft(self.weight.unwrap_or(Pin::DEFAULT_WEIGHT)),
        };
        Target { uv: DVec2::new(self.u, self.v), kind }
    }

    fn note(self) -> PinNote {
        PinNote { name: self.name }
    }
}

#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct SeamFields {
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    of_texture: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    edges: Vec<EdgeText>,
    /// Automatic seams, and the bound on the energy for which they were found.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    automatic: Vec<EdgeText>,
    #[serde(skip_serializing_if = "Option::is_none")]
    distortion: Option<f64>,
    /// Costs of edges for automatic seams.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    costs: Vec<CostFields>,
}

/// Cost of an edge for automatic seams, relative to its length.
#[derive(Serialize, Deserialize)]
struct CostFields {
    edge: EdgeText,
    cost: f64,
}

/// Edge as the numbers of its two vertices in one string, so that each edge takes one line.
#[derive(Clone, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
struct EdgeText([VertexId; 2]);

impl TryFrom<String> for EdgeText {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let ends = text.split_once(' ').and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
        match ends {
            Some([a, b]) if a != b => Ok(Self([a, b].map(VertexId::new))),
            _ => Err(format!("\"{text}\" is not an edge: write the numbers of two vertices, for example \"3 17\"")),
        }
    }
}

impl From<EdgeText> for String {
    fn from(EdgeText([a, b]): EdgeText) -> Self {
        format!("{} {}", a.number(), b.number())
    }
}

/// Seams: a flag for the seams of the texture coordinates, and a list of edges.
pub(super) mod seam_list {
    use super::{
        CostFields, Deserialize, Deserializer, EdgeText, Error as _, SeamFields, Seams, Serialize as _, Serializer,
    };

    pub(in super::super) fn serialize<S: Serializer>(seams: &Seams, serializer: S) -> Result<S::Ok, S::Error> {
        let edges = seams.edges().iter().copied().map(EdgeText).collect();
        let automatic = seams.automatic().iter().copied().map(EdgeText).collect();
        let costs = seams.costs().iter().map(|(&edge, &cost)| CostFields { edge: EdgeText(edge), cost }).collect();
        let (of_texture, distortion) = (seams.of_texture, seams.bound());
        SeamFields { of_texture, edges, automatic, distortion, costs }.serialize(serializer)
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Seams, D::Error> {
        let SeamFields { of_texture, edges, automatic, distortion, costs } = SeamFields::deserialize(deserializer)?;
        let ends = |list: Vec<EdgeText>| list.into_iter().map(|EdgeText(ends)| ends);
        let mut seams = Seams::default().with(ends(edges));
        if let Some(bound) = distortion {
            seams = seams.with_automatic(ends(automatic), bound);
        }
        if let Some(wrong) = costs.iter().find(|of| !Seams::COSTS.contains(&of.cost)) {
            return Err(D::Error::custom(format!("the cost {} of an edge is not within 0.001 to 1000000", wrong.cost)));
        }
        seams = seams.with_costs(costs.into_iter().map(|CostFields { edge: EdgeText(ends), cost }| (ends, cost)));
        seams.of_texture = of_texture;
        Ok(seams)
    }
}

/// Pins as a list.
impl Serialize for ProjectPins {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let pins = self.targets.iter();
        serializer.collect_seq(pins.map(|(&vertex, target)| PinFields::of(vertex, target, self.notes.get(&vertex))))
    }
}

impl<'de> Deserialize<'de> for ProjectPins {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut pins = Self::default();
        for fields in Vec::<PinFields>::deserialize(deserializer)? {
            let vertex = VertexId::new(fields.vertex);
            if pins.targets.insert(vertex, fields.target()).is_some() {
                return Err(D::Error::custom(format!("vertex {vertex} is pinned twice")));
            }
            let note = fields.note();
            if !note.is_empty() {
                pins.notes.insert(vertex, note);
            }
        }
        Ok(pins)
    }
}

/// Reads a weight. Validating it during parsing lets an error name the line of its field.
fn weight<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    deserializer.deserialize_any(WeightVisitor)
}

struct WeightVisitor;

impl Visitor<'_> for WeightVisitor {
    type Value = Option<f64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a weight")
    }

    fn visit_unit<E: Error>(self) -> Result<Option<f64>, E> {
        Ok(None)
    }

    fn visit_f64<E: Error>(self, weight: f64) -> Result<Option<f64>, E> {
        let is_weight = PinKind::Soft(weight).invalid_weight().is_none();
        if is_weight { Ok(Some(weight)) } else { Err(E::custom(format!("the weight {weight} is not positive"))) }
    }

    fn visit_u64<E: Error>(self, weight: u64) -> Result<Option<f64>, E> {
        self.visit_f64(weight as f64)
    }

    fn visit_i64<E: Error>(self, weight: i64) -> Result<Option<f64>, E> {
        self.visit_f64(weight as f64)
    }
}
