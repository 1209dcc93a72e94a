//! The messages of an editor, as bytes on standard input.

use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use psd::check::{LoadError, Loader, Options, check};
use psd_lsp::{Checked, Program, Simulation, serve};
use psd_plan::Plan;
use serde_json::{Value, json};

use super::attack;

/// The program without files.
struct NoFiles;

impl Program for NoFiles {
    fn check(&self, name: &str, text: &str, loader: &Loader<'_>) -> Checked {
        let checked = check(name, text, loader, &Options::default());
        Checked {
            plan: checked.plan,
            diagnostics: checked.diagnostics,
            sources: checked.sources,
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

#[derive(Clone, Default)]
struct Output(Arc<Mutex<Vec<u8>>>);

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

const URI: &str = "file:///plans/a.psd";

fn framed(mut message: Value) -> Vec<u8> {
    message["jsonrpc"] = "2.0".into();
    let text = message.to_string();
    format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes()
}

/// A conversation with every request.
fn conversation(plan: &str) -> Vec<u8> {
    let document = json!({ "uri": URI, "languageId": "psd", "version": 1, "text": plan });
    let mut messages = vec![
        json!({ "id": 0, "method": "initialize", "params": { "capabilities": {}, "rootUri": "file:///plans" } }),
        json!({ "method": "initialized", "params": {} }),
        json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } }),
    ];
    let start = json!({ "line": 1, "character": 4 });
    let range = json!({ "start": start, "end": { "line": 8, "character": 2 } });
    for (id, method) in (1..).zip([
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
    ]) {
        let params = json!({
            "textDocument": { "uri": URI }, "position": start, "positions": [start], "range": range, "newName": "other",
            "ch": "}", "context": { "includeDeclaration": true, "diagnostics": [] },
            "options": { "tabSize": 2, "insertSpaces": true },
        });
        messages.push(
            json!({ "id": id, "method": format!("textDocument/{method}"), "params": params }),
        );
        let change = json!({ "range": range, "text": format!("  a = {id} µm # 😀\n") });
        let changed = json!({ "textDocument": { "uri": URI, "version": id + 1 }, "contentChanges": [change] });
        messages.push(json!({ "method": "textDocument/didChange", "params": changed }));
    }
    messages.push(json!({ "id": 90, "method": "shutdown" }));
    messages.push(json!({ "method": "exit" }));
    messages.into_iter().flat_map(framed).collect()
}

#[test]
fn messages_of_an_editor() {
    let beam = include_str!("../../../plans/beam.psd");
    let seeds = [beam, "let µ = 1\r\nlet b = µ /", ""].map(conversation);
    attack("messages of an editor", &seeds, |bytes| {
        let output = Output::default();
        serve(
            Cursor::new(bytes.to_vec()),
            output.clone(),
            Arc::new(NoFiles),
        )
        .expect("memory");
        let said = String::from_utf8_lossy(&output.0.lock().unwrap()).into_owned();
        assert!(!said.contains("-32603"), "{said}");
    });
}
