//! Parsers for values of options.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use glam::{DVec2, UVec2};

use super::args::Denied;
use freebound_core::cutting::SeamOptions;
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{VertexId, WeldDistance};
use freebound_core::pipeline::Target;
use freebound_core::problem::{NamedOption, PinKind};
use freebound_core::verify::FindingCode;
use freebound_io::{BakeOptions, ConstraintFault, PatternOptions};

/// Parser for named options, which lists all names with a description of each.
pub(super) fn choice<C: NamedOption>() -> impl TypedValueParser<Value = C> {
    let values = C::ALL.iter().map(|choice| PossibleValue::new(choice.name()).help(choice.labels().about));
    PossibleValuesParser::new(values).map(|name| C::named(&name).expect("only these names pass"))
}

pub(super) fn parse_pin(text: &str) -> Result<(VertexId, Target), String> {
    let parsed = || {
        let (vertex, place) = text.split_once(':')?;
        let (place, weight) = place.split_once(':').map_or((place, None), |(place, weight)| (place, Some(weight)));
        let (u, v) = place.split_once(',')?;
        let kind = match weight {
            None => PinKind::Hard,
            Some(weight) => PinKind::Soft(weight.trim().parse().ok()?),
        };
        let uv = DVec2::new(u.trim().parse().ok()?, v.trim().parse().ok()?);
        Some((VertexId::new(vertex.trim().parse().ok()?), Target { uv, kind }))
    };
    let (vertex, target) = parsed().ok_or("write VERTEX:U,V or VERTEX:U,V:WEIGHT, for example 12:0.25,0.75")?;
    match target.kind.invalid_weight() {
        Some(weight) => Err(ConstraintFault::WeightNotPositive { vertex, weight }.to_string()),
        None => Ok((vertex, target)),
    }
}

/// Parses a size "widthxheight", in pixels.
pub(super) fn parse_pixels(text: &str) -> Result<UVec2, String> {
    let parsed = || {
        let (width, height) = text.split_once(['x', 'X', '×'])?;
        let size = UVec2::new(width.trim().parse().ok()?, height.trim().parse().ok()?);
        (size.cmpgt(UVec2::ZERO).all() && size.cmple(UVec2::splat(PackingOptions::LONGEST_SIDE)).all()).then_some(size)
    };
    parsed().ok_or_else(|| format!("write WIDTHxHEIGHT, for example 2048x1024, up to {}", PackingOptions::LONGEST_SIDE))
}

/// Parses the size of a picture that is drawn.
pub(super) fn parse_drawn_pixels(text: &str) -> Result<UVec2, String> {
    let size = parse_pixels(text).ok().filter(|size| size.max_element() <= BakeOptions::LONGEST_SIDE);
    size.ok_or_else(|| format!("write WIDTHxHEIGHT, for example 2048x1024, up to {}", BakeOptions::LONGEST_SIDE))
}

/// Parses an aspect ratio "width:height" and returns width over height.
pub(super) fn parse_aspect(text: &str) -> Result<f64, String> {
    let parsed = || {
        let (width, height) = text.split_once(':')?;
        let aspect = width.trim().parse::<f64>().ok()? / height.trim().parse::<f64>().ok()?;
        (aspect.is_normal() && aspect > 0.0).then_some(aspect)
    };
    parsed().ok_or_else(|| "write WIDTH:HEIGHT, for example 16:9".to_owned())
}

pub(super) fn parse_weld_distance(text: &str) -> Result<WeldDistance, String> {
    let parsed = text.trim().parse().ok().and_then(WeldDistance::new);
    parsed.ok_or_else(|| "write a distance of 0 or more, for example 0.001".to_owned())
}

/// Parses the code of a finding.
pub(super) fn parse_code(text: &str) -> Result<FindingCode, String> {
    text.trim().parse()
}

/// Parses the code of a finding, or "warnings".
pub(super) fn parse_denied(text: &str) -> Result<Denied, String> {
    if text.trim() == "warnings" { Ok(Denied::Warnings) } else { parse_code(text).map(Denied::Code) }
}

/// Parses a bound on the mean symmetric Dirichlet energy.
pub(super) fn parse_distortion(text: &str) -> Result<f64, String> {
    let parsed = text.trim().parse().ok().filter(|bound: &f64| bound.is_finite() && *bound > SeamOptions::ISOMETRIC);
    parsed.ok_or_else(|| "write an energy above 4, which is an isometric map, for example 4.1".to_owned())
}

/// Parses the weight of what a seam shows.
pub(super) fn parse_visibility(text: &str) -> Result<f64, String> {
    let parsed = text.trim().parse().ok().filter(|weight| (0.0..=1.0).contains(weight));
    parsed.ok_or_else(|| "write a number from 0 to 1, for example 0.5".to_owned())
}

/// Size of a chart relative to the others.
#[derive(Clone, Copy, Debug)]
pub struct ChartSize {
    /// Number of the chart, counted as in the report.
    pub chart: usize,
    /// Size relative to the others.
    pub size: f64,
}

/// Parses "number=size", the number and the relative size of a chart.
pub(super) fn parse_chart_size(text: &str) -> Result<ChartSize, String> {
    let parsed = || {
        let (chart, size) = text.split_once('=')?;
        let size = size.trim().parse().ok().filter(|size| PackingOptions::SIZES.contains(size))?;
        Some(ChartSize { chart: chart.trim().parse().ok()?, size })
    };
    let [low, high] = [PackingOptions::SIZES.start(), PackingOptions::SIZES.end()];
    parsed().ok_or_else(|| format!("write CHART=SIZE, for example 0=2, with a size from {low} to {high}"))
}

/// Parses a density in pixels per unit of length.
pub(super) fn parse_density(text: &str) -> Result<f64, String> {
    let parsed = text.trim().parse().ok().filter(|density: &f64| density.is_finite() && *density > 0.0);
    parsed.ok_or_else(|| "write pixels per unit of length, a number above 0, for example 512".to_owned())
}

/// Parses a length in millimetres.
pub(super) fn parse_millimetres(text: &str) -> Result<f64, String> {
    let parsed = text.trim().parse().ok().filter(|length| (0.0..=PatternOptions::LONGEST).contains(length));
    parsed.ok_or_else(|| format!("write millimetres, from 0 to {}, for example 10", PatternOptions::LONGEST))
}

/// Tiles that charts are packed into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileRule {
    /// At most so many tiles.
    UpTo(u32),
    /// A tile for each material of the file.
    Materials,
    /// A tile for each group of the file.
    Groups,
}

/// Parses a number of tiles, "materials" or "groups".
pub(super) fn parse_tiles(text: &str) -> Result<TileRule, String> {
    let number = || text.trim().parse().ok().filter(|count| (1..=PackingOptions::MOST_TILES).contains(count));
    let rule = match text {
        "materials" => Some(TileRule::Materials),
        "groups" => Some(TileRule::Groups),
        _ => number().map(TileRule::UpTo),
    };
    rule.ok_or_else(|| format!("write materials, groups or a number from 1 to {}", PackingOptions::MOST_TILES))
}

/// Parses a number of bytes with an optional K, M or G.
pub(super) fn parse_memory(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let (digits, shift) = match text.char_indices().last() {
        Some((at, 'k' | 'K')) => (&text[..at], 10),
        Some((at, 'm' | 'M')) => (&text[..at], 20),
        Some((at, 'g' | 'G')) => (&text[..at], 30),
        _ => (text, 0),
    };
    let bytes = digits.trim().parse::<u64>().ok().and_then(|number| number.checked_mul(1 << shift));
    bytes.filter(|&bytes| bytes > 0).ok_or_else(|| "write bytes, or a number with K, M or G, for example 4G".to_owned())
}
