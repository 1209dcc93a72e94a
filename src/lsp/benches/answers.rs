//! The time of each answer about a plan of 2,000 lines, just after a change of it: the plan is read again for every answer. The goal is
//! 10 ms.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lsp_server::{Connection, Message, Notification, Request, RequestId};
use psd_language::check::{LoadError, Loader};
use psd_lsp::{Checked, Program, Simulation};
use psd_plan::Plan;
use psd_text::source::Sources;
use serde_json::{Value, json};

fn main() {
    divan::main();
}

/// A program without files whose check finds nothing: checks run beside the answers.
struct Nothing;

impl Program for Nothing {
    fn check(&self, _: &str, _: &str, _: &Loader<'_>) -> Checked {
        Checked {
            plan: None,
            diagnostics: Vec::new(),
            sources: Sources::default(),
        }
    }

    fn simulate(&self, _: &Plan) -> Simulation {
        Simulation {
            stopped: None,
            procedures: Vec::new(),
            requirements: Vec::new(),
        }
    }

    fn steps(&self, _: &Plan) -> u64 {
        0
    }

    fn load(&self, _: &Path, _: &str) -> Result<String, LoadError> {
        Err(LoadError::NotFound)
    }

    fn plans(&self, _: &Path) -> Vec<PathBuf> {
        Vec::new()
    }

    fn read(&self, _: &Path) -> Option<String> {
        None
    }
}

const URI: &str = "file:///plans/long.psd";
const LINES: usize = 2_000;

/// A plan with calculations, procedures that read results, and requirements.
fn plan() -> String {
    let mut text = "specimen beam {\n  mass      = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n\nstriker hammer {\n  mass     = 10 kg\n  velocity = 1 m/s\n}\n\n".to_owned();
    for index in 0..LINES / 10 {
        let _ = write!(
            text,
            "let share_{index} = 2 * {index} kN / (3 + 1)\nimpact hit_{index} {{\n  striker   = hammer\n  mass      = 1 kg * (1 + 0.5)\n  time_step = critical / 20\n  duration  = 1 s\n}}\n\nrequire \"stays {index}\" abs(hit_{index}.max_displacement) < 20 cm\n\n"
        );
    }
    text
}

/// An editor with the plan open.
struct Editor {
    connection: Connection,
    next: i32,
}

impl Editor {
    fn new() -> Self {
        let (own, connection) = Connection::memory();
        std::thread::spawn(move || psd_lsp::run(own, Arc::new(Nothing)));
        let mut editor = Self {
            connection,
            next: 0,
        };
        editor.ask("initialize", json!({ "capabilities": {} }));
        let document = json!({ "uri": URI, "languageId": "psd", "version": 0, "text": plan() });
        editor.notify("textDocument/didOpen", json!({ "textDocument": document }));
        editor
    }

    fn notify(&self, method: &str, params: Value) {
        let method = method.to_owned();
        let message = Message::Notification(Notification { method, params });
        self.connection.sender.send(message).unwrap();
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.next += 1;
        let request = Request {
            id: RequestId::from(self.next),
            method: method.to_owned(),
            params,
        };
        self.connection
            .sender
            .send(Message::Request(request))
            .unwrap();
        loop {
            if let Message::Response(response) = self.connection.receiver.recv().unwrap() {
                return response.response_result.unwrap();
            }
        }
    }
}

/// The requests that editors send while one types, in the middle of the plan.
#[divan::bench(args = [
    "hover", "completion", "signatureHelp", "definition", "references", "documentHighlight", "prepareRename",
    "rename", "documentSymbol", "formatting", "onTypeFormatting", "semanticTokens/full", "foldingRange",
    "selectionRange", "documentLink", "inlayHint", "codeLens",
])]
fn answer(bencher: divan::Bencher, method: &str) {
    let mut editor = Editor::new();
    // The name of the procedure of a requirement.
    let position = json!({ "line": 1018, "character": 24 });
    let start = json!({ "line": 1000, "character": 0 });
    let params = json!({
        "textDocument": { "uri": URI }, "position": position, "positions": [position],
        "range": { "start": start, "end": { "line": 1060, "character": 0 } }, "newName": "other", "ch": "\n",
        "context": { "includeDeclaration": true, "isRetrigger": false, "triggerKind": 1 },
        "options": { "tabSize": 2, "insertSpaces": true },
    });
    let method = format!("textDocument/{method}");
    let mut version = 0;
    bencher.bench_local(|| {
        version += 1;
        let end = json!({ "line": 0, "character": 0 });
        editor.notify(
            "textDocument/didChange",
            json!({
                "textDocument": { "uri": URI, "version": version },
                "contentChanges": [{ "range": { "start": end, "end": end }, "text": "" }],
            }),
        );
        editor.ask(&method, params.clone())
    });
}
