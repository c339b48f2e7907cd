//! Search of commands by words in any order.

use super::MenuCommand;

/// Fit of a text to a word: none, letters in order, part of a word, or the beginning of a word.
fn fit(text: &str, word: &str) -> Option<usize> {
    let begins_word = |at: usize| text[..at].chars().next_back().is_none_or(|before| !before.is_alphanumeric());
    if text.match_indices(word).any(|(at, _)| begins_word(at)) {
        return Some(3);
    }
    if text.contains(word) {
        return Some(2);
    }
    let mut letters = text.chars();
    word.chars().all(|wanted| letters.any(|letter| letter == wanted)).then_some(1)
}

/// True if a text contains every word of a query, in any order and case.
pub(in crate::ui) fn matches_words(text: &str, query: &str) -> bool {
    let text = text.to_lowercase();
    query.to_lowercase().split_whitespace().all(|word| text.contains(word))
}

/// Commands that fit every word of a query, the best first. Without a query: all, those of `recent` first.
pub(in crate::ui) fn ranked(commands: Vec<MenuCommand>, query: &str, recent: &[String]) -> Vec<MenuCommand> {
    let query = query.to_lowercase();
    let words: Vec<&str> = query.split_whitespace().collect();
    if words.is_empty() {
        let age = |command: &MenuCommand| {
            let id = command.id();
            recent.iter().position(|other| *other == id).unwrap_or(usize::MAX)
        };
        let mut commands = commands;
        commands.sort_by_cached_key(age);
        return commands;
    }
    let score = |command: &MenuCommand| {
        let (own, above) = (command.words.to_lowercase(), command.path.to_lowercase());
        // The name counts more than the menus above it.
        let of_word = |word: &&str| fit(&own, word).map(|fit| 4 * fit).max(fit(&above, word).filter(|fit| *fit > 1));
        words.iter().map(of_word).sum::<Option<usize>>()
    };
    let mut found: Vec<(usize, MenuCommand)> =
        commands.into_iter().filter_map(|command| Some((score(&command)?, command))).collect();
    // A command that can be carried out, and a shorter name, come first among equals.
    found.sort_by_key(|(score, command)| (std::cmp::Reverse(*score), command.gate.is_err(), command.words.len()));
    found.into_iter().map(|(_, command)| command).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::commands::{ALWAYS, Mark};
    use crate::ui::state::Request;

    fn commands() -> Vec<MenuCommand> {
        let command = |words: &str, path: &str| MenuCommand {
            words: words.to_owned(),
            path: path.to_owned(),
            tip: None,
            request: Request::Frame,
            keys: None,
            gate: ALWAYS,
            mark: Mark::None,
        };
        vec![
            command("Clear seams", "Edit › Seams"),
            command("Export seams…", "Edit › Seams"),
            command("Report…", "File › Export"),
            command("Next step", "Solve"),
        ]
    }

    fn found(query: &str) -> Vec<String> {
        ranked(commands(), query, &[]).into_iter().map(|command| command.words).collect()
    }

    #[test]
    fn words_are_found_in_any_order_and_names_before_menus() {
        assert_eq!(found("seams exp"), ["Export seams…"]);
        assert_eq!(found("export"), ["Export seams…", "Report…"]);
        assert_eq!(found("nxt"), ["Next step"]);
        assert!(found("zebra").is_empty());
    }

    #[test]
    fn recent_commands_come_first_without_a_query() {
        let recent = ["Solve › Next step".to_owned(), "File › Export › Report…".to_owned()];
        let words: Vec<String> = ranked(commands(), " ", &recent).into_iter().map(|command| command.words).collect();
        assert_eq!(words, ["Next step", "Report…", "Clear seams", "Export seams…"]);
    }
}
