//! Pictures of old layouts in new layouts.

use freebound_core::geom::Picture;
use freebound_core::mesh::TriMesh;
use freebound_core::pipeline::LayoutSurface;
use freebound_core::problem::{Control, Embedding, SolveError};
use freebound_io::{BakeOptions, BakedPicture, PaintedSurface, Registration, bake};
use freebound_testkit::{grid, shaped};
use glam::{DVec2, DVec3};

/// Layout with the plane positions of a flat mesh, moved by a function.
fn layout(mesh: &TriMesh, place: impl Fn(DVec2) -> DVec2) -> Embedding {
    mesh.positions.iter().map(|position| place(position.truncate())).collect()
}

/// Picture whose red grows with u, and whose green grows with v.
fn gradient(size: u32) -> Picture {
    let level = |pixel: u32| u8::try_from((2 * pixel + 1) * 255 / (2 * size)).expect("a share");
    let row = |y: u32| (0..size).flat_map(move |x| [level(x), level(size - 1 - y), 77, 255]);
    Picture { width: size, height: size, pixels: (0..size).flat_map(row).collect() }
}

fn baked(mesh: &TriMesh, old: &Embedding, new: &Embedding, options: BakeOptions) -> BakedPicture {
    let surface = |coordinates| LayoutSurface { mesh, coordinates };
    let old = PaintedSurface { layout: surface(old), picture: &gradient(128) };
    bake(old, surface(new), options, Control::unattended()).expect("nobody cancels")
}

/// Flat sheet on the unit square.
fn flat() -> TriMesh {
    shaped(7, 5, |x, y| DVec3::new(x / 7.0, y / 5.0, 0.0))
}

#[test]
fn every_pixel_shows_the_point_of_the_surface_that_lies_there() {
    let mesh = flat();
    let old = layout(&mesh, |z| 0.1 + 0.8 * z);
    // A quarter turn, smaller, on a picture that is not square.
    let place = |z: DVec2| DVec2::new(0.7 - 0.4 * z.y, 0.2 + 0.6 * z.x);
    let new = layout(&mesh, place);
    let options = BakeOptions { pixels: [90, 160], margin: 0, registration: Registration::AsTheyAre };
    let BakedPicture { picture, report } = baked(&mesh, &old, &new, options);
    assert_eq!([picture.width, picture.height], options.pixels);
    let mut seen = 0;
    for (x, y) in (0..90).flat_map(|x| (0..160).map(move |y| (x, y))) {
        let uv = DVec2::new((f64::from(x) + 0.5) / 90.0, 1.0 - (f64::from(y) + 0.5) / 160.0);
        let point = DVec2::new((uv.y - 0.2) / 0.6, (0.7 - uv.x) / 0.4);
        let [r, g, b, opacity] = picture.pixel(x, y).expect("a pixel");
        if point.cmpgt(DVec2::splat(0.03)).all() && point.cmplt(DVec2::splat(0.97)).all() {
            let expected = (0.1 + 0.8 * point) * 255.0;
            let error = DVec2::new(f64::from(r), f64::from(g)) - expected;
            assert!(error.abs().max_element() < 2.0 && b == 77 && opacity == 255, "{x} {y}: {r} {g} {expected}");
            seen += 1;
        } else if point.cmplt(DVec2::splat(-0.03)).any() || point.cmpgt(DVec2::splat(1.03)).any() {
            assert_eq!(opacity, 0, "{x} {y}");
        }
    }
    assert!(seen > 2000);
    assert!((report.covered - 0.24).abs() < 0.01, "{report:?}");
    assert!(report.outside == 0 && report.largest_distance < 1e-12, "{report:?}");
}

#[test]
fn charts_grow_by_the_margin_and_no_further() {
    let mesh = flat();
    let new = layout(&mesh, |z| 0.25 + 0.5 * z);
    for margin in [0, 1, 5] {
        let options = BakeOptions { pixels: [64, 64], margin, registration: Registration::AsTheyAre };
        let BakedPicture { picture, .. } = baked(&mesh, &new, &new, options);
        for (x, y) in (0..64).flat_map(|x| (0..64).map(move |y| (x, y))) {
            let beyond = |pixel: u32| 16_u32.saturating_sub(pixel).max((pixel + 1).saturating_sub(48));
            let is_drawn = picture.pixel(x, y).expect("a pixel")[3] == 255;
            assert_eq!(is_drawn, beyond(x).max(beyond(y)) <= margin, "{margin}: {x} {y}");
        }
    }
}

#[test]
fn old_layouts_beyond_the_unit_square_repeat_their_picture() {
    let mesh = flat();
    let new = layout(&mesh, |z| 0.05 + 0.9 * z);
    let options = BakeOptions { pixels: [50, 50], margin: 2, registration: Registration::AsTheyAre };
    let once = baked(&mesh, &layout(&mesh, |z| 0.1 + 0.8 * z), &new, options);
    let shifted = baked(&mesh, &layout(&mesh, |z| DVec2::new(3.0, -2.0) + 0.1 + 0.8 * z), &new, options);
    let pairs = once.picture.pixels.iter().zip(&shifted.picture.pixels);
    assert!(pairs.into_iter().all(|(a, b)| a.abs_diff(*b) <= 1));
}

#[test]
fn faces_outside_the_picture_are_counted_and_overlaps_show_the_first_face() {
    let mesh = grid(2, 2);
    let old = layout(&mesh, |z| 0.25 * z);
    let whole = layout(&mesh, |z| 0.25 * z);
    let options = BakeOptions { pixels: [32, 32], margin: 0, registration: Registration::AsTheyAre };
    assert_eq!(baked(&mesh, &old, &whole, options).report.outside, 0);
    let moved = layout(&mesh, |z| 0.25 * z + DVec2::new(0.75, 0.0));
    assert_eq!(baked(&mesh, &old, &moved, options).report.outside, 4);
    let stacked = layout(&mesh, |z| DVec2::new(0.2 * z.x, 0.25 * z.y).min(DVec2::splat(0.4)));
    let first = baked(&mesh, &old, &stacked, options);
    assert_eq!(first.picture, baked(&mesh, &old, &stacked, options).picture);
}

#[test]
fn a_picture_has_the_same_bytes_on_any_number_of_threads() {
    let mesh = flat();
    let (old, new) = (layout(&mesh, |z| z), layout(&mesh, |z| 0.1 + 0.7 * z));
    let options = BakeOptions { pixels: [200, 120], margin: 4, registration: Registration::AsTheyAre };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| baked(&mesh, &old, &new, options).picture)
    };
    assert!(on(1) == on(3));
}

#[test]
fn a_surface_that_lies_apart_is_measured() {
    let mesh = flat();
    let lifted = TriMesh { positions: mesh.positions.iter().map(|p| *p + 0.25 * DVec3::Z).collect(), ..mesh.clone() };
    let coordinates = layout(&mesh, |z| z);
    let old =
        PaintedSurface { layout: LayoutSurface { mesh: &mesh, coordinates: &coordinates }, picture: &gradient(16) };
    let new = LayoutSurface { mesh: &lifted, coordinates: &coordinates };
    let options = BakeOptions { pixels: [16, 16], margin: 0, registration: Registration::AsTheyAre };
    let baked = bake(old, new, options, Control::unattended()).expect("nobody cancels");
    assert!((baked.report.largest_distance - 0.25).abs() < 1e-12, "{:?}", baked.report);
}

#[test]
fn a_cancelled_picture_says_so() {
    let mesh = flat();
    let coordinates = layout(&mesh, |z| z);
    let layout = LayoutSurface { mesh: &mesh, coordinates: &coordinates };
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let options = BakeOptions { pixels: [16, 16], margin: 0, registration: Registration::AsTheyAre };
    let old = PaintedSurface { layout, picture: &gradient(16) };
    let refused = bake(old, layout, options, Control::new(&cancel, &|_| {}));
    assert!(matches!(refused, Err(SolveError::Cancelled)));
}
