//! One test for each request that no other file asks: the answer, and what it is where there is nothing to answer.

use serde_json::{Value, json};

use super::testing::{CURSOR, Editor, edited, position, uri};

const PLAN: &str = "# Two bodies\nspecimen beam {\n  mass      = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n\nstriker hammer {\n  mass     = 10 kg\n  velocity = 1 m/s\n}\n\nimpact hit {\n  striker  = hammer\n  duration = 1 s\n}\n\nrequire \"stays in travel\" hit.max_displacement < 0.2 m\n";

fn document(name: &str) -> Value {
    json!({ "textDocument": { "uri": uri(name) } })
}

/// The hover text at a cursor.
fn hover(marked: &str) -> String {
    let mut editor = Editor::with(&[]);
    let answer = editor.at("a.psd", marked, "textDocument/hover", json!({}));
    answer["contents"]["value"]
        .as_str()
        .unwrap_or_default()
        .to_owned()
}

#[test]
fn hover_says_what_a_word_means_and_what_it_is_worth() {
    for (marked, wanted) in [
        (
            "str‸iker s {\n  mass = 1 kg\n}\n",
            &["**striker**", "```psd"][..],
        ),
        (
            "striker s {\n  ma‸ss = 1 kg\n}\n",
            &["**mass**: mass [kg]", "Here: 1 kg"],
        ),
        (
            "let k = 2 * 3 kN/m\nlet j = k‸ / 2\n",
            &["let k = 2 * 3 kN/m", "6 kN/m = 6000 N/m"],
        ),
        (
            "# Spring of the rig\nlet k‸ = 3 N/m\n",
            &["Spring of the rig"],
        ),
        ("let k = 300‸ kN/mm\n", &["= 3e8 N/m", "stiffness"]),
        ("let a = 2 i‸n\n", &["= 0.0508 m", "length"]),
        ("let a = sq‸rt(2)\n", &["square root"]),
        (
            "specimen b {\n  behaviour = ela‸stic(stiffness: 1 N/m)\n}\n",
            &["**elastic(stiffness", "required"],
        ),
        (
            "specimen b {\n  behaviour = elastic(stiff‸ness: 1 N/m)\n}\n",
            &["**stiffness**: stiffness [N/m]"],
        ),
        (
            "impact hit {\n}\nrequire \"a\" hit.max_disp‸lacement < 1 m\n",
            &["**max_displacement**: length [m]", "`.u`"],
        ),
        (
            "impact hit {\n}\nrequire \"a\" h‸it.max_displacement < 1 m\n",
            &["**impact hit**"],
        ),
        (
            "impact hit {\n}\nrequire \"a\" hit.max_displacement.u‸ < 1 m\n",
            &["standard uncertainty"],
        ),
        (
            "impact hit {\n  time_step = crit‸ical / 20\n}\n",
            &["largest time step"],
        ),
        ("par‸am v = 1 m/s\n", &["psd run --set"]),
        (
            "impact hit {\n  con‸tact = rigid\n}\n",
            &["contact law", "Default: rigid"],
        ),
        ("impact hit {\n  contact = rig‸id\n}\n", &["**rigid**"]),
    ] {
        let found = hover(marked);
        for wanted in wanted {
            assert!(found.contains(wanted), "{marked}\n{found}");
        }
    }
    for nothing in ["# a com‸ment\n", "‸", "let ‸= 3\n", "x‸yz {\n}\n"] {
        assert_eq!(hover(nothing), "", "{nothing}");
    }
}

#[test]
fn hover_counts_the_characters_of_the_editor() {
    for encoding in ["utf-8", "utf-16"] {
        let mut editor = Editor::of(&[], encoding);
        let marked = "require \"µ Δ 梁 🔨\" h.steps < 1 # x\n".to_owned() + "let k = 3 µ‸m # 🔨\n";
        let answer = editor.at("a.psd", &marked, "textDocument/hover", json!({}));
        assert!(
            answer["contents"]["value"]
                .as_str()
                .unwrap()
                .contains("length"),
            "{answer}"
        );
        let end = "let k = 3 µm".len() - usize::from(encoding == "utf-16");
        assert_eq!(
            answer["range"]["end"],
            json!({ "line": 1, "character": end })
        );
        let marked = "require \"µ Δ 梁 🔨\" h‸.steps < 1\nimpact h {\n}\n";
        let answer = editor.at("a.psd", marked, "textDocument/hover", json!({}));
        let start = position("require \"µ Δ 梁 🔨\" ", encoding);
        assert_eq!(answer["range"]["start"], start, "{encoding}");
    }
}

#[test]
fn a_call_shows_its_arguments() {
    let mut editor = Editor::with(&[]);
    let marked = "specimen b {\n  behaviour = beam(length: 1 m, youngs_modulus: ‸)\n}\n";
    let answer = editor.at("a.psd", marked, "textDocument/signatureHelp", json!({}));
    let label = answer["signatures"][0]["label"].as_str().unwrap();
    assert!(label.starts_with("beam(length, youngs_modulus"), "{label}");
    assert_eq!(answer["activeParameter"], 1);
    let answer = editor.at(
        "a.psd",
        "let a = max(1, ‸)\n",
        "textDocument/signatureHelp",
        json!({}),
    );
    assert_eq!(answer["signatures"][0]["label"], "max(values, …)");
    let answer = editor.at(
        "a.psd",
        "let a = ‸2\n",
        "textDocument/signatureHelp",
        json!({}),
    );
    assert_eq!(answer, Value::Null);
}

#[test]
fn a_document_has_its_items_as_symbols() {
    let mut editor = Editor::with(&[]);
    editor.open("a.psd", PLAN);
    let answer = editor.ask("textDocument/documentSymbol", document("a.psd"));
    let symbols: Vec<(&str, &str)> = answer
        .as_array()
        .unwrap()
        .iter()
        .map(|one| {
            (
                one["name"].as_str().unwrap(),
                one["detail"].as_str().unwrap(),
            )
        })
        .collect();
    let condition = "hit.max_displacement < 0.2 m";
    assert_eq!(
        symbols,
        [
            ("beam", "specimen"),
            ("hammer", "striker"),
            ("hit", "impact"),
            ("stays in travel", condition)
        ]
    );
    assert_eq!(answer[1]["children"][1]["name"], "velocity");
    assert_eq!(
        answer[1]["selectionRange"]["start"],
        json!({ "line": 6, "character": 8 })
    );
}

#[test]
fn the_workspace_is_searched_by_letters() {
    let mut editor = Editor::with(&[
        ("lib/a.psd", "striker big_hammer {\n  mass = 1 kg\n}\n"),
        ("b.psd", PLAN),
    ]);
    let answer = editor.ask("workspace/symbol", json!({ "query": "HAM" }));
    let found: Vec<&Value> = answer
        .as_array()
        .unwrap()
        .iter()
        .map(|one| &one["name"])
        .collect();
    assert_eq!(found, ["hammer", "big_hammer"]);
    assert_eq!(answer[1]["location"]["uri"], uri("lib/a.psd"));
    assert_eq!(
        editor.ask("workspace/symbol", json!({ "query": "zz" })),
        json!([])
    );
}

#[test]
fn a_plan_is_formatted_by_the_lines_that_change() {
    let mut editor = Editor::with(&[]);
    let text = "# µ\nlet a=1 m\n\n\n\nlet   b = 2 m\nlet c = 3 m\n";
    editor.open("a.psd", text);
    let mut params = document("a.psd");
    params["options"] = json!({ "tabSize": 2, "insertSpaces": true });
    let edits = editor.ask("textDocument/formatting", params.clone());
    assert_eq!(
        edited(text, &edits),
        "# µ\nlet a = 1 m\n\nlet b = 2 m\nlet c = 3 m\n"
    );
    editor.replace("a.psd", 2, "let a = 1 m\n");
    assert_eq!(
        editor.ask("textDocument/formatting", params.clone()),
        json!([])
    );
    editor.replace("a.psd", 3, "let a = = 1 m\n");
    assert_eq!(editor.ask("textDocument/formatting", params), Value::Null);
    editor.open("a.md", "#  Title\n\n```psd\nlet a=1 m\n```\n");
    let mut params = document("a.md");
    params["options"] = json!({ "tabSize": 2, "insertSpaces": true });
    let edits = editor.ask("textDocument/formatting", params);
    assert_eq!(edits[0]["newText"], "let a = 1 m\n");
}

#[test]
fn a_block_is_formatted_when_it_is_closed_and_its_lines_while_it_is_typed() {
    let mut editor = Editor::with(&[]);
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let on = |ch: &str| json!({ "ch": ch, "options": options });
    let marked = "let  x = 1\n\nstriker s {\n  mass = 1 kg\n  velocity = 1 m/s\n}‸\nlet  y = 1\n";
    let edits = editor.at("a.psd", marked, "textDocument/onTypeFormatting", on("}"));
    let text = marked.replace(CURSOR, "");
    let wanted =
        "let  x = 1\n\nstriker s {\n  mass     = 1 kg\n  velocity = 1 m/s\n}\nlet  y = 1\n";
    assert_eq!(edited(&text, &edits), wanted);
    let marked = "striker s {\n    mass = 1 kg\n‸\n}\n";
    let edits = editor.at("a.psd", marked, "textDocument/onTypeFormatting", on("\n"));
    assert_eq!(
        edited(&marked.replace(CURSOR, ""), &edits),
        "striker s {\n  mass = 1 kg\n\n}\n"
    );
    // A line that is typed between two entries leaves them aligned.
    let marked = "striker s {\n  mass= 1 kg\n‸\n  velocity = 1 m/s\n}\n";
    let edits = editor.at("a.psd", marked, "textDocument/onTypeFormatting", on("\n"));
    assert_eq!(
        edited(&marked.replace(CURSOR, ""), &edits),
        "striker s {\n  mass     = 1 kg\n\n  velocity = 1 m/s\n}\n"
    );
}

#[test]
fn every_word_has_a_colour() {
    let mut editor = Editor::with(&[]);
    let text = "param v = 1 m/s # 🔨\nstriker s {\n  velocity = v\n}\nimpact hit {\n  contact = hertz(stiffness: 2 GN/m^1.5)\n}\n";
    editor.open("a.psd", text);
    let answer = editor.ask("textDocument/semanticTokens/full", document("a.psd"));
    let types = crate::answers::semantic::TOKEN_TYPES;
    let numbers: Vec<usize> = answer["data"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| usize::try_from(one.as_u64().unwrap()).unwrap())
        .collect();
    let (mut line, mut start) = (0, 0);
    let mut found = Vec::new();
    for token in numbers.chunks(5) {
        start = if token[0] == 0 {
            start + token[1]
        } else {
            token[1]
        };
        line += token[0];
        let units: Vec<u16> = text.lines().nth(line).unwrap().encode_utf16().collect();
        let word = String::from_utf16(&units[start..start + token[2]]).unwrap();
        found.push(format!("{word}:{}", types[token[3]]));
    }
    let wanted = "param:keyword v:variable =:operator 1:number m/s:type # 🔨:comment striker:keyword s:class velocity:property =:operator v:variable impact:keyword hit:method contact:property =:operator hertz:enumMember stiffness:parameter 2:number GN/m^1.5:type";
    assert_eq!(found.join(" "), wanted);
}

#[test]
fn items_brackets_and_comments_fold() {
    let mut editor = Editor::with(&[]);
    let text = "# a\n# b\n# c\nstriker s {\n  mass = 1 kg\n}\ncycle c {\n  displacements = [\n    1,\n    2,\n  ] mm\n}\n";
    editor.open("a.psd", text);
    let answer = editor.ask("textDocument/foldingRange", document("a.psd"));
    let mut lines: Vec<(u64, u64)> = answer
        .as_array()
        .unwrap()
        .iter()
        .map(|one| {
            (
                one["startLine"].as_u64().unwrap(),
                one["endLine"].as_u64().unwrap(),
            )
        })
        .collect();
    lines.sort_unstable();
    assert_eq!(lines, [(0, 2), (3, 4), (6, 10), (7, 9)]);
}

#[test]
fn a_selection_grows_from_the_word_to_the_file() {
    let mut editor = Editor::with(&[]);
    let marked = "striker s {\n  velocity = sqrt(2 * 1 g‸n * 1 m)\n}\n";
    let params = editor.place("a.psd", marked, json!({}));
    let positions =
        json!({ "textDocument": params["textDocument"], "positions": [params["position"]] });
    let answer = editor.ask("textDocument/selectionRange", positions);
    let (mut range, mut starts) = (&answer[0], Vec::new());
    while !range.is_null() {
        starts.push((
            range["range"]["start"]["line"].as_u64().unwrap(),
            range["range"]["start"]["character"].as_u64().unwrap(),
        ));
        range = &range["parent"];
    }
    assert_eq!(starts.first(), Some(&(1, 22)));
    assert_eq!(starts.last(), Some(&(0, 0)));
    assert!(
        starts.windows(2).all(|pair| pair[0] >= pair[1]) && starts.len() >= 5,
        "{starts:?}"
    );
}

#[test]
fn the_files_that_a_plan_names_are_links() {
    let text = "use \"lib/s.psd\"\nuse \"lib/none.psd\"\nground g {\n  file = \"quake.csv\"\n}\n";
    let mut editor = Editor::with(&[("lib/s.psd", "let a = 1\n"), ("quake.csv", "0\n")]);
    editor.open("a.psd", text);
    let answer = editor.ask("textDocument/documentLink", document("a.psd"));
    let targets: Vec<&Value> = answer
        .as_array()
        .unwrap()
        .iter()
        .map(|one| &one["target"])
        .collect();
    assert_eq!(
        targets,
        [&json!(uri("lib/s.psd")), &json!(uri("quake.csv"))]
    );
    assert_eq!(
        answer[0]["range"]["start"],
        json!({ "line": 0, "character": 5 })
    );
}

/// The labels of the hints of a text.
fn hints(editor: &mut Editor, name: &str) -> Vec<String> {
    let mut params = document(name);
    params["range"] =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
    let answer = editor.ask("textDocument/inlayHint", params);
    answer
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["label"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn hints_have_values_other_units_and_what_a_simulation_found() {
    let mut editor = Editor::with(&[]);
    editor.open("a.psd", PLAN);
    // The server simulates a valid plan by itself, and requests the editor to ask again.
    editor.was_asked("workspace/inlayHint/refresh");
    editor.was_asked("workspace/codeLens/refresh");
    assert_eq!(
        hints(&mut editor, "a.psd"),
        [
            "peak 8.100 mm, critical Δt 0.3500 ms",
            "simulated: pass, 8.100 mm"
        ]
    );
    editor.open("b.psd", "let k = 2 * 3 kN/m\nlet b = 2 in\nlet c = 3 m\n");
    assert_eq!(hints(&mut editor, "b.psd"), ["= 6.000 kN/m", "= 50.80 mm"]);
}

#[test]
fn the_lens_simulates_and_says_so() {
    let mut editor = Editor::with(&[]);
    editor.open("a.psd", PLAN);
    editor.was_asked("workspace/codeLens/refresh");
    let lenses = editor.ask("textDocument/codeLens", document("a.psd"));
    let command = &lenses[0]["command"];
    assert_eq!(command["title"], "simulate (SIMULATION: requirement met)");
    let execute = json!({ "command": command["command"], "arguments": command["arguments"] });
    let answer = editor.ask("workspace/executeCommand", execute.clone());
    assert_eq!(answer, "SIMULATION: requirement met");
    let shown = editor.notified("window/showMessage", |_| true);
    assert_eq!(shown["message"], answer);
    // A plan with an error has no simulation, and a file without procedures no lens.
    editor.replace("a.psd", 2, "impact hit {\n  duration = 1 mm\n}\n");
    let answer = editor.ask("workspace/executeCommand", execute);
    assert_eq!(answer, "no simulation: the plan has an error");
    let shown = editor.notified("window/showMessage", |one| one["type"] == 2);
    assert_eq!(shown["message"], answer);
    editor.open("b.psd", "let a = 1\n");
    assert_eq!(
        editor.ask("textDocument/codeLens", document("b.psd")),
        json!([])
    );
    editor.fails(
        "workspace/executeCommand",
        json!({ "command": "rm", "arguments": [] }),
    );
}
