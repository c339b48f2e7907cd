//! Commands of the book: each `console` block prints what the book says. The list of options is that of the program.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::{Arg, Command, CommandFactory as _};
use freebound::cli::Arguments;

use crate::house::sources::files;

/// Variable that lets the test write the list of options anew.
const UPDATE: &str = "FREEBOUND_UPDATE";

fn book() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src")
}

/// Page with an empty line after each output, which trycmd takes for the end of the last line.
fn with_ends(page: &str) -> String {
    let (mut out, mut is_in_block, mut last) = (String::new(), false, "");
    for line in page.lines() {
        let ends_output = is_in_block && (line.starts_with("$ ") || line == "```");
        let has_output = !last.is_empty() && !["$ ", "? ", "```"].iter().any(|sign| last.starts_with(sign));
        if ends_output && has_output {
            out.push('\n');
        }
        is_in_block = if is_in_block { line != "```" } else { line == "```console" };
        out += line;
        out.push('\n');
        last = line;
    }
    out
}

/// Pages of the book with `console` blocks.
fn pages() -> Vec<PathBuf> {
    let has_commands = |path: &PathBuf| fs::read_to_string(path).is_ok_and(|page| page.contains("```console\n"));
    files(&book(), "md").into_iter().filter(has_commands).collect()
}

/// Every page runs in an empty folder of its own: a copy of the page stands beside an empty `.in` and `.out`, as trycmd
/// wants it.
#[test]
fn commands_of_the_book_print_what_it_says() {
    let copies = tempfile::tempdir().expect("a folder");
    let cases = trycmd::TestCases::new();
    cases.register_bin("freebound", Path::new(env!("CARGO_BIN_EXE_freebound")));
    let pages = pages();
    assert!(pages.len() > 5, "only {} pages have commands", pages.len());
    for page in pages {
        let name = page.strip_prefix(book()).expect("a page of the book").display().to_string().replace('/', "-");
        let copy = copies.path().join(name);
        for folder in ["in", "out"] {
            fs::create_dir(copy.with_extension(folder)).expect("a folder");
        }
        fs::write(&copy, with_ends(&fs::read_to_string(&page).expect("a page is text"))).expect("a copy");
        cases.case(copy);
    }
    cases.run();
}

/// Text as one line of a table.
fn sentence(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// Names and values of an option.
fn form(arg: &Arg) -> String {
    let values = arg.get_value_names().unwrap_or_default().iter().map(|name| format!("<{name}>")).collect::<Vec<_>>();
    let takes_values = arg.get_action().takes_values();
    let long = arg.get_long().map(|long| format!("--{long}"));
    let short = arg.get_short().map(|short| format!("-{short}"));
    let names: Vec<String> = short.into_iter().chain(long).collect();
    let values = if takes_values { values.join(" ") } else { String::new() };
    let form = if names.is_empty() { values } else { format!("{} {values}", names.join(", ")) };
    format!("`{}`", form.trim().replace('|', "\\|"))
}

fn options_of(command: &Command) -> String {
    let mut page = String::new();
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let _ = writeln!(page, "\n## freebound {}\n\n{}.\n", command.get_name(), sentence(&about).trim_end_matches('.'));
    let shown: Vec<&Arg> = command.get_arguments().filter(|arg| !arg.is_hide_set() && arg.get_id() != "help").collect();
    if shown.is_empty() {
        page.push_str("No options.\n");
        return page;
    }
    page.push_str("| option | effect |\n|---|---|\n");
    for arg in shown {
        let help = arg.get_long_help().or_else(|| arg.get_help()).map(ToString::to_string).unwrap_or_default();
        let default =
            arg.get_default_values().iter().map(|value| value.to_string_lossy()).collect::<Vec<_>>().join(" ");
        let values: Vec<String> =
            arg.get_possible_values().iter().map(|value| format!("`{}`", value.get_name())).collect();
        let values = if values.is_empty() || !arg.get_action().takes_values() {
            String::new()
        } else {
            format!(" Values: {}.", values.join(", "))
        };
        let default = if default.is_empty() || !arg.get_action().takes_values() {
            String::new()
        } else {
            format!(" Default: `{default}`.")
        };
        let _ = writeln!(page, "| {} | {}.{values}{default} |", form(arg), sentence(&help).trim_end_matches('.'));
    }
    page
}

#[test]
fn the_list_of_options_is_that_of_the_program() {
    let mut command = Arguments::command();
    command.build();
    let mut page =
        "# All options\n\nThis page is generated from the program: `freebound COMMAND --help` prints the same texts.\n"
            .to_owned();
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        page.push_str(&options_of(sub));
    }
    let path = book().join("options.md");
    if std::env::var_os(UPDATE).is_some() {
        fs::write(&path, &page).expect("the page can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == page,
        "book/src/options.md is old: {UPDATE}=1 cargo test --test program list_of_options writes it anew"
    );
}
