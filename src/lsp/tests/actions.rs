//! Code actions: fixes that were tried, missing fields, other units.

use serde_json::{Value, json};

use super::testing::{CURSOR, Editor, edited, uri};

/// The actions at a cursor: titles, and the text after each.
fn actions(marked: &str) -> Vec<(String, String, Value)> {
    let mut editor = Editor::with(&[("lib/s.psd", "let s = 1\n")]);
    let mut params = editor.place("a.psd", marked, json!({ "context": { "diagnostics": [] } }));
    let position = params["position"].take();
    params["range"] = json!({ "start": position, "end": position });
    let answer = editor.ask("textDocument/codeAction", params);
    let text = marked.replace(CURSOR, "");
    let one = |action: &Value| {
        let after = edited(&text, &action["edit"]["changes"][uri("a.psd")]);
        (
            action["title"].as_str().unwrap().to_owned(),
            after,
            action.clone(),
        )
    };
    answer.as_array().unwrap().iter().map(one).collect()
}

#[test]
fn a_fix_is_what_the_help_names_and_was_tried() {
    for (marked, title, after) in [
        ("let a = 1 k‸n\n", "replace by `kN`", "let a = 1 kN\n"),
        (
            "striker s {\n  mas‸ = 1 kg\n  velocity = 1 m/s\n}\n",
            "replace by `mass`",
            "striker s {\n  mass = 1 kg\n  velocity = 1 m/s\n}\n",
        ),
        (
            "strik‸r s {\n  mass = 1 kg\n  velocity = 1 m/s\n}\n",
            "replace by `striker`",
            "striker s {\n  mass = 1 kg\n  velocity = 1 m/s\n}\n",
        ),
        (
            "let speed = 1\nlet b = spead‸\n",
            "replace by `speed`",
            "let speed = 1\nlet b = speed\n",
        ),
        (
            "striker s‸ {\n  mass = 1 kg\n}\n",
            "add `velocity = 1 m/s`",
            "striker s {\n  mass = 1 kg\n  velocity = 1 m/s\n}\n",
        ),
        (
            "let a = 1:2:9‸ mm\n",
            "replace by `1 .. 9 step 2 mm`",
            "let a = 1 .. 9 step 2 mm\n",
        ),
        (
            "let a = linspace(‸1, 9, 5) mm\n",
            "replace by `1 .. 9 step 2 mm`",
            "let a = 1 .. 9 step 2 mm\n",
        ),
        (
            "let a = 1 k‸N m^-1\n",
            "replace by `1 kN/m`",
            "let a = 1 kN/m\n",
        ),
        (
            "let s = 8 mm\nlet a = 5 % o‸f s\n",
            "replace by `5 % * s`",
            "let s = 8 mm\nlet a = 5 % * s\n",
        ),
        (
            "let a = [1 2‸ 3] mm\n",
            "replace by `1, 2, 3`",
            "let a = [1, 2, 3] mm\n",
        ),
        (
            "let a = 2‸^2 s\n",
            "replace by `2^2 * 1 s`",
            "let a = 2^2 * 1 s\n",
        ),
        (
            "let a = pow(‸2 mm, 2)\n",
            "replace by `(2 mm)^2`",
            "let a = (2 mm)^2\n",
        ),
        // The span of the last field ends inside its foreign letter.
        (
            "let m\u{e9} = 1 kg\nstriker s‸ {\n  mass = m\u{e9}\n}\n",
            "add `velocity = 1 m/s`",
            "let m\u{e9} = 1 kg\nstriker s {\n  mass = m\u{e9}\n  velocity = 1 m/s\n}\n",
        ),
    ] {
        let found = actions(marked);
        let wanted = found.iter().find(|(found, ..)| found == title);
        let Some((_, text, action)) = wanted else {
            panic!("{marked}: {found:#?}");
        };
        assert_eq!(
            (text.as_str(), &action["kind"]),
            (after, &json!("quickfix"))
        );
    }
}

#[test]
fn what_does_not_help_is_not_offered() {
    // The help says `let nothing = …`, which is no line of a plan.
    let found = actions("let b = nothing‸\n");
    assert!(
        found
            .iter()
            .all(|(_, _, action)| action["kind"] != "quickfix"),
        "{found:#?}"
    );
}

#[test]
fn the_fields_that_a_block_requires_are_added_at_once() {
    for (marked, after) in [
        ("striker s {‸\n}\n", "striker s {\n  mass = 20 kg\n}\n"),
        ("striker s {‸}\n", "striker s {\n  mass = 20 kg\n}\n"),
    ] {
        let found = actions(marked);
        let wanted = found
            .iter()
            .find(|(title, ..)| title.starts_with("add `mass`"));
        let Some((_, text, _)) = wanted else {
            panic!("{marked}: {found:#?}");
        };
        assert_eq!(text, after);
    }
    let found = actions("specimen s {\n  mass‸ = 10 kg\n}\n");
    assert!(
        !found.iter().any(|(title, ..)| title == "add `mass`"),
        "{found:#?}"
    );
}

#[test]
fn a_number_is_offered_in_other_units_that_mean_the_same() {
    let found = actions("let k = 300‸ kN/m\n");
    let titles: Vec<&str> = found.iter().map(|(title, ..)| title.as_str()).collect();
    assert!(titles.contains(&"write `300 N/mm`"), "{titles:?}");
    assert!(titles.contains(&"write `300000 N/m`"), "{titles:?}");
    let (_, text, action) = &found[0];
    assert_eq!(action["kind"], "refactor.rewrite");
    assert!(
        text.starts_with("let k = ") && text.ends_with('\n'),
        "{text}"
    );
}

#[test]
fn an_editor_that_asks_for_one_kind_gets_that_kind() {
    let mut editor = Editor::with(&[]);
    let mut params = editor.place("a.psd", "let k = 300‸ kN/m\n", json!({}));
    let position = params["position"].take();
    params["range"] = json!({ "start": position, "end": position });
    for (only, count) in [
        ("quickfix", 0),
        ("refactor", 6),
        ("refactor.rewrite", 6),
        ("source", 0),
    ] {
        params["context"] = json!({ "diagnostics": [], "only": [only] });
        let answer = editor.ask("textDocument/codeAction", params.clone());
        assert_eq!(answer.as_array().unwrap().len(), count, "{only}");
    }
}
