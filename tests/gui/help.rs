//! Windows that help: command palette, list of keys and their changes, messages of the run, About.

use std::collections::BTreeSet;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, KeyboardShortcut, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::app::LaunchFile;
use freebound::session::Action;
use freebound::ui::{BINDINGS, KeyMap, KeyPreset, Request, Tab, Tool};

use crate::harness::{SIZE, Window, sheet};

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(6, 0.3))
}

/// Names of the commands that the palette lists, from top to bottom.
fn listed(window: &Window) -> Vec<String> {
    let mut rows: Vec<(f32, String)> = (window.harness.query_all_by_role(Role::Button))
        .filter_map(|node| Some((node.rect().top(), node.accesskit_node().label()?)))
        .filter_map(|(top, label)| Some((top, label.strip_prefix("Command ")?.to_owned())))
        .collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, name)| name).collect()
}

fn find(window: &mut Window, words: &str) -> Vec<String> {
    window.fill_in(Role::SearchInput, "Find a command", words);
    window.settle();
    listed(window)
}

fn place_of(request: &Request) -> usize {
    BINDINGS.iter().position(|binding| (binding.request)() == *request).expect("a key")
}

#[test]
fn the_palette_finds_commands_by_words_in_any_order_and_runs_them() {
    let mut window = window();
    window.press(Modifiers::COMMAND, Key::P);
    assert_eq!(find(&mut window, "scratch solve")[0], "Solve › Solve from scratch");
    assert_eq!(find(&mut window, "wrfr")[0], "View › Wireframe");
    window.key(Key::Enter);
    assert!(window.editor().pane_shading.wireframe && !window.editor().layout.help.has_palette());
    window.press(Modifiers::COMMAND, Key::P);
    assert_eq!(listed(&window)[0], "View › Wireframe", "the command chosen last comes first");
    let second = listed(&window)[1].clone();
    window.key(Key::ArrowDown);
    let is_selected = |window: &Window, name: &str| {
        let name = format!("Command {name}");
        let node = window.harness.get_by_role_and_label(Role::Button, &name);
        node.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    assert!(is_selected(&window, &second));
    window.key(Key::Escape);
    assert!(!window.editor().layout.help.has_palette());
    window.press(Modifiers::COMMAND, Key::P);
    assert!(!find(&mut window, "sharp cut").is_empty() && find(&mut window, "zebra").is_empty());
    window.press(Modifiers::COMMAND, Key::P);
    assert!(!window.editor().layout.help.has_palette(), "its keys close it");
    window.press(Modifiers::COMMAND, Key::P);
    find(&mut window, "all keys");
    window.click("Command Help › All keys");
    assert!(window.editor().layout.keys_shown);
}

#[test]
fn the_documentation_opens_turns_its_pages_and_finds_sections() {
    let mut window = window();
    window.menu(&["Help", "Documentation"]);
    assert!(window.editor().layout.help.has_documentation());
    assert!(window.shows("Choose where to start:"), "the first page");
    window.click("Choosing a method");
    assert!(window.shows("Decision table"));
    window.click("Back");
    assert!(window.shows("Choose where to start:") && !window.has_button("Back"));
    window.fill_in(Role::SearchInput, "Find in the documentation", "zebra");
    window.settle();
    assert!(window.shows("No section has all these words."));
    window.fill_in(Role::SearchInput, "Find in the documentation", "word proved");
    window.settle();
    window.click("Planar maps and proofs: The word proved");
    window.step();
    assert!(window.shows("The proof rests on a theorem."));
    window.key(Key::Escape);
    assert!(!window.editor().layout.help.has_documentation());
}

/// Clicks a link of the documentation, or to it. A page scrolls to its section in the frame after it is shown.
fn click_link(window: &mut Window, link: &str) {
    window.harness.get_by_role_and_label(Role::Link, link).click();
    window.settle();
    for _ in 0..3 {
        window.step();
    }
}

#[test]
fn links_of_a_page_lead_on_also_above_lines_of_code() {
    let mut window = window();
    window.menu(&["Help", "Documentation"]);
    // The link is in the first block of the page, and blocks of code follow.
    window.click("The command line");
    click_link(&mut window, "the window");
    assert!(window.shows("Parts of the screen"), "{:?}", window.words());
    window.click("Back");
    assert!(window.shows("works without a screen"));
    // A link within the page leads past lines of code.
    window.fill_in(Role::SearchInput, "Find in the documentation", "takes the place of the exported");
    window.settle();
    window.click("To Blender and back: Out of Blender");
    window.step();
    click_link(&mut window, "Seams from Blender");
    assert!(!window.shows("Limit to: Selected Objects"), "{:?}", window.words());
}

#[test]
fn links_of_the_panels_open_the_documentation_at_their_sections() {
    let mut window = window();
    window.editor_mut().handle(Request::ShowTab(Tab::Method));
    window.settle();
    for (link, words) in [("Which method?", "Decision table"), ("What do the numbers mean?", "Columns")] {
        click_link(&mut window, link);
        assert!(window.editor().layout.help.has_documentation(), "{link}");
        assert!(window.shows(words), "{link}");
        window.key(Key::Escape);
    }
}

#[test]
fn a_command_that_cannot_be_carried_out_says_why_and_does_nothing() {
    let mut window = window();
    window.press(Modifiers::COMMAND, Key::P);
    assert_eq!(find(&mut window, "redo")[0], "Edit › Redo");
    assert!(!window.is_enabled("Command Edit › Redo") && window.shows("There is nothing to redo"));
    window.key(Key::Enter);
    assert!(window.editor().layout.help.has_palette(), "it stays open");
}

/// Names of all commands of the palette.
fn all_commands(window: &mut Window) -> BTreeSet<String> {
    window.press(Modifiers::COMMAND, Key::P);
    let mut names = BTreeSet::new();
    loop {
        let before = names.len();
        names.extend(listed(window));
        (0..11).for_each(|_| window.key_now(Key::ArrowDown));
        window.settle();
        names.extend(listed(window));
        if names.len() == before {
            break;
        }
    }
    window.key(Key::Escape);
    names
}

#[test]
fn the_palette_has_every_entry_of_every_menu_and_every_key() {
    let mut window = window();
    let commands = all_commands(&mut window);
    let words: BTreeSet<&str> = commands.iter().map(|name| name.rsplit(" › ").next().unwrap_or(name)).collect();
    // Each menu and each of its submenus is opened, and its entries are looked up.
    let buttons = |window: &Window| -> BTreeSet<String> {
        let nodes = window.harness.query_all_by_role(Role::Button);
        nodes.filter_map(|node| node.accesskit_node().label()).collect()
    };
    let usual = buttons(&window);
    let mut seen = 0;
    for (menu, parts) in [
        ("File", &["Recent", "Examples", "Export", "Size in files"][..]),
        ("Edit", &["Tools", "Select", "Seams"]),
        (
            "View",
            &["Shading of the mesh", "Shading of the embedding", "Checker and pixels", "Show", "Side panels", "Theme"],
        ),
        ("Solve", &[]),
        ("Help", &[]),
    ] {
        for part in std::iter::once(None).chain(parts.iter().map(Some)) {
            window.click(menu);
            if let Some(part) = part {
                window.click(part);
            }
            for name in buttons(&window).difference(&usual) {
                let is_part =
                    parts.iter().chain([&"Steps and curves", &"What clicks select"]).any(|part| name.starts_with(part));
                let is_command = words.iter().any(|words| name.starts_with(words));
                assert!(is_part || is_command, "{menu}: {name:?} is not in the palette");
                seen += usize::from(is_command);
            }
            window.key(Key::Escape);
            window.key(Key::Escape);
        }
    }
    assert!(seen > 60, "only {seen} entries were found");
    for binding in BINDINGS {
        let request = (binding.request)();
        window.press(Modifiers::COMMAND, Key::P);
        let named = window.harness.ctx.format_shortcut(&binding.shortcut);
        let keys = named.replace("OpenBracket", "[").replace("CloseBracket", "]");
        let is_first = place_of(&request) == BINDINGS.iter().position(|b| b.shortcut == binding.shortcut).unwrap();
        let painted = || window.words().contains(&keys);
        let is_known = commands.iter().any(|name| name.ends_with(binding.about)) || painted();
        let is_there = is_known || !is_first || has_row_of(&mut window, &keys);
        assert!(is_there, "{} is not in the palette: {:?}", binding.about, window.words());
        window.key(Key::Escape);
    }
}

/// True if a row of the open palette shows these keys, scrolled to or not.
fn has_row_of(window: &mut Window, keys: &str) -> bool {
    (0..40).any(|_| {
        window.key_now(Key::PageDown);
        window.words().iter().any(|painted| painted == keys)
    })
}

#[test]
fn the_list_of_keys_is_searched_from_its_opening_on() {
    let mut window = window();
    window.key(Key::F1);
    window.type_text("frame");
    window.settle();
    let about = |request: &Request| BINDINGS[place_of(request)].about;
    let shows = |window: &Window, words: &str| window.harness.query_all_by_label(words).next().is_some();
    assert!(shows(&window, about(&Request::Frame)) && !shows(&window, about(&Request::SaveProject)));
    window.key(Key::F1);
    assert!(!window.editor().layout.keys_shown, "F1 closes it while its field has the focus");
}

fn change(window: &mut Window, request: &Request) {
    let (place, map) = (place_of(request), KeyMap::of(&window.harness.ctx));
    let (keys, about) = (window.harness.ctx.format_shortcut(&map.shortcut(place)), BINDINGS[place].about);
    window.fill_in(Role::SearchInput, "Find a key", about);
    window.settle();
    window.click(&format!("Change {keys}: {about}"));
}

#[test]
fn keys_are_changed_swapped_kept_and_reset() {
    let files = window();
    let start = || LaunchFile {
        file: Some(files.path("sheet.obj")),
        preferences: Some(files.path("window.json")),
        ..LaunchFile::default()
    };
    let mut window = Window::start(SIZE, start());
    let fix = Request::SetTool(Tool::Fix);
    window.key(Key::F1);
    change(&mut window, &fix);
    window.key(Key::K);
    window.key(Key::Escape);
    window.key(Key::K);
    assert_eq!(window.editor().tools.tool(), Tool::Fix);
    window.key(Key::V);
    window.key(Key::P);
    assert_eq!(window.editor().tools.tool(), Tool::Select, "its old key does nothing");
    // Keys of another binding: left alone, then swapped.
    window.key(Key::F1);
    for (answer, expected) in [("Leave both", [Key::K, Key::W]), ("Swap", [Key::W, Key::K])] {
        change(&mut window, &fix);
        window.key(Key::W);
        assert!(window.has_button("Swap"));
        window.click(answer);
        let map = KeyMap::of(&window.harness.ctx);
        let keys = [&fix, &Request::ToggleWireframe].map(|request| map.shortcut(place_of(request)).logical_key);
        assert_eq!(keys, expected, "{answer}");
    }
    change(&mut window, &fix);
    window.key(Key::Escape);
    assert_eq!(KeyMap::of(&window.harness.ctx).shortcut(place_of(&fix)).logical_key, Key::W, "Esc leaves them");
    // Hints name them.
    change(&mut window, &Request::Do(Action::Step));
    window.key(Key::J);
    assert!(window.shows("J takes one more") || window.shows("Press J"), "{:?}", window.words());
    // The next run has them, too, and the menus name them.
    eframe::App::on_exit(window.harness.state_mut());
    let mut next = Window::start(SIZE, start());
    next.click("View");
    assert!(next.has_button("Wireframe") && next.shows("K"));
    next.key(Key::Escape);
    next.key(Key::F1);
    next.click("Reset");
    assert_eq!(*KeyMap::of(&next.harness.ctx), KeyMap::default());
}

#[test]
fn the_blender_like_keys_work() {
    let mut window = window();
    window.key(Key::F1);
    window.click("Blender-like");
    assert_eq!(*KeyMap::of(&window.harness.ctx), KeyPreset::BlenderLike.map());
    window.key(Key::Escape);
    window.key(Key::N);
    assert!(!window.editor().layout.panels_shown());
    window.key(Key::N);
    window.press(Modifiers::COMMAND, Key::Space);
    assert!(window.editor().layout.full().is_some());
    window.press(Modifiers::COMMAND, Key::Space);
    window.key(Key::F3);
    assert!(window.editor().layout.help.has_palette());
    window.key(Key::F3);
    assert!(!window.editor().layout.help.has_palette());
    let frame = KeyMap::of(&window.harness.ctx).shortcut(place_of(&Request::Frame));
    assert_eq!(frame, KeyboardShortcut::new(Modifiers::NONE, Key::Home));
}

#[test]
fn help_has_the_version_and_the_messages_of_the_run() {
    let mut window = window();
    window.menu(&["Help", "About Freebound"]);
    window.click("Copy the text");
    let copied = |window: &Window, words: &str| {
        let commands = &window.harness.output().platform_output.commands;
        commands.iter().any(|c| matches!(c, egui::OutputCommand::CopyText(text) if text.contains(words)))
    };
    assert!(window.shows(env!("CARGO_PKG_VERSION")));
    window.key(Key::Escape);
    let gone = window.path("gone.txt");
    window.editor_mut().session.handle(Action::ImportConstraints(gone));
    window.settle();
    let text = window.editor().session.messages()[0].text.clone();
    window.click("Dismiss");
    window.menu(&["Help", "Messages of this run"]);
    let node = window.harness.get_by_role_and_label(Role::Button, "Copy all messages");
    node.click();
    window.step();
    assert!(copied(&window, &text));
    assert_eq!(window.editor().session.message_log().len(), 1);
}
