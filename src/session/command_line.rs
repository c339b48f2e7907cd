//! Command line that makes the map of a document, for a shell.

use std::path::{Path, PathBuf};

use super::{ChartLayout, Document, Model};
use freebound_core::geom::VAxis;
use freebound_core::mesh::{HoleTreatment, Repairs};
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{BoundaryShape, Growth, Method, NamedOption, PinKind, Settings, Spacing, Start};
use freebound_run::MethodOption;

/// Greatest number of pins that are written into the command. More pins need a file.
const MOST_PINS: usize = 20;

/// Command line of a document, with what it does not express.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommandLine {
    words: Vec<String>,
    remarks: Vec<String>,
}

impl CommandLine {
    /// Command line of a document on its mesh, with the size of coordinates in files.
    pub fn of(document: &Document, model: &Model, fit: Fit) -> Self {
        let mut line = Self { words: vec!["freebound".to_owned(), "flatten".to_owned()], remarks: Vec::new() };
        let stem = Path::new(&model.name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = model.path.as_ref().and_then(|path| path.parent()).unwrap_or(Path::new("")).to_owned();
        let beside = |ending: &str| path_words(&folder.join(format!("{stem}{ending}")));
        if let Some(path) = &model.path {
            line.words.push(path_words(path));
        } else {
            line.words.push(path_words(&PathBuf::from(format!("{stem}.obj"))));
            line.remark("The mesh has no file: write it first, by File, Export");
        }
        line.option("-o", beside("-flat.obj"));
        line.add_form(document, beside(".edges"));
        line.add_method(&document.settings);
        line.add_settings(document, model);
        line.add_picture(document);
        line.add_pins(document, model, beside("-constraints.txt"));
        if fit != Fit::default() {
            line.option("--fit", fit.name());
        }
        line.add_limits(document);
        line
    }

    fn option(&mut self, name: &str, value: impl Into<String>) {
        self.words.extend([name.to_owned(), value.into()]);
    }

    fn remark(&mut self, words: impl Into<String>) {
        self.remarks.push(words.into());
    }

    /// Adds a remark on a map that the command does not make.
    #[must_use]
    pub fn with_remark(mut self, words: impl Into<String>) -> Self {
        self.remark(words);
        self
    }

    /// Words of the command, unquoted.
    pub fn words(&self) -> &[String] {
        &self.words
    }

    /// Text for a shell: remarks as comments, then the command.
    pub fn text(&self) -> String {
        let remarks = self.remarks.iter().map(|remark| format!("# {remark}.\n"));
        let words = self.words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ");
        remarks.collect::<String>() + &words + "\n"
    }

    /// Adds the preparation of the mesh.
    fn add_form(&mut self, document: &Document, edges: String) {
        let form = &document.form;
        if form.repair != Repairs::default() {
            self.option("--repair", form.repair.to_string());
        }
        if let Some(distance) = form.repair.weld_distance() {
            self.option("--weld", format!("{:?}", distance.get()));
        }
        if form.holes == HoleTreatment::Cut {
            self.option("--holes", "cut");
        }
        if !form.seams.edges().is_empty() || !form.seams.automatic().is_empty() {
            self.remark(format!("Write the seams to {edges} first, by Edit, Seams, Export seams"));
            self.option("--cut", edges);
        } else if form.cut {
            self.option("--cut", "shortest");
        }
        if form.seams.of_texture {
            self.option("--charts", "uv");
        }
    }

    /// Adds the method with its weights and shape.
    fn add_method(&mut self, settings: &Settings) {
        let method = &settings.method;
        if *method != Method::default() {
            self.option("--method", method.name());
        }
        if let Some(shape) = method.boundary_shape().filter(|shape| **shape != BoundaryShape::default()) {
            self.option("--boundary", shape.written());
        }
        if let Some(family) = settings.family.filter(|_| MethodOption::Family.unused_by(method).is_none()) {
            self.option("--family", family.to_string());
        }
    }

    /// Adds the settings that the method uses and that differ from the defaults.
    fn add_settings(&mut self, document: &Document, model: &Model) {
        let settings = &document.settings;
        let used = |option: MethodOption| option.unused_by(&settings.method).is_none();
        if settings.spacing != Spacing::default() && used(MethodOption::Spacing) {
            self.option("--spacing", settings.spacing.name());
        }
        if settings.layers != Settings::LAYERS && used(MethodOption::Layers) {
            self.option("--layers", settings.layers.to_string());
        }
        if let Some(treatment) = settings.treatment.filter(|_| used(MethodOption::Treatment)) {
            self.option("--treatment", treatment.name());
        }
        if let Some(steps) = settings.max_steps.filter(|_| used(MethodOption::MaxSteps)) {
            self.option("--max-steps", steps.to_string());
        }
        if !settings.new_vertices && used(MethodOption::NewVertices) {
            self.words.push("--no-new-vertices".to_owned());
        }
        if settings.growth != Growth::default() && used(MethodOption::Growth) {
            self.option("--growth", settings.growth.name());
        }
        if settings.start == Start::File && used(MethodOption::Start) {
            self.option("--start", model.layout_file.as_ref().map_or("uv".to_owned(), |layout| layout.path.clone()));
        }
        if let Some(rounds) = settings.relax_rounds.or(Some(document.relaxed).filter(|&rounds| rounds > 0)) {
            self.option("--relax", rounds.to_string());
        }
        if document.relaxed > 0 && settings.relax_rounds.is_none() {
            self.remark("The window relaxed the finished map; --relax sets the rounds of the whole run");
        }
    }

    /// Adds the picture, or its aspect ratio.
    fn add_picture(&mut self, document: &Document) {
        let file = document.picture.as_ref().and_then(|picture| picture.path.as_ref());
        let aspect = document.picture.as_ref().map(|picture| picture.aspect()).or(document.aspect);
        match (file, aspect) {
            (Some(path), _) => self.option("--picture", path_words(path)),
            (None, Some(aspect)) => self.option("--aspect", format!("{aspect:?}:1")),
            (None, None) => {}
        }
        if document.v_axis == VAxis::Down {
            self.remark("v points down in the window; the command takes v upwards, so the map is turned over");
        }
    }

    fn add_pins(&mut self, document: &Document, model: &Model, file: String) {
        let targets = document.all_pins(model).targets;
        if targets.is_empty() || MethodOption::Pins.unused_by(&document.settings.method).is_some() {
            return;
        }
        if targets.len() > MOST_PINS {
            self.remark(format!("Write the constraints to {file} first, by File, Export constraints"));
            return self.option("--constraints", file);
        }
        for (vertex, Target { uv, kind }) in &targets {
            let weight = if let PinKind::Soft(weight) = kind { format!(":{weight:?}") } else { String::new() };
            self.option("--pin", format!("{}:{:?},{:?}{weight}", vertex.number(), uv.x, uv.y));
        }
    }

    /// Adds remarks on edits that no option expresses.
    fn add_limits(&mut self, document: &Document) {
        let form = &document.form;
        let limits = [
            (form.faces_turned, "The window reversed the faces; no option does that"),
            (!form.left_out.is_empty(), "The window left out parts: choose the others with --parts"),
            (
                document.layout != ChartLayout::default(),
                "Places, locks and stacks of charts on the page are not expressed",
            ),
            (
                document.elsewhere.values().any(|edits| edits.relaxed > 0),
                "Relaxing of single charts is not expressed: --relax holds for all",
            ),
        ];
        for (_, words) in limits.into_iter().filter(|(is_so, _)| *is_so) {
            self.remark(words);
        }
    }
}

/// Path as an argument: a name that begins with a dash is no option.
fn path_words(path: &Path) -> String {
    let words = path.to_string_lossy().into_owned();
    if words.starts_with('-') { format!("./{words}") } else { words }
}

/// Word quoted for a POSIX shell, if it needs quotes.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,+%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_split_or_expand_them() {
        for (word, expected) in [
            ("mesh.obj", "mesh.obj"),
            ("my mesh.obj", "'my mesh.obj'"),
            ("a'b", r"'a'\''b'"),
            ("$HOME", "'$HOME'"),
            ("", "''"),
            ("polygon:0 0; 1 0", "'polygon:0 0; 1 0'"),
        ] {
            assert_eq!(quoted(word), expected);
        }
        assert_eq!(path_words(Path::new("-o.obj")), "./-o.obj");
    }
}
