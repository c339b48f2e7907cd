//! Arguments of `flatten`.

use std::path::{Path, PathBuf};
use std::str::FromStr as _;

use clap::Args;
use glam::{DVec2, UVec2};

use super::solve::ONLY_ON_SHAPES;
use super::{MeshArguments, SolveArguments, TypedShape};
use crate::cli::typed::{ChartSize, choice, parse_chart_size, parse_pixels};
use freebound_core::geom::PackingOptions;
use freebound_core::pipeline::{Arrangement, Fit};
use freebound_core::problem::{Method, NamedOption as _, Settings};
use freebound_io::{OutputKind, PictureFile, Precision};

/// Arguments of `flatten`.
#[derive(Debug, Args)]
pub struct FlattenArguments {
    /// The mesh.
    #[command(flatten)]
    pub input: MeshArguments,
    /// Write the mesh with texture coordinates here (PLY or GLB where the name ends so, or else OBJ), or to standard output with `-`. The mesh that is read, or
    /// anything else that is, is never written over.
    #[arg(short, long, value_name = "MESH|-")]
    pub output: Option<PathBuf>,
    /// How to flatten.
    #[arg(long, value_parser = choice::<Method>(), default_value = Method::Auto.name())]
    pub method: Method,
    /// The shape of the boundary, for `--method convex` and `stretch`, or of the outermost layer, for `lee`; a circle without
    /// it. `hull` is the hull of the boundary's projection to its best plane. A polygon is a file of lines `x y`, or its
    /// corners themselves, for example `polygon:0 0; 3 0; 3 2; 0 2`: convex, counter-clockwise.
    #[arg(long, value_name = "circle|square|hull|polygon:FILE", value_parser = TypedShape::from_str)]
    pub boundary: Option<TypedShape>,
    /// Pins and settings.
    #[command(flatten)]
    pub solve: SolveArguments,
    /// Map this picture (PNG or JPEG) on the mesh: its aspect counts, and it goes beside the OBJ file, with a material.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Copy the mesh's material libraries and the pictures that they name beside the OBJ file. Without it they stay, and
    /// the OBJ file names them where they are.
    #[arg(long, requires = "output", conflicts_with = "picture")]
    pub copy_materials: bool,
    /// Size of an embedding without pins: fit into the unit square, or keep the area of the surface; into the unit square
    /// without it. With `--start` the embedding stays as large as it was, and where it was, without it.
    #[arg(long, value_parser = choice::<Fit>())]
    pub fit: Option<Fit>,
    /// Size of the picture that several charts are packed into, in pixels; without it that of `--picture`, or 1024x1024.
    #[arg(long, value_name = "WxH", value_parser = parse_pixels, conflicts_with_all = ["aspect", "picture"])]
    pub pack: Option<UVec2>,
    /// The least distance between packed charts, in pixels of that picture; 4 without it.
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub gap: Option<u32>,
    /// How many times as large as the others charts are packed: numbers of charts, as the report counts them from 0, each with
    /// its size, for example `0=2,3=0.5`.
    #[arg(long, value_name = "CHART=SIZE,…", value_delimiter = ',', value_parser = parse_chart_size)]
    pub chart_size: Vec<ChartSize>,
    /// How many bits the numbers of texture coordinates have, as they are proved and written. GLB files always hold 32.
    #[arg(long, value_parser = choice::<Precision>(), default_value = Precision::F64.name())]
    pub precision: Precision,
    /// Write a report here (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Draw the layout here (SVG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub svg: Option<PathBuf>,
    /// Size of the drawing: the unit square (the picture, where there is one) is the page, or lengths are as on the
    /// surface, a unit of the drawing for a unit of the mesh. As `--fit` without it.
    #[arg(long, value_parser = choice::<Fit>(), requires = "svg")]
    pub svg_scale: Option<Fit>,
    /// Draw the mesh and the layout side by side here (PNG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub png: Option<PathBuf>,
    /// Draw every step into this folder (SVG), with a table of their numbers (steps.csv). The steps of an earlier run in
    /// it are replaced.
    #[arg(long, value_name = "DIR")]
    pub steps: Option<PathBuf>,
}

impl FlattenArguments {
    /// How several charts are packed, into this picture where there is one.
    pub fn packing(&self, picture: Option<&PictureFile>) -> PackingOptions {
        let options = PackingOptions::default();
        let options = PackingOptions { gap: self.gap.unwrap_or(options.gap), ..options };
        let of_picture = picture.map(|picture| UVec2::new(picture.pixels.width, picture.pixels.height));
        let of_aspect = self
            .solve
            .aspect
            .map(|aspect| UVec2::from_array(options.picture).as_dvec2() * DVec2::new(aspect, 1.0) / aspect.max(1.0));
        let of_aspect = of_aspect.map(|size| size.round().max(DVec2::ONE).as_u64vec2().as_uvec2());
        let picture = self.pack.or(of_picture).or(of_aspect).map_or(options.picture, |size| size.to_array());
        PackingOptions { picture, ..options }
    }

    /// Where charts go: they stay where the file has them, where nothing else is asked for.
    pub fn arrangement(&self) -> Arrangement {
        let is_packed = self.pack.is_some() || self.gap.is_some();
        if self.solve.start.is_some() && !is_packed { Arrangement::AsGiven } else { Arrangement::Packed }
    }

    /// The files to write, apart from the report.
    pub fn outputs(&self) -> Vec<(OutputKind, &Path)> {
        // The mesh comes last, so that what it names is there.
        let mesh = self.output.as_deref().map_or(OutputKind::Obj, OutputKind::of_mesh);
        let paths = [(OutputKind::Svg, &self.svg), (OutputKind::Png, &self.png), (mesh, &self.output)].into_iter();
        paths.filter_map(|(kind, path)| Some((kind, path.as_deref()?))).collect()
    }

    /// The solver's settings.
    pub fn settings(&self) -> Settings {
        let shape = self.boundary.as_ref().map(|typed| typed.shape.clone());
        self.solve.settings(shape.map_or_else(|| self.method.clone(), |shape| self.method.clone().on_shape(shape)))
    }

    /// An option that was given but means nothing to the method, and why.
    pub fn idle_option(&self) -> Option<(&'static str, &'static str)> {
        if self.boundary.is_some() && self.method.boundary_shape().is_none() {
            return Some(("--boundary", ONLY_ON_SHAPES));
        }
        self.solve.idle_option(std::slice::from_ref(&self.method))
    }
}
