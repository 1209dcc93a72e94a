//! An editor of the tests. It answers every request of the server at once, and looks at its end that each of its own was answered once.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};

use super::program::Files;
use crate::{Ended, run};

#[path = "../../testing/plans.rs"]
#[expect(dead_code, reason = "the tests of other crates use the rest")]
pub mod plans;

/// The folder of the plans.
pub const FOLDER: &str = "/plans";
/// A cursor in a text.
pub const CURSOR: &str = "‸";

/// How long a test waits for a message that must come.
const LONGEST: Duration = Duration::from_mins(1);

pub struct Editor {
    connection: Connection,
    server: Option<JoinHandle<Ended>>,
    next: i32,
    /// Notifications that no test has looked at.
    pub notifications: Vec<Notification>,
    /// Requests of the server, each answered.
    pub asked: Vec<Request>,
    /// Answers that no test has looked at.
    answers: BTreeMap<i32, Result<Value, lsp_server::ResponseError>>,
    open: Vec<i32>,
    encoding: &'static str,
}

/// The URI of a file.
pub fn uri(name: &str) -> String {
    format!("file://{FOLDER}/{name}")
}

/// The capabilities of an editor that can do all that the server asks for.
pub fn capabilities(encoding: &str) -> Value {
    json!({
        "general": { "positionEncodings": [encoding] },
        "textDocument": { "completion": { "completionItem": { "snippetSupport": true } } },
        "workspace": {
            "didChangeWatchedFiles": { "dynamicRegistration": true },
            "inlayHint": { "refreshSupport": true },
            "codeLens": { "refreshSupport": true },
        },
    })
}

impl Editor {
    /// An editor with these files on disk.
    pub fn with(files: &[(&str, &str)]) -> Self {
        Self::of(files, "utf-16")
    }

    pub fn of(files: &[(&str, &str)], encoding: &'static str) -> Self {
        let mut editor = Self::before_initialize(files);
        editor.encoding = encoding;
        let folder = json!([{ "uri": format!("file://{FOLDER}"), "name": "plans" }]);
        let params = json!({
            "processId": null, "rootUri": null, "workspaceFolders": folder,
            "capabilities": capabilities(encoding),
        });
        let answer = editor.ask("initialize", params);
        assert_eq!(answer["capabilities"]["positionEncoding"], encoding);
        editor.notify("initialized", json!({}));
        editor
    }

    /// An editor that has not said anything.
    pub fn before_initialize(files: &[(&str, &str)]) -> Self {
        let path = |name: &str| PathBuf::from(format!("{FOLDER}/{name}"));
        let files = files
            .iter()
            .map(|(name, text)| (path(name), (*text).to_owned()));
        let program = Arc::new(Files(files.collect()));
        let (own, connection) = Connection::memory();
        Self {
            connection,
            server: Some(std::thread::spawn(move || run(own, program))),
            next: 0,
            notifications: Vec::new(),
            asked: Vec::new(),
            answers: BTreeMap::new(),
            open: Vec::new(),
            encoding: "utf-16",
        }
    }

    pub fn send(&self, message: Message) {
        self.connection.sender.send(message).unwrap();
    }

    pub fn notify(&self, method: &str, params: Value) {
        self.send(Message::Notification(Notification {
            method: method.to_owned(),
            params,
        }));
    }

    /// Sends a request.
    pub fn begin(&mut self, method: &str, params: Value) -> i32 {
        self.next += 1;
        self.open.push(self.next);
        self.send(Message::Request(Request {
            id: RequestId::from(self.next),
            method: method.to_owned(),
            params,
        }));
        self.next
    }

    /// Takes the next message.
    fn take(&mut self) {
        let message = self.connection.receiver.recv_timeout(LONGEST);
        match message.expect("the server is alive") {
            Message::Request(request) => {
                self.send(Message::Response(Response {
                    id: request.id.clone(),
                    response_result: Ok(Value::Null),
                }));
                self.asked.push(request);
            }
            Message::Notification(notification) => self.notifications.push(notification),
            Message::Response(response) => {
                let id: i32 = serde_json::from_value(json!(response.id)).unwrap();
                let before = self.open.len();
                self.open.retain(|open| *open != id);
                assert_eq!(
                    self.open.len() + 1,
                    before,
                    "an answer to nothing: {response:?}"
                );
                self.answers.insert(id, response.response_result);
            }
        }
    }

    /// The answer to a request.
    pub fn end(&mut self, id: i32) -> Result<Value, lsp_server::ResponseError> {
        loop {
            if let Some(answer) = self.answers.remove(&id) {
                return answer;
            }
            self.take();
        }
    }

    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.begin(method, params);
        self.end(id)
            .unwrap_or_else(|error| panic!("{method}: {error:?}"))
    }

    pub fn fails(&mut self, method: &str, params: Value) -> lsp_server::ResponseError {
        let id = self.begin(method, params);
        self.end(id).expect_err(method)
    }

    /// The next notification of a method that fits.
    pub fn notified(&mut self, method: &str, fits: impl Fn(&Value) -> bool) -> Value {
        loop {
            let found = self
                .notifications
                .iter()
                .position(|one| one.method == method && fits(&one.params));
            if let Some(found) = found {
                return self.notifications.remove(found).params;
            }
            self.take();
        }
    }

    /// Waits until the server has asked for something.
    pub fn was_asked(&mut self, method: &str) {
        while !self.asked.iter().any(|request| request.method == method) {
            self.take();
        }
    }

    pub fn open(&self, name: &str, text: &str) {
        self.open_uri(&uri(name), text);
    }

    pub fn open_uri(&self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "psd", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Replaces the whole text of a document.
    pub fn replace(&self, name: &str, version: i32, text: &str) {
        self.notify(
            "textDocument/didChange",
            json!({
                "textDocument": { "uri": uri(name), "version": version },
                "contentChanges": [{ "text": text }],
            }),
        );
    }

    /// The next diagnostics of a document.
    pub fn diagnostics(&mut self, name: &str) -> Value {
        let uri = uri(name);
        self.notified("textDocument/publishDiagnostics", |params| {
            params["uri"] == uri
        })
    }

    /// Opens a text with a cursor, and asks at the cursor.
    pub fn at(&mut self, name: &str, marked: &str, method: &str, more: Value) -> Value {
        let params = self.place(name, marked, more);
        self.ask(method, params)
    }

    /// Opens a text with a cursor; the parameters of a request there.
    pub fn place(&self, name: &str, marked: &str, more: Value) -> Value {
        let at = marked.find(CURSOR).expect("a cursor");
        self.open(name, &marked.replacen(CURSOR, "", 1));
        let mut params = json!({
            "textDocument": { "uri": uri(name) },
            "position": position(&marked[..at], self.encoding),
        });
        if let Value::Object(more) = more {
            for (key, value) in more {
                params[key] = value;
            }
        }
        params
    }

    /// Ends the server in order.
    pub fn shut_down(mut self) -> Ended {
        let ended = self.finish();
        ended.expect("the server runs")
    }

    fn finish(&mut self) -> Option<Ended> {
        let server = self.server.take()?;
        self.ask("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        let ended = server.join().expect("the server does not panic");
        // All that it sent is received; nothing that it was asked is open.
        while let Ok(message) = self.connection.receiver.try_recv() {
            assert!(
                !matches!(message, Message::Response(_)),
                "a second answer: {message:?}"
            );
        }
        assert_eq!(self.open, [0; 0], "requests without an answer");
        Some(ended)
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            self.finish();
        }
    }
}

/// The position of the end of a text.
pub fn position(before: &str, encoding: &str) -> Value {
    let line = before.matches('\n').count();
    let last = before.rsplit('\n').next().unwrap_or_default();
    let character = if encoding == "utf-8" {
        last.len()
    } else {
        last.encode_utf16().count()
    };
    json!({ "line": line, "character": character })
}

/// A text with the edits of an answer.
pub fn edited(text: &str, edits: &Value) -> String {
    let offset = |position: &Value| {
        let line = position["line"].as_u64().unwrap();
        let line = usize::try_from(line).unwrap();
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let units = usize::try_from(position["character"].as_u64().unwrap()).unwrap();
        let mut counted = 0;
        for (at, character) in text[start..].char_indices() {
            if counted >= units {
                return start + at;
            }
            counted += character.len_utf16();
        }
        text.len()
    };
    let mut edits: Vec<(usize, usize, &str)> = edits
        .as_array()
        .unwrap()
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            (
                offset(&range["start"]),
                offset(&range["end"]),
                edit["newText"].as_str().unwrap(),
            )
        })
        .collect();
    edits.sort_unstable();
    let mut edited = text.to_owned();
    for (start, end, new) in edits.into_iter().rev() {
        edited.replace_range(start..end, new);
    }
    edited
}

/// The names of the items of a completion, in order.
pub fn labels(completion: &Value) -> Vec<&str> {
    let items = completion["items"].as_array().unwrap();
    items
        .iter()
        .map(|item| item["label"].as_str().unwrap())
        .collect()
}
