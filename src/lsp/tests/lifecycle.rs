//! The conversation as a whole: beginning, end, bytes that are no message, faults of the program, diagnostics with their versions.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};
use std::sync::{Arc, Mutex};

use lsp_server::{ErrorCode, Message, Notification};
use serde_json::{Value, json};

use super::program::{Files, PANICS};
use super::testing::{Editor, uri};
use crate::{Ended, serve};

/// An output that the test reads.
#[derive(Clone, Default)]
struct Output(Arc<Mutex<Vec<u8>>>);

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn framed(body: &str) -> String {
    format!("Content-Length: {}\r\n\r\n{body}", body.len())
}

/// What the server says to some bytes.
fn answers(input: &[u8]) -> (Ended, Vec<Value>) {
    let output = Output::default();
    let program = Arc::new(Files(BTreeMap::new()));
    let ended = serve(Cursor::new(input.to_vec()), output.clone(), program).unwrap();
    let bytes = output.0.lock().unwrap().clone();
    let mut rest = std::str::from_utf8(&bytes).unwrap();
    let mut found = Vec::new();
    while let Some((header, after)) = rest.split_once("\r\n\r\n") {
        let length: usize = header
            .strip_prefix("Content-Length: ")
            .unwrap()
            .parse()
            .unwrap();
        found.push(serde_json::from_str(&after[..length]).unwrap());
        rest = &after[length..];
    }
    (ended, found)
}

const INITIALIZE: &str =
    r#"{"jsonrpc":"2.0","id":"first","method":"initialize","params":{"capabilities":{}}}"#;
const SHUTDOWN: &str = r#"{"jsonrpc":"2.0","id":7,"method":"shutdown"}"#;
const EXIT: &str = r#"{"jsonrpc":"2.0","method":"exit"}"#;

#[test]
fn bytes_that_are_no_message_get_an_error_and_the_server_lives() {
    let bad = [
        ("no JSON", ErrorCode::ParseError, json!(null)),
        ("", ErrorCode::ParseError, json!(null)),
        ("\u{0}", ErrorCode::ParseError, json!(null)),
        ("[]", ErrorCode::InvalidRequest, json!(null)),
        ("3", ErrorCode::InvalidRequest, json!(null)),
        ("{}", ErrorCode::InvalidRequest, json!(null)),
        (
            r#"{"id":null,"method":"shutdown"}"#,
            ErrorCode::InvalidRequest,
            json!(null),
        ),
        (
            r#"{"id":4294967296,"method":"shutdown"}"#,
            ErrorCode::InvalidRequest,
            json!(4_294_967_296_u64),
        ),
        (
            r#"{"id":1.5,"method":"shutdown"}"#,
            ErrorCode::InvalidRequest,
            json!(1.5),
        ),
        (
            r#"{"id":[1],"method":"shutdown"}"#,
            ErrorCode::InvalidRequest,
            json!([1]),
        ),
        (
            r#"{"id":3,"method":5}"#,
            ErrorCode::InvalidRequest,
            json!(3),
        ),
        (r#"{"method":{}}"#, ErrorCode::InvalidRequest, json!(null)),
    ];
    let mut input = framed(INITIALIZE);
    for (body, ..) in &bad {
        input.push_str(&framed(body));
    }
    // A header without a length, one with a wrong length, and answers to nothing.
    input.push_str("Content-Type: x\r\n\r\nContent-Length: many\r\n\r\n");
    input.push_str(&framed(r#"{"id":null,"result":null}"#));
    input.push_str(&framed(r#"{"id":99,"result":null}"#));
    input.push_str(&framed(SHUTDOWN));
    input.push_str(&framed(EXIT));
    let (ended, found) = answers(input.as_bytes());
    assert_eq!(ended, Ended::InOrder);
    let errors: Vec<&Value> = found
        .iter()
        .filter(|answer| answer.get("error").is_some())
        .collect();
    assert_eq!(errors.len(), bad.len() + 2, "{errors:#?}");
    for ((body, code, id), answer) in bad.iter().zip(&errors) {
        assert_eq!(answer["error"]["code"], *code as i32, "{body}");
        assert_eq!(answer["id"], *id, "{body}");
    }
    let good = |id: Value| {
        found
            .iter()
            .filter(|answer| answer["id"] == id && answer.get("result").is_some())
            .count()
    };
    assert_eq!((good(json!("first")), good(json!(7))), (1, 1));
    assert!(found.iter().all(|answer| answer["jsonrpc"] == "2.0"));
}

#[test]
fn a_message_that_is_too_large_or_no_text_is_passed_over() {
    let large = " ".repeat((16 << 20) + 1);
    let mut input = framed(INITIALIZE).into_bytes();
    input.extend(framed(&large).bytes());
    input.extend(b"Content-Length: 3\r\n\r\n\xff\xfe\xfd");
    input.extend(framed(&"[".repeat(100_000)).bytes());
    input.extend([framed(SHUTDOWN), framed(EXIT)].concat().bytes());
    let (ended, found) = answers(&input);
    assert_eq!((ended, found.len()), (Ended::InOrder, 5));
}

#[test]
fn the_end_of_the_stream_ends_the_server() {
    let (ended, found) = answers(framed(INITIALIZE).as_bytes());
    assert_eq!((ended, found.len()), (Ended::Abruptly, 1));
    assert_eq!(answers(b"").0, Ended::Abruptly);
    let cut = framed(INITIALIZE);
    assert_eq!(answers(&cut.as_bytes()[..cut.len() - 5]).0, Ended::Abruptly);
    assert_eq!(answers(framed(EXIT).as_bytes()).0, Ended::Abruptly);
}

#[test]
fn a_request_comes_after_initialize_and_before_shutdown() {
    let mut editor = Editor::before_initialize(&[]);
    let code = |code: ErrorCode| code as i32;
    let early = editor.fails("textDocument/hover", json!({}));
    assert_eq!(early.code, code(ErrorCode::ServerNotInitialized));
    editor.ask("initialize", json!({ "capabilities": {} }));
    let again = editor.fails("initialize", json!({ "capabilities": {} }));
    assert_eq!(again.code, code(ErrorCode::InvalidRequest));
    assert_eq!(
        editor.fails("psd/none", json!({})).code,
        code(ErrorCode::MethodNotFound)
    );
    let wrong = editor.fails("textDocument/hover", json!({ "position": 5 }));
    assert_eq!(wrong.code, code(ErrorCode::InvalidParams));
    assert_eq!(editor.shut_down(), Ended::InOrder);
}

#[test]
fn a_request_that_is_cancelled_while_it_waits_is_answered_so() {
    let mut editor = Editor::with(&[]);
    // Both stand in the queue when the first is looked at, if the server is busy with the one before.
    let ids: Vec<i32> = (0..50)
        .map(|_| editor.begin("workspace/symbol", json!({ "query": "" })))
        .collect();
    let last = *ids.last().unwrap();
    editor.notify("$/cancelRequest", json!({ "id": last }));
    for id in ids {
        if let Err(error) = editor.end(id) {
            assert_eq!((id, error.code), (last, ErrorCode::RequestCanceled as i32));
        }
    }
}

#[test]
fn a_fault_of_the_program_ends_neither_the_server_nor_later_checks() {
    let mut editor = Editor::with(&[]);
    editor.open("a.psd", PANICS);
    let params = json!({
        "textDocument": { "uri": uri("a.psd") }, "context": { "diagnostics": [] },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 0 } },
    });
    assert_eq!(editor.ask("textDocument/codeAction", params), json!([]));
    editor.replace("a.psd", 2, "let a = 1 mx\n");
    assert_eq!(
        editor.diagnostics("a.psd")["diagnostics"][0]["code"],
        "E204"
    );
}

#[test]
fn diagnostics_come_after_a_pause_with_the_newest_version_and_a_plain_message() {
    let mut editor = Editor::with(&[]);
    editor.open("a.psd", "let a = 1 mx\n");
    for version in 2..9 {
        editor.replace("a.psd", version, "let a = 1 mx\nlet b = 2 kN\n");
    }
    let published = loop {
        let published = editor.diagnostics("a.psd");
        if published["version"] == 8 {
            break published;
        }
    };
    let [one] = published["diagnostics"].as_array().unwrap().as_slice() else {
        panic!("{published}");
    };
    assert_eq!(
        (&one["code"], &one["severity"], &one["source"]),
        (&json!("E204"), &json!(1), &json!("psd"))
    );
    assert_eq!(one["range"]["start"], json!({ "line": 0, "character": 10 }));
    let message = one["message"].as_str().unwrap();
    assert!(message.starts_with("unknown unit `mx`\n"), "{message}");
    editor.replace("a.psd", 9, "let a = 1 m\n");
    assert_eq!(editor.diagnostics("a.psd")["diagnostics"], json!([]));
}

#[test]
fn diagnostics_of_a_used_file_are_shown_there_and_go_when_the_plan_is_closed() {
    let library = "striker hammer {\n  mass = 10 mm\n  velocity = 1 m/s\n}\n";
    let mut editor = Editor::with(&[("lib/s.psd", library)]);
    editor.open("a.psd", "use \"lib/s.psd\"\n");
    let published = editor.diagnostics("lib/s.psd");
    assert_eq!(published["diagnostics"][0]["code"], "E301");
    assert_eq!(published.get("version"), None);
    editor.notify(
        "textDocument/didClose",
        json!({ "textDocument": { "uri": uri("a.psd") } }),
    );
    assert_eq!(editor.diagnostics("lib/s.psd")["diagnostics"], json!([]));
}

#[test]
fn a_file_is_checked_with_the_plan_that_uses_it() {
    let plan = "use \"lib/s.psd\"\nlet twice = 2 * speed\n";
    let mut editor = Editor::with(&[("a.psd", plan), ("lib/s.psd", "let speed = 1 m/s\n")]);
    editor.open("lib/s.psd", "let velocity = 1 m/s\n");
    let published = editor.diagnostics("a.psd");
    assert_eq!(published["diagnostics"][0]["code"], "E203", "{published}");
}

#[test]
fn a_document_has_its_plan_in_its_code_blocks() {
    let text = "# Procedure Δ\n\nThe *mass*:\n\n```psd\nlet a = 1 mx\n```\n\n```psd fragment\nlet b = 1 my\n```\n";
    let mut editor = Editor::with(&[]);
    editor.open("a.md", text);
    let published = editor.diagnostics("a.md");
    let [one] = published["diagnostics"].as_array().unwrap().as_slice() else {
        panic!("{published}");
    };
    assert_eq!(one["range"]["start"], json!({ "line": 5, "character": 10 }));
}

#[test]
fn changes_of_parts_give_the_text_that_the_editor_has() {
    let mut editor = Editor::with(&[]);
    editor.open("a.psd", "# µ Δ 梁 🔨 x\nlet a = 1 m\n");
    let range = |from: u32, to: u32| json!({ "start": { "line": 0, "character": from }, "end": { "line": 0, "character": to } });
    // The emoji has two units of UTF-16: x is the tenth character of the line, from 0.
    editor.notify(
        "textDocument/didChange",
        json!({
            "textDocument": { "uri": uri("a.psd"), "version": 2 },
            "contentChanges": [
                { "range": range(11, 12), "text": "y\nlet b = 2 mx" },
                { "range": range(2, 3), "text": "nn" },
            ],
        }),
    );
    let published = loop {
        let published = editor.diagnostics("a.psd");
        if published["version"] == 2 {
            break published;
        }
    };
    let range = &published["diagnostics"][0]["range"];
    assert_eq!(
        range["start"],
        json!({ "line": 1, "character": 10 }),
        "{published}"
    );
}

#[test]
fn a_document_that_was_never_saved_is_a_plan() {
    let mut editor = Editor::with(&[]);
    editor.open_uri("untitled:Untitled-1", "let a = 1 mx\nuse \"b.psd\"\n");
    let published = editor.notified("textDocument/publishDiagnostics", |params| {
        params["uri"] == "untitled:Untitled-1"
    });
    let found = published["diagnostics"].as_array().unwrap();
    let codes: Vec<&Value> = found.iter().map(|one| &one["code"]).collect();
    assert_eq!(codes, ["E204", "E501"]);
}

#[test]
fn any_order_of_any_messages_is_survived() {
    let mut editor = Editor::with(&[]);
    let text =
        "striker s {\n  mass = 1 kg # µ🔨\n  velocity = 1 m/s\n}\nrequire \"a\" s.mass < 2 kg\n";
    editor.open("a.psd", text);
    let methods = [
        "hover",
        "completion",
        "signatureHelp",
        "definition",
        "references",
        "documentHighlight",
        "prepareRename",
        "rename",
        "documentSymbol",
        "formatting",
        "onTypeFormatting",
        "semanticTokens/full",
        "foldingRange",
        "selectionRange",
        "documentLink",
        "inlayHint",
        "codeLens",
        "codeAction",
    ];
    let mut seed = 1_u32;
    let mut draw = |below: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % below
    };
    let mut version = 1;
    for _ in 0..600 {
        let position = |line: u32, character: u32| json!({ "line": line, "character": character });
        let (start, end) = (position(draw(8), draw(30)), position(draw(8), draw(30)));
        if draw(3) == 0 {
            version += 1;
            let pieces = [
                "",
                "{",
                "}",
                "\"",
                " 1 k",
                ".",
                "🔨",
                "\n",
                "storeys = [",
                "# a\rb",
                "# x",
                "hit.",
            ];
            let piece = pieces[usize::try_from(draw(12)).unwrap()];
            editor.notify(
                "textDocument/didChange",
                json!({
                    "textDocument": { "uri": uri("a.psd"), "version": version },
                    "contentChanges": [{ "range": { "start": start, "end": end }, "text": piece }],
                }),
            );
            continue;
        }
        let method = methods[usize::try_from(draw(18)).unwrap()];
        let params = json!({
            "textDocument": { "uri": uri("a.psd") }, "position": start, "positions": [start],
            "range": { "start": start, "end": end }, "newName": "other", "ch": "\n",
            "context": { "includeDeclaration": true, "diagnostics": [], "triggerKind": 1, "isRetrigger": false },
            "options": { "tabSize": 2, "insertSpaces": true },
        });
        let id = editor.begin(&format!("textDocument/{method}"), params);
        if let Err(error) = editor.end(id) {
            assert_eq!(
                (method, error.code),
                ("rename", ErrorCode::RequestFailed as i32),
                "{error:?}"
            );
        }
    }
}

#[test]
fn notifications_that_make_no_sense_are_passed_over() {
    let mut editor = Editor::with(&[]);
    for method in [
        "textDocument/didOpen",
        "textDocument/didChange",
        "textDocument/didClose",
        "workspace/didChangeWatchedFiles",
        "workspace/didChangeWorkspaceFolders",
        "$/setTrace",
        "x",
    ] {
        editor.send(Message::Notification(Notification {
            method: method.to_owned(),
            params: json!([1]),
        }));
    }
    editor.notify("textDocument/didChange", json!({
        "textDocument": { "uri": uri("unknown.psd"), "version": 2 }, "contentChanges": [{ "text": "" }],
    }));
    let position = json!({ "line": 0, "character": 0 });
    let hover = json!({ "textDocument": { "uri": uri("unknown.psd") }, "position": position });
    assert_eq!(editor.ask("textDocument/hover", hover), Value::Null);
}
