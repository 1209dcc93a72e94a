//! What the server can do, and what it needs to know of the editor. In: the first message. Out: the answer to it.

use gen_lsp_types as lsp;

use crate::answers::semantic::TOKEN_TYPES;
use crate::text::Encoding;

/// The command of the code lens.
pub const SIMULATE: &str = "psd.simulate";

/// What the editor can do.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is one ability")]
pub struct Client {
    pub encoding: Encoding,
    /// It fills in placeholders of a completion.
    pub snippets: bool,
    /// It reports that a file changes on disk, if the server registers for it.
    pub watches: bool,
    /// It asks again for hints, or for lenses, if the server requests it.
    pub refreshes_hints: bool,
    pub refreshes_lenses: bool,
}

impl Client {
    pub fn of(capabilities: &lsp::ClientCapabilities) -> Self {
        let encodings = capabilities.general.as_ref();
        let encodings = encodings.and_then(|general| general.position_encodings.as_ref());
        let utf8 = encodings.is_some_and(|list| list.contains(&lsp::PositionEncodingKind::UTF8));
        let workspace = capabilities.workspace.as_ref();
        let completion = capabilities.text_document.as_ref();
        let completion = completion.and_then(|document| document.completion.as_ref());
        let item = completion.and_then(|completion| completion.completion_item.as_ref());
        let watched = workspace.and_then(|one| one.did_change_watched_files.as_ref());
        let hints = workspace.and_then(|one| one.inlay_hint.as_ref());
        let lenses = workspace.and_then(|one| one.code_lens.as_ref());
        Self {
            encoding: if utf8 {
                Encoding::Utf8
            } else {
                Encoding::Utf16
            },
            snippets: item.and_then(|item| item.snippet_support) == Some(true),
            watches: watched.and_then(|one| one.dynamic_registration) == Some(true),
            refreshes_hints: hints.and_then(|one| one.refresh_support) == Some(true),
            refreshes_lenses: lenses.and_then(|one| one.refresh_support) == Some(true),
        }
    }
}

/// The answer to the first message.
pub fn initialize_result(encoding: Encoding) -> lsp::InitializeResult {
    let words = |words: &[&str]| Some(words.iter().map(|&word| word.to_owned()).collect());
    lsp::InitializeResult {
        server_info: Some(lsp::ServerInfo {
            name: "psd".to_owned(),
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        }),
        capabilities: lsp::ServerCapabilities {
            position_encoding: Some(match encoding {
                Encoding::Utf8 => lsp::PositionEncodingKind::UTF8,
                Encoding::Utf16 => lsp::PositionEncodingKind::UTF16,
            }),
            text_document_sync: Some(
                lsp::TextDocumentSyncOptions {
                    open_close: Some(true),
                    change: Some(lsp::TextDocumentSyncKind::Incremental),
                    save: Some(true.into()),
                    ..lsp::TextDocumentSyncOptions::default()
                }
                .into(),
            ),
            completion_provider: Some(lsp::CompletionOptions {
                trigger_characters: words(&[".", "=", " ", "(", "\"", "["]),
                ..lsp::CompletionOptions::default()
            }),
            hover_provider: Some(true.into()),
            signature_help_provider: Some(lsp::SignatureHelpOptions {
                trigger_characters: words(&["(", ","]),
                ..lsp::SignatureHelpOptions::default()
            }),
            definition_provider: Some(true.into()),
            references_provider: Some(true.into()),
            document_highlight_provider: Some(true.into()),
            document_symbol_provider: Some(true.into()),
            workspace_symbol_provider: Some(true.into()),
            code_action_provider: Some(
                lsp::CodeActionOptions {
                    code_action_kinds: Some(vec![
                        lsp::CodeActionKind::QuickFix,
                        lsp::CodeActionKind::RefactorRewrite,
                    ]),
                    ..lsp::CodeActionOptions::default()
                }
                .into(),
            ),
            code_lens_provider: Some(lsp::CodeLensOptions::default()),
            document_link_provider: Some(lsp::DocumentLinkOptions::default()),
            document_formatting_provider: Some(true.into()),
            document_on_type_formatting_provider: Some(lsp::DocumentOnTypeFormattingOptions {
                first_trigger_character: "}".to_owned(),
                more_trigger_character: words(&["\n"]),
            }),
            rename_provider: Some(
                lsp::RenameOptions {
                    prepare_provider: Some(true),
                    ..lsp::RenameOptions::default()
                }
                .into(),
            ),
            folding_range_provider: Some(true.into()),
            selection_range_provider: Some(true.into()),
            semantic_tokens_provider: Some(
                lsp::SemanticTokensOptions {
                    legend: lsp::SemanticTokensLegend {
                        token_types: TOKEN_TYPES.iter().map(|&one| one.to_owned()).collect(),
                        token_modifiers: Vec::new(),
                    },
                    full: Some(true.into()),
                    ..lsp::SemanticTokensOptions::default()
                }
                .into(),
            ),
            inlay_hint_provider: Some(true.into()),
            execute_command_provider: Some(lsp::ExecuteCommandOptions {
                commands: vec![SIMULATE.to_owned()],
                ..lsp::ExecuteCommandOptions::default()
            }),
            workspace: Some(lsp::WorkspaceOptions {
                workspace_folders: Some(lsp::WorkspaceFoldersServerCapabilities {
                    supported: Some(true),
                    change_notifications: Some(true.into()),
                }),
                ..lsp::WorkspaceOptions::default()
            }),
            ..lsp::ServerCapabilities::default()
        },
    }
}
