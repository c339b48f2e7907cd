//! Grade of the map beside the verdict: how well it serves, whether or not it is proved.
//!
//! The energy is the mean symmetric Dirichlet energy: 4 for a map that changes no lengths, and more for any distortion.

use eframe::egui::{self, RichText, Role};

use super::advice::ratio_words;
use crate::session::{Action, Status};
use crate::ui::icons::{self, Sign};
use crate::ui::theme::CHIP_HOVERED;
use crate::ui::{Control, Editor, GOOD_ENERGY, Measure, Request, ShadingMode, short, theme_of, with_keys_set};
use freebound_core::pipeline::Outcome;
use freebound_core::verify::DistortionSummary;

/// Mean energy of a chart up to which the map of all charts is good.
const GOOD_CHART: f64 = 4.5;

/// Mean energy up to which a map is fair.
const FAIR: f64 = 5.0;

/// Width of the window from which the grade has words, points.
const ROOMY: f32 = 1000.0;

/// Side of the sign, points.
const SIGN: f32 = 10.0;

/// Grade of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Grade {
    Good,
    Fair,
    Poor,
}

impl Grade {
    const fn title(self) -> &'static str {
        ["Good", "Fair", "Poor"][self as usize]
    }

    const fn sign(self) -> Sign {
        match self {
            Self::Good => Sign::Good,
            Self::Fair => Sign::Warning,
            Self::Poor => Sign::Bad,
        }
    }
}

/// Distortion of all faces that the embedding pane shows.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quality {
    /// Mean energy over the surface.
    energy: f64,
    /// Chart with the greatest mean energy, and that energy, if there are several charts.
    worst: Option<(usize, f64)>,
    /// Greatest ratio of a face's area in the plane to its area on the surface, or the other way round, at equal areas
    /// of its chart.
    area_ratio: f64,
    /// Ratio of the greatest texel density of a chart to the least, if there are several charts.
    density_ratio: Option<f64>,
}

impl Quality {
    fn of_outcome(outcome: &Outcome) -> Self {
        let DistortionSummary { symmetric_dirichlet, area, .. } = outcome.distortion.summary;
        Self { energy: symmetric_dirichlet.mean, worst: None, area_ratio: area.max, density_ratio: None }
    }

    /// Quality of the map that the embedding pane shows, once it is up to date.
    fn of(editor: &Editor) -> Option<Self> {
        let session = &editor.session;
        if !editor.shows_page() {
            let is_at_rest = matches!(session.status(), Status::Held | Status::Current);
            let step = editor.step_on_screen().filter(|_| is_at_rest && !editor.plane.is_moving(session))?;
            return Some(Self::of_outcome(step));
        }
        let page = session.page().filter(|page| page.is_planar.is_some() && session.can_move_charts())?;
        let of_chart = |chart: &crate::session::PageChart| {
            (chart.model.disk().map_or(0.0, |disk| disk.area()), Self::of_outcome(&chart.outcome))
        };
        let charts: Vec<(f64, Self)> = page.charts.iter().map(of_chart).collect();
        let total: f64 = charts.iter().map(|(area, _)| area).sum();
        let energy = charts.iter().map(|(area, own)| area * own.energy).sum::<f64>() / total;
        let worst = charts.iter().map(|(_, own)| own.energy).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let area_ratio = charts.iter().map(|(_, own)| own.area_ratio).fold(1.0, f64::max);
        let densities = session.newest_atlas().map_or(&[] as &[f64], |atlas| &atlas.densities);
        let [least, most] = densities
            .iter()
            .filter(|density| density.is_finite() && **density > 0.0)
            .fold([f64::INFINITY, 0.0_f64], |[least, most], &density| [least.min(density), most.max(density)]);
        Some(Self { energy, worst, area_ratio, density_ratio: (most > 0.0).then_some(most / least) })
    }

    fn grade(&self) -> Grade {
        let worst = self.worst.map_or(self.energy, |(_, energy)| energy);
        let is_even = self.area_ratio < DistortionSummary::BAD_RATIO_OF_AREAS;
        match self.energy {
            energy if energy <= GOOD_ENERGY && worst <= GOOD_CHART && is_even => Grade::Good,
            energy if energy <= FAIR && is_even => Grade::Fair,
            _ => Grade::Poor,
        }
    }

    /// Numbers and remedy, for the tooltip.
    fn tip(&self) -> String {
        let mut lines = vec![
            format!("Mean energy {}: below {GOOD_ENERGY} is good", short(self.energy)),
            Measure::Energy.tip().to_owned(),
        ];
        lines.extend(self.worst.map(|(chart, energy)| format!("Worst chart: {chart}, with energy {}", short(energy))));
        let ratio = if self.area_ratio < 10.0 { short(self.area_ratio) } else { ratio_words(self.area_ratio) };
        lines.push(format!("Areas of faces differ up to {ratio} : 1"));
        lines.extend(self.density_ratio.map(|ratio| format!("Texel densities differ up to {} : 1", short(ratio))));
        if self.grade() != Grade::Good {
            lines.push("Relax (R) lowers it; Unwrap with more seams (U) lowers it further".to_owned());
        }
        lines.push("Click to colour the faces by their areas".to_owned());
        lines.join("\n")
    }
}

/// Shows the grade of the map.
pub(super) fn quality(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(quality) = Quality::of(editor).filter(|_| editor.busy_for_long().is_none()) else { return };
    let (grade, number) = (quality.grade(), short(quality.energy));
    let is_roomy = ui.ctx().content_rect().width() >= ROOMY;
    let words =
        if is_roomy { format!("{} · energy {number}", grade.title()) } else { format!("{} {number}", grade.title()) };
    let theme = theme_of(ui);
    let colour = grade.sign().colour(theme);
    let text = egui::WidgetText::from(RichText::new(&words).color(colour));
    let galley = text.into_galley(ui, None, f32::INFINITY, egui::TextStyle::Body);
    let size = galley.size() + egui::vec2(16.0 + SIGN + 6.0, 6.0);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, rect.height() / 2.0, colour.gamma_multiply(CHIP_HOVERED));
    }
    let at = rect.left_center() + egui::vec2(8.0 + SIGN / 2.0, 0.0);
    icons::sign(ui.painter(), egui::Rect::from_center_size(at, egui::Vec2::splat(SIGN)), grade.sign(), theme);
    let at = egui::pos2(at.x + SIGN / 2.0 + 6.0, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, colour);
    let response =
        response.named(Role::Button, &format!("Quality: {}, energy {}", grade.title(), short(quality.energy)));
    let tip = with_keys_set(ui.ctx(), &quality.tip(), ["(", "R", ")"], &Action::Relax.into());
    let tip = with_keys_set(ui.ctx(), &tip, ["(", "U", ")"], &Action::Unwrap(None).into());
    response.on_hover_text(tip).asks(Request::SetShading(ShadingMode::Area), requests);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grade(energy: f64, worst: Option<f64>, area_ratio: f64) -> Grade {
        Quality { energy, worst: worst.map(|energy| (3, energy)), area_ratio, density_ratio: None }.grade()
    }

    #[test]
    fn a_map_with_a_useless_face_or_energy_is_never_good() {
        assert_eq!(grade(4.05, None, 1.5), Grade::Good);
        assert_eq!(grade(4.05, Some(4.4), 1.5), Grade::Good);
        assert_eq!(grade(4.05, Some(4.6), 1.5), Grade::Fair);
        assert_eq!(grade(4.3, None, 1.5), Grade::Fair);
        assert_eq!(grade(5.1, None, 1.5), Grade::Poor);
        for bad in [5e9, 100.0, f64::INFINITY, f64::NAN] {
            assert_eq!(grade(4.0, None, bad), Grade::Poor);
            assert_eq!(grade(bad, None, 1.0), Grade::Poor);
        }
    }
}
