//! Schema of reports, `docs/report.schema.json`, against written reports. Every written field is described, every
//! required field is present, and every described field is written by some run.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use freebound_core::geom::Picture;
use freebound_io::raster::write_png;
use serde_json::Value;

use super::program::Program;

/// Keywords of the schemas; a keyword missing here would be ignored silently.
const KEYWORDS: [&str; 15] = [
    "$defs",
    "$ref",
    "$schema",
    "additionalProperties",
    "const",
    "description",
    "enum",
    "items",
    "maxItems",
    "minItems",
    "minimum",
    "oneOf",
    "properties",
    "required",
    "title",
];

/// Schema, and the fields encountered so far.
pub(crate) struct Schema {
    root: Value,
    met: BTreeSet<String>,
}

impl Schema {
    pub(crate) fn of_reports() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/report.schema.json");
        Self { root: serde_json::from_slice(&fs::read(path).unwrap()).unwrap(), met: BTreeSet::new() }
    }

    /// Violations of the schema in a report.
    pub(crate) fn faults(&mut self, report: &Value) -> Vec<String> {
        let root = self.root.clone();
        self.check(&root, "#", report)
    }

    /// Checks a value against the schema at `place`, a path in the root schema.
    fn check(&mut self, schema: &Value, place: &str, value: &Value) -> Vec<String> {
        let mut faults = Vec::new();
        for (keyword, rule) in schema.as_object().expect("a schema is an object") {
            let holds = match keyword.as_str() {
                "$ref" => {
                    let target = rule.as_str().unwrap();
                    let named = self.root.pointer(&target[1..]).unwrap_or_else(|| panic!("{target} is there")).clone();
                    faults.extend(self.check(&named, target, value));
                    true
                }
                "oneOf" => {
                    let ways: Vec<Vec<String>> =
                        rule.as_array().unwrap().iter().map(|way| self.check(way, place, value)).collect();
                    let fits = ways.iter().filter(|faults| faults.is_empty()).count();
                    if fits == 0 {
                        faults.extend(ways.into_iter().flatten());
                    }
                    fits <= 1
                }
                "type" => has_type(value, rule),
                "const" => value == rule,
                "enum" => rule.as_array().unwrap().contains(value),
                "minimum" => value.as_f64().is_none_or(|number| number >= rule.as_f64().unwrap()),
                "minItems" => value.as_array().is_none_or(|list| list.len() as u64 >= rule.as_u64().unwrap()),
                "maxItems" => value.as_array().is_none_or(|list| list.len() as u64 <= rule.as_u64().unwrap()),
                "items" => {
                    for item in value.as_array().into_iter().flatten() {
                        faults.extend(self.check(rule, &format!("{place}/items"), item));
                    }
                    true
                }
                "properties" => {
                    faults.extend(self.check_fields(rule, place, value));
                    true
                }
                "required" => {
                    let missing = |name: &&Value| value.get(name.as_str().unwrap()).is_none();
                    rule.as_array().unwrap().iter().find(missing).is_none()
                }
                // Checked with the properties.
                "additionalProperties" => *rule == Value::Bool(false),
                known => KEYWORDS.contains(&known),
            };
            if !holds {
                faults.push(format!("{place}: {keyword} {rule}: {value:.200}"));
            }
        }
        faults
    }

    fn check_fields(&mut self, properties: &Value, place: &str, value: &Value) -> Vec<String> {
        let mut faults = Vec::new();
        for (name, field) in value.as_object().into_iter().flatten() {
            let place = format!("{place}/properties/{name}");
            match properties.get(name) {
                Some(schema) => faults.extend(self.check(schema, &place, field)),
                None => faults.push(format!("{place}: is not described")),
            }
            self.met.insert(place);
        }
        faults
    }

    /// Paths of all described fields.
    fn described(schema: &Value, place: &str) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for (keyword, rule) in schema.as_object().into_iter().flatten() {
            let within = match keyword.as_str() {
                "properties" | "$defs" => {
                    rule.as_object().unwrap().iter().map(|(name, part)| (format!("{keyword}/{name}"), part)).collect()
                }
                "items" => vec![(keyword.clone(), rule)],
                _ => Vec::new(),
            };
            for (part, inner) in within {
                let inner_place = format!("{place}/{part}");
                if keyword == "properties" {
                    found.insert(inner_place.clone());
                }
                found.extend(Self::described(inner, &inner_place));
            }
        }
        found
    }
}

fn has_type(value: &Value, rule: &Value) -> bool {
    let is = |name: &Value| match name.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        other => panic!("no type of JSON: {other}"),
    };
    rule.as_array().map_or_else(|| is(rule), |names| names.iter().any(is))
}

/// Tent of four triangles, with its tip in the middle.
pub(crate) const TENT: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0.3\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

/// Input files with various faults.
const FILES: [(&str, &str); 21] = [
    ("laid.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"),
    (
        "twin-charts.obj",
        "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 5 0 0\nv 7 0 0\nv 5 1 0\nvt 0 0\nvt 1 0\nvt 0 0.5\n\
         f 1/1 2/2 3/3\nf 4/1 5/2 6/3\n",
    ),
    ("twins.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 5 0 0\nv 7 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n"),
    ("parts.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nf 1 2 3 4\nf 5 6 7\n"),
    (
        "charts.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n",
    ),
    ("tent.obj", TENT),
    (
        "folded.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.1 0.1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
    ),
    ("half.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1 3 4\n"),
    (
        "touching.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\nf 1 1 2\n",
    ),
    ("left-out.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2\nf 1/1 2/2 3/3\n"),
    ("lines.obj", "v 0 0 0\nv 1 0 x\nv 1 1 0\nf 1 2\nf 1 2 3\n"),
    (
        "bytes.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\n\
            end_header\n",
    ),
    ("empty.obj", "# nothing\n"),
    ("mesh.dae", "mesh\n"),
    ("closed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"),
    ("fins.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 9 9 9\nf 1 2 3\nf 2 1 4\nf 1 2 5\n"),
    (
        "ring.obj",
        "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\n\
         f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
    ),
    ("pins.txt", "0 0 0\n0 1 1\n"),
    ("held.txt", "0 0 0\n2 1 1\n"),
    ("odd-polygons.obj", ODD_POLYGONS),
    ("named.obj", "o square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
];

/// Four polygons with two polygons at each inner edge's vertex, which cannot all be convex. The last steps of method auto
/// are worse than earlier ones.
pub(crate) const ODD_POLYGONS: &str = "\
    v 0.000 0.000 -0.366\nv 1.000 0.000 0.347\nv 1.000 1.000 0.264\n\
    v 0.000 1.000 -0.245\nv 0.997 0.470 0.351\nv 0.673 0.756 -0.132\n\
    v 2.000 0.000 -0.067\nv 2.000 1.000 0.262\nv 1.467 1.133 0.182\n\
    v 1.000 2.000 -0.469\nv 0.000 2.000 -0.475\nv 1.025 1.763 -0.138\n\
    v 2.000 2.000 -0.471\nf 1 2 5 3 6 4\nf 2 7 8 9 3 5\n\
    f 4 6 3 12 10 11\nf 3 9 8 13 10 12\n";

/// Runs with their exit status: together they write all kinds of fields.
const RUNS: [(&[&str], i32); 42] = [
    (&["transfer", "laid.obj", "tent.obj"], 0),
    (&["transfer", "laid.obj", "laid.obj"], 0),
    (&["carry", "laid.obj", "tent.obj", "-c", "held.txt", "-o", "carried.txt"], 0),
    (&["transfer", "half.obj", "half.obj"], 3),
    (&["bake", "laid.obj", "laid.obj", "--picture", "skin.png", "-o", "baked.png"], 0),
    (&["flatten", "odd-polygons.obj", "--no-new-vertices"], 4),
    (&["flatten", "two-odd-parts.obj", "--no-new-vertices"], 4),
    (&["flatten", "named.obj", "-o", "named.ply"], 0),
    (&["pack", "twin-charts.obj", "--stack"], 0),
    (&["pack", "half.obj"], 3),
    (&["flatten", "twins.obj", "--stack"], 0),
    (&["flatten", "parts.obj", "--pin", "0:0,0", "--pin", "1:1,0"], 0),
    (&["check", "charts.obj"], 4),
    (&["flatten", "tent.obj"], 0),
    (&["flatten", "closed.obj", "--cut", "auto"], 0),
    (&["flatten", "tent.obj", "--relax", "2", "--pin", "0:0,0", "--pin", "1:1,0.2:3", "--pin", "2:0.9,1"], 0),
    (
        &[
            "flatten", "tent.obj", "--method", "natural", "--pin", "0:0,0", "--pin", "1:1,0", "--pin", "2:0,1",
            "--pin", "3:1,1",
        ],
        4,
    ),
    (&["flatten", "tent.obj", "--method", "convex", "--fit", "true", "--precision", "f32"], 0),
    (&["flatten", "tent.obj", "--method", "lee", "--boundary", "square", "--spacing", "even", "--layers", "3"], 0),
    (&["flatten", "tent.obj", "--method", "stretch", "--boundary", "polygon:0 0; 2 0; 1 2"], 0),
    (&["flatten", "folded.obj", "--start", "uv"], 0),
    (&["flatten", "tent.obj", "--method", "spectral"], 0),
    (&["flatten", "tent.obj", "--method", "abf++"], 0),
    (&["check", "tent.obj"], 0),
    (&["check", "folded.obj"], 4),
    (&["check", "half.obj"], 0),
    (&["flatten", "touching.obj"], 0),
    (&["flatten", "left-out.obj"], 0),
    (&["flatten", "lines.obj"], 3),
    (&["flatten", "bytes.ply"], 3),
    (&["flatten", "empty.obj"], 3),
    (&["flatten", "mesh.dae"], 3),
    (&["flatten", "missing.obj"], 3),
    (&["check", "huge.obj"], 3),
    (&["flatten", "closed.obj"], 3),
    (&["flatten", "fins.obj"], 3),
    (&["flatten", "ring.obj", "--holes", "cut"], 3),
    (&["flatten", "tent.obj", "--constraints", "pins.txt"], 3),
    (&["compare", "tent.obj"], 0),
    (&["compare", "parts.obj", "--methods", "natural,convex/uniform@square"], 0),
    (
        &[
            "compare",
            "tent.obj",
            "--methods",
            "iterate,virtual-boundary,auto",
            "--pin",
            "0:0,0",
            "--pin",
            "1:1,0.2",
            "--pin",
            "2:0.9,1",
            "--morph",
            "morph.png",
            "--frames",
            "3",
        ],
        0,
    ),
    (
        &[
            "compare",
            "tent.obj",
            "--methods",
            "natural,virtual-boundary",
            "--pin",
            "0:0,0",
            "--pin",
            "1:1,0.2:3",
            "--pin",
            "2:0.9,1",
        ],
        0,
    ),
];

/// Described fields that none of these runs writes, with the reason.
const RARE: [&str; 3] = [
    // More than a thousand pairs.
    "#/$defs/layout/properties/findings/items/properties/more",
    // More than a thousand crossings.
    "#/$defs/verdict/properties/more_crossings",
    // A density that no picture holds, with exit status 4.
    "#/$defs/packing/properties/wanted_density",
];

#[test]
fn every_report_is_as_the_schema_says_and_the_schema_says_nothing_that_no_report_has() {
    let program = Program::new();
    for (name, text) in FILES {
        program.write(name, text);
    }
    program.write_huge("huge.obj");
    let skin = fs::File::create(program.path("skin.png")).expect("the folder can be written to");
    write_png(&Picture::filled(4, 4, [200, 100, 50, 255]), skin).expect("written");
    let square = "v 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\nf -4 -3 -2 -1\n";
    program.write("two-odd-parts.obj", &format!("{ODD_POLYGONS}{square}"));
    let mut schema = Schema::of_reports();
    for (arguments, status) in RUNS {
        let report = program.run(&[arguments, &["--report", "-"][..]].concat()).expect(status).json();
        assert_eq!(schema.faults(&report), Vec::<String>::new(), "{arguments:?}: {report:#}");
        assert_eq!(report["schema"], 2, "{arguments:?}");
    }
    let described = Schema::described(&schema.root.clone(), "#");
    let never: Vec<&String> =
        described.difference(&schema.met).filter(|place| !RARE.contains(&place.as_str())).collect();
    assert!(never.is_empty(), "described and never written: {never:#?}");
}

#[test]
fn the_schema_refuses_fields_that_are_missing_unknown_or_of_another_kind() {
    let program = Program::new();
    program.write("tent.obj", TENT);
    let report = program.run(&["flatten", "tent.obj", "--report", "-"]).expect(0).json();
    let refused = |change: &dyn Fn(&mut Value)| {
        let mut changed = report.clone();
        change(&mut changed);
        !Schema::of_reports().faults(&changed).is_empty()
    };
    assert!(!refused(&|_| {}));
    assert!(refused(&|report| drop(report.as_object_mut().unwrap().remove("mesh"))));
    assert!(refused(&|report| drop(report["verdict"].as_object_mut().unwrap().remove("planar"))));
    assert!(refused(&|report| report["steps"][0]["more"] = Value::from(1)));
    assert!(refused(&|report| report["schema"] = Value::from(1)));
    assert!(refused(&|report| report["new_vertices"] = Value::from(-1)));
    assert!(refused(&|report| report["split_edges"] = serde_json::json!([[1]])));
    assert!(refused(&|report| report["placement"] = Value::from("somewhere")));
}
