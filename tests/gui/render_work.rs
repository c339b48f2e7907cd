//! Uploads of a frame to the graphics card, and the number of redraws of a pane.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use eframe::egui;
use eframe::egui_wgpu::RendererOptions;
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use freebound::render::{FaceShading, MeshFrame, PaneId, Style, install, mesh_pane, plane_pane, stats};
use freebound::view::{FacePaint, MeshArrays, PlaneArrays};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, VertexId};
use glam::DVec2;

use crate::render::{PANE, RECT, WINDOW, Window, camera_in_front, mesh_frame, pixel, plane_frame};

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn an_unchanged_frame_sends_and_draws_nothing() {
    let frame = mesh_frame();
    let mut window = Window::new(move || mesh_pane(PANE, RECT, frame.clone()));
    let first = window.picture();
    let after_first = stats(&window.state).expect("installed");
    assert!(after_first.uploads >= 2, "positions and normals: {after_first:?}");
    let second = window.picture();
    assert_eq!(stats(&window.state), Some(after_first));
    assert_eq!(first, second, "and shows the same");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn an_inset_of_the_same_embedding_sends_nothing() {
    let is_shown = Arc::new(AtomicBool::new(false));
    let (frame, shown) = (plane_frame(DVec2::new(-0.5, 0.5), &[FaceId::new(2)]), Arc::clone(&is_shown));
    let mut inset = frame.clone();
    inset.camera.frame(Bounds { low: DVec2::splat(-0.2), high: DVec2::splat(0.2) }, DVec2::splat(60.0));
    inset.style = Style { shading: FaceShading::Plain, wire_in_points: 1.0, ..inset.style };
    let state = create_render_state(default_wgpu_setup(), RendererOptions::PREDICTABLE);
    install(&state);
    let mut harness = Harness::builder()
        .with_size(egui::Vec2::splat(WINDOW))
        .renderer(WgpuTestRenderer::from_render_state(state.clone()))
        .build_ui(move |ui| {
            ui.painter().add(plane_pane(PANE, RECT, frame.clone()));
            if shown.load(std::sync::atomic::Ordering::Relaxed) {
                let corner = egui::Rect::from_min_size(egui::pos2(110.0, 120.0), egui::Vec2::splat(60.0));
                ui.painter().add(plane_pane(PaneId("inset"), corner, inset.clone()));
            }
        });
    let mut stats_of_frame = || {
        harness.step();
        harness.render().expect("the driver draws");
        stats(&state).expect("installed")
    };
    let alone = stats_of_frame();
    is_shown.store(true, std::sync::atomic::Ordering::Relaxed);
    let with_inset = stats_of_frame();
    assert_eq!(with_inset.uploads, alone.uploads, "both draw from the same buffers");
    assert_eq!(with_inset.drawn_panes, alone.drawn_panes + 1);
    assert_eq!(stats_of_frame(), with_inset, "an unchanged frame draws nothing");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_moved_camera_draws_with_one_call_and_sends_no_buffer() {
    let camera = Arc::new(std::sync::Mutex::new(camera_in_front()));
    let (shared, frame) = (Arc::clone(&camera), mesh_frame());
    let mut window = Window::new(move || {
        let camera = *shared.lock().expect("one thread");
        mesh_pane(PANE, RECT, MeshFrame { camera, ..frame.clone() })
    });
    window.picture();
    let before = stats(&window.state).expect("installed");
    camera.lock().expect("one thread").orbit(DVec2::new(30.0, 10.0));
    window.picture();
    let after = stats(&window.state).expect("installed");
    assert_eq!(after.uploads, before.uploads);
    assert_eq!(after.drawn_panes, before.drawn_panes + 1);
    assert_eq!(after.draw_calls, before.draw_calls + 1);
}

#[test]
fn a_pane_without_a_graphics_card_stays_empty() {
    let (mesh, plane) = (mesh_frame(), plane_frame(DVec2::ONE, &[]));
    let mut harness = Harness::new_ui(move |ui| {
        ui.painter().add(mesh_pane(PANE, RECT, mesh.clone()));
        ui.painter().add(plane_pane(PaneId("plane"), RECT, plane.clone()));
        ui.label("still here");
    });
    harness.step();
    egui_kittest::kittest::Queryable::get_by_label(&harness, "still here");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn thousands_of_faces_over_each_other_are_drawn_with_fewer_pixels() {
    // Faces over the whole pane, every second one flipped, as those of a folded embedding seen from near.
    let triangles = |count: usize| vec![[0, 1, 2].map(VertexId::new); count];
    let embedding = [DVec2::splat(-9.0), DVec2::new(20.0, -9.0), DVec2::new(-9.0, 20.0)];
    let drawn = |count: usize| {
        let mut frame = plane_frame(DVec2::ONE, &[]);
        let positions = embedding.map(|point| point.extend(0.0));
        let corners = triangles(count);
        let flipped: Vec<FaceId> = (0..count).step_by(2).map(FaceId::from_index).collect();
        frame.mesh = Arc::new(MeshArrays::new(&positions, &corners));
        frame.plane = Some(Arc::new(PlaneArrays::new(&embedding, &corners)));
        frame.paint = Some(Arc::new(FacePaint::plain(count, &flipped)));
        let mut window = Window::new(move || plane_pane(PANE, RECT, frame.clone()));
        let picture = window.picture();
        (picture, stats(&window.state).expect("installed").pixels)
    };
    let (few, pixels) = drawn(4);
    let (many, fewer) = drawn(20_000);
    // A graphics card can draw more of them at full resolution.
    assert!(pixels >= 4 * fewer, "{fewer} of {pixels} pixels");
    let [few, many] = [few, many].map(|picture| pixel(&picture, 40.0, 60.0));
    let is_red = |[red, green, blue]: [u8; 3]| red > green.max(blue).saturating_add(60);
    assert!(is_red(few) && is_red(many), "{few:?} and {many:?}: still a flipped face");
}
