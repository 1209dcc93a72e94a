//! Definition, references, highlights and rename, across files.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::testing::{Editor, edited, uri};

const LIBRARY: &str =
    "let speed = 1 m/s\nstriker hammer {\n  mass     = 10 kg\n  velocity = speed\n}\n";
const PLAN: &str = "use \"lib/s.psd\"\nimpact hit {\n  striker  = hammer\n  duration = 1 s\n}\nrequire \"slow\" speed < 2 m/s\nstudy scatter {\n  vary = [hammer.mass ~ normal(10 kg, sd: 1 kg)]\n}\nrequire \"rare\" scatter.probability(fails: \"slow\") < 5 %\n";
const OTHER: &str =
    "use \"lib/s.psd\"\nlet twice = 2 * speed\nimpact first {\n  striker = hammer\n}\n";

fn editor() -> Editor {
    Editor::with(&[
        ("lib/s.psd", LIBRARY),
        ("plan.psd", PLAN),
        ("other.psd", OTHER),
    ])
}

/// File, line and column of a place.
fn place(location: &Value) -> (String, u64, u64) {
    let start = &location["range"]["start"];
    let name = location["uri"].as_str().unwrap().replace(&uri(""), "");
    (
        name,
        start["line"].as_u64().unwrap(),
        start["character"].as_u64().unwrap(),
    )
}

fn places(answer: &Value) -> Vec<(String, u64, u64)> {
    let mut places: Vec<_> = answer.as_array().unwrap().iter().map(place).collect();
    places.sort();
    places
}

#[test]
fn a_name_leads_to_its_declaration() {
    for (marked, wanted) in [
        (
            PLAN.replacen("= hammer", "= ham‸mer", 1),
            ("lib/s.psd", 1, 8),
        ),
        (PLAN.replacen("speed <", "spe‸ed <", 1), ("lib/s.psd", 0, 4)),
        (
            PLAN.replacen("hammer.mass", "hammer.ma‸ss", 1),
            ("lib/s.psd", 2, 2),
        ),
        (
            PLAN.replacen("fails: \"slow", "fails: \"sl‸ow", 1),
            ("plan.psd", 5, 8),
        ),
        (PLAN.replacen("lib/s", "lib‸/s", 1), ("lib/s.psd", 0, 0)),
        (PLAN.replacen("hit {", "hi‸t {", 1), ("plan.psd", 1, 7)),
    ] {
        let mut editor = editor();
        let answer = editor.at("plan.psd", &marked, "textDocument/definition", json!({}));
        let (name, line, column) = wanted;
        assert_eq!(place(&answer), (name.to_owned(), line, column), "{marked}");
    }
    let mut editor = editor();
    let nothing = editor.at(
        "plan.psd",
        "let a = 1 k‸g\n",
        "textDocument/definition",
        json!({}),
    );
    assert_eq!(nothing, Value::Null);
}

#[test]
fn references_are_those_of_every_plan_that_uses_the_file() {
    let mut editor = editor();
    let marked = LIBRARY.replacen("let speed", "let spe‸ed", 1);
    let with = |declaration: bool| json!({ "context": { "includeDeclaration": declaration } });
    let answer = editor.at("lib/s.psd", &marked, "textDocument/references", with(true));
    let name = |name: &str, line, column| (name.to_owned(), line, column);
    let all = [
        name("lib/s.psd", 0, 4),
        name("lib/s.psd", 3, 13),
        name("other.psd", 1, 16),
        name("plan.psd", 5, 15),
    ];
    assert_eq!(places(&answer), all);
    let answer = editor.at("lib/s.psd", &marked, "textDocument/references", with(false));
    assert_eq!(places(&answer), all[1..]);
}

#[test]
fn highlights_are_those_of_the_document() {
    let mut editor = editor();
    let marked = LIBRARY.replacen("= speed", "= spe‸ed", 1);
    let answer = editor.at(
        "lib/s.psd",
        &marked,
        "textDocument/documentHighlight",
        json!({}),
    );
    let kinds: Vec<&Value> = answer
        .as_array()
        .unwrap()
        .iter()
        .map(|one| &one["kind"])
        .collect();
    assert_eq!(kinds, [3, 2]);
}

/// The files after a rename.
fn renamed(editor: &mut Editor, file: &str, marked: &str, to: &str) -> BTreeMap<String, String> {
    let answer = editor.at(
        file,
        marked,
        "textDocument/rename",
        json!({ "newName": to }),
    );
    let texts = [
        ("lib/s.psd", LIBRARY),
        ("plan.psd", PLAN),
        ("other.psd", OTHER),
    ];
    texts
        .into_iter()
        .filter_map(|(name, text)| {
            let edits = answer["changes"].get(uri(name))?;
            Some((name.to_owned(), edited(text, edits)))
        })
        .collect()
}

#[test]
fn a_rename_changes_every_file_that_has_the_name_and_nothing_else() {
    let mut editor = editor();
    let marked = PLAN.replacen("= hammer", "= ham‸mer", 1);
    let changed = renamed(&mut editor, "plan.psd", &marked, "mallet");
    assert_eq!(changed["lib/s.psd"], LIBRARY.replace("hammer", "mallet"));
    assert_eq!(changed["plan.psd"], PLAN.replace("hammer", "mallet"));
    assert_eq!(changed["other.psd"], OTHER.replace("hammer", "mallet"));
    // A requirement is named by strings.
    let marked = PLAN.replacen("\"slow\" speed", "\"sl‸ow\" speed", 1);
    let changed = renamed(&mut editor, "plan.psd", &marked, "is slow");
    assert_eq!(changed["plan.psd"], PLAN.replace("\"slow\"", "\"is slow\""));
}

#[test]
fn a_word_of_a_choice_is_no_name_of_the_plan() {
    let mut editor = Editor::with(&[]);
    let text = "let rigid = 1\nlet b = rigid\nimpact hit {\n  contact = rigid\n}\n";
    let marked = text.replacen("let rigid", "let rig‸id", 1);
    let answer = editor.at(
        "a.psd",
        &marked,
        "textDocument/rename",
        json!({ "newName": "stiff" }),
    );
    let edits = &answer["changes"][uri("a.psd")];
    assert_eq!(edited(text, edits), text.replacen("rigid", "stiff", 2));
}

#[test]
fn a_rename_says_why_a_name_cannot_be() {
    for (name, reason) in [
        ("1st", "is not a name"),
        ("hit-1", "is not a name"),
        ("µ", "is not a name"),
        ("", "is not a name"),
        ("let", "is a word"),
        ("impact", "is a word"),
        ("sqrt", "is a word"),
        ("speed", "is declared already"),
    ] {
        let mut editor = editor();
        let marked = PLAN.replacen("= hammer", "= ham‸mer", 1);
        let params = editor.place("plan.psd", &marked, json!({ "newName": name }));
        let error = editor.fails("textDocument/rename", params);
        assert!(error.message.contains(reason), "{name}: {error:?}");
    }
    let mut editor = editor();
    let params = editor.place("plan.psd", "im‸pact hit {\n}\n", json!({ "newName": "x" }));
    assert!(
        editor
            .fails("textDocument/rename", params)
            .message
            .contains("cannot be renamed")
    );
    let before = editor.at(
        "plan.psd",
        "im‸pact hit {\n}\n",
        "textDocument/prepareRename",
        json!({}),
    );
    assert_eq!(before, Value::Null);
    let before = editor.at(
        "plan.psd",
        "require \"a ‸b\" 1 < 2\n",
        "textDocument/prepareRename",
        json!({}),
    );
    assert_eq!(before["placeholder"], "a b");
    assert_eq!(
        before["range"]["start"],
        json!({ "line": 0, "character": 9 })
    );
}
