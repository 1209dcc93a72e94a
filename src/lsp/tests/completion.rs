//! Completion: what is offered where, and what is written.

use serde_json::{Value, json};

use super::testing::{CURSOR, Editor, edited, labels};

fn complete(marked: &str) -> Value {
    let files = [
        ("lib/s.psd", "let s = 1\n"),
        ("lib/deep/t.psd", "let t = 1\n"),
    ];
    Editor::with(&files).at("a.psd", marked, "textDocument/completion", json!({}))
}

/// The text after an item was chosen.
fn chosen(marked: &str, label: &str) -> String {
    let answer = complete(marked);
    let items = answer["items"].as_array().unwrap();
    let item = items.iter().find(|item| item["label"] == label);
    let item = item.unwrap_or_else(|| panic!("{label} is not in {:?}", labels(&answer)));
    edited(&marked.replacen(CURSOR, "", 1), &json!([item["textEdit"]]))
}

#[test]
fn a_block_comes_with_its_required_fields_only() {
    let text = chosen("stri‸", "striker");
    assert_eq!(text, "striker ${1:pendulum} {\n  mass = ${2:20 kg}\n}");
    let text = chosen("stiffness ‸", "ramp");
    assert!(text.starts_with("stiffness ramp ${1:k0} {\n"), "{text}");
    // The only striker of the plan is its value.
    let text = chosen("striker hammer {\n  mass = 1 kg\n}\nimp‸", "impact");
    assert!(text.contains("striker = ${2:hammer}"), "{text}");
}

#[test]
fn an_editor_without_placeholders_gets_plain_text() {
    let mut editor = Editor::before_initialize(&[]);
    editor.ask("initialize", json!({ "capabilities": {} }));
    let answer = editor.at("a.psd", "stri‸", "textDocument/completion", json!({}));
    let items = answer["items"].as_array().unwrap();
    let item = items
        .iter()
        .find(|item| item["label"] == "striker")
        .unwrap();
    assert_eq!(
        item["textEdit"]["newText"],
        "striker pendulum {\n  mass = 20 kg\n}"
    );
    assert_eq!(item.get("insertTextFormat"), None);
}

#[test]
fn fields_that_are_missing_come_with_their_documentation() {
    let answer = complete("striker s {\n  mass = 1 kg\n  ‸\n  gap = 1 mm\n}\n");
    let found = labels(&answer);
    assert!(
        !found.contains(&"mass") && !found.contains(&"gap") && found.contains(&"velocity"),
        "{found:?}"
    );
    let doc = answer["items"][0]["documentation"]["value"]
        .as_str()
        .unwrap();
    assert!(doc.starts_with("**"), "{doc}");
    let answer = complete("impact hit {\n  ‸\n}\n");
    assert_eq!(labels(&answer)[..2], ["striker", "duration"]);
}

#[test]
fn units_fit_the_dimension() {
    for (marked, first, never) in [
        ("striker s {\n  mass = 10 ‸\n}\n", "kg", "mm"),
        ("striker s {\n  velocity = 10 m‸\n}\n", "m/s", "kg"),
        (
            "specimen b {\n  behaviour = elastic(stiffness: 300 ‸)\n}\n",
            "N/m",
            "kg",
        ),
        (
            "specimen b {\n  behaviour = elastic(stiffness: 300 kN/‸)\n}\n",
            "N/m",
            "kg",
        ),
        (
            "impact hit {\n}\nrequire \"a\" hit.max_displacement < 0.2 ‸",
            "mm",
            "kg",
        ),
        ("let v = 1 m/s\nrequire \"a\" v < 0.2 ‸", "m/s", "kg"),
        (
            "stiffness ramp k {\n  displacements = 1 .. 10 ‸\n}\n",
            "mm",
            "kg",
        ),
    ] {
        let answer = complete(marked);
        let found = labels(&answer);
        assert!(
            found.contains(&first) && !found.contains(&never),
            "{marked}: {found:?}"
        );
        let units: Vec<&Value> = answer["items"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|item| item["kind"] == 11)
            .collect();
        assert!(
            units.len() >= 3 && units[0]["label"] == first,
            "{marked}: {found:?}"
        );
    }
    assert_eq!(
        chosen("striker s {\n  mass = 10 k‸\n}\n", "kg"),
        "striker s {\n  mass = 10 kg\n}\n"
    );
    assert_eq!(chosen("let k = 3 kN/‸\n", "kN/m"), "let k = 3 kN/m\n");
}

#[test]
fn results_are_those_of_earlier_procedures() {
    let plan = "stiffness ramp k0 {\n}\nimpact hit {\n  stiffness = ‸\n}\nimpact late {\n}\n";
    let answer = complete(plan);
    let found = labels(&answer);
    assert!(
        found.contains(&"k0") && !found.contains(&"late") && !found.contains(&"hit"),
        "{found:?}"
    );
    let answer = complete(&plan.replace("= ‸", "= k0.‸"));
    assert_eq!(labels(&answer)[0], "stiffness");
    let answer = complete("impact hit {\n}\nrequire \"a\" ‸\n");
    assert!(labels(&answer).contains(&"hit"));
    let answer = complete("impact hit {\n}\nrequire \"a\" hit.max_displacement.‸\n");
    assert_eq!(labels(&answer), ["u"]);
}

#[test]
fn values_are_those_of_the_type() {
    for (marked, wanted) in [
        ("impact hit {\n  contact = ‸\n}\n", &["rigid", "hertz"][..]),
        ("impact hit {\n  contact = hertz(‸)\n}\n", &["stiffness"]),
        (
            "striker a {\n}\nspecimen b {\n}\nimpact hit {\n  striker = ‸\n}\n",
            &["a"],
        ),
        ("impact hit {\n  time_step = ‸\n}\n", &["critical"]),
        ("specimen b {\n  behaviour = el‸\n}\n", &["elastic"]),
        ("use \"‸\"\n", &["lib/s.psd", "lib/deep/t.psd"]),
        ("use \"lib/‸\n", &["lib/s.psd"]),
        (
            "impact hit {\n}\nreport {\n  figures = [displacement(‸)]\n}\n",
            &["hit"],
        ),
        (
            "report {\n  figures = [‸]\n}\n",
            &["displacement", "energy"],
        ),
        ("param v = 1 m/s\nlet w = ‸", &["v", "sqrt"]),
        (
            "require \"slow\" 1 < 2\nstudy s {\n}\nrequire \"b\" s.probability(fails: \"‸\") < 5 %\n",
            &["slow"],
        ),
        (
            "impact hit {\n}\nrequire \"a\" hit.max_displacement ‸",
            &["<=", "within"],
        ),
    ] {
        let answer = complete(marked);
        let found = labels(&answer);
        for wanted in wanted {
            assert!(found.contains(wanted), "{marked}: {found:?}");
        }
    }
}

#[test]
fn nothing_is_offered_where_nothing_fits() {
    for marked in [
        "# com‸ment\n",
        "let ‸",
        "let a = 12‸",
        "require \"na‸me\" 1 < 2\n",
        "param x‸\n",
        "striker s {\n  mass ‸\n}\n",
    ] {
        let answer = complete(marked);
        assert!(
            labels(&answer).is_empty(),
            "{marked}: {:?}",
            labels(&answer)
        );
    }
    let mut editor = Editor::with(&[]);
    let answer = editor.at(
        "a.md",
        "# Ti‸tle\n\n```psd\nlet a = 1\n```\n",
        "textDocument/completion",
        json!({}),
    );
    assert!(labels(&answer).is_empty());
    let answer = editor.at(
        "b.md",
        "# Title\n\n```psd\nstri‸\n```\n",
        "textDocument/completion",
        json!({}),
    );
    assert!(labels(&answer).contains(&"striker"));
}
