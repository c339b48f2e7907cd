//! Arguments of `flatten`.

use std::path::{Path, PathBuf};
use std::str::FromStr as _;

use clap::Args;
use glam::UVec2;

use super::{MeshArguments, PatternArguments, SolveArguments, TypedShape};
use crate::cli::typed::{ChartSize, TileRule, choice, parse_chart_size, parse_density, parse_pixels, parse_tiles};
use freebound_core::geom::{PackingOptions, Rotations, Stacking};
use freebound_core::pipeline::{Arrangement, Fit};
use freebound_core::problem::{Method, NamedOption as _, Settings};
use freebound_io::{OutputKind, PictureFile, Precision};
use freebound_run::{MethodOption, picture_of_aspect};

/// Arguments of `flatten`.
#[derive(Debug, Args)]
pub struct FlattenArguments {
    /// The mesh.
    #[command(flatten)]
    pub input: MeshArguments,
    /// Write the mesh with texture coordinates to this file, or to standard output with `-`.
    ///
    /// Names that end in .ply or .glb give PLY or GLB; all others give OBJ. Input files are never overwritten.
    #[arg(short, long, value_name = "MESH|-")]
    pub output: Option<PathBuf>,
    /// Method to flatten with.
    #[arg(long, value_parser = choice::<Method>(), default_value = Method::Auto.name())]
    pub method: Method,
    /// Boundary shape for `convex`, `stretch` and `lee`. Default: circle.
    ///
    /// For `lee` the shape applies to the outermost layer. `hull` is the convex hull of the boundary, projected to its
    /// best plane. A polygon is a file of lines `x y`, or the corners themselves, for example `polygon:0 0; 3 0; 3 2;
    /// 0 2`. Its corners must be convex and counter-clockwise.
    #[arg(long, value_name = "circle|square|hull|polygon:FILE", value_parser = TypedShape::from_str, hide_short_help = true)]
    pub boundary: Option<TypedShape>,
    /// Pins and settings.
    #[command(flatten)]
    pub solve: SolveArguments,
    /// Map this picture (PNG, JPEG, or glTF with a picture) onto the mesh.
    ///
    /// The map uses the picture's aspect ratio. The picture is copied beside the OBJ file, with a material.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Copy the mesh's material libraries and their pictures beside the OBJ file.
    ///
    /// Default: the OBJ file refers to them in their present place.
    #[arg(long, requires = "output", conflicts_with = "picture", hide_short_help = true)]
    pub copy_materials: bool,
    /// Size of a map without pins: the unit square, or the area of the surface.
    ///
    /// Default: the unit square. With `--start` the default is the size and position of the layout. With `true` several
    /// charts lie side by side, and a unit of the map is a unit of the mesh.
    #[arg(long, value_parser = choice::<Fit>(), hide_short_help = true)]
    pub fit: Option<Fit>,
    /// Size of the picture that several charts are packed into, in pixels.
    ///
    /// Default: the size of `--picture`, or 1024x1024.
    #[arg(long, value_name = "WxH", value_parser = parse_pixels, conflicts_with_all = ["aspect", "picture"], hide_short_help = true)]
    pub pack: Option<UVec2>,
    /// Smallest distance between packed charts, in pixels of the packed picture. Default: 4.
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(0..=1024), hide_short_help = true)]
    pub gap: Option<u32>,
    /// Rotations of packed charts. Default: free.
    #[arg(long, value_parser = choice::<Rotations>(), hide_short_help = true)]
    pub rotations: Option<Rotations>,
    /// Density of packed charts: pixels of the picture per unit of length of the mesh. Default: the largest that fits.
    ///
    /// The picture is doubled until the charts fit. So several files get one density. A mesh of one chart is packed
    /// too.
    #[arg(long, value_name = "PIXELS", value_parser = parse_density, hide_short_help = true)]
    pub density: Option<f64>,
    /// Tiles (UDIM) that charts are packed into: at most N, or one for each material or group.
    ///
    /// A tile is a unit square with a picture of its own. Tile 1001 + c + 10 r lies in column c and row r. With
    /// `--density`, as few tiles as found are used. A chart belongs to the material of most of its area.
    #[arg(long, value_name = "N|materials|groups", value_parser = parse_tiles, hide_short_help = true)]
    pub tiles: Option<TileRule>,
    /// Keep these charts where the layout of `--start` has them, and pack the others around them.
    ///
    /// Charts are numbered from 0, as in the report.
    #[arg(long, value_name = "CHART,…", value_delimiter = ',', requires = "start", hide_short_help = true)]
    pub lock: Vec<usize>,
    /// Stack charts with congruent surfaces, so that they share one place. Default: none.
    ///
    /// With `mirrored` a chart may also be stacked as a mirror image. Its faces are then turned over in the picture.
    /// Without a value: congruent.
    #[arg(long, value_parser = choice::<Stacking>(), num_args = 0..=1, default_missing_value = Stacking::Congruent.name(), hide_short_help = true)]
    pub stack: Option<Stacking>,
    /// Relative sizes of packed charts, for example `0=2,3=0.5`.
    ///
    /// Charts are numbered from 0, as in the report. A chart without an entry has size 1.
    #[arg(long, value_name = "CHART=SIZE,…", value_delimiter = ',', value_parser = parse_chart_size, hide_short_help = true)]
    pub chart_size: Vec<ChartSize>,
    /// Precision in which texture coordinates are proved and written. Default: 64 bits for OBJ, 32 bits for PLY and GLB.
    ///
    /// PLY files of 32 bits have the form that most programs read: `s` and `t` as float, and a copy of each vertex on a
    /// seam. Those of 64 bits keep the vertices and list the coordinates of corners; a map that 32 bits would fold gets
    /// them by default. GLB files always hold 32 bits.
    #[arg(long, value_parser = choice::<Precision>(), hide_short_help = true)]
    pub precision: Option<Precision>,
    /// Write a report to this file (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Draw the layout into this file (SVG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub svg: Option<PathBuf>,
    /// Size of the drawing: the unit square, or the lengths of the surface. Default: as `--fit`.
    ///
    /// With `unit` the page is the unit square, or the picture if there is one. With `true` one unit of the drawing is
    /// one unit of the mesh.
    #[arg(long, value_parser = choice::<Fit>(), requires = "svg", hide_short_help = true)]
    pub svg_scale: Option<Fit>,
    /// Draw the mesh and the layout side by side into this file (PNG); `-` for standard output.
    #[arg(long, value_name = "FILE|-")]
    pub png: Option<PathBuf>,
    /// Write the layout as a flat mesh in the plane z = 0 to this file, in the units of the mesh.
    ///
    /// The mesh has one vertex per texture coordinate. Names that end in .ply or .glb give PLY or GLB; all others give OBJ.
    #[arg(long, value_name = "MESH", hide_short_help = true)]
    pub flat_mesh: Option<PathBuf>,
    /// Draw every step into this folder (SVG), with a table of numbers (steps.csv).
    ///
    /// Steps of an earlier run in the folder are replaced.
    #[arg(long, value_name = "DIR", hide_short_help = true)]
    pub steps: Option<PathBuf>,
    /// Cutting pattern.
    #[command(flatten)]
    pub cutting: PatternArguments,
}

/// Arguments of `unwrap`: those of `flatten` with other defaults.
#[derive(Debug, Args)]
#[command(
    mut_arg("repair", |arg| arg.default_value("all")),
    mut_arg("cut", |arg| arg.default_value("auto")),
    mut_arg("distortion", |arg| arg.default_value("4.1"))
)]
pub struct UnwrapArguments {
    /// The mesh, its outputs and all settings.
    #[command(flatten)]
    pub flatten: FlattenArguments,
}

impl FlattenArguments {
    /// Packing options of several charts, for the size of this picture if there is one.
    pub fn packing(&self, picture: Option<&PictureFile>) -> PackingOptions {
        let options = PackingOptions::default();
        let (gap, rotations) = (self.gap.unwrap_or(options.gap), self.rotations.unwrap_or(options.rotations));
        let stack = self.stack.unwrap_or(options.stack);
        let options = PackingOptions { gap, rotations, stack, density: self.density, ..options };
        let of_picture = picture.map(|picture| UVec2::new(picture.pixels.width, picture.pixels.height));
        let of_aspect = self.solve.aspect.map(|aspect| UVec2::from_array(picture_of_aspect(aspect)));
        let picture = self.pack.or(of_picture).or(of_aspect).map_or(options.picture, |size| size.to_array());
        PackingOptions { picture, ..options }
    }

    /// Arrangement of the charts. Charts of a layout to start from stay in place unless packing is requested.
    pub fn arrangement(&self) -> Arrangement {
        let sizes = [self.pack.is_some(), self.gap.is_some(), self.rotations.is_some(), self.density.is_some()];
        let is_packed = sizes.contains(&true) || self.tiles.is_some() || !self.lock.is_empty();
        let is_packed = is_packed || self.fit == Some(Fit::True);
        if self.solve.start.is_some() && !is_packed { Arrangement::AsGiven } else { Arrangement::Packed }
    }

    /// Files to write, apart from the report.
    pub fn outputs(&self) -> Vec<(OutputKind, &Path)> {
        // The mesh is written last, after the files that it names.
        let mesh = self.output.as_deref().map_or(OutputKind::Obj, OutputKind::of_mesh);
        let paths = [(OutputKind::Svg, &self.svg), (OutputKind::Png, &self.png), (mesh, &self.output)].into_iter();
        paths.filter_map(|(kind, path)| Some((kind, path.as_deref()?))).collect()
    }

    /// Settings of the solver.
    pub fn settings(&self) -> Settings {
        let shape = self.boundary.as_ref().map(|typed| typed.shape.clone());
        self.solve.settings(shape.map_or_else(|| self.method.clone(), |shape| self.method.clone().on_shape(shape)))
    }

    /// First given option that does not apply to the method, with the reason.
    pub fn idle_option(&self) -> Option<(&'static str, &'static str)> {
        let unused = MethodOption::Boundary.unused_by(&self.method).filter(|_| self.boundary.is_some());
        if let Some(why) = unused {
            return Some(("--boundary", why));
        }
        self.solve.idle_option(std::slice::from_ref(&self.method))
    }
}
