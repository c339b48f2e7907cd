//! Verdict in the bar at the top; beside it, or in its place, the work in the background.

use eframe::egui::{self, RichText, Role};

use super::seams_section::progress_words;
use crate::session::{Action, Busy, FirstMapWork, LivePreview, PageStroke, Preview, Session, Status};
use crate::ui::icons::{self, Sign};
use crate::ui::theme::{CHIP, CHIP_HOVERED};
use crate::ui::{Control, Editor, Offer, PageRequest, Request, Tab, counted, sentence, theme_of, with_keys_set};
use freebound_core::bijective::Blocker;
use freebound_core::flatten::Step;
use freebound_core::pipeline::Surface;
use freebound_core::problem::Phase;
use freebound_core::verify::Verdict;

/// Side of the sign in the pill, points.
const SIGN: f32 = 11.0;

struct Pill {
    sign: Sign,
    words: String,
    tip: String,
}

impl Pill {
    fn new(sign: Sign, words: impl Into<String>, tip: impl Into<String>) -> Self {
        Self { sign, words: words.into(), tip: tip.into() }
    }
}

/// Shows the verdict at a glance: proved, defective, being solved, or not up to date.
pub(in crate::ui) fn verdict_pill(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let (pill, busy) = shown(editor);
    if let Some(pill) = &pill
        && show_pill(ui, pill).clicked()
    {
        if editor.shows_page() {
            let charts = editor.session.overlapping_charts();
            requests.push(Request::ShowTab(Tab::Charts));
            if !charts.is_empty() {
                requests.push(PageRequest::Pick { chart: None, adds: false }.into());
                requests.push(PageRequest::Add(charts).into());
            }
            return;
        }
        let unmet = editor.step_on_screen().map(|outcome| outcome.step.unmet()).unwrap_or_default();
        requests.push(match editor.defect_count() {
            _ if editor.plane.is_moving(&editor.session) => Request::ShowTab(Tab::Defects),
            0 if unmet.is_empty() => Request::ShowTab(Tab::Defects),
            0 => Request::GoTo(unmet),
            _ => Request::StepDefect(1),
        });
    }
    let Some(busy) = busy else { return };
    Offer::new("Stop", "Stop the work in the background", Action::Cancel).show(ui, requests);
    if pill.is_none() {
        let words = editor.session.seam_search().map_or_else(|| busy_words(busy), |search| progress_words(&search));
        ui.label(RichText::new(words).color(theme_of(ui).weak_text));
    }
    ui.add(egui::Spinner::new().size(12.0));
}

/// Pill, and work in the background. Work replaces the pill, unless the pill labels a drag preview. That label stays
/// true during the solve until a first step exists.
fn shown(editor: &Editor) -> (Option<Pill>, Option<Busy>) {
    let busy = editor.busy_for_long();
    let is_replaced = busy.is_some() && editor.session.preview().is_none();
    (if is_replaced { None } else { pill(editor) }, busy)
}

fn busy_words(busy: Busy) -> String {
    match busy {
        Busy::Loading => "opening…".to_owned(),
        Busy::Job(what) => format!("{what}…"),
        Busy::Solving(None | Some(Phase::Solve)) => "solving…".to_owned(),
        Busy::Solving(Some(phase)) => format!("solving… {}", phase.words()),
        Busy::Saving => "saving…".to_owned(),
    }
}

fn pill(editor: &Editor) -> Option<Pill> {
    let session = &editor.session;
    let model = session.model()?;
    let work = session.first_map_work();
    if work == Some(FirstMapWork::Check) {
        return Some(Pill::new(Sign::Working, "checking…", "The layout of the file is being checked"));
    }
    if work.is_some() || (model.is_faulty() && session.seam_search().is_some()) {
        return Some(Pill::new(Sign::Working, "unwrapping…", "Short seams are being found"));
    }
    if let Surface::Faulty(_, diagnosis) = &model.prepared.surface {
        let words = counted(diagnosis.faults.len(), "fault", "faults");
        return Some(Pill::new(Sign::Bad, words, "The bars above the mesh and the Defects tab list the faults"));
    }
    if editor.shows_page() {
        return of_page(editor);
    }
    Some(match session.status() {
        Status::Preview(Some(Preview { live: Some(live), .. })) => of_live(session, *live),
        Status::Preview(preview) => {
            let tip = "Preview of the first, linear step. Repair starts when you pause or release the pin";
            Pill::new(Sign::Warning, preview_words(preview), tip)
        }
        Status::Solving => Pill::new(Sign::Working, "solving…", "The solve is running"),
        Status::Following => Pill::new(Sign::Working, "following…", "The solve is running"),
        Status::Stale => {
            let tip = "The embedding does not match the settings and pins. Press Solve";
            Pill::new(Sign::Warning, "not solved", tip)
        }
        Status::Held | Status::Current if editor.plane.is_moving(session) => moving(editor)?,
        Status::Held | Status::Current => of_step(&editor.step_on_screen()?.step),
    })
}

/// Chart that keeps a move or a stroke back, for the pill. `None` if nothing is kept back.
fn kept_back_words(session: &Session) -> Option<String> {
    let of_move = session.move_state().and_then(|state| state.kept_back.as_ref());
    let stroke = session.page_stroke();
    let verdict = stroke.and_then(PageStroke::kept_back).or(of_move.map(|judged| &judged.verdict))?;
    let moves = |chart: usize| {
        stroke.is_some_and(|stroke| stroke.chart() == chart)
            || of_move.is_some_and(|judged| judged.moves.iter().any(|(moved, _)| *moved == chart))
    };
    let other = verdict.overlapping.first().map(|&[a, b]| if moves(a) { b } else { a });
    Some(other.map_or_else(String::new, |other| format!(" · chart {other} is in the way")))
}

/// Verdict on all charts of the page, also while charts move.
fn of_page(editor: &Editor) -> Option<Pill> {
    let session = &editor.session;
    let page = session.page()?;
    let state = session.move_state();
    let stroke = session.page_stroke();
    let moved = stroke.and_then(PageStroke::verdict).or_else(|| Some(&state?.accepted.as_ref()?.verdict));
    let count = counted(page.charts.len(), "chart", "charts");
    if let Some([a, b]) = moved.and_then(|moved| moved.overlapping.first()) {
        return Some(Pill::new(Sign::Bad, format!("Charts {a} and {b} overlap"), "Bring them apart, or press Esc"));
    }
    if let Some(chart) = session.failed_chart().filter(|_| !session.can_move_charts()) {
        let tip = "Click to open the list of charts";
        return Some(Pill::new(Sign::Bad, format!("Chart {chart}: no embedding found"), tip));
    }
    if state.is_none() && !session.can_move_charts() {
        return Some(Pill::new(Sign::Working, "laying out…", "The charts are being solved or packed"));
    }
    if moved.is_some_and(|moved| !moved.is_planar()) {
        return Some(Pill::new(Sign::Bad, "A chart folds", "Go back a little, or press Esc"));
    }
    let tip = "Exact arithmetic shows that no two faces of any charts overlap";
    Some(match (page.is_planar, kept_back_words(session)) {
        (None, _) => Pill::new(Sign::Working, "checking…", "The layout of all charts is being proved"),
        (Some(true), Some(words)) => {
            Pill::new(Sign::Good, format!("Planar: proved{words}"), "Hold Alt to let charts overlap")
        }
        (Some(true), None) => Pill::new(Sign::Good, format!("Planar: proved · {count}"), tip),
        (Some(false), _) => {
            let words = session.newest_atlas().map(|atlas| atlas.verdict.summary());
            let tip = "Click to select the charts that overlap";
            Pill::new(Sign::Bad, words.map_or_else(|| "Not planar".to_owned(), |words| sentence(&words)), tip)
        }
    })
}

/// Pill of a transition: its first and last step. Omits the first if it is not a step of the current run.
fn moving(editor: &Editor) -> Option<Pill> {
    let timeline = editor.session.timeline();
    let to = timeline.shown()?;
    let tip = "The embedding is moving. The verdict on the step appears at the end of the movement";
    let Some(left) = editor.step_on_screen() else { return Some(Pill::new(Sign::Working, "drawing…", tip)) };
    let from = timeline.index_of(left).filter(|_| !editor.plane.shows_preview());
    let words = from.map_or_else(|| format!("moving to step {to}"), |from| format!("moving {from} to {to}"));
    Some(Pill::new(Sign::Moving, words, tip))
}

/// Verdict on an up-to-date step. A planar step also names its stage.
fn of_step(step: &Step) -> Pill {
    let (unmet, stage) = (step.unmet().len(), step.candidate.stage.short_words());
    if !step.verdict.planar {
        return Pill::new(Sign::Bad, short_verdict(&step.verdict), "Not planar. Click for the next defect (D)");
    }
    if unmet > 0 {
        let tip = "No two faces overlap, but some hard pins are not on their targets. Click to show them";
        return Pill::new(Sign::Unmet, format!("Planar, constraints not met: {unmet} · {stage}"), tip);
    }
    let new = step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices_of_surface().count());
    let note = match new {
        0 => String::new(),
        _ => format!(". The mesh has {}", counted(new, "new vertex", "new vertices")),
    };
    let in_f32 = if step.verdict.planar_in_f32 {
        "It is also planar in 32 bits, the precision of texture coordinates in most programs"
    } else {
        "It is not planar in 32 bits, the precision of texture coordinates in most programs: relax it"
    };
    let tip = format!("Exact arithmetic shows that no two faces overlap. {in_f32}{note}");
    Pill::new(Sign::Good, format!("Planar: proved · {stage}"), tip)
}

/// Planar embedding of a live drag, proved at every frame.
fn of_live(session: &Session, LivePreview { obstacle }: LivePreview) -> Pill {
    let tip = "Exact arithmetic shows for every frame that no two faces overlap. The rest of the map follows when \
               you pause or release";
    let words = obstacle
        .map_or_else(|| "Planar: proved".to_owned(), |by| format!("Planar: proved · {}", in_the_way(session, by)));
    Pill::new(Sign::Good, words, tip)
}

/// Obstacle of a dragged pin, in few words.
fn in_the_way(session: &Session, obstacle: Blocker) -> String {
    match obstacle {
        Blocker::Pin(vertex) => format!("{} is in the way", session.number_of(vertex)),
        Blocker::Boundary(vertex) => format!("the boundary at {} is in the way", session.number_of(vertex)),
        Blocker::Surroundings => "the rest of the map follows when you pause".to_owned(),
    }
}

/// State of a drag preview.
fn preview_words(preview: Option<&Preview>) -> String {
    let known = match preview.map(Preview::verdict) {
        None => return "preview, not repaired".to_owned(),
        Some(None) => "checking…".to_owned(),
        Some(Some(verdict)) if verdict.planar => "planar".to_owned(),
        Some(Some(verdict)) => short_verdict(verdict),
    };
    format!("preview, not repaired · {known}")
}

/// Verdict in few words.
fn short_verdict(verdict: &Verdict) -> String {
    let crossings = match verdict.boundary_crossings.len() {
        1 => "1 crossing".to_owned(),
        _ => format!("{} crossings", verdict.crossing_count_in_words()),
    };
    let counts = [
        (verdict.flipped_faces.len(), format!("{} flipped", verdict.flipped_faces.len())),
        (verdict.concave_polygons.len(), format!("{} concave", verdict.concave_polygons.len())),
        (verdict.crossed_holes.len(), format!("{} crossed holes", verdict.crossed_holes.len())),
        (verdict.boundary_crossings.len(), crossings),
        (verdict.overwound_vertices.len(), format!("{} overwound", verdict.overwound_vertices.len())),
    ];
    counts.into_iter().filter(|(count, _)| *count > 0).map(|(_, words)| words).collect::<Vec<_>>().join(" · ")
}

fn show_pill(ui: &mut egui::Ui, pill: &Pill) -> egui::Response {
    let theme = theme_of(ui);
    let colour = pill.sign.colour(theme);
    let text = egui::WidgetText::from(RichText::new(&pill.words).color(colour).strong());
    let galley = text.into_galley(ui, None, f32::INFINITY, egui::TextStyle::Body);
    let size = galley.size() + egui::vec2(20.0 + SIGN + 6.0, 6.0);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    let strength = if response.hovered() { CHIP_HOVERED } else { CHIP };
    ui.painter().rect_filled(rect, rect.height() / 2.0, colour.gamma_multiply(strength));
    if response.has_focus() {
        let stroke = egui::Stroke::new(1.0, colour);
        ui.painter().rect_stroke(rect, rect.height() / 2.0, stroke, egui::StrokeKind::Inside);
    }
    let square =
        egui::Rect::from_center_size(rect.left_center() + egui::vec2(10.0 + SIGN / 2.0, 0.0), egui::Vec2::splat(SIGN));
    icons::sign(ui.painter(), square, pill.sign, theme);
    let at = egui::pos2(square.right() + 6.0, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, colour);
    let tip = with_keys_set(ui.ctx(), &pill.tip, ["(", "D", ")"], &Request::StepDefect(1));
    response.named(Role::Button, &format!("Verdict: {}", pill.words)).on_hover_text(tip)
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use freebound_testkit::assert_message;

    use super::*;
    use crate::examples::Example;
    use crate::session::RecentFiles;
    use freebound_core::mesh::VertexId;
    use freebound_core::problem::{Family, Method, Settings};

    /// Adopts finished background work until a condition is true.
    fn wait(editor: &mut Editor, is_there: impl Fn(&Editor) -> bool) {
        let begun = Instant::now();
        while !is_there(editor) {
            assert!(begun.elapsed() < Duration::from_secs(90), "still waiting: {editor:?}");
            std::thread::sleep(Duration::from_millis(1));
            editor.session.poll();
        }
    }

    fn is_solved(editor: &Editor) -> bool {
        editor.session.busy().is_none() && editor.session.is_current()
    }

    /// Editor in the middle of a drag, with a preview.
    fn dragging(method: Method) -> Editor {
        let mut editor = Editor::new(&egui::Context::default(), RecentFiles::default());
        editor.session.handle(Action::OpenExample(Example::Dome));
        wait(&mut editor, is_solved);
        editor.session.handle(Action::SetSettings(Settings::new(method, Family::default())));
        wait(&mut editor, is_solved);
        editor.session.handle(Action::Fix([0, 10, 20].map(VertexId::new).to_vec()));
        wait(&mut editor, is_solved);
        let vertex = VertexId::new(10);
        let target = editor.session.document().targets[&vertex].uv + glam::DVec2::new(0.1, 0.05);
        editor.session.handle(Action::MovePin { vertex, target });
        wait(&mut editor, |editor| editor.session.preview().is_some());
        editor
    }

    fn a_while_ago() -> Instant {
        Instant::now().checked_sub(Duration::from_secs(1)).expect("the clock runs for longer")
    }

    #[test]
    fn a_preview_says_so_while_its_run_is_solved_for_long() {
        let mut editor = dragging(Method::Natural);
        editor.session.handle(Action::Rest);
        // Backdate the start of the work. No poll follows, so no step has replaced the preview.
        editor.gpu.note_work(true, a_while_ago());
        let (pill, busy) = shown(&editor);
        assert!(matches!(busy, Some(Busy::Solving(_))), "{busy:?}");
        let pill = pill.expect("the preview says what it is");
        assert_eq!(pill.sign, Sign::Warning, "{}", pill.words);
        // The verdict on the preview, which may be on its way, follows the dot.
        assert_message("verdict-pill-preview", pill.words.split(" · ").next().unwrap_or_default());
    }

    #[test]
    fn a_planar_sheet_under_a_pin_is_proved_and_says_what_is_in_the_way() {
        let mut editor = dragging(Method::Auto);
        let obstacle =
            |editor: &Editor| editor.session.preview().and_then(|preview| preview.live).map(|live| live.obstacle);
        let free = pill(&editor).expect("there is one");
        assert_eq!((free.sign, obstacle(&editor)), (Sign::Good, Some(None)));
        let over = editor.session.document().targets[&VertexId::new(20)].uv;
        editor.session.handle(Action::MovePin { vertex: VertexId::new(10), target: over });
        wait(&mut editor, |editor| !editor.session.is_following());
        let held = pill(&editor).expect("there is one");
        let in_the_way = Blocker::Pin(VertexId::new(20));
        assert_eq!((held.sign, obstacle(&editor)), (Sign::Good, Some(Some(in_the_way))));
        assert_message("verdict-pill-live-drag", &[free.words, held.words].join("\n"));
    }

    #[test]
    fn work_takes_the_place_of_any_other_verdict() {
        let mut editor = dragging(Method::Natural);
        editor.session.handle(Action::EndGesture);
        wait(&mut editor, is_solved);
        editor.session.handle(Action::Solve);
        editor.gpu.note_work(true, a_while_ago());
        let (pill, busy) = shown(&editor);
        assert!(pill.is_none() && busy.is_some());
    }
}
