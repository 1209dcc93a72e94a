//! What the server knows: the editor, the documents, and what was found about their plans. In: messages and findings. Out: messages.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use gen_lsp_types as lsp;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response, ResponseError};
use psd_plan::Plan;
use serde_json::{Value, json};

use super::background::{Background, Found, Order, SimulationOrder, protected};
use super::capabilities::{Client, initialize_result};
use super::publish;
use crate::documents::Documents;
use crate::fixes::Fix;
use crate::text::Encoding;
use crate::uri::path_of;
use crate::{Checked, Program, Simulation};

/// Most steps of a plan that is simulated unasked.
const MOST_STEPS: u64 = 200_000;

/// How the editor ended the server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// After `shutdown`, as the protocol asks.
    InOrder,
    /// By `exit` alone, or by the end of its messages.
    Abruptly,
}

/// Where the conversation is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Phase {
    Before,
    Running,
    ShutDown,
}

/// What is known of a plan.
#[derive(Default)]
pub struct Known {
    /// The change after which it was checked.
    checked: Option<u64>,
    /// By document.
    findings: BTreeMap<String, Vec<lsp::Diagnostic>>,
    pub fixes: Vec<Fix>,
    /// The change after which the fixes were tried.
    tried: Option<u64>,
    plan: Option<Arc<Plan>>,
    /// The newest simulation. It stays while the plan has an error.
    pub simulation: Option<Simulation>,
    simulated: Option<u64>,
    ordered: Option<u64>,
}

/// A request that waits for what a thread finds.
enum Waiting {
    /// For the fixes of a plan.
    Actions { request: Request, plan: String },
    /// For the simulation of a plan.
    Simulation { id: RequestId, plan: String },
}

pub struct Server {
    send: Box<dyn Fn(Message)>,
    background: Background,
    phase: Phase,
    pub(super) client: Client,
    pub(super) documents: Documents,
    /// Whether a document changed since the last check.
    pub(super) changed: bool,
    /// Number of changes.
    revision: u64,
    pub(super) known: BTreeMap<String, Known>,
    waiting: Vec<Waiting>,
    /// Number of requests to the editor.
    asked: i32,
}

impl Server {
    pub fn new(
        send: Box<dyn Fn(Message)>,
        program: Arc<dyn Program>,
        background: Background,
    ) -> Self {
        let client = Client::of(&lsp::ClientCapabilities::default());
        Self {
            send,
            background,
            phase: Phase::Before,
            client,
            documents: Documents::new(program, Encoding::Utf16),
            changed: false,
            revision: 0,
            known: BTreeMap::new(),
            waiting: Vec::new(),
            asked: 0,
        }
    }

    pub fn ended(&self) -> Ended {
        if self.phase == Phase::ShutDown {
            Ended::InOrder
        } else {
            Ended::Abruptly
        }
    }

    /// Whether a later message cancels a request, which is then answered.
    pub fn is_cancelled<'m>(
        &self,
        message: &Message,
        mut later: impl Iterator<Item = &'m Notification>,
    ) -> bool {
        let Message::Request(request) = message else {
            return false;
        };
        let id = json!(request.id);
        let cancels =
            |one: &Notification| one.method == "$/cancelRequest" && one.params["id"] == id;
        let is_cancelled = later.any(cancels);
        if is_cancelled {
            self.fail(request.id.clone(), ErrorCode::RequestCanceled, "cancelled");
        }
        is_cancelled
    }

    /// Takes one message.
    pub fn receive(&mut self, message: Message) {
        match message {
            // The answers of the editor say nothing that the server needs.
            Message::Response(_) => {}
            Message::Notification(notification) => {
                if self.phase == Phase::Running {
                    protected(|| self.notified(notification));
                }
            }
            Message::Request(request) => {
                let id = request.id.clone();
                if protected(|| self.requested(request)).is_none() {
                    self.fail(id, ErrorCode::InternalError, "psd failed at this request");
                }
            }
        }
    }

    fn requested(&mut self, request: Request) {
        let id = request.id.clone();
        match (self.phase, request.method.as_str()) {
            (Phase::Before, "initialize") => self.initialize(request),
            (Phase::Before, _) => self.fail(
                id,
                ErrorCode::ServerNotInitialized,
                "the first request is `initialize`",
            ),
            (Phase::Running, "shutdown") => {
                self.phase = Phase::ShutDown;
                self.answer(id, Ok(Value::Null));
            }
            (Phase::ShutDown, _) => {
                self.fail(id, ErrorCode::InvalidRequest, "the server is shut down");
            }
            (Phase::Running, "initialize") => {
                self.fail(id, ErrorCode::InvalidRequest, "the server is initialized");
            }
            (Phase::Running, "textDocument/codeAction") => self.code_action(request),
            (Phase::Running, "workspace/executeCommand") => self.execute(request),
            (Phase::Running, _) => {
                let answer = self.ask(&request);
                self.answer(id, answer);
            }
        }
    }

    fn initialize(&mut self, request: Request) {
        let Request { id, params, .. } = request;
        let params: lsp::InitializeParams = match serde_json::from_value(params) {
            Ok(params) => params,
            Err(error) => {
                return self.fail(id, ErrorCode::InvalidParams, &error.to_string());
            }
        };
        self.client = Client::of(&params.capabilities);
        self.documents.encoding = self.client.encoding;
        let folders = params.workspace_folders_initialize_params.workspace_folders;
        let mut folders: Vec<lsp::Uri> = match folders {
            Some(lsp::WorkspaceFolders::WorkspaceFolderList(folders)) => {
                folders.into_iter().map(|folder| folder.uri).collect()
            }
            _ => Vec::new(),
        };
        if folders.is_empty() {
            #[expect(deprecated, reason = "older editors name their folder here")]
            folders.extend(params.root_uri);
        }
        for folder in folders.iter().filter_map(|uri| path_of(&uri.0)) {
            self.documents.add_folder(&folder);
        }
        self.phase = Phase::Running;
        let result = initialize_result(self.client.encoding);
        self.answer(id, Ok(json!(result)));
    }

    fn notified(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        match method.as_str() {
            "initialized" => self.watch(),
            "textDocument/didOpen" => {
                if let Ok(params) = serde_json::from_value::<lsp::DidOpenTextDocumentParams>(params)
                {
                    let document = params.text_document;
                    self.documents
                        .open(&document.uri.0, document.version, &document.text);
                    self.change();
                }
            }
            "textDocument/didChange" => {
                if let Ok(params) =
                    serde_json::from_value::<lsp::DidChangeTextDocumentParams>(params)
                {
                    let document = params.text_document;
                    let uri = document.text_document_identifier.uri;
                    self.documents
                        .change(&uri.0, document.version, params.content_changes);
                    self.change();
                }
            }
            "textDocument/didClose" => {
                if let Ok(params) =
                    serde_json::from_value::<lsp::DidCloseTextDocumentParams>(params)
                {
                    self.documents.close(&params.text_document.uri.0);
                    self.change();
                }
            }
            // A data file may have changed too.
            "textDocument/didSave" => self.change(),
            "workspace/didChangeWatchedFiles" => {
                if let Ok(params) =
                    serde_json::from_value::<lsp::DidChangeWatchedFilesParams>(params)
                {
                    for change in params.changes {
                        self.documents.changed_on_disk(&change.uri.0);
                    }
                    self.change();
                }
            }
            "workspace/didChangeWorkspaceFolders" => {
                if let Ok(params) =
                    serde_json::from_value::<lsp::DidChangeWorkspaceFoldersParams>(params)
                {
                    let paths = |folders: &[lsp::WorkspaceFolder]| -> Vec<_> {
                        folders
                            .iter()
                            .filter_map(|folder| path_of(&folder.uri.0))
                            .collect()
                    };
                    for folder in paths(&params.event.removed) {
                        self.documents.remove_folder(&folder);
                    }
                    for folder in paths(&params.event.added) {
                        self.documents.add_folder(&folder);
                    }
                    self.change();
                }
            }
            _ => {}
        }
    }

    /// Asks the editor to tell when a plan changes on disk.
    fn watch(&mut self) {
        if self.client.watches {
            let watchers = ["**/*.psd", "**/*.md", "**/*.markdown", "**/*.csv"];
            let watchers = watchers.map(|pattern| json!({ "globPattern": pattern }));
            let method = "workspace/didChangeWatchedFiles";
            self.request(
                "client/registerCapability",
                json!({ "registrations": [{
                    "id": "files", "method": method, "registerOptions": { "watchers": watchers },
                }] }),
            );
        }
    }

    fn change(&mut self) {
        self.changed = true;
        self.revision += 1;
    }

    /// Checks the plans of all open documents, beside the loop.
    pub fn check(&mut self) {
        self.changed = false;
        let plans = self.documents.open_plans();
        let open: BTreeSet<&String> = plans.iter().collect();
        let gone: Vec<String> = self
            .known
            .keys()
            .filter(|key| !open.contains(key))
            .cloned()
            .collect();
        for plan in gone {
            let known = self.known.remove(&plan).unwrap_or_default();
            self.answer_waiting(&plan);
            for document in known.findings.keys() {
                self.publish(document);
            }
        }
        self.background.check(Order {
            revision: self.revision,
            plans,
            documents: self.documents.now.clone(),
        });
    }

    /// Takes what a thread found. What was found about older texts is dropped, because newer texts are looked at next.
    pub fn found(&mut self, found: Found) {
        match found {
            Found::Checked {
                plan_key,
                revision,
                checked,
            } if revision == self.revision => {
                if let Some(checked) = checked {
                    self.checked(&plan_key, *checked);
                } else {
                    self.known.entry(plan_key.clone()).or_default().checked = Some(revision);
                }
                self.simulate(&plan_key);
            }
            Found::Fixes {
                plan_key,
                revision,
                fixes,
            } if revision == self.revision => {
                let known = self.known.entry(plan_key.clone()).or_default();
                (known.fixes, known.tried) = (fixes, Some(revision));
                self.answer_waiting(&plan_key);
            }
            Found::Simulated {
                plan_key,
                revision,
                simulation,
            } => {
                let Some(known) = self.known.get_mut(&plan_key) else {
                    return;
                };
                known.simulated = Some(revision);
                if revision == self.revision || simulation.is_some() {
                    known.simulation = simulation;
                }
                self.answer_waiting(&plan_key);
                if self.client.refreshes_hints {
                    self.request("workspace/inlayHint/refresh", Value::Null);
                }
                if self.client.refreshes_lenses {
                    self.request("workspace/codeLens/refresh", Value::Null);
                }
            }
            Found::Checked { .. } | Found::Fixes { .. } => {}
        }
    }

    fn checked(&mut self, plan_key: &str, checked: Checked) {
        let Checked {
            plan,
            diagnostics,
            sources,
        } = checked;
        let findings = publish::by_document(
            plan_key,
            &diagnostics,
            &sources,
            &self.documents.now,
            self.client.encoding,
        );
        let known = self.known.entry(plan_key.to_owned()).or_default();
        known.checked = Some(self.revision);
        known.plan = plan.map(Arc::new);
        let before = std::mem::replace(&mut known.findings, findings.clone());
        let documents: BTreeSet<String> = before.into_keys().chain(findings.into_keys()).collect();
        for document in &documents {
            self.publish(document);
        }
    }

    /// Sends the diagnostics of a document, from every plan that it belongs to.
    fn publish(&self, document: &str) {
        let mut diagnostics: Vec<lsp::Diagnostic> = Vec::new();
        for known in self.known.values() {
            for one in known.findings.get(document).into_iter().flatten() {
                if !diagnostics.contains(one) {
                    diagnostics.push(one.clone());
                }
            }
        }
        let open = self.documents.now.open.get(document);
        let params = lsp::PublishDiagnosticsParams {
            uri: self.documents.now.uri(document),
            version: open.map(|open| open.version),
            diagnostics,
        };
        let params = json!(params);
        let method = "textDocument/publishDiagnostics".to_owned();
        (self.send)(Message::Notification(Notification { method, params }));
    }

    /// Simulates a plan that has no error, if it is short or somebody waits for it.
    fn simulate(&mut self, plan_key: &str) {
        let wanted =
            |one: &Waiting| matches!(one, Waiting::Simulation { plan, .. } if plan == plan_key);
        let is_wanted = self.waiting.iter().any(wanted);
        let program = &self.documents.now.program;
        let Some(known) = self.known.get_mut(plan_key) else {
            return;
        };
        match &known.plan {
            Some(plan) if is_wanted || program.steps(plan) <= MOST_STEPS => {
                if known.ordered != Some(self.revision) {
                    known.ordered = Some(self.revision);
                    self.background.simulate(SimulationOrder {
                        plan_key: plan_key.to_owned(),
                        revision: self.revision,
                        plan: Arc::clone(plan),
                    });
                }
            }
            Some(_) => {}
            None => {
                known.simulated = Some(self.revision);
                self.answer_waiting(plan_key);
            }
        }
    }

    fn code_action(&mut self, request: Request) {
        let uri = request.params["textDocument"]["uri"]
            .as_str()
            .unwrap_or_default();
        let key = crate::uri::normal(uri);
        let plan = self.documents.plans_of(&key).remove(0);
        if self.documents.now.open.contains_key(&key) {
            if self.changed {
                self.check();
            }
            if self.known.get(&plan).and_then(|known| known.tried) != Some(self.revision) {
                self.waiting.push(Waiting::Actions { request, plan });
                return;
            }
        }
        let answer = self.ask(&request);
        self.answer(request.id, answer);
    }

    /// `psd.simulate` of a document.
    fn execute(&mut self, request: Request) {
        let Request { id, params, .. } = request;
        let uri = params["arguments"][0].as_str();
        let (true, Some(uri)) = (params["command"] == super::capabilities::SIMULATE, uri) else {
            return self.fail(
                id,
                ErrorCode::InvalidParams,
                "`psd.simulate` takes one document",
            );
        };
        let key = crate::uri::normal(uri);
        let plan = self.documents.plans_of(&key).remove(0);
        if !self.documents.now.open.contains_key(&key) {
            return self.fail(id, ErrorCode::RequestFailed, "the document is not open");
        }
        self.waiting.push(Waiting::Simulation {
            id,
            plan: plan.clone(),
        });
        if self.changed {
            self.check();
        }
        let known = self.known.get(&plan);
        if known.and_then(|known| known.simulated) == Some(self.revision) {
            self.answer_waiting(&plan);
        } else if known.and_then(|known| known.checked) == Some(self.revision) {
            self.simulate(&plan);
        }
    }

    /// Answers the requests that waited for this plan, if what they need is there.
    fn answer_waiting(&mut self, plan_key: &str) {
        let known = self.known.get(plan_key);
        let is_tried = known.is_none_or(|known| known.tried == Some(self.revision));
        let is_simulated = known.is_none_or(|known| known.simulated == Some(self.revision));
        let ready = |one: &mut Waiting| match one {
            Waiting::Actions { plan, .. } => plan == plan_key && is_tried,
            Waiting::Simulation { plan, .. } => plan == plan_key && is_simulated,
        };
        let ready: Vec<Waiting> = self.waiting.extract_if(.., ready).collect();
        for one in ready {
            match one {
                Waiting::Actions { request, .. } => {
                    let answer = protected(|| self.ask(&request));
                    match answer {
                        Some(answer) => self.answer(request.id, answer),
                        None => self.fail(
                            request.id,
                            ErrorCode::InternalError,
                            "psd failed at this request",
                        ),
                    }
                }
                Waiting::Simulation { id, plan } => self.simulated(id, &plan),
            }
        }
    }

    /// The answer to `psd.simulate`, which the editor shows as well.
    fn simulated(&self, id: RequestId, plan_key: &str) {
        let known = self.known.get(plan_key);
        let simulation = known.filter(|known| known.plan.is_some());
        let (kind, text) = match simulation.and_then(|known| known.simulation.as_ref()) {
            Some(simulation) => (
                lsp::MessageType::Info,
                crate::answers::lens::in_one_line(simulation),
            ),
            // Editors show an error as a failure of the server.
            None => (
                lsp::MessageType::Warning,
                "no simulation: the plan has an error".to_owned(),
            ),
        };
        let params = json!({ "type": kind, "message": text });
        let method = "window/showMessage".to_owned();
        (self.send)(Message::Notification(Notification { method, params }));
        self.answer(id, Ok(json!(text)));
    }

    pub(super) fn answer(&self, id: RequestId, answer: Result<Value, ResponseError>) {
        (self.send)(Message::Response(Response {
            id,
            response_result: answer,
        }));
    }

    fn fail(&self, id: RequestId, code: ErrorCode, message: &str) {
        self.answer(id, Err(error(code, message)));
    }

    fn request(&mut self, method: &str, params: Value) {
        self.asked += 1;
        (self.send)(Message::Request(Request {
            id: RequestId::from(self.asked),
            method: method.to_owned(),
            params,
        }));
    }
}

/// An error as an answer.
pub fn error(code: ErrorCode, message: &str) -> ResponseError {
    ResponseError {
        code: code as i32,
        message: message.to_owned(),
        data: None,
    }
}
