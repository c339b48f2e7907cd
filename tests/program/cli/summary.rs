//! Messages of `freebound flatten` on a planar map with large distortion.

use freebound_core::mesh::{TriMesh, VertexId};
use glam::DVec3;

use super::program::{Program, obj_text};
use super::report_schema::ODD_POLYGONS;
use freebound_testkit::{assert_message, sheet, tower};

const CONVEX: [&str; 8] = ["flatten", "in.obj", "-o", "out.obj", "--method", "convex", "--family", "uniform"];

/// Program with two sheets side by side in its file; the faces of the first come first.
fn with_both(first: &TriMesh, second: &TriMesh) -> Program {
    let offset = u32::try_from(first.positions.len()).expect("a small mesh");
    let moved = second.positions.iter().map(|p| *p + 2.0 * DVec3::X);
    let positions = first.positions.iter().copied().chain(moved).collect();
    let of_second = second.triangles.iter().map(|t| t.map(|v| v.number() + offset));
    let triangles: Vec<[u32; 3]> = first.triangles.iter().map(|t| t.map(VertexId::number)).chain(of_second).collect();
    let program = Program::new();
    program.write("in.obj", &obj_text(&(&TriMesh::new(positions, &triangles)).into()));
    program
}

/// Line on differing areas without the digits of their ratio, if there is one.
fn areas(program: &Program, further: &[&str]) -> Option<String> {
    let run = program.run(&[&CONVEX[..], further].concat()).expect(0);
    let line = run.stdout.lines().find(|line| line.starts_with("areas"))?;
    let mut words: Vec<&str> = line.split(' ').collect();
    let ratio = words.iter().position(|word| *word == "by").expect("a ratio") + 1;
    words[ratio] = "RATIO";
    Some(words.join(" "))
}

#[test]
fn areas_that_differ_badly_are_told_with_what_can_be_done() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&(&tower()).into()));
    let line = areas(&program, &["--relax", "0"]).expect("a line on areas");
    assert_message("summary-areas-differ", &line);
}

#[test]
fn of_several_charts_the_one_is_named_whose_areas_differ_most() {
    let flat = sheet(8, 0.0);
    for (case, first, second, face) in
        [("first", &tower(), &flat, 0), ("second", &flat, &tower(), flat.triangles.len())]
    {
        let line = areas(&with_both(first, second), &["--relax", "0", "--cut", "shortest"]).expect("a line on areas");
        assert!(line.split(' ').any(|word| word == face.to_string()), "{line}");
        assert_message(&format!("summary-areas-of-the-{case}-chart"), &line);
    }
    assert_eq!(areas(&with_both(&flat, &flat), &["--cut", "shortest"]), None, "nothing is distorted");
}

#[test]
fn without_a_planar_map_the_step_with_the_fewest_faults_is_written_and_named() {
    let program = Program::new();
    program.write("in.obj", ODD_POLYGONS);
    let flatten = ["flatten", "in.obj", "--no-new-vertices", "-o", "out.obj"];
    let report = program.run(&[&flatten[..], &["--report", "-"]].concat()).expect(4).json();
    let faults: Vec<u64> = report["steps"]
        .as_array()
        .expect("steps")
        .iter()
        .map(|step| step["flipped_faces"].as_u64().unwrap() + step["concave_polygons"].as_u64().unwrap())
        .collect();
    let (fewest, last) = (faults.iter().min().expect("steps"), faults.last().expect("steps"));
    assert!(fewest < last, "the case has a step that is better than the last: {faults:?}");
    let written = usize::try_from(report["written_step"].as_u64().expect("not the last one")).unwrap();
    assert_eq!(&faults[written], fewest, "{faults:?}");
    let listed = report["verdict"]["concave_polygons"].as_array().expect("a list").len();
    assert_eq!(u64::try_from(listed).unwrap(), *fewest);
    let summary = program.run(&flatten).expect(4).stdout;
    let wanted = format!("at step {written}, the best of {}", faults.len());
    assert!(summary.contains(&wanted), "{summary}");
}
