//! Morph through the maps of several methods as a sequence of pictures. A morph of two maps runs forward, then back
//! over the same frames.

use std::io::{self, Write};

use glam::DVec2;
use rayon::prelude::*;

use super::comparison::{bar, checkered, colours_of};
use super::{CellShading, Range};
use crate::session::{MorphLeg, MorphTour};
use freebound_core::geom::Bounds;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Embedding, Variant};
use freebound_core::verify::distortion;
use freebound_io::figure::{CellContent, Page, Still, TintedDrawing, Window};
use freebound_io::{AnimationForm, AnimationFrame, write_animation};

/// Pixels per point of a frame.
const PIXELS: f64 = 1.25;

/// Display time of a method's map, then of each intermediate frame, milliseconds.
const STAY: u16 = 1000;
const FRAME: u16 = 40;

/// Number of frames drawn in parallel.
const DRAWN_TOGETHER: usize = 16;

/// Margin around an embedding, relative to its extent.
const MARGIN: f64 = 0.04;

/// Largest ratio of frame sizes for which all frames share one scale.
const SIZES: f64 = 2.5;

/// Tour of morphs to draw.
#[derive(Debug)]
pub struct MorphPicture<'a> {
    mesh: &'a DiskMesh,
    tour: &'a MorphTour,
    shading: CellShading,
    /// Colour range of the maps, shared by all frames.
    range: Option<Range>,
    /// Part of the plane that each frame shows.
    sight: MorphSight,
}

/// Part of the plane that the frames show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MorphSight {
    /// Fixed window for all frames, used if pins hold all maps.
    Fixed(Window),
    /// Window centred on each frame, with one scale for all: half a side.
    Along(f64),
    /// Window fitted to each frame.
    Whole,
}

/// Position on a tour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MorphPlace {
    /// Index of the leg.
    pub leg: usize,
    /// Index of the frame in the leg.
    pub frame: usize,
}

impl<'a> MorphPicture<'a> {
    /// Prepares the pictures of a tour on a mesh.
    pub fn new(mesh: &'a DiskMesh, tour: &'a MorphTour, shading: CellShading) -> Self {
        let stops = || tour.stops.stops.iter().map(|stop| &*stop.outcome);
        let range = match shading {
            CellShading::By(quantity) => quantity.common_range(stops().map(|outcome| &outcome.distortion)),
            CellShading::Checker => None,
        };
        Self { mesh, tour, shading, range, sight: MorphSight::new(tour) }
    }

    /// Places in display order, from the first map to the last, each map once. A tour of one leg then runs back over
    /// the same frames.
    pub fn places(&self) -> Vec<MorphPlace> {
        let of_leg = |(leg, of): (usize, &MorphLeg)| {
            // The map that ends one leg begins the next.
            let first = usize::from(leg > 0);
            (first..of.frames.len()).map(move |frame| MorphPlace { leg, frame })
        };
        let mut places: Vec<MorphPlace> = self.tour.legs.iter().enumerate().flat_map(of_leg).collect();
        if self.tour.legs.len() == 1 {
            let back: Vec<MorphPlace> = places.iter().rev().skip(1).copied().collect();
            places.extend(&back[..back.len().saturating_sub(1)]);
        }
        places
    }

    /// Lays out the frame at a place.
    fn page(&self, place: MorphPlace) -> Page {
        let leg = &self.tour.legs[place.leg];
        let embedding = &leg.frames[place.frame];
        let (content, bar) = match (self.shading, self.range) {
            (CellShading::By(quantity), Some(range)) => {
                let colours = colours_of(&distortion(self.mesh, embedding), quantity, range);
                let drawing = TintedDrawing::of_planar(self.mesh, embedding, colours, self.sight.window(embedding));
                (CellContent::Plane(drawing), Some(bar(quantity, range)))
            }
            _ => (CellContent::Photo(checkered(self.mesh, embedding)), None),
        };
        let number = format!("frame {} of {}", place.frame + 1, leg.frames.len());
        let lines = vec![format!("{number} · {}", leg.verdicts[place.frame].summary()), leg.route.words().to_owned()];
        Still { content, title: self.title(place), lines, bar }.page()
    }

    fn title(&self, place: MorphPlace) -> String {
        let [from, to] = [0, 1].map(|next| {
            let stop = &self.tour.stops.stops[place.leg + next];
            Variant::of(&stop.outcome.problem.settings).title()
        });
        match place.frame {
            0 => from,
            frame if self.is_last(MorphPlace { frame, ..place }) => to,
            _ => format!("{from} to {to}"),
        }
    }

    fn is_last(&self, place: MorphPlace) -> bool {
        place.frame + 1 == self.tour.legs[place.leg].frames.len()
    }

    /// Draws the frame at a place. A map is displayed longer than an intermediate frame.
    ///
    /// # Panics
    ///
    /// If the tour has no such place.
    pub fn frame(&self, place: MorphPlace) -> AnimationFrame {
        let is_map = place.frame == 0 || self.is_last(place);
        AnimationFrame { picture: self.page(place).picture(PIXELS), milliseconds: if is_map { STAY } else { FRAME } }
    }

    /// Writes all frames as an animated picture (APNG).
    ///
    /// # Errors
    ///
    /// Errors of the writer, and a tour without a leg.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let places = self.places();
        let Some(&first) = places.first() else { return Err(io::Error::other("a morph needs two maps")) };
        let picture = self.frame(first).picture;
        let frame_count = u32::try_from(places.len()).map_err(io::Error::other)?;
        let form = AnimationForm { size: [picture.width, picture.height], frame_count };
        let frame = |&place: &MorphPlace| self.frame(place);
        let drawn = places.chunks(DRAWN_TOGETHER).flat_map(|some| some.par_iter().map(frame).collect::<Vec<_>>());
        write_animation(out, form, drawn)
    }
}

impl MorphSight {
    /// Returns the choice that shows all of a tour.
    pub fn new(tour: &MorphTour) -> Self {
        let boxes: Vec<Bounds> = tour.legs.iter().flat_map(|leg| &leg.frames).map(Embedding::bounds).collect();
        let are_held = tour.stops.stops.iter().all(|stop| stop.outcome.is_held());
        let half = |extent: f64| (0.5 + MARGIN) * extent.max(f64::MIN_POSITIVE);
        let extents = || boxes.iter().map(|bounds| bounds.size().max_element());
        let (least, greatest) = (extents().fold(f64::INFINITY, f64::min), extents().fold(0.0, f64::max));
        match boxes.iter().copied().reduce(Bounds::union).filter(|_| are_held) {
            Some(all) => Self::Fixed(Window { centre: all.middle(), half: half(all.size().max_element()) }),
            None if greatest <= SIZES * least => Self::Along(half(greatest)),
            None => Self::Whole,
        }
    }

    /// Window of a frame with the given embedding.
    pub fn window(self, embedding: &Embedding) -> Window {
        let bounds = embedding.bounds();
        let centre: DVec2 = bounds.middle();
        match self {
            Self::Fixed(window) => window,
            Self::Along(half) => Window { centre, half },
            Self::Whole => Window { centre, half: (0.5 + MARGIN) * bounds.size().max_element().max(f64::MIN_POSITIVE) },
        }
    }
}
