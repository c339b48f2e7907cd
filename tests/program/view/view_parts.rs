//! Saved and derived state of views: cameras as numbers, detail views, snapped targets, smaller pictures.

use std::sync::Arc;

use freebound::examples::Example;
use freebound::view::{OrbitCamera, PictureQuad, PlaneCamera, Sphere, UpAxis, part_around, snapped};
use freebound_core::geom;
use freebound_core::geom::{Bounds, Similarity};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::Embedding;
use glam::{DVec2, DVec3};

const PANE: DVec2 = DVec2::new(400.0, 300.0);

fn orbit() -> OrbitCamera {
    OrbitCamera::framing(Sphere { center: DVec3::new(1.0, 2.0, 3.0), radius: 2.0 }, UpAxis::Y)
}

fn plane() -> PlaneCamera {
    PlaneCamera::framing(Bounds::UNIT, PANE)
}

#[test]
fn a_camera_before_the_mesh_comes_back_from_its_numbers() {
    // The last two end above and below the pivot.
    for drag in [DVec2::ZERO, DVec2::new(500.0, -40.0), DVec2::new(-300.0, 2000.0), DVec2::new(90.0, -2000.0)] {
        let mut camera = orbit();
        camera.orbit(drag);
        camera.pan(DVec2::new(13.0, 7.0), PANE);
        camera.zoom_about(DVec3::X, 0.4);
        assert!(camera.numbers().iter().all(|number| number.is_finite()));
        let again = orbit().with_numbers(&camera.numbers()).expect("sound");
        let differ = (camera.view_from_world() - again.view_from_world()).to_cols_array();
        assert!(differ.iter().all(|entry| entry.abs() < 1e-9), "{drag}: {camera:?} {again:?}");
        assert!(camera.pivot().distance(again.pivot()) < 1e-9, "{again:?}");
        assert!((camera.distance() - again.distance()).abs() < 1e-9, "{again:?}");
    }
}

#[test]
fn a_camera_over_the_plane_shows_as_much_in_another_pane() {
    for size in [PANE, 2.0 * PANE] {
        let again = plane().with_numbers(&[0.25, -0.5, 0.125], size).expect("sound");
        assert!(again.center().distance(DVec2::new(0.25, -0.5)) < 1e-12, "{again:?}");
        assert!((again.visible(size).size().y - 0.125).abs() < 1e-12, "{again:?}");
    }
}

#[test]
fn numbers_that_are_no_camera_s_are_ignored() {
    let too_few: [&[f64]; 3] = [&[], &[1.0], &[1.0, 2.0, 3.0, 4.0]];
    for numbers in too_few {
        assert!(orbit().with_numbers(numbers).is_none() && plane().with_numbers(numbers, PANE).is_none());
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(orbit().with_numbers(&[0.0, 0.0, 0.0, bad, 0.0, 0.0]), None);
        assert_eq!(plane().with_numbers(&[0.0, 0.0, bad], PANE), None);
    }
}

#[test]
fn a_single_vertex_is_shown_from_near_by() {
    let all = Sphere { center: DVec3::ZERO, radius: 2.0 };
    let near = all.part_around(&[DVec3::X]);
    assert!(near.center == DVec3::X && near.radius < 0.2 * all.radius, "{near:?}");
    let whole = Bounds { low: DVec2::ZERO, high: DVec2::splat(3.0) };
    let part = part_around(&[DVec2::ONE], whole);
    assert!(part.middle() == DVec2::ONE && part.extent() < 0.2 * whole.extent(), "{part:?}");
}

#[test]
fn nothing_wider_than_the_whole_is_shown() {
    let all = Sphere { center: DVec3::ZERO, radius: 2.0 };
    let shown = all.part_around(&[DVec3::X * -2.0, DVec3::X * 2.0]);
    assert!((shown.radius - all.radius).abs() < 1e-12, "{shown:?}");
}

#[test]
fn targets_snap_to_corners_and_middles_of_pixels() {
    let pixels = DVec2::new(8.0, 4.0);
    for (from, to) in [([0.26, 0.26], [2.0, 1.0]), ([0.31, 0.38], [2.5, 1.5]), ([0.99, 0.01], [8.0, 0.0])] {
        assert_eq!(snapped(DVec2::from(from), pixels), DVec2::from(to) / pixels, "{from:?}");
    }
}

#[test]
fn what_is_snapped_stays() {
    let pixels = DVec2::new(640.0, 427.0);
    for target in [DVec2::new(0.123, 0.877), DVec2::new(1.0, 0.5), DVec2::new(-0.2, 1.3)] {
        let once = snapped(target, pixels);
        assert_eq!(snapped(once, pixels), once);
        assert!(((once - target) * pixels).length() <= 0.5 + 1e-9, "{target} to {once}");
    }
}

/// Boundary of the L in its plane, and its moved image.
fn boundary_moved(moved: impl Fn(DVec2) -> DVec2) -> (Embedding, Vec<[DVec2; 2]>) {
    let disk = DiskMesh::try_from(Example::Ell.mesh()).expect("a disk");
    let before: Embedding = disk.vertices().map(|v| disk.position(v).truncate()).collect();
    let pairs = before.boundary(&disk).iter().map(|&z| [z, moved(z)]).collect();
    (before, pairs)
}

#[test]
fn a_similarity_is_found_again() {
    let moved = |z: DVec2| DVec2::new(-0.3, 2.0).rotate(z) + DVec2::new(5.0, -1.0);
    let (before, pairs) = boundary_moved(moved);
    let found = Similarity::fitting(&pairs).expect("there is one");
    assert!(before.iter().all(|&z| found.apply(z).distance(moved(z)) < 1e-12));
}

#[test]
fn an_embedding_at_one_point_stays_where_it_is() {
    let (_, pairs) = boundary_moved(|z| z);
    assert!(Similarity::fitting(&pairs.iter().map(|_| [DVec2::ONE; 2]).collect::<Vec<_>>()).is_none());
}

fn picture([width, height]: [u32; 2], pixels: Vec<u8>) -> Arc<geom::Picture> {
    Arc::new(geom::Picture { width, height, pixels })
}

fn sizes_of(picture: &Arc<geom::Picture>, limit: u32) -> Vec<Arc<geom::Picture>> {
    PictureQuad::new(Arc::clone(picture)).expect("as many pixels as it should").sizes_up_to(limit).to_vec()
}

#[test]
fn a_picture_that_fits_is_left_alone_and_one_without_its_pixels_is_none() {
    let fits = picture([2, 1], vec![7; 8]);
    assert!(Arc::ptr_eq(&sizes_of(&fits, 2)[0], &fits));
    assert!(
        PictureQuad::new(picture([2, 1], vec![7; 7])).is_none() && PictureQuad::new(picture([0, 3], vec![])).is_none()
    );
}

#[test]
fn each_size_is_half_the_one_before_down_to_a_pixel_and_a_single_colour_stays() {
    let colour = [10_u8, 20, 30, 255];
    let of_size = |[width, height]: [u32; 2]| picture([width, height], colour.repeat((width * height) as usize));
    for (size, limit, expected) in [
        ([7, 3], 8, vec![[7, 3], [3, 1], [1, 1]]),
        ([7, 3], 4, vec![[3, 1], [1, 1]]),
        ([3, 9], 4, vec![[1, 4], [1, 2], [1, 1]]),
        ([4, 5], 1, vec![[1, 1]]),
        ([4, 5], 0, vec![[1, 1]]),
    ] {
        let expected: Vec<_> = expected.into_iter().map(of_size).collect();
        assert_eq!(sizes_of(&of_size(size), limit), expected, "{size:?} up to {limit}");
    }
}

#[test]
fn a_block_becomes_its_mean_and_what_is_clear_lends_no_colour() {
    let pixels = [[10_u8, 20, 30, 255], [20, 40, 50, 255], [200, 0, 0, 255], [0, 99, 0, 0]].concat();
    let sizes = sizes_of(&picture([4, 1], pixels), 2);
    let pixels: Vec<&[u8]> = sizes.iter().map(|picture| picture.pixels.as_slice()).collect();
    assert_eq!(pixels, [&[15_u8, 30, 40, 255, 200, 0, 0, 128][..], &[77, 20, 27, 192]]);
}
