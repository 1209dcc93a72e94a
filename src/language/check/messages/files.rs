//! Errors of used files and of data files: E5xx.

use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

pub fn bad_path(path: &str, span: Span, reason: &str) -> Diagnostic {
    Diagnostic::new(Code::BadPath, format!("invalid path `{path}`: {reason}"))
        .at(span, "not in the plan's folder")
        .help("move the file into the plan's folder, or a folder in it: `use \"lib/frame.psd\"`")
}

pub fn not_found(path: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::FileNotFound, format!("file `{path}` does not exist"))
        .at(span, "not found")
        .help("write a path relative to the file that names it")
}

pub fn refused(path: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FileNotFound,
        format!("`{path}` cannot be read: {reason}"),
    )
    .at(span, "cannot be read")
    .help("name a UTF-8 text file in the plan's folder")
}

pub fn use_cycle(chain: &[String], path: &str, span: Span) -> Diagnostic {
    let cycle = chain
        .iter()
        .map(String::as_str)
        .chain([path])
        .collect::<Vec<_>>()
        .join(" → ");
    Diagnostic::new(Code::UseCycle, format!("circular `use`: {cycle}"))
        .at(span, "closes the circle")
        .help("move the shared declarations into a third file")
}

pub fn too_deep(deepest: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooManyFiles,
        format!("`use` nested more than {deepest} deep"),
    )
    .at(span, "too deep")
    .help("use the file from the plan directly")
}

pub fn too_many_files(most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooManyFiles,
        format!("too many files: a plan can have at most {most}"),
    )
    .at(span, "too many")
    .help("combine related declarations in one file")
}

pub fn bad_data_path(path: &str, span: Span, reason: &str) -> Diagnostic {
    Diagnostic::new(Code::BadPath, format!("`{path}` cannot be read: {reason}"))
        .at(span, "not in the plan's folder")
        .help("move the file into the plan's folder, or a folder in it")
}

pub fn data_refused(path: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FileNotFound,
        format!("`{path}` cannot be read: {reason}"),
    )
    .at(span, "cannot be read")
    .help("name a UTF-8 text file, or a picture, in the plan's folder")
}

pub fn not_a_picture(path: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::BadPath, format!("`{path}` is not a picture file"))
        .at(span, "not a picture file")
        .help("name a file that ends in `.png`, `.jpg`, `.jpeg` or `.svg`")
}

pub fn bad_picture(path: &str, reason: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FileNotFound,
        format!("`{path}` cannot be used: {reason}"),
    )
    .at(span, "not a usable picture")
    .help("save it as PNG, JPEG or SVG of up to 2 MiB")
}

pub fn too_many_photos(most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooManyFiles,
        format!("too many photographs (at most {most})"),
    )
    .at(span, "one too many")
    .help("remove photographs")
}
