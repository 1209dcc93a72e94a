//! The parser and its queries: the trees of the corpus, the plans of the repository, the words of the schema.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use psd_plan::schema::{BLOCKS, ITEM_WORDS};
use psd_testing::vocabulary;
use psd_text::markdown;
use tree_sitter::{Language, Node, Parser, Query, QueryCursor, StreamingIterator as _, Tree};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn language() -> Language {
    tree_sitter_psd::LANGUAGE.into()
}

fn tree(text: &str) -> Tree {
    let mut parser = Parser::new();
    parser.set_language(&language()).expect("the ABI is known");
    parser.parse(text, None).expect("a tree")
}

/// The files of a folder and of those in it, whose names end so.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let (mut folders, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if endings
                .iter()
                .any(|end| path.to_string_lossy().ends_with(end))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A tree as the corpus writes it, without the names of fields.
fn written(node: Node<'_>) -> String {
    let mut cursor = node.walk();
    let mut parts = vec![node.kind().to_owned()];
    parts.extend(node.named_children(&mut cursor).map(written));
    format!("({})", parts.join(" "))
}

/// Several spaces and line ends are one space.
fn spaced(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace(" )", ")")
}

/// Title, text and tree of each case; a case with `:error` in its title has no tree.
fn cases(page: &str) -> Vec<(String, String, String)> {
    const RULE: &str = "==================\n";
    let mut parts = page.split(RULE).skip(1);
    let mut cases = Vec::new();
    while let (Some(title), Some(body)) = (parts.next(), parts.next()) {
        let (text, tree) = body.split_once("\n---\n").unwrap_or((body, ""));
        cases.push((title.trim().to_owned(), text.to_owned(), spaced(tree)));
    }
    cases
}

#[test]
fn the_corpus_has_these_trees() {
    let mut count = 0;
    for path in files(&folder().join("test/corpus"), &[".txt"]) {
        for (title, text, wanted) in cases(&read(&path)) {
            let tree = tree(&text);
            let fails = title.ends_with(":error");
            assert_eq!(tree.root_node().has_error(), fails, "{title}");
            if !fails {
                assert_eq!(written(tree.root_node()), wanted, "{title}");
            }
            count += 1;
        }
    }
    assert!(count >= 10, "{count} cases");
}

/// The text of a plan: a file, or the `psd` blocks of a document.
fn plan(path: &Path) -> String {
    let text = read(path);
    if markdown::is_document(&path.to_string_lossy()) {
        markdown::Document::read(&text).blanked(&text)
    } else {
        text
    }
}

#[test]
fn every_plan_is_parsed_without_an_error() {
    let root = folder().ancestors().nth(3).expect("the repository");
    let mut paths = files(&root.join("plans"), &[".psd", "_procedure.md"]);
    paths.extend(files(&root.join("tests/lang/ok"), &[".psd", ".md"]));
    for path in &paths {
        let text = plan(path);
        assert!(!text.is_empty(), "{}: no plan", path.display());
        let tree = tree(&text);
        let shown = tree.root_node().to_sexp();
        assert!(!tree.root_node().has_error(), "{}: {shown}", path.display());
    }
    assert!(paths.len() > 60, "{} plans", paths.len());
}

#[test]
fn every_query_names_nodes_of_the_grammar() {
    let editors = folder().parent().expect("the folder of the editors");
    let paths = files(editors, &[".scm"]);
    for path in &paths {
        if let Err(error) = Query::new(&language(), &read(path)) {
            panic!("{}: {error}", path.display());
        }
    }
    assert!(paths.len() >= 6, "{} queries", paths.len());
}

/// The captures of `words`, which all have the same, in a plan that holds each of them at the place of `*`.
fn captures(query: &str, place: &str, word: &str) -> BTreeSet<String> {
    let text = place.replace('*', word);
    let at = place.find('*').expect("a place");
    let tree = tree(&text);
    assert!(!tree.root_node().has_error(), "{text}");
    let query = Query::new(&language(), query).expect("the query is right");
    let mut cursor = QueryCursor::new();
    let mut found = cursor.captures(&query, tree.root_node(), text.as_bytes());
    let mut names = BTreeSet::new();
    while let Some((matched, index)) = found.next() {
        let capture = matched.captures()[*index];
        let range = capture.node.byte_range();
        if range.start <= at && at + word.len() <= range.end {
            names.insert(query.capture_names()[capture.index as usize].to_owned());
        }
    }
    names
}

/// Each word has exactly the capture that is wanted.
#[track_caller]
fn all_are(place: &str, wanted: &str, words: impl IntoIterator<Item = &'static str>) {
    let query = read(&folder().join("queries/highlights.scm"));
    let mut count = 0;
    for word in words {
        let found = captures(&query, place, word);
        let found: Vec<&str> = found.iter().map(String::as_str).collect();
        assert_eq!(found, [wanted], "{word} in {place:?}");
        count += 1;
    }
    assert!(count > 0, "no words for {place:?}");
}

#[test]
fn every_word_of_the_schema_is_coloured() {
    for block in BLOCKS {
        let words = block.words();
        let (first, rest) = words.split_once(' ').unwrap_or((&words, ""));
        let (first, rest) = (
            first.to_owned().leak() as &str,
            rest.to_owned().leak() as &str,
        );
        all_are(&format!("* {rest} n {{ }}"), "keyword", [first]);
        if !rest.is_empty() {
            all_are(&format!("{first} * n {{ }}"), "keyword", [rest]);
        }
    }
    for word in ITEM_WORDS {
        let rest = match *word {
            "use" => "\"a\"",
            "require" => "\"a\" b < 1",
            _ => "a = 1",
        };
        all_are(&format!("* {rest}"), "keyword", [*word]);
    }
    all_are("rig n { * = 1 }", "property", vocabulary::fields());
    all_are(
        "let a = b(*: 1)",
        "variable.parameter",
        vocabulary::fields(),
    );
    all_are("let a = *(1)", "function.builtin", vocabulary::functions());
    all_are("let a = *(1)", "constructor", vocabulary::options());
    let bare = vocabulary::options()
        .into_iter()
        .filter(|word| *word != "within");
    all_are("let a = *", "constant.builtin", bare);
    all_are("let a = *", "boolean", vocabulary::TRUTHS);
    all_are("require \"a\" b * c of d", "keyword.operator", ["within"]);
    all_are("param a = 1 * 2 .. 3", "keyword.operator", ["between"]);
    all_are("let a = b * 1 .. 2", "keyword.operator", ["in"]);
    all_are("let a = 1 .. 2 * 3", "keyword.operator", ["step"]);
    all_are("require \"a\" b < 1 * c < 2", "keyword.operator", ["and"]);
    all_are("let a = 1 *", "type", ["kN/m", "%", "µm", "N/m^1.5", "in"]);
}
