//! `freebound pack`: new places for the charts of a layout, without flattening.

use std::collections::BTreeMap;
use std::fs;

use freebound_core::mesh::PolygonMesh;
use freebound_io::{MeshFile, Texture, read_mesh, write_obj};
use freebound_testkit::many_parts::interleaved;
use freebound_testkit::{Random, assert_message, grid, quad_sheet, shaped, table};
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::charts::{assert_one_to_one, triangles};
use super::program::{Program, obj_text};

/// Corners of each polygon in the plane.
fn polygons(file: &MeshFile) -> Vec<Vec<DVec2>> {
    let texture = file.texture.as_ref().expect("coordinates");
    let at = |place: usize| texture.coordinates[texture.corners[place] as usize];
    (0..file.polygons.face_count()).map(|face| file.polygons.corner_range(face).map(at).collect()).collect()
}

/// Asserts that the polygons of each chart are as before up to one similarity. `chart_of` has the chart of each face.
/// Returns the factors of the charts.
fn assert_similar(
    before: &[Vec<DVec2>],
    after: &[Vec<DVec2>],
    chart_of: &[usize],
    within: f64,
) -> BTreeMap<usize, f64> {
    let mut frames: BTreeMap<usize, [DVec2; 2]> = BTreeMap::new();
    for ((before, after), &chart) in before.iter().zip(after).zip(chart_of) {
        let [from, to] = [before, after].map(|corners| corners[1] - corners[0]);
        let turn = to.rotate(DVec2::new(from.x, -from.y)) / from.length_squared();
        let [turn, origin] = *frames.entry(chart).or_insert([turn, after[0] - turn.rotate(before[0])]);
        for (z, w) in before.iter().zip(after) {
            assert!((turn.rotate(*z) + origin).distance(*w) < within, "{chart}: {z} {w}");
        }
    }
    frames.into_iter().map(|(chart, [turn, _])| (chart, turn.length())).collect()
}

/// Chart of each face of a report: charts are parts that lie a hundred apart along x.
fn part_of_faces(file: &MeshFile) -> Vec<usize> {
    let hundreds = |face: usize| file.polygons.positions[file.polygons.face(face)[0].index()].x / 100.0;
    (0..file.polygons.face_count())
        .map(|face| [0.0, 1.0, 2.0, 3.0].iter().rposition(|&begin| hundreds(face) >= begin - 0.2).expect("a part"))
        .collect()
}

/// Asserts on an independent grid that charts are a gap apart: no pixel has points of two charts within half of the gap,
/// less the diagonal of a pixel.
#[expect(clippy::cast_possible_truncation, reason = "pixels of a small picture")]
fn assert_gap(file: &MeshFile, chart_of_triangle: &[usize], picture: [u32; 2], gap: f64) {
    const PER_PIXEL: f64 = 2.0;
    let size = DVec2::new(f64::from(picture[0]), f64::from(picture[1]));
    let mut owner: BTreeMap<[i64; 2], usize> = BTreeMap::new();
    let reach = gap / 2.0 - std::f64::consts::SQRT_2 / PER_PIXEL;
    for (corners, &chart) in triangles(file).iter().zip(chart_of_triangle) {
        let [a, b, c] = corners.map(|uv| uv * size);
        let (low, high) = (a.min(b).min(c) - reach, a.max(b).max(c) + reach);
        for x in (low.x * PER_PIXEL).floor() as i64..=(high.x * PER_PIXEL).ceil() as i64 {
            for y in (low.y * PER_PIXEL).floor() as i64..=(high.y * PER_PIXEL).ceil() as i64 {
                let point = DVec2::new(x as f64, y as f64) / PER_PIXEL;
                if distance_to_triangle(point, [a, b, c]) <= reach {
                    let own = *owner.entry([x, y]).or_insert(chart);
                    assert_eq!(own, chart, "charts {own} and {chart} meet at {point}");
                    assert!(point.cmpge(DVec2::ZERO).all() && point.cmple(size).all(), "beyond the page: {point}");
                }
            }
        }
    }
}

fn distance_to_triangle(point: DVec2, [a, b, c]: [DVec2; 3]) -> f64 {
    let sides = [[a, b], [b, c], [c, a]];
    let turns = sides.map(|[from, to]| (to - from).perp_dot(point - from));
    if turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0) {
        return 0.0;
    }
    let to_side = |[from, to]: [DVec2; 2]| {
        let along = ((point - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        point.distance(from.lerp(to, along))
    };
    sides.map(to_side).into_iter().fold(f64::INFINITY, f64::min)
}

/// Parts of quads and triangles, bent a little, a hundred apart along x.
fn parts() -> PolygonMesh {
    let bent: PolygonMesh = (&shaped(5, 3, |x, y| DVec3::new(x, y, 0.1 * x * y))).into();
    let parts = [quad_sheet(4, 3, 0.1, &mut Random(2)), bent, (&grid(7, 1)).into(), (&grid(2, 2)).into()];
    interleaved(&parts, &mut Random(4))
}

#[test]
fn charts_keep_their_shape_and_the_gap_and_nothing_is_lost() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&parts()));
    program.run(&["flatten", "in.obj", "-o", "flat.obj", "--chart-size", "0=3,1=0.4"]).expect(0);
    let arguments = ["pack", "flat.obj", "-o", "packed.obj", "--pack", "300x300", "--gap", "8", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    let [before, after] = ["flat.obj", "packed.obj"].map(|name| read_mesh(&program.path(name)).expect("written"));
    assert_eq!(before.polygons, after.polygons);
    let chart_of = part_of_faces(&after);
    assert_similar(&polygons(&before), &polygons(&after), &chart_of, 1e-12);
    assert_one_to_one(&after);
    let chart_of_triangle: Vec<usize> = (0..after.polygons.face_count())
        .flat_map(|face| vec![chart_of[face]; after.polygons.face(face).len() - 2])
        .collect();
    assert_gap(&after, &chart_of_triangle, [300, 300], 8.0);
    // All charts have one density, whatever their sizes were.
    let density = report["packing"]["density"].as_f64().expect("a number");
    let charts = report["packed_charts"].as_array().expect("charts");
    assert!(charts.len() == 4 && charts.iter().all(|chart| chart["was_planar"] == json!(true)));
    for chart in charts {
        let own = chart["density"].as_f64().expect("a number");
        assert!((own / density - 1.0).abs() < 1e-9, "{own} {density}");
    }
    assert_eq!(report["atlas"]["planar"], json!(true));
}

#[test]
fn relative_sizes_stay_if_that_is_asked_for() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&parts()));
    program.run(&["flatten", "in.obj", "-o", "flat.obj", "--chart-size", "0=3,1=0.4"]).expect(0);
    program
        .run(&["pack", "flat.obj", "-o", "packed.ply", "--precision", "f64", "--keep-sizes", "--rotations", "quarter"])
        .expect(0);
    let [before, after] = ["flat.obj", "packed.ply"].map(|name| read_mesh(&program.path(name)).expect("written"));
    let factors = assert_similar(&polygons(&before), &polygons(&after), &part_of_faces(&after), 1e-12);
    let factors: Vec<f64> = factors.into_values().collect();
    assert!(factors.iter().all(|factor| (factor / factors[0] - 1.0).abs() < 1e-9), "{factors:?}");
}

#[test]
fn locked_charts_keep_their_numbers_and_the_others_are_packed_around_them() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&parts()));
    program.run(&["flatten", "in.obj", "-o", "flat.obj"]).expect(0);
    let arguments = ["pack", "flat.obj", "-o", "packed.obj", "--pack", "300x300", "--lock", "0,2", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    let [before, after] = ["flat.obj", "packed.obj"].map(|name| read_mesh(&program.path(name)).expect("written"));
    assert_one_to_one(&after);
    let charts = report["packed_charts"].as_array().expect("charts");
    let chart_of = part_of_faces(&after);
    let part_of =
        |chart: usize| chart_of[usize::try_from(charts[chart]["first_face"].as_u64().expect("a number")).expect("few")];
    let locked = [0, 2].map(part_of);
    for (face, (before, after)) in polygons(&before).iter().zip(polygons(&after)).enumerate() {
        assert_eq!(*before == after, locked.contains(&chart_of[face]), "face {face}");
    }
    let wrong = program.run(&["pack", "flat.obj", "-o", "out.obj", "--lock", "4"]).expect(2);
    assert_message("pack-lock", &wrong.stderr);
    assert!(!program.path("out.obj").exists());
}

#[test]
fn a_density_is_met_in_as_many_tiles_as_it_needs() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&parts()));
    program.run(&["flatten", "in.obj", "-o", "flat.obj"]).expect(0);
    let packing = |arguments: &[&str]| {
        let start = ["pack", "flat.obj", "-o", "packed.obj", "--pack", "256x256", "--report", "-"];
        let report = program.run(&[&start, arguments].concat()).expect(0).json();
        assert_one_to_one(&read_mesh(&program.path("packed.obj")).expect("written"));
        report["packing"].clone()
    };
    let one = packing(&[]);
    let density = one["density"].as_f64().expect("a number");
    assert_eq!(one["tiles"], json!(1));
    let four = packing(&["--tiles", "4"]);
    assert!(four["density"].as_f64().expect("a number") > 1.2 * density, "{four} {one}");
    // The packer need not find a layout without a reserve, even if there is one.
    let nearly_twice = 1.9 * density;
    let doubled = packing(&["--density", &nearly_twice.to_string()]);
    assert_eq!((&doubled["picture"], &doubled["tiles"]), (&json!([512, 512]), &json!(1)));
    assert!((doubled["density"].as_f64().expect("a number") / nearly_twice - 1.0).abs() < 1e-12);
    program.run(&["pack", "flat.obj", "-o", "packed.obj", "--tiles", "0"]).expect(2);
}

#[test]
fn packing_again_covers_as_much_and_all_formats_are_written() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&table()));
    program.run(&["unwrap", "in.obj", "-o", "flat.obj"]).expect(0);
    let covered = |from: &str, to: &str| {
        let report = program.run(&["pack", from, "-o", to, "--report", "-"]).expect(0).json();
        program.run(&["check", to]).expect(0);
        report["packing"]["covered"].as_f64().expect("a number")
    };
    let shares = [("flat.obj", "1.obj"), ("1.obj", "2.glb"), ("2.glb", "3.ply"), ("3.ply", "4.obj")];
    let shares = shares.map(|(from, to)| covered(from, to));
    assert!(shares.iter().all(|share| (share / shares[0] - 1.0).abs() < 0.1), "{shares:?}");
    let drawing = program.run(&["pack", "flat.obj", "--svg", "-"]).expect(0).stdout;
    assert!(drawing.starts_with("<svg") && drawing.trim_end().ends_with("</svg>"));
    let streamed = program.run(&["pack", "flat.obj", "-o", "-"]).expect(0).stdout;
    assert_eq!(streamed.as_bytes(), fs::read(program.path("1.obj")).expect("written"));
}

#[test]
fn groups_materials_and_normals_are_carried_through() {
    let program = Program::new();
    let text = "mtllib a.mtl\no first\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\n\
                vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\ng one\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\n\
                g two\nusemtl blue\ns 1\nf 5/1/1 6/2/1 7/3/1\n";
    program.write("in.obj", text);
    program.write("a.mtl", "newmtl red\nnewmtl blue\n");
    program.run(&["pack", "in.obj", "-o", "out.obj"]).expect(0);
    let written = fs::read_to_string(program.path("out.obj")).expect("written");
    let is_other = |line: &&str| !line.starts_with("vt") && !line.starts_with('f') && !line.starts_with('#');
    let others = |text: &str| text.lines().filter(is_other).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(others(&written), others(text));
    assert!(written.lines().filter(|line| line.starts_with('f')).all(|line| line.ends_with("/1")), "{written}");
}

#[test]
fn charts_of_one_shape_are_stacked_or_spread() {
    let program = Program::new();
    let text = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 5 0 0\nv 7 0 0\nv 5 1 0\nv 9 0 0\nv 9 1 0\nv 11 0 0\n\
                vt 0 0\nvt 1 0\nvt 0 0.5\nf 1/1 2/2 3/3\nf 4/1 5/2 6/3\nf 7/1 8/3 9/2\n";
    program.write("in.obj", text);
    // The second chart is a copy of the first, and the third is its mirror image, on both in the layout.
    let stacks = |arguments: &[&str]| {
        let report =
            program.run(&[&["pack", "in.obj", "-o", "out.obj", "--report", "-"], arguments].concat()).expect(0);
        let report: Value = report.json();
        let charts = report["packed_charts"].as_array().expect("charts").clone();
        charts.iter().map(|chart| chart.get("stacked_on").cloned()).collect::<Vec<_>>()
    };
    assert_eq!(stacks(&[]), [None, None, None]);
    assert_one_to_one_but_mirrored(&program);
    assert_eq!(stacks(&["--stack", "none"]), [None, None, None]);
    let on_first = || Some(json!(0));
    assert_eq!(stacks(&["--stack"]), [None, on_first(), on_first()]);
    program.run(&["check", "out.obj"]).expect(4);
    program.run(&["check", "out.obj", "--stacked"]).expect(0);
}

/// Asserts that no two triangles overlap, of either orientation.
fn assert_one_to_one_but_mirrored(program: &Program) {
    program.run(&["check", "out.obj"]).expect(0);
}

#[test]
fn a_layout_that_folds_is_packed_and_not_proved() {
    let program = Program::new();
    let folded = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 3 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.9 0.3\n\
                  f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/1 6/2 7/3\n";
    program.write("folded.obj", folded);
    let report = program.run(&["pack", "folded.obj", "-o", "out.obj", "--report", "-"]).expect(4).json();
    let were_planar: Vec<&Value> =
        report["packed_charts"].as_array().expect("charts").iter().map(|chart| &chart["was_planar"]).collect();
    assert_eq!(were_planar, [&json!(false), &json!(true)]);
    assert_eq!(report["atlas"]["planar"], json!(false));
    let [before, after] = ["folded.obj", "out.obj"].map(|name| read_mesh(&program.path(name)).expect("written"));
    assert_similar(&polygons(&before), &polygons(&after), &[0, 0, 1], 1e-12);
    assert_gap(&after, &[0, 0, 1], [1024, 1024], 4.0);
    // A closed surface with one coordinate per vertex has no boundary.
    program.write(
        "closed.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.2 0.2\n\
         f 1/1 3/3 2/2\nf 1/1 2/2 4/4\nf 2/2 3/3 4/4\nf 3/3 1/1 4/4\n",
    );
    let report = program.run(&["pack", "closed.obj", "-o", "closed-packed.obj", "--report", "-"]).expect(4).json();
    assert!(report.get("atlas").is_none() && program.path("closed-packed.obj").exists());
}

#[test]
fn faces_without_coordinates_are_named_with_a_remedy() {
    let program = Program::new();
    program.write("half.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1 3 4\n");
    let half = program.run(&["pack", "half.obj", "-o", "out.obj", "--report", "report.json"]).expect(3);
    assert_message("pack-half", &half.stderr);
    program.write("none.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    assert_message("pack-none", &program.run(&["pack", "none.obj", "-o", "out.obj"]).expect(3).stderr);
    assert!(!program.path("out.obj").exists());
    assert_message("pack-overwrites", &program.run(&["pack", "half.obj", "-o", "half.obj"]).expect(2).stderr);
}

#[test]
fn a_picture_that_is_no_square_keeps_shapes_on_the_picture() {
    let program = Program::new();
    let mesh = MeshFile { polygons: (&grid(3, 2)).into(), ..MeshFile::default() };
    let corners = mesh.polygons.corners.iter().map(|vertex| vertex.number()).collect();
    // The layout of a picture twice as wide as high.
    let coordinates = mesh.polygons.positions.iter().map(|p| DVec2::new(p.x / 2.0, p.y) / 4.0).collect();
    let mut bytes = Vec::new();
    write_obj(&mut bytes, &mesh, &Texture { coordinates, corners }).expect("memory holds it");
    fs::write(program.path("in.obj"), &bytes).expect("written");
    program.run(&["pack", "in.obj", "-o", "wide.obj", "--pack", "512x256"]).expect(0);
    program.run(&["pack", "in.obj", "-o", "square.obj", "--pack", "256x256", "--from-aspect", "2:1"]).expect(0);
    for (name, aspect) in [("wide.obj", 2.0), ("square.obj", 1.0)] {
        let file = read_mesh(&program.path(name)).expect("written");
        for [a, b, c] in triangles(&file) {
            let [a, b, c] = [a, b, c].map(|uv| uv * DVec2::new(aspect, 1.0));
            let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
            sides.sort_by(f64::total_cmp);
            assert!((sides[1] / sides[0] - 1.0).abs() < 1e-9, "{name}: {sides:?}");
        }
    }
}
