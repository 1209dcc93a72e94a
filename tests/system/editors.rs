//! The extension of VS Code in `grammar/editors/vscode/`, by the programs that it is for: the colours by the libraries of VS Code, the
//! bundle by esbuild.

mod vsix;

use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use psd_plan::schema::{BLOCKS, ITEM_WORDS};
use psd_testing::vocabulary;

use crate::needs;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/editors/vscode")
}

/// A piece of a line, and its scope if it is coloured.
type Token = (String, Option<String>);

/// The tokens of each text.
fn tokens(texts: &[String]) -> Vec<Vec<Token>> {
    let mut node = Command::new("node")
        .arg("test/tokens.mjs")
        .current_dir(folder())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let input = serde_json::to_vec(texts).unwrap();
    node.stdin.take().unwrap().write_all(&input).unwrap();
    let output = node.wait_with_output().unwrap();
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Each of the words at the place of `*`, and the scope that it must have.
type Case = (&'static str, &'static str, Vec<String>);

fn cases() -> Vec<Case> {
    let all = |words: vocabulary::Words| words.into_iter().map(str::to_owned).collect::<Vec<_>>();
    let some = |words: &[&str]| {
        words
            .iter()
            .map(|word| (*word).to_owned())
            .collect::<Vec<_>>()
    };
    let options = || all(vocabulary::options());
    let bare = options().into_iter().filter(|word| word != "within");
    let keywords = BLOCKS.iter().map(|block| block.words()).collect::<Vec<_>>();
    vec![
        ("* n {", "keyword.control", keywords.clone()),
        ("* {", "keyword.control", keywords),
        ("* a", "keyword.control", some(ITEM_WORDS)),
        (
            "limits * {",
            "entity.name.type",
            some(&["frame", "limits", "force"]),
        ),
        (
            "  * = 1",
            "variable.other.property",
            all(vocabulary::fields()),
        ),
        (
            "golden { * = 1 }",
            "variable.other.property",
            all(vocabulary::fields()),
        ),
        (
            "  a = b(*: 1)",
            "variable.parameter",
            all(vocabulary::fields()),
        ),
        (
            "let a = *(1)",
            "support.function",
            all(vocabulary::functions()),
        ),
        ("let a = *(1)", "variable.other.enummember", options()),
        (
            "let a = [*, 1]",
            "variable.other.enummember",
            bare.collect(),
        ),
        (
            "let a = *",
            "constant.language.boolean",
            some(&vocabulary::TRUTHS),
        ),
        (
            "let a = * / 20",
            "variable.other.enummember",
            some(&["critical"]),
        ),
        (
            "a * b",
            "keyword.control",
            some(&["and", "between", "of", "step", "within", "in"]),
        ),
        (
            "let a = 1 *",
            "support.type.unit",
            some(&["kN/m", "%", "µm", "N/m^1.5", "1/s", "in"]),
        ),
        (
            "let a = [1, 2] *",
            "support.type.unit",
            some(&["kN/m", "%", "mm"]),
        ),
        (
            "let a = 1 * 2",
            "keyword.control",
            some(&["step", "within", "and"]),
        ),
        (
            "let a = * mm",
            "constant.numeric",
            some(&["1", "0.5", "1e-9", "2.5E+3"]),
        ),
        (
            "let a = b.*",
            "variable.other.property",
            some(&["max_displacement", "u", "mass"]),
        ),
    ]
}

#[test]
fn every_word_of_the_schema_is_coloured() {
    if !needs::extension_packages() {
        return;
    }
    let cases = cases();
    let each = cases
        .iter()
        .flat_map(|(place, scope, words)| words.iter().map(move |word| (*place, *scope, word)));
    let each: Vec<(&str, &str, &String)> = each.collect();
    let texts: Vec<String> = each
        .iter()
        .map(|(place, _, word)| place.replace('*', word))
        .collect();
    let mut wrong = Vec::new();
    for ((_, scope, word), tokens) in each.iter().zip(tokens(&texts)) {
        // The word may come before its place too, as a keyword: `limits limits {`.
        let found = tokens.iter().rfind(|(text, _)| text == *word);
        let found = found.and_then(|(_, scope)| scope.clone());
        if found.as_deref() != Some(&format!("{scope}.psd")) {
            wrong.push(format!(
                "{word}: {found:?} instead of {scope}, in {tokens:?}"
            ));
        }
    }
    assert!(each.len() > 500, "{} words", each.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The name that a line declares, if it is an item.
fn declared(line: &str) -> Option<&str> {
    let head = line.split(['{', '=']).next()?;
    line.starts_with(char::is_alphabetic)
        .then(|| head.split_whitespace().last())?
}

/// What has no colour in the example plans is a bracket, a comma, or a name: of a plan, of a field of the same block, of a result.
#[test]
fn the_example_plans_are_coloured() {
    if !needs::extension_packages() {
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut texts = Vec::new();
    for folder in ["plans", "plans/lib"] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "psd") {
                texts.push(fs::read_to_string(path).unwrap());
            }
        }
    }
    assert!(texts.len() > 30, "{} plans", texts.len());
    let mut names: BTreeSet<&str> = texts
        .iter()
        .flat_map(|text| text.lines())
        .filter_map(declared)
        .collect();
    names.extend(vocabulary::fields());
    names.extend(
        BLOCKS
            .iter()
            .flat_map(|block| block.results)
            .map(|result| result.name),
    );
    let tokens = tokens(&texts);
    let plain = tokens.iter().flatten().filter(|(_, scope)| scope.is_none());
    let is_mark = |letter: char| letter.is_whitespace() || "{}[](),:.".contains(letter);
    let words = plain.flat_map(|(piece, _)| piece.split(is_mark));
    let wrong: BTreeSet<&str> = words
        .filter(|word| !word.is_empty() && !names.contains(word))
        .collect();
    assert!(wrong.is_empty(), "no colour: {wrong:?}");
}

#[test]
fn the_bundle_is_that_of_its_sources() {
    if !needs::extension_packages() {
        return;
    }
    let status = Command::new("node")
        .args(["build.mjs", "--check"])
        .current_dir(folder())
        .status();
    assert!(status.unwrap().success());
}
