//! Frame times of the whole window, both panes, on the available graphics driver.
//!
//! `cargo bench --bench frames [MESH.obj]` opens the mesh; default: the built-in face. It measures frames in which
//! nothing changes, in which the mesh turns, in which the shading changes, and while iterations run in the
//! background. Every frame reads the picture back from the graphics card, which a real window does not do, so the
//! times are upper bounds. "window" is the part of a frame that is not drawing; the solver must never delay it.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use eframe::egui;
use egui::{Event, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use freebound::app::{App, LaunchFile};
use freebound::session::Action;
use freebound::ui::{Pane, Request, ShadingMode};

/// Measured frames of each kind.
const FRAMES: usize = 60;

/// Time limit for opening and solving the mesh in the background.
const PATIENCE: Duration = Duration::from_mins(2);

fn main() {
    let file = std::env::args().nth(1).filter(|argument| !argument.starts_with("--")).map(PathBuf::from);
    let start = LaunchFile { file, dialogs_inside: true, ..LaunchFile::default() };
    let mut window = Harness::builder()
        .with_size(Vec2::new(1280.0, 800.0))
        .wgpu()
        .build_eframe(move |context| App::new(context, start));
    let begin = Instant::now();
    while window.state().editor().pane_shading.paint(Pane::Mesh).is_none()
        || window.state().editor().plane.scene().is_none()
    {
        assert!(begin.elapsed() < PATIENCE, "the mesh was not opened and solved in time");
        window.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    let model = window.state().editor().session.model().expect("a mesh is open").clone();
    println!(
        "{}: {} faces; opened, solved and ready after {:.2} s",
        model.name,
        model.mesh().face_count(),
        begin.elapsed().as_secs_f64()
    );
    println!("{:<26} {:>12} {:>12} {:>12} {:>12}", "frame", "median ms", "worst ms", "window ms", "its worst");
    // The first pictures include all uploads.
    for _ in 0..3 {
        picture(&mut window);
    }
    measure(&mut window, "nothing changes", |_, _| ());
    let middle = Pos2::new(280.0, 400.0);
    window.event(Event::PointerMoved(middle));
    window.event(button(middle, true));
    measure(&mut window, "the mesh turns", |window, frame| {
        window.event(Event::PointerMoved(middle + Vec2::new((frame % 40) as f32 * 4.0, 10.0)));
    });
    window.event(button(middle, false));
    measure(&mut window, "the shading changes", |window, frame| {
        let shading = ShadingMode::ALL[frame % ShadingMode::ALL.len()];
        window.state_mut().editor_mut().handle(Request::SetShading(shading));
    });
    measure(&mut window, "a run goes on", |window, _| {
        if window.state().editor().session.busy().is_none() {
            window.state_mut().editor_mut().handle(Request::Do(Action::Step));
        }
    });
    println!("steps taken meanwhile: {}", window.state().editor().session.timeline().records().len());
}

fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

/// Runs one frame and reads its picture back. Returns the milliseconds of the frame's own work, and of everything.
fn picture(window: &mut Harness<'_, App>) -> [f64; 2] {
    let begin = Instant::now();
    window.step();
    let stepped = begin.elapsed();
    window.render().expect("a driver that draws");
    [stepped, begin.elapsed()].map(|time| 1000.0 * time.as_secs_f64())
}

fn measure(window: &mut Harness<'_, App>, name: &str, mut change: impl FnMut(&mut Harness<'_, App>, usize)) {
    let mut times: Vec<[f64; 2]> = Vec::with_capacity(FRAMES);
    for frame in 0..FRAMES {
        change(window, frame);
        times.push(picture(window));
    }
    let mut whole: Vec<f64> = times.iter().map(|[_, whole]| *whole).collect();
    let mut steps: Vec<f64> = times.iter().map(|[step, _]| *step).collect();
    whole.sort_by(f64::total_cmp);
    steps.sort_by(f64::total_cmp);
    let [median, worst] = [FRAMES / 2, FRAMES - 1];
    let cells = [whole[median], whole[worst], steps[median], steps[worst]].map(|ms| format!("{ms:>13.2}"));
    println!("{name:<26} {}", cells.join(""));
}
