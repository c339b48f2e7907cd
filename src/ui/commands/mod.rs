//! Commands of the window: one table for the menus and the command palette.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | commands, the builder of menus, the list of all commands |
//! | `menus.rs` | the menus |
//! | `search.rs` | search of commands by words |

mod menus;
mod search;

pub(in crate::ui) use menus::MENUS;
pub(in crate::ui) use search::{matches_words, ranked};

use super::keys::BINDINGS;
use super::state::Request;
use super::{Editor, sentence};

/// Reason why a command cannot be carried out now; `Ok` if it can.
pub(in crate::ui) type Gate = Result<(), &'static str>;

/// Gate of commands that can always be carried out.
pub(in crate::ui) const ALWAYS: Gate = Ok(());

/// Gate that is open if `is_open`, with the reason otherwise.
pub(in crate::ui) const fn when(is_open: bool, reason: &'static str) -> Gate {
    if is_open { Ok(()) } else { Err(reason) }
}

/// Gate that is open unless there is a reason.
pub(in crate::ui) fn unless(reason: Option<&'static str>) -> Gate {
    reason.map_or(ALWAYS, Err)
}

/// Mark of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum Mark {
    None,
    /// A choice among several; true if chosen.
    Choice(bool),
    /// A switch; true if on.
    Switch(bool),
}

/// Command of the window, as an entry of a menu or of the palette.
#[derive(Clone, Debug)]
pub(in crate::ui) struct MenuCommand {
    pub(in crate::ui) words: String,
    /// Titles of the menus above it, such as "File › Export". Empty if no menu has it.
    pub(in crate::ui) path: String,
    pub(in crate::ui) tip: Option<&'static str>,
    pub(in crate::ui) request: Request,
    /// Request whose keys are shown, if it differs.
    pub(in crate::ui) keys: Option<Request>,
    pub(in crate::ui) gate: Gate,
    pub(in crate::ui) mark: Mark,
}

impl MenuCommand {
    /// Name that identifies the command in every run.
    pub(in crate::ui) fn id(&self) -> String {
        format!("{} › {}", self.path, self.words)
    }

    /// Request whose keys are shown.
    pub(in crate::ui) fn request_of_keys(&self) -> &Request {
        self.keys.as_ref().unwrap_or(&self.request)
    }

    fn has_tip(self, tip: &'static str) -> Self {
        Self { tip: Some(tip), ..self }
    }

    fn has_keys_of(self, request: Request) -> Self {
        Self { keys: Some(request), ..self }
    }
}

/// Part of a menu.
#[derive(Clone, Debug)]
pub(in crate::ui) enum MenuNode {
    Entry(Box<MenuCommand>),
    Submenu { title: String, nodes: Vec<MenuNode> },
    Separator,
    Remark(&'static str),
}

/// Builder of a menu.
pub(in crate::ui) struct MenuBuilder<'a> {
    editor: &'a Editor,
    path: String,
    nodes: Vec<MenuNode>,
}

impl<'a> MenuBuilder<'a> {
    fn part(&mut self, title: &str, add: impl FnOnce(&mut MenuBuilder<'a>)) {
        let path = format!("{} › {title}", self.path);
        let mut inner = MenuBuilder { editor: self.editor, path, nodes: Vec::new() };
        add(&mut inner);
        self.nodes.push(MenuNode::Submenu { title: title.to_owned(), nodes: inner.nodes });
    }

    fn command(&self, gate: Gate, words: &str, request: impl Into<Request>) -> MenuCommand {
        MenuCommand {
            words: words.to_owned(),
            path: self.path.clone(),
            tip: None,
            request: request.into(),
            keys: None,
            gate,
            mark: Mark::None,
        }
    }

    fn add(&mut self, command: MenuCommand) {
        self.nodes.push(MenuNode::Entry(Box::new(command)));
    }

    fn item(&mut self, gate: Gate, words: &str, request: impl Into<Request>) {
        self.add(self.command(gate, words, request));
    }

    /// Entry with a tooltip.
    fn explained(&mut self, gate: Gate, [words, tip]: [&'static str; 2], request: impl Into<Request>) {
        self.add(self.command(gate, words, request).has_tip(tip));
    }

    /// Entry of a choice, highlighted if chosen.
    fn choice(&mut self, on: bool, words: &str, request: Request) {
        self.add(MenuCommand { mark: Mark::Choice(on), ..self.command(ALWAYS, words, request) });
    }

    /// Entry that toggles an option, with a check mark if on.
    fn switch(&mut self, on: bool, words: &str, request: Request) {
        self.add(MenuCommand { mark: Mark::Switch(on), ..self.command(ALWAYS, words, request) });
    }

    fn separator(&mut self) {
        self.nodes.push(MenuNode::Separator);
    }

    fn remark(&mut self, words: &'static str) {
        self.nodes.push(MenuNode::Remark(words));
    }
}

/// Entries of a menu of the bar, by its place.
pub(in crate::ui) fn menu(editor: &Editor, place: usize) -> Vec<MenuNode> {
    let (title, build) = MENUS[place];
    let mut builder = MenuBuilder { editor, path: title.to_owned(), nodes: Vec::new() };
    build(&mut builder);
    builder.nodes
}

/// All commands: every entry of every menu, then every shortcut that no menu has.
pub(in crate::ui) fn all(editor: &Editor) -> Vec<MenuCommand> {
    let mut commands = Vec::new();
    for place in 0..MENUS.len() {
        collect(menu(editor, place), &mut commands);
    }
    for binding in BINDINGS {
        let request = (binding.request)();
        let is_known = |command: &MenuCommand| command.request == request;
        if !commands.iter().any(is_known) {
            let words = sentence(binding.about);
            let (path, gate, mark) = (String::new(), ALWAYS, Mark::None);
            commands.push(MenuCommand { words, path, tip: None, request, keys: None, gate, mark });
        }
    }
    commands
}

fn collect(nodes: Vec<MenuNode>, commands: &mut Vec<MenuCommand>) {
    for node in nodes {
        match node {
            MenuNode::Entry(command) => commands.push(*command),
            MenuNode::Submenu { nodes, .. } => collect(nodes, commands),
            MenuNode::Separator | MenuNode::Remark(_) => {}
        }
    }
}
