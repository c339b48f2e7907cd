//! Pictures without a screen.

use freebound_core::geom::Picture;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::verdict;
use freebound_io::ProvedEmbedding;
use freebound_io::raster::{Canvas, Colour, RasterPaint, RasterShading, View, colours, mesh_picture, plane_picture};
use glam::{DQuat, DVec2, DVec3};

const SQUARE: [DVec2; 4] = [DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0), DVec2::new(0.0, 1.0)];

fn faces<const N: usize>(corners: [[u32; 3]; N]) -> [[VertexId; 3]; N] {
    corners.map(|t| t.map(VertexId::new))
}

fn unlit(width: u32, height: u32) -> Canvas {
    Canvas { shading: RasterShading::Unlit, wire: 0.0, ..Canvas::clay(width, height) }
}

fn disk(points: &[DVec2], triangles: &[[VertexId; 3]]) -> DiskMesh {
    let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(VertexId::number)).collect();
    DiskMesh::try_from(TriMesh::new(flat(points), &triangles)).expect("a disk")
}

#[test]
fn a_picture_is_as_red_as_the_verdict_says() {
    let points = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[3], DVec2::new(0.5, 0.5)];
    let mesh = disk(&points, &faces([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]));
    // A mirror image reverses every face, and the map is still one-to-one.
    let mirrored = points.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
    let verdict = verdict(&mesh, &mirrored);
    assert!(verdict.planar && verdict.mirrored);
    let proved = ProvedEmbedding { mesh: &mesh, embedding: &mirrored, verdict: &verdict };
    let picture = proved.picture(&Canvas::drawing(100, 100));
    assert_eq!(share_of(&picture, colours::FLIPPED), 0.0);
    assert!(share_of(&picture, colours::CLAY) > 0.5);
}

fn share_of(picture: &Picture, colour: Colour) -> f64 {
    let [r, g, b] = colour;
    let count = picture.pixels.chunks_exact(4).filter(|p| *p == [r, g, b, 255]).count();
    count as f64 / f64::from(picture.width * picture.height)
}

fn flat(points: &[DVec2]) -> Vec<DVec3> {
    points.iter().map(|p| p.extend(0.0)).collect()
}

#[test]
fn a_square_fills_its_frame_and_no_more() {
    let picture = mesh_picture(
        &flat(&SQUARE),
        &faces([[0, 1, 2], [0, 2, 3]]),
        &View::FRONT,
        &unlit(100, 100),
        RasterPaint::Faces(&[[10, 20, 30]; 2]),
    );
    // The margin is 4 % on each side, so the square covers 92 % of each direction.
    assert!((share_of(&picture, [10, 20, 30]) - 0.92 * 0.92).abs() < 1e-9);
    assert!((share_of(&picture, colours::BACKGROUND) - (1.0 - 0.92 * 0.92)).abs() < 1e-9);
}

#[test]
fn a_wide_frame_keeps_the_shape() {
    let picture =
        mesh_picture(&flat(&SQUARE), &faces([[0, 1, 2], [0, 2, 3]]), &View::FRONT, &unlit(200, 100), RasterPaint::Clay);
    assert_eq!(picture.pixel(53, 50), Some([0xf4, 0xf4, 0xf2, 255]));
    assert_eq!(picture.pixel(55, 50), Some([0xd8, 0xd4, 0xcc, 255]));
    assert_eq!(picture.pixel(144, 50), Some([0xd8, 0xd4, 0xcc, 255]));
    assert_eq!(picture.pixel(147, 50), Some([0xf4, 0xf4, 0xf2, 255]));
}

#[test]
fn the_nearer_face_hides_the_farther_one_from_either_side_and_in_either_order() {
    let mut positions = flat(&SQUARE);
    positions.extend(SQUARE.map(|p| p.extend(1.0)));
    let (far, near) = ([200, 0, 0], [0, 200, 0]);
    let squares = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let reversed = [[4, 5, 6], [4, 6, 7], [0, 1, 2], [0, 2, 3]];
    for (corners, paint) in [(squares, [far, far, near, near]), (reversed, [near, near, far, far])] {
        let seen =
            |view: &View| mesh_picture(&positions, &faces(corners), view, &unlit(40, 40), RasterPaint::Faces(&paint));
        assert_eq!(seen(&View::FRONT).pixel(20, 20), Some([0, 200, 0, 255]));
        let behind = View { eye: DVec3::NEG_Z, up: DVec3::Y };
        assert_eq!(seen(&behind).pixel(20, 20), Some([200, 0, 0, 255]));
    }
}

#[test]
fn what_is_up_and_right_stays_up_and_right() {
    // A triangle in the lower right half, seen from the front; seen from behind it is on the left.
    let positions = flat(&[DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0)]);
    let seen = |view: &View| mesh_picture(&positions, &faces([[0, 1, 2]]), view, &unlit(40, 40), RasterPaint::Clay);
    let background = Some([0xf4, 0xf4, 0xf2, 255]);
    let front = seen(&View::FRONT);
    assert!(front.pixel(35, 8) != background && front.pixel(8, 8) == background);
    let behind = seen(&View { eye: DVec3::NEG_Z, up: DVec3::Y });
    assert!(behind.pixel(4, 8) != background && behind.pixel(35, 8) == background);
    // The back side has another clay colour.
    assert_eq!(front.pixel(30, 25), Some([0xd8, 0xd4, 0xcc, 255]));
    assert_eq!(behind.pixel(10, 25), Some([0xa9, 0xa3, 0x9a, 255]));
}

#[test]
fn light_comes_from_above() {
    let roof = [
        DVec3::new(0.0, 0.0, 0.0),
        DVec3::new(1.0, 0.0, 0.0),
        DVec3::new(1.0, 0.5, 0.5),
        DVec3::new(0.0, 0.5, 0.5),
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(0.0, 1.0, 0.0),
    ];
    let triangles = faces([[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]]);
    let canvas = Canvas { shading: RasterShading::Faceted, ..Canvas::clay(60, 60) };
    let picture = mesh_picture(&roof, &triangles, &View::FRONT, &canvas, RasterPaint::Clay);
    let brightness = |y| picture.pixel(30, y).expect("inside")[0];
    assert!(brightness(15) > brightness(45) + 30, "{} above, {} below", brightness(15), brightness(45));
}

#[test]
fn a_flipped_face_is_red_and_the_boundary_dark() {
    let points = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[3], DVec2::new(0.5, 0.5)];
    let fan = faces([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
    let canvas = Canvas::drawing(200, 200);
    let mesh = disk(&points, &fan);
    let picture_of = |points: &[DVec2]| {
        let embedding = points.to_vec().into();
        ProvedEmbedding { mesh: &mesh, embedding: &embedding, verdict: &verdict(&mesh, &embedding) }.picture(&canvas)
    };
    let sound = picture_of(&points);
    assert!(share_of(&sound, colours::FLIPPED) == 0.0);
    // Moved below the lower side, the centre flips the triangle over that side.
    let folded = [points[0], points[1], points[2], points[3], DVec2::new(0.5, -0.4)];
    let picture = picture_of(&folded);
    assert!(share_of(&picture, colours::FLIPPED) > 0.05);
    assert!(share_of(&sound, colours::BOUNDARY) > 0.01);
    assert_eq!(sound.pixel(8, 100), Some([0x2c, 0x2b, 0x29, 255]), "the left side of the square");
}

#[test]
fn a_degenerate_face_of_an_embedding_counts_as_flipped_and_harms_nothing() {
    let points = [DVec2::ZERO, DVec2::X, DVec2::X * 2.0, DVec2::new(f64::NAN, 0.0), DVec2::Y];
    let picture = plane_picture(
        &points.to_vec().into(),
        &faces([[0, 1, 2], [0, 1, 3], [0, 1, 4]]),
        &Canvas::drawing(50, 50),
        RasterPaint::Clay,
    );
    assert_eq!(picture.pixels.len(), 4 * 50 * 50);
    let empty = plane_picture(&Embedding::default(), &[], &Canvas::drawing(50, 30), RasterPaint::Clay);
    assert!(share_of(&empty, colours::BACKGROUND) > 0.999);
}

#[test]
fn the_checker_follows_its_coordinates() {
    let coordinates = Embedding::from(SQUARE.to_vec());
    let paint = RasterPaint::Checker { coordinates: &coordinates, size: 0.5 };
    let picture = mesh_picture(&flat(&SQUARE), &faces([[0, 1, 2], [0, 2, 3]]), &View::FRONT, &unlit(100, 100), paint);
    let at = |x, y| picture.pixel(x, y).map(|p| [p[0], p[1], p[2]]);
    assert_eq!(at(25, 75), Some(colours::BACKGROUND), "lower left");
    assert_eq!(at(75, 75), Some(colours::CHECKER), "lower right");
    assert_eq!(at(25, 25), Some(colours::CHECKER), "upper left");
    assert_eq!(at(75, 25), Some(colours::BACKGROUND), "upper right");
}

#[test]
fn a_written_png_reads_back_the_same() {
    let left = Picture::filled(3, 2, [1, 2, 3, 255]);
    let both = left.beside(&Picture::filled(2, 4, [9, 8, 7, 128]));
    assert_eq!((both.width, both.height), (5, 4));
    assert_eq!(
        [both.pixel(2, 1), both.pixel(3, 3), both.pixel(0, 3)],
        [Some([1, 2, 3, 255]), Some([9, 8, 7, 128]), Some([255; 4])]
    );
    assert_eq!(both.pixel(5, 0), None);
    let mut bytes = Vec::new();
    freebound_io::raster::write_png(&both, &mut bytes).expect("memory takes all");
    let read = image::load_from_memory(&bytes).expect("a PNG").to_rgba8();
    assert_eq!((read.width(), read.height(), read.into_raw()), (5, 4, both.pixels));
}

#[test]
fn the_picture_does_not_depend_on_the_number_of_threads() {
    let mesh = freebound_testkit::BuiltIn::BumpyCap.mesh();
    let canvas = Canvas { wire: 0.5, ..Canvas::clay(160, 200) };
    let draw = || mesh_picture(&mesh.positions, &mesh.triangles, &View::turned(0.4), &canvas, RasterPaint::Clay);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool").install(draw);
    let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a pool").install(draw);
    assert_eq!(alone, three);
}

/// Twice the area vectors of a rotated box's triangles, without the sides that `is_open` selects.
fn box_areas(turn: DQuat, is_open: impl Fn(DVec3) -> bool) -> (DVec3, Vec<DVec3>) {
    let corner = |k: usize| turn * DVec3::new([0.1, 0.7][k & 1], [0.2, 0.9][k >> 1 & 1], [0.3, 1.4][k >> 2]);
    let sides = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
    let areas = sides
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(corner)).map(|[a, b, c]| (b - a).cross(c - a)));
    let areas: Vec<DVec3> = areas.filter(|&area| !is_open(area)).collect();
    (areas.iter().sum(), areas)
}

#[test]
fn a_closed_surface_is_seen_from_the_front_and_an_open_one_from_the_side_that_it_looks_to() {
    let mut noisy = 0;
    for k in 0..50 {
        let turn = DQuat::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), f64::from(k) * 0.7);
        let (left, areas) = box_areas(turn, |_| false);
        assert!(left.length() < 1e-14, "the area vectors of a closed surface cancel out: {left}");
        noisy += usize::from(left != DVec3::ZERO);
        assert_eq!(View::facing(areas), View::FRONT);
        let open = turn * DVec3::X;
        let (_, areas) = box_areas(turn, |area| area.normalize_or_zero().dot(open) > 0.9);
        assert_eq!(areas.len(), 10);
        let eye = View::facing(areas).eye;
        assert!(eye.normalize_or_zero().distance(-open) < 1e-12, "{eye} is not against {open}");
    }
    assert!(noisy > 25, "{noisy}: what is left would be zero anyhow");
    assert_eq!(View::facing([]), View::FRONT);
    let almost_up = DVec3::new(1e-15, 2.0, 0.0);
    assert_eq!(View::facing([almost_up]), View { eye: almost_up, up: DVec3::Z });
}
