//! Checker over the plane, in both panes, for one chart and for the page.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::async_scene::AsyncScene;
use super::scene::PlaneScene;
use crate::session::{JobFailure, KeptChecker, Wake};
use crate::ui::state::{CheckerRequest, CheckerStyle, SQUARES, nearest_squares};
use crate::view::PictureQuad;
use freebound_io::figure::chessboard;
use freebound_io::{PictureError, PictureFile};

/// Number of squares across one chart, unless the user chooses it.
pub(super) const ACROSS_CHART: u32 = 40;

/// Number of squares along the height of the page, unless the user chooses it.
pub(super) const ALONG_PAGE: u32 = 64;

/// Number of squares with letters and of those of a picture, unless the user chooses it: large enough to be read.
const LEGIBLE: u32 = 16;

/// Side of a square with letters, pixels.
const SQUARE_PIXELS: u32 = 128;

/// Result of a job: a tile, or the fault of the file.
type Tile = Result<Option<PictureQuad>, PictureError>;

/// Checker over the plane.
#[derive(Debug)]
pub struct Checker {
    style: CheckerStyle,
    /// Squares along the page, if the user has chosen their number.
    squares: Option<u32>,
    /// Picture that the user chose.
    picture: Option<PathBuf>,
    /// Tile of the chosen squares, once it is ready, with the style and the file that it was made for.
    tile: Option<(TileKey, Arc<PictureQuad>)>,
    job: AsyncScene<TileKey, Tile>,
    /// Side of a square in the plane of one chart, with its mesh and the chosen number of squares.
    check: Option<(u64, Option<u32>, f64)>,
}

/// Style and file of a tile.
type TileKey = (CheckerStyle, Option<PathBuf>);

impl Checker {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            style: CheckerStyle::Plain,
            squares: None,
            picture: None,
            tile: None,
            job: AsyncScene::new("checker", wake),
            check: None,
        }
    }

    /// Chosen squares.
    pub fn style(&self) -> CheckerStyle {
        self.style
    }

    /// Number of squares along the page, if the user has chosen it.
    pub fn squares(&self) -> Option<u32> {
        self.squares
    }

    /// Number of squares by the style, unless the user has chosen it. `None`: plain squares of their usual size.
    pub(in crate::ui) fn wanted_squares(&self) -> Option<u32> {
        self.squares.or((self.style != CheckerStyle::Plain).then_some(LEGIBLE))
    }

    /// Tile of the chosen squares. `None` for plain squares, and while the tile is being made.
    pub(in crate::ui) fn tile(&self) -> Option<Arc<PictureQuad>> {
        let (key, tile) = self.tile.as_ref()?;
        (*key == self.key() && self.style != CheckerStyle::Plain).then(|| Arc::clone(tile))
    }

    fn key(&self) -> TileKey {
        (self.style, self.picture.clone().filter(|_| self.style == CheckerStyle::Picture))
    }

    /// True while the tile is being made.
    pub fn is_making(&self) -> bool {
        self.job.is_busy()
    }

    /// Side of a square in the plane of one chart.
    pub fn check_size(&self) -> f64 {
        self.check.map_or(1.0, |(.., side)| side)
    }

    /// Chooses the size of the squares for an embedding. Keeps the size while it is within a factor of 2 of the wanted
    /// one, so that steps are comparable. Keeps it in any case while steps are played. Call once per frame.
    pub(super) fn refresh_size(&mut self, plane: &PlaneScene, is_playing: bool) {
        let (model, squares) = (plane.mesh.model_revision, self.wanted_squares());
        let wanted = plane.arrays.bounds.extent() / f64::from(squares.unwrap_or(ACROSS_CHART));
        let is_right = |side: f64| (0.5..=2.0).contains(&(wanted / side));
        let is_due = |&(of, count, side): &(u64, Option<u32>, f64)| {
            of != model || count != squares || !(is_playing || is_right(side))
        };
        if self.check.as_ref().is_none_or(is_due) {
            self.check = Some((model, squares, wanted));
        }
    }

    /// Failure of the job, returned once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// Makes the tile in the background. Returns the fault of the user's picture. Call once per frame.
    pub(super) fn refresh_tile(&mut self) -> Option<PictureError> {
        let mut fault = None;
        match self.job.poll() {
            Some((key, Ok(Some(tile)))) => self.tile = Some((key, Arc::new(tile))),
            Some((_, Ok(None))) => self.style = CheckerStyle::Plain,
            Some((_, Err(error))) => {
                self.style = CheckerStyle::Plain;
                fault = Some(error);
            }
            None => {}
        }
        let key = self.key();
        if self.style != CheckerStyle::Plain && self.tile.as_ref().is_none_or(|(of, _)| *of != key) {
            let path = key.1.clone();
            self.job.make(key, move |_| tile_of(path.as_deref()));
        }
        fault
    }

    /// Changes the squares. `shown` is the number of squares on the screen.
    pub(super) fn change(&mut self, request: CheckerRequest, shown: u32) {
        let [least, most] = SQUARES;
        match request {
            CheckerRequest::SetStyle(style) => self.style = style,
            CheckerRequest::SetSquares(squares) => self.squares = squares.map(nearest_squares),
            CheckerRequest::Finer => self.squares = Some((1 << (shown.ilog2() + 1)).min(most)),
            CheckerRequest::Coarser => self.squares = Some((shown.next_power_of_two() / 2).max(least)),
        }
    }

    /// Repeats a picture over the plane.
    pub(super) fn open(&mut self, path: PathBuf) {
        // A file that was read before may have changed.
        self.tile = None;
        (self.style, self.picture) = (CheckerStyle::Picture, Some(path));
    }

    /// Checker of an earlier run.
    pub(super) fn put_on(&mut self, kept: &KeptChecker) {
        self.squares = kept.squares.map(nearest_squares);
        self.picture.clone_from(&kept.picture);
        let style = CheckerStyle::called(&kept.style).unwrap_or_default();
        self.style = if style == CheckerStyle::Picture && self.picture.is_none() { CheckerStyle::Plain } else { style };
    }

    /// Checker to be kept for the next run.
    pub(super) fn kept(&self) -> KeptChecker {
        KeptChecker { style: self.style.words()[0].to_owned(), squares: self.squares, picture: self.picture.clone() }
    }
}

/// Tile from a file, or the chessboard.
fn tile_of(path: Option<&Path>) -> Tile {
    let picture = match path {
        Some(path) => PictureFile::read(path)?.pixels,
        None => Arc::new(chessboard(SQUARE_PIXELS)),
    };
    Ok(PictureQuad::new(picture))
}
