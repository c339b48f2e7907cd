//! Licences and sources of all dependencies: those that `deny.toml` allows.

use std::fs;
use std::process::Command;

use serde_json::Value;

use super::sources::root;

/// Licences that `deny.toml` allows.
fn allowed() -> Vec<String> {
    let text = fs::read_to_string(root().join("deny.toml")).expect("deny.toml is there");
    let list = text.split_once("allow = [").and_then(|(_, rest)| rest.split_once(']')).expect("a list of licences").0;
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// True if a licence expression can be met with these licences. Parentheses are read as in SPDX expressions.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let text = expression.replace('/', " OR ");
    let text = text.trim();
    let mut depth = 0_i32;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '(') - i32::from(c == ')');
        // AND binds more tightly than OR: the expression is split at OR first.
        if depth == 0 && text[at..].starts_with(" OR ") {
            return is_met(&text[..at], allowed) || is_met(&text[at + 4..], allowed);
        }
    }
    depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '(') - i32::from(c == ')');
        if depth == 0 && text[at..].starts_with(" AND ") {
            return is_met(&text[..at], allowed) && is_met(&text[at + 5..], allowed);
        }
    }
    match text.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')) {
        Some(inner) => is_met(inner, allowed),
        None => allowed.iter().any(|licence| licence == text),
    }
}

#[test]
fn all_dependencies_have_allowed_licences_and_come_from_the_registry() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let versions = Command::new(&cargo).arg("-vV").output().expect("cargo runs").stdout;
    let versions = String::from_utf8(versions).expect("text");
    let host = versions.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    // Dependencies of other platforms are not downloaded.
    let output = Command::new(cargo)
        .args([
            "metadata",
            "--format-version",
            "1",
            "--offline",
            "--locked",
            "--all-features",
            "--filter-platform",
            host,
        ])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    let packages = metadata["packages"].as_array().expect("a list of packages");
    assert!(packages.len() > 100, "only {} packages", packages.len());
    let allowed = allowed();
    let mut bad = Vec::new();
    for package in packages {
        let licence = package["license"].as_str().unwrap_or("none");
        let is_own = package["source"].is_null();
        let is_of_registry = package["source"].as_str().is_some_and(|source| source.starts_with("registry+"));
        if !is_met(licence, &allowed) || !(is_own || is_of_registry) {
            bad.push(format!("{} {}: {licence}, from {}", package["name"], package["version"], package["source"]));
        }
    }
    assert!(bad.is_empty(), "licences or sources that deny.toml does not allow:\n{}", bad.join("\n"));
}

#[test]
fn licence_expressions_are_read_with_their_precedence() {
    let allowed = ["MIT", "ISC"].map(str::to_owned);
    for met in ["MIT", "MIT OR GPL-3.0", "GPL-3.0 OR MIT AND ISC", "MIT/Apache-2.0", "(MIT OR GPL-3.0) AND ISC"] {
        assert!(is_met(met, &allowed), "{met}");
    }
    for unmet in ["GPL-3.0", "MIT AND GPL-3.0", "(GPL-3.0 OR LGPL-3.0) AND MIT", "none"] {
        assert!(!is_met(unmet, &allowed), "{unmet}");
    }
}
