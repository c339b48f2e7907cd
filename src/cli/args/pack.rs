//! Arguments of `pack`.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::UVec2;

use super::MeshOutputArguments;
use crate::cli::typed::{choice, parse_aspect, parse_density, parse_pixels};
use freebound_core::geom::{PackingOptions, Rotations, Stacking};
use freebound_core::pipeline::{ChartSizes, LockedCharts, RepackOptions};
use freebound_core::problem::NamedOption as _;
use freebound_io::{LayoutPacking, OutputKind, PictureFile};

/// Arguments of `pack`.
#[derive(Debug, Args)]
pub struct PackArguments {
    /// Mesh with texture coordinates: an OBJ, PLY, GLB or glTF file, or standard input with `-`.
    pub mesh: PathBuf,
    /// Size of the picture that the charts are packed into, in pixels. Default: 1024x1024.
    #[arg(long, value_name = "WxH", value_parser = parse_pixels)]
    pub pack: Option<UVec2>,
    /// Take the size in pixels from this picture (PNG, JPEG, or glTF with a picture). The picture itself stays unchanged.
    #[arg(long, value_name = "FILE", conflicts_with = "pack")]
    pub picture: Option<PathBuf>,
    /// Shape of the picture of the given layout, for example `2:1`. Default: that of the new picture.
    #[arg(long, value_name = "W:H", value_parser = parse_aspect)]
    pub from_aspect: Option<f64>,
    /// Smallest distance between packed charts, in pixels of the packed picture. Default: 4.
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub gap: Option<u32>,
    /// Rotations of packed charts. Default: free.
    #[arg(long, value_parser = choice::<Rotations>())]
    pub rotations: Option<Rotations>,
    /// Density of the charts: pixels of the picture per unit of length of the mesh. Default: the largest that fits.
    ///
    /// The picture is doubled until the charts fit. With `--keep-sizes`, the density is that of all charts together.
    #[arg(long, value_name = "PIXELS", value_parser = parse_density)]
    pub density: Option<f64>,
    /// Largest number of tiles (UDIM) that charts are packed into. Default: 1.
    ///
    /// With `--density`, as few tiles as found are used.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(PackingOptions::MOST_TILES)))]
    pub tiles: Option<u32>,
    /// Stack charts with congruent surfaces and maps, so that they share one place. Default: none.
    ///
    /// With `mirrored` a chart may also be stacked as a mirror image. Without a value: congruent.
    #[arg(long, value_parser = choice::<Stacking>(), num_args = 0..=1, default_missing_value = Stacking::Congruent.name())]
    pub stack: Option<Stacking>,
    /// Keep the sizes of the charts relative to each other. Default: equal density for all charts.
    #[arg(long)]
    pub keep_sizes: bool,
    /// Keep these charts in place, and pack the others around them.
    ///
    /// Charts are numbered from 0, in the order of their first faces, as in the report. The other charts get no more
    /// pixels per unit of length than these. If there is no room, they lie to the right of the picture.
    #[arg(long, value_name = "CHART,…", value_delimiter = ',')]
    pub lock: Vec<usize>,
    /// Draw the layout into this file (SVG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub svg: Option<PathBuf>,
    /// Files and their form.
    #[command(flatten)]
    pub result: MeshOutputArguments,
}

impl PackArguments {
    /// Rules for packing, for the size of this picture if there is one.
    pub fn packing(&self, picture: Option<&PictureFile>) -> LayoutPacking {
        let usual = PackingOptions::default();
        let of_picture = picture.map(|picture| [picture.pixels.width, picture.pixels.height]);
        let picture = self.pack.map(|size| size.to_array()).or(of_picture).unwrap_or(usual.picture);
        let options = PackingOptions {
            picture,
            gap: self.gap.unwrap_or(usual.gap),
            rotations: self.rotations.unwrap_or(usual.rotations),
            density: self.density,
            tiles: self.tiles.unwrap_or(usual.tiles),
            stack: self.stack.unwrap_or(usual.stack),
        };
        let sizes = if self.keep_sizes { ChartSizes::AsGiven } else { ChartSizes::EqualDensity };
        let [width, height] = picture.map(f64::from);
        let locked = LockedCharts::Numbered(self.lock.iter().copied().collect());
        let options = RepackOptions { packing: options, sizes, locked };
        LayoutPacking { options, aspect: self.from_aspect.unwrap_or(width / height) }
    }

    /// Files to write, apart from the report.
    pub fn outputs(&self) -> Vec<(OutputKind, &Path)> {
        // The mesh is written last, after the files that it names.
        let paths = [(OutputKind::Svg, &self.svg), (self.result.kind(), &self.result.output)].into_iter();
        paths.filter_map(|(kind, path)| Some((kind, path.as_deref()?))).collect()
    }
}
