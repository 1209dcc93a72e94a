//! Errors of used files and of data files: E5xx.

use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;

pub fn bad_path(path: &str, span: Span, reason: &str) -> Diagnostic {
    Diagnostic::new(Code::BadPath, format!("`{path}` cannot be used: {reason}"))
        .at(span, "not a path inside the plan's folder")
        .help("put the file into the plan's folder, or a folder in it: `use \"lib/frame.psd\"`")
}

pub fn not_found(path: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::FileNotFound, format!("there is no file `{path}`"))
        .at(span, "not found")
        .help("paths are relative to the file that names them")
}

pub fn refused(path: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FileNotFound,
        format!("`{path}` cannot be read: {reason}"),
    )
    .at(span, "cannot be read")
    .help("name a plan file of UTF-8 text in the plan's folder")
}

pub fn use_cycle(chain: &[String], path: &str, span: Span) -> Diagnostic {
    let cycle = chain
        .iter()
        .map(String::as_str)
        .chain([path])
        .collect::<Vec<_>>()
        .join(" → ");
    Diagnostic::new(
        Code::UseCycle,
        format!("files use each other in a ring: {cycle}"),
    )
    .at(span, "closes the ring")
    .help("move what both need into a third file")
}

pub fn too_deep(deepest: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooManyFiles,
        format!("files use files more than {deepest} deep"),
    )
    .at(span, "one too deep")
    .help("use the file from the plan itself")
}

pub fn too_many_files(most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooManyFiles,
        format!("a plan may be made of at most {most} files"),
    )
    .at(span, "one too many")
    .help("put declarations that belong together into one file")
}

pub fn bad_data_path(path: &str, span: Span, reason: &str) -> Diagnostic {
    Diagnostic::new(Code::BadPath, format!("`{path}` cannot be read: {reason}"))
        .at(span, "not a path inside the plan's folder")
        .help("put the file into the plan's folder, or a folder in it")
}

pub fn data_refused(path: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FileNotFound,
        format!("`{path}` cannot be read: {reason}"),
    )
    .at(span, "cannot be read")
    .help("name a file of UTF-8 text in the plan's folder")
}
