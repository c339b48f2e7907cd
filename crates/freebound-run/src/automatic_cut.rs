//! Cutting of a mesh along automatic seams.

use super::Model;
use freebound_core::cutting::SeamOptions;
use freebound_core::pipeline::SeamReport;
use freebound_core::problem::{Control, SolveError};

/// Options of the search for automatic seams.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AutomaticCut {
    /// Bound on the mean symmetric Dirichlet energy of each part; 4 is an isometric map. Default:
    /// [`SeamOptions::DISTORTION`], or none for a disk without holes.
    pub distortion: Option<f64>,
    /// Most charts. Default: no limit.
    pub most_charts: Option<usize>,
    /// Weight of what a seam shows, from 0 to 1. Default: [`SeamOptions::VISIBILITY`].
    pub visibility: Option<f64>,
}

impl Model {
    /// Model that is cut along automatic seams. `self` is prepared, and cut along shortest paths if it is cut at all. A
    /// plain disk is cut only if a bound is given. `report` receives each improvement of a part.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn cut_automatically(
        self,
        options: AutomaticCut,
        control: Control<'_>,
        report: SeamReport<'_>,
    ) -> Result<Self, SolveError> {
        let usual = (!self.prepared.is_plain_disk()).then_some(SeamOptions::DISTORTION);
        let Some(bound) = options.distortion.or(usual) else { return Ok(self) };
        let visibility = options.visibility.unwrap_or(SeamOptions::VISIBILITY);
        let most_charts = options.most_charts;
        let seam_options = SeamOptions { most_charts, visibility, ..SeamOptions::new(bound) };
        let seams = self.find_seams(&self.prepared.form, seam_options, control, report)?;
        Ok(self.cut_along(seams))
    }
}
