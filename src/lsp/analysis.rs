//! One plan as an editor sees it: its files, their syntax trees, and the meaning of each word in them. In: a plan and a loader. Out: an
//! [`Analysis`], which holds as long as no file changes. It evaluates a value where one asks for it.

use std::collections::BTreeMap;

use psd_language::check::Loader;
use psd_language::check::checker::{Checker, Context, Reads, Typed};
use psd_language::check::imports;
use psd_language::check::scope::{Meaning as Declared, Scope};
use psd_language::syntax::ast::{Ast, Expr};
use psd_text::source::{FileId, Sources, Span};

use crate::occurrences::{Meaning, Occurrence, Occurrences, Symbol};
use crate::text::{Encoding, Text};

/// A plan with the files that it uses.
pub struct Analysis {
    pub sources: Sources,
    pub trees: Vec<Ast>,
    /// The key of the document of each file.
    pub documents: Vec<String>,
    /// The text of each file, with its lines.
    pub texts: Vec<Text>,
    pub occurrences: Occurrences,
}

impl Analysis {
    /// Reads a plan. `document` gives the key of a file by its path from the plan's folder.
    pub fn of(
        name: &str,
        text: &str,
        loader: &Loader<'_>,
        document: &dyn Fn(&str) -> String,
        encoding: Encoding,
    ) -> Self {
        let mut sources = Sources::default();
        let mut errors = Vec::new();
        let trees = imports::load(name, text, loader, &mut sources, &mut errors).asts;
        let files = sources.iter();
        let (documents, texts) = files
            .map(|(file, source)| {
                let path = imports::own_path(&sources, file);
                (document(&path), Text::new(source.text.as_str(), encoding))
            })
            .unzip();
        let occurrences = Occurrences::of(&trees);
        Self {
            sources,
            trees,
            documents,
            texts,
            occurrences,
        }
    }

    /// The file of a document in this plan.
    pub fn file(&self, document: &str) -> Option<FileId> {
        let at = self.documents.iter().position(|own| own == document)?;
        u32::try_from(at).ok().map(FileId)
    }

    pub fn text(&self, file: FileId) -> &Text {
        &self.texts[file.0 as usize]
    }

    pub fn tree(&self, file: FileId) -> Option<&Ast> {
        self.trees.iter().find(|tree| tree.file == file)
    }

    pub fn symbol(&self, index: usize) -> &Symbol {
        &self.occurrences.symbols[index]
    }

    /// The innermost word at an offset, its end included.
    pub fn at(&self, file: FileId, offset: usize) -> Option<&Occurrence> {
        self.occurrences.at(file, offset)
    }

    /// Evaluates with the check of the language, whose diagnostics nobody reads here.
    pub fn evaluate<T>(
        &self,
        loader: &Loader<'_>,
        work: impl FnOnce(&mut Checker<'_>) -> Option<T>,
    ) -> Option<T> {
        let settings = BTreeMap::new();
        let mut diagnostics = Vec::new();
        let scope = Scope::collect(&self.trees, &settings, &mut diagnostics);
        let mut checker = Checker::new(&self.sources, &scope, loader, Vec::new(), Vec::new(), true);
        work(&mut checker)
    }

    /// The value of a `let`, a `param` or a numeric field.
    pub fn value_of(&self, loader: &Loader<'_>, meaning: Meaning) -> Option<Typed> {
        match meaning {
            Meaning::Symbol(symbol) => {
                let symbol = self.symbol(symbol);
                self.evaluate(loader, |checker| {
                    match checker.scope.meaning(&symbol.name)? {
                        Declared::Value(index) => checker.declared_value(index, symbol.span),
                        _ => None,
                    }
                })
            }
            Meaning::Entry { key, .. } => self.evaluate(loader, |checker| {
                let (block, entry) = entry_at(checker, key)?;
                checker.entry_value(block, entry)
            }),
            _ => None,
        }
    }

    /// The values of expressions, by their spans: of entries, declarations and conditions, or of parts of these. One that has an error has
    /// no value.
    pub fn values(&self, loader: &Loader<'_>, wanted: &[Span]) -> Vec<Typed> {
        let found = self.evaluate(loader, |checker| {
            let scope = checker.scope;
            let blocks = scope.blocks.iter().enumerate();
            let written: Vec<_> = blocks
                .flat_map(|(block, declared)| {
                    let entries = declared.block.fields.iter().enumerate();
                    entries.map(move |(entry, written)| (Some((block, entry)), &written.value))
                })
                .chain(scope.values.iter().map(|value| (None, value.value)))
                .chain(scope.requirements.iter().map(|one| (None, one.condition)))
                .collect();
            let mut found = Vec::new();
            for wanted in wanted {
                let whole = written
                    .iter()
                    .find(|(_, value)| covers(value.span, *wanted));
                let Some((entry, value)) = whole else {
                    continue;
                };
                let Some(expr) = innermost(value, *wanted) else {
                    continue;
                };
                let context = entry.map_or(
                    Context {
                        entry: None,
                        reads: Reads::All,
                        critical: false,
                    },
                    |(block, entry)| checker.context_of(block, entry),
                );
                found.extend(checker.value(expr, context));
            }
            Some(found)
        });
        found.unwrap_or_default()
    }
}

fn covers(span: Span, inner: Span) -> bool {
    span.file == inner.file && span.start <= inner.start && inner.end <= span.end
}

/// The expression with exactly this span, in another.
fn innermost(expr: &Expr, wanted: Span) -> Option<&Expr> {
    if expr.span == wanted {
        return Some(expr);
    }
    let parts = crate::occurrences::parts(expr);
    parts
        .into_iter()
        .filter(|part| covers(part.span, wanted))
        .find_map(|part| innermost(part, wanted))
}

/// The block and the entry whose key has this span.
fn entry_at(checker: &Checker<'_>, key: Span) -> Option<(usize, usize)> {
    let mut blocks = checker.scope.blocks.iter().enumerate();
    blocks.find_map(|(block, declared)| {
        let mut fields = declared.block.fields.iter();
        let entry = fields.position(|entry| entry.key.span == key)?;
        Some((block, entry))
    })
}
