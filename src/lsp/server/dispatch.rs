//! Which answer belongs to which request. In: a request. Out: its answer as JSON.

use gen_lsp_types as lsp;
use lsp_server::{ErrorCode, Request, ResponseError};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::state::{Server, error};
use crate::answers::{
    View, actions, completion, folding, format, hints, hover, lens, links, navigation, rename,
    selection, semantic, signature, symbols,
};
use crate::uri::normal;

type Answer = Result<Value, ResponseError>;

impl Server {
    /// The answer to a request of the running server.
    pub(super) fn ask(&self, request: &Request) -> Answer {
        match request.method.as_str() {
            "textDocument/hover" => self.on(request, hover::hover),
            "textDocument/completion" => self.on(request, completion::completion),
            "textDocument/signatureHelp" => self.on(request, signature::signature),
            "textDocument/definition" => self.on(request, navigation::definition),
            "textDocument/references" => self.on(request, navigation::references),
            "textDocument/documentHighlight" => self.on(request, navigation::highlight),
            "textDocument/prepareRename" => self.on(request, rename::prepare),
            "textDocument/rename" => self.on_or_fail(request, rename::rename),
            "textDocument/documentSymbol" => self.on(request, symbols::of_document),
            "textDocument/formatting" => self.on(request, format::whole),
            "textDocument/onTypeFormatting" => self.on(request, format::on_type),
            "textDocument/semanticTokens/full" => self.on(request, semantic::tokens),
            "textDocument/foldingRange" => self.on(request, folding::folding),
            "textDocument/selectionRange" => self.on(request, selection::selection),
            "textDocument/documentLink" => self.on(request, links::links),
            "textDocument/inlayHint" => self.on(request, hints::hints),
            "textDocument/codeLens" => self.on(request, lens::lenses),
            "textDocument/codeAction" => self.on(request, actions::actions),
            "workspace/symbol" => {
                let params: lsp::WorkspaceSymbolParams = read(&request.params)?;
                Ok(json!(symbols::of_workspace(&self.documents, &params.query)))
            }
            other => Err(error(
                ErrorCode::MethodNotFound,
                &format!("psd does not answer `{other}`"),
            )),
        }
    }

    /// An answer about an open document; null if the document is not open.
    fn on<P: DeserializeOwned, R: Serialize>(
        &self,
        request: &Request,
        answer: fn(&View<'_>, &P) -> R,
    ) -> Answer {
        self.on_or_fail(request, |view, params| Ok(answer(view, params)))
    }

    fn on_or_fail<P: DeserializeOwned, R: Serialize>(
        &self,
        request: &Request,
        answer: impl Fn(&View<'_>, &P) -> Result<R, String>,
    ) -> Answer {
        let params: P = read(&request.params)?;
        let uri = request.params["textDocument"]["uri"]
            .as_str()
            .unwrap_or_default();
        let Some(view) = self.view(&normal(uri)) else {
            return Ok(Value::Null);
        };
        let answer = answer(&view, &params);
        answer
            .map(|answer| json!(answer))
            .map_err(|reason| error(ErrorCode::RequestFailed, &reason))
    }

    fn view(&self, key: &str) -> Option<View<'_>> {
        if !self.documents.now.open.contains_key(key) {
            return None;
        }
        let plan = self.documents.plans_of(key).remove(0);
        // A file that its plan cannot reach is a plan of its own.
        let of = |plan: String| {
            let analysis = self.documents.analysis(&plan)?;
            let file = analysis.file(key)?;
            let known = self.known.get(&plan);
            Some(View {
                documents: &self.documents,
                analysis,
                file,
                simulation: known.and_then(|known| known.simulation.as_ref()),
                fixes: known.map_or(&[], |known| &known.fixes),
                snippets: self.client.snippets,
                plan,
            })
        };
        of(plan).or_else(|| of(key.to_owned()))
    }
}

fn read<P: DeserializeOwned>(params: &Value) -> Result<P, ResponseError> {
    P::deserialize(params).map_err(|found| error(ErrorCode::InvalidParams, &found.to_string()))
}
