//! Colours and type sizes: the only place for every colour on the screen.

use eframe::egui;
use eframe::egui::{Color32, CornerRadius, FontDefinitions, FontFamily, FontId, Stroke, TextStyle, Visuals};

use crate::view::{Palette, Srgb};

/// Height of the bar at the top, points.
pub const TOP_HEIGHT: f32 = 30.0;
/// Height of the bar at the bottom, points.
pub const BOTTOM_HEIGHT: f32 = 24.0;
/// Initial width of the panels at the right, points.
pub const PANEL_WIDTH: f32 = 280.0;
/// Limits of the width of the panels at the right, points.
pub const PANEL_WIDTHS: egui::Rangef = egui::Rangef { min: 220.0, max: 420.0 };

/// Colours of a theme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theme {
    /// Words and marks of flipped faces and of failures.
    pub flipped: Color32,
    /// A boundary crossing.
    pub crossing: Color32,
    /// A concave polygon.
    pub concave: Color32,
    /// An overwound vertex.
    pub overwound: Color32,
    /// A vertex outside the hull of its neighbours.
    pub outside_hull: Color32,
    /// A pin.
    pub pin: Color32,
    /// Constraint, its line and its residual.
    pub constraint: Color32,
    /// Element that is selected or under the pointer.
    pub selection: Color32,
    /// Outline of charts that are selected or under the pointer.
    pub selection_line: Srgb,
    /// Planar embedding, proved.
    pub planar: Color32,
    /// A constraint that a planar embedding does not meet.
    pub unmet: Color32,
    /// State that is not up to date.
    pub stale: Color32,
    /// Accent colour of controls.
    pub accent: Color32,
    /// Background of the panes.
    pub background: Color32,
    /// Background of the panels.
    pub panel: Color32,
    /// Text.
    pub text: Color32,
    /// Text of less weight.
    pub weak_text: Color32,
    /// Thin separator lines.
    pub separator: Color32,
    /// Line of the boundary.
    pub boundary: Srgb,
    /// Seams of the mesh.
    pub seam: Srgb,
    /// Edges that automatic seams avoid.
    pub kept_whole: Srgb,
    /// Seams that the mesh is not cut along yet.
    pub seam_to_be: Srgb,
    /// Outline of the compared step.
    pub ghost: Srgb,
    /// Hull of a virtual boundary.
    pub hull: Srgb,
    /// Edges of the pockets between boundary and hull.
    pub pocket: Srgb,
    /// Faces of the pockets: one quarter of the colour as screens blend it. The graphics card blends linear light, so
    /// its alpha differs.
    pub pocket_fill: Srgb,
    /// Colours that the graphics card draws with.
    pub palette: Palette,
}

/// Colour of a scale.
pub const fn rgb([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// The light theme.
pub const LIGHT: Theme = theme(Column(egui::Theme::Light));

/// The dark theme.
pub const DARK: Theme = theme(Column(egui::Theme::Dark));

/// Column of the table of colours: light or dark.
#[derive(Clone, Copy)]
struct Column(egui::Theme);

impl Column {
    const fn of<T: Copy>(self, light: T, dark: T) -> T {
        match self.0 {
            egui::Theme::Light => light,
            egui::Theme::Dark => dark,
        }
    }

    /// Colour from `0xRRGGBB`.
    const fn srgb(self, light: u32, dark: u32) -> Srgb {
        Srgb::from_hex(self.of(light, dark))
    }

    const fn colour(self, light: u32, dark: u32) -> Color32 {
        on_screen(self.srgb(light, dark))
    }
}

/// Colour of the graphics card as an opaque colour of egui.
pub(super) const fn on_screen(Srgb([r, g, b, _]): Srgb) -> Color32 {
    rgb([r, g, b])
}

/// Table of all colours, light and dark.
const fn theme(tone: Column) -> Theme {
    let selection = tone.srgb(0x00E0_A100, 0x00FF_D24A);
    let pocket = tone.srgb(0x003F_A34D, 0x0058_C46B);
    let palette = Palette {
        background: tone.srgb(0x00F4_F4F2, 0x001E_1F22),
        grid: tone.srgb(0x00D9_D9D5, 0x0034_363B),
        unit_square: tone.srgb(0x008C_8C88, 0x0074_777E),
        clay: tone.srgb(0x00D8_D4CC, 0x00B9_B4AA),
        clay_back: tone.srgb(0x00A9_A39A, 0x006F_6A63),
        plane_face: tone.srgb(0x00D8_D4CC, 0x008B_877F),
        overlap: tone.srgb(0x004A_4640, 0x0026_241F),
        checker: [tone.srgb(0x00F1_EEE8, 0x00D6_D1C7), tone.srgb(0x008F_A3B8, 0x0053_687F)],
        wire: tone.srgb(0x002A_2A2A, 0x0010_1010).with_alpha(tone.of(130, 140)),
        wire_light: tone.srgb(0x00FF_FFFF, 0x00F4_F4F0),
        flipped: tone.srgb(0x00D9_2D3A, 0x00FF_5A64),
    };
    Theme {
        // Darker or lighter than the faces, so that words are legible.
        flipped: tone.colour(0x00B8_222E, 0x00FF_7A82),
        crossing: tone.colour(0x00E8_700A, 0x00FF_9A3D),
        concave: tone.colour(0x006E_7B00, 0x00D4_E157),
        overwound: tone.colour(0x00C0_26A8, 0x00F0_6BD8),
        outside_hull: tone.colour(0x008A_5A2B, 0x00D9_A878),
        pin: tone.colour(0x002F_5BD8, 0x007B_9BFF),
        constraint: tone.colour(0x0000_8FA3, 0x002B_D4E6),
        selection: on_screen(selection),
        selection_line: selection,
        planar: tone.colour(0x001A_6B3B, 0x004A_CB80),
        unmet: tone.colour(0x006B_4FBB, 0x00B3_9DFF),
        stale: tone.colour(0x0080_5500, 0x00F0_B43C),
        accent: tone.colour(0x002F_5BD8, 0x007B_9BFF),
        background: on_screen(palette.background),
        panel: tone.colour(0x00FB_FBFA, 0x0026_272B),
        text: tone.colour(0x0022_2426, 0x00E4_E4E2),
        weak_text: tone.colour(0x005A_5D60, 0x00A9_ACB1),
        separator: tone.colour(0x00DD_DDD9, 0x0038_3A3F),
        boundary: tone.srgb(0x003A_3A38, 0x00EC_ECE8),
        seam: tone.srgb(0x00B0_006D, 0x00FF_6FB5),
        kept_whole: tone.srgb(0x0010_8A4A, 0x004A_D991),
        seam_to_be: tone.srgb(0x002F_5BD8, 0x007B_9BFF),
        ghost: tone.srgb(0x006F_8CE4, 0x006F_8BEA),
        hull: tone.srgb(0x00C9_3A3A, 0x00FF_7070),
        pocket: pocket.with_alpha(tone.of(170, 110)),
        pocket_fill: pocket.with_alpha(tone.of(78, 24)),
        palette,
    }
}

/// Share of its colour in the background of a chip, and under the pointer.
pub(super) const CHIP: f32 = 0.10;
pub(super) const CHIP_HOVERED: f32 = 0.16;

/// Share of the accent in the background of a row or a tool under the pointer, and of a selected one.
pub(super) const HOVERED: f32 = 0.10;
pub(super) const SELECTED: f32 = 0.15;

/// Active theme.
pub fn theme_of(ui: &egui::Ui) -> &'static Theme {
    if ui.visuals().dark_mode { &DARK } else { &LIGHT }
}

/// Installs both themes, type sizes and spacing in egui. Call once at the start.
pub fn install(context: &egui::Context) {
    let mut fonts = FontDefinitions::default();
    // The font of words has no arrows, and few marks of formulas.
    fonts.families.entry(FontFamily::Proportional).or_default().push("Hack".to_owned());
    context.set_fonts(fonts);
    context.set_visuals_of(egui::Theme::Light, visuals(&LIGHT, Visuals::light()));
    context.set_visuals_of(egui::Theme::Dark, visuals(&DARK, Visuals::dark()));
    context.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Small, FontId::new(11.0, FontFamily::Proportional)),
            (TextStyle::Body, FontId::new(13.0, FontFamily::Proportional)),
            (TextStyle::Button, FontId::new(13.0, FontFamily::Proportional)),
            (TextStyle::Heading, FontId::new(13.0, FontFamily::Proportional)),
            (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
        ]
        .into();
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(8.0, 3.0);
        style.spacing.interact_size = egui::vec2(32.0, 22.0);
        style.spacing.slider_width = 120.0;
        style.interaction.tooltip_delay = 0.4;
    });
}

fn visuals(theme: &Theme, base: Visuals) -> Visuals {
    let mut visuals = base;
    visuals.panel_fill = theme.panel;
    visuals.window_fill = theme.panel;
    visuals.extreme_bg_color = theme.background;
    visuals.override_text_color = Some(theme.text);
    visuals.hyperlink_color = theme.accent;
    visuals.selection.bg_fill = theme.accent.gamma_multiply(0.28);
    visuals.selection.stroke = Stroke::new(1.0, theme.accent);
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, theme.separator);
    visuals.window_stroke = Stroke::new(1.0, theme.separator);
    let widgets = &mut visuals.widgets;
    // The title of an open menu, and of a window.
    widgets.open.weak_bg_fill = theme.text.gamma_multiply(0.14);
    widgets.open.bg_fill = widgets.open.weak_bg_fill;
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(4);
    }
    visuals
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Least contrast of words, WCAG 2.2 level AA.
    const LEAST: f64 = 4.5;

    /// Relative luminance of a colour, WCAG 2.2.
    fn luminance(colour: Color32) -> f64 {
        let [r, g, b, _] = Srgb(colour.to_array()).to_linear().map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let [a, b] = [luminance(a), luminance(b)];
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// Background under a translucent tint.
    fn tinted(below: Color32, tint: Color32, share: f64) -> Color32 {
        let mix = |below: u8, tint: u8| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
            let mixed = (f64::from(below) * (1.0 - share) + f64::from(tint) * share).round() as u8;
            mixed
        };
        let ([r, g, b, _], [r2, g2, b2, _]) = (below.to_array(), tint.to_array());
        Color32::from_rgb(mix(r, r2), mix(g, g2), mix(b, b2))
    }

    #[test]
    fn words_stand_out_from_panels_panes_chips_and_marked_rows_in_both_themes() {
        for theme in [&LIGHT, &DARK] {
            let signs = [theme.planar, theme.flipped, theme.unmet, theme.stale];
            let plain = [theme.panel, theme.background];
            let rows = [HOVERED, SELECTED].map(|share| tinted(theme.panel, theme.accent, share.into()));
            for words in signs.into_iter().chain([theme.text, theme.weak_text]) {
                for below in plain.into_iter().chain(rows) {
                    let found = contrast(words, below);
                    assert!(found >= LEAST, "{words:?} on {below:?}: {found:.2}");
                }
            }
            for (words, share) in signs.into_iter().flat_map(|sign| [(sign, CHIP), (sign, CHIP_HOVERED)]) {
                let found = contrast(words, tinted(theme.panel, words, share.into()));
                assert!(found >= LEAST, "{words:?} in its chip: {found:.2}");
            }
        }
    }

    #[test]
    fn the_contrast_of_black_on_white_is_that_of_the_standard() {
        assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-6);
    }
}
