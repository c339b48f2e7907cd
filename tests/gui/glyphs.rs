//! Every character that the window may show has a glyph; a missing one appears as a box.

use std::collections::BTreeSet;
use std::path::Path;

use eframe::egui;
use egui::FontId;

/// Characters outside ASCII in string literals of a source file.
fn characters_shown(path: &Path) -> BTreeSet<char> {
    let text = std::fs::read_to_string(path).unwrap();
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.flat_map(|line| line.chars().collect::<Vec<_>>()).filter(|c| !c.is_ascii()).collect()
}

fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_character_on_the_screen_has_a_glyph() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![root.join("src/examples.rs")];
    for folder in ["src/ui", "src/session", "crates/freebound-core/src", "crates/freebound-io/src"] {
        sources(&root.join(folder), &mut files);
    }
    let context = egui::Context::default();
    let mut missing = Vec::new();
    // Fonts are available from the first pass on.
    let mut output = context.run_ui(egui::RawInput::default(), |ui| {
        let font = FontId::proportional(13.0);
        for file in &files {
            for character in characters_shown(file) {
                if !ui.ctx().fonts_mut(|fonts| fonts.has_glyph(&font, character)) {
                    missing.push((file.file_name().unwrap().to_owned(), character));
                }
            }
        }
    });
    output.textures_delta.clear();
    assert!(missing.is_empty(), "{missing:?}");
}
