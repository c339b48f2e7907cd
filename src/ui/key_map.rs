//! Keys of the shortcuts as the user has set them. egui's context keeps them, so that every tooltip can name them.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{self, Id, Key, KeyboardShortcut, Modifiers};

use super::keys::{BINDINGS, Binding};
use super::state::Request;

/// Sets of keys to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyPreset {
    /// Keys of the table.
    Freebound,
    /// Keys that users of Blender's UV editor know.
    BlenderLike,
}

const NONE: Modifiers = Modifiers::NONE;

/// Changes of the Blender-like keys: keys of the table, and the keys in their place.
const BLENDER: [[KeyboardShortcut; 2]; 17] = [
    [key(NONE, Key::F), key(NONE, Key::Home)],
    [key(NONE, Key::Home), key(Modifiers::SHIFT, Key::ArrowLeft)],
    [key(NONE, Key::End), key(Modifiers::SHIFT, Key::ArrowRight)],
    [key(NONE, Key::Tab), key(Modifiers::COMMAND, Key::Space)],
    [key(Modifiers::COMMAND, Key::B), key(NONE, Key::N)],
    [key(Modifiers::COMMAND, Key::A), key(NONE, Key::A)],
    [key(Modifiers::COMMAND, Key::P), key(NONE, Key::F3)],
    [key(NONE, Key::W), key(Modifiers::SHIFT, Key::Z)],
    [key(NONE, Key::Backspace), key(Modifiers::ALT, Key::P)],
    [key(Modifiers::COMMAND, Key::Num1), key(NONE, Key::Num1)],
    [key(NONE, Key::Num1), key(Modifiers::COMMAND, Key::Num1)],
    [key(Modifiers::COMMAND, Key::Num2), key(NONE, Key::Num2)],
    [key(NONE, Key::Num2), key(Modifiers::COMMAND, Key::Num2)],
    [key(Modifiers::COMMAND, Key::Num3), key(NONE, Key::Num3)],
    [key(NONE, Key::Num3), key(Modifiers::COMMAND, Key::Num3)],
    [key(Modifiers::COMMAND, Key::Num4), key(NONE, Key::Num4)],
    [key(NONE, Key::Num4), key(Modifiers::COMMAND, Key::Num4)],
];

const fn key(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(modifiers, key)
}

impl KeyPreset {
    /// All presets.
    pub const ALL: [Self; 2] = [Self::Freebound, Self::BlenderLike];

    /// Name for the user.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Freebound => "Freebound",
            Self::BlenderLike => "Blender-like",
        }
    }

    /// Keys of the preset.
    pub fn map(self) -> KeyMap {
        let changes = match self {
            Self::Freebound => &[][..],
            Self::BlenderLike => &BLENDER,
        };
        let place = |usual: KeyboardShortcut| BINDINGS.iter().position(|binding| binding.shortcut == usual);
        KeyMap { changed: changes.iter().filter_map(|[usual, new]| Some((place(*usual)?, *new))).collect() }
    }
}

/// Keys of all shortcuts: those of the table, and the changes of the user by their places in the table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyMap {
    changed: BTreeMap<usize, KeyboardShortcut>,
}

impl KeyMap {
    /// Current keys of a window.
    pub fn of(context: &egui::Context) -> Arc<Self> {
        context.data(|data| data.get_temp(id())).unwrap_or_default()
    }

    /// Makes these the keys of a window.
    pub fn put_on(self, context: &egui::Context) {
        context.data_mut(|data| data.insert_temp(id(), Arc::new(self)));
    }

    /// Keys of a binding.
    pub fn shortcut(&self, place: usize) -> KeyboardShortcut {
        self.changed.get(&place).copied().unwrap_or(BINDINGS[place].shortcut)
    }

    /// True if the user has changed a binding.
    pub(super) fn is_changed(&self, place: usize) -> bool {
        self.changed.contains_key(&place)
    }

    /// Binding with exactly these keys.
    pub(super) fn owner(&self, shortcut: KeyboardShortcut) -> Option<usize> {
        (0..BINDINGS.len()).find(|&place| self.shortcut(place) == shortcut)
    }

    /// Binding that a press belongs to.
    pub(super) fn pressed(&self, key: Key, modifiers: Modifiers) -> Option<&'static Binding> {
        let modifiers = if key == Key::Questionmark { Modifiers { shift: false, ..modifiers } } else { modifiers };
        let is_pressed =
            |shortcut: KeyboardShortcut| key == shortcut.logical_key && modifiers.matches_exact(shortcut.modifiers);
        let place = (0..BINDINGS.len()).find(|&place| is_pressed(self.shortcut(place)))?;
        Some(&BINDINGS[place])
    }

    /// Keys of the first binding of a request.
    pub(super) fn shortcut_of(&self, request: &Request) -> Option<KeyboardShortcut> {
        let place = BINDINGS.iter().position(|binding| (binding.request)() == *request)?;
        Some(self.shortcut(place))
    }

    /// Gives a binding other keys. Another binding with these keys gets its old ones.
    pub fn change(&mut self, place: usize, shortcut: KeyboardShortcut) {
        let before = self.shortcut(place);
        if let Some(owner) = self.owner(shortcut).filter(|owner| *owner != place) {
            self.set(owner, before);
        }
        self.set(place, shortcut);
    }

    fn set(&mut self, place: usize, shortcut: KeyboardShortcut) {
        if shortcut == BINDINGS[place].shortcut {
            self.changed.remove(&place);
        } else {
            self.changed.insert(place, shortcut);
        }
    }

    /// Changes by the keys of the table, for the preferences.
    pub(super) fn written(&self) -> BTreeMap<String, String> {
        self.changed.iter().map(|(&place, new)| (words_of(BINDINGS[place].shortcut), words_of(*new))).collect()
    }

    /// Changes of the preferences. Ignores unknown keys, and changes that leave one press to two bindings.
    pub(super) fn read(written: &BTreeMap<String, String>) -> Self {
        let place = |usual: &str| BINDINGS.iter().position(|binding| words_of(binding.shortcut) == usual);
        let changed = written.iter().filter_map(|(usual, new)| Some((place(usual)?, shortcut_of_words(new)?)));
        let map = Self { changed: changed.collect() };
        let is_unique = |place: usize| map.owner(map.shortcut(place)) == Some(place);
        if (0..BINDINGS.len()).all(is_unique) { map } else { Self::default() }
    }
}

fn id() -> Id {
    Id::unique("keys of the shortcuts")
}

/// Shortcut of a press, without the modifiers that say the same twice.
pub(super) fn shortcut_of_press(key: Key, modifiers: Modifiers) -> KeyboardShortcut {
    let Modifiers { alt, ctrl, shift, command, .. } = modifiers;
    let shift = shift && key != Key::Questionmark;
    KeyboardShortcut::new(Modifiers { alt, ctrl: ctrl && !command, shift, mac_cmd: false, command }, key)
}

/// Shortcut in words that do not depend on the system, such as "Ctrl+Shift+Z".
fn words_of(shortcut: KeyboardShortcut) -> String {
    let Modifiers { alt, ctrl, shift, command, .. } = shortcut.modifiers;
    let held = [(command, "Ctrl+"), (ctrl, "Control+"), (alt, "Alt+"), (shift, "Shift+")];
    let held: String = held.into_iter().filter(|(is_held, _)| *is_held).map(|(_, words)| words).collect();
    format!("{held}{}", shortcut.logical_key.name())
}

fn shortcut_of_words(words: &str) -> Option<KeyboardShortcut> {
    let mut parts: Vec<&str> = words.split('+').collect();
    let key = Key::from_name(parts.pop()?)?;
    let mut modifiers = Modifiers::NONE;
    for part in parts {
        match part {
            "Ctrl" => modifiers.command = true,
            "Control" => modifiers.ctrl = true,
            "Alt" => modifiers.alt = true,
            "Shift" => modifiers.shift = true,
            _ => return None,
        }
    }
    Some(KeyboardShortcut::new(modifiers, key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_has_each_key_once_and_comes_back_from_its_words() {
        for preset in KeyPreset::ALL {
            let map = preset.map();
            for (place, binding) in BINDINGS.iter().enumerate() {
                assert_eq!(map.owner(map.shortcut(place)), Some(place), "{}", binding.about);
            }
            assert_eq!(KeyMap::read(&map.written()), map);
        }
        assert_eq!(KeyPreset::BlenderLike.map().written().len(), BLENDER.len());
    }

    #[test]
    fn changes_that_make_no_sense_are_ignored() {
        let read = |changes: &[[&str; 2]]| {
            KeyMap::read(&changes.iter().map(|[usual, new]| ((*usual).to_owned(), (*new).to_owned())).collect())
        };
        assert_eq!(read(&[["Ctrl+O", "Ctrl+J"]]).written().len(), 1);
        for nonsense in [["Ctrl+O", "Ctrl+S"], ["Ctrl+O", "Hyper+L"], ["Ctrl+O", ""], ["No key", "F5"]] {
            assert_eq!(read(&[nonsense]), KeyMap::default(), "{nonsense:?}");
        }
    }

    #[test]
    fn keys_of_another_binding_are_swapped() {
        let place = |key| BINDINGS.iter().position(|binding| binding.shortcut == key).expect("a binding");
        let [w, h] = [Key::W, Key::H].map(|key| KeyboardShortcut::new(Modifiers::NONE, key));
        let mut map = KeyMap::default();
        map.change(place(w), h);
        assert_eq!([map.shortcut(place(w)), map.shortcut(place(h))], [h, w]);
        map.change(place(w), w);
        assert_eq!(map, KeyMap::default());
    }
}
