//! Options of a run. The package passes them as one JSON object, and lists of numbers as arrays.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::num::NonZeroUsize;
use std::str::FromStr;

use freebound_core::cutting::SeamOptions;
use freebound_core::geom::{PackingOptions, PictureFrame, Rotations, Stacking};
use freebound_core::mesh::{HoleTreatment, Preparation, Repairs, Seams, VertexId, WeldDistance};
use freebound_core::pipeline::{Arrangement, Fit, PipelineOptions, Target, Targets};
use freebound_core::problem::{
    BoundaryShape, Family, Growth, Method, NamedOption, PinKind, Settings, Spacing, Start, Treatment,
};
use freebound_io::Precision;
use freebound_run::{AutomaticCut, MethodOption, PartChoice, Run, RunRequest, SeamKind, picture_of_aspect};
use glam::DVec2;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::errors;

/// Options by name. All names are those of the command line, with underscores.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Options {
    unwrap: bool,
    method: Option<String>,
    boundary: Option<String>,
    family: Option<String>,
    spacing: Option<String>,
    layers: Option<usize>,
    treatment: Option<String>,
    max_steps: Option<usize>,
    relax: Option<usize>,
    new_vertices: Option<bool>,
    growth: Option<String>,
    start: bool,
    aspect: Option<f64>,
    repair: Option<String>,
    weld: Option<f64>,
    holes: Option<String>,
    cut: Option<String>,
    charts: Option<String>,
    distortion: Option<f64>,
    max_charts: Option<usize>,
    seam_visibility: Option<f64>,
    seam_kinds: Vec<String>,
    parts: Option<String>,
    fit: Option<String>,
    pack: Option<Pack>,
    chart_size: BTreeMap<usize, f64>,
    lock: Lock,
    precision: Option<String>,
    pub(crate) threads: Option<NonZeroUsize>,
}

/// Charts that are locked.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "pass numbers of charts, or True for all")]
enum Lock {
    All(bool),
    Charts(Vec<usize>),
}

impl Default for Lock {
    fn default() -> Self {
        Self::Charts(Vec::new())
    }
}

impl Lock {
    fn is_empty(&self) -> bool {
        match self {
            Self::All(all) => !all,
            Self::Charts(charts) => charts.is_empty(),
        }
    }

    fn numbers(&self) -> BTreeSet<usize> {
        match self {
            Self::All(_) => BTreeSet::new(),
            Self::Charts(charts) => charts.iter().copied().collect(),
        }
    }
}

/// Options of packing.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Pack {
    size: Option<[u32; 2]>,
    gap: Option<u32>,
    rotations: Option<String>,
    density: Option<f64>,
    tiles: Option<u32>,
    stack: Option<String>,
}

/// Lists of numbers that belong to the options.
#[derive(FromPyObject)]
pub(crate) struct Lists<'py> {
    /// Pinned vertices: rows of vertex, u, v, weight. A weight of NaN makes the pin hard.
    #[pyo3(item)]
    pins: Option<PyReadonlyArray2<'py, f64>>,
    /// Pinned corners, with rows like those of pinned vertices.
    #[pyo3(item)]
    corner_pins: Option<PyReadonlyArray2<'py, f64>>,
    /// Seams by the two vertices of their edges.
    #[pyo3(item)]
    seams: Option<PyReadonlyArray2<'py, f64>>,
    /// Costs of edges: rows of two vertices and the cost.
    #[pyo3(item)]
    costs: Option<PyReadonlyArray2<'py, f64>>,
}

/// Wrong option: the name of the option, and the reason.
struct Wrong(String);

impl Wrong {
    fn new(option: &str, why: impl Display) -> Self {
        Self(format!("{option}: {why}"))
    }
}

fn named<T: NamedOption>(option: &str, text: Option<&String>) -> Result<Option<T>, Wrong> {
    let Some(text) = text else { return Ok(None) };
    let wrong = || Wrong::new(option, format!("\"{text}\" is unknown: choose one of {}", T::names()));
    T::named(text).map(Some).ok_or_else(wrong)
}

fn parsed<T: FromStr<Err: Display>>(option: &str, text: Option<&String>) -> Result<Option<T>, Wrong> {
    text.map(|text| text.parse().map_err(|why| Wrong::new(option, why))).transpose()
}

impl Options {
    /// Request of these options.
    pub(crate) fn request(&self, py: Python<'_>, lists: &Lists<'_>) -> PyResult<RunRequest> {
        self.made(lists).map_err(|Wrong(why)| errors::option_error(py, why))
    }

    /// Packing and precision of these options.
    pub(crate) fn packing_and_precision(&self, py: Python<'_>) -> PyResult<(PackingOptions, Option<Precision>)> {
        let both = || Ok((self.packing()?, named::<Precision>("precision", self.precision.as_ref())?));
        both().map_err(|Wrong(why)| errors::option_error(py, why))
    }

    fn made(&self, lists: &Lists<'_>) -> Result<RunRequest, Wrong> {
        let usual = if self.unwrap { RunRequest::unwrap() } else { RunRequest::default() };
        let automatic_cut = self.automatic_cut(&usual)?;
        let settings = self.settings(lists)?;
        let aspect = self.aspect;
        if aspect.is_some_and(|aspect| !(aspect.is_normal() && aspect > 0.0)) {
            return Err(Wrong::new("aspect", "pass width over height, above 0"));
        }
        let fit: Option<Fit> = named("fit", self.fit.as_ref())?;
        if self.start && fit == Some(Fit::Unit) {
            return Err(Wrong::new("fit", "a layout to start from keeps its position: remove fit=\"unit\""));
        }
        if !self.start && !self.lock.is_empty() {
            return Err(Wrong::new("lock", "charts are locked at a layout to start from: pass one"));
        }
        let options = PipelineOptions {
            settings,
            frame: PictureFrame { aspect: aspect.unwrap_or(1.0), ..PictureFrame::default() },
            has_picture: aspect.is_some(),
            targets: targets(lists)?,
            packing: self.packing()?,
            arrangement: self.arrangement(fit),
            ..PipelineOptions::default()
        };
        let sizes = PackingOptions::SIZES;
        if let Some(size) = self.chart_size.values().find(|size| !sizes.contains(size)) {
            let [low, high] = [sizes.start(), sizes.end()];
            return Err(Wrong::new("chart_size", format!("a size is from {low} to {high}, not {size}")));
        }
        Ok(RunRequest {
            preparation: self.preparation(&usual, lists)?,
            seam_kinds: self
                .seam_kinds
                .iter()
                .map(|kind| kind.parse())
                .collect::<Result<_, _>>()
                .map_err(|why: <SeamKind as FromStr>::Err| Wrong::new("seams", why))?,
            automatic_cut,
            parts: parsed::<PartChoice>("parts", self.parts.as_ref())?,
            run: Run { options, fit: fit.unwrap_or_default(), locked: self.lock.numbers(), keeps_materials: false },
            corner_pins: corner_pins(lists)?,
            chart_sizes: self.chart_size.clone(),
            locks_all_charts: matches!(self.lock, Lock::All(true)),
            usual_relax_rounds: usual.usual_relax_rounds,
            precision: named::<Precision>("precision", self.precision.as_ref())?,
        })
    }

    /// Search for automatic seams. `usual` has the search that is usual for the call.
    fn automatic_cut(&self, usual: &RunRequest) -> Result<Option<AutomaticCut>, Wrong> {
        let is_searched = match self.cut.as_deref() {
            None => usual.automatic_cut.is_some(),
            Some("auto") => true,
            Some("none" | "shortest") => false,
            Some(_) => return Err(Wrong::new("cut", "choose one of none, auto, shortest")),
        };
        let given = [
            ("distortion", self.distortion.is_some()),
            ("max_charts", self.max_charts.is_some()),
            ("seam_visibility", self.seam_visibility.is_some()),
        ];
        if !is_searched {
            return match given.iter().find(|(_, is_given)| *is_given) {
                Some((option, _)) => Err(Wrong::new(option, "it needs automatic seams: pass cut=\"auto\"")),
                None => Ok(None),
            };
        }
        if self.distortion.is_some_and(|bound| !(bound.is_finite() && bound > SeamOptions::ISOMETRIC)) {
            return Err(Wrong::new("distortion", "pass an energy above 4, which is an isometric map"));
        }
        if self.seam_visibility.is_some_and(|weight| !(0.0..=1.0).contains(&weight)) {
            return Err(Wrong::new("seam_visibility", "pass a number from 0 to 1"));
        }
        if self.max_charts == Some(0) {
            return Err(Wrong::new("max_charts", "pass a number of 1 or more"));
        }
        let usual = usual.automatic_cut.and_then(|cut| cut.distortion);
        Ok(Some(AutomaticCut {
            distortion: self.distortion.or(usual),
            most_charts: self.max_charts,
            visibility: self.seam_visibility,
        }))
    }

    fn preparation(&self, usual: &RunRequest, lists: &Lists<'_>) -> Result<Preparation, Wrong> {
        let repairs = parsed::<Repairs>("repair", self.repair.as_ref())?.unwrap_or(usual.preparation.repair);
        let weld = match self.weld {
            Some(distance) => {
                Some(WeldDistance::new(distance).ok_or_else(|| Wrong::new("weld", "pass a distance of 0 or more"))?)
            }
            None => None,
        };
        let holes = match self.holes.as_deref() {
            None | Some("fill") => HoleTreatment::Fill,
            Some("cut") => HoleTreatment::Cut,
            Some(_) => return Err(Wrong::new("holes", "choose one of fill, cut")),
        };
        let mut seams = Seams::default();
        seams.of_texture = match self.charts.as_deref() {
            None | Some("parts") => false,
            Some("uv") => true,
            Some(_) => return Err(Wrong::new("charts", "choose one of parts, uv")),
        };
        if let Some(edges) = &lists.seams {
            seams = seams.with(rows::<2>("seams", edges)?.into_iter().map(edge_of).collect::<Result<Vec<_>, _>>()?);
        }
        if let Some(costs) = &lists.costs {
            let cost = |[a, b, cost]: [f64; 3]| {
                if !Seams::COSTS.contains(&cost) {
                    let [low, high] = [Seams::COSTS.start(), Seams::COSTS.end()];
                    return Err(Wrong::new("cut_weights", format!("a cost is from {low} to {high}, not {cost}")));
                }
                Ok((edge_of([a, b])?, cost))
            };
            seams = seams.with_costs(rows("cut_weights", costs)?.into_iter().map(cost).collect::<Result<Vec<_>, _>>()?);
        }
        let cut = self.cut.as_deref().map_or(usual.preparation.cut, |cut| cut != "none");
        Ok(Preparation { repair: repairs.welding(weld), holes, cut, seams, ..Preparation::default() })
    }

    fn settings(&self, lists: &Lists<'_>) -> Result<Settings, Wrong> {
        let mut method: Method = named("method", self.method.as_ref())?.unwrap_or_default();
        let has_pins = lists.pins.is_some() || lists.corner_pins.is_some();
        let given = [
            (self.boundary.is_some(), MethodOption::Boundary, "boundary"),
            (self.spacing.is_some(), MethodOption::Spacing, "spacing"),
            (self.layers.is_some(), MethodOption::Layers, "layers"),
            (self.family.is_some(), MethodOption::Family, "family"),
            (has_pins, MethodOption::Pins, "pins"),
            (self.treatment.is_some(), MethodOption::Treatment, "treatment"),
            (self.max_steps.is_some(), MethodOption::MaxSteps, "max_steps"),
            (self.new_vertices == Some(false), MethodOption::NewVertices, "new_vertices"),
            (self.start, MethodOption::Start, "start"),
            (self.growth.is_some(), MethodOption::Growth, "growth"),
        ];
        for (_, option, name) in given.into_iter().filter(|(is_given, ..)| *is_given) {
            if let Some(why) = option.unused_by(&method) {
                return Err(Wrong::new(name, format!("method \"{}\" does not use it: {why}", method.name())));
            }
        }
        if let Some(shape) = named::<BoundaryShape>("boundary", self.boundary.as_ref())? {
            method = method.on_shape(shape);
        }
        let most = usize::from(Settings::MOST_LAYERS);
        if self.layers.is_some_and(|layers| !(1..=most).contains(&layers)) {
            return Err(Wrong::new("layers", format!("pass a number from 1 to {most}")));
        }
        Ok(Settings {
            treatment: named::<Treatment>("treatment", self.treatment.as_ref())?,
            spacing: named::<Spacing>("spacing", self.spacing.as_ref())?.unwrap_or_default(),
            layers: self.layers.unwrap_or(Settings::LAYERS),
            max_steps: self.max_steps,
            growth: named::<Growth>("growth", self.growth.as_ref())?.unwrap_or_default(),
            relax_rounds: self.relax,
            new_vertices: self.new_vertices.unwrap_or(true),
            start: if self.start { Start::File } else { Start::FromScratch },
            method,
            family: parsed::<Family>("family", self.family.as_ref())?,
            ..Settings::default()
        })
    }

    fn packing(&self) -> Result<PackingOptions, Wrong> {
        let picture = self.aspect.map_or(PackingOptions::default().picture, picture_of_aspect);
        let usual = PackingOptions { picture, ..PackingOptions::default() };
        let Some(pack) = &self.pack else { return Ok(usual) };
        if pack.size.is_some() && self.aspect.is_some() {
            return Err(Wrong::new("pack.size", "the aspect ratio sets the picture: remove one of them"));
        }
        let sides = 1..=PackingOptions::LONGEST_SIDE;
        if pack.size.is_some_and(|size| !size.iter().all(|side| sides.contains(side))) {
            return Err(Wrong::new("pack.size", format!("pass pixels from 1 to {}", PackingOptions::LONGEST_SIDE)));
        }
        if pack.gap.is_some_and(|gap| gap > PackingOptions::WIDEST_GAP) {
            return Err(Wrong::new("pack.gap", format!("pass pixels from 0 to {}", PackingOptions::WIDEST_GAP)));
        }
        if pack.density.is_some_and(|density| !(density.is_finite() && density > 0.0)) {
            return Err(Wrong::new("pack.density", "pass pixels per unit of length, above 0"));
        }
        if pack.tiles.is_some_and(|tiles| !(1..=PackingOptions::MOST_TILES).contains(&tiles)) {
            return Err(Wrong::new("pack.tiles", format!("pass a number from 1 to {}", PackingOptions::MOST_TILES)));
        }
        Ok(PackingOptions {
            picture: pack.size.unwrap_or(usual.picture),
            gap: pack.gap.unwrap_or(usual.gap),
            rotations: named::<Rotations>("pack.rotations", pack.rotations.as_ref())?.unwrap_or(usual.rotations),
            density: pack.density,
            tiles: pack.tiles.unwrap_or(usual.tiles),
            stack: named::<Stacking>("pack.stack", pack.stack.as_ref())?.unwrap_or(usual.stack),
        })
    }

    /// Arrangement of the charts. Charts of a layout to start from stay in place unless packing is requested.
    fn arrangement(&self, fit: Option<Fit>) -> Arrangement {
        let is_packed = self.pack.is_some() || !self.lock.is_empty() || fit == Some(Fit::True);
        if self.start && !is_packed { Arrangement::AsGiven } else { Arrangement::Packed }
    }
}

/// Rejects wrong options before a mesh is read.
#[pyfunction]
pub(crate) fn check_options(py: Python<'_>, options: &str, lists: Lists<'_>) -> PyResult<()> {
    of_json::<Options>(py, options)?.request(py, &lists).map(drop)
}

/// Options of a JSON object.
pub(crate) fn of_json<T: DeserializeOwned>(py: Python<'_>, text: &str) -> PyResult<T> {
    let mut json = serde_json::Deserializer::from_str(text);
    serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let (path, why) = (error.path().to_string(), words(error.inner()));
        errors::option_error(py, if path == "." { why } else { format!("{path}: {why}") })
    })
}

/// Message of a wrong JSON object without its position, which the caller did not write.
fn words(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}

/// Rows of a table with `N` columns.
fn rows<const N: usize>(option: &str, table: &PyReadonlyArray2<'_, f64>) -> Result<Vec<[f64; N]>, Wrong> {
    let table = table.as_array();
    if table.shape()[1] != N {
        return Err(Wrong::new(option, format!("pass rows of {N} numbers")));
    }
    Ok(table.rows().into_iter().map(|row| std::array::from_fn(|at| row[at])).collect())
}

/// Element with this number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number is checked")]
fn element(option: &str, number: f64) -> Result<u32, Wrong> {
    let is_number = number >= 0.0 && number < f64::from(u32::MAX) && number.fract() == 0.0;
    if is_number { Ok(number as u32) } else { Err(Wrong::new(option, format!("there is no element {number}"))) }
}

fn edge_of([a, b]: [f64; 2]) -> Result<[VertexId; 2], Wrong> {
    Ok([VertexId::new(element("seams", a)?), VertexId::new(element("seams", b)?)])
}

/// Pinned elements with their targets.
fn pinned(option: &str, table: Option<&PyReadonlyArray2<'_, f64>>) -> Result<Vec<(u32, Target)>, Wrong> {
    let Some(table) = table else { return Ok(Vec::new()) };
    let pin = |[number, u, v, weight]: [f64; 4]| {
        let number = element(option, number)?;
        let kind = if weight.is_nan() { PinKind::Hard } else { PinKind::Soft(weight) };
        match kind.invalid_weight() {
            Some(weight) => Err(Wrong::new(option, format!("element {number}: the weight {weight} is not above 0"))),
            None => Ok((number, Target { uv: DVec2::new(u, v), kind })),
        }
    };
    rows(option, table)?.into_iter().map(pin).collect()
}

fn targets(lists: &Lists<'_>) -> Result<Targets, Wrong> {
    let mut targets = Targets::new();
    for (vertex, target) in pinned("pins", lists.pins.as_ref())? {
        if targets.insert(VertexId::new(vertex), target).is_some() {
            return Err(Wrong::new("pins", format!("vertex {vertex} is pinned twice")));
        }
    }
    Ok(targets)
}

fn corner_pins(lists: &Lists<'_>) -> Result<Vec<(usize, Target)>, Wrong> {
    let pins = pinned("corner_pins", lists.corner_pins.as_ref())?;
    Ok(pins.into_iter().map(|(corner, target)| (corner as usize, target)).collect())
}
