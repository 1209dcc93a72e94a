//! The fixes of diagnostics. In: the diagnostics of a plan and its files. Out: changes of the text, each of which was tried: with it the
//! check no longer reports the diagnostic, and reports no other in its place. A change is read from the help of the diagnostic.

use std::ops::Range;

use psd_language::check::{LoadError, Loader, imports};
use psd_language::syntax;
use psd_language::syntax::ast::{Block, Entry, ItemKind};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::{FileId, Sources, Span};

use crate::Program;

/// Most changes that are tried for one plan: each is a check of its own.
const MOST_TRIED: usize = 60;
/// Most fixes of one diagnostic.
const MOST_FIXES: usize = 3;

/// A change that removes a diagnostic.
#[derive(Clone, Debug, PartialEq)]
pub struct Fix {
    /// Path of its file from the plan's folder.
    pub file: String,
    pub code: Code,
    /// The bytes at which the diagnostic is.
    pub at: Range<usize>,
    /// What the editor shows: ``replace by `velocity` ``.
    pub title: String,
    /// The bytes that are replaced, and the new text.
    pub replaced: Range<usize>,
    pub text: String,
    /// Whether the diagnostic names this change alone, as the word that was probably meant.
    pub is_meant: bool,
}

/// A change that may be a fix.
struct Change {
    title: String,
    replaced: Range<usize>,
    text: String,
    is_meant: bool,
}

/// A plan as it was checked.
pub struct Plan<'a> {
    pub name: &'a str,
    pub diagnostics: &'a [Diagnostic],
    pub sources: &'a Sources,
    pub loader: &'a Loader<'a>,
}

/// The fixes of the diagnostics of a plan.
pub fn tried_fixes(program: &dyn Program, plan: &Plan<'_>) -> Vec<Fix> {
    let mut tried = 0;
    let mut fixes: Vec<Fix> = Vec::new();
    for diagnostic in plan.diagnostics {
        let Some(span) = diagnostic.span() else {
            continue;
        };
        let mut found: Vec<String> = Vec::new();
        for change in changes(diagnostic, span, plan.sources) {
            if tried >= MOST_TRIED || found.len() >= MOST_FIXES {
                break;
            }
            if found.contains(&change.title) {
                continue;
            }
            tried += 1;
            if plan.is_removed(program, diagnostic, span, &change) {
                found.push(change.title.clone());
                fixes.push(Fix {
                    file: imports::own_path(plan.sources, span.file),
                    code: diagnostic.code,
                    at: span.range(),
                    title: change.title,
                    replaced: change.replaced,
                    text: change.text,
                    is_meant: change.is_meant,
                });
            }
        }
    }
    fixes
}

impl Plan<'_> {
    /// Whether the check of the changed plan no longer reports a diagnostic, and no more than before.
    fn is_removed(
        &self,
        program: &dyn Program,
        diagnostic: &Diagnostic,
        span: Span,
        change: &Change,
    ) -> bool {
        let mut new = self.sources.file(span.file).text.clone();
        if new.get(change.replaced.clone()).is_none() {
            return false;
        }
        new.replace_range(change.replaced.clone(), &change.text);
        let own = imports::own_path(self.sources, span.file);
        let plan = &self.sources.file(FileId(0)).text;
        let checked = if span.file == FileId(0) {
            program.check(self.name, &new, self.loader)
        } else {
            let with_change = |file: &str| -> Result<String, LoadError> {
                if file == own {
                    Ok(new.clone())
                } else {
                    (self.loader)(file)
                }
            };
            program.check(self.name, plan, &with_change)
        };
        let times = |found: &[Diagnostic]| {
            let same = |one: &&Diagnostic| {
                one.code == diagnostic.code && one.message == diagnostic.message
            };
            found.iter().filter(same).count()
        };
        let errors = |found: &[Diagnostic]| found.iter().filter(|one| one.is_error()).count();
        // A warning is looked for only where there is no error, so a new error may hide it. What replaces a diagnostic by another is no fix.
        let (before, after) = (errors(self.diagnostics), errors(&checked.diagnostics));
        let fewer = if diagnostic.is_error() {
            after < before
        } else {
            after <= before && checked.diagnostics.len() < self.diagnostics.len()
        };
        fewer && times(&checked.diagnostics) < times(self.diagnostics)
    }
}

/// The changes that the help of a diagnostic names, the most likely first.
fn changes(diagnostic: &Diagnostic, span: Span, sources: &Sources) -> Vec<Change> {
    let Some(help) = &diagnostic.help else {
        return Vec::new();
    };
    let (tree, _) = syntax::parse(sources, span.file);
    let place = Place::of(&tree.items, span, sources);
    let mut found = Vec::new();
    let is_meant = help.starts_with("did you mean `") && help.matches('`').count() == 2;
    let pieces: Vec<&str> = help.split('`').collect();
    for (at, piece) in pieces.iter().enumerate() {
        if at % 2 == 1 {
            let before = pieces[at - 1];
            if before.contains("remove") {
                found.extend(place.removed(piece));
            } else if !piece.contains('…') {
                found.extend(place.written(piece, is_meant));
            }
        } else if piece.contains("remove it") || piece.starts_with("remove") && pieces.len() == 1 {
            found.extend(place.removed(""));
        }
    }
    if let Some((_, block)) = help.split_once("such as\n") {
        found.extend(place.with_block(block));
    }
    found
}

/// Whether a text is an item of a plan.
fn is_item(text: &str) -> bool {
    let mut sources = Sources::default();
    let file = sources.add("item.psd", text);
    let (tree, errors) = syntax::parse(&sources, file);
    errors.is_empty() && tree.items.len() == 1
}

/// Where a diagnostic is: its item, and its entry.
struct Place<'a> {
    sources: &'a Sources,
    text: &'a str,
    span: Range<usize>,
    item: Option<Range<usize>>,
    block: Option<&'a Block>,
    entry: Option<&'a Entry>,
}

impl<'a> Place<'a> {
    fn of(items: &'a [syntax::ast::Item], span: Span, sources: &'a Sources) -> Self {
        let holds = |outer: Span| outer.start <= span.start && span.end <= outer.end;
        let item = items.iter().find(|item| holds(item.span));
        let block = item.and_then(|item| match &item.kind {
            ItemKind::Block(block) => Some(block),
            _ => None,
        });
        let entry = block.and_then(|block| block.fields.iter().find(|entry| holds(entry.span)));
        Self {
            sources,
            text: &sources.file(span.file).text,
            span: sources.range(span),
            item: item.map(|item| sources.range(item.span)),
            block,
            entry,
        }
    }

    /// The changes that write a piece of the help.
    fn written(&self, piece: &str, is_meant: bool) -> Vec<Change> {
        let replace = |replaced: Range<usize>| Change {
            title: format!("replace by `{piece}`"),
            replaced,
            text: piece.to_owned(),
            is_meant,
        };
        let mut changes = Vec::new();
        if is_item(piece) {
            changes.extend(self.with_block(piece));
            return changes;
        }
        let key = piece.split_once('=').map(|(key, _)| key.trim());
        let is_name = |key: &&str| {
            !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        if let Some(key) = key.filter(is_name) {
            let mut entries = self.block.iter().flat_map(|block| &block.fields);
            match entries.find(|entry| entry.key.node == key) {
                Some(entry) => changes.push(replace(self.sources.range(entry.span))),
                None => changes.extend(self.with_line(piece)),
            }
            return changes;
        }
        changes.push(replace(self.span.clone()));
        if let Some(entry) = self.entry {
            let value = self.sources.range(entry.value.span);
            if value != self.span {
                changes.push(replace(value));
            }
        }
        changes
    }

    /// A line more in the block.
    fn with_line(&self, line: &str) -> Option<Change> {
        let (block, item) = (self.block?, self.item.clone()?);
        let last = block.fields.last();
        let last = last.map(|entry| self.sources.range(entry.span).end);
        let title = format!("add `{line}`");
        let is_meant = false;
        let (replaced, text) = match last {
            Some(end) if self.text[item.clone()].contains('\n') => {
                let end = end + self.text[end..].find('\n').unwrap_or(0);
                (
                    end..end,
                    format!("\n{}{line}", self.indent(last.unwrap_or(end))),
                )
            }
            Some(end) => (end..end, format!("\n  {line}\n")),
            None => {
                let brace = self.sources.range(block.head).end;
                let brace = brace + self.text.get(brace..item.end)?.find('{')? + 1;
                let closes = self.text[brace..item.end].find('}').map(|at| brace + at)?;
                (brace..closes, format!("\n  {line}\n"))
            }
        };
        Some(Change {
            title,
            replaced,
            text,
            is_meant,
        })
    }

    /// The spaces before the line of an offset.
    fn indent(&self, offset: usize) -> &str {
        let start = self.text[..offset].rfind('\n').map_or(0, |at| at + 1);
        let line = &self.text[start..offset];
        &line[..line.len() - line.trim_start().len()]
    }

    /// An item more: a requirement at the end, any other before the item of the diagnostic.
    fn with_block(&self, block: &str) -> Option<Change> {
        let block = block.trim_end();
        let first = block.lines().next().unwrap_or_default();
        let more = if first == block { "" } else { " … }" };
        let is_last = block.starts_with("require ");
        let (start, text) = if is_last {
            (self.text.len(), format!("\n{block}\n"))
        } else {
            (self.item.as_ref()?.start, format!("{block}\n\n"))
        };
        Some(Change {
            title: format!("add `{}{more}`", first.trim_end()),
            replaced: start..start,
            text,
            is_meant: false,
        })
    }

    /// The changes that remove what is named, or where the diagnostic is.
    fn removed(&self, name: &str) -> Vec<Change> {
        let mut entries = self.block.iter().flat_map(|block| &block.fields);
        let named =
            entries.find(|entry| entry.key.node == name.split(['=', ' ']).next().unwrap_or(name));
        let line = |entry: &Entry| {
            let range = self.sources.range(entry.span);
            let start = self.text[..range.start].trim_end_matches([' ', '\t']).len();
            let start = start.saturating_sub(usize::from(self.text[..start].ends_with('\n')));
            start..range.end
        };
        let remove = |what: &str, replaced: Range<usize>| Change {
            title: format!("remove `{}`", what.lines().next().unwrap_or_default()),
            replaced,
            text: String::new(),
            is_meant: false,
        };
        let mut changes = Vec::new();
        if let Some(entry) = named {
            changes.push(remove(&entry.key.node, line(entry)));
            return changes;
        }
        if let Some(text) = self.text.get(self.span.clone()) {
            changes.push(remove(text, self.span.clone()));
        }
        if let Some(entry) = self.entry {
            changes.push(remove(&entry.key.node, line(entry)));
        } else if let Some(item) = self.item.clone() {
            changes.push(remove(&self.text[item.clone()], item));
        }
        changes
    }
}
