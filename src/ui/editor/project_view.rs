//! How the person looks at the document, kept in its project and put on again when it is opened.
//!
//! ```text
//! mesh_camera    pivot x, y, z; distance; yaw, pitch         world units, radians
//! plane_camera   center x, y; height of what the pane shows   embedding units
//! ```
//!
//! Numbers that are none of these are ignored, as names are that mean nothing here.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::io::ProjectView;
use crate::mesh::VertexId;
use crate::ui::{Editor, Shading, Tool};
use crate::view::{OrbitCamera, PlaneCamera};

/// A drag by which a camera shows how far drags turn it, points: far less than half a turn.
const PROBE: f64 = 100.0;

impl Editor {
    fn view(&self) -> ProjectView {
        let shading = Some(self.look.shading.title().to_owned());
        ProjectView {
            mesh_shading: shading.clone(),
            plane_shading: shading,
            mesh_camera: self.mesh.camera().as_ref().and_then(orbit_numbers),
            plane_camera: self.plane_camera_numbers(),
            selection: self.selection.vertices().iter().map(|vertex| vertex.number()).collect(),
            tool: Some(self.tools.tool().words()[0].to_owned()),
        }
    }

    /// Tells the session how the person looks at it, to be saved with it. While what was opened is not on the screen
    /// yet, the session knows better.
    pub(in crate::ui) fn keep_view(&mut self) {
        if self.opened.is_on_screen(&self.session) {
            let view = self.view();
            self.session.set_view(view);
        }
    }

    /// Keeps the view that copies for recovery are made with fresh. Call once per frame.
    pub(super) fn refresh_view(&mut self) {
        if self.opened.view_is_due(&self.session) {
            self.keep_view();
        }
    }

    /// Puts on how the person looked at what was opened. Call once its mesh is drawn.
    pub(super) fn put_on_view(&mut self) {
        let view = self.session.view().clone();
        let shading = view.mesh_shading.and_then(|name| Shading::ALL.into_iter().find(|s| s.title() == name));
        if let Some(shading) = shading {
            self.look.shading = shading;
        }
        if let Some(tool) = Tool::ALL.into_iter().find(|tool| view.tool.as_deref() == Some(tool.words()[0])) {
            self.tools.take_up(tool);
        }
        let orbit = view.mesh_camera.zip(self.mesh.camera()).and_then(|(numbers, start)| orbit_of(&numbers, start));
        if let Some(orbit) = orbit {
            self.mesh.set_camera(orbit);
        }
        self.plane.set_saved_camera(view.plane_camera);
        let count = self.session.model().map_or(0, |model| model.mesh().vertex_count());
        let there = view.selection.into_iter().map(VertexId::new).filter(|vertex| vertex.index() < count);
        self.selection.select(there);
    }

    /// The plane's camera; none where the window chose it by itself, as it will again.
    fn plane_camera_numbers(&self) -> Option<Vec<f64>> {
        if let Some(saved) = self.plane.saved_camera() {
            return Some(saved.clone());
        }
        let camera = self.plane.camera().filter(|_| !self.plane.is_framed())?;
        let (center, height) = (camera.center(), camera.visible(self.plane.area().size()).size().y);
        finite(vec![center.x, center.y, height])
    }
}

/// JSON has no words for numbers that are not finite, and a project with one could not be read again.
fn finite(numbers: Vec<f64>) -> Option<Vec<f64>> {
    numbers.iter().all(|number| number.is_finite()).then_some(numbers)
}

fn orbit_numbers(camera: &OrbitCamera) -> Option<Vec<f64>> {
    let (pivot, angles) = (camera.pivot(), yaw_and_pitch(camera));
    finite(vec![pivot.x, pivot.y, pivot.z, camera.distance(), angles.x, angles.y])
}

/// The camera that such numbers are of, on the scene of another one.
fn orbit_of(numbers: &[f64], start: OrbitCamera) -> Option<OrbitCamera> {
    let &[x, y, z, distance, yaw, pitch]: &[f64; 6] = numbers.try_into().ok()?;
    if !(numbers.iter().all(|number| number.is_finite()) && distance > 0.0) {
        return None;
    }
    let mut camera = turned(start, DVec2::new(yaw, pitch));
    let pivot = DVec3::new(x, y, z);
    camera.set_pivot(pivot);
    camera.zoom_about(pivot, distance / camera.distance());
    camera.eye().is_finite().then_some(camera)
}

/// A camera's turn about the vertical and its height over the horizon, radians; y is up, as in all of the window.
fn yaw_and_pitch(camera: &OrbitCamera) -> DVec2 {
    let view_from_world = camera.view_from_world();
    let [right, up, back] = [0, 1, 2].map(|axis| view_from_world.row(axis));
    // By the axes rather than the eye, which says nothing of the yaw where it is right above the pivot.
    DVec2::new((-right.z).atan2(right.x), back.y.atan2(up.y))
}

/// The camera turned to a yaw and a pitch by the drag that does it.
fn turned(mut camera: OrbitCamera, wanted: DVec2) -> OrbitCamera {
    let now = yaw_and_pitch(&camera);
    let mut probe = camera;
    probe.orbit(DVec2::new(PROBE, 0.0));
    let turn = (yaw_and_pitch(&probe).x - now.x + PI).rem_euclid(TAU) - PI;
    // A drag to the right turns the camera to the left, one downwards lifts it as far.
    camera.orbit((wanted - now) * DVec2::new(1.0, -1.0) * (PROBE / turn));
    camera
}

/// The camera that such numbers are of, with the limits of another one.
pub(super) fn plane_of(numbers: &[f64], mut camera: PlaneCamera, pane_size: DVec2) -> Option<PlaneCamera> {
    let &[x, y, height]: &[f64; 3] = numbers.try_into().ok()?;
    if !(numbers.iter().all(|number| number.is_finite()) && height > 0.0) {
        return None;
    }
    camera.zoom_at(pane_size / 2.0, pane_size.y / height / camera.points_per_unit(), pane_size);
    let way = camera.center() - DVec2::new(x, y);
    camera.pan(way * DVec2::new(1.0, -1.0) * camera.points_per_unit());
    camera.center().is_finite().then_some(camera)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Bounds;
    use crate::view::{Sphere, UpAxis};

    const PANE: DVec2 = DVec2::new(400.0, 300.0);

    fn orbit() -> OrbitCamera {
        OrbitCamera::framing(Sphere { center: DVec3::new(1.0, 2.0, 3.0), radius: 2.0 }, UpAxis::Y)
    }

    fn plane() -> PlaneCamera {
        PlaneCamera::framing(Bounds { low: DVec2::ZERO, high: DVec2::ONE }, PANE)
    }

    #[test]
    fn a_camera_before_the_mesh_comes_back_from_its_numbers() {
        // The last two end above and below the pivot.
        for drag in [DVec2::ZERO, DVec2::new(500.0, -40.0), DVec2::new(-300.0, 2000.0), DVec2::new(90.0, -2000.0)] {
            let mut camera = orbit();
            camera.orbit(drag);
            camera.pan(DVec2::new(13.0, 7.0), PANE);
            camera.zoom_about(DVec3::X, 0.4);
            let again = orbit_of(&orbit_numbers(&camera).expect("finite"), orbit()).expect("sound");
            let differ = (camera.view_from_world() - again.view_from_world()).to_cols_array();
            assert!(differ.iter().all(|entry| entry.abs() < 1e-9), "{drag}: {camera:?} {again:?}");
            assert!(camera.pivot().distance(again.pivot()) < 1e-9, "{again:?}");
            assert!((camera.distance() - again.distance()).abs() < 1e-9, "{again:?}");
        }
    }

    #[test]
    fn a_camera_over_the_plane_shows_as_much_in_another_pane() {
        for size in [PANE, 2.0 * PANE] {
            let again = plane_of(&[0.25, -0.5, 0.125], plane(), size).expect("sound");
            assert!(again.center().distance(DVec2::new(0.25, -0.5)) < 1e-12, "{again:?}");
            assert!((again.visible(size).size().y - 0.125).abs() < 1e-12, "{again:?}");
        }
    }

    #[test]
    fn numbers_that_are_no_camera_s_are_ignored() {
        let too_few: [&[f64]; 3] = [&[], &[1.0], &[1.0, 2.0, 3.0, 4.0]];
        for numbers in too_few {
            assert!(orbit_of(numbers, orbit()).is_none() && plane_of(numbers, plane(), PANE).is_none());
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(orbit_of(&[0.0, 0.0, 0.0, bad, 0.0, 0.0], orbit()), None);
            assert_eq!(plane_of(&[0.0, 0.0, bad], plane(), PANE), None);
        }
    }
}
