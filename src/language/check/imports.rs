//! `use "lib/frame.psd"`: every file of a plan, each loaded once. In: the plan's text and a [`Loader`]. Out: the syntax
//! trees, the plan's first.

use crate::check::violations::{FileMissing, TooManyFiles};
use crate::codes::{E501, E502, E503, E504};
use crate::syntax;
use crate::syntax::ast::{Ast, ItemKind};
use psd_text::diagnostic::{Diagnostic, Violation};
use psd_text::source::{FileId, Sources, Span, Spanned};

use super::{LoadError, Loader};

/// Deepest chain of files that use files.
pub const DEEPEST: usize = 8;
/// Most files of one plan, the plan included.
pub const MOST_FILES: usize = 64;

/// All files of a plan.
pub struct Imports {
    pub asts: Vec<Ast>,
    /// Whether some file could not be read, so that names may be missing without an error in the plan.
    pub incomplete: bool,
}

struct Loading<'l> {
    loader: &'l Loader<'l>,
    /// Path of each file loaded, with its tree.
    loaded: Vec<(String, Ast)>,
    /// The files that use one another, down to the one being read.
    chain: Vec<String>,
    incomplete: bool,
}

pub fn load(
    name: &str,
    text: &str,
    loader: &Loader<'_>,
    sources: &mut Sources,
    diagnostics: &mut Vec<Diagnostic>,
) -> Imports {
    let mut loading = Loading {
        loader,
        loaded: Vec::new(),
        chain: Vec::new(),
        incomplete: false,
    };
    // Paths of used files are relative to the plan's folder, and so is the plan's own path.
    let own = name.rsplit(['/', '\\']).next().unwrap_or(name);
    loading.read(own, name, text, sources, diagnostics);
    Imports {
        asts: loading.loaded.into_iter().map(|(_, ast)| ast).collect(),
        incomplete: loading.incomplete,
    }
}

#[derive(Violation)]
#[violation(E502, "invalid path `{path}`: {reason}")]
#[help("move the file into the plan's folder, or a folder in it: `use \"lib/frame.psd\"`")]
struct BadUsePath<'a> {
    path: &'a str,
    #[label("not in the plan's folder")]
    span: Span,
    reason: &'a str,
}

#[derive(Violation)]
#[violation(E503, "circular `use`: {cycle}", cycle = chain
        .iter()
        .map(String::as_str)
        .chain([path])
        .collect::<Vec<_>>()
        .join(" → "))]
#[help("move the shared declarations into a third file")]
struct UseCycle<'a> {
    chain: &'a [String],
    path: &'a str,
    #[label("closes the circle")]
    span: Span,
}

#[derive(Violation)]
#[violation(E504, "`use` nested more than {deepest} deep")]
#[help("use the file from the plan directly")]
struct UseTooDeep {
    deepest: usize,
    #[label("too deep")]
    span: Span,
}

#[derive(Violation)]
#[violation(E501, "`{path}` cannot be read: {reason}")]
#[help("name a UTF-8 text file in the plan's folder")]
struct FileRefused<'a> {
    path: &'a str,
    reason: &'a str,
    #[label("cannot be read")]
    span: Span,
}

impl Loading<'_> {
    fn read(
        &mut self,
        path: &str,
        name: &str,
        text: &str,
        sources: &mut Sources,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let file = sources.add(name, text);
        let (ast, found) = syntax::parse(sources, file);
        let known = diagnostics.len();
        diagnostics.extend(found);
        let used: Vec<Spanned<String>> = ast
            .items
            .iter()
            .filter_map(|item| {
                if let ItemKind::Use { path } = &item.kind {
                    Some(path.clone())
                } else {
                    None
                }
            })
            .collect();
        // The declarations of a file that could not be parsed at all are unknown.
        self.incomplete |=
            ast.items.is_empty() && diagnostics[known..].iter().any(Diagnostic::is_error);
        self.loaded.push((path.to_owned(), ast));
        debug_assert_eq!(
            FileId(u32::try_from(self.loaded.len()).unwrap_or(0)),
            FileId(file.0 + 1)
        );
        self.chain.push(path.to_owned());
        for used in used {
            if let Err(found) = self.follow(path, &used, sources, diagnostics) {
                self.incomplete = true;
                diagnostics.push(found);
            }
        }
        self.chain.pop();
    }

    /// Loads the file of one `use`, unless it is loaded already.
    fn follow(
        &mut self,
        from: &str,
        used: &Spanned<String>,
        sources: &mut Sources,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Result<(), Diagnostic> {
        let written = used.node.as_str();
        if let Some(reason) = refused(written) {
            return Err(BadUsePath {
                path: written,
                span: used.span,
                reason,
            }
            .diagnostic());
        }
        let path = resolved(from, written);
        if let Some(start) = self.chain.iter().position(|open| *open == path) {
            return Err(UseCycle {
                chain: &self.chain[start..],
                path: &path,
                span: used.span,
            }
            .diagnostic());
        }
        if self.loaded.iter().any(|(known, _)| *known == path) {
            return Ok(());
        }
        if self.chain.len() > DEEPEST {
            return Err(UseTooDeep {
                deepest: DEEPEST,
                span: used.span,
            }
            .diagnostic());
        }
        if self.loaded.len() >= MOST_FILES {
            return Err(TooManyFiles {
                most: MOST_FILES,
                span: used.span,
            }
            .diagnostic());
        }
        match (self.loader)(&path) {
            Ok(text) => {
                self.read(&path, &path, &text, sources, diagnostics);
                Ok(())
            }
            Err(LoadError::NotFound) => Err(FileMissing {
                path: &path,
                span: used.span,
            }
            .diagnostic()),
            Err(LoadError::Refused(reason)) => Err(FileRefused {
                path: &path,
                reason: &reason,
                span: used.span,
            }
            .diagnostic()),
        }
    }
}

/// The path, relative to the plan's folder, of the file that `from` names as `written`.
pub fn resolved(from: &str, written: &str) -> String {
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let steps = written.split('/').filter(|step| *step != ".");
    folder
        .split('/')
        .filter(|step| !step.is_empty())
        .chain(steps)
        .collect::<Vec<_>>()
        .join("/")
}

/// The path of a file of the plan, relative to the plan's folder.
pub fn own_path(sources: &Sources, file: FileId) -> String {
    let name = sources.file(file).name.as_str();
    if file == FileId(0) {
        name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned()
    } else {
        name.to_owned()
    }
}

/// Why a path is not allowed, if so.
pub fn refused(path: &str) -> Option<&'static str> {
    let drive = path.as_bytes().get(1) == Some(&b':');
    if path.is_empty() {
        Some("the path is empty")
    } else if path.contains('\\') {
        Some("folders are separated by `/`, also on Windows")
    } else if path.starts_with('/') || drive {
        Some("the path is absolute")
    } else if path.split('/').any(|step| step == "..") {
        Some("the path leaves the plan's folder by `..`")
    } else if path.split('/').any(str::is_empty) {
        Some("a folder name is empty")
    } else if path.split('/').all(|step| step == ".") {
        Some("the path is the plan's folder, not a file")
    } else {
        None
    }
}
