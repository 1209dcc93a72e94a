//! The page of the language server: every example in it is asked, and its answer is compared. With `PSD_BLESS=1` the page is written.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};

use super::testing::{CURSOR, Editor, edited, labels, uri};

const PAGE: &str = "docs/reference/language-server.md";

/// The answer to a request about a plan with a cursor, as a reader wants to see it.
fn shown(method: &str, marked: &str) -> String {
    let mut editor = Editor::with(&[]);
    let mut more = json!({
        "context": { "includeDeclaration": true, "diagnostics": [], "triggerKind": 1, "isRetrigger": false }, "newName": "new_name",
        "ch": "}", "options": { "tabSize": 2, "insertSpaces": true },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 999, "character": 0 } },
    });
    let mut params = editor.place("plan.psd", marked, Value::Null);
    more["positions"] = json!([params["position"]]);
    if method == "textDocument/codeAction" {
        more["range"] = json!({ "start": params["position"], "end": params["position"] });
    }
    for (key, value) in more.as_object().unwrap() {
        params[key] = value.clone();
    }
    let text = marked.replacen(CURSOR, "", 1);
    if method == "textDocument/publishDiagnostics" {
        let published = editor.diagnostics("plan.psd");
        let list = published["diagnostics"].as_array().unwrap();
        return list.iter().fold(String::new(), |mut shown, one| {
            let _ = writeln!(
                shown,
                "{} {}: {}",
                range(&one["range"]),
                one["code"].as_str().unwrap(),
                one["message"].as_str().unwrap()
            );
            shown
        });
    }
    if method == "textDocument/inlayHint" || method == "textDocument/codeLens" {
        editor.was_asked("workspace/codeLens/refresh");
    }
    let answer = editor.ask(method, params);
    match method {
        "textDocument/hover" => {
            answer["contents"]["value"]
                .as_str()
                .unwrap_or("nothing")
                .to_owned()
                + "\n"
        }
        "textDocument/completion" => {
            let all = labels(&answer);
            let details = answer["items"].as_array().unwrap().iter().take(6);
            let mut lines = details.fold(String::new(), |mut lines, item| {
                let line = format!(
                    "{:<18} {}",
                    item["label"].as_str().unwrap(),
                    item["detail"].as_str().unwrap_or_default()
                );
                let _ = writeln!(lines, "{}", line.trim_end());
                lines
            });
            if all.len() > 6 {
                let _ = writeln!(lines, "… and {} more", all.len() - 6);
            }
            lines
        }
        "textDocument/formatting" | "textDocument/onTypeFormatting" => edited(&text, &answer),
        "textDocument/rename" => edited(&text, &answer["changes"][uri("plan.psd")]),
        "textDocument/codeAction" => {
            answer
                .as_array()
                .unwrap()
                .iter()
                .fold(String::new(), |mut lines, action| {
                    let _ = writeln!(lines, "{}", action["title"].as_str().unwrap());
                    lines
                })
        }
        _ => one_per_line(&answer),
    }
}

fn range(range: &Value) -> String {
    let at = |end: &str| format!("{}:{}", range[end]["line"], range[end]["character"]);
    format!("{}-{}", at("start"), at("end"))
}

/// The entries of a list, each on a line.
fn one_per_line(answer: &Value) -> String {
    let one = |value: &Value| {
        let mut value = value.clone();
        if let Some(object) = value.as_object_mut() {
            object.remove("uri");
            object.remove("data");
        }
        format!("{value}\n")
    };
    match answer {
        Value::Array(list) => list.iter().map(one).collect(),
        other => one(other),
    }
}

#[test]
fn every_example_of_the_page_is_what_the_server_answers() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(PAGE);
    let page = std::fs::read_to_string(&path).unwrap();
    let mut written = String::new();
    let mut rest = page.as_str();
    let mut count = 0;
    // A plan with a cursor, then the answer: ```text METHOD … ```  ```text answer … ```
    while let Some((before, after)) = rest.split_once("```text textDocument/") {
        let (method, after) = after.split_once('\n').unwrap();
        let (plan, after) = after.split_once("```\n").unwrap();
        let (between, after) = after.split_once("```text answer\n").unwrap();
        let (_, after) = after.split_once("```\n").unwrap();
        let answer = shown(&format!("textDocument/{method}"), plan).replace("```", "~~~");
        let _ = write!(
            written,
            "{before}```text textDocument/{method}\n{plan}```\n{between}```text answer\n{answer}```\n"
        );
        rest = after;
        count += 1;
    }
    written.push_str(rest);
    assert!(count >= 16, "{count} examples");
    if std::env::var_os("PSD_BLESS").is_some() {
        std::fs::write(&path, written).unwrap();
    } else {
        assert_eq!(
            page, written,
            "`cargo xtask generate editor` writes the page again"
        );
    }
}
