//! Settings of the window kept between runs: theme, wireframe, shading, width of the panels, size of the window.

use eframe::egui::{Theme, ThemePreference};

use super::Editor;
use crate::session::Preferences;
use crate::ui::key_map::KeyMap;
use crate::ui::state::Pane;

impl Editor {
    /// Current settings of the window, to be kept.
    pub(crate) fn preferences(&self) -> Preferences {
        let context = self.gpu.context();
        let dark = match context.options(|options| options.theme_preference) {
            ThemePreference::System => None,
            ThemePreference::Dark => Some(true),
            ThemePreference::Light => Some(false),
        };
        let shading = |pane| self.pane_shading.own_shading(pane).map(|shading| shading.title().to_owned());
        let size = context.content_rect().size() * context.zoom_factor();
        Preferences {
            dark,
            wireframe: self.pane_shading.wireframe,
            mesh_shading: shading(Pane::Mesh),
            plane_shading: shading(Pane::Plane),
            panel_width: Some(self.layout.panel_width()),
            window_size: Some([size.x, size.y]),
            no_welcome: !self.layout.welcome.at_start,
            folders: self.files.dialogs.folders.clone(),
            keys: KeyMap::of(context).written(),
            recent_commands: self.layout.help.recent.clone(),
            checker: self.pane_shading.checker.kept(),
        }
    }

    /// Restores the settings of the window from an earlier run. The window's size is restored when it opens.
    pub(crate) fn put_on(&mut self, left: &Preferences) {
        if let Some(dark) = left.dark {
            self.gpu.context().set_theme(if dark { Theme::Dark } else { Theme::Light });
        }
        self.layout.welcome.at_start = !left.no_welcome;
        self.files.dialogs.folders.clone_from(&left.folders);
        self.layout.help.recent.clone_from(&left.recent_commands);
        KeyMap::read(&left.keys).put_on(self.gpu.context());
        self.pane_shading.wireframe = left.wireframe;
        self.pane_shading.checker.put_on(&left.checker);
        for (pane, name) in Pane::BOTH.into_iter().zip([&left.mesh_shading, &left.plane_shading]) {
            self.pane_shading.keep_own_shading(pane, name.as_deref());
        }
        if let Some(width) = left.panel_width {
            self.layout.set_panel_width(width);
        }
    }
}
