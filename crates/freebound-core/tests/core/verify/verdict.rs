//! Verdict on known maps: each kind of failure alone.

use freebound_core::mesh::{EdgeId, FaceId, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{Verdict, verdict};
use glam::DVec2;

use super::verdict_cases::{Case, fan, strip};
use freebound_testkit::oracle::sorted_pair;
use freebound_testkit::{assert_message, corpus_entry, corpus_test};

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn judge(case: &Case) -> Verdict {
    verdict(&case.mesh(), &case.embedding)
}

fn faces(numbers: &[u32]) -> Vec<FaceId> {
    numbers.iter().map(|&number| FaceId::new(number)).collect()
}

/// Crossings as pairs of edges, each given by its vertices, in ascending order.
fn crossings(case: &Case) -> Vec<[[u32; 2]; 2]> {
    let mesh = case.mesh();
    let ends = |edge: EdgeId| mesh.ends(edge).map(VertexId::number);
    let mut found: Vec<_> =
        judge(case).boundary_crossings.iter().map(|&[e, f]| sorted_pair(ends(e), ends(f))).collect();
    found.sort_unstable();
    found
}

/// Hexagonal fan, planar.
fn hexagon() -> Case {
    let link: Vec<DVec2> =
        [(2.0, 0.0), (1.0, 2.0), (-1.0, 2.0), (-2.0, 0.0), (-1.0, -2.0), (1.0, -2.0)].map(|(x, y)| at(x, y)).to_vec();
    fan(DVec2::ZERO, &link)
}

/// Strip of squares, two triangles each, given by its cross edges.
fn ladder(stages: &[[DVec2; 2]]) -> Case {
    strip(stages.iter().flatten().copied().collect())
}

#[test]
fn a_flat_hexagon_is_planar() {
    let expected = Verdict {
        planar: true,
        flipped_faces: vec![],
        concave_polygons: vec![],
        crossed_holes: vec![],
        is_filling_folded: false,
        boundary_crossings: vec![],
        more_crossings: false,
        overwound_vertices: vec![],
        turning_number: Some(1),
        zero_area_faces: 0,
        mirrored: false,
        planar_in_f32: true,
    };
    assert_eq!(judge(&hexagon()), expected);
    assert_message("verdict-planar", &expected.summary());
}

#[test]
fn a_map_finer_than_32_bits_is_planar_but_does_not_hold_there() {
    let mut case = hexagon();
    case.embedding[0] = at(-1.0, 2.0 - 1e-9);
    let verdict = judge(&case);
    assert!(verdict.planar && !verdict.planar_in_f32, "{verdict:?}");
    assert_message("verdict-finer-than-32-bits", verdict.summary_in_f32().expect("it is planar"));
    // Outside the range of 32 bits the map cannot be planar there.
    let mut case = hexagon();
    case.embedding.iter_mut().for_each(|z| *z *= 1e39);
    assert!(judge(&case).planar && !judge(&case).planar_in_f32);
}

#[test]
fn a_mirror_image_is_planar_and_said_to_be_one() {
    let mut case = hexagon();
    case.embedding.iter_mut().for_each(|p| p.x = -p.x);
    let verdict = judge(&case);
    assert!(verdict.planar && verdict.mirrored && verdict.flipped_faces.is_empty(), "{verdict:?}");
    assert_eq!(verdict.turning_number, Some(-1));
    assert_message("verdict-mirrored", &verdict.summary());
}

#[test]
fn a_mirror_image_keeps_its_faces_of_area_zero() {
    let mut case = hexagon();
    case.embedding[0] = case.embedding[1];
    case.embedding.iter_mut().for_each(|p| p.x = -p.x);
    let verdict = judge(&case);
    assert!(verdict.mirrored && !verdict.planar);
    assert_eq!((verdict.flipped_faces, verdict.zero_area_faces), (faces(&[0, 5]), 2));
}

#[test]
fn one_face_turned_over_is_named() {
    let mut case = ladder(&[[at(0.0, 0.0), at(0.0, 1.0)], [at(1.0, 0.0), at(1.0, 1.0)], [at(2.0, 0.0), at(2.0, 1.0)]]);
    case.embedding[5] = at(1.5, -1.0);
    let verdict = judge(&case);
    assert!(!verdict.planar && !verdict.mirrored);
    assert_eq!((verdict.flipped_faces.clone(), verdict.zero_area_faces), (faces(&[3]), 0));
    assert_message("verdict-flipped-face", &verdict.summary());
}

#[test]
fn a_flattened_face_counts_as_flipped_and_apart() {
    let mut case = hexagon();
    case.embedding[0] = at(0.0, 2.0);
    let verdict = judge(&case);
    assert_eq!((verdict.flipped_faces.clone(), verdict.zero_area_faces), (faces(&[1]), 1));
    assert_eq!((verdict.boundary_crossings.len(), verdict.turning_number), (0, Some(1)));
    assert_message("verdict-flattened-face", &verdict.summary());
}

#[test]
fn a_bow_tie_crosses_itself_once_and_does_not_turn() {
    let case = strip(vec![at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0)].into());
    let verdict = judge(&case);
    assert_eq!(crossings(&case), [[[0, 2], [1, 3]]]);
    assert_eq!(verdict.turning_number, Some(0));
    assert_message("verdict-bow-tie", &verdict.summary());
}

/// Strip bent to a ring, with its ends at the given points.
fn bent(start: [DVec2; 2], end: [DVec2; 2]) -> Case {
    ladder(&[
        start,
        [at(3.0, -3.0), at(1.0, -1.0)],
        [at(3.0, 3.0), at(1.0, 1.0)],
        [at(-3.0, 3.0), at(-1.0, 1.0)],
        [at(-3.0, -3.0), at(-1.0, -1.0)],
        end,
    ])
}

#[test]
fn a_boundary_that_touches_itself_at_a_point_crosses() {
    let apart = bent([at(0.5, -3.0), at(0.5, -1.0)], [at(-0.5, -3.0), at(-0.5, -1.0)]);
    assert!(judge(&apart).planar);
    // The end of the last cross edge touches the middle of the first.
    let touching = bent([at(0.5, -3.0), at(0.5, -1.0)], [at(-0.5, -3.0), at(0.5, -1.5)]);
    let verdict = judge(&touching);
    assert_eq!((verdict.flipped_faces.len(), verdict.turning_number), (0, Some(1)));
    assert_eq!(crossings(&touching), [[[0, 1], [9, 11]], [[0, 1], [10, 11]]]);
    assert_message("verdict-touching-boundary", &verdict.summary());
}

#[test]
fn a_boundary_whose_edges_lie_on_each_other_crosses() {
    let overlapping = bent([at(0.5, -3.0), at(0.5, -1.0)], [at(0.5, -2.5), at(0.5, -1.5)]);
    let verdict = judge(&overlapping);
    assert_eq!(verdict.flipped_faces, []);
    assert!(crossings(&overlapping).contains(&[[0, 1], [10, 11]]), "{:?}", crossings(&overlapping));
    // Both end edges on one segment: four ends meet, too.
    let closed = bent([at(0.5, -3.0), at(0.5, -1.0)], [at(0.5, -3.0), at(0.5, -1.0)]);
    assert!(!judge(&closed).planar);
}

#[test]
fn a_strip_that_goes_around_far_crosses_though_every_face_is_upright() {
    let over = bent([at(-1.5, -3.0), at(-0.5, -1.0)], [at(1.5, -3.0), at(0.5, -1.0)]);
    let verdict = judge(&over);
    assert_eq!((verdict.flipped_faces.len(), verdict.turning_number), (0, Some(1)));
    assert!(!verdict.planar && verdict.boundary_crossings.len() >= 2);
}

/// Fan whose link goes around the middle several times, on a spiral so that its corners are distinct.
fn spiral_fan(turns: u32) -> Case {
    let count = 5 * turns;
    let link: Vec<DVec2> = (0..count)
        .map(|i| DVec2::from_angle(std::f64::consts::TAU * f64::from(i * turns) / f64::from(count)) * f64::from(10 + i))
        .collect();
    fan(DVec2::ZERO, &link)
}

#[test]
fn a_double_cover_has_an_overwound_vertex_and_turns_twice() {
    let verdict = judge(&spiral_fan(2));
    assert!(!verdict.planar);
    assert_eq!(verdict.flipped_faces, []);
    assert_eq!(verdict.overwound_vertices, [VertexId::new(0)]);
    assert_eq!(verdict.turning_number, Some(2));
    assert_eq!(judge(&spiral_fan(3)).turning_number, Some(3));
}

#[test]
fn a_double_cover_in_the_mirror_is_overwound_as_well() {
    let mut case = spiral_fan(2);
    case.embedding.iter_mut().for_each(|p| p.y = -p.y);
    let verdict = judge(&case);
    assert!(verdict.mirrored && !verdict.planar);
    assert_eq!(verdict.overwound_vertices, [VertexId::new(0)]);
    assert_eq!(verdict.turning_number, Some(-2));
}

#[test]
fn faces_at_a_coordinate_that_is_not_finite_are_flipped() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut case = hexagon();
        case.embedding[1].y = value;
        let verdict = judge(&case);
        assert!(!verdict.planar);
        assert_eq!((verdict.flipped_faces, verdict.zero_area_faces), (faces(&[0, 5]), 0));
        assert_eq!(verdict.turning_number, None);
    }
    let mut case = hexagon();
    case.embedding.fill(DVec2::NAN);
    let verdict = judge(&case);
    assert!(!verdict.planar && !verdict.mirrored);
    assert_eq!(verdict.flipped_faces.len(), 6);
}

#[test]
fn all_vertices_in_one_place_are_not_planar() {
    let mut case = hexagon();
    case.embedding.fill(DVec2::ONE);
    let verdict = judge(&case);
    assert!(!verdict.planar && !verdict.mirrored);
    assert_eq!((verdict.zero_area_faces, verdict.turning_number), (6, None));
}

#[test]
fn the_report_has_the_fields_of_the_design() {
    let case = strip(vec![at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0)].into());
    assert_eq!(
        serde_json::to_string(&judge(&case)).unwrap(),
        "{\"planar\":false,\"flipped_faces\":[1],\"concave_polygons\":[],\"crossed_holes\":[],\"boundary_crossings\":[[0,4]],\"overwound_vertices\":[],\
         \"turning_number\":0,\"zero_area_faces\":0,\"mirrored\":false,\"f32\":false}"
    );
}

corpus_test! {
    fn the_flat_mesh_of_the_corpus_lies_planar_as_it_is() {
        let entry = corpus_entry("flat_bump_domain.obj");
        let mesh = entry.disk();
        let embedding: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
        let verdict = verdict(&mesh, &embedding);
        assert!(verdict.planar, "{}", verdict.summary());
    }
}
