//! The rows of a formatted file: one for each field, item, brace, comment and blank line, in order. In: tokens and
//! pieces. Out: [`Row`]s, whose columns are not yet aligned.

use super::{BLOCK_WIDTH, INDENT, value};
use crate::syntax::layout::{Piece, Statement};
use crate::syntax::lexical::tokens::{Kind as TokenKind, Tokens};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    Blank,
    Comment,
    /// A whole line that is kept: a block on one line, a brace.
    Plain,
    Use,
    Field,
    /// `let` or `param`.
    Binding,
    Require,
}

impl RowKind {
    /// Whether neighbours of this kind are aligned in columns.
    pub fn aligns(self) -> bool {
        self != RowKind::Plain
    }
}

#[derive(Debug)]
pub struct Row {
    pub kind: RowKind,
    pub indent: usize,
    /// The words before the value, one for each column.
    pub lead: Vec<String>,
    /// The tokens of the value.
    pub value: Option<(usize, usize)>,
    pub comment: Option<String>,
}

pub fn rows(tokens: &Tokens, pieces: &[Piece]) -> Vec<Row> {
    let mut writer = Writer {
        tokens,
        rows: Vec::new(),
        at: 0,
        newlines: 0,
        indent: 0,
        opened: true,
    };
    for piece in pieces {
        match piece {
            Piece::Item(statement) => {
                writer.until(statement.start);
                writer.item(*statement);
            }
            Piece::Block {
                head,
                open,
                fields,
                close,
            } => {
                writer.until(head.start);
                writer.block(*head, *open, fields, close.unwrap_or(*open));
            }
        }
    }
    writer.until(tokens.list.len());
    writer.rows
}

struct Writer<'a> {
    tokens: &'a Tokens<'a>,
    rows: Vec<Row>,
    /// The first token not yet written.
    at: usize,
    /// Line ends since the last row.
    newlines: usize,
    indent: usize,
    /// The last row opened a block, or there is none: no blank line follows.
    opened: bool,
}

impl Writer<'_> {
    fn words(&self, start: usize, end: usize) -> String {
        let words: Vec<&str> = self.tokens.list[start..end]
            .iter()
            .map(|token| self.tokens.text_of(*token))
            .collect();
        words.join(" ")
    }

    fn row(&mut self, kind: RowKind, lead: Vec<String>, value: Option<(usize, usize)>) {
        if self.newlines > 1 && !self.opened {
            self.rows.push(Row {
                kind: RowKind::Blank,
                indent: 0,
                lead: Vec::new(),
                value: None,
                comment: None,
            });
        }
        self.rows.push(Row {
            kind,
            indent: self.indent,
            lead,
            value,
            comment: None,
        });
        self.newlines = 0;
        self.opened = false;
    }

    /// Writes the comments before token `end`; one on the line of the last row belongs to that row.
    fn until(&mut self, end: usize) {
        while self.at < end {
            let token = self.tokens.list[self.at];
            match token.kind {
                TokenKind::Newline => self.newlines += 1,
                TokenKind::Comment => {
                    let text = self.tokens.text_of(token).trim_end().to_owned();
                    match self
                        .rows
                        .last_mut()
                        .filter(|row| self.newlines == 0 && row.comment.is_none())
                    {
                        Some(row) if row.kind != RowKind::Comment => row.comment = Some(text),
                        _ => self.row(RowKind::Comment, vec![text], None),
                    }
                }
                _ => {}
            }
            self.at += 1;
        }
    }

    fn item(&mut self, item: Statement) {
        let word = |offset: usize| {
            self.words(item.start + offset, (item.start + offset + 1).min(item.end))
        };
        match word(0).as_str() {
            "use" => self.row(RowKind::Use, vec![self.words(item.start, item.end)], None),
            "require" => self.row(
                RowKind::Require,
                vec![word(1)],
                Some((item.start + 2, item.end)),
            ),
            _ => self.row(
                RowKind::Binding,
                vec![word(0), word(1)],
                Some((item.start + 3, item.end)),
            ),
        }
        self.at = item.end;
    }

    fn field(&mut self, field: Statement) {
        let key = self.words(field.start, field.start + 1);
        self.row(
            RowKind::Field,
            vec![key],
            Some((field.start + 2, field.end)),
        );
        self.at = field.end;
    }

    fn block(&mut self, head: Statement, open: usize, fields: &[Statement], close: usize) {
        let head = self.words(head.start, head.end);
        if let Some(line) = self.one_line(&head, open, fields, close) {
            self.row(RowKind::Plain, vec![line], None);
            self.at = close + 1;
            return;
        }
        self.row(RowKind::Plain, vec![format!("{head} {{")], None);
        self.at = open + 1;
        self.opened = true;
        self.indent += INDENT;
        for field in fields {
            self.until(field.start);
            self.field(*field);
        }
        self.until(close);
        self.indent -= INDENT;
        // No blank line is written before the brace.
        self.newlines = 0;
        self.row(RowKind::Plain, vec!["}".to_owned()], None);
        self.at = close + 1;
    }

    /// `head { key = value }`, if it was written on one line and is short.
    fn one_line(
        &self,
        head: &str,
        open: usize,
        fields: &[Statement],
        close: usize,
    ) -> Option<String> {
        let loose = |token: &crate::syntax::lexical::tokens::Token| {
            matches!(token.kind, TokenKind::Newline | TokenKind::Comment)
        };
        if self.tokens.list[open..close].iter().any(loose) {
            return None;
        }
        let line = match fields {
            [] => format!("{head} {{ }}"),
            [field] => {
                let value = value::flat(self.tokens, field.start + 2, field.end);
                format!(
                    "{head} {{ {} = {value} }}",
                    self.words(field.start, field.start + 1)
                )
            }
            _ => return None,
        };
        (line.chars().count() <= BLOCK_WIDTH).then_some(line)
    }
}
