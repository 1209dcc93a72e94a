//! Colours. In: a document. Out: its words with their roles, coded as the protocol asks.

use gen_lsp_types as lsp;
use psd_language::syntax::tokens::{JOINING_WORDS, Kind, Token, Tokens};
use psd_text::source::FileId;

use super::View;
use crate::cursor::plan_text;
use crate::occurrences::{Meaning, Occurrence, SymbolKind};
use crate::text::narrow;

/// The roles of words, by their numbers.
pub const TOKEN_TYPES: &[&str] = &[
    "keyword",
    "comment",
    "string",
    "number",
    "type",
    "operator",
    "property",
    "parameter",
    "variable",
    "function",
    "enumMember",
    "class",
    "method",
];

/// The number of a role.
fn role(name: &str) -> Option<u32> {
    let at = TOKEN_TYPES.iter().position(|role| *role == name)?;
    Some(narrow(at))
}

pub fn tokens(view: &View<'_>, _: &lsp::SemanticTokensParams) -> lsp::SemanticTokens {
    let text = view.text();
    let plan = plan_text(view.name(), text.as_str());
    let tokens = Tokens::read(&plan, FileId(0));
    let mut words = view
        .analysis
        .occurrences
        .of_file(view.file)
        .iter()
        .peekable();
    let mut data: Vec<lsp::SemanticToken> = Vec::new();
    let mut before = lsp::Position::new(0, 0);
    for token in &tokens.list {
        while words
            .next_if(|word| word.span.range().end <= token.start)
            .is_some()
        {}
        let meaning = words
            .clone()
            .take_while(|word| word.span.range().start <= token.start)
            .filter(|word| word.span.range().end >= token.end)
            .last();
        let Some(role) = of_token(*token, &plan, meaning, view).and_then(role) else {
            continue;
        };
        // A token of several lines has no code; a line end is part of none.
        let whole = &plan[token.start..token.end];
        // A lone carriage return ends a line for an editor.
        let shown = whole.split(['\r', '\n']).next().unwrap_or_default();
        let range = text.range(token.start..token.start + shown.len());
        let (start, end) = (range.start, range.end);
        let same_line = start.line == before.line;
        data.push(lsp::SemanticToken {
            delta_line: start.line - before.line,
            delta_start: start.character - if same_line { before.character } else { 0 },
            length: end.character - start.character,
            token_type: role,
            token_modifiers_bitset: 0,
        });
        before = start;
    }
    lsp::SemanticTokens {
        result_id: None,
        data,
    }
}

fn of_token(
    token: Token,
    plan: &str,
    word: Option<&Occurrence>,
    view: &View<'_>,
) -> Option<&'static str> {
    Some(match token.kind {
        Kind::Newline => return None,
        Kind::Comment => "comment",
        Kind::Text => "string",
        Kind::Number => "number",
        Kind::Unit => "type",
        Kind::Sign => match &plan[token.start..token.end] {
            "<" | "<=" | ">" | ">=" | "==" | "!=" | "+" | "-" | "*" | "/" | "^" | "~" | ".."
            | "=" => "operator",
            _ => return None,
        },
        Kind::Word => match word.map(|word| word.meaning) {
            Some(Meaning::ItemWord(_) | Meaning::Keyword(_)) => "keyword",
            Some(Meaning::Symbol(index)) => match view.analysis.symbol(index).kind {
                SymbolKind::Let | SymbolKind::Param => "variable",
                SymbolKind::Requirement => "string",
                SymbolKind::Block(kind) => {
                    if psd_plan::schema::block(kind).is_procedure() {
                        "method"
                    } else {
                        "class"
                    }
                }
            },
            Some(Meaning::Argument(_)) => "parameter",
            Some(Meaning::Variant(_) | Meaning::CriticalTimeStep) => "enumMember",
            Some(Meaning::Function(_) | Meaning::Figure(_)) => "function",
            Some(
                Meaning::Entry { .. }
                | Meaning::FieldOf(_)
                | Meaning::Result { .. }
                | Meaning::Uncertainty,
            ) => "property",
            Some(Meaning::Number | Meaning::File) | None => {
                let written = &plan[token.start..token.end];
                if JOINING_WORDS.contains(&written) || written == "in" {
                    "keyword"
                } else {
                    return None;
                }
            }
        },
    })
}
